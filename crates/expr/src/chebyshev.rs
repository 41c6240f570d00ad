//! Chebyshev polynomials in three forms.
//!
//! ```text
//! T      T_0 = 1, T_1 = x, T_k = 2x T_(k-1) - T_(k-2)
//! Tpow   sum of c_k x^k with integer c_k
//! Tcos   cos(n acos(x)) for |x| <= 1, sign(x)^n cosh(n acosh(|x|)) elsewhere
//! ```

use std::fmt::{self, Display};

use num_bigint::BigInt;
use num_traits::{Signed, Zero};
use zeroset_ia::{Binary, Unary};

use crate::graph::{Graph, Id};
use crate::rational::{Rational, integer};

/// The largest degree; beyond it coefficients leave the range of doubles.
pub(crate) const MAX_DEGREE: u32 = 512;

/// How a Chebyshev polynomial is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Form {
    /// By the recurrence.
    Recurrence,
    /// As a sum of powers.
    Powers,
    /// By cosines, as one product for all x: cos(n acos x) cosh(n acosh |x|), arguments clamped.
    Cosines,
}

impl Form {
    /// Every form.
    pub(crate) const ALL: [Self; 3] = [Self::Recurrence, Self::Powers, Self::Cosines];

    /// The name in an equation.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Recurrence => "T",
            Self::Powers => "Tpow",
            Self::Cosines => "Tcos",
        }
    }

    /// The form of that name.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|f| f.name() == name)
    }
}

impl Display for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Coefficients of `T_n`, from the constant upward.
fn coefficients(n: u32) -> Vec<BigInt> {
    let mut coefficients = vec![BigInt::ZERO; n as usize + 1];
    let mut c = BigInt::from(1) << n.saturating_sub(1);
    // (1 - x^2) T'' - x T' + n^2 T = 0 relates every other one.
    for k in (0..=n).rev().step_by(2) {
        coefficients[k as usize] = c.clone();
        if k >= 2 {
            c = -c * (k * (k - 1)) / (n * n - (k - 2) * (k - 2));
        }
    }
    coefficients
}

/// The exact value of `T_n` at a rational.
pub(crate) fn evaluate(n: u32, x: &Rational) -> Rational {
    let (mut before, mut last) = (integer(1), x.clone());
    for _ in 0..n {
        let next = x * &last * integer(2) - before;
        before = std::mem::replace(&mut last, next);
    }
    before
}

impl Graph {
    /// `T_n(x)` by operations of numbers.
    pub(crate) fn expand_chebyshev(&mut self, form: Form, n: u32, x: Id) -> Id {
        match form {
            Form::Recurrence => self.recurrence(n, x),
            Form::Powers => self.powers(n, x),
            Form::Cosines => self.cosines(n, x),
        }
    }

    fn recurrence(&mut self, n: u32, x: Id) -> Id {
        let [zero, two] = [0, 2].map(|n| self.constant(integer(n)));
        let twice = self.mul(two, x);
        // x^0 is 1 where x is defined.
        let (mut before, mut last) = (self.power(x, zero), x);
        for _ in 0..n {
            let product = self.mul(twice, last);
            let next = self.sub(product, before);
            before = std::mem::replace(&mut last, next);
        }
        before
    }

    fn powers(&mut self, n: u32, x: Id) -> Id {
        let mut sum = self.constant(integer(0));
        for (k, c) in coefficients(n).into_iter().enumerate().rev() {
            if c.is_zero() {
                continue;
            }
            let k = self.constant(integer(k));
            let power = self.power(x, k);
            let magnitude = self.constant(integer(c.abs()));
            let term = self.mul(magnitude, power);
            sum = if c.is_negative() { self.sub(sum, term) } else { self.add(sum, term) };
        }
        sum
    }

    fn cosines(&mut self, n: u32, x: Id) -> Id {
        let [minus_one, one, n] = [-1, 1, i64::from(n)].map(|n| self.constant(integer(n)));
        let clamped = self.binary(Binary::Max, x, minus_one);
        let clamped = self.binary(Binary::Min, clamped, one);
        let angle = self.unary(Unary::Acos, clamped);
        let angle = self.mul(n, angle);
        let inner = self.unary(Unary::Cos, angle);
        let beyond = self.unary(Unary::Abs, x);
        let beyond = self.binary(Binary::Max, beyond, one);
        let length = self.unary(Unary::Acosh, beyond);
        let length = self.mul(n, length);
        let outer = self.unary(Unary::Cosh, length);
        self.mul(inner, outer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_agree_with_the_recurrence() {
        assert_eq!(coefficients(4), [1, 0, -8, 0, 8].map(BigInt::from));
        let x = Rational::new(7.into(), 5.into());
        for n in [0, 1, 2, 7, 50, MAX_DEGREE] {
            let mut sum = integer(0);
            for c in coefficients(n).into_iter().rev() {
                sum = sum * &x + Rational::from_integer(c);
            }
            assert_eq!(sum, evaluate(n, &x));
        }
    }

    #[test]
    fn coefficients_are_doubles() {
        let largest = coefficients(MAX_DEGREE).into_iter().map(|c| c.bits()).max();
        assert!(largest.unwrap() < 1023);
    }
}
