//! What rays are cut by: common axes, or their own ranges; and the domain's box.

use zeroset_ia::{Interval, Scalar, Set};
use zeroset_raycast::{Domain, Ray};

/// What the rays of a packet have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// Slabs of the domain's box along a common axis.
    Slabs(Axis),
    /// Each ray's own part in the domain.
    Rays,
}

/// A [`Cut`] known when code is compiled, so that the loop over pieces has no branch for it.
pub(super) trait Cutting: Copy {
    /// Are the pieces slabs?
    const SLABS: bool;
}

/// [`Cut::Slabs`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Slabs;

/// [`Cut::Rays`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Rays;

impl Cutting for Slabs {
    const SLABS: bool = true;
}
impl Cutting for Rays {
    const SLABS: bool = false;
}

/// A common axis and direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Axis {
    /// K: 0, 1 or 2.
    pub k: usize,
    /// Does K increase along the rays?
    pub forward: bool,
}

impl Axis {
    /// The dominant axis of a direction and its sign.
    #[inline(always)]
    pub(super) fn of(ray: Ray) -> Self {
        let [axis] = Self::of_all(&ray.direction.to_array().map(|x| [f64::from(x)]));
        axis
    }

    /// The same for many directions, in a loop that becomes vectors.
    #[inline(always)]
    pub(super) fn of_all<const N: usize>(direction: &[[f64; N]; 3]) -> [Self; N] {
        let [x, y, z] = direction;
        // 2 k, and 1 more if it increases.
        let mut codes = [0_u64; N];
        for i in 0..N {
            let [dx, dy, dz] = [x[i].abs(), y[i].abs(), z[i].abs()];
            let rest = if dy >= dz { 2 + u64::from(y[i] > 0.0) } else { 4 + u64::from(z[i] > 0.0) };
            codes[i] = if dx >= dy && dx >= dz { u64::from(x[i] > 0.0) } else { rest };
        }
        codes.map(|code| Self { k: (code >> 1) as usize, forward: code & 1 == 1 })
    }

    /// K, and U and V in cyclic order.
    pub(super) fn all(self) -> [usize; 3] {
        [self.k, (self.k + 1) % 3, (self.k + 2) % 3]
    }
}

/// The domain's box, rounded outward to what a march's scalar type can represent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    ends: [[f64; 2]; 3],
    /// How far it goes, rounded up, by axis.
    lengths: [f64; 3],
    /// Depths at which slabs are about as thin as coordinates are rounded, by axis.
    finest: [u32; 3],
    /// How finely coordinates are rounded, at most.
    resolution: f64,
}

impl Bounds {
    pub(super) fn new<S: Scalar>(domain: &Domain) -> Self {
        let ends = [0, 1, 2]
            .map(|axis| S::enclose_range(domain.min[axis], domain.max[axis]).map(S::to_f64));
        let lengths = ends.map(|[lo, hi]| (Interval::<_, Set>::point(hi) - Interval::point(lo)).hi);
        let largest = ends.iter().flatten().map(|x| x.abs()).fold(0.0, f64::max);
        let epsilon = if size_of::<S>() == 4 { f64::from(f32::EPSILON) } else { f64::EPSILON };
        let resolution = 4.0 * epsilon * largest;
        let finest = ends.map(|[lo, hi]| ((hi - lo) / resolution).log2() as u32);
        Self { ends, lengths, finest, resolution }
    }

    /// The box.
    pub(super) fn ranges<S: Scalar>(&self) -> [[S; 2]; 3] {
        self.ends.map(|ends| ends.map(S::from_f64))
    }

    /// Where a march along an axis starts.
    pub(super) fn start(&self, axis: Axis) -> f64 {
        self.ends[axis.k][if axis.forward { 0 } else { 1 }]
    }

    /// The depth beyond which slabs gain nothing.
    pub(super) fn finest(&self, k: usize) -> u32 {
        self.finest[k]
    }

    /// The width below which pieces gain nothing.
    pub(super) fn resolution(&self) -> f64 {
        self.resolution
    }

    /// How far it goes.
    pub(super) fn length(&self, axis: Axis) -> f64 {
        self.lengths[axis.k]
    }
}
