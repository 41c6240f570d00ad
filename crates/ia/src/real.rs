//! Machine reals: what a float unit does, with marks for rounding.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::{Constant, range};

/// Machine arithmetic on one float or on several at once.
///
/// The operators round to nearest. [`down`](Real::down) and [`up`](Real::up) are *marks*: applied to
/// a result that has just been rounded to nearest, they give a value at most, or at least, as large
/// as the exact result. The fused forms (`add_down` and so on) do both; hardware with embedded
/// rounding overrides them.
///
/// In [`Number`](crate::Number) code written over a `Real`, every unmarked operation is exact.
pub trait Real:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// One lane of this real, with the same rounding; for a device's real, its constants.
    type Scalar: Scalar;
    /// Do the marks hold, so that a result may carry a proof?
    const OUTWARD: bool;

    /// The constant `c` in the context of `self` (lanes carry a token).
    fn splat(self, c: Self::Scalar) -> Self;
    /// The square root, to nearest.
    fn sqrt(self) -> Self;
    /// The absolute value: exact.
    fn abs(self) -> Self;
    /// The largest integer at most `self`: exact.
    fn floor(self) -> Self;
    /// The smaller operand; unspecified if one is NaN.
    fn min(self, other: Self) -> Self;
    /// The larger operand; unspecified if one is NaN.
    fn max(self, other: Self) -> Self;
    /// `x` where `self < other`, else `y` (so `y` where one is NaN).
    fn select_lt(self, other: Self, x: Self, y: Self) -> Self;
    /// A value at most as large as the exact result that was rounded to `self`.
    fn down(self) -> Self;
    /// A value at least as large as the exact result that was rounded to `self`.
    fn up(self) -> Self;
    /// Applies a scalar function to each lane. A real that has no lanes to look into, since it is a
    /// device's, must override the provided functions that use this.
    fn map<const N: usize, const M: usize>(
        x: [Self; N],
        f: impl Fn([Self::Scalar; N]) -> [Self::Scalar; M],
    ) -> [Self; M];

    /// The smallest integer at least `self`: exact.
    #[inline(always)]
    fn ceil(self) -> Self {
        -(-self).floor()
    }
    /// `self + o`, rounded down.
    #[inline(always)]
    fn add_down(self, o: Self) -> Self {
        (self + o).down()
    }
    /// `self + o`, rounded up.
    #[inline(always)]
    fn add_up(self, o: Self) -> Self {
        (self + o).up()
    }
    /// `self - o`, rounded down.
    #[inline(always)]
    fn sub_down(self, o: Self) -> Self {
        (self - o).down()
    }
    /// `self - o`, rounded up.
    #[inline(always)]
    fn sub_up(self, o: Self) -> Self {
        (self - o).up()
    }
    /// `self * o`, rounded down.
    #[inline(always)]
    fn mul_down(self, o: Self) -> Self {
        (self * o).down()
    }
    /// `self * o`, rounded up.
    #[inline(always)]
    fn mul_up(self, o: Self) -> Self {
        (self * o).up()
    }
    /// `self / o`, rounded down.
    #[inline(always)]
    fn div_down(self, o: Self) -> Self {
        (self / o).down()
    }
    /// `self / o`, rounded up.
    #[inline(always)]
    fn div_up(self, o: Self) -> Self {
        (self / o).up()
    }
    /// The square root, rounded down.
    #[inline(always)]
    fn sqrt_down(self) -> Self {
        self.sqrt().down()
    }
    /// The square root, rounded up.
    #[inline(always)]
    fn sqrt_up(self) -> Self {
        self.sqrt().up()
    }
    /// The least and the greatest of `a[i] * b[j]`, rounded outward: the interval product.
    ///
    /// The default rounds the extreme products, not each of the four.
    #[inline(always)]
    fn mul_bounds(a: [Self; 2], b: [Self; 2]) -> [Self; 2] {
        let p = a[0] * b[0];
        let q = a[0] * b[1];
        let r = a[1] * b[0];
        let s = a[1] * b[1];
        [p.min(q).min(r.min(s)).down(), p.max(q).max(r.max(s)).up()]
    }
    /// [`mul_bounds`](Real::mul_bounds) for ends that may be infinite: 0 times anything is 0, as in the
    /// limit. NaN counts as 0.
    #[inline(always)]
    fn mul_bounds_unbounded(a: [Self; 2], b: [Self; 2]) -> [Self; 2] {
        let p = (a[0] * b[0]).zero_where_nan();
        let q = (a[0] * b[1]).zero_where_nan();
        let r = (a[1] * b[0]).zero_where_nan();
        let s = (a[1] * b[1]).zero_where_nan();
        [p.min(q).min(r.min(s)).down(), p.max(q).max(r.max(s)).up()]
    }
    /// The range of a function of one argument over an interval; not of those that are exact for ends.
    #[inline(always)]
    fn unary_range(f: crate::Unary, x: [Self; 2]) -> [Self; 2] {
        Self::map(x, |x| range::unary(f, x))
    }
    /// The range of a function of two arguments over two intervals; not of min and max.
    #[inline(always)]
    fn binary_range(f: crate::Binary, x: [Self; 2], y: [Self; 2]) -> [Self; 2] {
        Self::map([x[0], x[1], y[0], y[1]], |[a, b, c, d]| range::binary(f, [a, b], [c, d]))
    }
    /// The range of `x^c` over an interval, on the domain of [`Binary::Pow`](crate::Binary::Pow).
    #[inline(always)]
    fn power_range(x: [Self; 2], c: &Constant) -> [Self; 2] {
        let exponent = Self::Scalar::enclose(c);
        Self::map(x, |x| range::power(x, exponent))
    }
    /// `self`, or 0 where it is NaN.
    #[inline(always)]
    fn zero_where_nan(self) -> Self {
        let zero = self.splat(Self::Scalar::from_f64(0.0));
        // Minus its absolute value, every number lies below 1; NaN does not.
        let one = self.splat(Self::Scalar::from_f64(1.0));
        (-self.abs()).select_lt(one, self, zero)
    }
}

/// A real that is a single float: code over it may branch.
pub trait Scalar: Real<Scalar = Self> + PartialOrd {
    /// Positive infinity.
    const INFINITY: Self;
    /// Not a number.
    const NAN: Self;
    /// Nearest value of this type.
    fn from_f64(x: f64) -> Self;
    /// The enclosure of a constant; for a nearest type, twice the nearest value.
    fn enclose(c: &Constant) -> [Self; 2];
    /// The nearest value to a constant.
    fn nearest(c: &Constant) -> Self;
    /// The tightest enclosure of `[lo, hi]`; for a nearest type, the nearest values.
    fn enclose_range(lo: f64, hi: f64) -> [Self; 2];
    /// The value, exactly.
    fn to_f64(self) -> f64;
    /// `f(self)`, within 0.51 (`f32`) or one (`f64`) unit in the last place.
    fn elementary(self, f: crate::Unary) -> Self;
    /// `f(self, y)` for `atan2(self, y)`, `hypot` and `pow`, with the error of `elementary`.
    fn elementary2(self, f: crate::Binary, y: Self) -> Self;
    /// `self^n`, with the error of `elementary`.
    fn power(self, n: i32) -> Self;
    /// A lower bound of a result that carries the error of [`elementary`](Scalar::elementary).
    fn elementary_down(self) -> Self;
    /// An upper bound of a result that carries the error of [`elementary`](Scalar::elementary).
    fn elementary_up(self) -> Self;
    /// Is it NaN?
    #[inline(always)]
    fn is_nan(self) -> bool {
        self.to_f64().is_nan()
    }
}

/// A real whose lanes can be filled, read and masked. A mask has one bit a lane, lane 0 lowest.
pub trait Packet: Real {
    /// How many lanes, at most 64.
    const LANES: usize;
    /// A packet from a function of the lane, in the context of `self`.
    #[allow(clippy::wrong_self_convention)]
    fn from_fn(self, f: impl FnMut(usize) -> Self::Scalar) -> Self;
    /// The value in lane `i`.
    fn lane(self, i: usize) -> Self::Scalar;
    /// Where is `self < other`?
    fn lt(self, other: Self) -> u64;
    /// Where is `self <= other`?
    fn le(self, other: Self) -> u64;
    /// `x` where the mask's bit is set, else `y`.
    fn select(self, mask: u64, x: Self, y: Self) -> Self;
    /// Does work in code for the packet's instruction set, which a function that is not inlined has
    /// left. The closure, and what it calls, must be `#[inline(always)]`.
    fn region<T>(self, work: impl FnOnce() -> T) -> T;
}

macro_rules! scalar {
    ($float:ty) => {
        impl Real for $float {
            type Scalar = Self;
            const OUTWARD: bool = true;

            #[inline(always)]
            fn splat(self, c: Self) -> Self {
                c
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$float>::sqrt(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$float>::abs(self)
            }
            #[inline(always)]
            fn floor(self) -> Self {
                <$float>::floor(self)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            #[inline(always)]
            fn select_lt(self, other: Self, x: Self, y: Self) -> Self {
                if self < other { x } else { y }
            }
            #[inline(always)]
            fn down(self) -> Self {
                self.next_down()
            }
            #[inline(always)]
            fn up(self) -> Self {
                self.next_up()
            }
            #[inline(always)]
            fn map<const N: usize, const M: usize>(
                x: [Self; N],
                f: impl Fn([Self; N]) -> [Self; M],
            ) -> [Self; M] {
                f(x)
            }
        }

        impl Packet for $float {
            const LANES: usize = 1;

            #[inline(always)]
            fn from_fn(self, mut f: impl FnMut(usize) -> Self) -> Self {
                f(0)
            }
            #[inline(always)]
            fn lane(self, _: usize) -> Self {
                self
            }
            #[inline(always)]
            fn lt(self, other: Self) -> u64 {
                u64::from(self < other)
            }
            #[inline(always)]
            fn le(self, other: Self) -> u64 {
                u64::from(self <= other)
            }
            #[inline(always)]
            fn select(self, mask: u64, x: Self, y: Self) -> Self {
                if mask & 1 == 1 { x } else { y }
            }
            #[inline(always)]
            fn region<T>(self, work: impl FnOnce() -> T) -> T {
                work()
            }
        }
    };
}
scalar!(f32);
scalar!(f64);

macro_rules! forward_operators {
    ([$($bound:tt)*] $type:ty, |$a:ident, $b:ident| $add:expr, $sub:expr, $mul:expr, $div:expr, |$c:ident| $neg:expr) => {
        impl<$($bound)*> Add for $type {
            type Output = Self;
            #[inline(always)]
            fn add(self, o: Self) -> Self {
                let ($a, $b) = (self, o);
                $add
            }
        }
        impl<$($bound)*> Sub for $type {
            type Output = Self;
            #[inline(always)]
            fn sub(self, o: Self) -> Self {
                let ($a, $b) = (self, o);
                $sub
            }
        }
        impl<$($bound)*> Mul for $type {
            type Output = Self;
            #[inline(always)]
            fn mul(self, o: Self) -> Self {
                let ($a, $b) = (self, o);
                $mul
            }
        }
        impl<$($bound)*> Div for $type {
            type Output = Self;
            #[inline(always)]
            fn div(self, o: Self) -> Self {
                let ($a, $b) = (self, o);
                $div
            }
        }
        impl<$($bound)*> Neg for $type {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                let $c = self;
                $neg
            }
        }
    };
}
pub(crate) use forward_operators;

/// Operations of a real in a tuple of one: what the real inside gives.
macro_rules! forward {
    ($($name:ident($($o:ident),*);)*) => {$(
        #[inline(always)]
        fn $name(self, $($o: Self),*) -> Self {
            Self(self.0.$name($($o.0),*))
        }
    )*};
}
pub(crate) use forward;

/// Two reals side by side: twice the lanes, so that one decoded operation feeds two vectors.
#[derive(Clone, Copy, Debug)]
pub struct Pair<R>(pub R, pub R);

forward_operators!([R: Real] Pair<R>, |a, b| Pair(a.0 + b.0, a.1 + b.1), Pair(a.0 - b.0, a.1 - b.1),
    Pair(a.0 * b.0, a.1 * b.1), Pair(a.0 / b.0, a.1 / b.1), |c| Pair(-c.0, -c.1));

macro_rules! pairwise {
    ($($name:ident($($o:ident),*);)*) => {$(
        #[inline(always)]
        fn $name(self, $($o: Self),*) -> Self {
            Pair(self.0.$name($($o.0),*), self.1.$name($($o.1),*))
        }
    )*};
}

impl<R: Real> Real for Pair<R> {
    type Scalar = R::Scalar;
    const OUTWARD: bool = R::OUTWARD;

    #[inline(always)]
    fn splat(self, c: Self::Scalar) -> Self {
        Pair(self.0.splat(c), self.1.splat(c))
    }
    pairwise! {
        sqrt(); abs(); floor(); min(o); max(o); select_lt(o, x, y); down(); up(); ceil();
        add_down(o); add_up(o); sub_down(o); sub_up(o); mul_down(o); mul_up(o); div_down(o);
        div_up(o); sqrt_down(); sqrt_up();
    }
    #[inline(always)]
    fn map<const N: usize, const M: usize>(
        x: [Self; N],
        f: impl Fn([Self::Scalar; N]) -> [Self::Scalar; M],
    ) -> [Self; M] {
        let first = R::map(x.map(|x| x.0), &f);
        let second = R::map(x.map(|x| x.1), &f);
        std::array::from_fn(|i| Pair(first[i], second[i]))
    }
    #[inline(always)]
    fn mul_bounds(a: [Self; 2], b: [Self; 2]) -> [Self; 2] {
        let p = R::mul_bounds([a[0].0, a[1].0], [b[0].0, b[1].0]);
        let q = R::mul_bounds([a[0].1, a[1].1], [b[0].1, b[1].1]);
        [Pair(p[0], q[0]), Pair(p[1], q[1])]
    }
    #[inline(always)]
    fn mul_bounds_unbounded(a: [Self; 2], b: [Self; 2]) -> [Self; 2] {
        let p = R::mul_bounds_unbounded([a[0].0, a[1].0], [b[0].0, b[1].0]);
        let q = R::mul_bounds_unbounded([a[0].1, a[1].1], [b[0].1, b[1].1]);
        [Pair(p[0], q[0]), Pair(p[1], q[1])]
    }
}

impl<R: Packet> Packet for Pair<R> {
    const LANES: usize = 2 * R::LANES;

    #[inline(always)]
    fn from_fn(self, mut f: impl FnMut(usize) -> Self::Scalar) -> Self {
        let first = self.0.from_fn(&mut f);
        Pair(
            first,
            self.1.from_fn(
                #[inline(always)]
                |i| f(i + R::LANES),
            ),
        )
    }
    #[inline(always)]
    fn lane(self, i: usize) -> Self::Scalar {
        if i < R::LANES { self.0.lane(i) } else { self.1.lane(i - R::LANES) }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u64 {
        self.0.lt(other.0) | self.1.lt(other.1) << R::LANES
    }
    #[inline(always)]
    fn le(self, other: Self) -> u64 {
        self.0.le(other.0) | self.1.le(other.1) << R::LANES
    }
    #[inline(always)]
    fn select(self, mask: u64, x: Self, y: Self) -> Self {
        Pair(self.0.select(mask, x.0, y.0), self.1.select(mask >> R::LANES, x.1, y.1))
    }
    #[inline(always)]
    fn region<T>(self, work: impl FnOnce() -> T) -> T {
        self.0.region(work)
    }
}

impl Scalar for f32 {
    const INFINITY: Self = f32::INFINITY;
    const NAN: Self = f32::NAN;

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        x as f32
    }
    #[inline(always)]
    fn enclose(c: &Constant) -> [Self; 2] {
        c.f32
    }
    #[inline(always)]
    fn nearest(c: &Constant) -> Self {
        c.nearest_f32
    }
    fn enclose_range(lo: f64, hi: f64) -> [Self; 2] {
        let (down, up) = (lo as f32, hi as f32);
        let down = if f64::from(down) > lo { down.next_down() } else { down };
        let up = if f64::from(up) < hi { up.next_up() } else { up };
        [down, up]
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    fn elementary(self, f: crate::Unary) -> Self {
        crate::elementary::unary_f32(f, self)
    }
    fn elementary2(self, f: crate::Binary, y: Self) -> Self {
        crate::elementary::binary_f32(f, self, y)
    }
    #[inline]
    fn power(self, n: i32) -> Self {
        crate::power::power_f32(self, n)
    }
    fn elementary_down(self) -> Self {
        self.next_down()
    }
    fn elementary_up(self) -> Self {
        self.next_up()
    }
}

impl Scalar for f64 {
    const INFINITY: Self = f64::INFINITY;
    const NAN: Self = f64::NAN;

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn enclose(c: &Constant) -> [Self; 2] {
        c.f64
    }
    #[inline(always)]
    fn nearest(c: &Constant) -> Self {
        c.nearest_f64
    }
    fn enclose_range(lo: f64, hi: f64) -> [Self; 2] {
        [lo, hi]
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
    fn elementary(self, f: crate::Unary) -> Self {
        crate::elementary::unary_f64(f, self)
    }
    fn elementary2(self, f: crate::Binary, y: Self) -> Self {
        crate::elementary::binary_f64(f, self, y)
    }
    #[inline]
    fn power(self, n: i32) -> Self {
        crate::power::power_f64(self, n)
    }
    fn elementary_down(self) -> Self {
        self.next_down().next_down()
    }
    fn elementary_up(self) -> Self {
        self.next_up().next_up()
    }
}
