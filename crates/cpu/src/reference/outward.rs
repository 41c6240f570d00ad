//! What the search needs of an interval, whatever its precision.

use std::sync::LazyLock;

use zeroset_ia::{BigInterval, Constant, Enclosure, Interval, Number, Set};

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
pub(super) trait Outward: Enclosure {
    /// The interval between two doubles, in the context of `self`.
    fn between(&self, lo: f64, hi: f64) -> Self;
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

impl Outward for Double {
    fn between(&self, lo: f64, hi: f64) -> Self {
        Self::new(lo, hi)
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

impl Outward for BigInterval {
    fn between(&self, lo: f64, hi: f64) -> Self {
        Self::from_bounds(lo, hi, self.precision())
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

    fn is_bounded(&self) -> bool {
        Self::is_bounded(self)
    }
}

#[cfg(test)]
mod tests {
    use zeroset_ia::Unary;

    use super::*;

    fn check<N: Outward>(context: &N) {
        let between = |lo, hi| context.between(lo, hi);
        assert_eq!(between(1.0, 2.0).sign(), Sign::Positive);
        assert_eq!(between(-2.0, -f64::MIN_POSITIVE).sign(), Sign::Negative);
        assert_eq!(between(0.0, 0.0).sign(), Sign::Zero);
        assert_eq!(between(0.0, 1.0).sign(), Sign::Unknown);
        assert_eq!(context.entire().sign(), Sign::Unknown);
        assert!(!context.entire().is_bounded() && between(-1.0, 1.0).is_bounded());
        let nothing = between(-2.0, -1.0).unary(Unary::Sqrt);
        assert_eq!(nothing.sign(), Sign::Undefined);
        assert!(!nothing.is_bounded());
        assert_eq!(between(-1.0, 0.5).union(&between(0.25, 3.0)).bounds(), [-1.0, 3.0]);
        for (eighths, value) in [(0, 1.0), (3, 1.75), (4, 2.0), (8, 3.0)] {
            let [lo, hi] = between(1.0, 1.0).blend(&between(3.0, 3.0), eighths).bounds();
            assert!(lo <= value && value <= hi && hi - lo < 1e-14);
        }
    }

    #[test]
    fn both_precisions_mean_the_same() {
        check(&Double::point(0.0));
        check(&BigInterval::from_f64(0.0, 128));
    }

    #[test]
    fn halves_of_subnormals_are_enclosed() {
        let least = f64::from_bits(1);
        let [lo, hi] = Double::point(least).blend(&Double::point(0.0), 4).bounds();
        assert!(lo <= 0.0 && hi >= least);
    }
}
