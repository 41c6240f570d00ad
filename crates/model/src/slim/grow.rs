//! The largest ball about a point that a quadric is good for.

use super::Edges;
use super::patch::{Surface, Trial, Verdict};
use super::samples::Samples;

/// The first ball reaches to this nearest point, its centre counted.
const START: usize = 10;
/// A ball grows by this factor.
const GROWTH: f64 = 1.1;
/// Balls in a row that may fail before growing ends.
const FAILURES: usize = 2;
/// Halvings of the interval between the last good radius and the next.
const BISECTIONS: usize = 4;
/// No ball is larger: the least in which points at any two ends are covered.
const LARGEST: f64 = 1.25;

/// A ball about a sample, with its surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grown {
    pub(super) centre: u32,
    pub(super) radius: f64,
    pub(super) surface: Surface,
    /// Whether even the first ball failed; it is kept all the same.
    pub(super) failed: bool,
}

/// Grows the ball about a sample while its surface is within `error`. The ball that reaches the tenth
/// nearest point is kept in any case. `None` if even that has no surface: its normals cancel out.
pub(super) fn grown(samples: &Samples, centre: u32, error: f64, edges: Edges) -> Option<Grown> {
    let place = samples.points[centre as usize];
    let start = samples.tree.nearest(place, START).map(|n| n.square).last()?.sqrt();
    let (mut found, mut inside) = (Vec::new(), Vec::new());
    let mut trial = |radius: f64| {
        samples.within(centre, radius, &mut found, &mut inside);
        Trial::of(&inside, error / radius, edges)
    };
    let first = trial(start)?;
    let ball = |radius, surface, failed| Some(Grown { centre, radius, surface, failed });
    if first.verdict != Verdict::Good {
        return ball(start, first.surface, true);
    }
    let (mut good, mut surface) = (start, first.surface);
    let (mut bad, mut failures) = (None, 0);
    let mut radius = start;
    while failures < FAILURES && radius < LARGEST {
        radius = (radius * GROWTH).min(LARGEST);
        match trial(radius) {
            Some(Trial { surface: larger, verdict: Verdict::Good }) => {
                (good, surface) = (radius, larger);
                (bad, failures) = (None, 0);
            }
            Some(Trial { verdict: Verdict::Poor, .. }) => {
                bad.get_or_insert(radius);
                failures += 1;
            }
            _ => {
                bad.get_or_insert(radius);
                break;
            }
        }
    }
    if let Some(mut bad) = bad {
        for _ in 0..BISECTIONS {
            let radius = 0.5 * (good + bad);
            match trial(radius) {
                Some(Trial { surface: larger, verdict: Verdict::Good }) => {
                    (good, surface) = (radius, larger);
                }
                _ => bad = radius,
            }
        }
    }
    ball(good, surface, false)
}
