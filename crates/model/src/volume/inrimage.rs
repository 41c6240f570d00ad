//! INRIMAGE `.inr`: a header of text, filled up to a multiple of 256 bytes, then the samples.

use glam::DVec3;

use super::encoding::{Encoding, Format};
use super::header::{Fields, line, number};
use super::reader::{Data, Header, UNSCALED};
use super::{ByteOrder, Fault, Sample};

/// Headers are whole blocks.
const BLOCK: usize = 256;

/// The most blocks of a header; what is longer is none.
const MOST_BLOCKS: usize = 64;

const END: &[u8] = b"##}\n";

pub(super) fn parse(bytes: &[u8]) -> Result<Header<'_>, Fault> {
    if !bytes.starts_with(b"#INRIMAGE-4#{") {
        return Err(Fault::new(
            "the file does not start with #INRIMAGE-4#{; this is another kind of file",
        ));
    }
    let (blocks, _) = bytes.as_chunks::<BLOCK>();
    let blocks = &blocks[..blocks.len().min(MOST_BLOCKS)];
    let last = blocks.iter().position(|block| block.ends_with(END));
    let Some(last) = last else {
        return Err(Fault::new(
            "the header has no end (##}); the file is cut off, or is no INRIMAGE",
        ));
    };
    let (header, data) = bytes.split_at((last + 1) * BLOCK);
    let fields = fields(header)?;
    if fields.find(&["VDIM"]).is_some_and(|n| n != "1") {
        return Err(Fault::new("samples have several values (VDIM); write one of them"));
    }
    if fields.find(&["SCALE"]).is_some_and(|scale| scale != "2**0") {
        return Err(Fault::new("samples are scaled (SCALE); write them without"));
    }
    let (sample, order) = (sample(&fields)?, order(fields.find(&["CPU"]).unwrap_or("decm"))?);
    let size = ["XDIM", "YDIM", "ZDIM"].map(|key| number(key, fields.get(key)?));
    let step = |key| fields.find(&[key]).map_or(Ok(1.0), |text| number(key, text));
    let [x, y, z] = size;
    Ok(Header {
        format: Format { size: [x?, y?, z?], sample, order, encoding: Encoding::Raw },
        spacing: DVec3::new(step("VX")?, step("VY")?, step("VZ")?),
        origin: DVec3::ZERO,
        scale: UNSCALED,
        data: Data::Here(data),
    })
}

fn fields(header: &[u8]) -> Result<Fields, Fault> {
    let mut fields = Fields::default();
    let mut rest = header;
    while !rest.is_empty() {
        let (text, after) = line(rest)?;
        rest = after;
        if let Some((key, value)) = text.split_once('=').filter(|_| !text.starts_with('#')) {
            fields.add(key, value)?;
        }
    }
    Ok(fields)
}

fn sample(fields: &Fields) -> Result<Sample, Fault> {
    let (kind, width) = (fields.get("TYPE")?, fields.get("PIXSIZE")?);
    Ok(match (kind, width.trim_end_matches("bits").trim_end()) {
        ("unsigned fixed", "8") => Sample::U8,
        ("signed fixed", "8") => Sample::I8,
        ("unsigned fixed", "16") => Sample::U16,
        ("signed fixed", "16") => Sample::I16,
        ("unsigned fixed", "32") => Sample::U32,
        ("signed fixed", "32") => Sample::I32,
        ("float", "32") => Sample::F32,
        ("float", "64") => Sample::F64,
        _ => {
            return Err(Fault::new(format!(
                "samples of {kind:?} in {width:?} are not read; write float in 32 bits"
            )));
        }
    })
}

fn order(machine: &str) -> Result<ByteOrder, Fault> {
    match machine {
        "decm" | "pc" | "alpha" => Ok(ByteOrder::Little),
        "sun" | "sgi" => Ok(ByteOrder::Big),
        _ => Err(Fault::new(format!("CPU is {machine:?}; it must be decm, pc, alpha, sun or sgi"))),
    }
}
