//! exp, log, sin, cos and powers of single floats, computed in double precision.
//!
//! The error of each result before the last rounding is below 2^-40 of its value, so that the float
//! is within 0.51 units in the last place: [`Scalar::elementary_down`] and `elementary_up` step over
//! that. The margin is wide: the series are cut where the rest is below 2^-55, and a dozen roundings
//! of 2^-53 each follow. Neither fused operations nor tables: every machine gives the same bits.
//!
//! Arguments beyond the ranges stated are left to the caller.
//!
//! [`Scalar::elementary_down`]: crate::Scalar::elementary_down

use std::f64::consts::{FRAC_2_PI, LN_2, LOG2_E};

/// log(2) in two parts: the first has 32 bits, so that its product with an exponent is exact.
const LN_2_HI: f64 = f64::from_bits(0x3fe6_2e42_fee0_0000);
const LN_2_LO: f64 = f64::from_bits(0x3dea_39ef_3579_3c76);

/// pi/2 in three parts, the first two of 33 bits.
const HALF_PI: [f64; 3] = [
    f64::from_bits(0x3ff9_21fb_5440_0000),
    f64::from_bits(0x3dd0_b461_1a60_0000),
    f64::from_bits(0x3ba3_198a_2e03_7073),
];

/// 3 2^51: added to a number below 2^50, it leaves the nearest integer in the last bits, without a
/// call that machines of the baseline need for `floor`.
const SHIFT: f64 = 6_755_399_441_055_744.0;

/// The nearest integer, as a number and as its bits; for |x| < 2^50.
#[inline(always)]
fn nearest_integer(x: f64) -> (f64, i64) {
    let shifted = x + SHIFT;
    (shifted - SHIFT, shifted.to_bits().wrapping_sub(SHIFT.to_bits()) as i64)
}

/// The largest integer at most x.
#[inline(always)]
pub(crate) fn floor(x: f64) -> f64 {
    const LIMIT: f64 = (1_u64 << 50) as f64;
    if x.abs() < LIMIT {
        let (nearest, _) = nearest_integer(x);
        if nearest > x { nearest - 1.0 } else { nearest }
    } else {
        x.floor()
    }
}

/// The largest |x| for [`sin`] and [`cos`].
pub(crate) const LARGEST_ANGLE: f32 = 1_048_576.0;

/// c_0 + c_1 x + ...
#[inline(always)]
fn polynomial<const N: usize>(x: f64, c: [f64; N]) -> f64 {
    let mut sum = 0.0;
    for c in c.into_iter().rev() {
        sum = sum * x + c;
    }
    sum
}

/// 1/n! for n = first, first + step, ..., with alternating signs if `sign` is -1.
const fn inverse_factorials<const N: usize>(first: u32, step: u32, sign: f64) -> [f64; N] {
    let mut terms = [0.0; N];
    let (mut i, mut n, mut factorial, mut s) = (0, 0, 1.0, 1.0);
    while i < N {
        let target = first + step * i as u32;
        while n < target {
            n += 1;
            factorial *= n as f64;
        }
        terms[i] = s / factorial;
        s *= sign;
        i += 1;
    }
    terms
}

/// e^x as a double, for |x| <= 700.
///
/// e^x = 2^k e^r with k = round(x / log 2) and |r| <= 0.35; the series of e^r to r^13, whose rest is
/// below 2^-57.
#[inline(always)]
fn exp_double(x: f64) -> f64 {
    const TERMS: [f64; 14] = inverse_factorials(0, 1, 1.0);
    let (k, exponent) = nearest_integer(x * LOG2_E);
    let r = (x - k * LN_2_HI) - k * LN_2_LO;
    let scale = f64::from_bits(((exponent + 1023) as u64) << 52);
    polynomial(r, TERMS) * scale
}

/// log(x) as a double, for a positive, finite, normal x.
///
/// x = 2^k m with m in [0.7, 1.42]; log m = 2 artanh s with s = (m - 1) / (m + 1), |s| <= 0.172; the
/// series to s^21, whose rest is below 2^-58 of the sum.
#[inline(always)]
fn log_double(x: f64) -> f64 {
    const TERMS: [f64; 11] = {
        let mut terms = [0.0; 11];
        let mut i = 0;
        while i < 11 {
            terms[i] = 2.0 / (2 * i + 1) as f64;
            i += 1;
        }
        terms
    };
    // The bits of 1/sqrt(2) are taken off, so that the exponent's carry splits at that mantissa.
    const SPLIT: u64 = std::f64::consts::FRAC_1_SQRT_2.to_bits();
    let offset = x.to_bits().wrapping_sub(SPLIT) as i64 >> 52;
    let m = f64::from_bits(x.to_bits().wrapping_sub((offset << 52) as u64));
    let s = (m - 1.0) / (m + 1.0);
    offset as f64 * LN_2 + s * polynomial(s * s, TERMS)
}

/// sin(x + quarter pi / 2) as a double, for |x| <= [`LARGEST_ANGLE`].
///
/// The angle is reduced to |r| <= pi/4: the products with the first two parts of pi/2 are exact. The
/// series of sine to r^17 and of cosine to r^18 leave less than 2^-60.
#[inline(always)]
fn sine_double(x: f64, quarter: i64) -> f64 {
    const SINE: [f64; 9] = inverse_factorials(1, 2, -1.0);
    const COSINE: [f64; 10] = inverse_factorials(0, 2, -1.0);
    let (k, quarters) = nearest_integer(x * FRAC_2_PI);
    let r = ((x - k * HALF_PI[0]) - k * HALF_PI[1]) - k * HALF_PI[2];
    let quadrant = quarters + quarter;
    let square = r * r;
    let sine = r * polynomial(square, SINE);
    let cosine = polynomial(square, COSINE);
    let value = if quadrant & 1 == 0 { sine } else { cosine };
    if quadrant & 2 == 0 { value } else { -value }
}

/// e^x.
#[inline]
pub(crate) fn exp(x: f32) -> f32 {
    // Beyond, the float is infinite or 0; NaN stays.
    exp_double(f64::from(x).clamp(-200.0, 200.0)) as f32
}

/// The natural logarithm.
#[inline]
pub(crate) fn log(x: f32) -> f32 {
    if x > 0.0 && x < f32::INFINITY {
        log_double(f64::from(x)) as f32
    } else if x == 0.0 {
        f32::NEG_INFINITY
    } else if x < 0.0 {
        f32::NAN
    } else {
        x
    }
}

/// The sine, for |x| <= [`LARGEST_ANGLE`].
#[inline]
pub(crate) fn sin(x: f32) -> f32 {
    sine_double(f64::from(x), 0) as f32
}

/// The cosine, for |x| <= [`LARGEST_ANGLE`].
#[inline]
pub(crate) fn cos(x: f32) -> f32 {
    sine_double(f64::from(x), 1) as f32
}

/// x^y = e^(y log x) for a positive, finite x, if |y log x| is so small that its error stays below
/// 2^-42: the result then is a normal float.
#[inline]
pub(crate) fn pow(x: f32, y: f32) -> Option<f32> {
    if !(x > 0.0 && x < f32::INFINITY) {
        return None;
    }
    let exponent = f64::from(y) * log_double(f64::from(x));
    (exponent.abs() < 80.0).then(|| exp_double(exponent) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BigInterval, Binary, Number, Unary};

    /// The distance of a float from the exact value, in units in the last place of the float.
    fn error(y: f32, exact: &BigInterval) -> f64 {
        let [lo, hi] = exact.to_f64();
        let ulp = f64::from((y.abs().next_up()) - y.abs());
        (f64::from(y) - 0.5 * (lo + hi)).abs() / ulp
    }

    /// Floats of every exponent up to `limit`, several mantissas each, both signs.
    fn floats(limit: f32, mut visit: impl FnMut(f32)) {
        let mut bits = 1_u32;
        while f32::from_bits(bits) <= limit {
            visit(f32::from_bits(bits));
            visit(-f32::from_bits(bits));
            bits += 4_194_301;
        }
        // Multiples of pi/2, where sine and cosine vanish.
        for i in 1..500 {
            let x = (f64::from(i * i) * std::f64::consts::FRAC_PI_2) as f32;
            for x in [x, x.next_up(), x.next_down()] {
                if x <= limit {
                    visit(x);
                    visit(-x);
                }
            }
        }
    }

    #[test]
    fn errors_are_below_their_bound() {
        let mut worst = 0.0_f64;
        let mut check = |f: Unary, x: f32, y: f32| {
            let exact = BigInterval::from_f64(f64::from(x), 192).unary(f);
            let e = error(y, &exact);
            assert!(e < 0.51, "{f}({x:e}) = {y:e}, wrong by {e} units");
            worst = worst.max(e);
        };
        floats(88.0, |x| check(Unary::Exp, x, exp(x)));
        floats(LARGEST_ANGLE, |x| check(Unary::Sin, x, sin(x)));
        floats(LARGEST_ANGLE, |x| check(Unary::Cos, x, cos(x)));
        floats(f32::MAX, |x| {
            if x > 0.0 {
                check(Unary::Log, x, log(x));
            }
        });
        assert!(worst > 0.4, "the test sees errors");
    }

    #[test]
    fn powers_are_within_their_bound() {
        floats(1e30, |x| {
            for y in [0.75_f32, 2.5, -1.3, 0.1, 3.0, 0.3333] {
                let Some(power) = (x > 0.0).then(|| pow(x, y)).flatten() else { continue };
                let [base, exponent] = [x, y].map(|v| BigInterval::from_f64(f64::from(v), 192));
                let e = error(power, &base.binary(Binary::Pow, exponent));
                assert!(e < 0.51, "{x:e}^{y} = {power:e}, wrong by {e} units");
            }
        });
    }

    #[test]
    fn integers_below() {
        let big = (1_u64 << 50) as f64;
        for x in [0.0, -0.0, 0.5, 1.5, 2.5, -0.5, -1.5, 0.999, -1e-300, 7.0, -7.0, big, -big, 1e300]
        {
            for x in [x, f64::next_up(x), f64::next_down(x)] {
                assert_eq!(floor(x), x.floor(), "{x}");
            }
        }
        assert!(floor(f64::NAN).is_nan() && floor(f64::INFINITY) == f64::INFINITY);
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!(exp(f32::NEG_INFINITY), 0.0);
        assert_eq!(exp(f32::INFINITY), f32::INFINITY);
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(log(0.0), f32::NEG_INFINITY);
        assert_eq!(log(f32::INFINITY), f32::INFINITY);
        assert_eq!(log(1.0), 0.0);
        assert!(exp(f32::NAN).is_nan() && log(f32::NAN).is_nan() && log(-1.0).is_nan());
        assert!(sin(f32::NAN).is_nan() && cos(f32::NAN).is_nan());
        assert_eq!(pow(0.0, 2.0), None);
    }
}
