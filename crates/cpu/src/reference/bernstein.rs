//! Polynomials in Bernstein form.

use std::ops::{Add, Div, Mul, Neg, Sub};

use zeroset_ia::{Binary, Constant, Number, Unary};

use super::outward::{Outward, Sign};

/// A polynomial of u in [0, 1] in scaled Bernstein form, `sum c_i u^i (1-u)^(n-i)`.
///
/// A homogeneous polynomial in u and 1 - u: products are convolutions, and a lower degree is raised
/// by factors `u + (1-u) = 1`. No product or sum of such forms cancels more than its value at the
/// ends would, which powers of u do at high degree.
#[derive(Clone, Debug)]
pub(super) struct Scaled<N>(Vec<N>);

impl<N: Outward> Scaled<N> {
    /// The line from `start` at u = 0 to `end` at u = 1.
    pub(super) fn line(start: N, end: N) -> Self {
        Self(vec![start, end])
    }

    /// The coefficients `c_i / C(n,i)`, in whose hull all values lie.
    pub(super) fn coefficients(self) -> Vec<N> {
        let n = self.0.len() - 1;
        let mut binomial = 1_u128;
        let mut coefficients = self.0;
        for (i, c) in coefficients.iter_mut().enumerate() {
            if binomial > 1 {
                *c = c.clone() / natural(c, binomial);
            }
            binomial = binomial * (n - i) as u128 / (i as u128 + 1);
        }
        coefficients
    }

    fn degree(&self) -> usize {
        self.0.len() - 1
    }

    /// The same polynomial with at least the given degree.
    fn raise(mut self, degree: usize) -> Self {
        while self.degree() < degree {
            multiply_by_sum(&mut self.0);
        }
        self
    }

    fn zip(self, other: Self, f: impl Fn(N, N) -> N) -> Self {
        let degree = self.degree().max(other.degree());
        let (a, b) = (self.raise(degree).0, other.raise(degree).0);
        Self(a.into_iter().zip(b).map(|(a, b)| f(a, b)).collect())
    }

    fn map(self, f: impl FnMut(N) -> N) -> Self {
        Self(self.0.into_iter().map(f).collect())
    }

    /// The result of an operation that gives a polynomial for constants only: otherwise unknown.
    fn constant_only(self, f: impl FnOnce(N) -> N) -> Self {
        let mut terms = self.0.into_iter();
        match (terms.next(), terms.next()) {
            (Some(c), None) => Self(vec![f(c)]),
            (Some(c), _) => Self(vec![c.entire()]),
            (None, _) => unreachable!("a polynomial has a coefficient"),
        }
    }
}

/// Multiplies a form in u and v by u + v.
fn multiply_by_sum<N: Number>(terms: &mut Vec<N>) {
    let last = terms[terms.len() - 1].clone();
    for i in (1..terms.len()).rev() {
        terms[i] = terms[i].clone() + terms[i - 1].clone();
    }
    terms.push(last);
}

/// A natural number, in the context of `like`.
fn natural<N: Outward>(like: &N, n: u128) -> N {
    const SPLIT: u32 = 53;
    if n >> SPLIT == 0 {
        return like.exact(n as f64);
    }
    let low = n & ((1 << SPLIT) - 1);
    natural(like, n >> SPLIT) * like.exact(f64::from(SPLIT).exp2()) + like.exact(low as f64)
}

/// A form in the powers of `s = 2u - 1`, `sum a_k s^k`, in Bernstein form.
pub(super) fn from_powers<N: Outward>(powers: Vec<N>) -> Vec<N> {
    let mut form: Option<Vec<N>> = None;
    for (k, a) in powers.into_iter().rev().enumerate() {
        // Horner's rule on homogeneous forms: times u - v, plus a (u + v)^k.
        let mut next = vec![a];
        (0..k).for_each(|_| multiply_by_sum(&mut next));
        if let Some(form) = form {
            for (i, c) in form.into_iter().enumerate() {
                next[i] = next[i].clone() - c.clone();
                next[i + 1] = next[i + 1].clone() + c;
            }
        }
        form = Some(next);
    }
    Scaled(form.expect("at least one power")).coefficients()
}

/// The coefficients on [0, u] and on [u, 1] by de Casteljau's scheme, for u in eighths.
pub(super) fn split<N: Outward>(mut coefficients: Vec<N>, eighths: u8) -> [Vec<N>; 2] {
    let mut left = Vec::with_capacity(coefficients.len());
    for last in (0..coefficients.len()).rev() {
        left.push(coefficients[0].clone());
        for i in 0..last {
            coefficients[i] = coefficients[i].blend(&coefficients[i + 1], eighths);
        }
    }
    [left, coefficients]
}

/// The sign that the polynomial has on all of [0, 1].
pub(super) fn sign<N: Outward>(coefficients: &[N]) -> Sign {
    let first = coefficients[0].sign();
    if coefficients.iter().all(|c| c.sign() == first) { first } else { Sign::Unknown }
}

/// The derivative by u, enclosed on all of [0, 1], if it has one sign there.
pub(super) fn slope<N: Outward>(coefficients: &[N]) -> Option<N> {
    let n = coefficients.len() - 1;
    let mut hull: Option<N> = None;
    for pair in coefficients.windows(2) {
        let difference = pair[1].clone() - pair[0].clone();
        let union = hull.map_or_else(|| difference.clone(), |h| h.union(&difference));
        if !matches!(union.sign(), Sign::Positive | Sign::Negative) {
            return None;
        }
        hull = Some(union);
    }
    hull.map(|h| h.clone() * h.exact(n as f64))
}

/// Is the uncertainty of single coefficients comparable to the spread of all?
pub(super) fn is_blurred<N: Outward>(coefficients: &[N]) -> bool {
    let mut widest = 0.0_f64;
    let mut hull = [f64::INFINITY, f64::NEG_INFINITY];
    for c in coefficients {
        let [lo, hi] = c.bounds();
        widest = widest.max(hi - lo);
        hull = [hull[0].min(lo), hull[1].max(hi)];
    }
    !(8.0 * widest < hull[1] - hull[0])
}

impl<N: Outward> Add for Scaled<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<N: Outward> Sub for Scaled<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl<N: Outward> Neg for Scaled<N> {
    type Output = Self;
    fn neg(self) -> Self {
        self.map(|c| -c)
    }
}

impl<N: Outward> Mul for Scaled<N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let degree = self.degree() + other.degree();
        let mut terms: Vec<Option<N>> = vec![None; degree + 1];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate() {
                accumulate(&mut terms[i + j], a.clone() * b.clone());
            }
        }
        collect(terms)
    }
}

/// Adds to a sum that may not have begun.
fn accumulate<N: Number>(sum: &mut Option<N>, term: N) {
    *sum = Some(match sum.take() {
        None => term,
        Some(s) => s + term,
    });
}

fn collect<N>(terms: Vec<Option<N>>) -> Scaled<N> {
    Scaled(terms.into_iter().map(|t| t.expect("each power has a term")).collect())
}

impl<N: Outward> Div for Scaled<N> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        match &other.0[..] {
            [divisor] => self.map(|c| c / divisor.clone()),
            _ => Self(vec![self.0[0].entire()]),
        }
    }
}

impl<N: Outward> Number for Scaled<N> {
    fn constant(&self, c: &Constant) -> Self {
        Self(vec![self.0[0].constant(c)])
    }

    fn scale(self, c: &Constant) -> Self {
        self.map(|x| x.scale(c))
    }

    fn offset(self, c: &Constant) -> Self {
        let c = self.constant(c);
        self + c
    }

    fn sqr(self) -> Self {
        let mut mixed: Vec<Option<N>> = vec![None; 2 * self.degree() + 1];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in self.0.iter().enumerate().skip(i + 1) {
                accumulate(&mut mixed[i + j], a.clone() * b.clone());
            }
        }
        let mut terms: Vec<_> = mixed.into_iter().map(|t| t.map(|t| t.clone() + t)).collect();
        for (i, a) in self.0.into_iter().enumerate() {
            accumulate(&mut terms[2 * i], a.sqr());
        }
        collect(terms)
    }

    fn powi(self, n: i32) -> Self {
        let Ok(n) = u32::try_from(n) else {
            return self.constant_only(|c| c.powi(n));
        };
        if n == 0 || self.degree() == 0 {
            return Self(vec![self.0[0].clone().powi(n as i32)]);
        }
        // From the leading bit down.
        let mut power = self.clone();
        for bit in (0..n.ilog2()).rev() {
            power = power.sqr();
            if n >> bit & 1 == 1 {
                power = power * self.clone();
            }
        }
        power
    }

    fn powc(self, c: &Constant) -> Self {
        self.constant_only(|x| x.powc(c))
    }

    fn unary(self, f: Unary) -> Self {
        self.constant_only(|c| c.unary(f))
    }

    fn binary(self, f: Binary, other: Self) -> Self {
        match &other.0[..] {
            [y] => self.constant_only(|x| x.binary(f, y.clone())),
            _ => Self(vec![self.0[0].entire()]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::outward::Double;
    use super::*;

    fn doubles(x: &[f64]) -> Vec<Double> {
        x.iter().map(|&x| Double::point(x)).collect()
    }

    fn assert_encloses(coefficients: &[Double], expected: &[f64]) {
        assert_eq!(coefficients.len(), expected.len());
        for (c, &e) in coefficients.iter().zip(expected) {
            assert!(c.contains(e) && c.hi - c.lo < 1e-13, "{c:?} should be {e}");
        }
    }

    #[test]
    fn products_and_sums_enclose_the_polynomial() {
        // x = 1 + u: x^3 - 2 x^2 + 5, whose Bernstein coefficients are worked out by hand:
        // 4 - u + u^2 + u^3 = [4, 4 - 1/3, 4 - 2/3 + 1/3, 5].
        let x = Scaled::line(Double::point(1.0), Double::point(2.0));
        let two = Constant::from_f64(2.0);
        let five = Constant::from_f64(5.0);
        let f = (x.clone().powi(3) - x.sqr().scale(&two)).offset(&five);
        assert_encloses(&f.coefficients(), &[4.0, 11.0 / 3.0, 11.0 / 3.0, 5.0]);
    }

    #[test]
    fn powers_are_converted() {
        // s^2 on [-1, 1] has the Bernstein coefficients 1, -1, 1.
        assert_encloses(&from_powers(doubles(&[0.0, 0.0, 1.0])), &[1.0, -1.0, 1.0]);
        assert_encloses(&from_powers(doubles(&[3.0, 2.0])), &[1.0, 5.0]);
    }

    #[test]
    fn halves_and_eighths_meet_at_the_value() {
        for eighths in [3, 4, 5] {
            let u = f64::from(eighths) / 8.0;
            // 1 - 3u + 2u^2 is [1, -1/2, 0].
            let [left, right] = split(doubles(&[1.0, -0.5, 0.0]), eighths);
            let value = 1.0 - 3.0 * u + 2.0 * u * u;
            assert!(left[2].contains(value) && right[0].contains(value));
            assert_eq!([left[0].lo, right[2].hi], [1.0, 0.0]);
        }
    }

    #[test]
    fn large_binomials_are_enclosed() {
        // (u + v)^70 is the constant 1.
        let one = Scaled(doubles(&[1.0])).raise(70);
        assert_encloses(&one.coefficients(), &[1.0; 71]);
    }

    #[test]
    fn what_is_no_polynomial_is_unknown() {
        let x = Scaled::line(Double::point(1.0), Double::point(2.0));
        let unknown = x.unary(Unary::Sqrt).coefficients();
        assert_eq!(unknown[0].bounds(), [f64::NEG_INFINITY, f64::INFINITY]);
    }
}
