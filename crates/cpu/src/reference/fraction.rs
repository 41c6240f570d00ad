//! Quotients kept as fractions, so that a pole is no more than a vanishing denominator.

use std::ops::{Add, Div, Mul, Neg, Sub};

use zeroset_ia::{Binary, Constant, Number, Unary};

/// A numerator and a denominator (1 if there is none).
///
/// Over intervals, a function whose numerator excludes 0 has no root, even where it has a pole and
/// its own enclosure is everything.
#[derive(Clone, Debug)]
pub(super) struct Fraction<N> {
    pub(super) numerator: N,
    denominator: Option<N>,
}

impl<N: Number> Fraction<N> {
    pub(super) fn new(numerator: N) -> Self {
        Self { numerator, denominator: None }
    }

    /// The value itself.
    fn quotient(self) -> N {
        match self.denominator {
            None => self.numerator,
            Some(d) => self.numerator / d,
        }
    }

    fn combine(self, other: Self, f: impl FnOnce(N, N) -> N) -> Self {
        let (a, b) = (self.numerator, other.numerator);
        match (self.denominator, other.denominator) {
            (None, None) => Self::new(f(a, b)),
            (Some(c), None) => Self { numerator: f(a, b * c.clone()), denominator: Some(c) },
            (None, Some(d)) => Self { numerator: f(a * d.clone(), b), denominator: Some(d) },
            (Some(c), Some(d)) => {
                Self { numerator: f(a * d.clone(), b * c.clone()), denominator: Some(c * d) }
            }
        }
    }

    fn both(self, f: impl Fn(N) -> N) -> Self {
        Self { numerator: f(self.numerator), denominator: self.denominator.map(f) }
    }
}

/// The product of two denominators.
fn product<N: Number>(a: Option<N>, b: Option<N>) -> Option<N> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a * b),
        (a, b) => a.or(b),
    }
}

impl<N: Number> Add for Fraction<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.combine(other, |a, b| a + b)
    }
}

impl<N: Number> Sub for Fraction<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.combine(other, |a, b| a - b)
    }
}

impl<N: Number> Neg for Fraction<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { numerator: -self.numerator, denominator: self.denominator }
    }
}

impl<N: Number> Mul for Fraction<N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            numerator: self.numerator * other.numerator,
            denominator: product(self.denominator, other.denominator),
        }
    }
}

impl<N: Number> Div for Fraction<N> {
    type Output = Self;
    // Dividing by a fraction multiplies by its denominator.
    #[allow(clippy::suspicious_arithmetic_impl)]
    fn div(self, other: Self) -> Self {
        let numerator = match other.denominator {
            None => self.numerator,
            Some(d) => self.numerator * d,
        };
        Self { numerator, denominator: product(self.denominator, Some(other.numerator)) }
    }
}

impl<N: Number> Number for Fraction<N> {
    fn constant(&self, c: &Constant) -> Self {
        Self::new(self.numerator.constant(c))
    }

    fn scale(self, c: &Constant) -> Self {
        Self { numerator: self.numerator.scale(c), denominator: self.denominator }
    }

    fn offset(self, c: &Constant) -> Self {
        match self.denominator {
            None => Self::new(self.numerator.offset(c)),
            Some(d) => {
                Self { numerator: self.numerator + d.clone().scale(c), denominator: Some(d) }
            }
        }
    }

    fn sqr(self) -> Self {
        self.both(N::sqr)
    }

    fn powi(self, n: i32) -> Self {
        let one = self.numerator.clone().powi(0);
        let Self { numerator, denominator } = self.both(|x| x.powi(n.saturating_abs()));
        if n >= 0 {
            Self { numerator, denominator }
        } else {
            Self { numerator: denominator.unwrap_or(one), denominator: Some(numerator) }
        }
    }

    fn powc(self, c: &Constant) -> Self {
        Self::new(self.quotient().powc(c))
    }

    fn unary(self, f: Unary) -> Self {
        let x = self.quotient();
        if f == Unary::Tan {
            let cosine = x.clone().unary(Unary::Cos);
            return Self { numerator: x.unary(Unary::Sin), denominator: Some(cosine) };
        }
        Self::new(x.unary(f))
    }

    fn binary(self, f: Binary, other: Self) -> Self {
        Self::new(self.quotient().binary(f, other.quotient()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::outward::{Double, Outward, Sign};
    use super::*;

    /// Checks numerator / denominator against the value, for x = 3/4.
    fn check(f: impl Fn(Fraction<Double>) -> Fraction<Double>, value: f64) {
        let result = f(Fraction::new(Double::point(0.75)));
        assert!(result.denominator.is_some());
        let [lo, hi] = result.quotient().bounds();
        assert!(lo <= value && value <= hi && hi - lo < 1e-12, "{value} in [{lo}, {hi}]");
    }

    #[test]
    fn operations_agree_with_their_values() {
        let x: f64 = 0.75;
        let two = Constant::from_f64(2.0);
        let inverse = |x: Fraction<Double>| x.powi(-1);
        check(|x| inverse(x.clone()) + x, 1.0 / x + x);
        check(|x| x.clone() - inverse(x), x - 1.0 / x);
        check(|x| inverse(x.clone()) * (x.clone() + inverse(x)), (x + 1.0 / x) / x);
        check(|x| inverse(x.clone()) / (x.clone() - inverse(x)), 1.0 / x / (x - 1.0 / x));
        check(|x| inverse(x.clone()) + inverse(x.sqr()), 1.0 / x + 1.0 / (x * x));
        check(|x| inverse(x).offset(&two).scale(&two), 2.0 * (1.0 / x + 2.0));
        check(|x| -inverse(x).powi(3), -1.0 / x.powi(3));
        check(|x| inverse(x).powi(-2) / inverse(x_squared()), x.powi(4));
        check(|x| x.unary(Unary::Tan), x.tan());
    }

    fn x_squared() -> Fraction<Double> {
        Fraction::new(Double::point(0.75)).sqr()
    }

    #[test]
    fn a_pole_is_a_vanishing_denominator() {
        let x = Fraction::new(Double::new(-1.0, 1.0));
        let f = x.powi(-1);
        assert_eq!(f.numerator.sign(), Sign::Positive);
        assert_eq!(f.quotient().bounds(), [f64::NEG_INFINITY, f64::INFINITY]);
    }
}
