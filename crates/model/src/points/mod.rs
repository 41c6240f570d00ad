//! Points with normals, as scanners and files give them.
//!
//! | format | normals, first that there is |
//! |---|---|
//! | PLY: ascii, binary in either order of bytes | `nx ny nz`; the faces, by area; estimated |
//! | OBJ: `v`, `vn`, `f` | `vn` through the faces, or one to one; the faces, by area; estimated |
//! | XYZ: `x y z` or `x y z nx ny nz` a line, `#` comments | given; estimated |
//!
//! Each can be compressed by gzip. Normals of faces point where the face is seen counterclockwise.

mod axes;
mod error;
mod estimate;
mod faces;
mod obj;
mod ply;
mod raw;
mod source;
mod text;
mod xyz;

use std::path::Path;

use glam::DVec3;

pub use error::{Error, Place};
pub use raw::Dropped;

use raw::Raw;
use source::Source;

/// Points of a surface, all different, each with a normal.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cloud {
    /// The points.
    pub points: Vec<DVec3>,
    /// For each point the normal, of length 1, outwards.
    pub normals: Vec<DVec3>,
}

impl Cloud {
    /// The points of a file, with what was dropped.
    ///
    /// # Errors
    /// If the file cannot be read, is none of the formats, or has fewer than two points that can be used.
    pub fn read(path: &Path) -> Result<(Self, Dropped), Error> {
        Source::read(path)?.raw()?.cloud(&path.display().to_string())
    }

    /// The points of a file whose bytes are at hand: its name tells the format.
    ///
    /// # Errors
    /// As for [`Cloud::read`].
    pub fn parse(name: &str, bytes: Vec<u8>) -> Result<(Self, Dropped), Error> {
        Source::new(name.into(), bytes)?.raw()?.cloud(name)
    }

    /// Points with normals of any length; those without use are dropped.
    ///
    /// # Errors
    /// If there are not as many normals as points, or fewer than two points can be used.
    pub fn new(points: Vec<DVec3>, normals: Vec<DVec3>) -> Result<(Self, Dropped), Error> {
        if points.len() != normals.len() {
            let what = format!("{} points have {} normals", points.len(), normals.len());
            return Err(Error::new(MEMORY, Place::Whole, what, "give one a point"));
        }
        Raw { points, normals: Some(normals), ..Raw::default() }.cloud(MEMORY)
    }

    /// Points whose normals are estimated.
    ///
    /// # Errors
    /// If fewer than two points can be used.
    pub fn estimated(points: Vec<DVec3>) -> Result<(Self, Dropped), Error> {
        Raw { points, ..Raw::default() }.cloud(MEMORY)
    }

    /// The least and the greatest corner of the box of all points.
    pub fn corners(&self) -> [DVec3; 2] {
        let least = self.points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        [least, self.points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max)]
    }

    /// The diagonal of the box of all points, the unit of errors.
    pub fn diagonal(&self) -> f64 {
        let [least, most] = self.corners();
        (most - least).length()
    }
}

/// What messages call points that come from no file.
const MEMORY: &str = "the points";
