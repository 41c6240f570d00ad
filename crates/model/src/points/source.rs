//! The bytes of a file, uncompressed, and the format that they are in.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use flate2::read::MultiGzDecoder;

use super::{Error, Place, obj, ply, raw::Raw, xyz};

/// The most bytes that are read: indices of 32 bits then have room to spare.
const MOST: u64 = 1 << 31;
/// A gzip file may claim a thousand times its size; numbers reach a tenth of that. Small files may have more.
const RATIO: u64 = 100;
const SMALL: u64 = 1 << 24;

const GZIP: [u8; 2] = [0x1f, 0x8b];

/// A file at hand.
#[derive(Debug)]
pub(super) struct Source {
    name: String,
    bytes: Vec<u8>,
}

impl Source {
    pub(super) fn read(path: &Path) -> Result<Self, Error> {
        let name = path.display().to_string();
        let unreadable = |e: std::io::Error| {
            Error::new(&name, Place::Whole, format!("cannot be read: {e}"), "check the path")
        };
        let file = File::open(path).map_err(unreadable)?;
        let mut bytes = Vec::new();
        file.take(MOST + 1).read_to_end(&mut bytes).map_err(unreadable)?;
        Self::new(name, bytes)
    }

    /// Uncompresses if the content is gzip, whatever the name says.
    pub(super) fn new(name: String, bytes: Vec<u8>) -> Result<Self, Error> {
        let said = name.to_ascii_lowercase().ends_with(".gz");
        let bytes = match (bytes.starts_with(&GZIP), said) {
            (true, _) => uncompressed(&name, &bytes)?,
            (false, true) => {
                let what = "is named .gz but does not start as gzip does";
                return Err(Error::new(&name, Place::Byte(0), what, "rename it or compress it"));
            }
            (false, false) => bytes,
        };
        if bytes.len() as u64 > MOST {
            let what = format!("has more than {MOST} bytes");
            return Err(Error::new(&name, Place::Whole, what, "thin out the points"));
        }
        Ok(Self { name, bytes })
    }

    pub(super) fn raw(&self) -> Result<Raw, Error> {
        let lower = self.name.to_ascii_lowercase();
        let stem = lower.strip_suffix(".gz").unwrap_or(&lower);
        let ends = |extension: &str| stem.ends_with(extension);
        match () {
            () if ends(".ply") || self.bytes.starts_with(b"ply") => {
                ply::read(&self.name, &self.bytes)
            }
            () if ends(".obj") => obj::read(&self.name, &self.bytes),
            () if ends(".xyz") => xyz::read(&self.name, &self.bytes),
            () => {
                let what = "is of no known format";
                let remedy = "name it .ply, .obj or .xyz, with .gz if it is compressed";
                Err(Error::new(&self.name, Place::Whole, what, remedy))
            }
        }
    }
}

fn uncompressed(name: &str, bytes: &[u8]) -> Result<Vec<u8>, Error> {
    let mut out = Vec::new();
    let most = (RATIO * bytes.len() as u64).clamp(SMALL, MOST);
    match MultiGzDecoder::new(bytes).take(most + 1).read_to_end(&mut out) {
        Ok(length) if length as u64 > most => {
            let what = format!("has more than {most} bytes in {} of gzip", bytes.len());
            Err(Error::new(name, Place::Whole, what, "uncompress it if it is what it seems"))
        }
        Ok(_) => Ok(out),
        Err(e) => {
            let what = format!("is broken as gzip after that byte: {e}");
            Err(Error::new(name, Place::Byte(out.len()), what, "get the file again"))
        }
    }
}
