//! A bilinear quadrilateral, its quadric in its tetrahedron, and the ray's own way to it are one surface.

use glam::{DMat3, DVec3, Vec3};
use proptest::prelude::*;
use zeroset_model::bilinear::{Quadrilateral, folded_strip, patches, triangle_patches, twisted};

mod casting;
use casting::{Crossing, crossings};

const ALWAYS: std::ops::RangeInclusive<f64> = f64::NEG_INFINITY..=f64::INFINITY;

fn cases(count: u32) -> ProptestConfig {
    let plain = ProptestConfig::with_cases(count);
    ProptestConfig { failure_persistence: None, max_global_rejects: 1 << 16, ..plain }
}

fn point() -> impl Strategy<Value = DVec3> {
    // Of single precision, as the patches like it.
    [-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0].prop_map(|p| Vec3::from(p).as_dvec3())
}

/// Any four corners: folded ones and bow-ties are among them.
fn quadrilateral() -> impl Strategy<Value = Quadrilateral> {
    [point(), point(), point(), point()].prop_map(Quadrilateral)
}

/// Corners in a plane but for a height; any order of the corners, so bow-ties and arrows.
fn flat(height: f64) -> impl Strategy<Value = Quadrilateral> {
    (quadrilateral(), point(), point()).prop_map(move |(quad, x, y)| {
        let frame = DMat3::from_cols(x, y, x.cross(y).normalize_or_zero());
        Quadrilateral(quad.0.map(|p| frame * (p * DVec3::new(1.0, 1.0, height))))
    })
}

fn barycentric(quad: &Quadrilateral, x: DVec3) -> [f64; 4] {
    let [p1, p2, p3, p4] = quad.0;
    let l = DMat3::from_cols(p2 - p1, p3 - p1, p4 - p1).inverse() * (x - p1);
    [1.0 - l.x - l.y - l.z, l.x, l.y, l.z]
}

/// The volume of the tetrahedron in units of that of its box: what rounding is divided by.
fn volume(quad: &Quadrilateral) -> f64 {
    let [p1, p2, p3, p4] = quad.0;
    (p2 - p1).cross(p3 - p1).dot(p4 - p1).abs()
}

/// All t of the ray on the quadrilateral: Newton's method from a grid of u and v.
fn searched(quad: &Quadrilateral, origin: DVec3, direction: DVec3) -> Vec<[f64; 3]> {
    let [p1, p2, p3, p4] = quad.0;
    let mut found: Vec<[f64; 3]> = Vec::new();
    for start in 0..49 {
        let (mut u, mut v) = (f64::from(start % 7) / 6.0, f64::from(start / 7) / 6.0);
        let mut t = (quad.point(u, v) - origin).dot(direction) / direction.length_squared();
        let mut is_done = false;
        for _ in 0..40 {
            let off = quad.point(u, v) - origin - t * direction;
            let by_u = (1.0 - v) * (p2 - p1) + v * (p3 - p4);
            let by_v = (1.0 - u) * (p4 - p1) + u * (p3 - p2);
            let step = DMat3::from_cols(by_u, by_v, -direction).inverse() * off;
            (u, v, t) = (u - step.x, v - step.y, t - step.z);
            is_done = step.abs().max_element() < 1e-13;
            if is_done || !(u.abs() + v.abs() < 1e3) {
                break;
            }
        }
        let is_on = [u, v].iter().all(|w| (0.0..=1.0).contains(w));
        if is_done && is_on && !found.iter().any(|f| (f[0] - t).abs() < 1e-9) {
            found.push([t, u, v]);
        }
    }
    found.sort_by(|a, b| a[0].total_cmp(&b[0]));
    found
}

/// Does rounding or a search that starts from a grid decide? Grazing rays and those through edges.
fn is_close(quad: &Quadrilateral, direction: DVec3, [_, u, v]: [f64; 3]) -> bool {
    let is_edge = |w: f64| w.min(1.0 - w) < 1e-3;
    let grazes = quad.normal(u, v).dot(direction.normalize()).abs() < 0.05;
    is_edge(u) || is_edge(v) || grazes
}

proptest! {
    #![proptest_config(cases(2500))]

    #[test]
    fn the_quadric_in_the_tetrahedron_is_the_quadrilateral(
        quad in quadrilateral(), u in 0.0..1.0f64, v in 0.0..1.0f64,
        through in [0.05..1.0f64, 0.05..1.0, 0.05..1.0, 0.05..1.0],
        direction in point(),
    ) {
        prop_assume!(volume(&quad) > 1e-2 && direction.length() > 0.1);
        let quadric = quad.quadric().unwrap();
        // Its points are on the quadric, with the gradient along the normal.
        let x = quad.point(u, v);
        prop_assert!(quadric.value(x).abs() < 1e-12, "{}", quadric.value(x));
        let gradient = quadric.half_gradient(x);
        prop_assert!(gradient.normalize().dot(quad.normal(u, v)) > 1.0 - 1e-9);
        prop_assert!(quad.0.iter().all(|&p| quadric.half_gradient(p).length() < 0.5 + 1e-9));
        // Roots of the quadric in the tetrahedron, on a line through it, are points of it.
        let sum: f64 = through.iter().sum();
        let inside: DVec3 = quad.0.iter().zip(through).map(|(&p, l)| l / sum * p).sum();
        let (alpha, beta, gamma) = (
            direction.dot(quadric.a * direction),
            direction.dot(quadric.half_gradient(inside)),
            quadric.value(inside),
        );
        let root = (beta * beta - alpha * gamma).sqrt();
        prop_assume!(root > 1e-4);
        let mut met = Vec::new();
        for t in [gamma / (root - beta), -gamma / (root + beta)] {
            let y = inside + t * direction;
            let l = barycentric(&quad, y);
            if l.iter().all(|&l| l >= 0.0) {
                let (u, v) = (l[1] + l[2], l[2] + l[3]);
                prop_assert!((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v));
                let off = (quad.point(u, v) - y).length();
                prop_assert!(off < 1e-8, "{off:e} at {u}, {v}");
                met.push(t);
            }
        }
        // And the ray's own way finds the first of them.
        met.sort_by(f64::total_cmp);
        let own = quad.intersect(inside, direction, ALWAYS).map(|(t, ..)| t);
        match (met.first(), own) {
            (None, None) => {}
            (Some(&t), Some(own)) => prop_assert!((t - own).abs() < 1e-7, "{t} {own}"),
            (t, own) => prop_assert!(false, "{t:?} {own:?}"),
        }
    }

    #[test]
    fn the_rays_own_way_finds_what_a_search_finds(
        quad in prop_oneof![quadrilateral(), flat(0.0), flat(1e-3), flat(1e-9)],
        u in 0.01..0.99f64, v in 0.01..0.99f64, direction in point(), back in 0.0..3.0f64,
    ) {
        prop_assume!(direction.length() > 0.1);
        let origin = quad.point(u, v) - back * direction;
        let found = searched(&quad, origin, direction);
        prop_assume!(!found.is_empty() && !found.iter().any(|&at| is_close(&quad, direction, at)));
        let (t, u, v) = quad.intersect(origin, direction, ALWAYS).expect("the search found it");
        prop_assert!((t - found[0][0]).abs() < 1e-9, "{t} {found:?}");
        prop_assert!((quad.point(u, v) - origin - t * direction).length() < 1e-9);
        if let Some(second) = found.get(1).filter(|second| second[0] > t + 1e-6) {
            let rest = 0.5 * (t + second[0])..=f64::INFINITY;
            let next = quad.intersect(origin, direction, rest);
            prop_assert!((next.unwrap().0 - second[0]).abs() < 1e-9, "{next:?} {found:?}");
        }
    }

    #[test]
    fn rays_at_a_point_of_a_quadrilateral_meet_its_patches(
        quad in prop_oneof![quadrilateral(), flat(1e-2), flat(1e-4), flat(1e-6)],
        u in 0.001..0.999f64, v in 0.001..0.999f64, direction in point(),
    ) {
        let x = quad.point(u, v);
        prop_assume!(direction.length() > 0.1 && quad.normal(u, v).dot(direction.normalize()).abs() > 0.05);
        let is_convex = {
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[u, v]| quad.normal(u, v));
            corners.iter().all(|n| n.dot(corners[0]) > 0.0)
        };
        // Where a flat one folds, its quadric has two roots that are nearly one.
        prop_assume!(quad.flatness() > 0.01 || is_convex);
        let surface = patches(&[quad]).unwrap();
        let hits = crossings(&surface, x - 2.0 * direction, direction);
        let off = hits.iter().map(|hit| (hit.t - 2.0).abs()).fold(f64::INFINITY, f64::min);
        let tolerance = if quad.is_planar() { 1e-3 } else { 1e-8 };
        prop_assert!(off < tolerance, "{off:e} {hits:?}");
    }
}

#[test]
fn no_ray_is_lost_at_the_edges_of_a_strip() {
    let strip = folded_strip();
    for surface in [patches(&strip).unwrap(), triangle_patches(&strip).unwrap()] {
        for pair in strip.windows(2) {
            for step in 0..=200 {
                let at = pair[0].point(1.0, f64::from(step) / 200.0);
                for k in 0..8 {
                    let (sin, cos) = (0.4 + 0.785 * f64::from(k)).sin_cos();
                    let direction = DVec3::new(0.3 * sin, cos, sin);
                    // A ray that grazes one of both may leave the surface here.
                    let v = f64::from(step) / 200.0;
                    let normals = [pair[0].normal(1.0, v), pair[1].normal(0.0, v)];
                    if normals.iter().any(|n| n.dot(direction).abs() < 0.05) {
                        continue;
                    }
                    let hits = crossings(&surface, at - 3.0 * direction, direction);
                    let is_hit = |hit: &Crossing| (hit.t - 3.0).abs() < 1e-7;
                    assert!(hits.iter().any(is_hit), "{at} {direction} {hits:?}");
                }
            }
        }
    }
}

#[test]
fn planar_ones_are_covered_and_no_more() {
    let square = twisted(0.0);
    let surface = patches(&[square]).unwrap();
    let half = twisted(0.5);
    let curved = patches(&[half]).unwrap();
    for i in -60..=60 {
        for k in -60..=60 {
            let at = DVec3::new(f64::from(i), f64::from(k), 40.0) / 50.0;
            let inside = at.x.abs() <= 1.0 && at.y.abs() <= 1.0;
            let hits = crossings(&surface, at, DVec3::NEG_Z);
            assert_eq!(!hits.is_empty(), inside, "{at}");
            assert!(hits.iter().all(|hit| (hit.t - at.z).abs() < 1e-15));
            let hits = crossings(&curved, at, DVec3::NEG_Z);
            assert_eq!(!hits.is_empty(), inside, "{at}");
            assert!(hits.iter().all(|hit| (hit.t - at.z + 0.5 * at.x * at.y).abs() < 1e-14));
        }
    }
}
