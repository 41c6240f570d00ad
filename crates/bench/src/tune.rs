//! Constants for a surface: AMP's base step and thresholds by measurement, Section 4.5 of \[singh2010\].

use std::time::{Duration, Instant};

use zeroset_raycast::{Error, Hits, Method, Progress, Rays, Request, Scene, Work};

use crate::{Tolerance, Truths, Verdict, judge};

/// What is tried: every base step with every threshold.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Base steps b, in units of space, longest first.
    pub steps: Vec<f64>,
    /// Thresholds `tau_1`, in units of the function's size, least first.
    pub thresholds: Vec<f64>,
}

impl Grid {
    /// From 4 times the base step down to a quarter in half octaves, with thresholds from 0.1 to 3.
    pub fn around(step: f64) -> Self {
        Self {
            steps: (-4..=4).map(|i| step * 2.0_f64.powf(-0.5 * f64::from(i))).collect(),
            thresholds: vec![0.1, 0.3, 1.0, 3.0],
        }
    }
}

/// One setting, measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// b.
    pub step: f64,
    /// `tau_1`.
    pub tau1: f64,
    /// Rays on which a root was lost: misses where there is one, and hits on a later sheet.
    pub lost: usize,
    /// Hits where there is no root.
    pub false_hits: usize,
    /// Rays whose first root crosses the surface.
    pub crossed: usize,
    /// Rays that were judged.
    pub judged: usize,
    /// What the frame cost.
    pub work: Work,
    /// How long it took.
    pub time: Duration,
}

impl Trial {
    /// The share of crossing rays that were lost, and of judged ones that hit nothing.
    pub fn error_rate(&self) -> f64 {
        (self.lost + self.false_hits) as f64 / self.crossed.max(1) as f64
    }

    /// Values and gradients of the frame, a gradient counted as two values.
    pub fn cost(&self) -> u64 {
        self.work.points + 2 * self.work.gradients
    }
}

/// Measures every setting of the grid. `method` must have the knobs `step` and `tau1`, as AMP has;
/// others stay as they are. `see` is told of each trial.
///
/// # Errors
/// If the method does not take a setting or the scene, fails, or the work was asked to stop.
pub fn tune(
    method: &dyn Method,
    scene: &Scene,
    rays: Rays<'_>,
    truths: &Truths,
    grid: &Grid,
    progress: &Progress,
    see: &mut dyn FnMut(&Trial),
) -> Result<Vec<Trial>, Error> {
    let mut trials = Vec::new();
    for step in &grid.steps {
        for tau1 in &grid.thresholds {
            let mut method = method.boxed();
            for (knob, value) in [("step", step), ("tau1", tau1)] {
                method
                    .set(knob, &format!("{value:?}"))
                    .map_err(|e| zeroset_raycast::Unsupported(e.to_string()))?;
            }
            let intersector = method.prepare(scene)?;
            let mut hits = Hits::new(Request::First, rays.len());
            let start = Instant::now();
            let report = intersector.intersect(rays, &mut hits, progress)?;
            let time = start.elapsed();
            let tally = judge(rays, &hits, truths, Tolerance::Footprint).tally;
            let count = |verdict| tally.count_in(crate::Class::Transversal, verdict);
            let trial = Trial {
                step: *step,
                tau1: *tau1,
                lost: count(Verdict::FalseMiss) + count(Verdict::WrongSheet),
                false_hits: tally.count(Verdict::FalseHit),
                crossed: tally.class(crate::Class::Transversal),
                judged: tally.judged,
                work: report.work,
                time,
            };
            see(&trial);
            trials.push(trial);
        }
    }
    Ok(trials)
}

/// The cheapest trial whose error rate is at most `rate`; of equally cheap ones the better.
pub fn recommended(trials: &[Trial], rate: f64) -> Option<&Trial> {
    trials
        .iter()
        .filter(|trial| trial.error_rate() <= rate)
        .min_by(|a, b| a.cost().cmp(&b.cost()).then(a.error_rate().total_cmp(&b.error_rate())))
}

/// Is there no trial that is both cheaper and as good, or better and as cheap?
pub fn is_on_frontier(trials: &[Trial], trial: &Trial) -> bool {
    trials.iter().all(|other| {
        let better = other.error_rate() < trial.error_rate() && other.cost() <= trial.cost();
        let cheaper = other.cost() < trial.cost() && other.error_rate() <= trial.error_rate();
        !better && !cheaper
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(points: u64, lost: usize) -> Trial {
        Trial {
            step: 0.1,
            tau1: 1.0,
            lost,
            false_hits: 0,
            crossed: 1000,
            judged: 2000,
            work: Work { points, ..Work::default() },
            time: Duration::ZERO,
        }
    }

    #[test]
    fn the_cheapest_that_is_good_enough_is_recommended() {
        let trials = [trial(100, 50), trial(200, 5), trial(250, 5), trial(300, 1), trial(350, 2)];
        let cost = |rate| recommended(&trials, rate).map(Trial::cost);
        assert_eq!(cost(0.1), Some(100));
        assert_eq!(cost(0.005), Some(200));
        assert_eq!(cost(0.001), Some(300));
        assert_eq!(cost(0.0), None);
        let frontier: Vec<_> = trials.iter().map(|t| is_on_frontier(&trials, t)).collect();
        assert_eq!(frontier, [true, true, false, true, false]);
    }

    #[test]
    fn a_grid_is_around_its_step() {
        let Grid { steps, .. } = Grid::around(0.02);
        assert_eq!(steps.len(), 9);
        assert!((steps[0] - 0.08).abs() < 1e-15 && (steps[8] - 0.005).abs() < 1e-15);
        assert_eq!(steps[4], 0.02);
    }
}
