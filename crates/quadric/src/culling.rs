//! Patches that turn their back to the eye: \[stoll2006\] Section 4.4.4.

use glam::DVec3;
use zeroset_raycast::{Bound, Patch};

/// Does a patch surely show its inside alone to the eye?
///
/// About the eye the quadric is y'A y + 2 b'y + c, and at a root y the ray leaves the inside where
/// y'(A y + b) > 0, which is -(b'y + c) > 0. So none is entered if c + b'y < 0 for every y in the bound
/// (Eq. 18): for a ball, c + b'y_0 + r |b|; for a tetrahedron, the greatest of the corners (Eq. 19). A margin
/// stands for what was rounded.
pub fn is_hidden(patch: &Patch, eye: DVec3) -> bool {
    let e = eye - patch.origin;
    let q = patch.quadric.about(e);
    // Of the terms that c is made of; each has a few roundings.
    let size = {
        let (a, b, e) = (patch.quadric.a.abs(), patch.quadric.b.abs(), e.abs());
        e.dot(a * e + 2.0 * b) + patch.quadric.c.abs()
    };
    let steepness = patch.quadric.a.abs() * e.abs() + patch.quadric.b.abs();
    let (most, reach) = match patch.bound {
        Bound::Ball { centre, radius } => {
            let y = centre - e;
            (q.b.dot(y) + radius * q.b.length(), y.abs() + radius)
        }
        Bound::Tetrahedron(corners) => {
            let y = corners.map(|corner| corner - e);
            let most = y.iter().map(|y| q.b.dot(*y)).fold(f64::NEG_INFINITY, f64::max);
            (most, y.into_iter().fold(DVec3::ZERO, |reach, y| reach.max(y.abs())))
        }
    };
    let margin = 32.0 * f64::EPSILON * (size + steepness.dot(reach));
    q.c + most < -margin
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_raycast::Quadric;
    use zeroset_raycast::quadric::Coefficients;

    fn unit_sphere() -> Quadric {
        Coefficients { constant: -1.0, xx: 1.0, yy: 1.0, zz: 1.0, ..Default::default() }.into()
    }

    #[test]
    fn the_far_side_of_a_sphere_is_hidden() {
        let at = |z: f64| {
            let centre = DVec3::new(0.0, 0.0, z);
            let bound = Bound::Ball { centre, radius: 0.2 };
            Patch { origin: DVec3::ZERO, quadric: unit_sphere(), bound, clip: None }
        };
        let eye = DVec3::new(0.0, 0.0, -3.0);
        assert!(is_hidden(&at(1.0), eye));
        assert!(!is_hidden(&at(-1.0), eye));
        // Seen from inside everything is.
        assert!(is_hidden(&at(1.0), DVec3::ZERO) && is_hidden(&at(-1.0), DVec3::ZERO));
        let shifted = |z: f64| Patch { origin: DVec3::new(1e3, 0.0, 0.0), ..at(z) };
        let eye = DVec3::new(1e3, 0.0, -3.0);
        assert!(is_hidden(&shifted(1.0), eye) && !is_hidden(&shifted(-1.0), eye));
        // So far that nothing is known.
        assert!(!is_hidden(&at(1.0), DVec3::new(0.0, 0.0, -1e20)));
    }

    #[test]
    fn tetrahedra_are_hidden_by_their_corners() {
        let at = |z: f64| {
            let corner = |x: f64, y: f64, dz: f64| DVec3::new(x, y, z + dz);
            let corners = [
                corner(0.1, 0.0, 0.1),
                corner(-0.1, 0.1, 0.1),
                corner(-0.1, -0.1, 0.1),
                corner(0.0, 0.0, -0.1),
            ];
            let bound = Bound::Tetrahedron(corners);
            Patch { origin: DVec3::ZERO, quadric: unit_sphere(), bound, clip: None }
        };
        let eye = DVec3::new(0.0, 0.0, -3.0);
        assert!(is_hidden(&at(1.0), eye) && !is_hidden(&at(-1.0), eye));
    }
}
