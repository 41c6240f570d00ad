//! Methods on the device answer as their twins on the CPU do.

mod adapter;

use zeroset_cpu::amp::Adaptation;
use zeroset_cpu::{Amp, Bisection, Implicit, RootTest};
use zeroset_expr::Evaluator;
use zeroset_gpu::{AmpGpu, BisectionGpu};
use zeroset_ia::{Interval, Plain};
use zeroset_raycast::catalogue::Catalogue;
use zeroset_raycast::{Camera, Hits, Method, Progress, Ray, Rays, Request, Scene, View};

const SIZE: usize = 128;

fn cast(method: &dyn Method, scene: &Scene, view: &View) -> Hits {
    let rays = Rays::View(view);
    let mut hits = Hits::new(Request::First, rays.len());
    let intersector = method.prepare(scene).unwrap_or_else(|e| panic!("{}: {e}", scene.id));
    intersector.intersect(rays, &mut hits, &Progress::new()).unwrap();
    hits
}

/// Is a pixel beside one that is hit and one that is not, or beside a jump in depth?
fn is_at_silhouette(hits: &Hits, pixel: usize, jump: f64) -> bool {
    let (x, y) = (pixel % SIZE, pixel / SIZE);
    let mut depths = Vec::new();
    for dy in -2..=2_i64 {
        for dx in -2..=2_i64 {
            let (x, y) = (x as i64 + dx, y as i64 + dy);
            let inside = 0..SIZE as i64;
            if inside.contains(&x) && inside.contains(&y) {
                depths.push(hits.get(y as usize * SIZE + x as usize).t());
            }
        }
    }
    let least = depths.iter().copied().fold(f64::INFINITY, f64::min);
    let most = depths.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    most - least > jump
}

#[test]
fn sign_tests_hit_where_their_twins_do() {
    marches_agree(RootTest::Sign);
}

#[test]
fn taylor_tests_hit_where_their_twins_do() {
    marches_agree(RootTest::Taylor);
}

/// What single precision leaves open about where a root is: devices may contract and round otherwise.
struct Blur<'a> {
    value: Evaluator<'a, Interval<f32>>,
    slope: Evaluator<'a, Plain<f64>>,
}

impl Blur<'_> {
    /// The width of the value's enclosure in single precision at a point of the ray, over the slope there.
    fn at(&mut self, ray: Ray, t: f64) -> f64 {
        let p = ray.at(t);
        let point = p.to_array().map(|x| Interval::<f32>::point(x as f32));
        let value = self.value.evaluate(point);
        let direction = ray.direction.as_dvec3();
        let [x, y, z] = p.to_array().map(Plain);
        let [dx, dy, dz] = direction.to_array().map(Plain);
        [x, y, z, dx, dy, dz].into_iter().enumerate().for_each(|(i, x)| self.slope.bind(i, x));
        let slope = self.slope.run(|_| {}).0;
        f64::from(value.hi - value.lo) / slope.abs()
    }
}

fn marches_agree(test: RootTest) {
    let Some(device) = adapter::device() else { return };
    // Devices in software compute as the CPU does.
    let is_exact = device.report().kind == "software";
    let mut report = Vec::new();
    let mut blurry = Vec::new();
    for surface in Catalogue::builtin().functions() {
        let scene = surface.scene().unwrap();
        let twin = Amp { test, ..Amp::default() };
        if twin.supports(&scene).is_err() {
            continue;
        }
        let view = View::new(Camera::facing(&scene.domain), SIZE, SIZE);
        let expected = cast(&twin, &scene, &view);
        let actual = cast(&AmpGpu::new(test), &scene, &view);
        let jump = 0.02 * scene.domain.radius();
        let implicit = Implicit::new(twin.id(), &scene).unwrap();
        let slope = implicit.tape.slope();
        let mut blur = Blur {
            value: implicit.tape.evaluator(&Interval::point(0.0)),
            slope: slope.evaluator(&Plain(0.0)),
        };
        let (mut other, mut far, mut excused) = (0, 0, 0);
        for i in 0..expected.len() {
            let (a, b) = (expected.get(i), actual.get(i));
            let hits = [a, b].into_iter().filter(|hit| hit.certificate.is_hit());
            let ray = view.ray(i % SIZE, i / SIZE);
            let (mut width, mut blurred) = (0.0_f64, 0.0_f64);
            for hit in hits.clone() {
                width = width.max(hit.bracket[1] - hit.bracket[0]);
                if !is_exact {
                    blurred = blurred.max(blur.at(ray, hit.t()));
                }
            }
            let apart = match hits.count() {
                0 => 0.0,
                // One root more or less: as if it were another sheet.
                1 => jump,
                _ => (a.t() - b.t()).abs(),
            };
            let sharp = 2.0 * width + 1e-5 * scene.domain.radius();
            if apart > sharp + blurred {
                other += 1;
                far += usize::from(!is_at_silhouette(&expected, i, jump));
            } else {
                excused += usize::from(apart > sharp);
            }
        }
        if excused > SIZE * SIZE / 100 {
            blurry.push((scene.id.clone(), excused));
        }
        if other > 0 {
            report.push((scene.id.clone(), other, far));
        }
    }
    // Whether a step that all but touches holds a root may hang on a rounding.
    let limit = SIZE * SIZE / if is_exact { 1000 } else { 100 };
    let bad: Vec<_> = report.iter().filter(|(_, other, far)| *other > limit || *far > 0).collect();
    eprintln!("pixels that differ, and those not at a silhouette: {report:?}");
    assert!(bad.is_empty(), "{bad:?}");
    // Chebyshev surfaces from order 14 on, in powers.
    assert!(blurry.len() <= 4, "single precision explains too much: {blurry:?}");
}

#[test]
fn marches_take_the_samples_of_their_twins() {
    let Some(device) = adapter::device() else { return };
    if device.report().kind != "software" {
        // Others round otherwise, and go on from there.
        return;
    }
    let kinds = [Adaptation::Off, Adaptation::On];
    for id in ["barth-sextic", "superquadric-2p5", "steiner"] {
        let scene = Catalogue::builtin().get(id).unwrap().scene().unwrap();
        let view = View::new(Camera::facing(&scene.domain), 48, 48);
        let mut samples = Vec::new();
        for test in [RootTest::Sign, RootTest::Taylor] {
            for distance_adaptation in kinds {
                for silhouette_adaptation in kinds {
                    let twin =
                        Amp { test, distance_adaptation, silhouette_adaptation, ..Amp::default() };
                    let expected = cast(&twin, &scene, &view);
                    let actual = cast(&AmpGpu::auto(twin.clone()), &scene, &view);
                    let pairs = expected.work.iter().zip(&actual.work);
                    let other = pairs.filter(|(a, b)| a != b).count();
                    // A rounding at a threshold moves a march.
                    assert!(other * 100 <= expected.len(), "{id} {twin:?}: {other}");
                    samples.push(expected.total_work());
                }
            }
        }
        // Each kind is another march.
        for (i, work) in samples.iter().enumerate() {
            assert!(!samples[..i].contains(work), "{id}: {samples:?}");
        }
    }
}

#[test]
fn bisection_hits_where_its_twin_does() {
    if adapter::device().is_none() {
        return;
    }
    let mut supported = 0;
    for surface in Catalogue::builtin().functions() {
        let scene = surface.scene().unwrap();
        let mut method = BisectionGpu::default();
        if method.supports(&scene).is_err() {
            continue;
        }
        supported += 1;
        let view = View::new(Camera::facing(&scene.domain), 32, 32);
        let mut twin = Bisection::tbisect();
        let width = 1e-4 * scene.domain.longest_side();
        twin.for_precision(width, &scene);
        method.for_precision(width, &scene);
        let (expected, actual) = (cast(&twin, &scene, &view), cast(&method, &scene, &view));
        for i in 0..expected.len() {
            let (a, b) = (expected.get(i), actual.get(i));
            // Both proven: the same root.
            let proven = |hit: &zeroset_raycast::Hit| {
                matches!(hit.certificate.name(), "proven-hit" | "proven-miss")
            };
            if proven(&a) && proven(&b) {
                assert_eq!(a.certificate, b.certificate, "{} {i}: {a:?} {b:?}", scene.id);
                let apart = a.bracket[0].max(b.bracket[0]) > a.bracket[1].min(b.bracket[1]);
                assert!(!apart || !a.certificate.is_hit(), "{} {i}: {a:?} {b:?}", scene.id);
            }
        }
        let count = |hits: &Hits| {
            hits.certificate.iter().filter(|c| c.name().starts_with("proven")).count()
        };
        let (twin, here) = (count(&expected), count(&actual));
        assert!(here * 10 >= twin * 9, "{}: {here} of {twin} proofs", scene.id);
    }
    assert!(supported >= 50, "{supported} surfaces");
}
