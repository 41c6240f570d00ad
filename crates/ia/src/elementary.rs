//! Elementary functions of scalars and of intervals of scalars.

use crate::{Binary, Scalar, Unary};

/// `f(x)`, correctly rounded.
pub(crate) fn unary_f32(f: Unary, x: f32) -> f32 {
    todo!("{f} {x}")
}
/// `f(x)` within one unit in the last place.
pub(crate) fn unary_f64(f: Unary, x: f64) -> f64 {
    todo!("{f} {x}")
}
/// `f(x, y)`, correctly rounded.
pub(crate) fn binary_f32(f: Binary, x: f32, y: f32) -> f32 {
    todo!("{f} {x} {y}")
}
/// `f(x, y)` within one unit in the last place.
pub(crate) fn binary_f64(f: Binary, x: f64, y: f64) -> f64 {
    todo!("{f} {x} {y}")
}
/// The range of `f` over `x`.
pub(crate) fn unary<S: Scalar>(f: Unary, x: [S; 2]) -> [S; 2] {
    todo!("{f} {x:?}")
}
/// The range of `f` over `x` times `y`.
pub(crate) fn binary<S: Scalar>(f: Binary, x: [S; 2], y: [S; 2]) -> [S; 2] {
    todo!("{f} {x:?} {y:?}")
}
/// The quotient of set-based intervals.
pub(crate) fn divide<S: Scalar>(x: [S; 2], y: [S; 2]) -> [S; 2] {
    todo!("{x:?} {y:?}")
}
/// `x^c` for a constant exponent, over the part of `x` where it is defined.
pub(crate) fn power<S: Scalar>(x: [S; 2], c: [S; 2]) -> [S; 2] {
    todo!("{x:?} {c:?}")
}
