//! Sums, products, quotients and integer powers, rounded outward.

use std::ops::{Add, Div, Mul, Neg, Sub};

use astro_float::BigFloat;

use super::{BigInterval, Toward, integer};

/// The product, with `0 * inf = 0`.
fn product(x: &BigFloat, y: &BigFloat, precision: usize, toward: Toward) -> BigFloat {
    if x.is_zero() || y.is_zero() {
        return integer(0);
    }
    toward.settle(x.mul(y, precision, toward.mode()))
}

/// The quotient of a number and a divisor that is at least 0, with `x / 0 = inf`.
fn quotient(x: &BigFloat, y: &BigFloat, precision: usize, toward: Toward) -> BigFloat {
    if x.is_zero() || y.is_inf() {
        return integer(0);
    }
    if y.is_zero() {
        return if x.is_positive() { astro_float::INF_POS } else { astro_float::INF_NEG };
    }
    toward.settle(x.div(y, precision, toward.mode()))
}

/// `x^n` for `x >= 0`, `n >= 1`.
fn power(x: &BigFloat, n: u32, precision: usize, toward: Toward) -> BigFloat {
    // From the leading bit down, so that 2^n is exact.
    let mut result = x.clone();
    for bit in (0..n.ilog2()).rev() {
        result = product(&result, &result, precision, toward);
        if n >> bit & 1 == 1 {
            result = product(&result, x, precision, toward);
        }
    }
    result
}

impl Add for BigInterval {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let precision = self.precision.max(o.precision);
        if self.is_empty() || o.is_empty() {
            return Self::empty(precision);
        }
        let sum = |x: &BigFloat, y: &BigFloat, toward: Toward| {
            toward.settle(x.add(y, precision, toward.mode()))
        };
        Self::new(sum(&self.lo, &o.lo, Toward::Down), sum(&self.hi, &o.hi, Toward::Up), precision)
    }
}

impl Sub for BigInterval {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Neg for BigInterval {
    type Output = Self;
    fn neg(self) -> Self {
        if self.is_empty() {
            return self;
        }
        let turn = |x: BigFloat| if x.is_zero() { x } else { -x };
        Self::new(turn(self.hi), turn(self.lo), self.precision)
    }
}

impl Mul for BigInterval {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let precision = self.precision.max(o.precision);
        if self.is_empty() || o.is_empty() {
            return Self::empty(precision);
        }
        let extreme = |toward: Toward| {
            let term = |x, y| product(x, y, precision, toward);
            let first = toward.outer(term(&self.lo, &o.lo), term(&self.lo, &o.hi));
            let second = toward.outer(term(&self.hi, &o.lo), term(&self.hi, &o.hi));
            toward.outer(first, second)
        };
        Self::new(extreme(Toward::Down), extreme(Toward::Up), precision)
    }
}

impl Div for BigInterval {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let precision = self.precision.max(o.precision);
        if self.is_empty() || o.is_empty() || o.lo.is_zero() && o.hi.is_zero() {
            return Self::empty(precision);
        }
        let zero = integer(0);
        if o.lo < zero && o.hi > zero {
            let only_zero = self.lo.is_zero() && self.hi.is_zero();
            return if only_zero { self } else { Self::entire(precision) };
        }
        if o.lo < zero {
            return -self / -o;
        }
        // A divisor of one sign: the sign of the dividend tells which end to divide by.
        let low = if self.lo < zero { &o.lo } else { &o.hi };
        let high = if self.hi > zero { &o.lo } else { &o.hi };
        Self::new(
            quotient(&self.lo, low, precision, Toward::Down),
            quotient(&self.hi, high, precision, Toward::Up),
            precision,
        )
    }
}

impl BigInterval {
    /// The smallest and the largest absolute value.
    pub(super) fn magnitudes(&self) -> [BigFloat; 2] {
        let (lo, hi) = (self.lo.abs(), self.hi.abs());
        let [least, most] = if lo < hi { [lo, hi] } else { [hi, lo] };
        [if self.contains_zero() { integer(0) } else { least }, most]
    }

    /// `self^n` for `n >= 1`.
    pub(super) fn power(&self, n: u32) -> Self {
        if self.is_empty() {
            return self.clone();
        }
        let even = |x: &BigFloat, toward| power(x, n, self.precision, toward);
        if n.is_multiple_of(2) {
            let [least, most] = self.magnitudes();
            return Self::new(even(&least, Toward::Down), even(&most, Toward::Up), self.precision);
        }
        let odd = |x: &BigFloat, toward| match (x.is_negative(), toward) {
            (false, _) => power(x, n, self.precision, toward),
            (true, Toward::Down) => -power(&x.abs(), n, self.precision, Toward::Up),
            (true, Toward::Up) => -power(&x.abs(), n, self.precision, Toward::Down),
        };
        Self::new(odd(&self.lo, Toward::Down), odd(&self.hi, Toward::Up), self.precision)
    }
}
