//! Hits are those of the reference, whatever the quadric, the bound, the distance and the place of the eye,
//! where the discriminant is not so small that rounding decides.

use glam::{DMat3, DVec3, Vec3};
use zeroset_cpu::Class;
use zeroset_quadric::{Formula, Precision, QuadricReference, Quadrics};
use zeroset_raycast::{
    Blending, Bound, Hits, Method, Patch, Patches, Progress, Quadric, Ray, RayBatch, Rays, Request,
    Scene, Sides,
};

/// Numbers without pattern from 0 to 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn signed(&mut self) -> f64 {
        2.0 * self.next() - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    fn unit(&mut self) -> DVec3 {
        loop {
            let v = self.vector();
            if (0.01..1.0).contains(&v.length()) {
                return v.normalize();
            }
        }
    }
}

/// A quadric of that rank through a point near the origin, its outside on a random side.
fn quadric(numbers: &mut Numbers, rank: usize) -> Quadric {
    let mut axes = numbers.vector();
    for axis in rank..3 {
        axes[axis] = 0.0;
    }
    let turn = DMat3::from_rotation_x(3.0 * numbers.next())
        * DMat3::from_rotation_y(3.0 * numbers.next())
        * DMat3::from_rotation_z(3.0 * numbers.next());
    let a = turn * DMat3::from_diagonal(axes) * turn.transpose();
    let b = numbers.vector();
    Quadric { a: 0.5 * (a + a.transpose()), b, c: 0.0 }.about(-0.3 * numbers.vector())
}

fn bound(numbers: &mut Numbers) -> Bound {
    if numbers.next() < 0.5 {
        return Bound::Ball { centre: 0.2 * numbers.vector(), radius: 1.0 };
    }
    loop {
        let corners = [0; 4].map(|_| 1.5 * numbers.vector());
        let sides = [1, 2, 3].map(|i| corners[i] - corners[0]);
        if DMat3::from_cols(sides[0], sides[1], sides[2]).determinant().abs() > 0.3 {
            return Bound::Tetrahedron(corners);
        }
    }
}

fn rays(numbers: &mut Numbers, at: DVec3, distance: f64, count: usize) -> RayBatch {
    let one = |numbers: &mut Numbers| {
        let eye = (at + distance * numbers.unit()).as_vec3();
        let target = at + numbers.vector();
        Ray::new(eye, (target - eye.as_dvec3()).normalize().as_vec3())
    };
    RayBatch::new((0..count).map(|_| one(numbers)).collect())
}

/// Answers that differ from the truth, of those that are decided.
#[derive(Debug, Default)]
struct Count {
    decided: usize,
    hits: usize,
    /// Hits and misses that are none.
    wrong: usize,
    /// The greatest distance of a hit from its root.
    error: f64,
}

fn count(method: &Quadrics, patch: &Patch, sides: Sides, rays: &RayBatch, count: &mut Count) {
    let patches = Patches::new(vec![*patch], sides, Blending::None).expect("it is a patch");
    let scene = Scene::of_patches("one", patches);
    let oracle = QuadricReference.prepare_reference(&scene).expect("patches");
    let indices: Vec<usize> = (0..rays.rays.len()).collect();
    let rays = Rays::Batch(rays);
    let truths = oracle.classify(rays, &indices, &Progress::new()).expect("truths");
    let mut hits = Hits::new(Request::First, rays.len());
    let intersector = method.prepare(&scene).expect("patches");
    intersector.intersect(rays, &mut hits, &Progress::new()).expect("answers");
    for (i, truth) in truths.iter().enumerate() {
        if [Class::Undecidable, Class::Tangential].contains(&truth.class) {
            continue;
        }
        count.decided += 1;
        let (hit, is_root) = (hits.get(i), truth.class == Class::Transversal);
        count.wrong += usize::from(hit.certificate.is_hit() != is_root);
        if hit.certificate.is_hit() && is_root {
            count.hits += 1;
            count.error = count.error.max((hit.t() - truth.bracket[0]).abs());
        }
    }
}

fn all(method: &Quadrics, distance: f64, rounds: usize) -> Count {
    let mut numbers = Numbers(7);
    let mut total = Count::default();
    for round in 0..rounds {
        let origin = 3.0 * numbers.vector();
        let (quadric, bound) = (quadric(&mut numbers, round % 4), bound(&mut numbers));
        let patch = Patch { origin, quadric, bound, clip: None };
        let rays = rays(&mut numbers, origin, distance, 200);
        let sides = if round % 2 == 0 { Sides::Front } else { Sides::Both };
        count(method, &patch, sides, &rays, &mut total);
    }
    total
}

#[test]
fn double_precision_finds_what_is_there_at_any_distance() {
    for distance in [0.1, 1.0, 30.0, 1e3, 1e6] {
        let counted = all(&Quadrics::incremental(), distance, 200);
        println!("{distance}: {counted:?}");
        assert!(counted.hits > 1000 && counted.decided > 35_000, "{distance}: {counted:?}");
        // A ray at 1e6 is known to 1e-10 there.
        assert!(counted.wrong <= 2, "{distance}: {counted:?}");
        assert!(counted.error < 1e-5, "{distance}: {counted:?}");
    }
}

#[test]
fn single_precision_keeps_what_the_papers_formulas_lose() {
    let method = |formula| Quadrics { formula, precision: Precision::Single, ..Quadrics::brute() };
    for distance in [30.0, 1e3, 1e5] {
        let is_far = distance > 100.0;
        let [local, quotient, reciprocal] =
            [Formula::Local, Formula::Quotient, Formula::Reciprocal]
                .map(|formula| all(&method(formula), distance, 100));
        println!("{distance}: {local:?} {quotient:?} {reciprocal:?}");
        assert!(500 * local.wrong < local.decided, "{distance}: {local:?}");
        for paper in [quotient, reciprocal] {
            assert!(paper.error > 1e3 * local.error, "{distance}: {paper:?} {local:?}");
            assert!(!is_far || paper.wrong > 3 * local.wrong, "{distance}: {paper:?} {local:?}");
        }
    }
}

#[test]
fn alpha_may_vanish() {
    // A paraboloid seen nearly along its axis: alpha is the square of the ray's slope.
    let quadric = Quadric {
        a: DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0)),
        b: DVec3::new(0.0, 0.0, 0.5),
        c: 0.0,
    };
    let bound = Bound::Ball { centre: DVec3::ZERO, radius: 1.0 };
    let patch = Patch { origin: DVec3::ZERO, quadric, bound, clip: None };
    for exponent in 0..=8 {
        let slope = 10.0_f32.powi(-exponent);
        let rays = (0..100).map(|i| {
            let x = -0.5 + 0.01 * i as f32;
            Ray::new(Vec3::new(x - 3.0 * slope, 0.1, 3.0), Vec3::new(slope, 0.0, -1.0))
        });
        let mut counted = Count::default();
        let rays = RayBatch::new(rays.collect());
        let single = Quadrics { precision: Precision::Single, ..Quadrics::incremental() };
        count(&single, &patch, Sides::Front, &rays, &mut counted);
        assert!(counted.hits > 40 && counted.wrong <= 1, "{slope}: {counted:?}");
        assert!(counted.error < 1e-5, "{slope}: {counted:?}");
    }
}

#[test]
fn what_lies_behind_the_eye_is_seen_from_behind() {
    // From z = 0 to negative t the ray comes to the far side of the sphere at -5 first.
    let quadric = Quadric { a: DMat3::IDENTITY, b: DVec3::ZERO, c: -1.0 };
    let far = DVec3::new(0.0, 0.0, -6.0);
    let bound = Bound::Ball { centre: DVec3::ZERO, radius: 0.2 };
    let quadric = quadric.about(far - DVec3::new(0.0, 0.0, -5.0));
    let patch = Patch { origin: far, quadric, bound, clip: None };
    let rays = RayBatch { rays: vec![Ray::new(Vec3::ZERO, Vec3::Z)], range: [-10.0, 10.0] };
    for method in [Quadrics::incremental(), Quadrics::brute()] {
        let mut counted = Count::default();
        count(&method, &patch, Sides::Front, &rays, &mut counted);
        assert_eq!((counted.decided, counted.hits, counted.wrong), (1, 1, 0), "{method:?}");
    }
}

#[test]
fn patches_are_found_whose_places_cancel() {
    let plane = Quadric { a: DMat3::ZERO, b: DVec3::new(0.0, 0.0, 0.5), c: 0.0 };
    let bound = Bound::Ball { centre: DVec3::new(-1e12, 0.0, 0.0), radius: 1e-5 };
    let patch = Patch { origin: DVec3::new(1e12, 0.0, 0.0), quadric: plane, bound, clip: None };
    let rays = (-4..=4).map(|i| Ray::new(Vec3::new(2e-6 * i as f32, 0.0, 1.0), Vec3::NEG_Z));
    let mut counted = Count::default();
    let rays = RayBatch::new(rays.collect());
    count(&Quadrics::incremental(), &patch, Sides::Front, &rays, &mut counted);
    assert_eq!((counted.hits, counted.wrong), (9, 0), "{counted:?}");
}

#[test]
fn normals_of_misses_are_zero_whatever_was_there() {
    let quadric = Quadric { a: DMat3::IDENTITY, b: DVec3::ZERO, c: -1.0 };
    let bound = Bound::Ball { centre: DVec3::ZERO, radius: 2.0 };
    let patch = Patch { origin: DVec3::ZERO, quadric, bound, clip: None };
    let patches = Patches::new(vec![patch], Sides::Front, Blending::None).expect("it is a patch");
    let scene = Scene::of_patches("one", patches);
    let methods: [&dyn Method; 2] = [&Quadrics::incremental(), &QuadricReference];
    for method in methods {
        let intersector = method.prepare(&scene).expect("patches");
        let mut hits = Hits::new(Request::FirstWithNormal, 1);
        for (x, normal) in [(0.0, Vec3::NEG_Z), (5.0, Vec3::ZERO)] {
            let rays = RayBatch::new(vec![Ray::new(Vec3::new(x, 0.0, -3.0), Vec3::Z)]);
            let answered = intersector.intersect(Rays::Batch(&rays), &mut hits, &Progress::new());
            answered.expect("answers");
            assert_eq!(hits.normal[0], normal, "{}", method.id());
        }
    }
}

#[test]
fn scenes_of_any_size_are_cast() {
    for scale in [1e-30, 1e-12, 1e12, 1e30] {
        let quadric = Quadric { a: DMat3::IDENTITY, b: DVec3::ZERO, c: -scale * scale };
        let bound = Bound::Ball { centre: DVec3::ZERO, radius: 2.0 * scale };
        let patch = Patch { origin: DVec3::ZERO, quadric, bound, clip: None };
        let single = Quadrics { precision: Precision::Single, ..Quadrics::incremental() };
        for method in [Quadrics::incremental(), single] {
            let ray = |x: f64| {
                Ray::new((scale * DVec3::new(x, 0.2, -3.0)).as_vec3(), Vec3::new(0.0, 0.0, 0.7))
            };
            let rays = RayBatch::new([0.0, 0.5, 0.9, 1.1].map(ray).to_vec());
            let mut counted = Count::default();
            count(&method, &patch, Sides::Front, &rays, &mut counted);
            assert_eq!((counted.hits, counted.wrong), (3, 0), "{scale} {method:?}: {counted:?}");
        }
    }
}
