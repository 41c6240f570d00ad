//! Coordinates of one size for all molecules, and points whose differences are exact.

use glam::DVec3;

use super::Atom;

/// Points whose coordinates are multiples of `step`, a power of two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    /// The middle of the atoms; local coordinates are about it.
    origin: DVec3,
    /// A power of two: the molecule's size, or up to twice that.
    scale: f64,
    /// 2^-26 of the scale.
    step: f64,
}

impl Lattice {
    pub(super) fn around(atoms: &[Atom]) -> Self {
        let least = atoms.iter().map(|a| a.centre - a.radius).fold(DVec3::INFINITY, DVec3::min);
        let most = atoms.iter().map(|a| a.centre + a.radius).fold(DVec3::NEG_INFINITY, DVec3::max);
        let scale = (most - least).max_element().log2().ceil().exp2();
        let step = scale / f64::from(1u32 << 26);
        Self { origin: 0.5 * (least + most), scale, step }
    }

    /// A point of space about the origin, in units of the scale.
    pub(super) fn local(&self, point: DVec3) -> DVec3 {
        (point - self.origin) / self.scale
    }

    /// A length in units of the scale.
    pub(super) fn length(&self, length: f64) -> f64 {
        length / self.scale
    }

    /// The point of space of a local one.
    pub(super) fn space(&self, local: DVec3) -> DVec3 {
        self.origin + self.scale * local
    }

    /// The lattice's nearest point.
    pub(super) fn nearest(&self, point: DVec3) -> DVec3 {
        (point / self.step).round() * self.step
    }

    /// A point of the lattice in the middle of others.
    pub(super) fn middle(&self, corners: [DVec3; 4]) -> DVec3 {
        self.nearest(0.25 * (corners[0] + corners[1] + corners[2] + corners[3]))
    }

    /// The square of the scale.
    pub(super) fn square(&self) -> f64 {
        self.scale * self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_of_its_points_are_exact() {
        let atoms = [
            Atom { centre: DVec3::new(1e3, 0.1, -1.0 / 3.0), radius: 0.7 },
            Atom { centre: DVec3::new(1e3 + 1.1, -0.3, 2.0 / 3.0), radius: 1.2 },
        ];
        let lattice = Lattice::around(&atoms);
        assert_eq!(lattice.scale, 4.0);
        let points = (0..64).map(|i| {
            let t = f64::from(i);
            lattice.nearest(lattice.space(DVec3::new(t.sin(), (2.0 * t).sin(), (3.0 * t).cos())))
        });
        let points: Vec<_> = points.collect();
        for &p in &points {
            for &q in &points {
                assert_eq!(q + (p - q), p);
                assert_eq!(lattice.nearest(p - q), p - q);
            }
        }
        let at = lattice.space(DVec3::splat(0.25));
        assert!((lattice.local(at) - 0.25).length() < 1e-13);
    }
}
