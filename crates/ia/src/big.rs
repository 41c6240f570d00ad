//! Intervals of any precision.

use std::ops::{Add, Div, Mul, Neg, Sub};

use astro_float::{BigFloat, RoundingMode};

use crate::{Binary, Constant, Number, Unary};

/// An interval whose ends are binary floats of a chosen precision, rounded outward.
///
/// Set-based as in IEEE 1788, like `Interval<f64, Set>`: NaN at both ends is the empty interval.
/// The result of an operation has the larger precision of its operands.
#[derive(Clone, Debug)]
pub struct BigInterval {
    lo: BigFloat,
    hi: BigFloat,
    precision: usize,
}

impl BigInterval {
    /// The exact value of a finite double.
    pub fn from_f64(x: f64, precision: usize) -> Self {
        todo!("{x} {precision}")
    }
    /// The interval between two doubles.
    pub fn from_bounds(lo: f64, hi: f64, precision: usize) -> Self {
        todo!("{lo} {hi} {precision}")
    }
    /// Bits of the significand.
    pub fn precision(&self) -> usize {
        self.precision
    }
    /// The tightest enclosure by doubles.
    pub fn to_f64(&self) -> [f64; 2] {
        todo!()
    }
    /// The double nearest to the midpoint.
    pub fn nearest(&self) -> f64 {
        todo!()
    }
}

macro_rules! todo_operators { ($($trait:ident $name:ident),*) => {$(
    impl $trait for BigInterval { type Output = Self; fn $name(self, o: Self) -> Self { todo!("{o:?}") } }
)*}}
todo_operators!(Add add, Sub sub, Mul mul, Div div);
impl Neg for BigInterval {
    type Output = Self;
    fn neg(self) -> Self {
        todo!("{:?} {:?} {:?}", self.lo, self.hi, RoundingMode::Down)
    }
}
impl Number for BigInterval {
    fn constant(&self, c: &Constant) -> Self {
        c.big.clone()
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
        todo!()
    }
    fn powi(self, n: i32) -> Self {
        todo!("{n}")
    }
    fn powc(self, c: &Constant) -> Self {
        todo!("{c:?}")
    }
    fn unary(self, f: Unary) -> Self {
        todo!("{f}")
    }
    fn binary(self, f: Binary, other: Self) -> Self {
        todo!("{f} {other:?}")
    }
}
