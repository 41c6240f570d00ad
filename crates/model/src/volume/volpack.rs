//! VolPack `.den`: 31 little-endian integers of 16 bits, then samples of 8 bits.

use glam::DVec3;

use super::encoding::{Encoding, Format};
use super::reader::{Data, Header, UNSCALED};
use super::{ByteOrder, Fault, Sample};

const HEADER: usize = 62;

pub(super) fn parse(bytes: &[u8]) -> Result<Header<'_>, Fault> {
    let Some((header, data)) = bytes.split_first_chunk::<HEADER>() else {
        return Err(Fault::new(format!(
            "{} bytes, but the header alone has {HEADER}; the file is cut off",
            bytes.len()
        )));
    };
    let short = |index: usize| i16::from_le_bytes([header[2 * index], header[2 * index + 1]]);
    if short(0) != 1 {
        return Err(Fault::new(format!(
            "the header starts with the version {}, not 1; this is another kind of file",
            short(0)
        )));
    }
    // map_len. What is below 0 is refused like 0: there are no samples.
    let size = [25, 26, 27].map(|index| usize::try_from(short(index)).unwrap_or(0));
    let (sample, order, encoding) = (Sample::U8, ByteOrder::Little, Encoding::Raw);
    Ok(Header {
        format: Format { size, sample, order, encoding },
        spacing: DVec3::ONE,
        origin: DVec3::ZERO,
        scale: UNSCALED,
        data: Data::Here(data),
    })
}
