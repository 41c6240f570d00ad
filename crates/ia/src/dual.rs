//! Forward-mode derivatives over any number.

use std::array;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::constant::{HALF, LN_2, LN_10, MINUS_ONE, ONE, THREE, TWO, ZERO};
use crate::{Binary, Constant, Number, Unary};

/// A value and `K` directional derivatives.
///
/// `K = 1` along a ray gives F'(t), `K = 3` the gradient. Over intervals each tangent encloses the
/// derivative wherever the function is differentiable in the box; where `abs`, `min` or `max` has a
/// kink it encloses the slopes on each side that the box reaches. The mean value theorem holds if the
/// value is continuous on the box as well ([`Decorated`](crate::Decorated) tells): a tangent sees
/// neither jumps, of which `floor`, `ceil`, `sign` and `mod` have slope 0 on both sides, nor poles.
/// An empty tangent, as of `sqrt` at 0 alone, claims nothing.
#[derive(Clone, Copy, Debug)]
pub struct Dual<N, const K: usize> {
    /// The value.
    pub value: N,
    /// The derivatives.
    pub tangent: [N; K],
}

// Loops over tangents rather than `array::map`, which may call its closure out of line: there, lanes
// have no instruction set.
impl<N: Number, const K: usize> Dual<N, K> {
    /// A number whose derivatives vanish.
    #[inline(always)]
    pub fn constant_value(value: N) -> Self {
        let zero = value.constant(&ZERO);
        Self { value, tangent: array::from_fn(|_| zero.clone()) }
    }

    /// The `axis`-th independent variable: its own tangent is 1, the others 0.
    #[inline(always)]
    pub fn variable(value: N, axis: usize) -> Self {
        let tangent = array::from_fn(|i| value.constant(if i == axis { &ONE } else { &ZERO }));
        Self { value, tangent }
    }

    /// `value` with every tangent multiplied by the slope.
    #[inline(always)]
    fn chain(mut self, value: N, slope: N) -> Self {
        for t in &mut self.tangent {
            *t = t.clone() * slope.clone();
        }
        Self { value, tangent: self.tangent }
    }

    /// `value` with the tangents `a * self' + b * other'`.
    #[inline(always)]
    fn combine(self, other: Self, value: N, a: N, b: N) -> Self {
        self.zip(
            other,
            value,
            #[inline(always)]
            |t, o| t * a.clone() + o * b.clone(),
        )
    }

    #[inline(always)]
    fn zip(self, other: Self, value: N, f: impl Fn(N, N) -> N) -> Self {
        let mut tangent = self.tangent;
        for (t, o) in tangent.iter_mut().zip(&other.tangent) {
            *t = f(t.clone(), o.clone());
        }
        Self { value, tangent }
    }
}

impl<N: Number, const K: usize> Add for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        let value = self.value.clone() + o.value.clone();
        self.zip(
            o,
            value,
            #[inline(always)]
            |a, b| a + b,
        )
    }
}

impl<N: Number, const K: usize> Sub for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        let value = self.value.clone() - o.value.clone();
        self.zip(
            o,
            value,
            #[inline(always)]
            |a, b| a - b,
        )
    }
}

impl<N: Number, const K: usize> Mul for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let (a, b) = (self.value.clone(), o.value.clone());
        self.combine(o, a.clone() * b.clone(), b, a)
    }
}

impl<N: Number, const K: usize> Div for Dual<N, K> {
    type Output = Self;
    /// `(a/b)' = (a' - (a/b) b') / b`.
    #[allow(clippy::suspicious_arithmetic_impl)]
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let quotient = self.value.clone() / o.value.clone();
        let (q, b) = (quotient.clone(), o.value.clone());
        self.zip(
            o,
            quotient,
            #[inline(always)]
            |da, db| (da - q.clone() * db) / b.clone(),
        )
    }
}

impl<N: Number, const K: usize> Neg for Dual<N, K> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for t in &mut self.tangent {
            *t = -t.clone();
        }
        Self { value: -self.value, tangent: self.tangent }
    }
}

impl<N: Number, const K: usize> Number for Dual<N, K> {
    #[inline(always)]
    fn constant(&self, c: &Constant) -> Self {
        Self::constant_value(self.value.constant(c))
    }

    #[inline(always)]
    fn scale(mut self, c: &Constant) -> Self {
        for t in &mut self.tangent {
            *t = t.clone().scale(c);
        }
        Self { value: self.value.scale(c), tangent: self.tangent }
    }

    #[inline(always)]
    fn offset(self, c: &Constant) -> Self {
        Self { value: self.value.offset(c), tangent: self.tangent }
    }

    #[inline(always)]
    fn sqr(self) -> Self {
        let slope = self.value.clone().scale(&TWO);
        let value = self.value.clone().sqr();
        self.chain(value, slope)
    }

    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        if n == 0 {
            return Self::constant_value(self.value.powi(0));
        }
        let x = self.value.clone();
        let value = x.clone().powi(n);
        // n x^(n-1); below 0 by a division, so that the exponent cannot overflow.
        let power = if n > 0 { x.powi(n - 1) } else { value.clone() / x };
        let slope = power.scale(&Constant::shared_integer(n));
        self.chain(value, slope)
    }

    #[inline(always)]
    fn powc(self, c: &Constant) -> Self {
        let value = self.value.clone().powc(c);
        let slope = self.value.clone().powc(&c.minus_one()).scale(c);
        self.chain(value, slope)
    }

    #[inline(always)]
    fn unary(self, f: Unary) -> Self {
        let x = self.value.clone();
        let y = x.clone().unary(f);
        let slope = match f {
            Unary::Sqrt => x.constant(&ONE) / y.clone().scale(&TWO),
            Unary::Cbrt => x.constant(&ONE) / y.clone().sqr().scale(&THREE),
            Unary::Abs => x.unary(Unary::Sign),
            Unary::Sign | Unary::Floor | Unary::Ceil => x.constant(&ZERO),
            Unary::Exp => y.clone(),
            Unary::Exp2 => y.clone().scale(&LN_2),
            Unary::Exp10 => y.clone().scale(&LN_10),
            Unary::Expm1 => y.clone().offset(&ONE),
            Unary::Log => x.constant(&ONE) / x,
            Unary::Log2 => x.constant(&ONE) / x.scale(&LN_2),
            Unary::Log10 => x.constant(&ONE) / x.scale(&LN_10),
            Unary::Logp1 => x.constant(&ONE) / x.offset(&ONE),
            Unary::Sin => x.unary(Unary::Cos),
            Unary::Cos => -x.unary(Unary::Sin),
            Unary::Tan => y.clone().sqr().offset(&ONE),
            Unary::Asin => x.constant(&ONE) / (x.constant(&ONE) - x.sqr()).unary(Unary::Sqrt),
            Unary::Acos => -(x.constant(&ONE) / (x.constant(&ONE) - x.sqr()).unary(Unary::Sqrt)),
            Unary::Atan => x.constant(&ONE) / x.sqr().offset(&ONE),
            Unary::Sinh => x.unary(Unary::Cosh),
            Unary::Cosh => x.unary(Unary::Sinh),
            Unary::Tanh => x.constant(&ONE) - y.clone().sqr(),
            Unary::Asinh => x.constant(&ONE) / x.sqr().offset(&ONE).unary(Unary::Sqrt),
            Unary::Acosh => x.constant(&ONE) / x.sqr().offset(&MINUS_ONE).unary(Unary::Sqrt),
            Unary::Atanh => x.constant(&ONE) / (x.constant(&ONE) - x.sqr()),
        };
        self.chain(y, slope)
    }

    #[inline(always)]
    fn binary(self, f: Binary, o: Self) -> Self {
        let (x, y) = (self.value.clone(), o.value.clone());
        let value = x.clone().binary(f, y.clone());
        match f {
            // The weight of the first operand is 1 where it is chosen, 0 where it is not.
            Binary::Min | Binary::Max => {
                let difference = if f == Binary::Min { y - x } else { x - y };
                let first = difference.unary(Unary::Sign).offset(&ONE).scale(&HALF);
                let second = first.constant(&ONE) - first.clone();
                self.combine(o, value, first, second)
            }
            Binary::Mod => {
                let steps = (x / y).unary(Unary::Floor);
                self.zip(
                    o,
                    value,
                    #[inline(always)]
                    |dx, dy| dx - steps.clone() * dy,
                )
            }
            Binary::Atan2 => {
                let norm = x.clone().sqr() + y.clone().sqr();
                self.combine(o, value, y / norm.clone(), -x / norm)
            }
            Binary::Hypot => {
                let (a, b) = (x / value.clone(), y / value.clone());
                self.combine(o, value, a, b)
            }
            Binary::Pow => {
                let slope = y.clone() * x.clone().binary(Binary::Pow, y.offset(&MINUS_ONE));
                let growth = value.clone() * x.unary(Unary::Log);
                self.combine(o, value, slope, growth)
            }
        }
    }
}
