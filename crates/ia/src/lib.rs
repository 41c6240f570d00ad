//! Numbers that carry guarantees.
//!
//! Each number is written **once**, over machine reals:
//!
//! - A [`Real`] is what a float unit does, with *marks* that round a result down or up. `f32` and
//!   `f64` are reals (their marks step to the neighbouring float), so are SIMD [`Lanes`], lanes with
//!   rounding embedded in the instruction, and [`Nearest`], whose marks do nothing.
//! - A [`Number`] is what an equation is evaluated over: a plain real, an [`Interval`], a [`Dual`].
//!
//! Rounding therefore belongs to the real and not to the interval: `Interval<f32>` is outward,
//! `Interval<Nearest<f32>>` is what graphics papers use, and the same lines of code serve both.
//! Only a real with [`Real::OUTWARD`] may claim a proof.
//!
//! | module | holds |
//! |---|---|
//! | [`real`] | machine reals: scalars, pairs |
//! | [`nearest`] | reals whose marks do nothing |
//! | [`lanes`] | SIMD lanes, chosen at run time |
//! | [`number`] | what an expression needs of a number |
//! | [`interval`] | intervals, raw and set-based (IEEE 1788) |
//! | [`plain`] | plain reals as numbers |
//! | [`portable`] | reals and functions for devices that promise little |
//! | [`decorated`] | intervals that know whether the function was defined and continuous |
//! | [`dual`] | forward-mode derivatives over any number |
//! | [`jet`] | Taylor series over any enclosing number |
//! | [`big`] | intervals of any precision |
//! | [`constant`] | exact constants, as every number takes them |

pub mod affine;
pub mod big;
pub mod constant;
pub mod decorated;
pub mod dual;
mod elementary;
pub mod interval;
pub mod jet;
pub mod lanes;
pub mod nearest;
pub mod number;
pub mod plain;
pub mod portable;
mod power;
mod range;
pub mod real;
mod single;

pub use affine::Affine;
pub use big::BigInterval;
pub use constant::Constant;
pub use decorated::{Decorated, Decoration};
pub use dual::Dual;
pub use interval::{Interval, Raw, Set};
pub use jet::{Enclosure, Jet};
pub use lanes::{
    Isa, Kernel, Lanes, Lanes4, Lanes8, Register, Rounding, dispatch, dispatch_register, widest,
};
pub use nearest::Nearest;
pub use number::{Binary, Number, Unary};
pub use plain::Plain;
pub use portable::{Mirror, Portable};
pub use real::{Packet, Pair, Real, Scalar};
