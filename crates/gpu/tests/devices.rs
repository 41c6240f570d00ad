//! What can go wrong with devices gives a message, or is mended.

mod adapter;

use glam::{DVec3, Vec3};
use zeroset_expr::{Function, Parameters};
use zeroset_gpu::device::Binding;
use zeroset_gpu::{
    AmpGpu, BisectionGpu, Choice, Device, DeviceError, Frames, Look, Shadows, Surroundings,
};
use zeroset_raycast::{
    Camera, Domain, Error, Hits, Method, Progress, Ray, RayBatch, Rays, Request, Scene, View,
};

fn scene(equation: &str) -> Scene {
    let domain = Domain::new(DVec3::splat(-2.0), DVec3::splat(2.0)).unwrap();
    Scene::new("scene", Function::parse(equation).unwrap(), domain)
}

const LIGHTS: [(Vec3, f32); 1] = [(Vec3::Z, 1.0)];

fn look(background: &[[u8; 3]]) -> Look<'_> {
    Look {
        lights: &LIGHTS,
        shadows: Shadows::On,
        front: Vec3::ONE,
        back: Vec3::ONE,
        surroundings: Surroundings::Rows(background),
    }
}

#[test]
fn unknown_devices_are_named() {
    if adapter::device().is_none() {
        return;
    }
    for wanted in ["no such device", "987654321"] {
        match Device::open(&Choice::read(wanted)) {
            Err(DeviceError::Unknown { wanted: named, known }) => {
                assert_eq!(named, wanted);
                assert!(known.starts_with("0: "), "{known}");
            }
            other => panic!("{other:?}"),
        }
    }
    // A part of the name, in any case, is enough.
    let name = adapter::device().unwrap().report().name.to_uppercase();
    assert!(Device::open(&Choice::Named(name)).is_ok());
}

#[test]
fn without_a_device_no_scene_is_supported() {
    // As on a machine that has none.
    let method = AmpGpu { device: Choice::Named("no such device".into()), ..AmpGpu::default() };
    let scene = scene("x^2+y^2+z^2=1");
    let why = method.supports(&scene).unwrap_err();
    assert!(matches!(method.prepare(&scene), Err(Error::Unsupported(same)) if same == why));
}

#[test]
fn a_lost_device_is_an_error_and_then_opened_anew() {
    if adapter::device().is_none() {
        return;
    }
    // A device of its own: others are in use by other tests.
    let choice = Choice::Named("0".into());
    let method = AmpGpu { device: choice.clone(), ..AmpGpu::default() };
    let scene = scene("x^2+y^2+z^2=1");
    let mut frames = Frames::new(&method, &scene).unwrap();
    let intersector = method.prepare(&scene).unwrap();
    let view = View::new(Camera::facing(&scene.domain), 32, 32);
    let count = || {
        let mut hits = Hits::new(Request::First, 32 * 32);
        intersector.intersect(Rays::View(&view), &mut hits, &Progress::new()).unwrap();
        hits.certificate.iter().filter(|c| c.is_hit()).count()
    };
    let before = count();
    assert!(before > 50);
    let background = [[9, 9, 9]; 32];
    frames.draw(&view, &look(&background), &Progress::new()).unwrap();
    let pixels = frames.pixels().unwrap();

    let lost = Device::open(&choice).unwrap();
    lost.lose();
    match lost.storage::<u32>(16) {
        Err(DeviceError::Lost(..)) => {}
        other => panic!("{other:?}"),
    }
    assert!(matches!(frames.pixels(), Err(Error::Device(_))));
    // Both mend themselves, and frames even if parameters are set first.
    frames.set_parameters(&Parameters::default()).unwrap();
    assert_eq!(count(), before);
    frames.draw(&view, &look(&background), &Progress::new()).unwrap();
    assert_eq!(frames.pixels().unwrap(), pixels);
    assert!(!Device::open(&choice).unwrap().is_lost());
}

#[test]
fn shaders_that_are_none_are_errors() {
    let Some(device) = adapter::device() else { return };
    let error = device.kernel("bad", "fn main() -> nonsense {}", &[Binding::Write]).unwrap_err();
    assert!(matches!(error, DeviceError::Invalid(..)), "{error}");
    // The device is of use as before.
    let buffer = device.storage::<u32>(4).unwrap();
    device.write(&buffer, &[1, 2, 3]).unwrap();
    assert_eq!(device.read(&buffer, 3).unwrap(), [1, 2, 3]);
}

#[test]
fn large_and_empty_requests_are_cut_or_refused() {
    if adapter::device().is_none() {
        return;
    }
    let scene = scene("x^2+y^2+z^2=1");
    let method = AmpGpu::default();
    let intersector = method.prepare(&scene).unwrap();
    // More rays than a chunk, all answered; and none.
    let ray = Ray::new(Vec3::new(0.0, 0.0, -4.0), Vec3::Z);
    for count in [0, 1, (1 << 17) + 1] {
        let batch = RayBatch::new(vec![ray; count]);
        let mut hits = Hits::new(Request::First, count);
        intersector.intersect(Rays::Batch(&batch), &mut hits, &Progress::new()).unwrap();
        assert!(hits.certificate.iter().all(|c| c.is_hit()), "{count}");
    }
    // An image that no buffer holds.
    let mut frames = Frames::new(&method, &scene).unwrap();
    let view = View::new(Camera::facing(&scene.domain), 1 << 20, 1 << 20);
    let background = vec![[0; 3]; 1 << 20];
    let error = frames.draw(&view, &look(&background), &Progress::new()).unwrap_err().to_string();
    assert!(error.contains("MiB"), "{error}");
    assert!(matches!(frames.pixels(), Err(Error::Device(_))));
    // Stopped work ends.
    let progress = Progress::new();
    progress.stop();
    let batch = RayBatch::new(vec![ray; 4096]);
    let mut hits = Hits::new(Request::First, 4096);
    let stopped = intersector.intersect(Rays::Batch(&batch), &mut hits, &progress);
    assert_eq!(stopped, Err(Error::Interrupted));
}

#[test]
fn hostile_functions_and_rays_end_without_a_panic() {
    if adapter::device().is_none() {
        return;
    }
    let rays = [
        Ray::new(Vec3::new(0.0, 0.0, -4.0), Vec3::Z),
        Ray::new(Vec3::new(1e30, 0.0, 0.0), Vec3::X),
        Ray::new(Vec3::new(f32::NAN, 0.0, 0.0), Vec3::X),
        Ray::new(Vec3::ZERO, Vec3::ZERO),
        Ray::new(Vec3::new(0.0, 0.0, -4.0), Vec3::new(1e-40, 0.0, 1.0)),
        Ray::new(Vec3::new(0.0, 0.0, -4.0), Vec3::new(0.0, 0.0, 1e-30)),
        Ray::new(Vec3::new(0.0, 0.0, -4.0), Vec3::new(0.0, 0.0, 1e30)),
    ];
    let batch = RayBatch::new(rays.to_vec());
    for equation in [
        "1/x - y",
        "sqrt(x) - y",
        "log(x) + y",
        "1e38*x^9 - y",
        "1e-45*x - 1e-45*y",
        "tan(9*x) - y",
        "x^-3 - z",
        "exp(exp(exp(x+4))) - y",
    ] {
        let scene = scene(equation);
        for method in [&AmpGpu::default() as &dyn Method, &BisectionGpu::default()] {
            match method.supports(&scene) {
                Ok(()) => {
                    let intersector = method.prepare(&scene).unwrap();
                    let mut hits = Hits::new(Request::FirstWithNormal, rays.len());
                    intersector
                        .intersect(Rays::Batch(&batch), &mut hits, &Progress::new())
                        .unwrap_or_else(|e| panic!("{equation}: {e}"));
                }
                Err(why) => assert!(!why.to_string().is_empty()),
            }
        }
    }
}

#[test]
fn bounds_that_overflow_within_are_refused() {
    // Squares within hypot, and exponents, are no sub-values; the intervals of a device would lose the
    // infinity, and prove a miss.
    for (equation, half, says) in [
        ("hypot(exp(10*x), y) = 2", 5.0, "not bounded"),
        ("hypot(x, y) = 5e19", 1e20, "not bounded"),
        ("x^2 + 1e39*y = 1", 2.0, "too large"),
        ("1/(x^2+1e-9) = y", 2.0, "divisor"),
    ] {
        let half = DVec3::splat(half);
        let domain = Domain::new(-half, half).unwrap();
        let scene = Scene::new(equation, Function::parse(equation).unwrap(), domain);
        let why = BisectionGpu::default().supports(&scene).unwrap_err().to_string();
        assert!(why.contains(says), "{equation}: {why}");
    }
    assert!(
        adapter::device().is_none()
            || BisectionGpu::default().supports(&scene("hypot(x, y) = 1")).is_ok()
    );
}

#[test]
fn functions_that_are_too_long_are_refused() {
    let scene = scene("sum(i, 1, 3000, 1/((x-i/3000)^2+y^2+z^2+1)) = 1000");
    for method in [&AmpGpu::default() as &dyn Method, &BisectionGpu::default()] {
        let why = method.supports(&scene).unwrap_err().to_string();
        assert!(why.contains("too long for a shader"), "{why}");
        assert!(method.prepare(&scene).is_err());
    }
}

#[test]
fn parameters_move_without_a_new_shader() {
    if adapter::device().is_none() {
        return;
    }
    let scene = scene("x^2+y^2+z^2=r^2; r=1");
    let methods: [Box<dyn Method>; 2] =
        [Box::new(AmpGpu::default()), Box::new(BisectionGpu::default())];
    for method in methods {
        let mut intersector = method.prepare(&scene).unwrap();
        let batch = RayBatch::new(vec![Ray::new(Vec3::new(0.0, 0.0, -4.0), Vec3::Z)]);
        for (r, expected) in [("1", 3.0), ("1.5", 2.5), ("0.25", 3.75)] {
            let mut values = Parameters::default();
            values.set("r", r);
            intersector.set_parameters(&values).unwrap();
            let mut hits = Hits::new(Request::First, 1);
            intersector.intersect(Rays::Batch(&batch), &mut hits, &Progress::new()).unwrap();
            assert!(
                (hits.get(0).t() - expected).abs() < 0.01,
                "{}: {:?}",
                method.id(),
                hits.get(0)
            );
        }
        let mut bad = Parameters::default();
        bad.set("r", "nan");
        assert!(intersector.set_parameters(&bad).is_err());
        let mut hits = Hits::new(Request::First, 1);
        intersector.intersect(Rays::Batch(&batch), &mut hits, &Progress::new()).unwrap();
        assert!((hits.get(0).t() - 3.75).abs() < 0.01);
    }
}
