//! The part of a ray in a domain is enclosed from outside and from inside.
//!
//! The judge is exact: a point of a ray is computed with so many bits that nothing is rounded.

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use zeroset_ia::{BigInterval, Number};
use zeroset_raycast::{Domain, Ray};

/// Bits that hold every sum and product of these tests exactly.
const PRECISION: usize = 4096;

fn exact(x: f64) -> BigInterval {
    BigInterval::from_f64(x, PRECISION)
}

/// Does the ray's point at t lie in the domain?
fn holds(domain: &Domain, ray: Ray, t: f64) -> bool {
    let mut outside = false;
    let mut square = exact(0.0);
    for axis in 0..3 {
        let direction = exact(f64::from(ray.direction[axis]));
        let at = exact(f64::from(ray.origin[axis])) + direction * exact(t);
        let (min, max) = (exact(domain.min[axis]), exact(domain.max[axis]));
        assert!(at.is_point());
        outside |= (at.clone() - min.clone()).is_negative();
        outside |= (max.clone() - at.clone()).is_negative();
        // Twice the distance from the centre, so that nothing is divided.
        square = square + (at.clone() + at - min - max).sqr();
    }
    assert!(square.is_point());
    if let Some(radius) = domain.ball {
        outside |= (exact(4.0) * exact(radius).sqr() - square).is_negative();
    }
    !outside
}

/// Checks a clip against the judge at the ends, next to them, and at the given places.
fn judge(domain: &Domain, ray: Ray, range: [f64; 2], places: &[f64]) {
    let clip = domain.clip(ray, range);
    // Of many rays at once, the same bits.
    let mut rays = [Ray { origin: ray.direction, direction: ray.origin }; 4];
    rays[1] = ray;
    let components = |part: fn(&Ray) -> Vec3| {
        [0, 1, 2].map(|axis| rays.each_ref().map(|ray| f64::from(part(ray)[axis])))
    };
    let [from, to] = domain.outer(&components(|r| r.origin), &components(|r| r.direction), range);
    let outer = (from[1] <= to[1]).then_some([from[1], to[1]]);
    assert_eq!(outer.map(|ends| ends.map(f64::to_bits)), clip.map(|c| c.outer.map(f64::to_bits)));
    let mut places: Vec<f64> = places.to_vec();
    // Where the ray passes the faces, to the nearest double, and its point nearest to the centre.
    let d = ray.direction.as_dvec3();
    for corner in [domain.min, domain.max] {
        places.extend(((corner - ray.origin.as_dvec3()) / d).to_array());
    }
    places.push((domain.centre() - ray.origin.as_dvec3()).dot(d) / d.length_squared());
    places.extend(range);
    if let Some(clip) = clip {
        places.extend(clip.outer);
        places.extend(clip.inner.into_iter().flatten());
    }
    let beside = |t: f64| [t, t.next_down(), t.next_up(), 0.5 * t, 2.0 * t];
    for t in places.into_iter().flat_map(beside).filter(|t| t.is_finite() && t.abs() < 1e100) {
        let counts = range[0] <= t && t <= range[1] && holds(domain, ray, t);
        let outer = clip.is_some_and(|c| c.outer[0] <= t && t <= c.outer[1]);
        let inner = clip.and_then(|c| c.inner).is_some_and(|[lo, hi]| lo <= t && t <= hi);
        assert!(!counts || outer, "{t} lies in the domain, outside of {clip:?}");
        assert!(!inner || counts, "{t} lies outside of the domain, inside {clip:?}");
    }
}

/// Numbers that meet: of a coarse grid, near it, tiny, or anything of moderate size.
fn number() -> impl Strategy<Value = f32> {
    let grid = (-8_i8..=8).prop_map(|i| f32::from(i) / 4.0);
    prop_oneof![
        4 => grid.clone(),
        1 => grid.clone().prop_map(f32::next_up),
        1 => grid.prop_map(f32::next_down),
        1 => prop_oneof![Just(0.0_f32), Just(-0.0), Just(1e-45), Just(-1e-38), Just(1e-20)],
        3 => -8.0_f32..8.0,
        1 => -1e6_f32..1e6,
    ]
}

fn vector() -> impl Strategy<Value = Vec3> {
    [number(), number(), number()].prop_map(Vec3::from_array)
}

fn domain() -> impl Strategy<Value = Domain> {
    let side = prop_oneof![(1_u8..16).prop_map(|i| f64::from(i) / 4.0), 1e-3..8.0_f64];
    let sides = [side.clone(), side.clone(), side.clone()].prop_map(DVec3::from_array);
    (vector(), sides, proptest::option::of(side)).prop_map(|(min, sides, ball)| {
        let min = min.as_dvec3();
        let domain = Domain::new(min, min + sides).expect("sides are above 0");
        ball.map_or(domain, |radius| domain.with_ball(radius).expect("it is above 0"))
    })
}

fn range() -> impl Strategy<Value = [f64; 2]> {
    let infinite = f64::INFINITY;
    prop_oneof![
        Just([0.0, infinite]),
        Just([-infinite, infinite]),
        (-4.0..4.0_f64, 0.0..4.0_f64).prop_map(|(lo, length)| [lo, lo + length]),
        (-2.0..2.0_f64).prop_map(|t| [t, t]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn clips_are_enclosures(
        domain in domain(),
        origin in vector(),
        direction in vector(),
        range in range(),
        places in [-8.0..8.0_f64, -8.0..8.0, -8.0..8.0],
    ) {
        let ray = Ray::new(origin, direction);
        prop_assume!(ray.is_valid());
        judge(&domain, ray, range, &places);
    }

    #[test]
    fn rays_from_inside_the_domain_are_clipped_there(
        domain in domain(),
        place in [0.0..=1.0_f32, 0.0..=1.0, 0.0..=1.0],
        direction in vector(),
    ) {
        let place = Vec3::from_array(place).as_dvec3();
        let origin = (domain.min + place * (domain.max - domain.min)).as_vec3();
        let ray = Ray::new(origin, direction);
        prop_assume!(ray.is_valid() && holds(&domain, ray, 0.0));
        let clip = domain.clip(ray, [0.0, f64::INFINITY]).expect("the origin is in the domain");
        prop_assert_eq!(clip.outer[0], 0.0);
        judge(&domain, ray, [0.0, f64::INFINITY], &[]);
    }
}

const EVERYTHING: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

fn unit() -> Domain {
    Domain::new(DVec3::splat(-1.0), DVec3::splat(1.0)).expect("a domain")
}

#[test]
fn rays_along_an_axis() {
    let ray = Ray::new(Vec3::new(-3.0, 0.5, 0.25), Vec3::new(2.0, 0.0, -0.0));
    let clip = unit().clip(ray, EVERYTHING).expect("it passes");
    assert!(clip.outer[0] <= 1.0 && 2.0 <= clip.outer[1]);
    assert!(clip.outer[0] > 1.0 - 1e-12 && clip.outer[1] < 2.0 + 1e-12);
    let inner = clip.inner.expect("some of it is certain");
    assert!(1.0 <= inner[0] && inner[1] <= 2.0 && inner[1] - inner[0] > 1.0 - 1e-12);
}

#[test]
fn rays_in_a_face_count_and_those_beside_it_do_not() {
    for z in [-1.0_f32, 1.0] {
        let along = |z: f32| Ray::new(Vec3::new(-3.0, 0.0, z), Vec3::X);
        let clip = unit().clip(along(z), EVERYTHING).expect("a face belongs to the box");
        assert!(clip.inner.is_some());
        let beside = if z < 0.0 { z.next_down() } else { z.next_up() };
        assert_eq!(unit().clip(along(beside), EVERYTHING), None);
    }
}

#[test]
fn a_ray_from_a_face_outward_counts_where_it_starts() {
    let ray = Ray::new(Vec3::X, Vec3::X);
    let clip = unit().clip(ray, [0.0, f64::INFINITY]).expect("its origin is in the box");
    assert!(clip.outer[0] == 0.0 && clip.outer[1] < 1e-300);
}

#[test]
fn a_ray_that_touches_the_ball_or_an_edge_is_not_lost() {
    let ball = unit().with_ball(1.0).expect("a ball");
    let clip = ball.clip(Ray::new(Vec3::new(-3.0, 1.0, 0.0), Vec3::X), EVERYTHING);
    assert!(clip.is_some_and(|c| c.outer[0] <= 3.0 && 3.0 <= c.outer[1]));
    let clip =
        unit().clip(Ray::new(Vec3::new(0.0, 2.0, 0.0), Vec3::new(1.0, -1.0, 0.0)), EVERYTHING);
    assert!(clip.is_some_and(|c| c.outer[0] <= 1.0 && 1.0 <= c.outer[1]));
}

#[test]
fn clips_of_the_ball_are_tight() {
    let ball = unit().with_ball(0.5).expect("a ball");
    let clip =
        ball.clip(Ray::new(Vec3::new(-3.0, 0.3, 0.0), Vec3::X), EVERYTHING).expect("it hits");
    let half = (0.25 - f64::from(0.3_f32).powi(2)).sqrt();
    let inner = clip.inner.expect("most of it is certain");
    for [lo, hi] in [clip.outer, inner] {
        assert!((lo - (3.0 - half)).abs() < 1e-12 && (hi - (3.0 + half)).abs() < 1e-12);
    }
}

#[test]
fn ranges_limit_clips() {
    let ray = Ray::new(Vec3::new(-3.0, 0.0, 0.0), Vec3::X);
    let clip = |lo, hi| unit().clip(ray, [lo, hi]);
    let inner = |lo, hi| clip(lo, hi).and_then(|c| c.inner);
    assert_eq!(inner(2.5, 3.0), Some([2.5, 3.0]));
    assert_eq!(inner(3.0, 3.0), Some([3.0, 3.0]));
    assert_eq!(clip(0.0, 1.0), None);
    assert_eq!(clip(5.0, f64::INFINITY), None);
    assert_eq!(clip(3.0, 2.5), None);
    for range in [[f64::NAN, 3.0], [3.0, f64::NAN]] {
        assert_eq!(unit().clip(ray, range), None);
    }
}

#[test]
fn extreme_rays_and_domains_are_enclosed() {
    let huge = Domain::new(DVec3::splat(-1e300), DVec3::splat(1e300)).expect("a domain");
    let tiny = Domain::new(DVec3::splat(-1e-40), DVec3::splat(1e-40)).expect("a domain");
    for domain in [huge, tiny, huge.with_ball(1e299).expect("a ball")] {
        for d in [1e-45_f32, 1.0, f32::MAX] {
            let ray = Ray::new(Vec3::ZERO, Vec3::new(d, -d, 0.0));
            let clip = domain.clip(ray, EVERYTHING).expect("it starts inside");
            assert!(clip.outer[0] < 0.0 && 0.0 < clip.outer[1]);
        }
    }
    let far = Ray::new(Vec3::new(f32::MAX, 0.0, 0.0), Vec3::new(-1e-45, 0.0, 0.0));
    let clip = unit().clip(far, EVERYTHING).expect("it arrives");
    assert!(clip.outer[0] <= clip.outer[1]);
}
