//! At the extremes of numbers, certificates contradict neither the reference nor closed forms.
//!
//! Spheres and planes, in rational arithmetic: huge and tiny ones, far from the origin, seen from afar,
//! touched to the last unit, through plates, along rays of any length.

mod exactly;

use exactly::{Q, Shape, exact, power_of_ten};
use glam::{DVec3, Vec3};
use num_traits::One;
use zeroset_beam::{Beam, Enclosure, Stop};
use zeroset_bench::{Class, Registry, judge::lie};
use zeroset_cpu::{Arithmetic, Bisection, Reference};
use zeroset_expr::Function;
use zeroset_raycast::{
    Camera, Certificate, Domain, Error, Hits, Method, Progress, Projection, Ray, RayBatch, Rays,
    Request, Sampling, Scene, View,
};

/// How many answers of each kind were given, by all methods together.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    rays: usize,
    proven: usize,
    hits: usize,
    decided: usize,
    /// Hits of whole pixels that beams proved.
    whole: usize,
}

fn scene(equation: &str, min: DVec3, max: DVec3) -> Scene {
    let function = Function::parse(equation).unwrap_or_else(|e| panic!("{}", e.render()));
    Scene::new(equation, function, Domain::new(min, max).expect("it is a box"))
}

fn cube(equation: &str, half: f64) -> Scene {
    scene(equation, DVec3::splat(-half), DVec3::splat(half))
}

fn sphere(centre: [f64; 3], radius: Q) -> Shape {
    Shape::Sphere { centre: centre.map(exact), radius }
}

fn ask(method: &dyn Method, scene: &Scene, rays: Rays<'_>) -> Hits {
    let intersector = method.prepare(scene).unwrap_or_else(|e| panic!("{}: {e}", scene.id));
    let mut hits = Hits::new(Request::First, rays.len());
    let report = intersector.intersect(rays, &mut hits, &Progress::new());
    report.unwrap_or_else(|e| panic!("{}: {e}", scene.id));
    hits
}

fn is_double(method: &dyn Method) -> bool {
    method.knobs().iter().any(|knob| knob.name == "arithmetic" && knob.value == "double")
}

/// Judges the reference by the closed form, and every method by both.
fn check(scene: &Scene, shape: &Shape, rays: Vec<Ray>) -> Count {
    let batch = RayBatch::new(rays);
    let rays = Rays::Batch(&batch);
    // The default width is for domains of the size of 1.
    let width = Reference::default().width * scene.domain.longest_side().min(1.0);
    let reference = Reference { width, ..Reference::default() };
    let oracle = reference.prepare_reference(scene).expect("it is a function");
    let all: Vec<usize> = (0..rays.len()).collect();
    let truths = oracle.classify(rays, &all, &Progress::new()).expect("truths");
    let roots: Vec<_> = batch.rays.iter().map(|ray| shape.roots(*ray, &scene.domain)).collect();
    let mut count = Count { rays: rays.len(), ..Count::default() };
    for (i, truth) in truths.iter().enumerate() {
        let fault = roots[i].as_ref().and_then(|roots| roots.contradicts(*truth));
        let place = format!("{}: {:?}: {truth:?}", scene.id, rays.get(i));
        assert_eq!(fault, None, "{place}");
        count.decided += usize::from(truth.class != Class::Undecidable);
    }
    // Not every method supports domains beyond single precision.
    // The bisections in double precision too.
    let double = [Bisection::kmarch(), Bisection::tbisect(), Bisection::mitchell()]
        .map(|method| Bisection { arithmetic: Arithmetic::Double, ..method });
    let double = double.iter().map(|method| method as &dyn Method);
    // Beams that prove hits of whole pixels.
    let beams = [Enclosure::Interval, Enclosure::Affine].map(|enclosure| Beam {
        enclosure,
        stop: Stop::Seen,
        ..Beam::adaptive()
    });
    let beams = beams.iter().map(|method| method as &dyn Method);
    let registry = Registry::standard();
    let certified = registry.certified();
    let certified = certified.iter().map(AsRef::as_ref);
    let methods = registry.iter().chain(double).chain(beams).chain(certified);
    for method in methods.filter(|method| method.supports(scene).is_ok()) {
        if method.sampling() == Sampling::Footprint {
            let mut camera = Camera::facing(&scene.domain);
            if method.knobs().iter().any(|knob| knob.name == "stop" && knob.value == "seen") {
                // Only pixels that are small to the surface see nothing else.
                camera.projection = Projection::Perspective { fov: 12.0 };
            }
            count.whole += check_pixels(method, scene, shape, camera);
            continue;
        }
        let hits = ask(method, scene, rays);
        for (i, truth) in truths.iter().enumerate() {
            let hit = hits.get(i);
            let place = || format!("{} on {}: {:?}: {hit:?}", method.id(), scene.id, rays.get(i));
            let fault = roots[i].as_ref().and_then(|roots| roots.contradiction(hit));
            assert_eq!(fault, None, "{}", place());
            assert_eq!(lie(hit, *truth), None, "{}, {truth:?}", place());
            if method.id() == "kmarch" && !is_double(method) {
                count.hits += usize::from(hit.certificate.is_hit());
                let proofs = [Certificate::PROVEN_HIT, Certificate::PROVEN_MISS];
                count.proven += usize::from(proofs.contains(&hit.certificate));
            }
        }
    }
    count
}

/// Judges a method that answers for whole pixels by the closed form, on 16 rays of each; gives how many hits of
/// whole pixels are proven.
fn check_pixels(method: &dyn Method, scene: &Scene, shape: &Shape, camera: Camera) -> usize {
    let view = View::new(camera, 9, 7);
    let intersector = method.prepare(scene).unwrap_or_else(|e| panic!("{}: {e}", scene.id));
    let mut hits = Hits::new(Request::First, 63);
    match intersector.intersect(Rays::View(&view), &mut hits, &Progress::new()) {
        // Cameras can be too far away.
        Err(Error::Unsupported(_)) => return 0,
        answered => answered.map(|_| ()).unwrap_or_else(|e| panic!("{}: {e}", scene.id)),
    }
    for i in 0..63 {
        let (column, row) = ((i % 9) as f64, (i / 9) as f64);
        for k in 0..16 {
            let (u, v) = (f64::from(k % 4) / 3.0, f64::from(k / 4) / 3.0);
            let ray = view.ray_at(column + u, row + v);
            if !ray.is_valid() {
                // The domain is beyond single precision.
                assert_eq!(hits.certificate[i], Certificate::MISS, "{}", method.id());
                continue;
            }
            let roots = shape.roots(ray, &scene.domain);
            let fault = roots.and_then(|roots| roots.contradiction(hits.get(i)));
            let place = format!("{} on {}: {ray:?}: {:?}", method.id(), scene.id, hits.get(i));
            assert_eq!(fault, None, "{place}");
        }
    }
    hits.certificate.iter().filter(|c| **c == Certificate::PROVEN_HIT).count()
}

/// Rays towards a cube around a point, from outside, inside and along axes.
fn towards(centre: DVec3, half: f64) -> Vec<Ray> {
    let mut rays = Vec::new();
    for i in 0..40 {
        let z = (f64::from(i) + 0.5) / 20.0 - 1.0;
        let (sin, cos) = (2.4 * f64::from(i)).sin_cos();
        let (from, to) = (DVec3::new(cos, sin, z), DVec3::new(sin, 0.3 * z, cos));
        let outside = centre + 3.0 * half * from;
        let inside = centre + 0.6 * half * to;
        rays.push(Ray::new(outside.as_vec3(), (inside - outside).as_vec3()));
        rays.push(Ray::new(inside.as_vec3(), from.as_vec3()));
        let axis = i as usize % 3;
        let mut beside = inside;
        beside[axis] = centre[axis] - 3.0 * half;
        rays.push(Ray::new(beside.as_vec3(), Vec3::AXES[axis]));
    }
    rays
}

#[test]
fn equations_of_any_scale() {
    for power in [-50_i32, -12, -3, 3, 12, 50] {
        let scene = cube(&format!("1e{power}*(x^2 + y^2 + z^2 - 1)"), 1.5);
        let count = check(&scene, &sphere([0.0; 3], Q::one()), towards(DVec3::ZERO, 1.5));
        assert_eq!(count.decided, count.rays, "{power}: {count:?}");
        assert!(2 * count.hits > count.rays && count.proven == count.rays, "{power}: {count:?}");
        // Single precision has no 1e-50.
        assert!(count.whole > 5 || power.abs() > 12, "{power}: {count:?}");
    }
}

#[test]
fn domains_of_any_scale() {
    for power in [-30, -12, -3, 3, 12, 30] {
        let half = 1.5 * 10_f64.powi(power);
        let scene = cube(&format!("x^2 + y^2 + z^2 - (1e{power})^2"), half);
        let shape = sphere([0.0; 3], power_of_ten(power));
        let count = check(&scene, &shape, towards(DVec3::ZERO, half));
        assert!(20 * count.decided >= 19 * count.rays, "{power}: {count:?}");
        assert!(3 * count.hits > count.rays, "{power}: {count:?}");
    }
}

#[test]
fn domains_beyond_single_precision() {
    for power in [50, 100] {
        let half = 1.5 * 10_f64.powi(power);
        let scene = cube(&format!("x^2 + y^2 + z^2 - (1e{power})^2"), half);
        let shape = sphere([0.0; 3], power_of_ten(power));
        // Rays reach it from inside alone.
        let directions =
            [Vec3::X, -Vec3::Z, Vec3::new(0.3, -0.0, 1.0), Vec3::new(1e-30, 1e30, 1.0)];
        let rays = directions.map(|d| Ray::new(Vec3::new(1.0, -2.0, 3e30), d)).to_vec();
        let count = check(&scene, &shape, rays);
        assert_eq!(count.hits, count.rays, "{power}: {count:?}");
    }
}

#[test]
fn far_from_the_origin() {
    for centre in [DVec3::new(1e6, -2e6, 3e6), DVec3::new(0.0, 0.0, 16_777_216.0)] {
        let DVec3 { x, y, z } = centre;
        let equation = format!("(x-({x}))^2 + (y-({y}))^2 + (z-({z}))^2 - 100");
        let scene = scene(&equation, centre - 15.0, centre + 15.0);
        let shape = sphere(centre.to_array(), exact(10.0));
        let count = check(&scene, &shape, towards(centre, 15.0));
        assert_eq!(count.decided, count.rays, "{count:?}");
        assert!(2 * count.hits > count.rays, "{count:?}");
    }
}

#[test]
fn seen_from_afar() {
    let scene = cube("x^2 + y^2 + z^2 - 1", 1.5);
    for distance in [1e3, 3e6, 1e12] {
        let camera = Camera::facing(&scene.domain);
        let eye = distance * camera.eye.normalize();
        let fov = (4.0 / distance).to_degrees();
        let wide = Camera { eye, projection: Projection::Perspective { fov }, ..camera };
        let flat = Camera { projection: Projection::Orthographic { height: 4.0 }, ..wide };
        for camera in [wide, flat] {
            let view = View::new(camera, 12, 12);
            let rays: Vec<_> = (0..144).map(|i| Rays::View(&view).get(i)).collect();
            let count = check(&scene, &sphere([0.0; 3], Q::one()), rays);
            assert_eq!(count.decided, count.rays, "{distance}: {count:?}");
            assert!(distance > 1e4 || 6 * count.hits > count.rays, "{distance}: {count:?}");
        }
    }
}

#[test]
fn directions_of_any_length() {
    let scene = cube("x^2 + y^2 + z^2 - 1", 1.5);
    for scale in [1e-38, 1e-30, 1e-10, 1e10, 1e30, 1e38_f32] {
        let of = |ray: Ray| Ray::new(ray.origin, scale * ray.direction.normalize());
        let rays = towards(DVec3::ZERO, 1.5).into_iter().map(of).collect();
        let count = check(&scene, &sphere([0.0; 3], Q::one()), rays);
        assert!(2 * count.hits > count.rays, "{scale:e}: {count:?}");
    }
}

#[test]
fn rays_that_touch_to_the_last_unit() {
    let mut rays = Vec::new();
    for steps in -3..4_i32 {
        let x = f32::from_bits(1_f32.to_bits().wrapping_add_signed(steps));
        for k in 0..3 {
            for sign in [1.0, -1.0] {
                let mut origin = Vec3::ZERO;
                origin[k] = sign * x;
                origin[(k + 1) % 3] = -3.0;
                rays.push(Ray::new(origin, Vec3::AXES[(k + 1) % 3]));
                // 3-4-5: from (3x, 4x, 0)/5 across.
                let foot = Vec3::new(0.6 * x, sign * 0.8 * x, 0.0);
                let along = Vec3::new(-sign * 0.8, 0.6, 0.0);
                rays.push(Ray::new(foot - 2.0 * along, along));
            }
        }
    }
    for equation in ["x^2 + y^2 + z^2 - 1", "sqrt(x^2 + y^2 + z^2) - 1", "(x^2 + y^2 + z^2 - 1)^2"]
    {
        let count = check(&cube(equation, 1.5), &sphere([0.0; 3], Q::one()), rays.clone());
        let is_polynomial = !equation.starts_with("sqrt");
        assert!(!is_polynomial || count.decided == count.rays, "{equation}: {count:?}");
    }
}

#[test]
fn roots_of_any_multiplicity() {
    let tenth = Shape::Plane { normal: [1.0, 0.0, 0.0].map(exact), offset: power_of_ten(-1) };
    let quarter = Shape::Plane { normal: [1.0, 2.0, -1.0].map(exact), offset: exact(0.25) };
    for (equation, shape) in [
        ("(x-0.1)^2", &tenth),
        ("(x-0.1)^3", &tenth),
        ("abs(x-0.1)", &tenth),
        ("(x-0.1)*exp(y)", &tenth),
        ("(x+2*y-z-1/4)^2", &quarter),
        ("(x+2*y-z-1/4)^5", &quarter),
        ("-(x+2*y-z-1/4)^4/(1+y^2)", &quarter),
    ] {
        let count = check(&cube(equation, 1.0), shape, towards(DVec3::ZERO, 1.0));
        assert!(3 * count.hits > count.rays, "{equation}: {count:?}");
    }
}

#[test]
fn rays_that_start_on_the_surface() {
    let mut rays = Vec::new();
    for k in 0..3 {
        for ray in towards(DVec3::ZERO, 1.5) {
            rays.push(Ray::new(Vec3::AXES[k], ray.direction));
            rays.push(Ray::new(-Vec3::AXES[k], ray.direction));
        }
    }
    let count = check(&cube("x^2 + y^2 + z^2 - 1", 1.5), &sphere([0.0; 3], Q::one()), rays.clone());
    assert_eq!((count.hits, count.decided), (count.rays, count.rays), "{count:?}");
    let plane = Shape::Plane { normal: [1.0; 3].map(exact), offset: Q::one() };
    rays.retain(|ray| ray.origin.min_element() >= 0.0);
    let count = check(&cube("x + y + z = 1", 1.5), &plane, rays);
    assert_eq!((count.hits, count.decided), (count.rays, count.rays), "{count:?}");
}

#[test]
fn thin_plates() {
    for half in [1e-3, 1e-9, 1e-20] {
        let (min, max) = (DVec3::new(-1.5, -1.5, -half), DVec3::new(1.5, 1.5, half));
        let scene = scene("x^2 + y^2 + z^2 - 1", min, max);
        let mut rays = towards(DVec3::ZERO, 1.5);
        for ray in towards(DVec3::ZERO, 1.0) {
            let flat = Vec3::new(ray.direction.x, ray.direction.y, -0.0);
            rays.push(Ray::new(Vec3::new(ray.origin.x, ray.origin.y, 0.0), flat));
            // Across the plate where the sphere stands on it.
            let foot = Vec3::new(ray.origin.x, ray.origin.y, 0.0).normalize();
            rays.push(Ray::new(foot + ray.direction, -ray.direction));
        }
        rays.retain(|ray| ray.is_valid());
        let count = check(&scene, &sphere([0.0; 3], Q::one()), rays);
        assert!(4 * count.hits > count.rays, "{half:e}: {count:?}");
        assert!(10 * count.decided > 9 * count.rays, "{half:e}: {count:?}");
    }
}

#[test]
fn what_is_no_ray_is_missed_and_harms_no_neighbour() {
    let scene = cube("x^2 + y^2 + z^2 - 1", 1.5);
    let good = towards(DVec3::ZERO, 1.5);
    let mut mixed = Vec::new();
    for (i, ray) in good.iter().enumerate() {
        let (mut bad, value) = (*ray, [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][i / 3 % 3]);
        match i % 3 {
            0 => bad.origin[i % 2] = value,
            1 => bad.direction[i % 2] = value,
            _ => bad.direction = Vec3::new(0.0, -0.0, 0.0),
        }
        mixed.extend([bad, *ray]);
    }
    let (good, mixed) = (RayBatch::new(good), RayBatch::new(mixed));
    let registry = Registry::standard();
    let of_rays = registry.iter().filter(|method| method.sampling() == Sampling::Ray);
    for method in of_rays.filter(|method| method.supports(&scene).is_ok()) {
        let alone = ask(method, &scene, Rays::Batch(&good));
        let among = ask(method, &scene, Rays::Batch(&mixed));
        for i in 0..alone.len() {
            assert_eq!(among.get(2 * i + 1), alone.get(i), "{}", method.id());
            let bad = among.get(2 * i);
            assert_eq!(bad.certificate, Certificate::MISS, "{}: {bad:?}", method.id());
            assert_eq!(bad.work.nonfinite, 1, "{}: {bad:?}", method.id());
        }
    }
}
