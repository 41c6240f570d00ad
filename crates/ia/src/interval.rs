//! Intervals over any real.

use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::range;
use crate::{Binary, Constant, Number, Real, Scalar, Unary};

/// How intervals treat what is not a bounded, non-empty interval.
pub trait Flavor: Copy + Debug + 'static {
    /// Are empty and unbounded intervals handled?
    const SET: bool;
}

/// Bounded, non-empty intervals only: the fastest form.
///
/// A precondition of its bounds: no operand is infinite or NaN, no divisor contains 0, and no
/// argument leaves a function's domain. A caller establishes it once, on the box that contains all
/// others: evaluated over [`Decorated`](crate::Decorated) intervals, every sub-value must be
/// [bounded](Interval::is_bounded_by) and defined; inclusion extends that to every smaller box.
#[derive(Clone, Copy, Debug)]
pub struct Raw;

/// Set-based intervals as in IEEE 1788: unbounded ones have infinite ends, the empty one is NaN at
/// both ends, and a function's value is its range over the part of the argument in its domain.
#[derive(Clone, Copy, Debug)]
pub struct Set;

impl Flavor for Raw {
    const SET: bool = false;
}
impl Flavor for Set {
    const SET: bool = true;
}

/// All numbers between `lo` and `hi`, in each lane of `R`.
///
/// If `R` is outward, every operation gives an interval that contains each exact result on members
/// of its operands, and never a larger one for smaller operands. The excess over the tightest such
/// interval is at most one unit in the last place an end for sums, products, quotients, squares and
/// square roots with nudged marks, none with embedded rounding, and one (`f32`) or two (`f64`) units
/// for elementary functions ([`Scalar::elementary`]) of moderate arguments and for integer powers.
/// Raw integer powers round each of their products.
#[derive(Clone, Copy, Debug)]
pub struct Interval<R, F = Raw> {
    /// Lower end.
    pub lo: R,
    /// Upper end.
    pub hi: R,
    flavor: PhantomData<F>,
}

impl<R: Real, F: Flavor> Interval<R, F> {
    /// The interval `[lo, hi]`.
    #[inline(always)]
    pub fn new(lo: R, hi: R) -> Self {
        Self { lo, hi, flavor: PhantomData }
    }

    /// The interval that holds `x` alone.
    #[inline(always)]
    pub fn point(x: R) -> Self {
        Self::new(x, x)
    }

    /// Lower and upper end.
    #[inline(always)]
    pub fn bounds(self) -> [R; 2] {
        [self.lo, self.hi]
    }

    /// The smallest interval that contains both operands ("convexHull").
    #[inline(always)]
    pub fn hull(self, other: Self) -> Self {
        let both = Self::new(self.lo.min(other.lo), self.hi.max(other.hi));
        if F::SET { both.or_where_empty(other, self).or_where_empty(self, other) } else { both }
    }

    /// The common members; of raw intervals, which must have some.
    #[inline(always)]
    pub fn intersection(self, other: Self) -> Self {
        let (lo, hi) = (self.lo.max(other.lo), self.hi.min(other.hi));
        if !F::SET {
            return Self::new(lo, hi);
        }
        let nan = lo.splat(R::Scalar::NAN);
        let common = Self::new(hi.select_lt(lo, nan, lo), hi.select_lt(lo, nan, hi));
        common.empty_where(self).empty_where(other)
    }

    /// Largest absolute value: `max(-lo, hi)`.
    #[inline(always)]
    fn magnitude(self) -> R {
        (-self.lo).max(self.hi)
    }

    /// Smallest absolute value: `max(lo, -hi, 0)`.
    #[inline(always)]
    fn mignitude(self) -> R {
        self.lo.max(-self.hi).max(zero(self.lo))
    }

    /// Applies a scalar function of bounds lane by lane.
    #[inline(always)]
    fn map(self, f: impl Fn([R::Scalar; 2]) -> [R::Scalar; 2]) -> Self {
        let [lo, hi] = R::map([self.lo, self.hi], f);
        Self::new(lo, hi)
    }

    /// `self^n` for `n >= 2` by products, each of which is rounded.
    #[inline(always)]
    fn products(self, n: u32) -> Self {
        if n.is_multiple_of(2) {
            let [lo, hi] = powers(self.mignitude(), self.magnitude(), n);
            return Self::new(lo, hi).empty_where(self);
        }
        // Odd powers increase: x^n = x |x|^(n-1), the even power rounded away from the result's end.
        let zero = zero(self.lo);
        let [down, up] = powers(self.lo.abs(), self.lo.abs(), n - 1);
        let lo = self.lo.mul_down(self.lo.select_lt(zero, up, down));
        let [down, up] = powers(self.hi.abs(), self.hi.abs(), n - 1);
        let hi = self.hi.mul_up(self.hi.select_lt(zero, down, up));
        Self::new(lo, hi)
    }

    /// `self^n` for `|n| >= 2` by products, as raw intervals have it.
    #[inline(always)]
    pub(crate) fn multiplied(self, n: i32) -> Self {
        let power = self.products(n.unsigned_abs());
        if n < 0 { Self::point(self.lo.splat(R::Scalar::from_f64(1.0))) / power } else { power }
    }

    /// Restores NaN at both ends where an operand was empty (min and max drop NaN).
    #[inline(always)]
    fn empty_where(self, x: Self) -> Self {
        if !F::SET {
            return self;
        }
        self.or_where_empty(x, Self::point(x.lo.splat(R::Scalar::NAN)))
    }

    /// `other` where `x` is empty.
    #[inline(always)]
    fn or_where_empty(self, x: Self, other: Self) -> Self {
        // No lower end is infinity; NaN is not below it.
        let infinity = x.lo.splat(R::Scalar::INFINITY);
        let lo = x.lo.select_lt(infinity, self.lo, other.lo);
        Self::new(lo, x.lo.select_lt(infinity, self.hi, other.hi))
    }
}

impl<S: Scalar, F: Flavor> Interval<S, F> {
    /// Does it contain no number?
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        self.lo.is_nan() || self.hi.is_nan()
    }

    /// Is `x` a member?
    #[inline(always)]
    pub fn contains(self, x: S) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Is 0 a member?
    #[inline(always)]
    pub fn contains_zero(self) -> bool {
        self.contains(zero(self.lo))
    }

    /// Does it have members, none of which exceeds `limit` in absolute value?
    ///
    /// The limit for [`Raw`] should be far below the largest number of `S`: 2^100 for `f32`.
    #[inline(always)]
    pub fn is_bounded_by(self, limit: f64) -> bool {
        -limit <= self.lo.to_f64() && self.hi.to_f64() <= limit
    }
}

/// 0 in the context of `x`.
#[inline(always)]
fn zero<R: Real>(x: R) -> R {
    x.splat(R::Scalar::from_f64(0.0))
}

/// A product that is not negative, once it is rounded down.
#[inline(always)]
fn nonnegative<R: Real>(product: R) -> R {
    if R::OUTWARD { product.max(zero(product)) } else { product }
}

/// `[a^n rounded down, b^n rounded up]` for `a, b >= 0`, `n >= 1`. Without closures, which would lose
/// the instruction set.
#[inline(always)]
fn powers<R: Real>(a: R, b: R, n: u32) -> [R; 2] {
    let (mut a, mut b) = (a, b);
    let mut rest = n >> n.trailing_zeros();
    for _ in 0..n.trailing_zeros() {
        (a, b) = (nonnegative(a.mul_down(a)), b.mul_up(b));
    }
    let (mut down, mut up) = (a, b);
    rest >>= 1;
    while rest > 0 {
        (a, b) = (nonnegative(a.mul_down(a)), b.mul_up(b));
        if rest & 1 == 1 {
            (down, up) = (nonnegative(down.mul_down(a)), up.mul_up(b));
        }
        rest >>= 1;
    }
    [down, up]
}

impl<R: Real, F: Flavor> Add for Interval<R, F> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.lo.add_down(o.lo), self.hi.add_up(o.hi))
    }
}

impl<R: Real, F: Flavor> Sub for Interval<R, F> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.lo.sub_down(o.hi), self.hi.sub_up(o.lo))
    }
}

impl<R: Real, F: Flavor> Neg for Interval<R, F> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.hi, -self.lo)
    }
}

impl<R: Real, F: Flavor> Mul for Interval<R, F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        if F::SET {
            let [lo, hi] = R::mul_bounds_unbounded(self.bounds(), o.bounds());
            Self::new(lo, hi).empty_where(self).empty_where(o)
        } else {
            let [lo, hi] = R::mul_bounds(self.bounds(), o.bounds());
            Self::new(lo, hi)
        }
    }
}

impl<R: Real, F: Flavor> Div for Interval<R, F> {
    type Output = Self;
    /// Each end is one quotient: the signs tell of which ends.
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let zero = zero(self.lo);
        // x / y = (-x) / (-y) makes the divisor positive; adding 0 makes -0 into +0 (d = 0 has no quotient).
        let a = zero.select_lt(o.hi, self.lo, -self.hi);
        let b = zero.select_lt(o.hi, self.hi, -self.lo);
        let c = zero.select_lt(o.hi, o.lo, -o.hi) + zero;
        let d = zero.select_lt(o.hi, o.hi, -o.lo);
        let lo = a.div_down(a.select_lt(zero, c, d));
        let hi = b.div_up(zero.select_lt(b, c, d));
        if !F::SET {
            return Self::new(lo, hi);
        }
        // 0 inside the divisor: everything, unless the dividend is 0 alone: then 0, as wide as any
        // smaller divisor makes it.
        let infinity = zero.splat(R::Scalar::INFINITY);
        let [down, up] = [zero.mul_down(zero), zero.mul_up(zero)];
        let low = a.select_lt(zero, -infinity, zero.select_lt(b, -infinity, down));
        let high = a.select_lt(zero, infinity, zero.select_lt(b, infinity, up));
        let around = Self::new(c.select_lt(zero, low, lo), c.select_lt(zero, high, hi));
        // Divisor 0 alone: nothing.
        let nan = zero.splat(R::Scalar::NAN);
        let lo = c.select_lt(zero, around.lo, zero.select_lt(d, around.lo, nan));
        let hi = c.select_lt(zero, around.hi, zero.select_lt(d, around.hi, nan));
        Self::new(lo, hi).empty_where(self)
    }
}

impl<R: Real, F: Flavor> Number for Interval<R, F> {
    #[inline(always)]
    fn constant(&self, c: &Constant) -> Self {
        let [lo, hi] = R::Scalar::enclose(c);
        Self::new(self.lo.splat(lo), self.lo.splat(hi))
    }

    #[inline(always)]
    fn scale(self, c: &Constant) -> Self {
        let [c_lo, c_hi] = R::Scalar::enclose(c);
        let zero = R::Scalar::from_f64(0.0);
        if c_lo != c_hi || F::SET && c_lo == zero {
            return self * self.constant(c);
        }
        // A point factor: its sign tells which end is which.
        let factor = self.lo.splat(c_lo);
        if c_lo < zero {
            Self::new(self.hi.mul_down(factor), self.lo.mul_up(factor))
        } else {
            Self::new(self.lo.mul_down(factor), self.hi.mul_up(factor))
        }
    }

    #[inline(always)]
    fn offset(self, c: &Constant) -> Self {
        self + self.constant(c)
    }

    #[inline(always)]
    fn sqr(self) -> Self {
        let (mig, mag) = (self.mignitude(), self.magnitude());
        Self::new(nonnegative(mig.mul_down(mig)), mag.mul_up(mag)).empty_where(self)
    }

    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        let one = Self::point(self.lo.splat(R::Scalar::from_f64(1.0)));
        match n {
            0 => one.empty_where(self),
            1 => self,
            2 => self.sqr(),
            -1 => one / self,
            _ if F::SET => self.map(|x| range::integer_power(x, n)),
            _ => self.multiplied(n),
        }
    }

    #[inline(always)]
    fn powc(self, c: &Constant) -> Self {
        let [lo, hi] = R::power_range(self.bounds(), c);
        Self::new(lo, hi)
    }

    #[inline(always)]
    fn unary(self, f: Unary) -> Self {
        match f {
            Unary::Abs => Self::new(self.mignitude(), self.magnitude()).empty_where(self),
            Unary::Floor => Self::new(self.lo.floor(), self.hi.floor()),
            Unary::Ceil => Self::new(self.lo.ceil(), self.hi.ceil()),
            Unary::Sqrt => {
                let zero = zero(self.lo);
                let lo = self.lo.max(zero).sqrt_down().max(zero);
                let root = Self::new(lo, self.hi.max(zero).sqrt_up());
                if !F::SET {
                    return root;
                }
                let nan = zero.splat(R::Scalar::NAN);
                let lo = self.hi.select_lt(zero, nan, root.lo);
                Self::new(lo, self.hi.select_lt(zero, nan, root.hi)).empty_where(self)
            }
            _ => {
                let [lo, hi] = R::unary_range(f, self.bounds());
                Self::new(lo, hi)
            }
        }
    }

    #[inline(always)]
    fn binary(self, f: Binary, o: Self) -> Self {
        match f {
            Binary::Min => {
                let min = Self::new(self.lo.min(o.lo), self.hi.min(o.hi));
                min.empty_where(self).empty_where(o)
            }
            Binary::Max => {
                let max = Self::new(self.lo.max(o.lo), self.hi.max(o.hi));
                max.empty_where(self).empty_where(o)
            }
            _ => {
                let [lo, hi] = R::binary_range(f, self.bounds(), o.bounds());
                Self::new(lo, hi)
            }
        }
    }
}
