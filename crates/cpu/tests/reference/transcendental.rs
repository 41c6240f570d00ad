//! Functions that are no polynomials: poles, kinks, jumps, and dense samples in doubles.

use glam::{DVec3, Vec3};
use num_traits::{Signed, Zero};
use zeroset_cpu::{Class, Truth};
use zeroset_raycast::{Ray, RayBatch};

use crate::cast::{Noise, Tally, classify, judge, rays, scene};
use crate::rational::{Poly, clip, exact, fraction};

/// Samples are doubtful below this.
const CLEAR: f64 = 1e-9;

/// Checks that no clear sign change of `f` between samples precedes what was found, and that one
/// surrounds each root that is well conditioned.
fn sample(equation: &str, half: f64, batch: &RayBatch, f: impl Fn(DVec3) -> f64) -> Tally {
    let scene = scene(equation, half);
    let mut tally = Tally::default();
    for (ray, truth) in batch.rays.iter().zip(classify(&scene, batch)) {
        tally.add(truth.class);
        let says = format!("{equation}: {ray:?} {truth:?}");
        let Some(clip) = scene.domain.clip(*ray, batch.range) else { continue };
        let Some(inner) = clip.inner else { continue };
        let end = truth.bracket[0].min(inner[1]);
        let length = inner[1] - inner[0];
        let mut last = 0.0;
        for i in 0..=1000 {
            let t = inner[0] + length * f64::from(i) / 1000.0;
            if t >= end {
                break;
            }
            let value = f(ray.at(t));
            if value.abs() > CLEAR {
                assert!(last * value >= 0.0, "{says}: changes sign before {t}");
                last = value;
            }
        }
        if truth.class == Class::Transversal {
            let around = |sign: f64| f(ray.at(truth.bracket[0] + sign * 1e-6 * length));
            let (before, after) = (around(-1.0), around(1.0));
            if before.abs() > CLEAR && after.abs() > CLEAR {
                assert!(before * after < 0.0, "{says}");
            }
        }
    }
    println!("{equation}: {tally:?}");
    tally
}

fn assert_decided(tally: &Tally, count: usize) {
    assert!(100 * tally.undecidable <= count, "{tally:?}");
    assert!(tally.transversal > count / 10, "{tally:?}");
}

#[test]
fn waves() {
    let equation = "x^2+y^2+z^2+sin(4*x)-cos(4*y)+sin(4*z)-1";
    let batch = RayBatch::new(rays(&mut Noise(11), 2.25, 400));
    let tally = sample(equation, 2.25, &batch, |p| {
        let q = 4.0 * p;
        p.length_squared() + q.x.sin() - q.y.cos() + q.z.sin() - 1.0
    });
    assert_decided(&tally, 400);
}

#[test]
fn diamond() {
    let equation =
        "sin(x)*sin(y)*sin(z)+sin(x)*cos(y)*cos(z)+cos(x)*sin(y)*cos(z)+cos(x)*cos(y)*sin(z)";
    let batch = RayBatch::new(rays(&mut Noise(12), 5.0, 200));
    let tally = sample(equation, 5.0, &batch, |p| {
        let [sx, sy, sz] = p.to_array().map(f64::sin);
        let [cx, cy, cz] = p.to_array().map(f64::cos);
        sx * sy * sz + sx * cy * cz + cx * sy * cz + cx * cy * sz
    });
    assert_decided(&tally, 200);
}

#[test]
fn blobs() {
    let equation = "exp(1-4*(x^2+y^2+z^2))+exp(1-8*((x-1)^2+y^2+z^2))+exp(1-8*(x^2+(y-1)^2+z^2))-1";
    let batch = RayBatch::new(rays(&mut Noise(13), 1.5, 300));
    let tally = sample(equation, 1.5, &batch, |p| {
        let blob = |k: f64, c: DVec3| (1.0 - k * (p - c).length_squared()).exp();
        blob(4.0, DVec3::ZERO) + blob(8.0, DVec3::X) + blob(8.0, DVec3::Y) - 1.0
    });
    assert_decided(&tally, 300);
}

#[test]
fn superquadrics() {
    for m in [0.75, 2.5] {
        let equation = format!("abs(x)^m+abs(y)^m+abs(z)^m-1; m = {m}");
        let batch = RayBatch::new(rays(&mut Noise(14), 1.125, 200));
        let tally = sample(&equation, 1.125, &batch, |p| {
            p.abs().to_array().map(|v| v.powf(m)).iter().sum::<f64>() - 1.0
        });
        assert_decided(&tally, 200);
    }
}

#[test]
fn a_pole_is_no_root() {
    // Wherever 1/(x - y^2) is defined, the equation is that of 1 - z (x - y^2).
    let batch = RayBatch::new(rays(&mut Noise(15), 2.0, 500));
    let tally = judge("1/(x-y^2)-z", 2.0, &batch, |[x, y, z]| {
        &Poly::integer(1) - &(&z * &(&x - &y.pow(2)))
    });
    assert_decided(&tally, 500);
    // Straight through the pole at x = 0, where 1/x changes sign, with no root anywhere.
    let through = RayBatch::new(vec![Ray::new(Vec3::new(-1.5, 0.0, 0.0), Vec3::X)]);
    for equation in ["1/x", "1/x^3", "tan(x+pi/2)/(x^2+1)", "1/(x*(1+y^2))"] {
        let truth = classify(&scene(equation, 1.0), &through)[0];
        assert_eq!(truth.class, Class::None, "{equation} {truth:?}");
    }
}

#[test]
fn jumps_are_no_roots() {
    // Each changes sign at a jump and is nowhere 0.
    let ray = Ray::new(Vec3::new(-0.75, 0.0, 0.0), Vec3::X);
    let batch =
        RayBatch::new(vec![ray, Ray::new(Vec3::new(-0.7, 0.1, 0.2), Vec3::new(0.3, 0.1, 0.0))]);
    for equation in [
        "floor(x)+1/2",
        "ceil(x)-1/2",
        "sign(x)-1/2",
        "mod(x,1)-x-1/2",
        "atan2(x,-1)",
        "x-2*floor(x+1)+7/8",
        "x+2*floor(x+1)-7/8",
    ] {
        for truth in classify(&scene(equation, 0.875), &batch) {
            assert!(
                !truth.certificate().contains(zeroset_raycast::Certificate::ROOT),
                "{equation} {truth:?}"
            );
            assert!(truth.class == Class::None || truth.bracket[0] <= 2.5, "{equation} {truth:?}");
        }
    }
    // Between jumps, and before one that a smooth continuation would not see, are honest roots.
    for (equation, root) in
        [("floor(4*x)/4-2*x+1/3", 0.75 + 1.0 / 6.0), ("x+1/2+2*floor(x+1)", 0.25)]
    {
        let truth = classify(&scene(equation, 1.0), &batch)[0];
        assert_eq!(truth.class, Class::Transversal, "{equation} {truth:?}");
        assert!((truth.bracket[0] - root).abs() < 1e-11, "{equation} {truth:?}");
    }
}

#[test]
fn undefined_parts_are_no_roots() {
    // sqrt(x) is undefined for x < 0, log(x) for x <= 0; where defined, each has one simple root.
    let batch = RayBatch::new(vec![Ray::new(Vec3::new(-0.75, 0.0, 0.0), Vec3::X)]);
    for (equation, root) in [("sqrt(x)-1/2", 1.0), ("log(x)+log(2)", 1.25)] {
        let truth = classify(&scene(equation, 0.875), &batch)[0];
        let [lo, hi] = truth.bracket;
        assert_eq!(truth.class, Class::Transversal, "{equation} {truth:?}");
        assert!(lo <= root + 1e-12 && root - 1e-12 <= hi, "{equation} {truth:?}");
    }
    // At the rim of its domain, x = 0, the first root of this cannot be bracketed.
    let truth = classify(&scene("sqrt(x)*(x-1/2)", 0.875), &batch)[0];
    assert!(truth.bracket[0] <= 0.75 && truth.class == Class::Undecidable, "{truth:?}");
    // Nowhere defined.
    let truth = classify(&scene("sqrt(x-2)+x", 1.0), &batch)[0];
    assert_eq!(truth.class, Class::None, "{truth:?}");
}

#[test]
fn a_square_root_of_a_torus() {
    let batch = RayBatch::new(rays(&mut Noise(16), 1.75, 400));
    let algebraic = "(x^2+y^2+z^2+3/4)^2-4*(x^2+y^2)";
    let exact = classify(&scene(algebraic, 1.75), &batch);
    let rooted = classify(&scene("(1-sqrt(x^2+y^2))^2+z^2-1/4", 1.75), &batch);
    let mut undecided = 0;
    for ((a, b), ray) in exact.iter().zip(&rooted).zip(&batch.rays) {
        let says = format!("{ray:?} {a:?} {b:?}");
        if b.class == Class::Undecidable {
            undecided += 1;
            assert!(b.bracket[0] <= a.bracket[1], "{says}");
        } else {
            let hit = |t: &Truth| t.class != Class::None;
            assert_eq!(hit(a), hit(b), "{says}");
            assert!(b.bracket[0] <= a.bracket[1] && a.bracket[0] <= b.bracket[1], "{says}");
        }
    }
    assert!(undecided <= 8, "{undecided}");
}

/// The first root of `|x| + |y| - |z|` on a ray, piece by piece between its kinks.
#[test]
fn kinks() {
    let scene = scene("abs(x)+abs(y)-abs(z)", 1.0);
    let batch = RayBatch::new(rays(&mut Noise(17), 1.0, 500));
    let mut undecided = 0;
    for (ray, truth) in batch.rays.iter().zip(classify(&scene, &batch)) {
        let says = format!("{ray:?} {truth:?}");
        let Some([lo, hi]) = clip(&scene.domain, *ray, batch.range) else { continue };
        let [x, y, z] = Poly::ray(*ray);
        let value = |t| x.at(t).abs() + y.at(t).abs() - z.at(t).abs();
        let mut breaks = vec![lo.clone(), hi.clone()];
        for axis in [&x, &y, &z] {
            if let [o, d] = &axis.0[..] {
                let t = -o / d;
                if lo < t && t < hi {
                    breaks.push(t);
                }
            }
        }
        breaks.sort();
        let mut first = breaks.iter().find(|t| value(t).is_zero()).cloned();
        for pair in breaks.windows(2) {
            let (u, v) = (value(&pair[0]), value(&pair[1]));
            if (&u * &v).is_negative() {
                let t = &pair[0] + (&pair[1] - &pair[0]) * &u / (&u - &v);
                first = Some(first.map_or(t.clone(), |f| f.min(t)));
            }
        }
        match (first, truth.class) {
            (_, Class::None) if breaks.is_empty() => {}
            (None, class) => {
                assert!(matches!(class, Class::None | Class::Undecidable), "{says}");
            }
            (Some(t), class) => {
                assert_ne!(class, Class::None, "{says}");
                let [l, h] = truth.bracket.map(exact);
                assert!(l <= t, "{says} {t}");
                assert!(class == Class::Undecidable || t <= h, "{says} {t}");
            }
        }
        undecided += usize::from(truth.class == Class::Undecidable);
    }
    println!("kinks: {undecided} undecided");
    // Many rays on quarters touch the cone's edges or its apex.
    assert!(undecided <= 100, "{undecided}");
    assert_eq!(fraction(1, 2), exact(0.5));
}
