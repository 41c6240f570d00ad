//! What a simplex of spheres says of its mixed cell.

use glam::{DMat3, DVec3};
use zeroset_raycast::Quadric;

use super::diagram::Sphere;

/// The focus of a simplex and its dual face, and R^2 there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Focus {
    pub(super) place: DVec3,
    pub(super) square: f64,
    /// Projects on the directions of the simplex.
    projection: DMat3,
}

impl Focus {
    /// From a simplex and a point of the dual face, which the simplex's hull holds the projection of.
    pub(super) fn new(simplex: &[Sphere], dual: DVec3) -> Self {
        let first = simplex[0].centre;
        let projection = projection(simplex.iter().skip(1).map(|sphere| sphere.centre - first));
        let place = first + projection * (dual - first);
        let squares = simplex.iter().map(|s| s.weight - place.distance_squared(s.centre));
        Self { place, square: squares.sum::<f64>() / simplex.len() as f64, projection }
    }

    /// |b|^2 - s/(1-s) |a|^2 - s R^2 about the focus.
    pub(super) fn quadric(&self, s: f64) -> Quadric {
        let along = 1.0 + s / (1.0 - s);
        let a = DMat3::IDENTITY - along * self.projection;
        Quadric { a, b: DVec3::ZERO, c: -s * self.square }
    }
}

/// The projection on what the directions span; they are independent.
fn projection(directions: impl Iterator<Item = DVec3>) -> DMat3 {
    let mut found = DMat3::ZERO;
    for (rank, direction) in directions.enumerate() {
        if rank == 2 {
            return DMat3::IDENTITY;
        }
        // Twice, since the first time leaves its rounding.
        let rest = direction - found * direction;
        let unit = (rest - found * rest).normalize();
        found += DMat3::from_cols(unit.x * unit, unit.y * unit, unit.z * unit);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_focus_of_two_is_where_their_powers_are_equal() {
        let spheres = [
            Sphere { centre: DVec3::ZERO, weight: 4.0 },
            Sphere { centre: DVec3::new(3.0, 0.0, 0.0), weight: 1.0 },
        ];
        let focus = Focus::new(&spheres, DVec3::new(2.0, 5.0, -1.0));
        assert_eq!((focus.place, focus.square), (DVec3::new(2.0, 0.0, 0.0), 0.0));
        let quadric = focus.quadric(0.25);
        assert!((quadric.value(DVec3::new(3.0, 1.0, 0.0)) + 2.0).abs() < 1e-15);
    }

    #[test]
    fn a_projection_keeps_what_it_projects_on() {
        let (u, v) = (DVec3::new(1.0, 2.0, -1.0), DVec3::new(1.0, 2.1, -1.0));
        let plane = projection([u, v].into_iter());
        assert!((plane * u - u).length() < 1e-14 && (plane * v - v).length() < 1e-14);
        assert!((plane * u.cross(v)).length() < 1e-14);
        assert_eq!(projection([].into_iter()), DMat3::ZERO);
        assert_eq!(projection([u, v, DVec3::X].into_iter()), DMat3::IDENTITY);
    }
}
