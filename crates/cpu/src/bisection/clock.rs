//! From q, the place on a ray, to the ray parameter and back.

use super::cut::{Axis, Bounds, Cut};
use super::march::Marcher;

/// The ray parameter along the pieces: `t = start + q pace`, in double precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    start: f64,
    /// t a unit of q.
    pace: f64,
    /// How far all pieces go in t.
    pub whole: f64,
}

impl Clock {
    /// The clock of a ray. What is cut by rays starts where the range of t does.
    pub(super) fn new(marcher: &Marcher, cut: Cut, bounds: &Bounds) -> Self {
        let Marcher { line, range, .. } = marcher;
        let k = match cut {
            Cut::Slabs(axis) => axis.k,
            Cut::Rays => Axis::of(*line).k,
        };
        let inverse = 1.0 / f64::from(line.direction[k]);
        let pace = inverse.abs();
        let (start, whole) = match cut {
            Cut::Slabs(axis) => {
                let start = (bounds.start(axis) - f64::from(line.origin[k])) * inverse;
                (start, bounds.length(axis) * pace)
            }
            Cut::Rays => (range[0], range[1] - range[0]),
        };
        Self { start, pace, whole }
    }

    /// A q at most that of `t`: the largest number if t is infinite, the least where it overflows. `start`
    /// has three roundings, its quotient by the pace two; the difference, the product and the end one
    /// each: of terms at most `(|t| + |start|) / pace`, less than 16 units of 2^-53.
    pub(super) fn q(&self, t: f64) -> f64 {
        if t == f64::INFINITY {
            return f64::MAX;
        }
        let inverse = 1.0 / self.pace;
        let error = 2.0 * UNITS_8 * ((t.abs() + self.start.abs()) * inverse) + TINY;
        let q = (t - self.start) * inverse - error;
        if q.is_nan() { f64::MIN } else { q }
    }

    /// The range of t between two boundaries, rounded outward; NaN where it overflows. `start` has
    /// three roundings, `q pace` two, the sum one and the end another: less than 8 units of 2^-53.
    pub(super) fn range(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        let at = |q: f64| {
            let error = UNITS_8 * (self.start.abs() + q * self.pace) + TINY;
            [self.start + q * self.pace - error, self.start + q * self.pace + error]
        };
        [at(from)[0], at(to)[1]]
    }
}

/// 8 units of 2^-53, the largest relative error of a rounding in double precision.
pub(super) const UNITS_8: f64 = 4.0 * f64::EPSILON;
/// More than the errors of all products that underflow.
pub(super) const TINY: f64 = f64::from_bits(123 << 52);
