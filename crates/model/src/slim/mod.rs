//! SLIM surfaces: balls, each with a quadric of its own, blended (\[stoll2006\] Section 5.1.1).
//!
//! [`build()`] makes one from a [`Cloud`](crate::points::Cloud) of points; [`Slim::write`] and
//! [`Slim::read`] keep it in a file (`docs/slim-file.md`); [`Slim::patches`] hands it to the methods.

mod build;
mod crease;
mod error;
mod file;
mod grow;
mod patch;
mod quadratic;
mod samples;
mod shuffle;
mod summary;

use glam::DVec3;
use zeroset_raycast::{Blending, Bound, HalfSpace, Patch, Patches, Quadric, Sides};

pub use build::{Edges, Options, build};
pub use error::Error;
pub use summary::Summary;

/// A ball with the surface in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The centre, in space; what follows is given about it.
    pub centre: DVec3,
    /// The radius.
    pub radius: f64,
    /// The surface, f > 0 outside. Built ones have f near the distance, in units of space.
    pub quadric: Quadric,
    /// Where the surface ends at an edge, if it does.
    pub clip: Option<HalfSpace>,
}

/// A surface in balls.
#[derive(Clone, Debug, PartialEq)]
pub struct Slim {
    balls: Vec<Ball>,
    offset: f64,
}

impl Slim {
    /// How far behind the first hit others are blended, in radii of a hit's ball. From 0.5 to 2 pictures are
    /// the same; below, scales show.
    pub const OFFSET: f64 = 0.5;

    /// A surface of these balls, blended as [`Blending::Weighted`] by `offset` says.
    ///
    /// # Errors
    /// If there are none, a ball has a number that is not finite or a radius that is not above 0, or the
    /// offset is negative.
    pub fn new(balls: Vec<Ball>, offset: f64) -> Result<Self, Error> {
        let slim = Self { balls, offset };
        slim.checked().map_err(|e| Error::Balls(e.to_string()))?;
        Ok(slim)
    }

    /// The balls.
    pub fn balls(&self) -> &[Ball] {
        &self.balls
    }

    /// The offset of blending, in radii.
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// What the methods cast: a patch a ball, about its centre, seen from the outside, blended.
    pub fn patches(&self) -> Patches {
        self.checked().expect("it was checked when it was made")
    }

    fn checked(&self) -> Result<Patches, zeroset_raycast::Error> {
        let patch = |ball: &Ball| Patch {
            origin: ball.centre,
            quadric: ball.quadric,
            bound: Bound::Ball { centre: DVec3::ZERO, radius: ball.radius },
            clip: ball.clip,
        };
        let blending = Blending::Weighted { offset: self.offset };
        Patches::new(self.balls.iter().map(patch).collect(), Sides::Front, blending)
    }
}

impl Ball {
    /// Does the surface count at a point given about the centre?
    pub fn contains(&self, x: DVec3) -> bool {
        let clip = self.clip.is_none_or(|h| h.normal.dot(x) <= h.offset);
        clip && x.length_squared() <= self.radius * self.radius
    }
}
