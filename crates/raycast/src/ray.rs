//! Rays, and sets of rays.

use glam::{DVec3, Vec3};
use zeroset_ia::{Interval, Set};

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

    /// A box that contains the points over a closed range of t.
    pub fn over(self, [a, b]: [f64; 2]) -> [Interval<f64, Set>; 3] {
        let (o, d) = (self.origin.as_dvec3(), self.direction.as_dvec3());
        let t = Interval::new(a, b);
        std::array::from_fn(|axis| Interval::point(o[axis]) + t * Interval::point(d[axis]))
    }

    /// Are all numbers finite, and is there a direction? Methods answer `miss` for other rays. Without
    /// branches, so that a loop over rays becomes vectors.
    #[inline(always)]
    pub fn is_valid(self) -> bool {
        let finite = self.origin.is_finite_mask() & self.direction.is_finite_mask();
        finite.all() & self.direction.cmpne(Vec3::ZERO).any()
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
    ///
    /// # Panics
    /// If there are not so many.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, Domain};

    #[test]
    fn valid_rays_are_finite_and_have_a_direction() {
        let good = Ray::new(Vec3::ZERO, Vec3::new(0.0, 1e-45, 0.0));
        assert!(good.is_valid());
        for bad in [0.0, f32::NAN, f32::INFINITY] {
            assert!(!Ray { direction: Vec3::new(bad, 0.0, -0.0), ..good }.is_valid(), "{bad}");
        }
        for bad in [f32::NAN, f32::NEG_INFINITY] {
            assert!(!Ray { origin: Vec3::new(0.0, 0.0, bad), ..good }.is_valid(), "{bad}");
        }
    }

    #[test]
    fn t_counts_the_direction_as_given() {
        let ray = Ray::new(Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.0, -2.0, 0.5));
        assert_eq!(ray.at(4.0), DVec3::new(1.0, -6.0, 5.0));
    }

    #[test]
    fn views_count_row_by_row_from_the_top() {
        let domain = Domain::new(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap();
        let view = View::new(Camera::facing(&domain), 3, 2);
        let rays = Rays::View(&view);
        assert_eq!((rays.len(), rays.is_empty()), (6, false));
        assert_eq!(rays.get(4), view.ray(1, 1));
        assert_eq!(rays.range(), [0.0, f64::INFINITY]);

        let batch = RayBatch::new((0..6).map(|i| rays.get(i)).collect());
        let listed = Rays::Batch(&batch);
        assert!((0..6).all(|i| listed.get(i) == rays.get(i)));
        assert_eq!(listed.range(), rays.range());
        assert!(Rays::Batch(&RayBatch::new(Vec::new())).is_empty());
    }
}
