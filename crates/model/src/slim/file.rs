//! The file of a SLIM surface: `docs/slim-file.md`.

use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;

use glam::{DMat3, DVec3};
use zeroset_raycast::{HalfSpace, Quadric};

use super::{Ball, Error, Slim};
use crate::checksum::checksum;

/// The first bytes. The line ends are broken by whatever takes the file for text.
const MAGIC: [u8; 8] = *b"\x89SLIM\r\n\x1a";
const VERSION: u32 = 1;
/// Bytes before the balls: magic, version, count and offset.
const HEADER: usize = 8 + 4 + 8 + 8;
/// Numbers of every ball: centre, radius, A, b, c.
const NUMBERS: usize = 3 + 1 + 6 + 3 + 1;
/// Bytes of the checksum at the end.
const CHECKSUM: usize = 4;
/// The most bytes that are read.
const MOST: u64 = 1 << 32;

impl Slim {
    /// Writes the surface to a file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        // Beside it first: what is there already stays until the new one is whole.
        let part = path.with_added_extension("part");
        let written = File::create(&part).and_then(|mut file| file.write_all(&self.to_bytes()));
        let written = written.and_then(|()| std::fs::rename(&part, path));
        written.map_err(|e| refused(path, format!("cannot be written: {e}; choose another place")))
    }

    /// Reads a surface from a file.
    ///
    /// # Errors
    /// If the file cannot be read, is none of these files, is broken or cut short, or holds numbers that make
    /// no surface.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let mut bytes = Vec::new();
        let read = File::open(path).and_then(|file| file.take(MOST).read_to_end(&mut bytes));
        read.map_err(|e| refused(path, format!("cannot be read: {e}; check the path")))?;
        Self::from_bytes(&bytes).map_err(|what| refused(path, what))
    }

    /// The content of the file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(HEADER + self.balls.len() * (1 + 8 * NUMBERS) + CHECKSUM);
        out.extend(MAGIC);
        out.extend(VERSION.to_le_bytes());
        out.extend((self.balls.len() as u64).to_le_bytes());
        out.extend(self.offset.to_le_bytes());
        for ball in &self.balls {
            let Ball { centre, radius, quadric: Quadric { a, b, c }, clip } = *ball;
            let [x, y, z] = [a.x_axis, a.y_axis, a.z_axis];
            out.push(u8::from(clip.is_some()));
            let mut put =
                |numbers: &[f64]| numbers.iter().for_each(|n| out.extend(n.to_le_bytes()));
            put(&centre.to_array());
            put(&[radius, x.x, y.y, z.z, x.y, y.z, z.x]);
            put(&b.to_array());
            put(&[c]);
            if let Some(HalfSpace { normal, offset }) = clip {
                put(&normal.to_array());
                put(&[offset]);
            }
        }
        let sum = checksum(&out);
        out.extend(sum.to_le_bytes());
        out
    }

    /// The surface of a file's content, or what is wrong with it.
    pub(crate) fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        if !bytes.starts_with(&MAGIC) {
            return Err("is no SLIM surface: it does not start as one; build it anew".into());
        }
        if bytes.len() < HEADER + CHECKSUM {
            return Err(format!("is cut short: it has {} bytes; {AGAIN}", bytes.len()));
        }
        let mut rest = Rest { bytes: &bytes[MAGIC.len()..bytes.len() - CHECKSUM] };
        let version = u32::from_le_bytes(rest.take()?);
        if version != VERSION {
            return Err(format!("has version {version} where {VERSION} is known; build it anew"));
        }
        // Sizes come before sums: a count that is wrong names itself.
        let count = u64::from_le_bytes(rest.take()?);
        let offset = rest.number()?;
        let most = rest.bytes.len() / (1 + 8 * NUMBERS);
        if count > most as u64 {
            return Err(format!(
                "says {count} balls and has room for {most}: it is cut short; {AGAIN}"
            ));
        }
        let end = bytes.len() - CHECKSUM;
        let [written, found] =
            [u32::from_le_bytes(Rest { bytes: &bytes[end..] }.take()?), checksum(&bytes[..end])];
        if written != found {
            return Err(format!(
                "has the checksum {written:08x} and its content {found:08x}; {AGAIN}"
            ));
        }
        let balls = (0..count).map(|_| rest.ball()).collect::<Result<Vec<_>, _>>()?;
        if !rest.bytes.is_empty() {
            return Err(format!("has {} bytes after its {count} balls; {AGAIN}", rest.bytes.len()));
        }
        Self::new(balls, offset).map_err(|e| format!("makes no surface: {e}; build it anew"))
    }
}

const AGAIN: &str = "copy it again or build it anew";

fn refused(path: &Path, what: String) -> Error {
    Error::File { file: path.display().to_string(), what }
}

/// Bytes that are not read yet.
struct Rest<'a> {
    bytes: &'a [u8],
}

impl Rest<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (first, rest) = self.bytes.split_first_chunk::<N>().ok_or_else(|| {
            format!("ends within a ball: {} bytes are left; {AGAIN}", self.bytes.len())
        })?;
        self.bytes = rest;
        Ok(*first)
    }

    fn number(&mut self) -> Result<f64, String> {
        Ok(f64::from_le_bytes(self.take()?))
    }

    fn vector(&mut self) -> Result<DVec3, String> {
        Ok(DVec3::new(self.number()?, self.number()?, self.number()?))
    }

    fn ball(&mut self) -> Result<Ball, String> {
        let [kind] = self.take()?;
        let centre = self.vector()?;
        let radius = self.number()?;
        let [squares, mixed] = [self.vector()?, self.vector()?];
        let a = DMat3::from_cols(
            DVec3::new(squares.x, mixed.x, mixed.z),
            DVec3::new(mixed.x, squares.y, mixed.y),
            DVec3::new(mixed.z, mixed.y, squares.z),
        );
        let quadric = Quadric { a, b: self.vector()?, c: self.number()? };
        let clip = match kind {
            0 => None,
            1 => Some(HalfSpace { normal: self.vector()?, offset: self.number()? }),
            _ => return Err(format!("has a ball of kind {kind} where 0 and 1 are known; {AGAIN}")),
        };
        Ok(Ball { centre, radius, quadric, clip })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of a clip: normal and offset.
    const CLIP: usize = 3 + 1;

    fn surface() -> Slim {
        let a = DMat3::from_cols_array(&[1.0, 4.0, 6.0, 4.0, 2.0, 5.0, 6.0, 5.0, -3.0]);
        let quadric = Quadric { a, b: DVec3::new(0.1, -0.2, 1e-300), c: -0.5 };
        let whole = Ball { centre: DVec3::new(1e9, -2.0, 3.0), radius: 0.25, quadric, clip: None };
        let clip = Some(HalfSpace { normal: DVec3::new(0.0, 0.6, -0.8), offset: -0.125 });
        Slim::new(vec![whole, Ball { clip, ..whole }, whole], 0.5).unwrap()
    }

    /// Content with a checksum that fits.
    fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
        let end = bytes.len() - CHECKSUM;
        let sum = checksum(&bytes[..end]);
        bytes[end..].copy_from_slice(&sum.to_le_bytes());
        bytes
    }

    #[test]
    fn what_is_written_is_read() {
        let slim = surface();
        let bytes = slim.to_bytes();
        assert_eq!(bytes.len(), HEADER + 3 * (1 + 8 * NUMBERS) + 8 * CLIP + CHECKSUM);
        assert_eq!(Slim::from_bytes(&bytes).unwrap(), slim);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("three.slim");
        slim.write(&path).unwrap();
        assert_eq!(Slim::read(&path).unwrap(), slim);
        let missing = Slim::read(&folder.path().join("none.slim")).unwrap_err().to_string();
        assert!(missing.contains("none.slim") && missing.contains("cannot be read"), "{missing}");
    }

    #[test]
    fn every_byte_counts() {
        let bytes = surface().to_bytes();
        for i in 0..bytes.len() {
            assert!(Slim::from_bytes(&bytes[..i]).is_err(), "cut at {i}");
            let mut wrong = bytes.clone();
            wrong[i] ^= 0x10;
            assert!(Slim::from_bytes(&wrong).is_err(), "byte {i}");
        }
    }

    #[test]
    fn messages_say_what_is_wrong() {
        let bytes = surface().to_bytes();
        let said = |change: &dyn Fn(&mut Vec<u8>)| {
            let mut bytes = bytes.clone();
            change(&mut bytes);
            Slim::from_bytes(&sealed(bytes)).unwrap_err()
        };
        let with = |at: usize, new: &[u8]| {
            said(&|bytes: &mut Vec<u8>| bytes[at..at + new.len()].copy_from_slice(new))
        };
        assert!(with(0, b"x").contains("no SLIM surface"));
        assert!(with(8, &7u32.to_le_bytes()).contains("version 7"));
        // A count that would take 2^70 bytes is refused before any is allocated.
        assert!(with(12, &u64::MAX.to_le_bytes()).contains("has room for 3"));
        assert!(with(12, &2u64.to_le_bytes()).contains("bytes after its 2 balls"));
        assert!(with(12, &0u64.to_le_bytes()).contains("bytes after its 0 balls"));
        assert!(with(20, &f64::NAN.to_le_bytes()).contains("offset"));
        let last = HEADER + 2 * (1 + 8 * NUMBERS) + 8 * CLIP;
        assert!(with(last, &[1]).contains("ends within a ball"));
        assert!(with(HEADER, &[9]).contains("kind 9"));
        assert!(with(HEADER + 25, &0f64.to_le_bytes()).contains("patch 0 has a ball whose radius"));
        let mut broken = bytes.clone();
        broken[HEADER + 60] ^= 1;
        assert!(Slim::from_bytes(&broken).unwrap_err().contains("checksum"));
        assert!(Slim::from_bytes(&bytes[..20]).unwrap_err().contains("cut short"));
    }
}
