//! Where a ray meets a bilinear quadrilateral, without its quadric.
//!
//! Geometric, after Reshetov, "Cool Patches", Ray Tracing Gems (2019), chapter 8. For a fixed u the
//! quadrilateral is a segment from a = (1-u) p1 + u p2 along r = (1-u)(p4-p1) + u (p3-p2). The ray o + t d
//! is in one plane with its line where (a - o).(d x r) = 0, a quadratic in u. With u known, two lines in a
//! plane meet: a - o = t d - v r, and products with r and d leave t and v, with n = d x r, as
//! t n = (a - o) x r and v n = (a - o) x d.

use std::ops::RangeInclusive;

use glam::DVec3;

use super::Quadrilateral;

/// How far beyond an edge u and v still count, for rays between two quadrilaterals, and how far below 0 a
/// discriminant still is 0: 64 roundings.
const MARGIN: f64 = 64.0 * f64::EPSILON;

/// The angle in radians below which two lines have no point to meet at, and are one if they are as near: the
/// square root of the precision, which is what a double root is known to.
const PARALLEL: f64 = 1.0 / (1u64 << 26) as f64;

/// A root: t, u and v.
type Meeting = (f64, f64, f64);

impl Quadrilateral {
    /// The first t in `range` where the ray meets the quadrilateral, in lengths of `direction`, with u and v
    /// there. Edges belong to it; a ray along a segment of constant u or v meets it where that begins. A ray
    /// in the plane of a planar quadrilateral misses.
    pub fn intersect(
        &self,
        origin: DVec3,
        direction: DVec3,
        range: RangeInclusive<f64>,
    ) -> Option<Meeting> {
        let seen = self.about(origin);
        // Where the ray is a segment of constant v, it meets those of constant u for all u.
        seen.first(direction, &range).unwrap_or_else(|| {
            let [p1, p2, p3, p4] = seen.0;
            let swapped = Self([p1, p4, p3, p2]).first(direction, &range).flatten();
            swapped.map(|(t, v, u)| (t, u, v))
        })
    }

    /// The first meeting with a ray from 0; nothing at all if the quadratic vanishes.
    fn first(&self, d: DVec3, range: &RangeInclusive<f64>) -> Option<Option<Meeting>> {
        let [p1, p2, p3, p4] = self.0;
        let [base, from, to] = [p2 - p1, p4 - p1, p3 - p2];
        let twist = to - from;
        let product = |a: DVec3, r: DVec3| a.dot(d.cross(r));
        let square = product(base, twist);
        let linear = product(p1, twist) + product(base, from);
        let constant = product(p1, from);
        let size = (p1.length() + base.length()) * d.length() * (from.length() + to.length());
        if ![square, linear, constant].iter().any(|k| k.abs() > MARGIN * size) {
            return None;
        }
        let meetings = unit_roots(square, linear, constant).into_iter().flatten().filter_map(|u| {
            let (t, v) = segment(p1 + u * base, from + u * twist, d, range)?;
            Some((t, u, v))
        });
        Some(meetings.min_by(|a, b| a.0.total_cmp(&b.0)))
    }
}

/// The roots of a u^2 + b u + c in \[0, 1\]: without cancellation, and without a case for small a.
fn unit_roots(a: f64, b: f64, c: f64) -> [Option<f64>; 2] {
    let [square, product] = [b * b, 4.0 * a * c];
    let discriminant = square - product;
    if !(discriminant >= -MARGIN * square) {
        return [None; 2];
    }
    let q = -0.5 * (b + discriminant.max(0.0).sqrt().copysign(b));
    // 0 / 0 is NaN, which lies nowhere.
    [c / q, q / a].map(|u| within(u).then(|| u.clamp(0.0, 1.0)))
}

/// Is it in \[0, 1\], but for the margin?
fn within(u: f64) -> bool {
    (-MARGIN..=1.0 + MARGIN).contains(&u)
}

/// The first t in `range` and the v in \[0, 1\] where t d = a + v r, if the lines are in one plane.
fn segment(a: DVec3, r: DVec3, d: DVec3, range: &RangeInclusive<f64>) -> Option<(f64, f64)> {
    let n = d.cross(r);
    let square = n.length_squared();
    if square > PARALLEL * PARALLEL * d.length_squared() * r.length_squared() {
        let [t, v] = [r, d].map(|along| a.cross(along).dot(n) / square);
        return (range.contains(&t) && within(v)).then(|| (t, v.clamp(0.0, 1.0)));
    }
    // The segment is along the ray, or a point.
    let away = a.cross(d).length();
    if !(away <= PARALLEL * d.length() * (a.length() + r.length())) {
        return None;
    }
    let [start, end] = [a, a + r].map(|p| p.dot(d) / d.length_squared());
    let t = start.min(end).max(*range.start());
    let v = if start == end { 0.0 } else { (t - start) / (end - start) };
    (t <= start.max(end) && range.contains(&t)).then_some((t, v))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ANY: RangeInclusive<f64> = f64::NEG_INFINITY..=f64::INFINITY;

    /// z = xy over the unit square.
    fn saddle() -> Quadrilateral {
        Quadrilateral([DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y])
    }

    #[test]
    fn a_saddle_is_met_once_from_above_and_twice_from_its_side() {
        let down = saddle().intersect(DVec3::new(0.25, 0.5, 3.0), DVec3::new(0.0, 0.0, -2.0), ANY);
        assert_eq!(down, Some((1.4375, 0.25, 0.5)));
        // x = t, y = 1 - t, z = 3/16.
        let across = |range| {
            saddle().intersect(DVec3::new(0.0, 1.0, 0.1875), DVec3::new(1.0, -1.0, 0.0), range)
        };
        let (t, u, v) = across(ANY).unwrap();
        assert!([t - 0.25, u - 0.25, v - 0.75].iter().all(|e| e.abs() < 1e-15));
        assert!((across(0.5..=1.0).unwrap().0 - 0.75).abs() < 1e-15);
        assert_eq!(across(0.8..=9.0), None);
    }

    #[test]
    fn a_ray_in_a_segment_meets_its_beginning() {
        let along = DVec3::new(0.0, 1.0, 0.5);
        let start = DVec3::new(0.5, -2.0, -1.0);
        let (t, u, v) = saddle().intersect(start, along, 0.0..=9.0).unwrap();
        assert_eq!((t, u, v), (2.0, 0.5, 0.0));
        assert_eq!(saddle().intersect(start, along, 2.25..=9.0), Some((2.25, 0.5, 0.25)));
        assert_eq!(saddle().intersect(start, along, 3.5..=9.0), None);
        let swapped = |p: DVec3| DVec3::new(p.y, p.x, p.z);
        let across = saddle().intersect(swapped(start), swapped(along), 0.0..=9.0);
        assert_eq!(across, Some((2.0, 0.0, 0.5)));
        // Beside the segment and along it.
        assert_eq!(saddle().intersect(start + 0.1 * DVec3::Z, along, 0.0..=9.0), None);
    }

    /// Rounded, such a ray passes the segment by, or crosses it at any point: it is hit where it is.
    #[test]
    fn rays_that_would_be_segments_but_for_rounding_hit_somewhere() {
        let corners = [[0.1, 0.2, 0.3], [1.1, 0.1, 0.3], [0.9, 0.7, 0.8], [0.0, 0.8, -0.2]];
        let quad = Quadrilateral(corners.map(DVec3::from));
        let mut hits = 0;
        for w in (1..37).map(|k| f64::from(k) / 37.0) {
            for [from, to] in [[(w, 0.0), (w, 1.0)], [(0.0, w), (1.0, w)]] {
                let [from, to] = [from, to].map(|(u, v)| quad.point(u, v));
                let (origin, direction) = (3.0 * from - 2.0 * to, to - from);
                if let Some((t, u, v)) = quad.intersect(origin, direction, ANY) {
                    assert!((2.0 - 1e-7..3.0 + 1e-7).contains(&t), "{t}");
                    let off = (quad.point(u, v) - origin - t * direction).length();
                    assert!(off < 1e-6, "{off:e}");
                    hits += 1;
                }
            }
        }
        assert!(hits > 66, "{hits} of 72");
    }

    #[test]
    fn a_ray_in_the_plane_of_a_square_misses() {
        let square = Quadrilateral([DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y]);
        assert_eq!(square.intersect(DVec3::NEG_X, DVec3::new(1.0, 0.25, 0.0), ANY), None);
        let (t, u, v) = square.intersect(DVec3::new(0.5, 0.25, 1.0), DVec3::NEG_Z, ANY).unwrap();
        assert_eq!((t, u, v), (1.0, 0.5, 0.25));
    }
}
