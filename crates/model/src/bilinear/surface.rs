//! Quadrilaterals as patches.

use glam::{DMat3, DVec3};
use zeroset_raycast::{Blending, Bound, Error, Patch, Patches, Quadric, Sides};

use super::Quadrilateral;

/// The area up to which three corners count as on one line, in squares of the longest distance.
const LINE: f64 = 1.0 / (1u64 << 40) as f64;

/// Quadrilaterals as quadrics in the tetrahedra between their corners; planar ones as two triangles, each a
/// plane. Both sides are seen.
///
/// Corners are given about a point of single precision near them. Quadrilaterals that share an edge share its
/// ends but for half a rounding of the quadrilaterals' size.
///
/// # Errors
/// If there are none, or one is not finite or has all corners on a line.
pub fn patches(all: &[Quadrilateral]) -> Result<Patches, Error> {
    patches_flat(all, 0.0)
}

/// As [`patches`], with two triangles for all that have no more than this
/// [`flatness`](Quadrilateral::flatness): for methods in single precision.
///
/// # Errors
/// As [`patches`].
pub fn patches_flat(all: &[Quadrilateral], flatness: f64) -> Result<Patches, Error> {
    let pieces = all.iter().enumerate().map(|(i, quad)| {
        let origin = quad.check(i)?;
        let near = quad.about(origin);
        let quadric = near.quadric().filter(|_| near.flatness() > flatness);
        Ok(match quadric {
            Some(quadric) => {
                vec![Patch { origin, quadric, bound: Bound::Tetrahedron(near.0), clip: None }]
            }
            None => near.halves().into_iter().filter_map(|p| triangle(origin, p)).collect(),
        })
    });
    surface(pieces)
}

/// Each quadrilateral as [`Quadrilateral::two_triangles`], for comparison: the right side of
/// \[stoll2006\] Fig. 9.
///
/// # Errors
/// As [`patches`].
pub fn triangle_patches(all: &[Quadrilateral]) -> Result<Patches, Error> {
    let pieces = all.iter().enumerate().map(|(i, quad)| {
        let origin = quad.check(i)?;
        let triangles = quad.about(origin).two_triangles();
        Ok(triangles.into_iter().filter_map(|p| triangle(origin, p)).collect())
    });
    surface(pieces)
}

fn surface(pieces: impl Iterator<Item = Result<Vec<Patch>, Error>>) -> Result<Patches, Error> {
    let all = pieces.collect::<Result<Vec<_>, _>>()?;
    Patches::new(all.into_iter().flatten().collect(), Sides::Both, Blending::None)
}

/// A triangle as a plane in a tetrahedron that it cuts from side to side; none without area.
///
/// Its edges are in three faces of the tetrahedron and its inside is far from the fourth face and from the
/// corner across, so that rounding does not decide whether the plane is in its bound.
fn triangle(origin: DVec3, corners: [DVec3; 3]) -> Option<Patch> {
    let [p, q, r] = corners;
    let area = (q - p).cross(r - p);
    let length = [q - p, r - q, p - r].into_iter().map(DVec3::length).fold(0.0, f64::max);
    if !(area.length() > LINE * length * length) {
        return None;
    }
    let normal = area.normalize();
    let top = (p + q + r) / 3.0 + 0.5 * length * normal;
    // Each corner is halfway from the top to a corner of the base.
    let base = corners.map(|corner| corner + (corner - top));
    let bound = Bound::Tetrahedron([base[0], base[1], base[2], top]);
    let quadric = Quadric { a: DMat3::ZERO, b: 0.5 * normal, c: -normal.dot(p) };
    Some(Patch { origin, quadric, bound, clip: None })
}

impl Quadrilateral {
    /// The triangles (p1, p2, p3) and (p1, p3, p4), as graphics libraries draw a quadrilateral.
    pub fn two_triangles(&self) -> [[DVec3; 3]; 2] {
        let [p1, p2, p3, p4] = self.0;
        [[p1, p2, p3], [p1, p3, p4]]
    }

    /// The triangles along the diagonal that is inside, if it is planar: their areas face the same way. If
    /// it has no inside since two edges cross, those along the diagonal with the greater areas.
    fn halves(&self) -> [[DVec3; 3]; 2] {
        let [p1, p2, p3, p4] = self.0;
        let both = [self.two_triangles(), Self([p2, p3, p4, p1]).two_triangles()];
        let key = |halves: &[[DVec3; 3]; 2]| {
            let [a, b] = halves.map(|[p, q, r]| (q - p).cross(r - p));
            (a.dot(b), a.length() + b.length())
        };
        let [first, second] = [&both[0], &both[1]].map(key);
        let is_inside = |key: (f64, f64)| key.0 >= 0.0 && key.1 > 0.0;
        match [is_inside(first), is_inside(second)] {
            [true, _] => both[0],
            [false, true] => both[1],
            [false, false] => both[usize::from(second.1 > first.1)],
        }
    }

    /// A point of single precision near the corners.
    ///
    /// # Errors
    /// If it is no quadrilateral.
    fn check(&self, index: usize) -> Result<DVec3, Error> {
        let [p1, p2, p3, p4] = self.0;
        let refused = |why| Err(Error::Patches(format!("quadrilateral {index} {why}")));
        if !self.0.iter().all(|p| p.is_finite()) {
            return refused("is not finite");
        }
        let distinct = (0..4).filter(|&i| !self.0[..i].contains(&self.0[i])).count();
        if distinct < 3 {
            return refused("has fewer than three corners");
        }
        let size = self.size();
        let areas = [[p1, p2, p3], [p1, p3, p4], [p1, p2, p4], [p2, p3, p4]];
        let area = areas.map(|[p, q, r]| (q - p).cross(r - p).length());
        if !area.iter().any(|&area| area > LINE * size * size) {
            return refused("has its corners on a line");
        }
        Ok((0.25 * (p1 + p2 + p3 + p4)).as_vec3().as_dvec3())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quadrilateral(corners: [[f64; 2]; 4]) -> Quadrilateral {
        Quadrilateral(corners.map(|[x, y]| DVec3::new(x, y, 0.0)))
    }

    #[test]
    fn planar_ones_are_two_triangles_along_the_diagonal_inside() {
        let square = quadrilateral([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(square.halves(), square.two_triangles());
        let arrow = [[0.0, 0.0], [2.0, 0.0], [0.5, 0.5], [0.0, 2.0]];
        for turn in 0..4 {
            let corners = [0, 1, 2, 3].map(|i| arrow[(i + turn) % 4]);
            let halves = quadrilateral(corners).halves();
            let inside = [DVec3::ZERO, DVec3::new(0.5, 0.5, 0.0)];
            for half in halves {
                assert!(inside.iter().all(|p| half.contains(p)), "turn {turn}: {half:?}");
            }
        }
        // Two corners are one: the other diagonal has the area.
        let folded = quadrilateral([[0.0, 0.0], [2.0, 0.0], [0.0, 0.0], [0.0, 2.0]]);
        assert_eq!(patches(&[folded]).unwrap().all().len(), 2);
        let pointed = quadrilateral([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [0.0, 2.0]]);
        assert_eq!(patches(&[pointed]).unwrap().all().len(), 1);
        assert_eq!(patches(&[square]).unwrap().all().len(), 2);
        assert_eq!(triangle_patches(&[square]).unwrap(), patches(&[square]).unwrap());
        let twisted = crate::bilinear::twisted(0.01);
        assert!((twisted.flatness() - 0.01 / 2f64.sqrt()).abs() < 1e-4);
        for (flatness, count) in [(0.0, 1), (0.007, 1), (0.008, 2)] {
            assert_eq!(patches_flat(&[twisted], flatness).unwrap().all().len(), count);
        }
    }

    #[test]
    fn what_has_no_area_is_refused() {
        let square = quadrilateral([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        for (corners, why) in [
            ([[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [1.0, 0.0]], "fewer than three"),
            ([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]], "on a line"),
            ([[0.0, 0.0], [f64::NAN, 1.0], [2.0, 2.0], [3.0, 3.0]], "not finite"),
        ] {
            for make in [patches, triangle_patches] {
                let said = make(&[square, quadrilateral(corners)]).unwrap_err().to_string();
                assert!(said.contains("quadrilateral 1") && said.contains(why), "{said}");
            }
        }
        assert!(patches(&[]).is_err());
    }

    #[test]
    fn a_triangle_is_cut_out_of_its_plane() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(0.25, 0.5, 0.0)];
        let patch = triangle(DVec3::ONE, corners).unwrap();
        let Bound::Tetrahedron([a, b, c, top]) = patch.bound else { panic!("a ball") };
        for (low, corner) in [a, b, c].into_iter().zip(corners) {
            assert!((0.5 * (low + top) - corner).length() < 1e-15);
        }
        assert!((patch.quadric.value(top) - 0.5).abs() < 1e-15);
        assert_eq!(triangle(DVec3::ONE, [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X]), None);
    }
}
