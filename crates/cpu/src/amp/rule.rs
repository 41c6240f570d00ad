//! The values of the knobs where the paper gives none: the rule of `docs/deviations.md`.

use glam::DVec3;
use zeroset_expr::Tape;
use zeroset_ia::plain::Plain;
use zeroset_raycast::{Camera, Domain, Error, Unsupported, View};

use super::{Adaptation, Amp, MAX_BISECTIONS};
use crate::implicit::Implicit;

/// The knobs as the march uses them: thresholds and epsilon in units of the function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// b.
    pub step: f64,
    /// The surface is near where |S| is at most this.
    pub tau1: f64,
    /// It is far where |S| is more than this.
    pub tau2: f64,
    /// A silhouette is near where |grad S . D| is at most this.
    pub tau3: f64,
    /// The surface is S = epsilon.
    pub epsilon: f64,
    /// Halvings of the isolated interval.
    pub bisections: u32,
    /// Does |S| change the step?
    pub distance_adaptation: Adaptation,
    /// Does |grad S . D|?
    pub silhouette_adaptation: Adaptation,
    /// No ray is longer within the domain, in units of space.
    pub longest: f64,
    /// No march that nothing refutes takes more samples. One that has taken so many is refuted no
    /// more: it would crawl through a function of high frequency.
    pub samples: f64,
    /// By how much brackets are widened for a proof, in units of space.
    pub slack: f64,
}

/// The base step in pixel footprints.
const FOOTPRINTS: f64 = 2.5;
/// Rows of the view whose footprint counts.
const ROWS: usize = 512;
/// The most samples that a march may take: so that counts are exact in single precision, every step
/// is a step, and a ray ends.
const MAX_SAMPLES: f64 = 1_048_576.0;
/// Units in the last place of the domain's largest coordinate by which roots of rounded values may lie
/// beside their place. The start and direction of a line, the product and the sum that make a point, put
/// it off by 4.5 of them at most in a cube around the origin.
const SLACK: f64 = 8.0;
/// Points of the domain at which the size of the function is measured.
const PROBES: usize = 1024;

impl Settings {
    /// The settings of a method for a function.
    ///
    /// # Errors
    /// If single precision does not hold the domain and the step, or a ray needs too many samples.
    pub fn new(amp: &Amp, implicit: &Implicit, published_step: Option<f64>) -> Result<Self, Error> {
        let domain = &implicit.domain;
        let step = amp.supported_step(domain, published_step)?;
        let scale = amp.scale.unwrap_or_else(|| size(&implicit.tape, domain));
        let tau1 = amp.tau1.unwrap_or(1.0);
        let unit = 0.5 * domain.longest_side();
        Ok(Self {
            step,
            tau1: scale * tau1,
            tau2: scale * amp.tau2.unwrap_or(2.0 * tau1),
            tau3: scale * amp.tau3.unwrap_or(0.5 * tau1 / unit),
            epsilon: scale * amp.epsilon,
            bisections: amp.bisections,
            distance_adaptation: amp.distance_adaptation,
            silhouette_adaptation: amp.silhouette_adaptation,
            longest: 2.0 * domain.radius(),
            samples: 2.0 * domain.radius() / (0.25 * step),
            slack: SLACK
                * f64::from(f32::EPSILON)
                * domain.min.abs().max(domain.max.abs()).max_element(),
        })
    }
}

impl Amp {
    /// The base step in a domain.
    ///
    /// # Errors
    /// If single precision does not hold the domain and the step, or a ray needs too many samples.
    pub(super) fn supported_step(
        &self,
        domain: &Domain,
        published_step: Option<f64>,
    ) -> Result<f64, Unsupported> {
        let step = self.base_step(domain, published_step);
        let longest = 2.0 * domain.radius();
        let largest = domain.min.abs().max(domain.max.abs()).max_element().max(longest);
        let least = 0.25 * step;
        if !(largest < f64::from(f32::MAX) && least >= f64::from(f32::MIN_POSITIVE)) {
            return Err(Unsupported(format!(
                "{} computes in single precision, which does not hold a domain of this size ({} \
                 across) and steps of {step}; give the equation in other units of length",
                zeroset_raycast::Method::id(self),
                longest
            )));
        }
        if longest / least > MAX_SAMPLES {
            return Err(Unsupported(format!(
                "step {step:?} needs more than {MAX_SAMPLES} samples a ray in a domain \
                 {longest:?} across; the least step here is {:.3e}",
                // Rounded up, so that it is no lie.
                1.001 * 4.0 * longest / MAX_SAMPLES
            )));
        }
        Ok(step)
    }

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

/// The size of a function: the lower quartile of |S| over the domain, where it is finite and not
/// zero; 1 if that is nowhere. A quarter of the domain is then near the surface.
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
    let quarter = sizes.len() / 4;
    *sizes.select_nth_unstable_by(quarter, f64::total_cmp).1
}

/// The n-th point of an additive recurrence in the unit cube: fractional parts of n g^-1, n g^-2 and
/// n g^-3, where g^4 = g + 1. The first N points are spread evenly for every N.
fn spread(n: usize) -> DVec3 {
    const G: f64 = 1.220_744_084_605_759_5;
    let n = n as f64;
    DVec3::new(n / G, n / (G * G), n / (G * G * G)).fract()
}

#[cfg(test)]
mod tests {
    use zeroset_expr::{Instruction, Op};
    use zeroset_ia::Constant;

    use super::*;

    fn cube(half: f64) -> Domain {
        Domain::new(DVec3::splat(-half), DVec3::splat(half)).unwrap()
    }

    /// c x.
    fn plane(c: f64) -> Tape {
        let scaled = Instruction { op: Op::Scale(0, 0), out: 3 };
        Tape::new(vec![scaled], vec![Constant::from_f64(c)], 3)
    }

    #[test]
    fn a_quarter_of_the_domain_is_within_the_size() {
        assert!((size(&plane(1.0), &cube(1.0)) - 0.25).abs() < 0.01);
        assert!((size(&plane(-8.0), &cube(1.0)) - 2.0).abs() < 0.08);
        assert_eq!(
            size(&plane(2.0_f64.powi(100)), &cube(1.0)),
            size(&plane(1.0), &cube(1.0)) * 2.0_f64.powi(100)
        );
        // In the ball, values far from the centre are rarer.
        let ball = Domain { ball: Some(1.0), ..cube(1.0) };
        assert!(size(&plane(1.0), &ball) < 0.2);
        // No finite value but zero.
        assert_eq!(size(&plane(0.0), &cube(1.0)), 1.0);
        assert_eq!(size(&plane(1e300), &cube(1e300)), 1.0);
    }

    #[test]
    fn points_spread_over_every_octant() {
        let mut octants = [0; 8];
        for n in 1..=PROBES {
            let p = spread(n);
            assert!(p.min_element() >= 0.0 && p.max_element() < 1.0);
            octants[[p.x, p.y, p.z].iter().fold(0, |o, x| 2 * o + usize::from(*x >= 0.5))] += 1;
        }
        assert!(octants.iter().all(|n| (108..=148).contains(n)), "{octants:?}");
    }

    #[test]
    fn the_step_is_set_or_published_or_some_pixels() {
        let domain = cube(1.0);
        let auto = Amp::default();
        let ratio = domain.radius() / auto.base_step(&domain, None);
        assert!((ratio - 96.2).abs() < 0.1, "{ratio}");
        assert_eq!(auto.base_step(&domain, Some(0.02)), 0.02);
        let set = Amp { step: Some(0.3), ..Amp::default() };
        assert_eq!(set.base_step(&domain, Some(0.02)), 0.3);
    }
}
