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

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::quadratic::Quadratic;
    use super::*;
    use crate::points::Cloud;

    /// A plane with a point above and one below it near each other, 4 steps from the middle.
    fn samples() -> (Samples, u32) {
        let place = |i: u32| DVec3::new(f64::from(i % 81) - 40.0, f64::from(i / 81) - 40.0, 0.0);
        let mut points: Vec<DVec3> = (0..81 * 81).map(place).collect();
        points.extend([0.5, -0.5].map(|z| DVec3::new(4.0, 0.1, z)));
        let normals = vec![DVec3::Z; points.len()];
        let (cloud, _) = Cloud::new(points, normals).unwrap();
        (Samples::new(&cloud), 40 * 81 + 40)
    }

    fn error(samples: &Samples, centre: u32, radius: f64) -> f64 {
        let (mut found, mut inside) = (Vec::new(), Vec::new());
        samples.within(centre, radius, &mut found, &mut inside);
        let fit = Quadratic::fitted(&inside).unwrap();
        let square: f64 = inside.iter().map(|s| s.w * fit.distance(s.x).powi(2)).sum();
        radius * (square / inside.iter().map(|s| s.w).sum::<f64>()).sqrt()
    }

    /// The error rises while the two come in and falls when they are outnumbered.
    #[test]
    fn one_failure_is_passed_and_two_end_growth_at_the_last_good_radius() {
        let (samples, centre) = samples();
        let nearest = samples.tree.nearest(samples.points[centre as usize], START);
        let start = nearest.last().unwrap().square.sqrt();
        let radii: Vec<f64> = (0..22).map(|k| start * GROWTH.powi(k)).collect();
        let errors: Vec<f64> = radii.iter().map(|&r| error(&samples, centre, r)).collect();
        let worst = (0..22).max_by(|&i, &j| errors[i].total_cmp(&errors[j])).unwrap();
        assert!((5..20).contains(&worst), "{errors:?}");
        let second = errors[worst - 1].max(errors[worst + 1]);
        let third = errors[worst - 1].min(errors[worst + 1]);

        let grow = |error| grown(&samples, centre, error, Edges::Ignore).unwrap();
        let passed = grow(0.5 * (errors[worst] + second));
        assert!(passed.radius > 2.0 * radii[worst] && !passed.failed, "{passed:?} {errors:?}");

        for part in [0.3, 0.5, 0.6, 0.7, 0.8, 0.9] {
            let limit = part * third;
            let ended = grow(limit);
            let next = (0..22).find(|&k| errors[k] > limit).unwrap();
            let step = (radii[next] - radii[next - 1]) / 16.0;
            assert!(radii[next - 1] <= ended.radius && ended.radius < radii[next], "{ended:?}");
            assert!(error(&samples, centre, ended.radius) <= limit);
            assert!(error(&samples, centre, ended.radius + 1.001 * step) > limit);
        }
    }
}
