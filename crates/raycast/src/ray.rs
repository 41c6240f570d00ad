//! Rays, and sets of rays.

use glam::{DVec3, Vec3};

use crate::View;

/// A ray: six single-precision numbers, taken as exact.
///
/// The point at t is `origin + t direction`, with the direction as given: it need not be a unit
/// vector, and t is counted in its length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where t = 0.
    pub origin: Vec3,
    /// What t counts.
    pub direction: Vec3,
}

impl Ray {
    /// The ray from `origin` along `direction`.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction }
    }

    /// The point at t, rounded to double precision.
    pub fn at(self, t: f64) -> DVec3 {
        self.origin.as_dvec3() + t * self.direction.as_dvec3()
    }

    /// Are all numbers finite, and is there a direction? Methods answer `miss` for other rays.
    pub fn is_valid(self) -> bool {
        self.origin.is_finite() && self.direction.is_finite() && self.direction != Vec3::ZERO
    }
}

/// Rays from anywhere, in any order.
#[derive(Clone, Debug, PartialEq)]
pub struct RayBatch {
    /// The rays.
    pub rays: Vec<Ray>,
    /// Roots count for t in this closed range.
    pub range: [f64; 2],
}

impl RayBatch {
    /// A batch whose roots count for t >= 0.
    pub fn new(rays: Vec<Ray>) -> Self {
        Self { rays, range: [0.0, f64::INFINITY] }
    }
}

/// The rays of a request. Methods that work in image space need a view.
#[derive(Clone, Copy, Debug)]
pub enum Rays<'a> {
    /// One ray a pixel, row by row from the top.
    View(&'a View),
    /// A list.
    Batch(&'a RayBatch),
}

impl Rays<'_> {
    /// How many rays.
    pub fn len(self) -> usize {
        match self {
            Self::View(view) => view.width * view.height,
            Self::Batch(batch) => batch.rays.len(),
        }
    }

    /// Are there none?
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// The ray of that index.
    pub fn get(self, index: usize) -> Ray {
        match self {
            Self::View(view) => view.ray(index % view.width, index / view.width),
            Self::Batch(batch) => batch.rays[index],
        }
    }

    /// The closed range of t in which roots count.
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::View(_) => [0.0, f64::INFINITY],
            Self::Batch(batch) => batch.range,
        }
    }
}
