//! Enclosures of the roots of a patch on a ray.

use glam::DVec3;
use zeroset_ia::{BigInterval, Enclosure, Interval, Set, Unary};
use zeroset_raycast::{Bound, Domain, HalfSpace, Patch, Ray, Sides};

use super::is_narrow;
use crate::equation::Equation;

/// A root that is, or may be, in its patch's bound and in the range of the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Root {
    /// Encloses it.
    pub(super) t: [f64; 2],
    /// Encloses the distance from the ball's centre, in squared radii; 0 in a tetrahedron.
    pub(super) square: [f64; 2],
    pub(super) is_sure: bool,
    /// Does the ray touch the surface there?
    pub(super) is_double: bool,
}

/// The roots that count of a patch on a ray, and how many equations were solved for that.
pub(super) fn roots(patch: &Patch, sides: Sides, ray: Ray, range: [f64; 2]) -> (Vec<Root>, u64) {
    let double = Interval::<f64, Set>::point(0.0);
    let mut found = solve(&double, patch, sides, ray, range);
    let mut solved = 1;
    for bits in BITS {
        if found.iter().all(|root| root.is_sure && is_narrow(root.t)) {
            break;
        }
        found = solve(&BigInterval::from_f64(0.0, bits), patch, sides, ray, range);
        solved += 1;
    }
    (found, solved)
}

/// The precisions above double. The last one holds the discriminant of numbers of like size exactly.
const BITS: [usize; 2] = [256, 2048];

/// An enclosing number of some precision.
trait Bits: Enclosure {
    /// A double, exactly.
    fn of(&self, x: f64) -> Self;
    /// Bounds.
    fn ends(&self) -> [f64; 2];
}

impl Bits for Interval<f64, Set> {
    fn of(&self, x: f64) -> Self {
        Self::point(x)
    }
    fn ends(&self) -> [f64; 2] {
        [self.lo, self.hi]
    }
}

impl Bits for BigInterval {
    fn of(&self, x: f64) -> Self {
        Self::from_f64(x, self.precision())
    }
    fn ends(&self) -> [f64; 2] {
        self.to_f64()
    }
}

/// Is something so?
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Known {
    No,
    Maybe,
    Yes,
}

/// Is it 0 or more?
fn is_not_negative<N: Enclosure>(x: &N) -> Known {
    match x {
        x if x.is_negative() => Known::No,
        x if x.is_positive() || is_zero(x) => Known::Yes,
        _ => Known::Maybe,
    }
}

fn is_zero<N: Enclosure>(x: &N) -> bool {
    x.is_point() && !x.is_positive() && !x.is_negative()
}

fn solve<N: Bits>(zero: &N, patch: &Patch, sides: Sides, ray: Ray, range: [f64; 2]) -> Vec<Root> {
    let exact = |v: DVec3| v.to_array().map(|x| zero.of(x));
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    // About a point of the ray near the patch, any double: less is lost.
    let middle = patch.bound.ball().0 + patch.origin;
    let start = (middle - origin).dot(direction) / direction.length_squared();
    let start = if start.is_finite() { start } else { 0.0 };
    let d = exact(direction);
    let at = |start: N| {
        let (o, p) = (exact(origin), exact(patch.origin));
        [0, 1, 2].map(|i| o[i].clone() + start.clone() * d[i].clone() - p[i].clone())
    };
    let point = at(zero.of(start));
    let columns = [patch.quadric.a.x_axis, patch.quadric.a.y_axis, patch.quadric.a.z_axis];
    let times = |v: &[N; 3]| columns.map(|column| dot(&exact(column), v));
    let b = exact(patch.quadric.b);
    let (along_d, along_point) = (times(&d), times(&point));
    let two = zero.of(2.0);
    let equation = Equation {
        alpha: dot(&d, &along_d),
        beta: dot(&d, &[0, 1, 2].map(|i| along_point[i].clone() + b[i].clone())),
        gamma: dot(&point, &[0, 1, 2].map(|i| along_point[i].clone() + two.clone() * b[i].clone()))
            + zero.of(patch.quadric.c),
    };
    let mut found = Vec::new();
    for (t, is_double) in enclosed(&equation, sides) {
        let (place, square, t, is_known) = match t {
            Some(t) => {
                let x = [0, 1, 2].map(|i| point[i].clone() + t.clone() * d[i].clone());
                let (place, square) = place(zero, patch, &x);
                (place, square, (zero.of(start) + t).ends(), true)
            }
            // Anywhere in the bound.
            None => match within(patch, ray, range) {
                Some(t) => (Known::Maybe, [0.0, 1.0], t, false),
                None => continue,
            },
        };
        let in_range = match t {
            [lo, hi] if hi < range[0] || range[1] < lo => Known::No,
            [lo, hi] if range[0] <= lo && hi <= range[1] => Known::Yes,
            _ => Known::Maybe,
        };
        match place.min(in_range) {
            Known::No => {}
            known => {
                let is_sure = known == Known::Yes && is_known;
                let t = [t[0].max(range[0]), t[1].min(range[1])];
                found.push(Root { t, square, is_sure, is_double });
            }
        }
    }
    found
}

/// The range of t in which the ray may be in the patch's bound.
fn within(patch: &Patch, ray: Ray, range: [f64; 2]) -> Option<[f64; 2]> {
    let [min, max] = patch.corners();
    Domain { min, max, ball: None }.clip(ray, range).map(|clip| clip.outer)
}

fn dot<N: Enclosure>(a: &[N; 3], b: &[N; 3]) -> N {
    let [x, y, z] = [0, 1, 2].map(|i| a[i].clone() * b[i].clone());
    x + y + z
}

/// Enclosures of the roots that a side shows, each with whether the ray only touches there; `None` for one that
/// may be anywhere, or nowhere.
fn enclosed<N: Enclosure>(equation: &Equation<N>, sides: Sides) -> Vec<(Option<N>, bool)> {
    let Equation { alpha, beta, gamma } = equation;
    let discriminant = beta.clone().sqr() - alpha.clone() * gamma.clone();
    let has_alpha = alpha.is_positive() || alpha.is_negative();
    if discriminant.is_negative() {
        return Vec::new();
    }
    if is_zero(&discriminant) && has_alpha {
        return vec![(Some(-beta.clone() / alpha.clone()), true)];
    }
    if is_zero(alpha) && is_zero(beta) && (gamma.is_positive() || gamma.is_negative()) {
        return Vec::new();
    }
    if !discriminant.is_positive() {
        return match sides {
            Sides::Front => vec![(None, false)],
            Sides::Both => vec![(None, false); 2],
        };
    }
    let s = discriminant.unary(Unary::Sqrt);
    // (-beta - s)/alpha and (-beta + s)/alpha, each as the quotient that does not cancel.
    let quotient = |numerator: N| -> Option<Option<N>> {
        if has_alpha {
            Some(Some(numerator / alpha.clone()))
        } else {
            // At infinity, or who knows where.
            (!is_zero(alpha)).then_some(None)
        }
    };
    let (beta, gamma) = (beta.clone(), gamma.clone());
    let enters = if beta.is_negative() {
        Some(Some(gamma.clone() / (s.clone() - beta.clone())))
    } else {
        quotient(-(beta.clone() + s.clone()))
    };
    let leaves =
        if beta.is_positive() { Some(Some(-gamma / (beta + s))) } else { quotient(s - beta) };
    let shown = match sides {
        Sides::Front => vec![enters],
        Sides::Both => vec![enters, leaves],
    };
    shown.into_iter().flatten().map(|root| (root, false)).collect()
}

/// Is a point in the bound, and its squared distance from the ball's centre in radii.
fn place<N: Bits>(zero: &N, patch: &Patch, x: &[N; 3]) -> (Known, [f64; 2]) {
    let exact = |v: DVec3| v.to_array().map(|x| zero.of(x));
    let minus = |a: &[N; 3], b: &[N; 3]| [0, 1, 2].map(|i| a[i].clone() - b[i].clone());
    let below = |HalfSpace { normal, offset }: HalfSpace| {
        is_not_negative(&(zero.of(offset) - dot(&exact(normal), x)))
    };
    let clip = patch.clip.map_or(Known::Yes, below);
    match patch.bound {
        Bound::Ball { centre, radius } => {
            let away = minus(x, &exact(centre));
            let [a, b, c] = away.map(N::sqr);
            let (distance, square) = (a + b + c, zero.of(radius).sqr());
            let known = is_not_negative(&(square.clone() - distance.clone()));
            (known.min(clip), (distance / square).ends())
        }
        Bound::Tetrahedron(corners) => {
            let corners = corners.map(exact);
            let mut known = clip;
            for i in 0..4 {
                let [p, q, r] = [1, 2, 3].map(|k| &corners[(i + k) % 4]);
                let normal = cross(&minus(q, p), &minus(r, p));
                // The corner across says which side is inside.
                let side = dot(&normal, &minus(&corners[i], p));
                let here = dot(&normal, &minus(x, p));
                let face = match (side.is_positive(), side.is_negative()) {
                    (true, _) => is_not_negative(&here),
                    (_, true) => is_not_negative(&-here),
                    _ => Known::Maybe,
                };
                known = known.min(face);
            }
            (known, [0.0; 2])
        }
    }
}

fn cross<N: Enclosure>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    [0, 1, 2].map(|i| {
        let [j, k] = [(i + 1) % 3, (i + 2) % 3];
        a[j].clone() * b[k].clone() - a[k].clone() * b[j].clone()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use zeroset_raycast::Quadric;
    use zeroset_raycast::quadric::Coefficients;

    const ALL: [f64; 2] = [0.0, f64::INFINITY];

    fn sphere(radius: f64) -> Patch {
        let quadric: Quadric =
            Coefficients { constant: -1.0, xx: 1.0, yy: 1.0, zz: 1.0, ..Default::default() }.into();
        let bound = Bound::Ball { centre: DVec3::ZERO, radius };
        Patch { origin: DVec3::ZERO, quadric, bound, clip: None }
    }

    #[test]
    fn roots_are_enclosed() {
        let ray = Ray::new(Vec3::new(0.0, 0.0, -3.0), Vec3::new(0.1, 0.0, 1.0));
        let (front, solved) = roots(&sphere(2.0), Sides::Front, ray, ALL);
        let (both, _) = roots(&sphere(2.0), Sides::Both, ray, ALL);
        assert_eq!((front.len(), both.len(), solved), (1, 2, 1));
        assert_eq!(front[0], both[0]);
        let (alpha, beta, gamma) = (1.01_f64, -3.0, 8.0);
        // 0.1 is a little more in single precision.
        let s = (beta * beta - alpha * gamma).sqrt();
        for (root, t) in both.iter().zip([(-beta - s) / alpha, (-beta + s) / alpha]) {
            let [lo, hi] = root.t;
            assert!(root.is_sure && (lo - t).abs() < 1e-7 && hi - lo < 1e-14, "{root:?} {t}");
            assert!((root.square[0] - 0.25).abs() < 1e-12, "{root:?}");
        }
    }

    #[test]
    fn a_ray_that_touches_is_decided_by_more_bits() {
        let ray = Ray::new(Vec3::new(1.0, 0.0, -3.0), Vec3::new(0.0, 0.0, 0.7));
        let (found, solved) = roots(&sphere(1.0), Sides::Front, ray, ALL);
        let [root] = found[..] else { panic!("{found:?}") };
        assert!(root.is_double && solved > 1 && root.t[0] <= root.t[1], "{root:?} {solved}");
        // A little beside it there is none, and a little inside there are two.
        let beside = Ray::new(Vec3::new(1.0_f32.next_up(), 0.0, -3.0), ray.direction);
        assert_eq!(roots(&sphere(1.0), Sides::Both, beside, ALL).0, []);
        let inside = Ray::new(Vec3::new(1.0_f32.next_down(), 0.0, -3.0), ray.direction);
        let (found, _) = roots(&sphere(2.0), Sides::Both, inside, ALL);
        assert!(found.len() == 2 && found.iter().all(|r| r.is_sure && !r.is_double), "{found:?}");
    }

    #[test]
    fn a_line_in_the_surface_is_undecided() {
        let plane = Quadric::from(Coefficients { z: 1.0, ..Default::default() });
        let patch = Patch { quadric: plane, ..sphere(1.0) };
        let ray = Ray::new(Vec3::new(-3.0, 0.0, 0.0), Vec3::X);
        let (found, _) = roots(&patch, Sides::Both, ray, ALL);
        let [root, other] = found[..] else { panic!("{found:?}") };
        assert_eq!(root, other);
        assert!(!root.is_sure && (root.t[0] - 2.0).abs() < 1e-9 && (root.t[1] - 4.0).abs() < 1e-9);
        let above = Ray::new(Vec3::new(-3.0, 0.0, 0.1), Vec3::X);
        assert_eq!(roots(&patch, Sides::Both, above, ALL).0, []);
        let across = Ray::new(Vec3::new(0.2, 0.0, 1.0), Vec3::NEG_Z);
        let (found, _) = roots(&patch, Sides::Front, across, ALL);
        let [lo, hi] = found[0].t;
        assert!(found[0].is_sure && lo <= 1.0 && 1.0 <= hi && hi - lo < 1e-14, "{found:?}");
        // From below it shows its inside.
        let below = Ray::new(Vec3::new(0.2, 0.0, -1.0), Vec3::Z);
        assert_eq!(roots(&patch, Sides::Front, below, ALL).0, []);
    }

    #[test]
    fn tetrahedra_are_closed() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.0, 0.0, 1.0)];
        let plane = Quadric::from(Coefficients { z: 1.0, constant: -0.25, ..Default::default() });
        let bound = Bound::Tetrahedron(corners);
        let patch = Patch { origin: DVec3::ZERO, quadric: plane, bound, clip: None };
        let down = |x: f32, y: f32| {
            let ray = Ray::new(Vec3::new(x, y, 2.0), Vec3::NEG_Z);
            roots(&patch, Sides::Front, ray, ALL).0
        };
        for (x, y) in [(0.25, 0.25), (0.0, 0.25), (0.0, 0.0), (0.75, 0.0), (0.5, 0.25)] {
            assert!(down(x, y).iter().all(|root| root.is_sure) && down(x, y).len() == 1, "{x} {y}");
        }
        for (x, y) in [(0.75_f32.next_up(), 0.0), (-1e-30, 0.1), (0.5, 0.25_f32.next_up())] {
            assert_eq!(down(x, y), [], "{x} {y}");
        }
    }
}
