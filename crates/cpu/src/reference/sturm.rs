//! Real roots of polynomials with integer coefficients, counted exactly.

use std::cmp::Ordering;

use num_bigint::{BigInt, Sign};
use num_traits::{One, Signed, Zero};

/// A polynomial with integer coefficients, constant first, without leading zeros; empty for 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Polynomial(Vec<BigInt>);

/// A rational number.
#[derive(Clone, Debug)]
pub(super) struct Point {
    numerator: BigInt,
    /// Positive.
    denominator: BigInt,
}

impl Point {
    /// The exact value of a finite double.
    pub(super) fn new(x: f64) -> Self {
        let bits = x.abs().to_bits();
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, exponent) = match (bits >> 52) as i64 {
            0 => (fraction, -1074),
            biased => (fraction | 1 << 52, biased - 1075),
        };
        let zeros = if mantissa == 0 { 0 } else { i64::from(mantissa.trailing_zeros()) };
        let shift = |n: BigInt, by: i64| n << by.max(0).unsigned_abs();
        let mantissa = BigInt::from(mantissa >> zeros) * if x < 0.0 { -1 } else { 1 };
        let exponent = exponent + zeros;
        Self { numerator: shift(mantissa, exponent), denominator: shift(BigInt::one(), -exponent) }
    }

    /// Numerator and denominator.
    pub(super) fn parts(self) -> (BigInt, BigInt) {
        (self.numerator, self.denominator)
    }

    /// `(self - other) / divisor`, for a divisor that is not 0.
    pub(super) fn difference_over(&self, other: &Self, divisor: &Self) -> Self {
        let difference =
            &self.numerator * &other.denominator - &other.numerator * &self.denominator;
        let sign = divisor.numerator.signum();
        Self {
            numerator: difference * &divisor.denominator * sign,
            denominator: &self.denominator * &other.denominator * divisor.numerator.abs(),
        }
    }
}

impl PartialEq for Point {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Point {}

impl PartialOrd for Point {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Point {
    fn cmp(&self, other: &Self) -> Ordering {
        (&self.numerator * &other.denominator).cmp(&(&other.numerator * &self.denominator))
    }
}

impl Polynomial {
    pub(super) fn new(mut coefficients: Vec<BigInt>) -> Self {
        while coefficients.last().is_some_and(Zero::is_zero) {
            coefficients.pop();
        }
        Self(coefficients)
    }

    pub(super) fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// The degree; 0 for 0.
    pub(super) fn degree(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    /// Bits of the largest coefficient.
    pub(super) fn bits(&self) -> u64 {
        self.0.iter().map(BigInt::bits).max().unwrap_or(0)
    }

    fn leading(&self) -> &BigInt {
        self.0.last().expect("not 0")
    }

    pub(super) fn derivative(&self) -> Self {
        Self::new(self.0.iter().enumerate().skip(1).map(|(k, c)| c * k).collect())
    }

    /// Divided by the (positive) greatest common divisor of its coefficients.
    fn primitive(mut self) -> Self {
        let content = self.0.iter().fold(BigInt::zero(), |g, c| common_divisor(g, c.clone()));
        if content > BigInt::one() {
            self.0.iter_mut().for_each(|c| *c /= &content);
        }
        self
    }

    /// A positive multiple of the remainder of division by `divisor`.
    fn remainder(&self, divisor: &Self) -> Self {
        let lead = divisor.leading();
        let mut rest = self.0.clone();
        while rest.len() >= divisor.0.len() {
            let Some(top) = rest.pop() else { break };
            if top.is_zero() {
                continue;
            }
            // |lead| rest - sign(lead) top x^shift divisor, whose leading term vanishes.
            let factor = if lead.is_negative() { -top } else { top };
            let shift = rest.len() + 1 - divisor.0.len();
            rest.iter_mut().for_each(|c| *c *= lead.abs());
            for (i, c) in divisor.0[..divisor.degree()].iter().enumerate() {
                rest[shift + i] -= &factor * c;
            }
        }
        Self::new(rest).primitive()
    }

    /// The greatest common divisor, primitive.
    pub(super) fn gcd(&self, other: &Self) -> Self {
        let (mut a, mut b) = (self.clone().primitive(), other.clone().primitive());
        while !b.is_zero() {
            (a, b) = (b.clone(), a.remainder(&b));
        }
        a
    }

    /// A multiple of the quotient by a divisor that leaves no remainder.
    pub(super) fn quotient(&self, divisor: &Self) -> Self {
        let lead = divisor.leading();
        let mut rest = self.0.clone();
        let mut quotient = Vec::new();
        while rest.len() >= divisor.0.len() {
            let Some(top) = rest.pop() else { break };
            let shift = rest.len() + 1 - divisor.0.len();
            rest.iter_mut().for_each(|c| *c *= lead);
            quotient.iter_mut().for_each(|c| *c *= lead);
            for (i, c) in divisor.0[..divisor.degree()].iter().enumerate() {
                rest[shift + i] -= &top * c;
            }
            quotient.push(top);
        }
        quotient.reverse();
        Self::new(quotient).primitive()
    }

    /// The sign at a point: -1, 0 or 1.
    pub(super) fn sign_at(&self, x: &Point) -> i32 {
        let mut value = BigInt::zero();
        let mut scale = BigInt::one();
        for c in self.0.iter().rev() {
            value = value * &x.numerator + c * &scale;
            scale *= &x.denominator;
        }
        match value.sign() {
            Sign::Minus => -1,
            Sign::NoSign => 0,
            Sign::Plus => 1,
        }
    }
}

fn common_divisor(mut a: BigInt, mut b: BigInt) -> BigInt {
    while !b.is_zero() {
        (a, b) = (b.clone(), a % b);
    }
    a.abs()
}

/// Sturm's chain of a polynomial without multiple roots.
#[derive(Clone, Debug)]
pub(super) struct Chain(Vec<Polynomial>);

impl Chain {
    pub(super) fn new(p: &Polynomial) -> Self {
        let mut chain = vec![p.clone()];
        let mut next = p.derivative().primitive();
        while !next.is_zero() {
            let last = chain[chain.len() - 1].clone();
            chain.push(next.clone());
            next = last.remainder(&next);
            next.0.iter_mut().for_each(|c| *c = -&*c);
        }
        Self(chain)
    }

    /// The number of roots in `(a, b]`.
    pub(super) fn count(&self, a: &Point, b: &Point) -> usize {
        self.variations(a).saturating_sub(self.variations(b))
    }

    fn variations(&self, x: &Point) -> usize {
        let mut signs = self.0.iter().map(|p| p.sign_at(x)).filter(|&s| s != 0);
        let mut last = signs.next().unwrap_or(0);
        let mut count = 0;
        for s in signs {
            count += usize::from(s != last);
            last = s;
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(c: &[i64]) -> Polynomial {
        Polynomial::new(c.iter().map(|&c| BigInt::from(c)).collect())
    }

    #[test]
    fn doubles_are_exact() {
        for x in [0.0, 1.0, -0.75, 3e-300, -5e-324, 1e300, 2f64.powi(60)] {
            let (n, d) = Point::new(x).parts();
            // n is exact in a double unless the shift was upwards; compare crosswise.
            let back: f64 =
                n.to_string().parse::<f64>().unwrap() / d.to_string().parse::<f64>().unwrap();
            assert!(back == x || d.bits() > 1000, "{x} {back}");
        }
        assert_eq!(Point::new(-0.75).parts(), (BigInt::from(-3), BigInt::from(4)));
        let third = Point::new(1.5).difference_over(&Point::new(2.0), &Point::new(-1.5));
        assert!(Point::new(0.333) < third && third < Point::new(0.334));
    }

    #[test]
    fn roots_are_counted_once_each() {
        // (x - 1)^2 (x + 2) (x - 3)^3
        let factors = [[-1, 1], [-1, 1], [2, 1], [-3, 1], [-3, 1], [-3, 1]];
        let mut p = vec![BigInt::one()];
        for [a, b] in factors {
            let mut next = vec![BigInt::zero(); p.len() + 1];
            for (i, c) in p.iter().enumerate() {
                next[i] += c * a;
                next[i + 1] += c * b;
            }
            p = next;
        }
        let p = Polynomial::new(p);
        let multiple = p.gcd(&p.derivative());
        assert_eq!(multiple.degree(), 3);
        let simple = p.quotient(&multiple);
        assert_eq!(simple.degree(), 3);
        for (root, other) in [(1.0, 0), (-2.0, 0), (3.0, 0), (0.0, 1)] {
            assert_eq!(simple.sign_at(&Point::new(root)) == 0, other == 0);
        }
        let chain = Chain::new(&simple);
        let count = |a, b| chain.count(&Point::new(a), &Point::new(b));
        assert_eq!(count(-10.0, 10.0), 3);
        assert_eq!(count(-10.0, -2.0), 1);
        assert_eq!(count(-2.0, 1.0), 1);
        assert_eq!(count(1.25, 2.875), 0);
        assert_eq!(count(1.25, 3.0), 1);
    }

    #[test]
    fn remainders_keep_their_sign() {
        // x^3 = (-2x + 1) q + 1/8: a positive remainder, by a divisor with a negative lead.
        let r = polynomial(&[0, 0, 0, 1]).remainder(&polynomial(&[1, -2]));
        assert_eq!(r, polynomial(&[1]));
        let r = polynomial(&[-5, 0, 1]).remainder(&polynomial(&[0, 1]));
        assert_eq!(r, polynomial(&[-1]));
    }
}
