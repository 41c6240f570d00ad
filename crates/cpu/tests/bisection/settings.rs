//! What the settings do: poles, tolerances, shadow rays, normals.

use zeroset_cpu::{Algorithm, Arithmetic, Bisection, Finishing, Normals, Poles, Stop};
use zeroset_raycast::{Certificate, Hits, Method, Progress, RayBatch, Rays, Request, Work};

use crate::{ALGORITHMS, EQUATIONS, answers, assorted, ray, scene, view};

/// As the paper has it: every last piece is a hit.
fn accepting(algorithm: Algorithm) -> Bisection {
    Bisection { finish: Finishing::Accept, ..Bisection::new(algorithm) }
}

#[test]
fn poles_are_hits_if_they_are_shown() {
    let across = ray([-3.0, 0.1, 0.2], [1.0, 0.0, 0.0]);
    for equation in ["1/(x-0.3)", "tan(2*(x+0.4853981634))+9", "1/(x-0.3)^3+1/(x-0.3)"] {
        let scene = scene(equation, 1.0);
        for algorithm in ALGORITHMS {
            let at =
                |poles| answers(&Bisection { poles, ..accepting(algorithm) }, &scene, &[across])[0];
            let (hidden, shown) = (at(Poles::Hidden), at(Poles::Shown));
            assert!(!hidden.certificate.contains(Certificate::FIRST), "{equation} {hidden:?}");
            assert_eq!(shown.certificate, Certificate::POSSIBLE_HIT, "{equation} {algorithm:?}");
            let [lo, hi] = shown.bracket;
            assert!(lo <= 3.3 && 3.3 <= hi && hi - lo < 0.01, "{equation} {algorithm:?} {shown:?}");
        }
    }
}

#[test]
fn a_ray_within_a_pole_ends() {
    let scene = scene("y/x-1", 1.0);
    let within = ray([0.0, -2.0, 0.0], [0.0, 1.0, 0.0]);
    for algorithm in ALGORITHMS {
        let (stop, arithmetic) = (Stop::Width(1e-11), Arithmetic::Double);
        let method = Bisection { stop, arithmetic, ..Bisection::new(algorithm) };
        let hit = answers(&method, &scene, &[within])[0];
        assert_eq!(hit.certificate, Certificate::MISS, "{algorithm:?} {hit:?}");
        assert!(hit.work.intervals < 20_000, "{algorithm:?} {hit:?}");
    }
}

#[test]
fn domains_beyond_what_t_can_tell_are_refused() {
    // The root x = 1 is at t = 2^149, the domain's end beyond all numbers.
    let domain = |far: i32| {
        let (min, max) = (glam::DVec3::NEG_ONE, glam::DVec3::new(2.0_f64.powi(far), 1.0, 1.0));
        zeroset_raycast::Domain::new(min, max).unwrap()
    };
    let least = ray([0.0; 3], [1e-45, 0.0, 0.0]);
    for algorithm in ALGORITHMS {
        let method = Bisection::new(algorithm);
        let mut scene = scene("x-1", 1.0);
        scene.domain = domain(890);
        let refused = method.prepare(&scene).err().expect("it is refused").to_string();
        assert!(refused.contains("2^800"), "{refused}");
        scene.domain = domain(799);
        let hit = answers(&method, &scene, &[least])[0];
        let root = 2.0_f64.powi(149);
        assert!(hit.certificate.is_hit(), "{algorithm:?} {hit:?}");
        assert!(hit.bracket[0] <= root && root <= hit.bracket[1], "{algorithm:?} {hit:?}");
    }
}

#[test]
fn a_range_tolerance_ends_the_bisection_early() {
    let scene = scene("x^2+y^2+z^2-1", 1.25);
    let rays = assorted(&scene, 16);
    for algorithm in [Algorithm::Kmarch, Algorithm::Tbisect] {
        let at = |delta| {
            answers(
                &Bisection { delta, stop: Stop::Depth(16), ..accepting(algorithm) },
                &scene,
                &rays,
            )
        };
        let (fine, coarse) = (at(0.0), at(0.1));
        let work = |hits: &[zeroset_raycast::Hit]| -> u64 {
            hits.iter().map(|hit| hit.work.intervals).sum()
        };
        assert!(2 * work(&coarse) < work(&fine), "{algorithm:?}");
        for (fine, coarse) in fine.iter().zip(&coarse) {
            assert!(coarse.certificate.is_hit() || !fine.certificate.is_hit());
            assert!(coarse.bracket[0] <= fine.bracket[0], "{fine:?} {coarse:?}");
        }
    }
}

fn ask(
    method: &Bisection,
    scene: &zeroset_raycast::Scene,
    rays: Rays<'_>,
    request: Request,
) -> Hits {
    let mut hits = Hits::new(request, rays.len());
    let intersector = method.prepare(scene).unwrap();
    intersector.intersect(rays, &mut hits, &Progress::new()).unwrap();
    hits
}

#[test]
fn shadow_rays_stop_earlier() {
    for (equation, half) in EQUATIONS {
        let scene = scene(equation, half);
        let batch = RayBatch::new(assorted(&scene, 16));
        let rays = Rays::Batch(&batch);
        for algorithm in ALGORITHMS {
            let method = Bisection { stop: Stop::Depth(10), ..accepting(algorithm) };
            let any = ask(&method, &scene, rays, Request::Any);
            let coarse = Bisection { stop: Stop::Depth(8), ..method.clone() };
            let first = ask(&coarse, &scene, rays, Request::First);
            assert_eq!((any.bracket, any.certificate), (first.bracket, first.certificate));
            let exact = ask(&Bisection { shadow: 0, ..method.clone() }, &scene, rays, Request::Any);
            let first = ask(&method, &scene, rays, Request::First);
            assert_eq!((exact.bracket, exact.certificate), (first.bracket, first.certificate));
        }
    }
}

#[test]
fn normals_by_differences_are_near_the_gradient() {
    let scene = scene("x^2+2*y^2+z^2-1", 1.25);
    let view = view(&scene, 24, 24);
    let with = |normals| {
        let method = Bisection { normals, ..Bisection::kmarch() };
        ask(&method, &scene, Rays::View(&view), Request::FirstWithNormal)
    };
    let exact = with(Normals::Gradient);
    for width in [1e-4, 0.01, 0.5] {
        let stencil = with(Normals::Stencil(width));
        for i in 0..exact.len() {
            // Central differences of a quadric are exact.
            let off = (stencil.normal[i] - exact.normal[i]).length();
            assert!(off < 1e-5, "{width}: {:?} {:?}", stencil.normal[i], exact.normal[i]);
            let Work { points, gradients, .. } = stencil.work[i];
            let hit = exact.certificate[i].is_hit();
            assert_eq!(points, if hit { 6 } else { 0 });
            assert_eq!(exact.work[i].gradients, gradients + u64::from(hit));
        }
    }
}

#[test]
fn work_is_kept_by_ray_only_where_that_is_asked_for() {
    let scene = scene("x^2+2*y^2+z^2-1", 1.25);
    let view = view(&scene, 40, 40);
    let intersector = Bisection::kmarch().prepare(&scene).expect("a scene");
    let cast = |mut hits: Hits| {
        let cast = intersector.intersect(Rays::View(&view), &mut hits, &Progress::new());
        (hits, cast.expect("answers").work)
    };
    let (with, total) = cast(Hits::new(Request::FirstWithNormal, 1600));
    let (without, same) = cast(Hits::without_work(Request::FirstWithNormal, 1600));
    assert_eq!((total, with.total_work()), (same, total));
    assert!(without.work.is_empty() && total.gradients > 0);
    assert_eq!((with.bracket, with.certificate), (without.bracket, without.certificate));
    assert_eq!(with.normal, without.normal);
}

#[test]
fn mitchell_ends_where_the_function_is_monotone() {
    let scene = scene("x^2+y^2+z^2-1", 1.25);
    let through = ray([-3.0, 0.1, 0.2], [1.0, 0.01, 0.0]);
    let hit = answers(&accepting(Algorithm::Mitchell), &scene, &[through])[0];
    assert_eq!(hit.certificate, Certificate::PROVEN_HIT);
    let bisected = answers(&accepting(Algorithm::Tbisect), &scene, &[through])[0];
    assert!(hit.work.intervals < bisected.work.intervals, "{hit:?} {bisected:?}");
    assert!(hit.work.points > 4 && hit.work.gradients > 0, "{hit:?}");
    let [lo, hi] = hit.bracket;
    assert!(lo <= hi && hi - lo < 0.01, "{hit:?}");
}

#[test]
fn double_precision_resolves_what_single_cannot() {
    // Two sheets 1e-9 apart: in single precision they are one.
    let scene = scene("(x-0.3)*(x-0.300000001)", 1.0);
    let across = ray([-3.0, 0.1, 0.2], [1.0, 0.0, 0.0]);
    for algorithm in ALGORITHMS {
        let [single, double] = [Arithmetic::Auto, Arithmetic::Double].map(|arithmetic| {
            let stop = Stop::Width(1e-11);
            let method = Bisection { stop, arithmetic, ..accepting(algorithm) };
            answers(&method, &scene, &[across])[0].bracket
        });
        assert!(single[0] <= 3.3 && single[1] - single[0] > 1e-8, "{algorithm:?} {single:?}");
        let near = double.iter().all(|t| (t - 3.3).abs() < 2e-9);
        assert!(near && double[1] - double[0] < 1e-10, "{algorithm:?} {double:?}");
    }
}
