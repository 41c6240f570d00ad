//! What every method owes its caller.

use glam::Vec3;
use zeroset_cpu::{Class, Reference};
use zeroset_expr::Parameters;
use zeroset_raycast::{
    Camera, Certificate, Error, Hits, Method, Progress, Ray, RayBatch, Rays, Request, View,
};

use crate::cast::{Noise, classify, judge, rays, scene};
use crate::rational::Poly;

#[test]
fn answers_do_not_depend_on_company() {
    let scene = scene("x^2+y^2+sin(3*z)-1/2", 1.5);
    let mut batch = RayBatch::new(rays(&mut Noise(21), 1.5, 200));
    batch.rays.push(Ray::new(Vec3::NAN, Vec3::X));
    batch.rays.push(Ray::new(Vec3::ZERO, Vec3::ZERO));
    let all = classify(&scene, &batch);
    let prepared = Reference::default().prepare_reference(&scene).unwrap();
    let backwards: Vec<usize> = (0..batch.rays.len()).rev().step_by(3).collect();
    let some = prepared.classify(Rays::Batch(&batch), &backwards, &Progress::new()).unwrap();
    for (i, truth) in backwards.into_iter().zip(some) {
        assert_eq!(truth, all[i]);
    }
    let mut hits = Hits::new(Request::First, batch.rays.len());
    let report = Reference::default()
        .prepare(&scene)
        .unwrap()
        .intersect(Rays::Batch(&batch), &mut hits, &Progress::new())
        .unwrap();
    for (i, truth) in all.iter().enumerate() {
        let hit = hits.get(i);
        if batch.rays[i].is_valid() {
            assert_eq!(hit.certificate, truth.certificate());
            assert_eq!(hit.bracket, truth.bracket);
            assert_eq!(hit.work, truth.work);
        } else {
            assert_eq!(hit.certificate, Certificate::MISS);
            assert_eq!(truth.class, Class::Undecidable);
        }
    }
    assert!(report.work.intervals > 200);
    assert_eq!(report.work.nonfinite, 2);
}

#[test]
fn any_root_will_do_for_a_shadow() {
    let scene = scene("x^2+y^2+sin(3*z)-1/2", 1.5);
    let batch = RayBatch::new(rays(&mut Noise(22), 1.5, 300));
    let first = classify(&scene, &batch);
    let mut hits = Hits::new(Request::Any, batch.rays.len());
    let prepared = Reference::default().prepare_reference(&scene).unwrap();
    let cast = |hits: &mut Hits| {
        zeroset_raycast::Intersector::intersect(
            &prepared,
            Rays::Batch(&batch),
            hits,
            &Progress::new(),
        )
    };
    let cheap = cast(&mut hits).unwrap().work.intervals;
    let mut dear = 0;
    for (i, truth) in first.iter().enumerate() {
        dear += truth.work.intervals;
        let hit = hits.get(i);
        assert_eq!(hit.certificate.is_hit(), truth.class != Class::None, "{truth:?} {hit:?}");
        if truth.class == Class::Transversal {
            assert!(hit.certificate.contains(Certificate::ROOT), "{truth:?} {hit:?}");
            assert!(hit.bracket[0] <= truth.bracket[1] && truth.bracket[0] <= hit.bracket[1]);
        }
    }
    assert!(cheap < dear, "{cheap} {dear}");
}

#[test]
fn views_have_unit_normals() {
    let scene = scene("x^2+y^2+z^2-1", 1.25);
    let view = View::new(Camera::facing(&scene.domain), 32, 24);
    let mut hits = Hits::new(Request::FirstWithNormal, 32 * 24);
    let prepared = Reference::default().prepare(&scene).unwrap();
    let progress = Progress::new();
    prepared.intersect(Rays::View(&view), &mut hits, &progress).unwrap();
    assert_eq!(progress.done(), 32 * 24);
    let mut found = 0;
    for i in 0..hits.len() {
        if hits.certificate[i] == Certificate::PROVEN_HIT {
            found += 1;
            let p = view.ray(i % 32, i / 32).at(hits.get(i).t());
            assert!((hits.normal[i].as_dvec3() - p).length() < 1e-6);
        } else {
            assert_eq!(hits.normal[i], Vec3::ZERO);
        }
    }
    assert!(found > 60, "{found}");
}

#[test]
fn parameters_change_without_preparing() {
    let scene = scene("x^2+y^2+z^2-r^2; r = 1", 1.25);
    let batch = RayBatch::new(vec![Ray::new(Vec3::new(-2.0, 0.0, 0.0), Vec3::X)]);
    let mut prepared = Reference::default().prepare(&scene).unwrap();
    let mut at = |r: &str| {
        let mut values = Parameters::default();
        values.set("r", r);
        prepared.set_parameters(&values).unwrap();
        let mut hits = Hits::new(Request::First, 1);
        prepared.intersect(Rays::Batch(&batch), &mut hits, &Progress::new()).unwrap();
        hits.bracket[0]
    };
    for (r, t) in [("0.5", 1.5), ("1", 1.0), ("sqrt(1/4)", 1.5)] {
        let [lo, hi] = at(r);
        assert!(lo <= t && t <= hi && hi - lo <= 1e-12);
    }
    let mut wrong = Parameters::default();
    wrong.set("radius", "1");
    assert!(matches!(prepared.set_parameters(&wrong), Err(Error::Parameter(_))));
}

#[test]
fn work_stops_when_asked() {
    let scene = scene("x^2+y^2+z^2-1", 1.25);
    let batch = RayBatch::new(rays(&mut Noise(23), 1.25, 10));
    let prepared = Reference::default().prepare_reference(&scene).unwrap();
    let progress = Progress::new();
    progress.stop();
    let answer = prepared.classify(Rays::Batch(&batch), &[0, 1], &progress);
    assert_eq!(answer, Err(Error::Interrupted));
}

#[test]
fn knobs_are_set_by_name() {
    let mut method = Reference::default();
    for knob in method.knobs() {
        method.set(knob.name, &knob.value).unwrap();
    }
    assert_eq!(method, Reference::default());
    method.set("bits", "53").unwrap();
    method.for_precision(1e-6, &scene("x", 1.0));
    assert_eq!((method.bits, method.width), (53, 1e-6));
    for (knob, value) in [("bits", "12"), ("width", "nan"), ("budget", "0"), ("depth", "3")] {
        assert!(method.set(knob, value).is_err(), "{knob}={value}");
    }
}

#[test]
fn less_precision_says_less_and_stays_true() {
    let scene = scene("(x^2+y^2+z^2-1)*(x^2+y^2+z^2-1-1/68719476736)", 1.5);
    let batch = RayBatch::new(rays(&mut Noise(24), 1.5, 200));
    let full = classify(&scene, &batch);
    let coarse = Reference { bits: 53, budget: 60, ..Reference::default() };
    let prepared = coarse.prepare_reference(&scene).unwrap();
    let indices: Vec<usize> = (0..batch.rays.len()).collect();
    let few = prepared.classify(Rays::Batch(&batch), &indices, &Progress::new()).unwrap();
    for (a, b) in full.iter().zip(&few) {
        if b.class == Class::Undecidable {
            assert!(b.bracket[0] <= a.bracket[1], "{a:?} {b:?}");
        } else {
            assert!(a.class == Class::None || b.bracket[0] <= a.bracket[1], "{a:?} {b:?}");
            assert_eq!(a.class == Class::None, b.class == Class::None, "{a:?} {b:?}");
        }
    }
}

#[test]
fn extreme_numbers_are_no_trouble() {
    let values = [0.0, -0.0, 1.0, -0.5, 1e-45, -1e-38, 1e38, -3e38, 16_777_216.0];
    let noise = &mut Noise(25);
    let mut pick = || values[((noise.unit() + 1.0) * 4.49) as usize];
    let mut vector = || Vec3::new(pick(), pick(), pick());
    let rays: Vec<Ray> = (0..300).map(|_| Ray::new(vector(), vector())).collect();
    let ranges = [
        [0.0, f64::INFINITY],
        [f64::NEG_INFINITY, f64::INFINITY],
        [f64::NAN, f64::NAN],
        [1.0, -1.0],
        [f64::INFINITY, f64::INFINITY],
        [-0.0, 5e-324],
    ];
    let equations = [
        "x^2+y^2+z^2-1",
        "1e200*x^3-1e-200*y",
        "exp(50*x)-log(y^2)+1/z",
        "floor(x)+sqrt(y)-abs(z)^0.3",
        "x",
    ];
    let valid = rays.iter().copied().filter(|r| r.is_valid()).collect();
    let tally = judge("x^2+y^2+z^2-1", 1e3, &RayBatch::new(valid), |[x, y, z]| {
        &(&(&x.pow(2) + &y.pow(2)) + &z.pow(2)) - &Poly::integer(1)
    });
    assert!(tally.undecidable == 0 && tally.transversal > 20, "{tally:?}");
    for equation in equations {
        let scene = scene(equation, 1e3);
        for range in ranges {
            let batch = RayBatch { rays: rays.clone(), range };
            for (ray, truth) in rays.iter().zip(classify(&scene, &batch)) {
                let [lo, hi] = truth.bracket;
                assert!(lo <= hi, "{equation}: {ray:?} in {range:?} is {truth:?}");
                if ray.is_valid() && range[0] > range[1] {
                    assert_eq!(truth.class, Class::None, "{equation}: {ray:?} is {truth:?}");
                }
            }
        }
    }
}
