//! The 24 tetrahedra of a cube.

use glam::{DMat3, DVec3};
use zeroset_raycast::Quadric;

use super::mask::PAIRS;

/// One of the tetrahedra v0 v1 v2 v3 of a cube of the type-6 partition: v0 is the cube's centre, v1 the centre
/// of a face, and v2 and v3 the ends of an edge of that face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Sector(u8);

/// Tetrahedra of a cube.
pub(super) const SECTORS: u8 = 24;

impl Sector {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..SECTORS).map(Self)
    }

    /// The one of this number, from 0 to 23.
    pub(super) fn numbered(number: u8) -> Self {
        debug_assert!(number < SECTORS);
        Self(number)
    }

    /// Its number, from 0 to 23.
    pub fn number(self) -> u8 {
        self.0
    }

    /// The axes of the face, of the edge's place in the face, and along the edge; the signs of the first two.
    fn axes(self) -> ([usize; 3], [i8; 2]) {
        let (face, edge) = (self.0 / 4, self.0 % 4);
        let across = usize::from(face / 2);
        let beside = (across + 1 + usize::from(edge / 2)) % 3;
        let sign = |parity: u8| if parity == 0 { -1 } else { 1 };
        ([across, beside, 3 - across - beside], [sign(face % 2), sign(edge % 2)])
    }

    /// The one that holds a point of the cube, in steps of the grid from its centre.
    pub fn holding(point: DVec3) -> Self {
        let sizes = point.abs().to_array();
        let larger = |a: usize, b: usize| if sizes[b] > sizes[a] { b } else { a };
        let across = larger(larger(0, 1), 2);
        let [next, last] = [(across + 1) % 3, (across + 2) % 3];
        let beside = larger(next, last);
        let parity = |axis: usize| u8::from(point[axis] > 0.0);
        let edge = 2 * u8::from(beside == last) + parity(beside);
        Self(4 * (2 * across as u8 + parity(across)) + edge)
    }

    /// v0, v1, v2, v3, in half steps of the grid from the cube's centre.
    pub fn corners(self) -> [[i8; 3]; 4] {
        let ([across, beside, along], [face, edge]) = self.axes();
        let mut corners = [[0; 3]; 4];
        for corner in &mut corners[1..] {
            corner[across] = face;
        }
        for (corner, end) in corners[2..].iter_mut().zip([1, -1]) {
            corner[beside] = edge;
            corner[along] = end;
        }
        corners
    }

    /// The rows of L in lambda(x) = L x + l, the barycentric coordinates of a point in steps of the grid from
    /// the cube's centre; l is (1, 0, 0, 0).
    ///
    /// With a, b and c the coordinates across the face, beside the edge and along it: a = (l1 + l2 + l3)/2,
    /// b = (l2 + l3)/2, c = (l2 - l3)/2.
    fn rows(self) -> [DVec3; 4] {
        let (axes, signs) = self.axes();
        let [across, beside, along] = axes.map(|axis| DVec3::AXES[axis]);
        let [face, edge] = signs.map(f64::from);
        let (across, beside) = (face * across, edge * beside);
        [-2.0 * across, 2.0 * (across - beside), beside + along, beside - along]
    }

    /// The barycentric coordinates of a point, in steps of the grid from the cube's centre.
    pub fn barycentric(self, point: DVec3) -> [f64; 4] {
        let [l0, l1, l2, l3] = self.rows().map(|row| row.dot(point));
        [1.0 + l0, l1, l2, l3]
    }

    /// The polynomial of these ordinates about the cube's centre: A = L'B L, b = L'B l, c = l'B l.
    pub(super) fn quadric(self, ordinates: &[f64; 10], spacing: DVec3) -> Quadric {
        let rows = self.rows().map(|row| row / spacing);
        let mut quadric = Quadric { a: DMat3::ZERO, b: DVec3::ZERO, c: ordinates[0] };
        for ([p, q], ordinate) in PAIRS.into_iter().zip(ordinates) {
            let product = outer(rows[p], rows[q]);
            let both = if p == q { product } else { product + product.transpose() };
            quadric.a += *ordinate * both;
            if p == 0 {
                quadric.b += *ordinate * rows[q];
            }
        }
        quadric
    }
}

/// p q'.
fn outer(p: DVec3, q: DVec3) -> DMat3 {
    DMat3::from_cols(q.x * p, q.y * p, q.z * p)
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    fn half(corner: [i8; 3]) -> DVec3 {
        0.5 * DVec3::from(corner.map(f64::from))
    }

    #[test]
    fn the_tetrahedra_are_congruent_and_fill_the_cube() {
        let mut shapes = HashSet::new();
        for sector in Sector::all() {
            let corners = sector.corners();
            let mut sorted = corners;
            sorted.sort_unstable();
            assert!(shapes.insert(sorted));
            let [v0, v1, v2, v3] = corners.map(half);
            assert_eq!(v0, DVec3::ZERO);
            let volume = DMat3::from_cols(v1, v2, v3).determinant().abs() / 6.0;
            assert!((24.0 * volume - 1.0).abs() < 1e-12);
            for (i, corner) in corners.into_iter().enumerate() {
                let mut one = [0.0; 4];
                one[i] = 1.0;
                assert_eq!(sector.barycentric(half(corner)), one);
            }
            assert_eq!(Sector::holding(0.25 * (v0 + v1 + v2 + v3)), sector);
            assert_eq!(Sector::numbered(sector.number()), sector);
        }
    }

    #[test]
    fn every_point_lies_in_the_one_that_holds_it() {
        let ends = [-0.5, -0.3, -0.25, 0.0, 0.2, 0.25, 0.5];
        for x in ends {
            for y in ends {
                for z in ends {
                    let p = DVec3::new(x, y, z);
                    let lambda = Sector::holding(p).barycentric(p);
                    assert!(lambda.iter().all(|l| *l >= 0.0), "{p}: {lambda:?}");
                }
            }
        }
    }
}
