//! What the search needs of an interval, whatever its precision.

use std::sync::LazyLock;

use zeroset_ia::{BigInterval, Constant, Interval, Number, Set};

/// What is certain of a number's sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sign {
    /// Below 0.
    Negative,
    /// Exactly 0.
    Zero,
    /// Above 0.
    Positive,
    /// There is no number.
    Undefined,
    /// Nothing is.
    Unknown,
}

impl Sign {
    /// Is one sign above and the other below 0?
    pub(super) fn opposes(self, other: Self) -> bool {
        matches!((self, other), (Self::Negative, Self::Positive) | (Self::Positive, Self::Negative))
    }
}

/// Double precision, outward.
pub(super) type Double = Interval<f64, Set>;

/// A set-based outward interval; its ends may be finer than doubles.
pub(super) trait Enclosure: Number {
    /// The interval between two doubles, in the context of `self`.
    fn between(&self, lo: f64, hi: f64) -> Self;
    /// All numbers, in the context of `self`.
    fn entire(&self) -> Self;
    /// Doubles around it; NaN if it is empty.
    fn bounds(&self) -> [f64; 2];
    /// The sign that all members have.
    fn sign(&self) -> Sign;
    /// The smallest interval that contains both; neither may be empty.
    fn union(&self, other: &Self) -> Self;
    /// `(1 - u) self + u other`, for u in eighths.
    fn blend(&self, other: &Self, eighths: u8) -> Self {
        let [rest, part] = weights(eighths);
        self.clone().scale(rest) + other.clone().scale(part)
    }

    /// The double `x`, in the context of `self`.
    fn exact(&self, x: f64) -> Self {
        self.between(x, x)
    }
    /// Does it contain no number?
    fn is_empty(&self) -> bool {
        self.bounds()[0].is_nan()
    }
    /// Is it bounded, and not empty?
    fn is_bounded(&self) -> bool {
        self.bounds().iter().all(|x| x.is_finite())
    }
}

/// `1 - u` and `u`, for u in eighths.
fn weights(eighths: u8) -> [&'static Constant; 2] {
    static EIGHTHS: LazyLock<[Constant; 9]> =
        LazyLock::new(|| std::array::from_fn(|k| Constant::from_f64(k as f64 / 8.0)));
    let k = usize::from(eighths);
    [&EIGHTHS[8 - k], &EIGHTHS[k]]
}

impl Enclosure for Double {
    fn between(&self, lo: f64, hi: f64) -> Self {
        Self::new(lo, hi)
    }

    fn entire(&self) -> Self {
        Self::new(f64::NEG_INFINITY, f64::INFINITY)
    }

    #[inline(always)]
    fn bounds(&self) -> [f64; 2] {
        [self.lo, self.hi]
    }

    #[inline(always)]
    fn sign(&self) -> Sign {
        if self.lo > 0.0 {
            Sign::Positive
        } else if self.hi < 0.0 {
            Sign::Negative
        } else if self.lo == 0.0 && self.hi == 0.0 {
            Sign::Zero
        } else if self.lo.is_nan() || self.hi.is_nan() {
            Sign::Undefined
        } else {
            Sign::Unknown
        }
    }

    fn union(&self, other: &Self) -> Self {
        self.hull(*other)
    }

    #[inline(always)]
    fn blend(&self, other: &Self, eighths: u8) -> Self {
        if eighths == 4 {
            // Halves are exact but for the last bit of a subnormal, which the marks cover.
            return Self::new(
                (0.5 * self.lo + 0.5 * other.lo).next_down(),
                (0.5 * self.hi + 0.5 * other.hi).next_up(),
            );
        }
        let [rest, part] = weights(eighths);
        self.scale(rest) + other.scale(part)
    }
}

impl Enclosure for BigInterval {
    fn between(&self, lo: f64, hi: f64) -> Self {
        Self::from_bounds(lo, hi, self.precision())
    }

    fn entire(&self) -> Self {
        Self::entire(self.precision())
    }

    fn bounds(&self) -> [f64; 2] {
        if self.is_empty() { [f64::NAN; 2] } else { self.to_f64() }
    }

    fn sign(&self) -> Sign {
        if self.is_positive() {
            Sign::Positive
        } else if self.is_negative() {
            Sign::Negative
        } else if Self::is_empty(self) {
            Sign::Undefined
        } else if self.is_point() {
            Sign::Zero
        } else {
            Sign::Unknown
        }
    }

    fn union(&self, other: &Self) -> Self {
        self.hull(other)
    }

    fn is_empty(&self) -> bool {
        Self::is_empty(self)
    }

    fn is_bounded(&self) -> bool {
        Self::is_bounded(self)
    }
}
