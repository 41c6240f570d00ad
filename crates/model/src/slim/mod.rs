//! SLIM surfaces: sparse low-degree implicits, balls with a quadric each, blended where they overlap
//! (\[stoll2006\] Section 5.1.1).
//!
//! | module | holds |
//! |---|---|
//! | `fit` | the quadric of one ball, and the largest ball whose quadric is near enough |
//! | `cover` | balls until every point lies well within one |
//! | `file` | the format `.slim` |

mod cover;
mod file;
mod fit;

use glam::DVec3;
use zeroset_raycast::{
    Blending, Bound, Error, HalfSpace, Patch, Patches, Progress, Quadric, Sides,
};

use crate::points::Cloud;

pub use file::FileError;

/// How far, in radii of its ball, a hit may lie behind another of the same sheet. With 0.02 the balls are seen
/// as scales, with 0.25 there are still jumps, and from here to 2 pictures are the same.
const OFFSET: f64 = 0.5;

/// How a surface is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The error of a ball's quadric, at most, in diagonals of the points' box: the weighted root mean square
    /// of the distances of its points.
    pub error: f64,
    /// A point within so many radii of a ball's centre is covered by it.
    pub cover: f64,
    /// The order in which points become centres.
    pub seed: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self { error: 1e-4, cover: 0.82, seed: 0 }
    }
}

/// A ball with its quadric, which is about the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Its centre.
    pub centre: DVec3,
    /// Its radius.
    pub radius: f64,
    /// f, about the centre; positive outside.
    pub quadric: Quadric,
    /// What is left of it where the surface has an edge, about the centre.
    pub clip: Option<HalfSpace>,
}

/// Balls whose blended quadrics are a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slim {
    /// The balls.
    pub balls: Vec<Ball>,
}

/// What came of a build.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Root mean square of the points' distances from the blended surface, in diagonals.
    pub rms: f64,
    /// The greatest of them.
    pub worst: f64,
    /// Balls that a point lies in, on average.
    pub overlap: f64,
}

impl Slim {
    /// Balls for points, in parallel; the result does not depend on the threads. `progress` counts the points
    /// that are covered.
    ///
    /// # Errors
    /// If the work was asked to stop.
    pub fn build(cloud: &Cloud, options: &Options, progress: &Progress) -> Result<Self, Error> {
        cover::balls(cloud, options, progress).map(|balls| Self { balls })
    }

    /// The surface that the methods cast rays at.
    ///
    /// # Errors
    /// If there are no balls, or they are not finite.
    pub fn patches(&self) -> Result<Patches, Error> {
        let patch = |ball: &Ball| Patch {
            origin: ball.centre,
            quadric: ball.quadric,
            bound: Bound::Ball { centre: DVec3::ZERO, radius: ball.radius },
            clip: ball.clip,
        };
        let patches = self.balls.iter().map(patch).collect();
        Patches::new(patches, Sides::Front, Blending::Weighted { offset: OFFSET })
    }

    /// How far the points are from the surface.
    pub fn summary(&self, cloud: &Cloud) -> Summary {
        cover::summary(&self.balls, cloud)
    }
}
