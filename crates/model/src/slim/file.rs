//! The format `.slim`, described in `docs/slim-file.md`.

use std::fs;
use std::path::Path;

use glam::{DMat3, DVec3};
use zeroset_raycast::{HalfSpace, Quadric};

use super::{Ball, Slim};
use crate::checksum::checksum;

/// Why a file is no surface.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FileError {
    /// It cannot be read, or written.
    #[error("{file}: {why}")]
    Unusable {
        /// The file.
        file: String,
        /// What the system says.
        why: String,
    },
    /// It is not what was written.
    #[error("{file} is no SLIM surface: {why}")]
    Malformed {
        /// The file.
        file: String,
        /// What is wrong.
        why: String,
    },
}

const MAGIC: &[u8; 8] = b"zeroslim";
const VERSION: u32 = 1;
/// Magic, version, a word that is 0, count.
const HEADER: usize = 24;
/// Centre, radius, six of A, b, c, and normal and offset of the half-space.
const NUMBERS: usize = 18;

impl Slim {
    /// Writes a file.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        let mut bytes = Vec::with_capacity(HEADER + self.balls.len() * NUMBERS * 8 + 4);
        bytes.extend(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(0_u32.to_le_bytes());
        bytes.extend((self.balls.len() as u64).to_le_bytes());
        for ball in &self.balls {
            for number in numbers(ball) {
                bytes.extend(number.to_le_bytes());
            }
        }
        bytes.extend(checksum(&bytes).to_le_bytes());
        fs::write(path, bytes).map_err(|error| FileError::Unusable {
            file: path.display().to_string(),
            why: format!("cannot be written: {error}"),
        })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// If it cannot be read, or is not as it was written.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let file = path.display().to_string();
        let bytes = fs::read(path).map_err(|error| FileError::Unusable {
            file: file.clone(),
            why: format!("cannot be read: {error}"),
        })?;
        parse(&bytes).map_err(|why| FileError::Malformed { file, why })
    }
}

fn numbers(ball: &Ball) -> [f64; NUMBERS] {
    let Ball { centre, radius, quadric: Quadric { a, b, c }, clip } = *ball;
    let [x, y, z] = [a.x_axis, a.y_axis, a.z_axis];
    let clip = clip.unwrap_or(HalfSpace { normal: DVec3::ZERO, offset: 0.0 });
    let n = clip.normal;
    [
        centre.x,
        centre.y,
        centre.z,
        radius,
        x.x,
        y.y,
        z.z,
        x.y,
        y.z,
        z.x,
        b.x,
        b.y,
        b.z,
        c,
        n.x,
        n.y,
        n.z,
        clip.offset,
    ]
}

fn parse(bytes: &[u8]) -> Result<Slim, String> {
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes(b.try_into().unwrap()));
    if bytes.get(..8) != Some(MAGIC) {
        return Err("it does not begin as one".into());
    }
    match word(8) {
        Some(VERSION) => {}
        version => return Err(format!("its version is {}, not {VERSION}", version.unwrap_or(0))),
    }
    let count = bytes.get(16..24).map(|b| u64::from_le_bytes(b.try_into().unwrap())).unwrap_or(0);
    let body = bytes.len().saturating_sub(HEADER + 4);
    if u64::try_from(body).ok() != count.checked_mul(NUMBERS as u64 * 8) {
        return Err(format!(
            "{count} balls take {} bytes each, but there are {body} bytes of them",
            NUMBERS * 8
        ));
    }
    let (checked, sum) = bytes.split_at(bytes.len() - 4);
    if sum != checksum(checked).to_le_bytes() {
        return Err("its checksum is wrong: it was changed".into());
    }
    let ball = |bytes: &[u8]| {
        let n: Vec<f64> =
            bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
        let normal = DVec3::new(n[14], n[15], n[16]);
        let columns = [
            DVec3::new(n[4], n[7], n[9]),
            DVec3::new(n[7], n[5], n[8]),
            DVec3::new(n[9], n[8], n[6]),
        ];
        Ball {
            centre: DVec3::new(n[0], n[1], n[2]),
            radius: n[3],
            quadric: Quadric {
                a: DMat3::from_cols(columns[0], columns[1], columns[2]),
                b: DVec3::new(n[10], n[11], n[12]),
                c: n[13],
            },
            clip: (normal != DVec3::ZERO).then_some(HalfSpace { normal, offset: n[17] }),
        }
    };
    let balls = checked[HEADER..].chunks_exact(NUMBERS * 8).map(ball).collect();
    Ok(Slim { balls })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slim() -> Slim {
        let ball = |i: u32| Ball {
            centre: DVec3::new(f64::from(i), -0.5, 1e-9),
            radius: 0.25,
            quadric: Quadric {
                a: DMat3::from_cols(
                    DVec3::new(1.0, 2.0, 3.0),
                    DVec3::new(2.0, 4.0, 5.0),
                    DVec3::new(3.0, 5.0, 6.0),
                ),
                b: DVec3::new(7.0, 8.0, 9.0),
                c: -0.1,
            },
            clip: (i == 1).then_some(HalfSpace { normal: DVec3::X, offset: 0.5 }),
        };
        Slim { balls: (0..3).map(ball).collect() }
    }

    #[test]
    fn what_is_written_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.slim");
        slim().write(&path).unwrap();
        assert_eq!(Slim::read(&path).unwrap(), slim());
        assert!(Slim::read(folder.path()).unwrap_err().to_string().contains("cannot be read"));
    }

    #[test]
    fn every_change_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.slim");
        slim().write(&path).unwrap();
        let bytes = fs::read(&path).unwrap();
        for i in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[i] ^= 0x10;
            assert!(parse(&changed).is_err(), "byte {i}");
            assert!(parse(&bytes[..i]).is_err(), "cut at {i}");
        }
        let mut huge = bytes.clone();
        huge[16..24].fill(0xff);
        assert!(parse(&huge).unwrap_err().contains("bytes each"));
    }
}
