//! MetaImage: `.mhd` with its samples beside it, `.mha` with both.
//!
//! Lines of `key = value`; the last names the file of the samples, or LOCAL.

use glam::DVec3;

use super::encoding::{Encoding, Format};
use super::header::{Fields, line, number};
use super::reader::{Data, Header, UNSCALED};
use super::{ByteOrder, Fault, Sample};

pub(super) fn parse(bytes: &[u8]) -> Result<Header<'_>, Fault> {
    let (fields, rest) = fields(bytes)?;
    let dimensions = fields.get("NDims")?;
    if dimensions != "3" {
        return Err(Fault::new(format!("NDims is {dimensions:?}; only volumes are read, of 3")));
    }
    if fields.find(&["ElementNumberOfChannels"]).is_some_and(|n| n != "1") {
        return Err(Fault::new("samples have several channels; write one of them"));
    }
    let is_true = |keys: &[&str], default: &str| {
        fields.find(keys).unwrap_or(default).eq_ignore_ascii_case("true")
    };
    let is_big = is_true(&["BinaryDataByteOrderMSB", "ElementByteOrderMSB"], "false");
    let encoding = match () {
        () if !is_true(&["BinaryData"], "true") => Encoding::Text,
        () if is_true(&["CompressedData"], "false") => Encoding::Zlib,
        () => Encoding::Raw,
    };
    let format = Format {
        size: fields.size("DimSize")?,
        sample: sample(fields.get("ElementType")?)?,
        order: if is_big { ByteOrder::Big } else { ByteOrder::Little },
        encoding,
    };
    let spacing: DVec3 = fields.vector(&["ElementSpacing", "ElementSize"], 1.0)?;
    let origin = fields.vector(&["Offset", "Position", "Origin"], 0.0)?;
    let skip: i64 = number("HeaderSize", fields.find(&["HeaderSize"]).unwrap_or("0"))?;
    let name = fields.get("ElementDataFile")?;
    let data = match (name, skip) {
        ("LOCAL" | "Local" | "local", _) => Data::Here(rest),
        (name, _) if name.is_empty() || name.starts_with("LIST") || name.contains('%') => {
            return Err(Fault::new(format!(
                "ElementDataFile is {name:?}; samples in several files are not read, join them"
            )));
        }
        (name, 0) => Data::Beside(name.into()),
        (name, -1) if encoding == Encoding::Raw => Data::AtEndOf(name.into()),
        _ => return Err(Fault::new(format!("HeaderSize is {skip}; only 0 and -1 are read"))),
    };
    Ok(Header { format, spacing, origin, scale: UNSCALED, data })
}

/// The fields up to that which ends the header, and what follows.
fn fields(bytes: &[u8]) -> Result<(Fields, &[u8]), Fault> {
    let mut fields = Fields::default();
    let mut rest = bytes;
    while !rest.is_empty() {
        let (text, after) = line(rest)?;
        rest = after;
        match text.split_once('=') {
            Some((key, value)) => fields.add(key, value)?,
            None if text.is_empty() => {}
            None => {
                let shown: String = text.chars().take(40).collect();
                return Err(Fault::new(format!(
                    "a header line is {shown:?}, not key = value; this is another kind of file"
                )));
            }
        }
        if fields.find(&["ElementDataFile"]).is_some() {
            return Ok((fields, rest));
        }
    }
    Err(Fault::new("the header has no ElementDataFile; add it, or fetch the file again"))
}

fn sample(name: &str) -> Result<Sample, Fault> {
    Ok(match name {
        "MET_UCHAR" => Sample::U8,
        "MET_CHAR" => Sample::I8,
        "MET_USHORT" => Sample::U16,
        "MET_SHORT" => Sample::I16,
        "MET_UINT" => Sample::U32,
        "MET_INT" => Sample::I32,
        "MET_FLOAT" => Sample::F32,
        "MET_DOUBLE" => Sample::F64,
        _ => {
            return Err(Fault::new(format!(
                "ElementType is {name:?}; it must be MET_UCHAR, MET_CHAR, MET_USHORT, MET_SHORT, MET_UINT, \
                 MET_INT, MET_FLOAT or MET_DOUBLE"
            )));
        }
    })
}
