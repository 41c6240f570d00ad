//! The numbers with which beams are cast: intervals, or affine forms over (u, v, t).

use zeroset_ia::interval::Flavor;
use zeroset_ia::{Affine, Interval, Number, Real};

/// What a point of a beam depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Symbol {
    U,
    V,
    T,
}

/// A number that holds all values over a beam's piece.
pub(crate) trait Form<R: Real>: Number {
    /// Can it hold nothing, as where a function is undefined?
    const CAN_BE_EMPTY: bool;
    /// One value.
    fn point(x: R) -> Self;
    /// All values of a variable.
    fn variable(range: Interval<R>, symbol: Symbol) -> Self;
    /// All values that are at most so far away.
    fn widened(self, slack: R) -> Self;
    /// `self + t direction`, for t >= 0.
    fn along(self, direction: Self, t: Self) -> Self;
    /// What of it is between two numbers.
    fn cut(self, lo: R, hi: R) -> Self;
    /// The least and the greatest value, or less and more.
    fn range(&self) -> [R; 2];
}

impl<R: Real, F: Flavor> Form<R> for Interval<R, F> {
    const CAN_BE_EMPTY: bool = F::SET;

    #[inline(always)]
    fn point(x: R) -> Self {
        Self::point(x)
    }
    #[inline(always)]
    fn variable(range: Interval<R>, _: Symbol) -> Self {
        Self::new(range.lo, range.hi)
    }
    #[inline(always)]
    fn widened(self, slack: R) -> Self {
        Self::new(self.lo.sub_down(slack), self.hi.add_up(slack))
    }
    /// Two products, since t is not negative.
    #[inline(always)]
    fn along(self, direction: Self, t: Self) -> Self {
        let low = t.lo.mul_down(direction.lo).min(t.hi.mul_down(direction.lo));
        let high = t.lo.mul_up(direction.hi).max(t.hi.mul_up(direction.hi));
        Self::new(self.lo.add_down(low), self.hi.add_up(high))
    }
    #[inline(always)]
    fn cut(self, lo: R, hi: R) -> Self {
        Self::new(lo, hi)
    }
    #[inline(always)]
    fn range(&self) -> [R; 2] {
        self.bounds()
    }
}

/// An affine form over (u, v, t).
pub(crate) type AffineBeam<R> = Affine<R, 3>;

impl<R: Real> Form<R> for AffineBeam<R> {
    const CAN_BE_EMPTY: bool = false;

    #[inline(always)]
    fn point(x: R) -> Self {
        Self::between(Interval::point(x))
    }
    #[inline(always)]
    fn variable(range: Interval<R>, symbol: Symbol) -> Self {
        Self::variable(range, symbol as usize)
    }
    #[inline(always)]
    fn widened(self, slack: R) -> Self {
        self.widened(slack)
    }
    #[inline(always)]
    fn along(self, direction: Self, t: Self) -> Self {
        self + t * direction
    }
    #[inline(always)]
    fn cut(self, lo: R, hi: R) -> Self {
        self.within(Interval::new(lo, hi))
    }
    #[inline(always)]
    fn range(&self) -> [R; 2] {
        self.range.bounds()
    }
}
