//! Plain reals as numbers: rounded to nearest, without any bound.

use crate::real::forward_operators;
use crate::{Binary, Constant, Number, Real, Scalar, Unary};

/// The real `R` as a number: point evaluation.
#[derive(Clone, Copy, Debug)]
pub struct Plain<R>(pub R);

forward_operators!([R: Real] Plain<R>, |a, b| Plain(a.0 + b.0), Plain(a.0 - b.0),
    Plain(a.0 * b.0), Plain(a.0 / b.0), |c| Plain(-c.0));

use std::ops::{Add, Div, Mul, Neg, Sub};

impl<R: Real> Plain<R> {
    /// A scalar function in each lane.
    #[inline(always)]
    fn map(self, f: impl Fn(R::Scalar) -> R::Scalar) -> Self {
        let [y] = R::map([self.0], |[x]| [f(x)]);
        Self(y)
    }
}

impl<R: Real> Number for Plain<R> {
    #[inline(always)]
    fn constant(&self, c: &Constant) -> Self {
        Self(self.0.splat(R::Scalar::nearest(c)))
    }
    #[inline(always)]
    fn scale(self, c: &Constant) -> Self {
        self * self.constant(c)
    }
    #[inline(always)]
    fn offset(self, c: &Constant) -> Self {
        self + self.constant(c)
    }
    #[inline(always)]
    fn sqr(self) -> Self {
        self * self
    }
    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        let one = self.0.splat(R::Scalar::from_f64(1.0));
        let mut result = one;
        let mut square = self.0;
        let mut rest = n.unsigned_abs();
        while rest > 0 {
            if rest & 1 == 1 {
                result = result * square;
            }
            square = square * square;
            rest >>= 1;
        }
        Self(if n < 0 { one / result } else { result })
    }
    #[inline(always)]
    fn powc(self, c: &Constant) -> Self {
        let c = R::Scalar::nearest(c);
        self.map(|x| x.elementary2(Binary::Pow, c))
    }
    #[inline(always)]
    fn unary(self, f: Unary) -> Self {
        match f {
            Unary::Sqrt => Self(self.0.sqrt()),
            Unary::Abs => Self(self.0.abs()),
            Unary::Floor => Self(self.0.floor()),
            Unary::Ceil => Self(self.0.ceil()),
            _ => self.map(|x| x.elementary(f)),
        }
    }
    #[inline(always)]
    fn binary(self, f: Binary, o: Self) -> Self {
        match f {
            Binary::Min => Self(self.0.min(o.0)),
            Binary::Max => Self(self.0.max(o.0)),
            Binary::Mod => self - o * (self / o).unary(Unary::Floor),
            _ => {
                let [y] = R::map([self.0, o.0], |[x, y]| [x.elementary2(f, y)]);
                Self(y)
            }
        }
    }
}
