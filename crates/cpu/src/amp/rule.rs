//! The values of the knobs where the paper gives none: the rule of `docs/deviations.md`.

use glam::DVec3;
use zeroset_expr::Tape;
use zeroset_ia::plain::Plain;
use zeroset_raycast::{Camera, Domain, Error, Unsupported, View};

use super::{Adaptation, Amp, MAX_BISECTIONS, RootTest};
use crate::implicit::Implicit;

/// The knobs as the march uses them: thresholds and epsilon in units of the function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Settings {
    pub test: RootTest,
    pub step: f64,
    pub tau1: f64,
    pub tau2: f64,
    pub tau3: f64,
    pub epsilon: f64,
    pub bisections: u32,
    pub distance_adaptation: Adaptation,
    pub silhouette_adaptation: Adaptation,
    /// No ray is longer within the domain, in units of space.
    pub longest: f64,
}

/// The base step in pixel footprints.
const FOOTPRINTS: f64 = 2.5;
/// Rows of the view whose footprint counts.
const ROWS: usize = 512;
/// The most samples that a march may take: so that counts are exact in single precision, every step
/// is a step, and a ray ends.
const MAX_SAMPLES: f64 = 1_048_576.0;
/// Points of the domain at which the size of the function is measured.
const PROBES: usize = 1024;

impl Settings {
    /// The settings of a method for a function.
    pub(super) fn new(
        amp: &Amp,
        implicit: &Implicit,
        published_step: Option<f64>,
    ) -> Result<Self, Error> {
        let domain = &implicit.domain;
        let step = amp.base_step(domain, published_step);
        let longest = 2.0 * domain.radius();
        let largest = domain.min.abs().max(domain.max.abs()).max_element().max(longest);
        let least = 0.25 * step;
        if !(largest < f64::from(f32::MAX) && least >= f64::from(f32::MIN_POSITIVE)) {
            return Err(Unsupported(format!(
                "{} computes in single precision, which does not hold a domain of this size ({} \
                 across) and steps of {step}; give the equation in other units of length",
                zeroset_raycast::Method::id(amp),
                longest
            ))
            .into());
        }
        if longest / least > MAX_SAMPLES {
            return Err(Unsupported(format!(
                "step {step} needs more than {MAX_SAMPLES} samples a ray in a domain {longest} \
                 across; the least step here is {}",
                4.0 * longest / MAX_SAMPLES
            ))
            .into());
        }
        let scale = amp.scale.unwrap_or_else(|| size(&implicit.tape, domain));
        let tau1 = amp.tau1.unwrap_or(1.0);
        let unit = 0.5 * domain.longest_side();
        Ok(Self {
            test: amp.test,
            step,
            tau1: scale * tau1,
            tau2: scale * amp.tau2.unwrap_or(2.0 * tau1),
            tau3: scale * amp.tau3.unwrap_or(0.5 * tau1 / unit),
            epsilon: scale * amp.epsilon,
            bisections: amp.bisections,
            distance_adaptation: amp.distance_adaptation,
            silhouette_adaptation: amp.silhouette_adaptation,
            longest,
        })
    }
}

impl Amp {
    /// b: as set, as published, or from the pixel footprint.
    fn base_step(&self, domain: &Domain, published_step: Option<f64>) -> f64 {
        self.step.or(published_step).unwrap_or_else(|| {
            let camera = Camera::facing(domain);
            let distance = (camera.eye - camera.at).length();
            FOOTPRINTS * View::new(camera, ROWS, ROWS).footprint(distance)
        })
    }

    /// The bisections that narrow the longest step to `width`, or to a unit in the last place of a
    /// position in single precision.
    pub(super) fn bisections_for(
        &self,
        width: f64,
        domain: &Domain,
        published_step: Option<f64>,
    ) -> u32 {
        let resolution = 2.0 * domain.radius() * f64::from(f32::EPSILON);
        let halvings =
            (2.0 * self.base_step(domain, published_step) / width.max(resolution)).log2();
        halvings.ceil().clamp(0.0, f64::from(MAX_BISECTIONS)) as u32
    }
}

/// The size of a function: the median of |S| over the domain, where it is finite and not zero; 1 if
/// that is nowhere.
fn size(tape: &Tape, domain: &Domain) -> f64 {
    let mut evaluator = tape.evaluator(&Plain(0.0_f64));
    let mut sizes: Vec<f64> = (1..=PROBES)
        .map(|n| domain.min + spread(n) * (domain.max - domain.min))
        .filter(|p| domain.ball.is_none_or(|radius| (p - domain.centre()).length() <= radius))
        .map(|p| evaluator.evaluate([p.x, p.y, p.z].map(Plain)).0.abs())
        .filter(|size| *size > 0.0 && size.is_finite())
        .collect();
    if sizes.is_empty() {
        return 1.0;
    }
    let middle = sizes.len() / 2;
    *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The n-th point of an additive recurrence in the unit cube: fractional parts of n g^-1, n g^-2 and
/// n g^-3, where g^4 = g + 1. The first N points are spread evenly for every N.
fn spread(n: usize) -> DVec3 {
    const G: f64 = 1.220_744_084_605_759_5;
    let n = n as f64;
    DVec3::new(n / G, n / (G * G), n / (G * G * G)).fract()
}
