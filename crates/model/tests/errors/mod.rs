//! How far a spline is from the signal that it was built from.

use glam::DVec3;
use zeroset_model::spline::Spline;
use zeroset_model::volume::{marschner_lobb, marschner_lobb_gradient};

/// Points at which errors are measured.
const POINTS: u32 = 200_000;

/// Errors of the spline of a signal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Errors {
    /// The greatest of the values.
    pub(crate) value: f64,
    /// The root of the mean square of the gradients.
    pub(crate) gradient: f64,
}

impl Errors {
    /// Of the spline of [`marschner_lobb`], at points that fill the cubes evenly whose centres have
    /// `border` samples or more on all sides.
    pub(crate) fn of(spline: &Spline<'_>, n: usize, border: usize) -> Self {
        let reach = 1.0 - (2 * border - 1) as f64 / (n - 1) as f64;
        let (mut value, mut square, mut count) = (0.0_f64, 0.0, 0.0);
        for p in points() {
            let p = reach * p;
            let s = spline.value(p).expect("the point lies in a cube");
            let gradient = spline.gradient(p).expect("the point lies in a cube");
            value = value.max((s - marschner_lobb(p)).abs());
            square += (gradient - marschner_lobb_gradient(p)).length_squared();
            count += 1.0;
        }
        Self { value, gradient: f64::sqrt(square / count) }
    }
}

/// Points of an additive recurrence in (-1, 1)^3, which fill it evenly.
fn points() -> impl Iterator<Item = DVec3> {
    // The root of g^4 = g + 1.
    let g = 1.220_744_084_605_759_5_f64;
    let step = DVec3::new(1.0 / g, 1.0 / (g * g), 1.0 / (g * g * g));
    (1..=POINTS).map(move |n| 2.0 * (step * f64::from(n)).fract() - 1.0)
}
