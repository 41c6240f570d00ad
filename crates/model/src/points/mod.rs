//! Points with normals, from files.

mod estimate;
mod obj;
mod ply;
mod xyz;

use std::fmt;
use std::fs;
use std::io::Read;
use std::path::Path;

use glam::DVec3;

/// Points with unit normals that point out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cloud {
    /// The points.
    pub points: Vec<DVec3>,
    /// One a point.
    pub normals: Vec<DVec3>,
}

/// Rows of a file that were left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dropped {
    /// Numbers that are not finite.
    pub not_finite: usize,
    /// Normals of length zero, as of vertices that no face uses.
    pub no_normal: usize,
    /// Points that were there before.
    pub repeated: usize,
}

/// Why a file gives no points.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PointsError {
    /// It cannot be read.
    #[error("cannot read {file}: {why}")]
    Unreadable {
        /// The file.
        file: String,
        /// What the system says.
        why: String,
    },
    /// It is not what it says.
    #[error("{file}, {place}: {why}")]
    Malformed {
        /// The file.
        file: String,
        /// A line or a byte.
        place: String,
        /// What was expected.
        why: String,
    },
    /// Too few points are left.
    #[error("{file} has {usable} usable points ({dropped}); a surface needs at least {LEAST}")]
    TooFew {
        /// The file.
        file: String,
        /// How many are left.
        usable: usize,
        /// Those that were left out.
        dropped: Dropped,
    },
}

/// The fewest points of a surface.
pub const LEAST: usize = 6;

/// What a file says, before it is looked at.
#[derive(Clone, Debug, Default, PartialEq)]
struct Raw {
    points: Vec<DVec3>,
    /// One a point, or none at all.
    normals: Vec<DVec3>,
    faces: Vec<[usize; 3]>,
}

/// Where a file is wrong, and how.
type Fault = (String, String);

impl fmt::Display for Dropped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { not_finite, no_normal, repeated } = self;
        write!(f, "left out: {not_finite} not finite, {no_normal} without a normal, ")?;
        write!(f, "{repeated} repeated")
    }
}

/// Reads points from a file: `.ply` (ascii or binary), `.obj`, or else lines of `x y z` or
/// `x y z nx ny nz`; each may be compressed by gzip.
///
/// Normals are those of the file; else those of its faces, weighted by area; else they are estimated.
///
/// # Errors
/// If it cannot be read, is malformed, or has too few usable points.
pub fn read(path: &Path) -> Result<(Cloud, Dropped), PointsError> {
    let file = path.display().to_string();
    let unreadable = |error: std::io::Error| PointsError::Unreadable {
        file: file.clone(),
        why: error.to_string(),
    };
    let mut bytes = fs::read(path).map_err(unreadable)?;
    let mut name = file.to_lowercase();
    if bytes.starts_with(&[0x1f, 0x8b]) {
        let mut plain = Vec::new();
        flate2::read::MultiGzDecoder::new(&bytes[..])
            .take(LONGEST)
            .read_to_end(&mut plain)
            .map_err(unreadable)?;
        bytes = plain;
        name = name.trim_end_matches(".gz").into();
    }
    let raw = if bytes.starts_with(b"ply") {
        ply::read(&bytes)
    } else if name.ends_with(".obj") {
        obj::read(&bytes)
    } else {
        xyz::read(&bytes)
    };
    let raw =
        raw.map_err(|(place, why)| PointsError::Malformed { file: file.clone(), place, why })?;
    let (cloud, dropped) = cloud(raw);
    if cloud.points.len() < LEAST {
        return Err(PointsError::TooFew { file, usable: cloud.points.len(), dropped });
    }
    Ok((cloud, dropped))
}

/// The most bytes that a compressed file may hold.
const LONGEST: u64 = 1 << 32;

/// The usable points of a file, with normals.
fn cloud(raw: Raw) -> (Cloud, Dropped) {
    let Raw { points, mut normals, faces } = raw;
    let has_faces = !faces.is_empty();
    if normals.is_empty() && has_faces {
        normals = of_faces(&points, &faces);
    }
    let is_estimated = normals.is_empty();
    let (mut cloud, mut dropped) = (Cloud::default(), Dropped::default());
    let mut seen = std::collections::HashSet::new();
    for (i, point) in points.iter().enumerate() {
        let normal = normals.get(i).copied().unwrap_or(DVec3::Z);
        if !(point.is_finite() && normal.is_finite()) {
            dropped.not_finite += 1;
        } else if normal.try_normalize().is_none() {
            dropped.no_normal += 1;
        } else if !seen.insert((*point + DVec3::ZERO).to_array().map(f64::to_bits)) {
            dropped.repeated += 1;
        } else {
            cloud.points.push(*point);
            cloud.normals.push(normal.normalize());
        }
    }
    if is_estimated && cloud.points.len() >= LEAST {
        cloud.normals = estimate::normals(&cloud.points);
    }
    (cloud, dropped)
}

/// The sums of the faces' normals by their area, unit or zero.
fn of_faces(points: &[DVec3], faces: &[[usize; 3]]) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; points.len()];
    for face in faces {
        let [a, b, c] = face.map(|i| points[i]);
        let normal = (b - a).cross(c - a);
        if normal.is_finite() {
            face.iter().for_each(|&i| normals[i] += normal);
        }
    }
    normals
}

impl Cloud {
    /// The diagonal of the points' box: what errors are counted in.
    pub fn diagonal(&self) -> f64 {
        let ends = self.points.iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |ends, p| {
            [ends[0].min(*p), ends[1].max(*p)]
        });
        (ends[1] - ends[0]).length()
    }
}

/// Reads a number of a text file.
fn number(word: &str) -> Option<f64> {
    word.parse().ok()
}

/// The lines of a text file, counted from 1, without comments.
fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, Vec<String>)> {
    bytes.split(|b| *b == b'\n').enumerate().map(|(i, line)| {
        let text = String::from_utf8_lossy(line);
        let words = text.split('#').next().unwrap_or_default();
        (i + 1, words.split_whitespace().map(String::from).collect())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(name: &str, bytes: &[u8]) -> (tempfile::TempDir, std::path::PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        (folder, path)
    }

    fn of(name: &str, text: &str) -> Result<(Cloud, Dropped), PointsError> {
        let (_folder, path) = write(name, text.as_bytes());
        read(&path)
    }

    const SIX: &str =
        "0 0 0 0 0 2\n1 0 0 0 0 1\n0 1 0 0 0 1\n1 1 0 0 0 1\n2 0 0 0 0 1\n2 1 0 0 0 1\n";

    #[test]
    fn bad_rows_are_left_out_and_counted() {
        let text = format!("# points\n{SIX}nan 0 0 0 0 1\n5 5 5 0 0 0\n1 0 0 0 0 1\n");
        let (cloud, dropped) = of("a.xyz", &text).unwrap();
        assert_eq!((cloud.points.len(), cloud.normals[0]), (6, DVec3::Z));
        assert_eq!(dropped, Dropped { not_finite: 1, no_normal: 1, repeated: 1 });
        assert!((cloud.diagonal() - 5.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn files_that_give_no_surface_say_why() {
        let told = |name: &str, text: &str| of(name, text).unwrap_err().to_string();
        assert!(told("a.xyz", "").contains("0 usable points"));
        assert!(told("a.xyz", "1 2 3 0 0 1\n").contains("1 usable points"));
        assert!(told("a.xyz", "1 2\n").contains("line 1"));
        assert!(told("a.xyz", &format!("{SIX}1 2 3\n")).contains("line 7"));
        assert!(told("a.obj", "v 1 2 x\n").contains("line 1"));
        assert!(told("a.obj", "v 1 2 3\nf 1 2 3\n").contains("line 2"));
        assert!(told("a.ply", "ply\nformat ascii 1.0\nelement vertex 9\n").contains("end_header"));
        assert!(read(Path::new("no such file")).unwrap_err().to_string().contains("cannot read"));
    }

    #[test]
    fn normals_come_from_faces_where_there_are_none() {
        let vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nv 9 9 9\n";
        let text = format!("{vertices}f 1 2 3 4\nf 2/1 5/2 6/3 -5/1\n");
        let (cloud, dropped) = of("a.obj", &text).unwrap();
        assert_eq!((cloud.points.len(), dropped.no_normal), (6, 1));
        assert!(cloud.normals.iter().all(|n| *n == DVec3::Z));
        let with = "vn 0 0 -1\nf 1//1 2//1 3//1\nf 4//1 5//1 6//1\n";
        let (cloud, _) = of("b.obj", &format!("{vertices}{with}")).unwrap();
        assert!(cloud.normals.iter().all(|n| *n == DVec3::NEG_Z));
    }

    #[test]
    fn compressed_files_are_the_same() {
        use std::io::Write;
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(SIX.as_bytes()).unwrap();
        let (_folder, path) = write("a.xyz.gz", &encoder.finish().unwrap());
        assert_eq!(read(&path).unwrap(), of("a.xyz", SIX).unwrap());
        let (_folder, path) = write("b.xyz.gz", &[0x1f, 0x8b, 8, 0, 0]);
        assert!(read(&path).unwrap_err().to_string().contains("cannot read"));
    }
}
