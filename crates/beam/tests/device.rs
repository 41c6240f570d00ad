//! With outward rounding, a device gives the answers of its twin on the CPU: on every surface of the
//! catalogue, uniform and adaptive, in perspective and orthographic views, in one band or in many.
//!
//! Bit for bit on devices in software. Others divide and take roots otherwise by some units in the last place,
//! which the language allows, so that a piece may be excluded on one and not on the other: there, nearly all
//! answers must be nearly the same.

#[path = "../../gpu/tests/adapter/mod.rs"]
mod adapter;

use zeroset_beam::{Arithmetic, Beam, BeamGpu, Enclosure, Refinement, Start, Stop};
use zeroset_gpu::Device;
use zeroset_raycast::catalogue::Catalogue;
use zeroset_raycast::{
    Camera, Hits, Intersector, Method, Progress, Projection, Rays, Request, Scene, View,
};

fn ask(intersector: &dyn Intersector, view: &View) -> (Hits, u64) {
    let rays = Rays::View(view);
    let mut hits = Hits::new(Request::First, rays.len());
    let report = intersector.intersect(rays, &mut hits, &Progress::new()).expect("answers");
    assert_eq!(report.work, hits.total_work());
    (hits, report.work.intervals)
}

fn same(device: &Device, place: &str, a: &Hits, b: &Hits) {
    let is_exact = device.report().kind == "software";
    let mut apart = 0;
    for i in 0..a.len() {
        let (a, b) = (a.get(i), b.get(i));
        let bits = |bracket: [f64; 2]| bracket.map(f64::to_bits);
        let is_same = bits(a.bracket) == bits(b.bracket)
            && a.certificate == b.certificate
            && a.work == b.work;
        assert!(is_same || !is_exact, "{place}, pixel {i}: {a:?} and {b:?}");
        let [width, other] = [a, b].map(|hit| hit.bracket[1] - hit.bracket[0]);
        let near = (a.t() - b.t()).abs() <= 2.0 * (width + other);
        apart += usize::from(a.certificate != b.certificate || a.certificate.is_hit() && !near);
    }
    assert!(50 * apart <= a.len(), "{place}: {apart} of {} differ", a.len());
}

fn twins(refinement: Refinement, stop: Stop, start: Start) -> (Beam, BeamGpu) {
    on_both(Beam { stop, start, ..Beam::new(refinement) })
}

fn on_both(settings: Beam) -> (Beam, BeamGpu) {
    let device = BeamGpu::auto(settings.clone());
    (Beam { arithmetic: Arithmetic::Device, ..settings }, device)
}

/// Of a view: in perspective, and across.
fn cameras(scene: &Scene) -> [Camera; 2] {
    let camera = Camera::facing(&scene.domain);
    let height = 1.5 * scene.domain.radius();
    [camera, Camera { projection: Projection::Orthographic { height }, ..camera }]
}

#[test]
fn a_device_agrees_with_its_twin_on_every_surface() {
    let Some(adapter) = adapter::device() else { return };
    let (mut scenes, mut hits, mut proven) = (0, 0, 0);
    for (i, surface) in Catalogue::builtin().functions().enumerate() {
        let scene = surface.scene().expect("the catalogue is well formed");
        let [perspective, across] = cameras(&scene);
        // Each shader takes a second to compile.
        let ((twin, device), camera) = match i % 4 {
            0 => (twins(Refinement::Uniform, Stop::Thin, Start::Auto), perspective),
            1 => (twins(Refinement::Adaptive, Stop::Seen, Start::Size(8)), across),
            2 => (twins(Refinement::Adaptive, Stop::Thin, Start::Size(8)), perspective),
            _ => (twins(Refinement::Adaptive, Stop::Thin, Start::Auto), across),
        };
        if twin.supports(&scene).is_err() {
            assert!(device.prepare(&scene).is_err(), "{}", scene.id);
            continue;
        }
        let Ok(device) = device.prepare(&scene) else {
            // Some operations have no form there.
            assert!(device.supports(&scene).is_err(), "{}", scene.id);
            continue;
        };
        // No multiple of anything.
        let view = View::new(camera, 37, 29);
        let twin = twin.prepare(&scene).expect("it is supported");
        let ((a, _), (b, _)) = (ask(twin.as_ref(), &view), ask(device.as_ref(), &view));
        same(&adapter, &scene.id, &a, &b);
        scenes += 1;
        hits += a.certificate.iter().filter(|c| c.is_hit()).count();
        proven += a.certificate.iter().filter(|c| c.name() == "proven-hit").count();
    }
    assert!(scenes > 50 && hits > 10_000 && proven > 100, "{scenes} {hits} {proven}");
}

#[test]
fn a_device_agrees_with_its_twin_by_affine_forms() {
    let Some(adapter) = adapter::device() else { return };
    // Polynomials, exponentials, a sine, absolute values, a root; in a box and in a ball.
    let ids = [
        "sphere",
        "klein",
        "barth-sextic",
        "blinn-blob-ganacim",
        "torus-sqrt",
        "diamond",
        "scherk",
    ];
    let (mut hits, mut proven) = (0, 0);
    for id in ids {
        let scene = Catalogue::builtin().get(id).expect("it is there").scene().expect("a scene");
        let enclosure = Enclosure::Affine;
        let (twin, device) = on_both(Beam { enclosure, stop: Stop::Seen, ..Beam::adaptive() });
        let Ok(twin) = twin.prepare(&scene) else {
            assert!(device.supports(&scene).is_err(), "{id}");
            continue;
        };
        let device = device.prepare(&scene).expect("as its twin");
        for camera in cameras(&scene) {
            let view = View::new(camera, 37, 29);
            let ((a, _), (b, _)) = (ask(twin.as_ref(), &view), ask(device.as_ref(), &view));
            same(&adapter, id, &a, &b);
            hits += a.certificate.iter().filter(|c| c.is_hit()).count();
            proven += a.certificate.iter().filter(|c| c.name() == "proven-hit").count();
        }
    }
    assert!(hits > 2000 && proven > 100, "{hits} {proven}");
}

#[test]
fn no_cell_is_lost_however_the_image_is_tiled_and_where_the_quadtree_starts() {
    let Some(adapter) = adapter::device() else { return };
    let scene = Catalogue::builtin().get("klein").expect("it is there").scene().expect("a scene");
    // Near enough that no cell is excluded before it is a pixel.
    let near = Camera { projection: Projection::Perspective { fov: 8.0 }, ..cameras(&scene)[0] };
    for (camera, width, height) in [(cameras(&scene)[0], 131, 77), (near, 64, 96)] {
        let view = View::new(camera, width, height);
        for start in [Start::Auto, Start::Size(4), Start::Size(1 << 16)] {
            let (twin, device) = twins(Refinement::Adaptive, Stop::Thin, start);
            let (expected, work) = ask(twin.prepare(&scene).expect("twin").as_ref(), &view);
            for band in [1000, 1] {
                let device = BeamGpu { band, ..device.clone() };
                let intersector = device.prepare(&scene).expect("device");
                let (hits, again) = ask(intersector.as_ref(), &view);
                same(&adapter, &format!("{start:?}, bands of {band}"), &expected, &hits);
                assert!(work == again || adapter.report().kind != "software");
            }
        }
    }
}

#[test]
fn one_intersector_serves_views_of_any_size_and_new_parameters() {
    let Some(adapter) = adapter::device() else { return };
    let surface = Catalogue::builtin().get("torus").expect("it is there");
    let scene = surface.scene().expect("a scene");
    let (twin, device) = twins(Refinement::Adaptive, Stop::Thin, Start::Size(16));
    let (mut twin, mut device) =
        (twin.prepare(&scene).expect("twin"), device.prepare(&scene).expect("device"));
    for round in 0..2 {
        for (camera, size) in cameras(&scene).into_iter().zip([[40, 30], [30, 40]]) {
            for [width, height] in [size, [64, 64], [1, 300], [1, 1], [0, 5]] {
                let view = View::new(camera, width, height);
                let (a, b) = (ask(twin.as_ref(), &view).0, ask(device.as_ref(), &view).0);
                same(&adapter, &format!("{round}: {width} x {height}"), &a, &b);
            }
        }
        let zeroset_raycast::Geometry::Implicit(function) = &scene.geometry else { panic!() };
        let mut values = zeroset_expr::Parameters::default();
        values.set(&function.parameters()[0].name, "0.9");
        twin.set_parameters(&values).expect("a value");
        device.set_parameters(&values).expect("a value");
    }
}
