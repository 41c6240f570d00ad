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
