//! Closed forms in exact arithmetic: plane, sphere, quadric, torus.

use glam::Vec3;
use num_traits::{Signed, Zero};
use zeroset_cpu::{Class, Truth};
use zeroset_raycast::{Ray, RayBatch};

use crate::cast::{Noise, classify, judge, rays, scene};
use crate::rational::{Poly, Q, clip, exact, fraction};

fn vector(v: Vec3) -> [Q; 3] {
    v.to_array().map(|x| exact(f64::from(x)))
}

fn dot(a: &[Q; 3], b: &[Q; 3]) -> Q {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// Is t = (-b - sqrt(d)) / a, or with + for the second root, at least `t`? For a > 0, d >= 0.
fn is_root_at_least(a: &Q, b: &Q, d: &Q, second: bool, t: &Q) -> bool {
    // -+sqrt(d) >= a t + b
    let side = a * t + b;
    if second {
        !side.is_positive() || &side * &side <= *d
    } else {
        !side.is_positive() && &side * &side >= *d
    }
}

/// The truth for `a t^2 + 2 b t + c = 0` by its discriminant.
fn assert_quadratic([a, b, c]: [Q; 3], [lo, hi]: [Q; 2], truth: &Truth, says: &str) {
    assert!(a.is_positive());
    let d = &b * &b - &a * &c;
    let at_least = |second, t: &Q| is_root_at_least(&a, &b, &d, second, t);
    let at_most = |second, t: &Q| {
        // A root that is at least t and not more is t.
        !at_least(second, t) || (&a * t * t + (&b + &b) * t + &c).is_zero()
    };
    let inside = |second: bool| at_least(second, &lo) && at_most(second, &hi);
    let first = match d.is_negative() {
        true => None,
        false => [false, true].into_iter().find(|&second| inside(second)),
    };
    match (first, truth.class) {
        (None, class) => assert_eq!(class, Class::None, "{says}"),
        (Some(second), class) => {
            let [l, h] = truth.bracket.map(exact);
            assert!(at_least(second, &l) && at_most(second, &h), "{says}");
            let expected = if d.is_zero() { Class::Tangential } else { Class::Transversal };
            // Two roots between neighbouring doubles cannot be told apart.
            let close = d.is_positive() && !second && at_most(true, &h);
            assert!(class == expected || close && class == Class::Tangential, "{says}");
        }
    }
}

/// Rays that pass a unit sphere at distance 1 -+ 10^-k.
fn grazing() -> Vec<Ray> {
    let mut rays = Vec::new();
    for k in 1..8 {
        let gap = 10.0_f32.powi(-k);
        for offset in [1.0 - gap, 1.0 + gap, -1.0 + gap, -1.0 - gap] {
            rays.push(Ray::new(Vec3::new(-3.0, offset, 0.0), Vec3::X));
            rays.push(Ray::new(Vec3::new(0.5, 3.0, offset), Vec3::new(0.0, -2.0, 0.0)));
            rays.push(Ray::new(Vec3::new(offset, 0.0, 2e4), Vec3::NEG_Z));
        }
    }
    for offset in [1.0, 1.0_f32.next_up(), 1.0_f32.next_down()] {
        rays.push(Ray::new(Vec3::new(-3.0, offset, 0.0), Vec3::X));
        rays.push(Ray::new(Vec3::new(-3.0, 0.0, offset), Vec3::new(0.3, 0.0, 0.0)));
        rays.push(Ray::new(Vec3::new(offset, 0.0, 0.0), Vec3::X));
        rays.push(Ray::new(Vec3::new(offset, 0.0, 0.0), Vec3::NEG_X));
        rays.push(Ray::new(Vec3::new(offset, 0.0, 0.0), Vec3::Y));
    }
    rays
}

#[test]
fn sphere() {
    let mut batch = RayBatch::new(rays(&mut Noise(1), 1.5, 2000));
    batch.rays.extend(grazing());
    let scene = scene("x^2+y^2+z^2-1", 1.5);
    for (ray, truth) in batch.rays.iter().zip(classify(&scene, &batch)) {
        let says = format!("{ray:?} {truth:?}");
        let Some(range) = clip(&scene.domain, *ray, batch.range) else {
            assert_eq!(truth.class, Class::None, "{says}");
            continue;
        };
        let (o, d) = (vector(ray.origin), vector(ray.direction));
        let quadratic = [dot(&d, &d), dot(&o, &d), dot(&o, &o) - fraction(1, 1)];
        assert_quadratic(quadratic, range, &truth, &says);
    }
}

#[test]
fn ellipsoid() {
    // 4 (x - 1/4)^2 + y^2 + 9 z^2 = 1
    let scene = scene("4*(x-0.25)^2+y^2+9*z^2=1", 1.25);
    let batch = RayBatch::new(rays(&mut Noise(2), 1.25, 1000));
    for (ray, truth) in batch.rays.iter().zip(classify(&scene, &batch)) {
        let says = format!("{ray:?} {truth:?}");
        let Some(range) = clip(&scene.domain, *ray, batch.range) else { continue };
        let (mut o, d) = (vector(ray.origin), vector(ray.direction));
        o[0] -= fraction(1, 4);
        let stretch = |v: &[Q; 3]| [&v[0] * fraction(4, 1), v[1].clone(), &v[2] * fraction(9, 1)];
        let (eo, ed) = (stretch(&o), stretch(&d));
        let quadratic = [dot(&ed, &d), dot(&ed, &o), dot(&eo, &o) - fraction(1, 1)];
        assert_quadratic(quadratic, range, &truth, &says);
    }
}

#[test]
fn plane() {
    let scene = scene("x/2-2*y+z-1/8", 1.0);
    let batch = RayBatch::new(rays(&mut Noise(3), 1.0, 1000));
    let normal = [fraction(1, 2), fraction(-2, 1), fraction(1, 1)];
    for (ray, truth) in batch.rays.iter().zip(classify(&scene, &batch)) {
        let says = format!("{ray:?} {truth:?}");
        let Some([lo, hi]) = clip(&scene.domain, *ray, batch.range) else { continue };
        let height = dot(&normal, &vector(ray.origin)) - fraction(1, 8);
        let slope = dot(&normal, &vector(ray.direction));
        if slope.is_zero() {
            let expected = if height.is_zero() { Class::Tangential } else { Class::None };
            assert_eq!(truth.class, expected, "{says}");
            continue;
        }
        let t = -height / slope;
        if t < lo || t > hi {
            assert_eq!(truth.class, Class::None, "{says}");
        } else {
            assert_eq!(truth.class, Class::Transversal, "{says}");
            let [l, h] = truth.bracket.map(exact);
            assert!(l <= t && t <= h, "{says}");
        }
    }
}

#[test]
fn plane_in_a_ball() {
    let mut scene = scene("x-1/2", 1.0);
    scene.domain.ball = Some(0.75);
    let mut batch = RayBatch::new(rays(&mut Noise(5), 1.0, 1000));
    // Through the rim, where the plane leaves the ball: x = 1/2, y^2 + z^2 = 5/16.
    let rim = |y: f32| Ray::new(Vec3::new(-0.5, y, 0.25), Vec3::X);
    batch.rays.extend([rim(0.5), rim(0.5_f32.next_up()), rim(0.5_f32.next_down())]);
    let mut hits = 0;
    for (ray, truth) in batch.rays.iter().zip(classify(&scene, &batch)) {
        let says = format!("{ray:?} {truth:?}");
        let (o, d) = (vector(ray.origin), vector(ray.direction));
        if d[0].is_zero() {
            continue;
        }
        let t = (fraction(1, 2) - &o[0]) / &d[0];
        let p = [0, 1, 2].map(|i| &o[i] + &d[i] * &t);
        let outside = dot(&p, &p) - fraction(9, 16);
        let counts = !t.is_negative() && !outside.is_positive();
        let near = outside.abs() < exact(1e-10);
        match truth.class {
            Class::None => assert!(!counts, "{says}"),
            Class::Undecidable => assert!(near && exact(truth.bracket[0]) <= t, "{says}"),
            _ => {
                let [l, h] = truth.bracket.map(exact);
                assert!(counts && l <= t && t <= h, "{says}");
                hits += 1;
            }
        }
    }
    assert!(hits > 50, "{hits}");
}

/// The torus with radii 1 and 1/2 about z, as a quartic in t with textbook coefficients.
fn torus([x, y, z]: [Poly; 3]) -> Poly {
    let part = |p: &Poly, i: usize| p.0.get(i).cloned().unwrap_or_else(Q::zero);
    let [o, d] = [0, 1].map(|i| [part(&x, i), part(&y, i), part(&z, i)]);
    let (dd, od, oo) = (dot(&d, &d), dot(&o, &d), dot(&o, &o));
    // |p|^2 + R^2 - r^2 = dd t^2 + 2 od t + k, less 4 R^2 (x^2 + y^2).
    let k = oo + fraction(3, 4);
    let (two, four) = (fraction(2, 1), fraction(4, 1));
    let flat = |a: &[Q; 3], b: &[Q; 3]| &a[0] * &b[0] + &a[1] * &b[1];
    let coefficients = [
        &k * &k - &four * flat(&o, &o),
        &four * &od * &k - &four * &two * flat(&o, &d),
        &two * &dd * &k + &four * &od * &od - &four * flat(&d, &d),
        &four * &dd * &od,
        &dd * &dd,
    ];
    let mut terms = coefficients.to_vec();
    while terms.last().is_some_and(Zero::is_zero) {
        terms.pop();
    }
    Poly(terms)
}

#[test]
fn torus_as_a_quartic() {
    let equation = "(x^2+y^2+z^2+R^2-r^2)^2-4*R^2*(x^2+y^2); R = 1; r = 0.5";
    let mut batch = RayBatch::new(rays(&mut Noise(4), 1.75, 800));
    // Along the top, where a whole circle is touched, and along the waist.
    for k in 1..7 {
        for gap in [10.0_f32.powi(-k), -(10.0_f32.powi(-k)), 0.0] {
            batch.rays.push(Ray::new(Vec3::new(-3.0, 0.25, 0.5 + gap), Vec3::X));
            batch.rays.push(Ray::new(Vec3::new(1.5 + gap, -3.0, 0.0), Vec3::Y));
            batch.rays.push(Ray::new(Vec3::new(0.5 + gap, -3.0, 0.0), Vec3::Y));
            batch.rays.push(Ray::new(Vec3::new(0.5 + gap, 0.0, 3.0), Vec3::NEG_Z));
        }
    }
    let tally = judge(equation, 1.75, &batch, torus);
    assert_eq!(tally.undecidable, 0, "{tally:?}");
    assert!(tally.tangential >= 10, "{tally:?}");
}
