//! NRRD: `.nrrd`, or `.nhdr` with the samples beside it.
//!
//! A line `NRRD000n`, lines of `field: value`, `key:=value` and `# comment`, an empty line, the samples.

use glam::DVec3;

use super::encoding::{Encoding, Format};
use super::header::{Fields, line, number, numbers};
use super::reader::{Data, Header, UNSCALED};
use super::{ByteOrder, Fault, Sample};

pub(super) fn parse(bytes: &[u8]) -> Result<Header<'_>, Fault> {
    let (magic, mut rest) = line(bytes)?;
    if !magic.starts_with("NRRD000") {
        return Err(Fault::new("the first line is not NRRD000n; this is another kind of file"));
    }
    let mut fields = Fields::default();
    while !rest.is_empty() {
        let (text, after) = line(rest)?;
        rest = after;
        if text.is_empty() {
            break;
        }
        if text.starts_with('#') || text.contains(":=") {
            continue;
        }
        let Some((key, value)) = text.split_once(':') else {
            let shown: String = text.chars().take(40).collect();
            return Err(Fault::new(format!(
                "a header line is {shown:?}, not field: value; correct it"
            )));
        };
        fields.add(key, value)?;
    }
    let dimension = fields.get("dimension")?;
    if dimension != "3" {
        return Err(Fault::new(format!(
            "the dimension is {dimension:?}; only volumes are read, of 3, with one number a sample"
        )));
    }
    for key in ["line skip", "byte skip"] {
        if fields.find(&[key]).is_some_and(|skip| skip != "0") {
            return Err(Fault::new(format!("{key} is not read; write the samples without it")));
        }
    }
    let sample = sample(fields.get("type")?)?;
    let encoding = encoding(fields.get("encoding")?)?;
    let order = match fields.find(&["endian"]) {
        Some("little") => ByteOrder::Little,
        Some("big") => ByteOrder::Big,
        None if sample.width() == 1 || encoding == Encoding::Text => ByteOrder::Little,
        _ => return Err(Fault::new("endian must be little or big")),
    };
    let format = Format { size: fields.size("sizes")?, sample, order, encoding };
    let data = match fields.find(&["data file", "datafile"]) {
        None => Data::Here(rest),
        Some(name) if name.is_empty() || name.starts_with("LIST") || name.contains('%') => {
            return Err(Fault::new(format!(
                "the data file is {name:?}; samples in several files are not read, join them"
            )));
        }
        Some(name) => Data::Beside(name.into()),
    };
    let origin = match fields.find(&["space origin"]) {
        Some(text) => vector("space origin", text)?,
        None => DVec3::ZERO,
    };
    Ok(Header { format, spacing: spacing(&fields)?, origin, scale: UNSCALED, data })
}

/// The lengths of the axes' steps; `nan` and `none` say nothing, which is 1.
fn spacing(fields: &Fields) -> Result<DVec3, Fault> {
    let known = |step: f64| if step.is_nan() { 1.0 } else { step };
    if let Some(text) = fields.find(&["space directions"]) {
        let mut steps = [1.0; 3];
        let vectors: Vec<&str> =
            text.split_inclusive(')').filter(|v| !v.trim().is_empty()).collect();
        if vectors.len() != 3 {
            return Err(Fault::new(format!(
                "space directions has {} vectors, not 3; correct it",
                vectors.len()
            )));
        }
        for (step, text) in steps.iter_mut().zip(vectors) {
            *step = vector("space directions", text)?.length();
        }
        return Ok(DVec3::from(steps));
    }
    let spacing = match fields.find(&["spacings"]) {
        Some(text) => numbers("spacings", text)?,
        None => [1.0; 3],
    };
    Ok(DVec3::from(spacing.map(known)))
}

/// `(x,y,z)`.
fn vector(key: &str, text: &str) -> Result<DVec3, Fault> {
    let inner = text.trim().strip_prefix('(').and_then(|text| text.strip_suffix(')'));
    let parts: Vec<&str> = inner.unwrap_or_default().split(',').collect();
    let [x, y, z] = parts[..] else {
        return Err(Fault::new(format!("{key} must be of the form (x,y,z)")));
    };
    Ok(DVec3::new(number(key, x)?, number(key, y)?, number(key, z)?))
}

fn encoding(name: &str) -> Result<Encoding, Fault> {
    match name.to_ascii_lowercase().as_str() {
        "raw" => Ok(Encoding::Raw),
        "gzip" | "gz" => Ok(Encoding::Gzip),
        "ascii" | "text" | "txt" => Ok(Encoding::Text),
        _ => {
            Err(Fault::new(format!("the encoding is {name:?}; only raw, gzip and ascii are read")))
        }
    }
}

fn sample(name: &str) -> Result<Sample, Fault> {
    Ok(match name {
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => Sample::U8,
        "signed char" | "int8" | "int8_t" => Sample::I8,
        "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => Sample::U16,
        "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => {
            Sample::I16
        }
        "uint" | "unsigned int" | "uint32" | "uint32_t" => Sample::U32,
        "int" | "signed int" | "int32" | "int32_t" => Sample::I32,
        "float" => Sample::F32,
        "double" => Sample::F64,
        _ => {
            return Err(Fault::new(format!(
                "the type is {name:?}; it must be int8 to uint32, float or double"
            )));
        }
    })
}
