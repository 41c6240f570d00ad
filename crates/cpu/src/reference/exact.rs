//! The ray polynomial in exact rational arithmetic.

use std::ops::{Add, Div, Mul, Neg, Sub};

use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};
use zeroset_ia::{BigInterval, Binary, Constant, Number, Unary};

use super::sturm::{Dyadic, Polynomial};

/// A polynomial in t over the rationals; nothing where an operation or a constant is not rational.
#[derive(Clone, Debug)]
pub(super) struct Exact(Option<Ratio>);

/// Integer coefficients, constant first, over a common denominator, which is positive.
#[derive(Clone, Debug)]
struct Ratio {
    numerators: Vec<BigInt>,
    denominator: BigInt,
}

impl Exact {
    /// `origin + direction t`.
    pub(super) fn line(origin: f64, direction: f64) -> Self {
        let [o, d] = [origin, direction].map(|x| Dyadic::new(x).parts());
        Self(Some(Ratio { numerators: vec![o.0 * &d.1, d.0 * &o.1], denominator: o.1 * d.1 }))
    }

    /// A positive multiple with integer coefficients.
    pub(super) fn polynomial(self) -> Option<Polynomial> {
        self.0.map(|r| Polynomial::new(r.numerators))
    }

    fn constant_value(n: BigInt, denominator: BigInt) -> Self {
        Self(Some(Ratio { numerators: vec![n], denominator }))
    }

    fn zip(self, other: Self, f: impl Fn(BigInt, BigInt) -> BigInt) -> Self {
        let (Some(a), Some(b)) = (self.0, other.0) else { return Self(None) };
        let same = a.denominator == b.denominator;
        let length = a.numerators.len().max(b.numerators.len());
        let spread = |r: &Ratio, factor: &BigInt| {
            let mut terms: Vec<BigInt> = if same {
                r.numerators.clone()
            } else {
                r.numerators.iter().map(|n| n * factor).collect()
            };
            terms.resize(length, BigInt::zero());
            terms
        };
        let (x, y) = (spread(&a, &b.denominator), spread(&b, &a.denominator));
        let denominator = if same { a.denominator } else { a.denominator * b.denominator };
        Self(Some(Ratio {
            numerators: x.into_iter().zip(y).map(|(x, y)| f(x, y)).collect(),
            denominator,
        }))
    }
}

/// The exact value of a constant that is known exactly.
pub(super) fn rational(c: &Constant) -> Option<(BigInt, BigInt)> {
    let mut rest = c.big.clone();
    let mut sum = (BigInt::zero(), BigInt::one());
    // A sum of doubles, the largest first.
    while rest.is_point() {
        if rest.contains_zero() {
            return Some(sum);
        }
        let part = rest.nearest();
        if !part.is_finite() || part == 0.0 {
            return None;
        }
        let (n, d) = Dyadic::new(part).parts();
        sum = (sum.0 * &d + n * &sum.1, sum.1 * d);
        let precision = rest.precision();
        rest = rest - BigInterval::from_f64(part, precision);
    }
    None
}

impl Add for Exact {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Exact {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Neg for Exact {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|r| Ratio {
            numerators: r.numerators.into_iter().map(|n| -n).collect(),
            denominator: r.denominator,
        }))
    }
}

impl Mul for Exact {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (Some(a), Some(b)) = (self.0, other.0) else { return Self(None) };
        let mut numerators = vec![BigInt::zero(); a.numerators.len() + b.numerators.len() - 1];
        for (i, x) in a.numerators.iter().enumerate() {
            for (j, y) in b.numerators.iter().enumerate() {
                numerators[i + j] += x * y;
            }
        }
        Self(Some(Ratio { numerators, denominator: a.denominator * b.denominator }))
    }
}

impl Div for Exact {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let Some(b) = other.0 else { return Self(None) };
        match &b.numerators[..] {
            [n] if !n.is_zero() => {
                let sign = n.signum();
                self * Self::constant_value(b.denominator * sign, n.abs())
            }
            _ => Self(None),
        }
    }
}

impl Number for Exact {
    fn constant(&self, c: &Constant) -> Self {
        rational(c).map_or(Self(None), |(n, d)| Self::constant_value(n, d))
    }

    fn scale(self, c: &Constant) -> Self {
        let c = self.constant(c);
        self * c
    }

    fn offset(self, c: &Constant) -> Self {
        let c = self.constant(c);
        self + c
    }

    fn sqr(self) -> Self {
        self.clone() * self
    }

    fn powi(self, n: i32) -> Self {
        let one = Self::constant_value(BigInt::one(), BigInt::one());
        if n < 0 {
            return one / self.powi(n.saturating_neg());
        }
        (0..n).fold(one, |power, _| power * self.clone())
    }

    fn powc(self, _: &Constant) -> Self {
        Self(None)
    }

    fn unary(self, _: Unary) -> Self {
        Self(None)
    }

    fn binary(self, _: Binary, _: Self) -> Self {
        Self(None)
    }
}
