//! `amp-sign` and `amp-taylor` find what their sampling can find, where it is, whatever the grouping of
//! the rays, and certify only what is a root.

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use zeroset_cpu::{Adaptation, Amp, RootTest};
use zeroset_expr::{Function, Parameters};
use zeroset_ia::Isa;
use zeroset_raycast::{
    Camera, Certificate, Certification, Domain, Error, Hit, Hits, KnobError, Method, Progress,
    Projection, Ray, RayBatch, Rays, Request, Scene, View,
};

fn cube(half: f64) -> Domain {
    Domain::new(DVec3::splat(-half), DVec3::splat(half)).unwrap()
}

fn scene(equation: &str, half: f64) -> Scene {
    Scene::new("test", Function::parse(equation).unwrap(), cube(half))
}

fn cast(method: &Amp, scene: &Scene, rays: Rays<'_>, request: Request) -> Hits {
    let mut hits = Hits::new(request, rays.len());
    let intersector = method.prepare(scene).unwrap();
    intersector.intersect(rays, &mut hits, &Progress::new()).unwrap();
    hits
}

/// The answer for one ray.
fn answer(method: &Amp, scene: &Scene, ray: Ray) -> Hit {
    cast(method, scene, Rays::Batch(&RayBatch::new(vec![ray])), Request::First).get(0)
}

fn ray(origin: [f32; 3], direction: [f32; 3]) -> Ray {
    Ray::new(Vec3::from(origin), Vec3::from(direction))
}

/// With both root tests.
fn both(method: &Amp) -> [Amp; 2] {
    [RootTest::Sign, RootTest::Taylor].map(|test| Amp { test, ..method.clone() })
}

/// With both root tests, hits certified.
fn certifying() -> [Amp; 2] {
    both(&Amp { certify: Certification::On, ..Amp::default() })
}

/// Thresholds in units of f itself.
fn unscaled() -> Amp {
    Amp { scale: Some(1.0), ..Amp::default() }
}

/// The roots of |o + t d| = 1 in double precision, and the distance of the line to the centre.
fn sphere_roots(ray: Ray) -> Option<[f64; 2]> {
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let nearest = -o.dot(d) / d.length_squared();
    let discriminant = 1.0 - (o + nearest * d).length_squared();
    (discriminant >= 0.0).then(|| {
        let half = discriminant.sqrt() / d.length();
        [nearest - half, nearest + half]
    })
}

const SPHERE: &str = "x^2+y^2+z^2-1";

#[test]
fn brackets_hold_the_first_root_of_a_sphere() {
    let scene = scene(SPHERE, 1.25);
    let view = View::new(Camera::facing(&scene.domain), 96, 64);
    for method in both(&Amp::default()) {
        brackets_hold_the_first_root(&method, &scene, &view);
    }
}

fn brackets_hold_the_first_root(method: &Amp, scene: &Scene, view: &View) {
    let hits = cast(method, scene, Rays::View(view), Request::FirstWithNormal);
    let longest = 2.0 * 2.5 * 1.25 * 3.0_f64.sqrt() / 240.0;
    let mut found = 0;
    for i in 0..hits.len() {
        let ray = Rays::View(view).get(i);
        let Hit { bracket: [lo, hi], certificate, .. } = hits.get(i);
        match sphere_roots(ray) {
            None => assert_eq!(certificate, Certificate::MISS),
            // Roots closer than the longest step may be missed.
            Some([near, far]) if far - near <= longest => {}
            Some([near, _]) => {
                found += 1;
                assert_eq!(certificate, Certificate::HIT);
                assert!(hi - lo <= longest / 1024.0 + 1e-6, "{lo} {hi}");
                assert!(lo - 1e-5 <= near && near <= hi + 1e-5, "{near} not in [{lo}, {hi}]");
                let normal = ray.at(0.5 * (lo + hi)).as_vec3();
                assert!((hits.normal[i] - normal).length() < 1e-3);
            }
        }
    }
    assert!(found > 500, "{found} hits");
}

#[test]
fn steps_follow_equation_2() {
    let scene = scene("x", 1.0);
    let along = ray([-3.0, 0.1, 0.2], [1.0, 0.0, 0.0]);
    let isolated = |tau1, tau2, tau3| {
        let method = Amp {
            step: Some(0.125),
            tau1: Some(tau1),
            tau2: Some(tau2),
            tau3: Some(tau3),
            bisections: 0,
            ..unscaled()
        };
        let hit = answer(&method, &scene, along);
        assert_eq!(hit.certificate, Certificate::HIT);
        hit.bracket[1] - hit.bracket[0]
    };
    // No sample meets 0 itself: they are at -1 + k s + an offset below s.
    let offset = ray([-0.95, 0.1, 0.2], [1.0, 0.0, 0.0]);
    let width = |tau1, tau2, tau3, distance, silhouette| {
        let method = Amp {
            step: Some(0.125),
            tau1: Some(tau1),
            tau2: Some(tau2),
            tau3: Some(tau3),
            bisections: 0,
            distance_adaptation: distance,
            silhouette_adaptation: silhouette,
            ..unscaled()
        };
        let [lo, hi] = answer(&method, &scene, offset).bracket;
        assert!(lo <= 0.95 && 0.95 <= hi, "[{lo}, {hi}]");
        hi - lo
    };
    use Adaptation::{Off, On};
    for (expected, tau1, tau2, tau3, distance, silhouette) in [
        (0.03125, 10.0, 10.0, 1.5, On, On),
        (0.0625, 10.0, 10.0, 0.5, On, On),
        (0.0625, 10.0, 10.0, 1.5, On, Off),
        (0.125, 1e-9, 10.0, 1.5, On, On),
        (0.25, 1e-9, 1e-9, 1.5, On, On),
        (0.0625, 10.0, 10.0, 1.5, Off, On),
        (0.125, 10.0, 10.0, 1.5, Off, Off),
    ] {
        let width = width(tau1, tau2, tau3, distance, silhouette);
        assert!((width - expected).abs() < 1e-6, "{width} for {expected}");
    }
    // A sample that is exactly zero is a root.
    assert_eq!(isolated(10.0, 10.0, 0.5), 0.0);
}

#[test]
fn marching_points_are_counted() {
    let scene = scene("x^2+y^2+z^2+1", 1.0);
    let method = Amp {
        step: Some(0.01),
        distance_adaptation: Adaptation::Off,
        silhouette_adaptation: Adaptation::Off,
        ..Amp::default()
    };
    let hit = answer(&method, &scene, ray([-5.0, 0.0, 0.0], [2.0, 0.0, 0.0]));
    assert_eq!(hit.certificate, Certificate::MISS);
    assert_eq!(hit.bracket, [f64::INFINITY; 2]);
    // Both ends, and every 0.01 in between; rounding may add one.
    assert!((201..=202).contains(&hit.work.points), "{}", hit.work.points);
    assert_eq!(hit.work.gradients, 0);
}

#[test]
fn smaller_steps_find_more_and_cost_more() {
    // A shell 0.03 thick.
    let scene = scene("(x^2+y^2+z^2-0.5)*(x^2+y^2+z^2-0.55)", 1.0);
    let view = View::new(Camera::facing(&scene.domain), 64, 64);
    let run = |step| {
        let method = Amp { step: Some(step), ..Amp::default() };
        let hits = cast(&method, &scene, Rays::View(&view), Request::First);
        let found = hits.certificate.iter().filter(|c| c.is_hit()).count();
        (found, hits.total_work().points)
    };
    let runs = [0.4, 0.1, 0.025, 0.00625].map(run);
    for pair in runs.windows(2) {
        assert!(pair[0].0 <= pair[1].0 && pair[0].1 < pair[1].1, "{runs:?}");
    }
    assert!(runs[0].0 < runs[3].0, "{runs:?}");
}

#[test]
fn a_scaled_function_has_the_same_answers() {
    let view = View::new(Camera::facing(&cube(1.25)), 48, 48);
    let run = |equation: &str| {
        let scene = scene(equation, 1.25);
        cast(&Amp::default(), &scene, Rays::View(&view), Request::First)
    };
    let torus = "(x^2+y^2+z^2+0.64-0.09)^2-2.56*(x^2+y^2)";
    let expected = run(torus);
    // A power of two changes no digit; the product of two values below 1e-30 would vanish.
    for factor in ["2^80", "(1/2)^95"] {
        let scaled = run(&format!("({torus})*{factor}"));
        assert_eq!(scaled.bracket, expected.bracket, "{factor}");
        assert_eq!(scaled.work, expected.work, "{factor}");
    }
    for factor in ["1e24", "-3e-25"] {
        let scaled = run(&format!("({torus})*({factor})"));
        let differences = scaled
            .certificate
            .iter()
            .zip(&expected.certificate)
            .filter(|(scaled, expected)| scaled != expected)
            .count();
        assert!(differences <= 2, "{differences} differences for {factor}");
    }
}

#[test]
fn a_scaled_space_has_the_same_answers() {
    let run = |equation: &str, half: f64| {
        let scene = scene(equation, half);
        let view = View::new(Camera::facing(&scene.domain), 48, 48);
        cast(&Amp::default(), &scene, Rays::View(&view), Request::First)
    };
    let small = run("(x^2+y^2+z^2+0.55)^2-2.56*(x^2+y^2)", 1.25);
    let large =
        run("((x/1024)^2+(y/1024)^2+(z/1024)^2+0.55)^2-2.56*((x/1024)^2+(y/1024)^2)", 1280.0);
    for i in 0..small.len() {
        assert_eq!(small.certificate[i], large.certificate[i]);
        assert_eq!(small.bracket[i].map(|t| 1024.0 * t), large.bracket[i]);
        assert_eq!(small.work[i], large.work[i]);
    }
}

#[test]
fn the_length_of_a_direction_does_not_matter() {
    let scene = scene(SPHERE, 1.25);
    let [origin, direction] = [[3.0, 0.1, 0.2], [-1.0, 0.03, -0.02]];
    let unit = answer(&Amp::default(), &scene, ray(origin, direction));
    assert_eq!(unit.certificate, Certificate::HIT);
    for factor in [2.0_f32.powi(-120), 0.25, 2.0_f32.powi(100)] {
        let scaled = answer(&Amp::default(), &scene, ray(origin, direction.map(|d| d * factor)));
        assert_eq!(scaled.bracket.map(|t| t * f64::from(factor)), unit.bracket);
    }
}

#[test]
fn far_eyes_see_the_same() {
    let scene = scene(SPHERE, 1.25);
    for distance in [1e3, 1e6] {
        let ray = ray([distance, 0.25, 0.5], [-1.0, 0.0, 0.0]);
        let hit = answer(&Amp::default(), &scene, ray);
        let [root, _] = sphere_roots(ray).unwrap();
        assert!(hit.bracket[0] - 1e-6 <= root && root <= hit.bracket[1] + 1e-6, "{hit:?}");
        assert!(hit.bracket[1] - hit.bracket[0] < 1e-4, "{hit:?}");
    }
    // So far that double precision does not tell where the ray enters: counted, not guessed.
    let hit = answer(&Amp::default(), &scene, ray([1e30, 1e30, 1e30], [-1.0, -1.0, -1.0]));
    assert_eq!(hit.certificate, Certificate::MISS);
    assert_eq!(hit.work.nonfinite, 1);
}

#[test]
fn double_roots_are_missed_unless_offset() {
    let scene = scene("(x^2+y^2+z^2-1)^2", 1.25);
    let through = ray([3.0, 0.1, 0.2], [-1.0, 0.0, 0.0]);
    assert_eq!(answer(&Amp::default(), &scene, through).certificate, Certificate::MISS);
    let offset = Amp { epsilon: 0.01, ..Amp::default() };
    let hit = answer(&offset, &scene, through);
    assert_eq!(hit.certificate, Certificate::HIT);
    let [root, _] = sphere_roots(through).unwrap();
    assert!((hit.t() - root).abs() < 0.1, "{hit:?}");
}

#[test]
fn the_taylor_test_finds_double_roots() {
    let view = View::new(Camera::facing(&cube(1.25)), 48, 48);
    let rays = Rays::View(&view);
    for (equation, within) in
        [("(x^2+y^2+z^2-1)^2", 1e-4), ("(x^2+y^2+z^2)^2-2*(x^2+y^2+z^2)+1", 2e-2)]
    {
        let scene = scene(equation, 1.25);
        let hits = cast(&Amp::taylor(), &scene, rays, Request::First);
        assert!(hits.work.iter().all(|work| work.points == 0));
        let mut found = 0;
        for (i, hit) in (0..hits.len()).map(|i| (i, hits.get(i))) {
            match sphere_roots(rays.get(i)) {
                None => assert_eq!(hit.certificate, Certificate::MISS, "{equation}: {i}"),
                // Near a silhouette both double roots are one.
                Some([near, far]) if far - near < 0.2 => {}
                Some([near, _]) => {
                    found += 1;
                    assert_eq!(hit.certificate, Certificate::HIT, "{equation}: {i}");
                    assert!((hit.t() - near).abs() < within, "{equation}: {hit:?}, {near}");
                }
            }
        }
        assert!(found > 300, "{found}");
    }
}

/// Past a silhouette the test holds for a step, and for none of its halves; behind it there is a root.
#[test]
fn a_step_that_bisection_refutes_does_not_end_the_march() {
    let along = ray([-3.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    for offset in ["1e-3", "1e-4", "1e-5"] {
        let scene = scene(&format!("((x+0.3)^2+{offset})*(x-0.4)"), 1.0);
        let method = Amp { step: Some(0.2), bisections: 20, ..Amp::taylor() };
        let hit = answer(&method, &scene, along);
        assert_eq!(hit.certificate, Certificate::HIT, "{offset}");
        assert!((hit.t() - 3.4).abs() < 1e-4, "{offset}: {hit:?}");
        // Without bisection nothing refutes the step.
        let hit = answer(&Amp { bisections: 0, ..method }, &scene, along);
        assert!(hit.bracket[1] < 3.0, "{offset}: {hit:?}");
    }
}

/// Every step of a function of high frequency passes the Taylor test, and every bisection refutes it.
#[test]
fn a_march_that_is_always_refuted_ends() {
    let scene = scene("2+sin(20000*x)", 1.0);
    let method = Amp { step: Some(0.02), ..Amp::taylor() };
    let hit = answer(&method, &scene, ray([-3.0, 0.1, 0.2], [1.0, 0.0, 0.0]));
    let most = (8.0 * 3.0_f64.sqrt() / 0.02) as u64;
    assert!((most..most + 20).contains(&hit.work.gradients), "{hit:?}");
    assert_eq!(hit.certificate, Certificate::HIT);
}

#[test]
fn certified_hits_hold_a_root_of_the_sphere() {
    let scene = scene(SPHERE, 1.25);
    let view = View::new(Camera::facing(&scene.domain), 64, 64);
    let rays = Rays::View(&view);
    for method in certifying() {
        for bisections in [0, 10, 22] {
            let plain = Amp { bisections, certify: Certification::Off, ..method.clone() };
            let method = Amp { bisections, ..method.clone() };
            let plain = cast(&plain, &scene, rays, Request::First);
            let hits = cast(&method, &scene, rays, Request::First);
            let [mut found, mut proven] = [0; 2];
            for (i, hit) in (0..hits.len()).map(|i| (i, hits.get(i))) {
                let before = plain.get(i);
                assert_eq!(hit.certificate.is_hit(), before.certificate.is_hit());
                assert!(!before.certificate.contains(Certificate::ROOT));
                if !hit.certificate.is_hit() {
                    assert_eq!(hit, before);
                    continue;
                }
                found += 1;
                if hit.certificate != Certificate::ROOT_HIT {
                    assert_eq!((hit.certificate, hit.bracket), (Certificate::HIT, before.bracket));
                    continue;
                }
                proven += 1;
                let roots = sphere_roots(rays.get(i)).expect("a root was proven");
                let [lo, hi] = hit.bracket;
                // The roots are rounded here.
                let holds = |root: f64| lo - 1e-14 <= root && root <= hi + 1e-14;
                assert!(holds(roots[0]) || holds(roots[1]), "{hit:?}, {roots:?}");
                assert!(lo >= before.bracket[0] - 2e-6 && hi <= before.bracket[1] + 2e-6);
            }
            assert!(100 * proven > 97 * found && found > 500, "{bisections}: {proven} of {found}");
        }
    }
}

/// A sample that is exactly zero gives a bracket of one point, at which there is no change of sign.
#[test]
fn brackets_of_one_point_are_widened_for_a_proof() {
    let scene = scene("x", 1.0);
    let along = ray([-3.0, 0.125, 0.25], [1.0, 0.0, 0.0]);
    for method in certifying() {
        let method = Amp { step: Some(0.125), ..method };
        let plain = Amp { certify: Certification::Off, ..method.clone() };
        let [lo, hi] = answer(&plain, &scene, along).bracket;
        assert!(lo == hi && (lo - 3.0).abs() < 1e-14, "[{lo}, {hi}]");
        let hit = answer(&method, &scene, along);
        assert_eq!(hit.certificate, Certificate::ROOT_HIT);
        assert!(hit.bracket[0] < 3.0 && 3.0 < hit.bracket[1], "{hit:?}");
        assert!(hit.bracket[1] - hit.bracket[0] < 4e-6, "{hit:?}");
        // Only as far as roots count.
        let batch = RayBatch { rays: vec![along], range: [0.0, 3.0] };
        let hit = cast(&method, &scene, Rays::Batch(&batch), Request::First).get(0);
        assert_eq!(hit.certificate, Certificate::HIT);
        assert!(hit.bracket[0] == hit.bracket[1], "{hit:?}");
    }
}

/// A certificate is about f = 0, and a root of f - epsilon is none of f.
#[test]
fn a_moved_surface_is_not_taken_for_the_surface() {
    let through = ray([3.0, 0.1, 0.2], [-1.0, 0.0, 0.0]);
    for method in certifying() {
        for (equation, epsilon) in [(SPHERE, 0.01), (SPHERE, -0.01), ("(x^2+y^2+z^2-1)^2", 0.01)] {
            let method = Amp { epsilon, ..method.clone() };
            let hit = answer(&method, &scene(equation, 1.25), through);
            assert_eq!(hit.certificate, Certificate::HIT, "{equation} = {epsilon}");
        }
        // So little that the bracket holds both.
        let method = Amp { epsilon: 1e-9, ..method };
        let hit = answer(&method, &scene(SPHERE, 1.25), through);
        assert_eq!(hit.certificate, Certificate::ROOT_HIT);
        let [root, _] = sphere_roots(through).unwrap();
        assert!(hit.bracket[0] <= root && root <= hit.bracket[1]);
    }
}

#[test]
fn poles_are_plain_hits_and_undefined_values_are_none() {
    let along = ray([-3.0, 0.1, 0.2], [1.0, 0.0, 0.0]);
    let pole = answer(&Amp::default(), &scene("1/(x-0.3)", 1.0), along);
    assert_eq!(pole.certificate, Certificate::HIT);
    assert!(pole.bracket[0] - 1e-6 <= 3.3 && 3.3 <= pole.bracket[1] + 1e-6);
    // Undefined for x < 0.3, then positive.
    let undefined = answer(&Amp::default(), &scene("sqrt(x-0.3)+1", 1.0), along);
    assert_eq!(undefined.certificate, Certificate::MISS);
    assert!(undefined.work.nonfinite > 10);
    // Undefined first: the root after it is found.
    let root = answer(&Amp::default(), &scene("sqrt(x+0.3)-0.5", 1.0), along);
    assert_eq!(root.certificate, Certificate::HIT);
    assert!((root.t() - 2.95).abs() < 1e-4);
    // Everywhere undefined, or too large for single precision.
    for equation in ["log(-1-x^2)", "(x-2)*1e200"] {
        let hit = answer(&Amp::default(), &scene(equation, 1.0), along);
        assert_eq!(hit.certificate, Certificate::MISS);
        assert_eq!(hit.work.nonfinite, hit.work.points);
    }
}

#[test]
fn only_roots_in_the_domain_and_range_count() {
    let mut half = scene(SPHERE, 1.25);
    half.domain.max.z = 0.0;
    let down = ray([0.1, 0.2, 3.0], [0.0, 0.0, -1.0]);
    let hit = answer(&Amp::default(), &half, down);
    let [_, far] = sphere_roots(down).unwrap();
    assert!(hit.bracket[0] - 1e-6 <= far && far <= hit.bracket[1] + 1e-6, "{hit:?}");

    let scene = scene(SPHERE, 1.25);
    let in_range = |range| {
        let batch = RayBatch { rays: vec![down], range };
        cast(&Amp::default(), &scene, Rays::Batch(&batch), Request::First).get(0)
    };
    let [near, far] = sphere_roots(down).unwrap();
    assert_eq!(in_range([0.0, near - 0.01]).certificate, Certificate::MISS);
    assert_eq!(in_range([near + 0.01, far - 0.01]).certificate, Certificate::MISS);
    assert!((in_range([near + 0.01, 10.0]).t() - far).abs() < 1e-4);
    assert_eq!(in_range([20.0, 30.0]).certificate, Certificate::MISS);
    // A range of one point holds that point's root.
    let touching = ray([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let batch = RayBatch { rays: vec![touching], range: [0.0, 0.0] };
    let hit = cast(&Amp::default(), &scene, Rays::Batch(&batch), Request::First).get(0);
    assert_eq!((hit.certificate, hit.bracket), (Certificate::HIT, [0.0, 0.0]));
}

#[test]
fn any_root_is_enough_for_a_shadow() {
    let scene = scene(SPHERE, 1.25);
    let view = View::new(Camera::facing(&scene.domain), 48, 48);
    // The Taylor test needs its bisections: they refute steps without a root.
    let taylor = |request| cast(&Amp::taylor(), &scene, Rays::View(&view), request);
    let (any, first) = (taylor(Request::Any), taylor(Request::First));
    assert_eq!((any.certificate, any.bracket), (first.certificate, first.bracket));

    let first = cast(&Amp::default(), &scene, Rays::View(&view), Request::First);
    let any = cast(&Amp::default(), &scene, Rays::View(&view), Request::Any);
    assert_eq!(any.certificate, first.certificate);
    assert!(any.total_work().points < first.total_work().points);
    for (any, first) in any.bracket.iter().zip(&first.bracket) {
        assert!(any[0] <= first[0] && first[1] <= any[1]);
    }
}

#[test]
fn precision_sets_the_bisections() {
    let scene = scene(SPHERE, 1.25);
    let view = View::new(Camera::facing(&scene.domain), 32, 32);
    for width in [1.0, 1e-2, 1e-4] {
        let mut method = Amp { step: Some(0.02), ..Amp::default() };
        method.for_precision(width, &scene);
        assert_eq!(method.step, Some(0.02));
        let hits = cast(&method, &scene, Rays::View(&view), Request::First);
        for i in 0..hits.len() {
            let [lo, hi] = hits.bracket[i];
            assert!(lo.is_infinite() || hi - lo <= width + 1e-6, "[{lo}, {hi}]");
        }
    }
    let bisections = |width| {
        let mut method = Amp { step: Some(0.02), ..Amp::default() };
        method.for_precision(width, &scene);
        method.bisections
    };
    assert_eq!([bisections(0.04), bisections(0.02), bisections(0.04 / 1024.0)], [0, 1, 10]);
    // Single precision resolves no more.
    assert_eq!(bisections(1e-12), bisections(0.0));
    assert!(bisections(0.0) < 24);
}

#[test]
fn parameters_change_without_preparing_again() {
    let scene = scene("x^2+y^2+z^2-r^2; r=1", 1.25);
    let mut intersector = Amp::default().prepare(&scene).unwrap();
    let batch = RayBatch::new(vec![ray([3.0, 0.0, 0.0], [-1.0, 0.0, 0.0])]);
    let root = |intersector: &dyn zeroset_raycast::Intersector| {
        let mut hits = Hits::new(Request::First, 1);
        intersector.intersect(Rays::Batch(&batch), &mut hits, &Progress::new()).unwrap();
        hits.get(0).t()
    };
    assert!((root(&*intersector) - 2.0).abs() < 1e-4);
    let mut values = Parameters::default();
    values.set("r", "0.5");
    intersector.set_parameters(&values).unwrap();
    assert!((root(&*intersector) - 2.5).abs() < 1e-4);
    values.set("q", "1");
    assert!(matches!(intersector.set_parameters(&values), Err(Error::Parameter(_))));
    assert!((root(&*intersector) - 2.5).abs() < 1e-4);
}

#[test]
fn knobs_take_what_they_say_and_give_it_back() {
    let mut method = Amp::default();
    for (name, value) in [
        ("step", "0.01"),
        ("scale", "128"),
        ("tau1", "0.01"),
        ("tau2", "0.02"),
        ("tau3", "0.005"),
        ("bisections", "20"),
        ("epsilon", "-0.25"),
        ("distance_adaptation", "off"),
        ("silhouette_adaptation", "off"),
        ("isa", "portable"),
        ("certify", "on"),
    ] {
        method.set(name, value).unwrap();
        let knob = method.knobs().into_iter().find(|k| k.name == name).unwrap();
        assert_eq!(knob.value, value);
    }
    // Every knob's text sets it again.
    let mut copy = Amp::default();
    for knob in method.knobs() {
        copy.set(knob.name, &knob.value).unwrap();
    }
    assert_eq!(copy, method);
    for knob in Amp::default().knobs() {
        copy.set(knob.name, &knob.value).unwrap();
    }
    assert_eq!(copy, Amp::default());

    assert!(matches!(method.set("stride", "1"), Err(KnobError::Unknown { .. })));
    for (name, value) in [
        ("step", "0"),
        ("step", "-1"),
        ("step", "inf"),
        ("step", "wide"),
        ("tau1", "nan"),
        ("bisections", "65"),
        ("bisections", "1.5"),
        ("epsilon", "inf"),
        ("distance_adaptation", "yes"),
        ("isa", "mmx"),
        ("certify", "yes"),
    ] {
        assert!(matches!(method.set(name, value), Err(KnobError::Value { .. })), "{name}={value}");
    }
}

#[test]
fn what_single_precision_cannot_do_is_refused() {
    let refused = |method: Amp, scene: &Scene| match method.prepare(scene) {
        Err(Error::Unsupported(why)) => {
            assert_eq!(method.supports(scene), Err(why.clone()));
            why.to_string()
        }
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("accepted"),
    };
    let small_step = Amp { step: Some(1e-9), ..Amp::default() };
    let why = refused(small_step, &scene(SPHERE, 1.25));
    assert!(why.contains("1e-9") || why.contains("0.000000001"), "{why}");
    assert!(why.contains("least step"), "{why}");
    refused(Amp::default(), &scene(SPHERE, 1e39));
    refused(Amp::default(), &scene(SPHERE, 1e-39));

    let mut inverted = scene(SPHERE, 1.0);
    inverted.domain.min.y = 2.0;
    assert!(matches!(Amp::default().prepare(&inverted), Err(Error::Domain(_))));
    let mut no_ball = scene(SPHERE, 1.0);
    no_ball.domain.ball = Some(f64::NAN);
    assert!(matches!(Amp::default().prepare(&no_ball), Err(Error::Domain(_))));
}

#[test]
fn rays_that_are_none_are_counted() {
    let scene = scene(SPHERE, 1.25);
    for bad in [
        ray([f32::NAN, 0.0, 0.0], [1.0, 0.0, 0.0]),
        ray([0.0; 3], [0.0; 3]),
        ray([0.0; 3], [f32::INFINITY, 0.0, 0.0]),
    ] {
        let hit = answer(&Amp::default(), &scene, bad);
        assert_eq!((hit.certificate, hit.work.nonfinite), (Certificate::MISS, 1));
    }
    let empty = RayBatch::new(vec![]);
    assert!(cast(&Amp::default(), &scene, Rays::Batch(&empty), Request::First).is_empty());
    let nothing = View::new(Camera::facing(&scene.domain), 0, 0);
    assert!(cast(&Amp::default(), &scene, Rays::View(&nothing), Request::First).is_empty());
}

/// Functions with every kind of operation that single precision could round in its own way.
const MIXED: [&str; 3] = [
    "(x^2+y^2+z^2+0.55)^2-2.56*(x^2+y^2)",
    "sin(5*x)*cos(4*y)+sin(3*z)+exp(x*y)-1.2",
    "abs(x)^1.5+abs(y)^0.7+max(z,sqrt(x+0.8))/(y+1.5)-0.8",
];

#[test]
fn answers_do_not_depend_on_grouping_threads_or_instruction_set() {
    for equation in MIXED {
        let scene = scene(equation, 1.25);
        let mut camera = Camera::facing(&scene.domain);
        camera.projection = Projection::Orthographic { height: 3.0 };
        let view = View::new(camera, 45, 37);
        let rays = Rays::View(&view);
        let expected = certifying().map(|m| cast(&m, &scene, rays, Request::FirstWithNormal));
        for expected in &expected {
            assert!(expected.certificate.iter().any(|c| c.is_hit()));
            assert!(expected.certificate.iter().any(|c| !c.is_hit()));
        }

        // 677 is prime to 45 * 37.
        let order: Vec<usize> = (0..rays.len()).map(|i| i * 677 % rays.len()).collect();
        let batch = RayBatch::new(order.iter().map(|&i| rays.get(i)).collect());
        let methods = certifying();
        let methods = methods.iter().zip(&expected);
        for (isa, (method, expected)) in
            Isa::available().into_iter().flat_map(|isa| methods.clone().map(move |m| (isa, m)))
        {
            let method = Amp { isa: Some(isa), ..method.clone() };
            let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
            let hits = one_thread
                .install(|| cast(&method, &scene, Rays::Batch(&batch), Request::FirstWithNormal));
            for (i, &index) in order.iter().enumerate() {
                assert_eq!(hits.get(i), expected.get(index), "{equation} on {}", isa.name());
                assert_eq!(hits.normal[i], expected.normal[index]);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_ray_is_answered_as_if_alone(
        rays in prop::collection::vec(
            (prop::array::uniform3(-2.0_f32..2.0), prop::array::uniform3(prop::num::f32::NORMAL | prop::num::f32::ZERO)),
            1..70,
        ),
        equation in prop::sample::select(&MIXED[..]),
    ) {
        let scene = scene(equation, 1.25);
        let rays: Vec<Ray> = rays.into_iter().map(|(o, d)| ray(o, d)).collect();
        let batch = RayBatch::new(rays.clone());
        for method in certifying() {
            let method = Amp { step: Some(0.1), ..method };
            let together = cast(&method, &scene, Rays::Batch(&batch), Request::First);
            for (i, &ray) in rays.iter().enumerate() {
                prop_assert_eq!(together.get(i), answer(&method, &scene, ray));
            }
        }
    }

    /// At a pole or a jump the sign changes, and nothing is a root.
    #[test]
    fn poles_and_jumps_are_never_certified(
        rays in prop::collection::vec(
            (prop::array::uniform3(-3.0_f32..3.0), prop::array::uniform3(-1.0_f32..1.0)),
            1..70,
        ),
        equation in prop::sample::select(&[
            "1/(x-0.1)",
            "(y^2+1)/(x-0.1)^3",
            "1/(x^2+y^2+z^2-1)",
            "sign(x-0.1)",
            "floor(x-0.1)+0.5",
            "1/(x-0.1)+sin(y)/2+1",
        ][..]),
        bisections in 0..25_u32,
    ) {
        let scene = scene(equation, 1.25);
        let rays: Vec<Ray> = rays.into_iter().map(|(o, d)| ray(o, d)).collect();
        let batch = RayBatch::new(rays.clone());
        for method in certifying() {
            let hits = cast(&Amp { bisections, ..method }, &scene, Rays::Batch(&batch), Request::First);
            for (ray, hit) in rays.iter().zip((0..rays.len()).map(|i| hits.get(i))) {
                // The last equation has roots too: there 1/(x-0.1) <= -1/2.
                let [lo, hi] = hit.bracket.map(|t| ray.at(t).x);
                let holds_the_pole = lo.min(hi) <= 0.1 && 0.1 <= lo.max(hi);
                let has_root = equation.contains("sin") && !holds_the_pole;
                prop_assert!(has_root || !hit.certificate.contains(Certificate::ROOT), "{hit:?}");
            }
        }
    }
}
