//! The domain, for boxes.

use zeroset_ia::{Packet, Scalar};
use zeroset_raycast::Domain;

/// The domain's box and ball in a scalar's numbers, rounded so that no point is lost.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Region<S> {
    pub bounds: [[S; 2]; 3],
    pub ball: Option<Ball<S>>,
}

/// All points no farther from a centre, which is enclosed, than the root of `squared`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball<S> {
    pub centre: [[S; 2]; 3],
    pub squared: S,
}

impl<S: Scalar> Region<S> {
    pub(crate) fn new(domain: &Domain) -> Self {
        let bounds = [0, 1, 2].map(|axis| S::enclose_range(domain.min[axis], domain.max[axis]));
        let ball = domain.ball.map(|radius| {
            let centre = domain.centre();
            let centre = [0, 1, 2].map(|axis| {
                // A sum, halved: one rounding.
                S::enclose_range(centre[axis].next_down(), centre[axis].next_up())
            });
            let [_, squared] = S::enclose_range(0.0, (radius * radius).next_up());
            Ball { centre, squared }
        });
        Self { bounds, ball }
    }
}

/// A box, an axis after the other.
pub(crate) type Boxes<R> = [[R; 2]; 3];

impl<S: Scalar> Region<S> {
    /// Cuts boxes with the region's box. Gives what is left, the lanes where something is, and those where
    /// nothing was cut away.
    #[inline(always)]
    pub(crate) fn cut<R: Packet<Scalar = S>>(&self, boxes: Boxes<R>) -> (Boxes<R>, u64, u64) {
        let (mut cut, mut meets, mut inside) = (boxes, u64::MAX, u64::MAX);
        for (ends, bounds) in cut.iter_mut().zip(self.bounds) {
            let [low, high] = [ends[0].splat(bounds[0]), ends[0].splat(bounds[1])];
            // Bounds are rounded outward: the next number inward is in the domain.
            inside &= low.lt(ends[0]) & ends[1].lt(high);
            *ends = [ends[0].max(low), ends[1].min(high)];
            meets &= ends[0].le(ends[1]);
        }
        if let Some(ball) = self.ball {
            meets &= ball.meets(&cut);
            // What is inside the ball is not told.
            inside = 0;
        }
        (cut, meets, inside)
    }
}

impl<S: Scalar> Ball<S> {
    /// The lanes whose box may have a point in the ball.
    #[inline(always)]
    fn meets<R: Packet<Scalar = S>>(&self, boxes: &Boxes<R>) -> u64 {
        let zero = boxes[0][0].splat(S::from_f64(0.0));
        let mut sum = zero;
        for (ends, centre) in boxes.iter().zip(self.centre) {
            let [low, high] = [zero.splat(centre[0]), zero.splat(centre[1])];
            let gap = ends[0].sub_down(high).max(low.sub_down(ends[1])).max(zero);
            sum = sum.add_down(gap.mul_down(gap));
        }
        sum.le(zero.splat(self.squared))
    }
}
