//! Bilinear quadrilaterals as quadrics, \[stoll2006\] Section 4.5.
//!
//! Let l1 to l4 be the barycentric coordinates of a point in the tetrahedron between the corners. By Eq. 1
//! those of s(u, v) are (1-u)(1-v), u(1-v), uv and (1-u)v, so l1 l3 = l2 l4: that is the quadric. The other
//! way round, let l1 l3 = l2 l4 with no coordinate below 0, and u = l2 + l3, v = l3 + l4, both in \[0, 1\].
//! Then uv = l3 (l1 + l2 + l3 + l4) = l3, and the others follow: the point is s(u, v). **In its tetrahedron
//! the quadric is the quadrilateral and nothing else**, however twisted it is, so long as there is a
//! tetrahedron; and its normal is nowhere 0. Tests hold both against thousands of quadrilaterals.
//!
//! A planar quadrilateral is two triangles, as the paper says. That is the same set of points if it is
//! convex. If it is not, s folds over, and what it covers beyond the two triangles, or they beyond it, is
//! bounded by a parabola; [`Quadrilateral::intersect`] follows the fold, the triangles do not.
//!
//! With g the flatness of a quadrilateral, the width of its tetrahedron in units of its longest edge, the
//! other sheet of its quadric is about g away, unless it is nearly a parallelogram. A root in a precision of
//! e is then found e/g off, and since faces of the tetrahedron meet at an angle of g, rays that pass within
//! e/g^2 of an edge may be lost. Two triangles lie at most g off and lose none. Both errors are alike at the
//! cube root of e: for double precision at g = 2^-17, where [`patches`] changes to triangles. For single
//! precision that is 2^-8; [`patches_flat`] changes earlier. Of 20000 rays at convex quadrilaterals of side 2
//! with heights of up to 1e-2, 1e-3 and 1e-4, single precision loses 4, 32 and 255 at the edges of their
//! quadrics, and double precision none.

mod intersection;
mod strip;
mod surface;

pub use strip::{folded_strip, twisted};
pub use surface::{patches, patches_flat, triangle_patches};

use glam::{DAffine3, DMat3, DVec3};
use zeroset_raycast::Quadric;

/// A bilinear quadrilateral: its corners in cyclic order, p1 to p4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadrilateral(pub [DVec3; 4]);

/// The flatness up to which a quadrilateral counts as planar.
const PLANAR: f64 = 1.0 / (1u64 << 17) as f64;

impl Quadrilateral {
    /// s(u, v): \[stoll2006\] Eq. 1.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        let [p1, p2, p3, p4] = self.0;
        (1.0 - v) * ((1.0 - u) * p1 + u * p2) + v * ((1.0 - u) * p4 + u * p3)
    }

    /// The unit normal at s(u, v), along the derivative by u times that by v; 0 where these are parallel,
    /// which takes a planar quadrilateral.
    pub fn normal(&self, u: f64, v: f64) -> DVec3 {
        let [p1, p2, p3, p4] = self.0;
        let by_u = (1.0 - v) * (p2 - p1) + v * (p3 - p4);
        let by_v = (1.0 - u) * (p4 - p1) + u * (p3 - p2);
        by_u.cross(by_v).normalize_or_zero()
    }

    /// The same quadrilateral in coordinates y = x - origin.
    #[must_use]
    pub fn about(&self, origin: DVec3) -> Self {
        Self(self.0.map(|p| p - origin))
    }

    /// The quadric that is the quadrilateral in the tetrahedron between its corners: \[stoll2006\] Eq. 22
    /// to 29, where A'33 is 2ef. None if it is planar.
    ///
    /// The corner that the frame of Eq. 22 stands on is the one where its area is greatest. The gradient
    /// points along the [`normal`](Self::normal); its greatest length at a corner is 1, so that f is near
    /// the distance.
    pub fn quadric(&self) -> Option<Quadric> {
        if self.is_planar() {
            return None;
        }
        let (area, [p1, p2, p3, p4]) = (0..4)
            .map(|i| {
                let p = [0, 1, 2, 3].map(|k| self.0[(i + k) % 4]);
                ((p[1] - p[0]).cross(p[3] - p[0]), p)
            })
            .max_by(|a, b| a.0.length_squared().total_cmp(&b.0.length_squared()))?;
        let map = DAffine3::from_mat3_translation(DMat3::from_cols(p2 - p1, p4 - p1, area), p1);
        let DVec3 { x, y, z: g } = map.matrix3.inverse() * (p3 - p1);
        let (e, f) = (x - 1.0, y - 1.0);
        let twisted = Quadric {
            a: DMat3::from_cols(
                DVec3::new(0.0, g * g, -f * g),
                DVec3::new(g * g, 0.0, -e * g),
                DVec3::new(-f * g, -e * g, 2.0 * e * f),
            ),
            b: DVec3::new(0.0, 0.0, -g),
            c: 0.0,
        };
        let quadric = twisted.mapped(map);
        let steepest = self.0.map(|p| quadric.half_gradient(p).length());
        let steepest = 2.0 * steepest.into_iter().fold(0.0, f64::max);
        Some(quadric.scaled(-g.signum() / steepest))
    }

    /// Do the corners lie in a plane, but for 2^-17 of the longest distance between two?
    pub fn is_planar(&self) -> bool {
        !(self.flatness() > PLANAR)
    }

    /// The width of the tetrahedron in units of the longest distance between two corners: 0 in a plane, and
    /// NaN for no distance at all.
    pub fn flatness(&self) -> f64 {
        self.width() / self.size()
    }

    /// The longest distance between two corners.
    fn size(&self) -> f64 {
        self.edges().into_iter().map(DVec3::length).fold(0.0, f64::max)
    }

    /// The least distance of two parallel planes that the corners lie between. They are at right angles to
    /// two edges of the tetrahedron, whose six lines are taken in pairs.
    fn width(&self) -> f64 {
        let edges = self.edges();
        let volume = edges[0].cross(edges[1]).dot(edges[2]).abs();
        let pairs = (0..6).flat_map(|i| (0..i).map(move |k| (i, k)));
        let area = pairs.map(|(i, k)| edges[i].cross(edges[k]).length()).fold(0.0, f64::max);
        if area > 0.0 { volume / area } else { 0.0 }
    }

    /// The edges of the tetrahedron, the first three from p1.
    fn edges(&self) -> [DVec3; 6] {
        let [p1, p2, p3, p4] = self.0;
        [p2 - p1, p3 - p1, p4 - p1, p3 - p2, p4 - p3, p4 - p2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quadrilateral(corners: [[f64; 3]; 4]) -> Quadrilateral {
        Quadrilateral(corners.map(DVec3::from))
    }

    #[test]
    fn a_quadric_worked_by_hand() {
        let quad =
            quadrilateral([[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [4.0, 3.0, 2.0], [1.0, 2.0, 0.0]]);
        let quadric = quad.quadric().unwrap();
        // Of Eq. 23 to 25 with e = f = g = 1/2, but for a factor below 0.
        let expected = Quadric {
            a: DMat3::from_cols_array(&[
                0.0, 0.0625, -0.03125, 0.0625, 0.0, -0.03125, -0.03125, -0.03125, 0.03125,
            ]),
            b: DVec3::new(0.0, -0.0625, -0.09375),
            c: 0.0,
        };
        let scale = quadric.b.z / expected.b.z;
        assert!(scale < 0.0, "the gradient points along the normal: {scale}");
        assert!(
            (quadric.a - expected.scaled(scale).a).to_cols_array().iter().all(|x| x.abs() < 1e-15)
        );
        assert!((quadric.b - scale * expected.b).length() < 1e-15 && quadric.c.abs() < 1e-15);
        assert_eq!(quad.point(0.5, 0.5), DVec3::new(2.25, 1.25, 0.5));
    }

    #[test]
    fn the_width_is_that_of_the_tetrahedron() {
        let regular = quadrilateral([
            [1.0, 1.0, 1.0],
            [1.0, -1.0, -1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, -1.0, 1.0],
        ]);
        assert!((regular.width() - 2.0).abs() < 1e-15);
        let flat =
            |h: f64| quadrilateral([[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, h], [0.0, 1.0, 0.0]]);
        assert!((flat(1e-3).width() - 0.5e-3).abs() < 1e-8, "{}", flat(1e-3).width());
        assert!(flat(2e-5).is_planar() && !flat(3e-5).is_planar());
        // Diagonals that are nearly parallel, and far apart, make a thin tetrahedron too.
        let bow = quadrilateral([[0.0; 3], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1e-6]]);
        assert!(bow.is_planar());
        assert!(quadrilateral([[1.0; 3]; 4]).is_planar());
        assert_eq!(quadrilateral([[f64::NAN; 3]; 4]).quadric(), None);
    }
}
