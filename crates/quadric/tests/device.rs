//! What a device draws is what rays hit on the CPU, but for pixels at silhouettes: in balls and in tetrahedra,
//! blended or not, from near, far and inside, in perspective and orthographic views.

#[path = "../../gpu/tests/adapter/mod.rs"]
mod adapter;
mod scenes;

use glam::{DMat3, DVec3};
use scenes::{balls, cubes, sphere};
use zeroset_gpu::device::Format;
use zeroset_quadric::{Culling, Formula, Quadrics, QuadricsGpu};
use zeroset_raycast::{
    Blending, Camera, Hits, Method, Patches, Progress, Projection, Quadric, Rays, Request, Scene,
    Sides, View,
};

fn ask(method: &dyn Method, scene: &Scene, view: &View) -> Hits {
    let intersector = method.prepare(scene).expect("patches");
    let mut hits = Hits::new(Request::FirstWithNormal, view.width * view.height);
    intersector.intersect(Rays::View(view), &mut hits, &Progress::new()).expect("answers");
    hits
}

/// How two pictures differ.
#[derive(Debug, Default)]
struct Difference {
    hits: usize,
    /// Hits of one alone.
    alone: usize,
    /// Hits further apart than a pixel is wide.
    apart: usize,
    /// The greatest distance of the others, and the greatest angle of their normals in degrees.
    error: f64,
    angle: f64,
}

fn difference(a: &Hits, b: &Hits, view: &View) -> Difference {
    let mut difference = Difference::default();
    for i in 0..a.len() {
        let (x, y) = (a.get(i), b.get(i));
        if x.certificate.is_hit() != y.certificate.is_hit() {
            difference.alone += 1;
        } else if x.certificate.is_hit() {
            difference.hits += 1;
            let error = (x.t() - y.t()).abs();
            if error > view.footprint(x.t()) {
                difference.apart += 1;
                continue;
            }
            difference.error = difference.error.max(error);
            let cosine = a.normal[i].dot(b.normal[i]).clamp(-1.0, 1.0);
            difference.angle = difference.angle.max(f64::from(cosine.acos().to_degrees()));
        }
    }
    difference
}

const GPU: fn() -> [QuadricsGpu; 2] = || [QuadricsGpu::incremental(), QuadricsGpu::brute()];

/// The same, but for as many pixels as a silhouette may have of a thousand hits.
fn check(place: &str, scene: &Scene, camera: Camera, most_apart: usize, error: f64) {
    let view = View::new(camera, 97, 83);
    let expected = ask(&Quadrics::incremental(), scene, &view);
    for method in GPU() {
        let hits = ask(&method, scene, &view);
        let d = difference(&expected, &hits, &view);
        println!("{place}, {}: {d:?}", method.id());
        assert!(d.hits > 500, "{place}, {}: {d:?}", method.id());
        assert!(1000 * d.alone <= 6 * d.hits, "{place}, {}: {d:?}", method.id());
        assert!(1000 * d.apart <= most_apart * d.hits, "{place}, {}: {d:?}", method.id());
        assert!(d.error < error && d.angle < 3.0, "{place}, {}: {d:?}", method.id());
    }
}

#[test]
fn balls_and_tetrahedra_from_everywhere() {
    if adapter::device().is_none() {
        return;
    }
    let at = DVec3::new(3.0, -2.0, 1.0);
    let saddle = Quadric {
        a: DMat3::from_diagonal(DVec3::new(1.0, -1.0, 0.0)),
        b: DVec3::new(0.0, 0.0, -0.5),
        c: 0.0,
    };
    let turn = DMat3::from_rotation_x(0.7) * DMat3::from_rotation_z(0.4);
    let axes = DMat3::from_diagonal(DVec3::new(1.1, 0.9, 1.7));
    let egg = Quadric { a: turn * axes * turn.transpose(), b: DVec3::splat(0.1), c: -1.0 };
    let scenes = [
        ("egg", cubes(at, egg, 1.25, 5, Sides::Front)),
        ("balls", balls(at, 400, 0.2, Blending::None)),
        ("blended", balls(at, 400, 0.2, Blending::Weighted { offset: 0.5 })),
        ("sphere", cubes(at, sphere(1.0), 1.25, 5, Sides::Front)),
        ("saddle", cubes(at, saddle, 0.8, 4, Sides::Both)),
    ];
    for (name, scene) in &scenes {
        let facing = Camera::facing(&scene.domain);
        check(name, scene, facing, 2, 0.01);
        let across = Projection::Orthographic { height: 2.5 };
        check(&format!("{name} across"), scene, Camera { projection: across, ..facing }, 2, 0.01);
        let near = Camera { eye: at + 0.4 * (facing.eye - at), ..facing };
        check(&format!("{name} near"), scene, near, 2, 0.01);
        let towards = (facing.eye - at).normalize();
        // From further away a view's rays, which are in single precision, are no longer apart.
        for distance in [1e3_f64, 3e4] {
            let fov = 2.0 * (1.3 / distance).atan().to_degrees();
            let projection = Projection::Perspective { fov };
            let far = Camera { eye: at + distance * towards, projection, ..facing };
            check(&format!("{name} at {distance}"), scene, far, 6, 0.03);
        }
    }
    // The eye among the tetrahedra, and inside.
    let room = cubes(at, sphere(1.0).inverted(), 1.25, 5, Sides::Front);
    let projection = Projection::Perspective { fov: 90.0 };
    for eye in [DVec3::ZERO, DVec3::new(0.3, 0.2, 0.1)] {
        let at = at + DVec3::X;
        let inside = Camera { eye: room.domain.centre() + eye, at, up: DVec3::Z, projection };
        check("inside", &room, inside, 2, 0.01);
    }
}

#[test]
fn culling_changes_nothing() {
    if adapter::device().is_none() {
        return;
    }
    for scene in [
        balls(DVec3::ZERO, 400, 0.2, Blending::None),
        cubes(DVec3::ZERO, sphere(1.0), 1.25, 5, Sides::Front),
    ] {
        let view = View::new(Camera::facing(&scene.domain), 128, 96);
        let culled = ask(&QuadricsGpu::incremental(), &scene, &view);
        let all = QuadricsGpu { culling: Culling::Fragments, ..QuadricsGpu::incremental() };
        let all = ask(&all, &scene, &view);
        assert_eq!(culled.bracket, all.bracket);
        assert_eq!(culled.normal, all.normal);
    }
}

#[test]
fn sums_of_fewer_bits_lose_digits() {
    if adapter::device().is_none() {
        return;
    }
    let scene = balls(DVec3::ZERO, 400, 0.2, Blending::Weighted { offset: 0.5 });
    let view = View::new(Camera::facing(&scene.domain), 128, 96);
    let expected = ask(&Quadrics::incremental(), &scene, &view);
    let of = |sums| {
        let method = QuadricsGpu { sums, ..QuadricsGpu::incremental() };
        let d = difference(&expected, &ask(&method, &scene, &view), &view);
        println!("{sums:?}: {d:?}");
        d
    };
    let [single, half, byte] = [Format::Single, Format::Half, Format::Byte].map(of);
    assert!(single.error < 1e-4 && single.apart == 0 && single.alone <= 4);
    assert!(half.error < 0.01 && half.angle < 1.0 && half.angle > single.angle);
    assert!(byte.angle > 2.0 * half.angle);
}

#[test]
fn the_papers_formulas_draw_the_same_from_near() {
    if adapter::device().is_none() {
        return;
    }
    let scene = cubes(DVec3::ZERO, sphere(1.0), 1.25, 5, Sides::Front);
    let view = View::new(Camera::facing(&scene.domain), 128, 96);
    let expected = ask(&Quadrics::incremental(), &scene, &view);
    for formula in [Formula::Quotient, Formula::Reciprocal] {
        for method in GPU() {
            let method = QuadricsGpu { formula, ..method };
            let d = difference(&expected, &ask(&method, &scene, &view), &view);
            println!("{formula:?}: {d:?}");
            assert!(1000 * (d.alone + d.apart) <= 10 * d.hits, "{formula:?}: {d:?}");
        }
    }
}

#[test]
fn what_a_device_cannot_draw_is_refused() {
    if adapter::device().is_none() {
        return;
    }
    let blended = Blending::Weighted { offset: 0.5 };
    let scene = balls(DVec3::ZERO, 20, 0.5, blended);
    let zeroset_raycast::Geometry::Patches(patches) = &scene.geometry else { panic!("patches") };
    let both = Patches::new(patches.all().to_vec(), Sides::Both, blended).expect("patches");
    let huge = cubes(DVec3::ZERO, sphere(1e12), 1e12, 1, Sides::Front);
    for scene in [Scene::of_patches("both", both), huge] {
        for method in GPU() {
            assert!(method.supports(&scene).is_err() && method.prepare(&scene).is_err());
        }
    }
    // Offsets without end, and views without end.
    let endless = Blending::Weighted { offset: 1e39 };
    let scene = balls(DVec3::ZERO, 20, 0.5, endless);
    let view = View::new(Camera::facing(&scene.domain), 8, 8);
    ask(&QuadricsGpu::incremental(), &scene, &view);
    let intersector = QuadricsGpu::incremental().prepare(&scene).expect("patches");
    let view = View::new(Camera::facing(&scene.domain), 1 << 15, 1);
    let mut hits = Hits::new(Request::First, 1 << 15);
    assert!(intersector.intersect(Rays::View(&view), &mut hits, &Progress::new()).is_err());
}
