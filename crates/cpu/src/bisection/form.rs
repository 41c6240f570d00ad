//! The arithmetic that a scene needs.

use zeroset_expr::Tape;
use zeroset_ia::{Decorated, Decoration, Interval, Scalar};
use zeroset_raycast::{Domain, Error};

use super::cut::Bounds;
use super::method::{Arithmetic, Bisection};

/// The numbers of a march, and the domain's box in them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub bounds: Bounds,
    pub numbers: Numbers,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Numbers {
    /// Every sub-value is defined and bounded in single precision.
    Raw,
    /// Some sub-value is unbounded or undefined: single precision, set-based.
    Set,
    /// Something is too large for single precision: double precision, set-based.
    Double,
}

/// Single precision is used for numbers up to here.
const LARGEST_SINGLE: f64 = f64::from_bits((1023 + 100) << 52);
/// Double precision is used for sub-values up to here.
const LARGEST_DOUBLE: f64 = f64::from_bits((1023 + 900) << 52);
/// 2^800: coordinates are at most as large. Divided by the least component of a direction, 2^-149, they do
/// not overflow on the way to a piece.
const FARTHEST: f64 = f64::from_bits((1023 + 800) << 52);

impl Form {
    /// The root-box check: one evaluation over the whole domain, of each tape.
    ///
    /// # Errors
    /// If the domain reaches beyond 2^800.
    pub(super) fn of(
        method: &Bisection,
        tape: &Tape,
        slope: Option<&Tape>,
        domain: &Domain,
    ) -> Result<Self, Error> {
        let reach = domain.min.abs().max(domain.max.abs()).max_element();
        if reach > FARTHEST {
            return Err(Error::Domain(format!(
                "the domain reaches to {reach:e}; interval bisection takes domains within 2^800 of \
                 the origin"
            )));
        }
        let (single, double) = (Bounds::new::<f32>(domain), Bounds::new::<f64>(domain));
        let numbers = if reach > LARGEST_SINGLE || method.arithmetic == Arithmetic::Double {
            Numbers::Double
        } else if is_bounded::<f32>(tape, &single, LARGEST_SINGLE) {
            let raw = slope.is_none_or(|slope| is_bounded::<f32>(slope, &single, LARGEST_SINGLE));
            if raw { Numbers::Raw } else { Numbers::Set }
        } else if is_bounded::<f64>(tape, &double, LARGEST_DOUBLE) {
            Numbers::Double
        } else {
            Numbers::Set
        };
        let bounds = if numbers == Numbers::Double { double } else { single };
        Ok(Self { bounds, numbers })
    }
}

/// Over the domain, are all sub-values within the limit, and is every operation defined everywhere?
/// Then this holds for every smaller box too, which raw intervals presuppose. A slope is looked at in
/// all directions whose components are at most 1, and a rounding more.
fn is_bounded<S: Scalar>(tape: &Tape, bounds: &Bounds, limit: f64) -> bool {
    let range = |[lo, hi]: [S; 2]| Decorated::new(Interval::new(lo, hi));
    let point = bounds.ranges::<S>().map(range);
    let mut evaluator = tape.evaluator(&point[0]);
    let direction = range([S::from_f64(-2.0), S::from_f64(2.0)]);
    for (axis, x) in point.into_iter().chain([direction; 3]).enumerate().take(tape.inputs()) {
        evaluator.bind(axis, x);
    }
    let mut bounded = true;
    evaluator.run(|x| {
        bounded &= x.interval.is_bounded_by(limit) && x.decoration >= Decoration::Defined;
    });
    bounded
}
