//! Where cubes and their corners are.

use glam::DVec3;

use crate::volume::Volume;

/// Bits of a position. Two fewer than a float has, so that positions and their differences are exact.
const BITS: i32 = 50;

/// The places of a volume's samples and of the points half way between.
///
/// They are rounded to multiples of one power of two along each axis. Differences of places are then exact,
/// and a corner that is found from any cube at it is the same point: there are no cracks.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lattice {
    pub(super) size: [usize; 3],
    pub(super) spacing: DVec3,
    pub(super) origin: DVec3,
    grain: DVec3,
}

impl Lattice {
    pub(super) fn new(size: [usize; 3], spacing: DVec3, origin: DVec3) -> Self {
        let far = origin + spacing * DVec3::from(size.map(|n| n as f64));
        let most = origin.abs().max(far.abs());
        let grain =
            DVec3::from(most.to_array().map(|m| 2.0_f64.powi(m.log2().ceil() as i32 - BITS)));
        Self { size, spacing, origin, grain }
    }

    pub(super) fn of(volume: &Volume) -> Self {
        Self::new(volume.size(), volume.spacing(), volume.origin())
    }

    /// The point so many half steps from the first sample.
    pub(super) fn place(&self, half_steps: [i64; 3]) -> DVec3 {
        let steps = 0.5 * DVec3::from(half_steps.map(|n| n as f64));
        ((self.origin + steps * self.spacing) / self.grain).round() * self.grain
    }

    /// The centre of a cube.
    pub(super) fn centre(&self, cell: [usize; 3]) -> DVec3 {
        self.place(cell.map(|n| 2 * n as i64))
    }

    /// A point in half steps from the centre of a cube, relative to that centre.
    pub(super) fn corner(&self, cell: [usize; 3], corner: [i8; 3]) -> DVec3 {
        let half_steps = [0, 1, 2].map(|axis| 2 * cell[axis] as i64 + i64::from(corner[axis]));
        self.place(half_steps) - self.centre(cell)
    }

    /// The number of a cube, that of its sample.
    pub(super) fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        i + self.size[0] * (j + self.size[1] * k)
    }

    /// The cube of a number.
    pub(super) fn cell(&self, number: usize) -> [usize; 3] {
        let [nx, ny, _] = self.size;
        [number % nx, number / nx % ny, number / nx / ny]
    }

    /// Does the cube have neighbours on all sides?
    pub(super) fn is_inside(&self, cell: [usize; 3]) -> bool {
        cell.into_iter().zip(self.size).all(|(i, n)| i > 0 && i + 1 < n)
    }

    /// The cube that holds a point, and the point in steps of the grid from its centre.
    pub(super) fn locate(&self, point: DVec3) -> Option<([usize; 3], DVec3)> {
        let steps = (point - self.origin) / self.spacing;
        let mut cell = [0; 3];
        for axis in 0..3 {
            let end = self.size[axis] as f64 - 1.5;
            // NaN is outside.
            if !(steps[axis] >= 0.5 && steps[axis] <= end) {
                return None;
            }
            cell[axis] = (steps[axis].round() as usize).min(self.size[axis] - 2);
        }
        Some((cell, steps - DVec3::from(cell.map(|n| n as f64))))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::spline::Sector;

    /// What is lost when a + b is rounded (Knuth).
    fn rounding(a: DVec3, b: DVec3) -> DVec3 {
        let sum = a + b;
        let rest = sum - a;
        (a - (sum - rest)) + (b - rest)
    }

    proptest! {
        #[test]
        fn a_corner_is_one_point_from_every_cube(
            spacing in prop::array::uniform3(0.5_f64..2.0),
            start in prop::array::uniform3(prop_oneof![-2.0_f64..2.0, -1e6_f64..1e6]),
        ) {
            let spacing = DVec3::from(spacing);
            let lattice = Lattice::new([6; 3], spacing, DVec3::from(start) * spacing);
            for n in 1..5 {
                let cell = [n; 3];
                let centre = lattice.centre(cell);
                for corner in Sector::all().flat_map(Sector::corners) {
                    let from_centre = lattice.corner(cell, corner);
                    let place = corner.map(|c| 2 * n as i64 + i64::from(c));
                    prop_assert_eq!(rounding(centre, from_centre), DVec3::ZERO);
                    prop_assert_eq!(centre + from_centre, lattice.place(place));
                }
            }
        }
    }
}
