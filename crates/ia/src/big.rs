//! Intervals of any precision.

mod arithmetic;
mod convert;
mod functions;

use astro_float::{BigFloat, RoundingMode, Sign};

/// An interval whose ends are binary floats of a chosen precision, rounded outward.
///
/// Set-based as in IEEE 1788, like `Interval<f64, Set>`: NaN at both ends is the empty interval, and
/// a function's value is its range over the part of the argument in its domain. The result of an
/// operation has the larger precision of its operands. Precisions are multiples of 64 bits, rounded
/// up. An end beyond 2^(2^24) counts as infinite, one below 2^-(2^24) as next to 0.
#[derive(Clone, Debug)]
pub struct BigInterval {
    lo: BigFloat,
    hi: BigFloat,
    precision: usize,
}

/// Which way an end is rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Toward {
    Down,
    Up,
}

/// The largest exponent of an end, and minus the smallest.
const EXPONENT_LIMIT: i32 = 1 << 24;

impl Toward {
    fn mode(self) -> RoundingMode {
        match self {
            Self::Down => RoundingMode::Down,
            Self::Up => RoundingMode::Up,
        }
    }

    /// The infinity in this direction.
    fn infinity(self) -> BigFloat {
        match self {
            Self::Down => astro_float::INF_NEG,
            Self::Up => astro_float::INF_POS,
        }
    }

    /// Does rounding this way move a number of that sign away from 0?
    fn grows(self, sign: Sign) -> bool {
        (self == Self::Up) == (sign == Sign::Pos)
    }

    /// Brings the exponent of an end within its limits; what is not a number says nothing.
    fn settle(self, x: BigFloat) -> BigFloat {
        let Some(sign) = x.sign() else {
            return self.infinity();
        };
        if x.is_zero() {
            return integer(0);
        }
        let exponent = x.exponent();
        if exponent.is_none_or(|e| e > EXPONENT_LIMIT) {
            if self.grows(sign) { self.infinity() } else { power_of_two(sign, EXPONENT_LIMIT) }
        } else if exponent.is_some_and(|e| e < -EXPONENT_LIMIT) {
            if self.grows(sign) { power_of_two(sign, -EXPONENT_LIMIT) } else { integer(0) }
        } else {
            x
        }
    }

    /// The outermost of two ends.
    fn outer(self, x: BigFloat, y: BigFloat) -> BigFloat {
        if (self == Self::Down) == (x < y) { x } else { y }
    }
}

/// A small integer, exactly.
fn integer(n: i64) -> BigFloat {
    BigFloat::from_i64(n, 64)
}

/// `2^(exponent - 1)` with a sign, exactly.
fn power_of_two(sign: Sign, exponent: i32) -> BigFloat {
    let mut x = integer(1);
    x.set_exponent(exponent);
    x.set_sign(sign);
    x
}

impl BigInterval {
    fn new(lo: BigFloat, hi: BigFloat, precision: usize) -> Self {
        Self { lo, hi, precision }
    }

    fn point(x: BigFloat, precision: usize) -> Self {
        Self::new(x.clone(), x, precision)
    }

    /// No number.
    pub fn empty(precision: usize) -> Self {
        Self::new(astro_float::NAN, astro_float::NAN, whole_words(precision))
    }

    /// All numbers.
    pub fn entire(precision: usize) -> Self {
        Self::new(astro_float::INF_NEG, astro_float::INF_POS, whole_words(precision))
    }

    /// Bits of the significand.
    pub fn precision(&self) -> usize {
        self.precision
    }

    /// The same set, or the smallest around it, with ends of another precision.
    pub fn with_precision(&self, precision: usize) -> Self {
        let precision = whole_words(precision);
        let round = |x: &BigFloat, toward: Toward| {
            let mut x = x.clone();
            match x.set_precision(precision, toward.mode()) {
                Ok(()) => toward.settle(x),
                Err(_) => toward.infinity(),
            }
        };
        if self.is_empty() {
            return Self::empty(precision);
        }
        Self::new(round(&self.lo, Toward::Down), round(&self.hi, Toward::Up), precision)
    }

    /// Does it contain no number?
    pub fn is_empty(&self) -> bool {
        self.lo.is_nan() || self.hi.is_nan()
    }

    /// Does it contain one number only?
    pub fn is_point(&self) -> bool {
        self.lo == self.hi
    }

    /// Are both ends finite?
    pub fn is_bounded(&self) -> bool {
        !(self.is_empty() || self.lo.is_inf() || self.hi.is_inf())
    }

    /// Is 0 a member?
    pub fn contains_zero(&self) -> bool {
        !(self.is_empty() || self.is_positive() || self.is_negative())
    }

    /// Has it members, each above 0?
    pub fn is_positive(&self) -> bool {
        self.lo > integer(0)
    }

    /// Has it members, each below 0?
    pub fn is_negative(&self) -> bool {
        self.hi < integer(0)
    }

    /// Is each member of `other` a member?
    pub fn contains(&self, other: &Self) -> bool {
        other.is_empty() || self.lo <= other.lo && other.hi <= self.hi
    }

    /// Is the double a member?
    pub fn contains_f64(&self, x: f64) -> bool {
        x.is_finite() && self.contains(&Self::from_f64(x, 64))
    }

    /// Have both members, and is each of them below each of `other`?
    pub fn is_below(&self, other: &Self) -> bool {
        self.hi < other.lo
    }

    /// The least member alone; -2^(2^24) if there is none for want of a bound.
    pub fn lower(&self) -> Self {
        self.end(&self.lo)
    }

    /// The greatest member alone; 2^(2^24) if there is none for want of a bound.
    pub fn upper(&self) -> Self {
        self.end(&self.hi)
    }

    fn end(&self, x: &BigFloat) -> Self {
        let x = match x.sign() {
            Some(sign) if x.is_inf() => power_of_two(sign, EXPONENT_LIMIT),
            _ => x.clone(),
        };
        Self::point(x, self.precision)
    }

    /// A member near the middle, as a point.
    pub fn midpoint(&self) -> Self {
        if self.is_empty() || self.is_point() {
            return self.clone();
        }
        let (lo, hi) = (self.lower().lo, self.upper().hi);
        let mut sum = lo.add(&hi, self.precision, RoundingMode::ToEven);
        if let (false, Some(e)) = (sum.is_zero(), sum.exponent()) {
            sum.set_exponent(e - 1);
        }
        // Of ends without a double between them, rounding may pass one.
        Self::point(sum.clamp(&lo, &hi), self.precision)
    }

    /// An upper bound of the distance between the ends; NaN if empty.
    pub fn width(&self) -> f64 {
        (self.upper() - self.lower()).to_f64()[1]
    }

    /// The smallest interval that contains both.
    pub fn hull(&self, other: &Self) -> Self {
        let precision = self.precision.max(other.precision);
        match (self.is_empty(), other.is_empty()) {
            (true, _) => other.with_precision(precision),
            (_, true) => self.with_precision(precision),
            _ => Self::new(
                Toward::Down.outer(self.lo.clone(), other.lo.clone()),
                Toward::Up.outer(self.hi.clone(), other.hi.clone()),
                precision,
            ),
        }
    }

    /// The common members.
    pub fn intersect(&self, other: &Self) -> Self {
        let precision = self.precision.max(other.precision);
        let lo = if self.lo < other.lo { &other.lo } else { &self.lo };
        let hi = if self.hi < other.hi { &self.hi } else { &other.hi };
        if lo <= hi && !other.is_empty() {
            Self::new(lo.clone(), hi.clone(), precision)
        } else {
            Self::empty(precision)
        }
    }
}

/// A precision in whole words.
fn whole_words(precision: usize) -> usize {
    precision.clamp(1, 1 << 30).next_multiple_of(64)
}
