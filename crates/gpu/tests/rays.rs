//! The ray's own arithmetic on a device is rounded outward: the product and the sum that make a point.

mod adapter;

use zeroset_gpu::device::{AsBinding, Binding};
use zeroset_gpu::program::Module;
use zeroset_ia::Rounding;

const BISECTION: &str = include_str!("../src/shaders/tbisect.wgsl");

const KERNEL: &str = "
@group(0) @binding(1) var<storage, read> rays: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> points: array<vec2f>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&rays) {
        let r = rays[id.x];
        points[id.x] = coordinate(r.x, r.x, vec2f(r.y, r.y), r.z);
    }
}
";

#[test]
fn points_of_a_ray_are_enclosed() {
    let Some(device) = adapter::device() else { return };
    let from = BISECTION.find("fn coordinate(").unwrap();
    let to = from + BISECTION[from..].find("@compute").unwrap();
    let module = Module::new(Rounding::Outward);
    let source = module.shader(&format!("{}{KERNEL}", &BISECTION[from..to]));
    let kernel =
        device.kernel("rays", &source, &[Binding::Uniform, Binding::Read, Binding::Write]).unwrap();
    let mut state = 7_u64;
    let mut random = move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1 << 24) as f32
    };
    // Base, t, direction.
    let rays: Vec<[f32; 4]> = (0..1 << 14)
        .map(|_| [4.0 * random() - 2.0, 8.0 * random(), 2.0 * random() - 1.0, 0.0])
        .collect();
    let constants = device.uniform(1).unwrap();
    device.write(&constants, &module.constants()).unwrap();
    let sent = device.storage(rays.len()).unwrap();
    device.write(&sent, &rays).unwrap();
    let points = device.storage::<[f32; 2]>(rays.len()).unwrap();
    let bound: [&dyn AsBinding; 3] = [&constants, &sent, &points];
    device.run(&kernel, &bound, rays.len()).unwrap();
    for ([base, t, direction, _], [lo, hi]) in
        rays.iter().zip(device.read(&points, rays.len()).unwrap())
    {
        // The product is exact in double precision, and the sum far more so than in single.
        let [base, t, direction] = [base, t, direction].map(|x| f64::from(*x));
        let point = base + t * direction;
        let slack = 1e-14 * (base.abs() + (t * direction).abs());
        let [lo, hi] = [lo, hi].map(f64::from);
        assert!(lo <= point + slack && point - slack <= hi, "{base} {t} {direction}: {lo} {hi}");
        assert!(hi - lo <= 1e-5, "{base} {t} {direction}: {lo} {hi}");
    }
}
