//! NIfTI-1: `.nii`, and packed by gzip `.nii.gz`.
//!
//! A header of 348 bytes in either order of bytes, the samples from `vox_offset` on. Samples are scaled by
//! `scl_slope` and `scl_inter`. Where the first lies in a patient is not used: it makes sense only with the
//! directions of the axes.

use std::borrow::Cow;

use glam::DVec3;

use super::encoding::{self, Encoding, Format};
use super::reader::{Data, Header, UNSCALED};
use super::{ByteOrder, Fault, Sample};

const HEADER: usize = 348;

/// A header's numbers, in its order of bytes.
struct Numbers<'a> {
    bytes: &'a [u8; HEADER],
    order: ByteOrder,
}

impl Numbers<'_> {
    fn short(&self, at: usize) -> i16 {
        let bytes = [self.bytes[at], self.bytes[at + 1]];
        match self.order {
            ByteOrder::Little => i16::from_le_bytes(bytes),
            ByteOrder::Big => i16::from_be_bytes(bytes),
        }
    }

    fn float(&self, at: usize) -> f32 {
        let bytes = [0, 1, 2, 3].map(|i| self.bytes[at + i]);
        match self.order {
            ByteOrder::Little => f32::from_le_bytes(bytes),
            ByteOrder::Big => f32::from_be_bytes(bytes),
        }
    }
}

/// The numbers of the header and where the samples start.
fn numbers(bytes: &[u8]) -> Result<(Numbers<'_>, usize), Fault> {
    let Some(bytes) = bytes.first_chunk::<HEADER>() else {
        return Err(Fault::new(format!(
            "{} bytes, but the header alone has {HEADER}; the file is cut off",
            bytes.len()
        )));
    };
    let length = [bytes[0], bytes[1], bytes[2], bytes[3]];
    let order = match (u32::from_le_bytes(length), u32::from_be_bytes(length)) {
        (348, _) => ByteOrder::Little,
        (_, 348) => ByteOrder::Big,
        (540, _) | (_, 540) => {
            return Err(Fault::new("this is NIfTI-2; only NIfTI-1 is read, convert it"));
        }
        _ => {
            return Err(Fault::new(
                "the header does not start with its length, 348; this is no NIfTI-1",
            ));
        }
    };
    match &bytes[344..] {
        b"n+1\0" => {}
        b"ni1\0" => {
            return Err(Fault::new(
                "the samples are in another file; join header and samples in a .nii",
            ));
        }
        _ => return Err(Fault::new("the header does not end in n+1; this is no NIfTI-1")),
    }
    let numbers = Numbers { bytes, order };
    let start = numbers.float(108);
    if !(start >= HEADER as f32 && start < 1e9 && start.fract() == 0.0) {
        return Err(Fault::new(format!(
            "vox_offset is {start}; it must be a whole number from 352 on"
        )));
    }
    Ok((numbers, start as usize))
}

fn format(numbers: &Numbers<'_>) -> Result<Format, Fault> {
    let sizes: [i16; 8] = std::array::from_fn(|i| numbers.short(40 + 2 * i));
    let rank = sizes[0];
    let is_volume = (3..=7).contains(&rank) && sizes[4..=rank as usize].iter().all(|n| *n == 1);
    if !is_volume {
        return Err(Fault::new(format!(
            "dim is {sizes:?}; only volumes are read, of 3 dimensions, write one of them"
        )));
    }
    // What is below 0 is refused like 0: there are no samples.
    let size = [sizes[1], sizes[2], sizes[3]].map(|n| usize::try_from(n).unwrap_or(0));
    let sample = match numbers.short(70) {
        2 => Sample::U8,
        4 => Sample::I16,
        8 => Sample::I32,
        16 => Sample::F32,
        64 => Sample::F64,
        256 => Sample::I8,
        512 => Sample::U16,
        768 => Sample::U32,
        other => {
            return Err(Fault::new(format!(
                "the datatype is {other}; only integers of 8 to 32 bits and floats are read, convert it"
            )));
        }
    };
    Ok(Format { size, sample, order: numbers.order, encoding: Encoding::Raw })
}

pub(super) fn parse(bytes: &[u8]) -> Result<Header<'_>, Fault> {
    let (numbers, start) = numbers(bytes)?;
    let format = format(&numbers)?;
    let spacing = DVec3::from([80, 84, 88].map(|at| f64::from(numbers.float(at).abs())));
    let [slope, intercept] = [112, 116].map(|at| f64::from(numbers.float(at)));
    // A slope of 0 is how a header says that there is none.
    let is_scaled = slope != 0.0 && slope.is_finite() && intercept.is_finite();
    let scale = if is_scaled { [slope, intercept] } else { UNSCALED };
    let data = bytes.get(start..).ok_or_else(|| {
        Fault::new(format!(
            "{} bytes, but samples start at {start}; the file is cut off",
            bytes.len()
        ))
    })?;
    Ok(Header { format, spacing, origin: DVec3::ZERO, scale, data: Data::Here(data) })
}

/// The bytes of a `.nii` from those of a `.nii.gz`.
pub(super) fn unpacked(packed: &[u8]) -> Result<Vec<u8>, Fault> {
    let head = encoding::start(Encoding::Gzip, packed, HEADER)?;
    let (numbers, start) = numbers(&head)?;
    let wanted = format(&numbers)?.bytes()? + start;
    encoding::unpacked(Encoding::Gzip, packed, wanted).map(Cow::into_owned)
}
