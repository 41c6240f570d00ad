//! Methods on the device answer as their twins on the CPU do.

mod adapter;

use zeroset_cpu::{Amp, Bisection, RootTest};
use zeroset_gpu::{AmpGpu, BisectionGpu};
use zeroset_raycast::catalogue::Catalogue;
use zeroset_raycast::{Camera, Hits, Method, Progress, Rays, Request, Scene, View};

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

fn marches_agree(test: RootTest) {
    if adapter::device().is_none() {
        return;
    }
    let mut report = Vec::new();
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
        let (mut other, mut far) = (0, 0);
        for i in 0..expected.len() {
            let (a, b) = (expected.get(i), actual.get(i));
            if a.certificate.is_hit() != b.certificate.is_hit() {
                other += 1;
                far += usize::from(!is_at_silhouette(&expected, i, jump));
            } else if a.certificate.is_hit() {
                let width = (a.bracket[1] - a.bracket[0]).max(b.bracket[1] - b.bracket[0]);
                let apart = (a.t() - b.t()).abs();
                if apart > 2.0 * width + 1e-5 * scene.domain.radius() {
                    // Another sheet: at a silhouette, too.
                    other += 1;
                    far += usize::from(!is_at_silhouette(&expected, i, jump));
                }
            }
        }
        if other > 0 {
            report.push((scene.id.clone(), other, far));
        }
    }
    let limit = SIZE * SIZE / 1000;
    let bad: Vec<_> = report.iter().filter(|(_, other, far)| *other > limit || *far > 0).collect();
    eprintln!("pixels that differ, and those not at a silhouette: {report:?}");
    assert!(bad.is_empty(), "{bad:?}");
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
