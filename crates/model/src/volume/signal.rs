//! Volumes of known functions.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use super::{Fault, Volume};

/// The contrast alpha of the rings.
const CONTRAST: f64 = 0.25;

/// Their frequency f_M.
const FREQUENCY: f64 = 6.0;

/// The signal of Marschner and Lobb (1994):
/// (1 - sin(pi z/2) + alpha (1 + cos(2 pi f_M cos(pi r/2)))) / (2 (1 + alpha)), r^2 = x^2 + y^2,
/// with alpha = 0.25 and f_M = 6.
pub fn marschner_lobb(p: DVec3) -> f64 {
    let rings = (TAU * FREQUENCY * (FRAC_PI_2 * p.truncate().length()).cos()).cos();
    let wave = (FRAC_PI_2 * p.z).sin();
    (1.0 - wave + CONTRAST * (1.0 + rings)) / (2.0 * (1.0 + CONTRAST))
}

/// The gradient of [`marschner_lobb`]; where r = 0, that of its smooth part.
pub fn marschner_lobb_gradient(p: DVec3) -> DVec3 {
    let r = p.truncate().length();
    let phase = TAU * FREQUENCY * (FRAC_PI_2 * r).cos();
    let slope = phase.sin() * TAU * FREQUENCY * FRAC_PI_2 * (FRAC_PI_2 * r).sin();
    let radial = if r > 0.0 { CONTRAST * slope / r } else { 0.0 };
    let wave = FRAC_PI_2 * (FRAC_PI_2 * p.z).cos();
    DVec3::new(radial * p.x, radial * p.y, -wave) / (2.0 * (1.0 + CONTRAST))
}

impl Volume {
    /// The distance from the origin at n x n x n points over [-1, 1]^3.
    ///
    /// # Errors
    /// If n is below 2 or too large.
    pub fn sphere(n: usize) -> Result<Self, Fault> {
        Self::sampled([n; 3], [DVec3::NEG_ONE, DVec3::ONE], DVec3::length)
    }

    /// The signal of [`marschner_lobb`] at n x n x n points over [-1, 1]^3.
    ///
    /// # Errors
    /// If n is below 2 or too large.
    pub fn marschner_lobb(n: usize) -> Result<Self, Fault> {
        Self::sampled([n; 3], [DVec3::NEG_ONE, DVec3::ONE], marschner_lobb)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_signal_has_its_gradient() {
        // At the origin: cos(12 pi) = 1 and no wave.
        assert!((marschner_lobb(DVec3::ZERO) - 0.6).abs() < 1e-15);
        assert!((marschner_lobb(DVec3::Z) - 0.2).abs() < 1e-15);
        let step = 1e-5;
        for p in
            [DVec3::new(0.3, -0.2, 0.7), DVec3::new(-0.9, 0.1, -0.4), DVec3::new(0.0, 0.5, 0.0)]
        {
            let slope = DVec3::from(DVec3::AXES.map(|axis| {
                let ends = [p + step * axis, p - step * axis].map(marschner_lobb);
                (ends[0] - ends[1]) / (2.0 * step)
            }));
            assert!((slope - marschner_lobb_gradient(p)).abs().max_element() < 1e-5, "{p}");
        }
    }

    #[test]
    fn grids_reach_from_corner_to_corner() {
        let volume = Volume::sphere(5).unwrap();
        assert_eq!((volume.size(), volume.spacing()), ([5; 3], DVec3::splat(0.5)));
        assert_eq!(volume.values()[62], 0.0);
        assert_eq!(volume.values()[124], 3f32.sqrt());
        assert_eq!(volume.values()[1 + 2 * 5 + 2 * 25], 0.5);
        assert!(Volume::sphere(1).is_err() && Volume::marschner_lobb(1 << 20).is_err());
    }
}
