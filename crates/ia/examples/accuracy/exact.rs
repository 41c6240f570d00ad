//! The error of a value, settled by arithmetic of any precision.

use zeroset_ia::{BigInterval, Scalar};

/// How a value compares with a bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Settled {
    /// The error is at most the bound; about how large it is.
    Within(f64),
    /// It is larger.
    Beyond(f64),
    /// Not even the highest precision tells.
    Open,
}

/// The precisions tried in turn, in bits.
const PRECISIONS: [usize; 3] = [128, 320, 1088];

/// The neighbour of `y` on one side.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Side {
    Below,
    Above,
}

/// The neighbour of `y` on a side.
pub(crate) fn neighbour<S: Scalar>(y: S, side: Side) -> S {
    match side {
        Side::Below => y.down(),
        Side::Above => y.up(),
    }
}

/// The value, and for an infinity the power of two that overflows, by which rounding decides.
fn at<S: Scalar>(y: S, precision: usize) -> BigInterval {
    let y = y.to_f64();
    if y.is_finite() {
        return BigInterval::from_f64(y, precision);
    }
    let exponent = if size_of::<S>() == 4 { 127 } else { 1023 };
    let half = BigInterval::from_f64(2.0_f64.powi(exponent).copysign(y), precision);
    half.clone() + half
}

/// The distance of `y` from an exact value in units in the last place: of the gap between `y` and the
/// float beside it towards the exact value.
fn error<S: Scalar>(y: S, exact: &BigInterval) -> [f64; 2] {
    let precision = exact.precision();
    let difference = exact.clone() - at(y, precision);
    if difference.contains_zero() && difference.is_point() {
        return [0.0, 0.0];
    }
    let side = if difference.is_negative() { Side::Below } else { Side::Above };
    // Beyond the overflow infinity is right.
    if y.to_f64().is_infinite() && (side == Side::Above) == (y.to_f64() > 0.0) {
        return [0.0, 0.0];
    }
    let gap = at(neighbour(y, side), precision) - at(y, precision);
    (difference / gap).to_f64()
}

/// Compares the error of `y` with a bound; `exact` gives the exact value with so many bits.
pub(crate) fn settle<S: Scalar>(y: S, bound: f64, exact: impl Fn(usize) -> BigInterval) -> Settled {
    for precision in PRECISIONS {
        let exact = exact(precision);
        if exact.is_empty() || y.is_nan() {
            // Where there is no value NaN is right, and at a pole an infinity.
            return if exact.is_empty() && !y.to_f64().is_finite() {
                Settled::Within(0.0)
            } else {
                Settled::Beyond(f64::INFINITY)
            };
        }
        let [lo, hi] = error(y, &exact);
        if hi <= bound {
            return Settled::Within(hi);
        }
        if lo > bound {
            return Settled::Beyond(lo);
        }
    }
    Settled::Open
}
