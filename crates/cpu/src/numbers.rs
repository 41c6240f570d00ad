//! The arithmetic that interval methods need on a scene.

use zeroset_expr::Tape;
use zeroset_ia::{Decorated, Decoration, Interval, Scalar};
use zeroset_raycast::Domain;

/// What a function is evaluated with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// Every sub-value is defined and bounded in single precision: raw intervals.
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

impl Numbers {
    /// The root-box check: one evaluation over the whole domain, of the function and its slope if that is
    /// used too.
    pub fn of(tape: &Tape, slope: Option<&Tape>, domain: &Domain) -> Self {
        let reach = domain.min.abs().max(domain.max.abs()).max_element();
        if reach > LARGEST_SINGLE {
            Self::Double
        } else if is_bounded::<f32>(tape, domain, LARGEST_SINGLE) {
            let raw = slope.is_none_or(|slope| is_bounded::<f32>(slope, domain, LARGEST_SINGLE));
            if raw { Self::Raw } else { Self::Set }
        } else if is_bounded::<f64>(tape, domain, LARGEST_DOUBLE) {
            Self::Double
        } else {
            Self::Set
        }
    }
}

/// Over the domain, are all sub-values within the limit, and is every operation defined everywhere?
/// Then this holds for every smaller box too, which raw intervals presuppose. A slope is looked at in
/// all directions whose components are at most 1, and a rounding more.
fn is_bounded<S: Scalar>(tape: &Tape, domain: &Domain, limit: f64) -> bool {
    let range = |[lo, hi]: [S; 2]| Decorated::new(Interval::new(lo, hi));
    let point = [0, 1, 2].map(|axis| range(S::enclose_range(domain.min[axis], domain.max[axis])));
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
