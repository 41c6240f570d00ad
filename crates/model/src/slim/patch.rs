//! What a ball holds: one surface, or two that meet in an edge.

use super::Edges;
use super::crease::Crease;
use super::quadratic::Quadratic;
use super::samples::Sample;

/// The surface in a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Surface {
    /// One.
    Whole(Quadratic),
    /// Two, each on its side of a plane.
    Edge(Crease),
}

/// A surface in a ball, and how good it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial {
    pub(super) surface: Surface,
    pub(super) verdict: Verdict,
}

/// What is thought of a surface in a ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// Within the error.
    Good,
    /// Not within it.
    Poor,
    /// A point looks the other way: another sheet, and no larger ball will do.
    OtherSheet,
}

impl Trial {
    /// The best surface for these samples of a ball, judged by the root of the mean of w e^2, with e Taubin's
    /// distance, against an error in radii. `None` if there is no surface at all.
    pub(super) fn of(samples: &[Sample], error: f64, edges: Edges) -> Option<Self> {
        let whole = Quadratic::fitted(samples);
        let verdict = whole.map(|whole| {
            if samples.iter().any(|s| s.n.dot(whole.normal()) < 0.0) {
                Verdict::OtherSheet
            } else if mean(samples, |s| whole.distance(s.x)) <= error {
                Verdict::Good
            } else {
                Verdict::Poor
            }
        });
        if edges == Edges::Clip
            && verdict != Some(Verdict::Good)
            && let Some(crease) = Crease::fitted(samples)
            && mean(samples, |s| crease.distance(s.x)) <= error
        {
            return Some(Self { surface: Surface::Edge(crease), verdict: Verdict::Good });
        }
        Some(Self { surface: Surface::Whole(whole?), verdict: verdict? })
    }
}

/// The root of the weighted mean of squares.
fn mean(samples: &[Sample], distance: impl Fn(&Sample) -> f64) -> f64 {
    let sum: f64 = samples.iter().map(|s| s.w * distance(s).powi(2)).sum();
    (sum / samples.iter().map(|s| s.w).sum::<f64>()).sqrt()
}
