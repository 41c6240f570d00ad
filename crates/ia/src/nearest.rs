//! Rounding to nearest: reals that prove nothing.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::real::{forward, forward_operators};
use crate::{Constant, Packet, Real, Scalar};

/// The real `R` with marks that do nothing: arithmetic as the papers have it, which proves nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest<R>(pub R);

/// Written out, since the derived `<` goes through `partial_cmp` and costs ten times as much.
impl<R: PartialOrd> PartialOrd for Nearest<R> {
    #[inline(always)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.partial_cmp(&other.0)
    }
    #[inline(always)]
    fn lt(&self, other: &Self) -> bool {
        self.0 < other.0
    }
    #[inline(always)]
    fn le(&self, other: &Self) -> bool {
        self.0 <= other.0
    }
    #[inline(always)]
    fn gt(&self, other: &Self) -> bool {
        self.0 > other.0
    }
    #[inline(always)]
    fn ge(&self, other: &Self) -> bool {
        self.0 >= other.0
    }
}

forward_operators!([R: Real] Nearest<R>, |a, b| Nearest(a.0 + b.0), Nearest(a.0 - b.0),
    Nearest(a.0 * b.0), Nearest(a.0 / b.0), |c| Nearest(-c.0));

impl<R: Real> Real for Nearest<R>
where
    Nearest<R::Scalar>: Scalar,
{
    type Scalar = Nearest<R::Scalar>;
    const OUTWARD: bool = false;

    #[inline(always)]
    fn splat(self, c: Self::Scalar) -> Self {
        Nearest(self.0.splat(c.0))
    }
    forward! { sqrt(); abs(); floor(); min(o); max(o); select_lt(o, x, y); }
    #[inline(always)]
    fn down(self) -> Self {
        self
    }
    #[inline(always)]
    fn up(self) -> Self {
        self
    }
    #[inline(always)]
    fn map<const N: usize, const M: usize>(
        x: [Self; N],
        f: impl Fn([Self::Scalar; N]) -> [Self::Scalar; M],
    ) -> [Self; M] {
        R::map(
            x.map(|x| x.0),
            #[inline(always)]
            |x| f(x.map(Nearest)).map(|y| y.0),
        )
        .map(Nearest)
    }
}

impl<R: Packet> Packet for Nearest<R>
where
    Nearest<R::Scalar>: Scalar,
{
    const LANES: usize = R::LANES;

    #[inline(always)]
    fn from_fn(self, mut f: impl FnMut(usize) -> Self::Scalar) -> Self {
        Nearest(self.0.from_fn(
            #[inline(always)]
            |i| f(i).0,
        ))
    }
    #[inline(always)]
    fn lane(self, i: usize) -> Self::Scalar {
        Nearest(self.0.lane(i))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u64 {
        self.0.lt(other.0)
    }
    #[inline(always)]
    fn le(self, other: Self) -> u64 {
        self.0.le(other.0)
    }
    #[inline(always)]
    fn select(self, mask: u64, x: Self, y: Self) -> Self {
        Nearest(self.0.select(mask, x.0, y.0))
    }
    #[inline(always)]
    fn region<T>(self, work: impl FnOnce() -> T) -> T {
        self.0.region(work)
    }
}

macro_rules! nearest_scalar {
    ($float:ty) => {
        impl Scalar for Nearest<$float> {
            const INFINITY: Self = Nearest(<$float>::INFINITY);
            const NAN: Self = Nearest(<$float>::NAN);

            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                Nearest(<$float as Scalar>::from_f64(x))
            }
            #[inline(always)]
            fn enclose(c: &Constant) -> [Self; 2] {
                [Self::nearest(c); 2]
            }
            #[inline(always)]
            fn nearest(c: &Constant) -> Self {
                Nearest(<$float as Scalar>::nearest(c))
            }
            fn enclose_range(lo: f64, hi: f64) -> [Self; 2] {
                [Self::from_f64(lo), Self::from_f64(hi)]
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.0.to_f64()
            }
            fn elementary(self, f: crate::Unary) -> Self {
                Nearest(self.0.elementary(f))
            }
            fn elementary2(self, f: crate::Binary, y: Self) -> Self {
                Nearest(self.0.elementary2(f, y.0))
            }
            fn power(self, n: i32) -> Self {
                Nearest(self.0.power(n))
            }
            fn elementary_down(self) -> Self {
                self
            }
            fn elementary_up(self) -> Self {
                self
            }
        }
    };
}
nearest_scalar!(f32);
nearest_scalar!(f64);
