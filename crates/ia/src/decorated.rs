//! Intervals that know whether the function was defined and continuous.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::range::{self, Domain};
use crate::{Binary, Constant, Interval, Number, Scalar, Set, Unary};

/// What holds of a function on a box (IEEE 1788-2015, chapter 11); the later implies the earlier.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Decoration {
    /// Nothing: somewhere in the box it may be undefined ("trv").
    Trivial,
    /// It is defined everywhere in the box ("def").
    Defined,
    /// Its restriction to the box is defined and continuous everywhere ("dac").
    Continuous,
}

/// The range of a function over a box, with what is known of the function there.
///
/// Opposite signs at the ends of a box prove a root only if the function is
/// [`Continuous`](Decoration::Continuous) on it: a pole changes sign too.
///
/// Sums and products of numbers that are not negative are cut at 0, so that `sqrt(x^2 + y^2)` stays
/// defined where rounding down would give a tiny negative number. Integer powers are as wide as those
/// of [`Raw`](crate::Raw), so that what holds of a box here holds there.
#[derive(Clone, Copy, Debug)]
pub struct Decorated<S> {
    /// The range over the part of the box where the function is defined.
    pub interval: Interval<S, Set>,
    /// What is known of the function so far.
    pub decoration: Decoration,
}

/// What is known of the sign of all members.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    /// A side of its own, so that a point at 0 has no wider range than the boxes around it.
    Zero,
    NotNegative,
    NotPositive,
    Both,
}

impl Side {
    fn of<S: Scalar>(x: Interval<S, Set>) -> Self {
        let zero = S::from_f64(0.0);
        if x.lo >= zero && x.hi <= zero {
            Self::Zero
        } else if x.lo >= zero {
            Self::NotNegative
        } else if x.hi <= zero {
            Self::NotPositive
        } else {
            Self::Both
        }
    }

    fn of_sum(self, other: Self) -> Self {
        match (self, other) {
            (Self::Zero, side) | (side, Self::Zero) => side,
            _ if self == other => self,
            _ => Self::Both,
        }
    }

    fn of_product(self, other: Self) -> Self {
        match (self, other) {
            (Self::Zero, _) | (_, Self::Zero) => Self::Zero,
            (Self::Both, _) | (_, Self::Both) => Self::Both,
            _ if self == other => Self::NotNegative,
            _ => Self::NotPositive,
        }
    }

    /// The members of `x` on this side.
    fn cut<S: Scalar>(self, x: Interval<S, Set>) -> Interval<S, Set> {
        let zero = S::from_f64(0.0);
        match self {
            Self::Zero if !x.is_empty() => Interval::point(zero),
            Self::NotNegative if x.lo < zero => Interval::new(zero, x.hi),
            Self::NotPositive if x.hi > zero => Interval::new(x.lo, zero),
            _ => x,
        }
    }
}

/// `Continuous` if it holds, else the other.
fn continuous_if(holds: bool, otherwise: Decoration) -> Decoration {
    if holds { Decoration::Continuous } else { otherwise }
}

impl<S: Scalar> Decorated<S> {
    /// An independent variable that ranges over a box.
    pub fn new(interval: Interval<S, Set>) -> Self {
        Self { interval, decoration: Decoration::Continuous }.settled()
    }

    /// Is the function known to be defined and continuous on the box?
    pub fn is_continuous(&self) -> bool {
        self.decoration == Decoration::Continuous
    }

    /// A function without values is not defined.
    fn settled(mut self) -> Self {
        if self.interval.is_empty() {
            self.decoration = Decoration::Trivial;
        }
        self
    }

    /// The composition with a function that has this range and decoration on the ranges so far.
    fn composed(self, interval: Interval<S, Set>, decoration: Decoration) -> Self {
        Self { interval, decoration: self.decoration.min(decoration) }.settled()
    }

    /// The composition with a function that is continuous everywhere.
    fn continuous(self, interval: Interval<S, Set>) -> Self {
        self.composed(interval, Decoration::Continuous)
    }

    /// Both decorations together, with the first interval.
    fn and(self, other: Self) -> Self {
        Self { interval: self.interval, decoration: self.decoration.min(other.decoration) }
    }

    fn side(&self) -> Side {
        Side::of(self.interval)
    }
}

impl<S: Scalar> Add for Decorated<S> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let side = self.side().of_sum(o.side());
        self.and(o).continuous(side.cut(self.interval + o.interval))
    }
}

impl<S: Scalar> Sub for Decorated<S> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl<S: Scalar> Neg for Decorated<S> {
    type Output = Self;
    fn neg(self) -> Self {
        self.continuous(-self.interval)
    }
}

impl<S: Scalar> Mul for Decorated<S> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let side = self.side().of_product(o.side());
        self.and(o).continuous(side.cut(self.interval * o.interval))
    }
}

impl<S: Scalar> Div for Decorated<S> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let side = self.side().of_product(o.side());
        let decoration = continuous_if(!o.interval.contains_zero(), Decoration::Trivial);
        self.and(o).composed(side.cut(self.interval / o.interval), decoration)
    }
}

impl<S: Scalar> Number for Decorated<S> {
    fn constant(&self, c: &Constant) -> Self {
        Self::new(self.interval.constant(c))
    }

    fn scale(self, c: &Constant) -> Self {
        let side = self.side().of_product(Side::of(self.interval.constant(c)));
        self.continuous(side.cut(self.interval.scale(c)))
    }

    fn offset(self, c: &Constant) -> Self {
        let side = self.side().of_sum(Side::of(self.interval.constant(c)));
        self.continuous(side.cut(self.interval.offset(c)))
    }

    fn sqr(self) -> Self {
        self.continuous(self.interval.sqr())
    }

    fn powi(self, n: i32) -> Self {
        let side = if n % 2 == 0 { Side::NotNegative } else { self.side() };
        let defined = n >= 0 || !self.interval.contains_zero();
        let mut power = self.interval.powi(n);
        if n.unsigned_abs() > 2 || n == -2 {
            // Raw intervals multiply, and their range has to be in this one.
            power = power.hull(self.interval.multiplied(n));
        }
        self.composed(side.cut(power), continuous_if(defined, Decoration::Trivial))
    }

    fn powc(self, c: &Constant) -> Self {
        let exponent = self.constant(c);
        self.binary(Binary::Pow, exponent)
    }

    fn unary(self, f: Unary) -> Self {
        let x = self.interval;
        let y = x.unary(f);
        let decoration = match f {
            // Within one step these are constant.
            Unary::Sign | Unary::Floor | Unary::Ceil => {
                continuous_if(y.lo == y.hi, Decoration::Defined)
            }
            Unary::Tan => continuous_if(!range::has_pole(x.bounds()), Decoration::Trivial),
            _ => continuous_if(Domain::of(f).covers(x.bounds()), Decoration::Trivial),
        };
        self.composed(y, decoration)
    }

    fn binary(self, f: Binary, o: Self) -> Self {
        let (x, y) = (self.interval, o.interval);
        let zero = S::from_f64(0.0);
        let decoration = match f {
            Binary::Min | Binary::Max | Binary::Hypot => Decoration::Continuous,
            Binary::Mod if y.contains_zero() => Decoration::Trivial,
            Binary::Mod => {
                let quotient = range::constant_quotient(x.bounds(), y.bounds());
                continuous_if(quotient.is_some(), Decoration::Defined)
            }
            Binary::Atan2 if x.contains_zero() && y.contains_zero() => Decoration::Trivial,
            Binary::Atan2 => {
                let jumps = range::crosses_cut(x.bounds(), y.bounds());
                continuous_if(!jumps, Decoration::Defined)
            }
            Binary::Pow => {
                let defined = x.lo > zero || x.lo >= zero && y.lo > zero;
                continuous_if(defined, Decoration::Trivial)
            }
        };
        self.and(o).composed(x.binary(f, y), decoration)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Decoration::{Continuous, Defined, Trivial};

    fn over(lo: f64, hi: f64) -> Decorated<f64> {
        Decorated::new(Interval::new(lo, hi))
    }

    #[test]
    fn functions_of_one_argument_know_their_domain() {
        let half_pi = std::f64::consts::FRAC_PI_2;
        for (f, lo, hi, expected) in [
            (Unary::Sqrt, 0.0, 1.0, Continuous),
            (Unary::Sqrt, -1e-300, 1.0, Trivial),
            (Unary::Log, 0.0, 1.0, Trivial),
            (Unary::Log, 1e-300, f64::INFINITY, Continuous),
            (Unary::Logp1, -1.0, 1.0, Trivial),
            (Unary::Asin, -1.0, 1.0, Continuous),
            (Unary::Acos, -1.0, 1.0f64.next_up(), Trivial),
            (Unary::Acosh, 1.0, 2.0, Continuous),
            (Unary::Atanh, -0.5, 1.0, Trivial),
            (Unary::Tan, -1.5, 1.5, Continuous),
            // The pole lies between these neighbours.
            (Unary::Tan, half_pi, half_pi.next_up(), Trivial),
            (Unary::Tan, -half_pi, half_pi, Continuous),
            (Unary::Tan, 1.0, 2.0, Trivial),
            (Unary::Floor, 2.0, 2.5, Continuous),
            (Unary::Floor, 1.5, 2.0, Defined),
            (Unary::Ceil, 1.5, 2.0, Continuous),
            (Unary::Ceil, 1.5, 2.5, Defined),
            (Unary::Sign, 0.0, 1.0, Defined),
            (Unary::Sign, 1e-300, 1.0, Continuous),
            (Unary::Abs, -1.0, 1.0, Continuous),
            (Unary::Sin, -9.0, f64::INFINITY, Continuous),
        ] {
            assert_eq!(over(lo, hi).unary(f).decoration, expected, "{f} over [{lo:e}, {hi:e}]");
        }
    }

    #[test]
    fn functions_of_two_arguments_know_their_domain() {
        let square = |lo, hi| over(lo, hi);
        for (f, x, y, expected) in [
            (Binary::Mod, square(0.5, 0.75), square(1.0, 1.0), Continuous),
            (Binary::Mod, square(0.5, 1.0), square(1.0, 1.0), Defined),
            (Binary::Mod, square(0.5, 0.75), square(0.0, 1.0), Trivial),
            (Binary::Atan2, square(-1.0, 1.0), square(0.5, 1.0), Continuous),
            (Binary::Atan2, square(-1.0, 1.0), square(-1.0, -0.5), Defined),
            (Binary::Atan2, square(0.0, 1.0), square(-1.0, -0.5), Continuous),
            (Binary::Atan2, square(0.0, 1.0), square(-1.0, 1.0), Trivial),
            (Binary::Pow, square(0.0, 1.0), square(0.5, 1.0), Continuous),
            (Binary::Pow, square(0.0, 1.0), square(0.0, 1.0), Trivial),
            (Binary::Pow, square(0.5, 1.0), square(-1.0, 1.0), Continuous),
            (Binary::Max, square(-1.0, 1.0), square(-1.0, 1.0), Continuous),
        ] {
            assert_eq!(x.binary(f, y).decoration, expected, "{f} {x:?} {y:?}");
        }
        assert_eq!((square(1.0, 2.0) / square(0.0, 1.0)).decoration, Trivial);
        assert_eq!((square(1.0, 2.0) / square(0.5, 1.0)).decoration, Continuous);
        assert_eq!(square(0.0, 1.0).powi(-1).decoration, Trivial);
    }

    #[test]
    fn what_is_lost_stays_lost() {
        let x = over(-1.0, 1.0);
        let pole = x.constant(&Constant::integer(1)) / x;
        assert_eq!((pole + x).decoration, Trivial);
        assert_eq!((x * pole).unary(Unary::Exp).decoration, Trivial);
        assert_eq!((x.unary(Unary::Floor) - x).unary(Unary::Sin).decoration, Defined);
        assert_eq!(over(-2.0, -1.0).unary(Unary::Sqrt).decoration, Trivial);
        assert_eq!(over(f64::NAN, f64::NAN).decoration, Trivial);
    }

    #[test]
    fn a_point_at_zero_has_no_wider_range_than_a_box_around_it() {
        let (x, zero) = (over(0.5, 1.0), over(0.0, 0.0));
        // Not positive for all y in [-1, 0], so its negative has a root for y = 0 too.
        assert!((-(x * over(-1.0, 0.0))).unary(Unary::Sqrt).is_continuous());
        assert!((-(x * zero)).unary(Unary::Sqrt).is_continuous());
        assert!((-(zero + x * zero)).unary(Unary::Sqrt).is_continuous());
        assert!((-zero.scale(&Constant::from_f64(0.1))).unary(Unary::Sqrt).is_continuous());
        assert_eq!((zero * x).interval.bounds(), [0.0, 0.0]);
        assert_eq!((zero / x).interval.bounds(), [0.0, 0.0]);
        assert!((zero / zero).interval.is_empty() && zero.powi(-1).interval.is_empty());
    }

    #[test]
    fn rounding_does_not_leave_the_domain() {
        let x = over(-1.0, 1.0);
        assert!((x.sqr() + x.sqr()).unary(Unary::Sqrt).is_continuous());
        assert!((x.sqr() * x.powi(4)).unary(Unary::Sqrt).is_continuous());
        assert!(x.sqr().scale(&Constant::from_f64(0.1)).unary(Unary::Sqrt).is_continuous());
        assert!(x.unary(Unary::Abs).powi(3).unary(Unary::Sqrt).is_continuous());
        assert!((-(-x.sqr() - x.sqr())).unary(Unary::Sqrt).is_continuous());
        assert!((x.sqr() / over(1.0, 2.0)).unary(Unary::Sqrt).is_continuous());
        assert!(!(x.powi(3)).unary(Unary::Sqrt).is_continuous());
    }
}
