//! Interval programs on a device give what they give on the CPU.

mod adapter;

use zeroset_expr::{Parameters, Tape};
use zeroset_gpu::BisectionGpu;
use zeroset_gpu::device::{AsBinding, Binding, Device};
use zeroset_gpu::program::{Module, Numbers};
use zeroset_ia::{Interval, Mirror, Rounding};
use zeroset_raycast::catalogue::Catalogue;
use zeroset_raycast::{Geometry, Method};

const KERNEL: &str = "
@group(0) @binding(1) var<storage, read> boxes: array<array<vec2f, 3>>;
@group(0) @binding(2) var<storage, read_write> values: array<vec2f>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&boxes) {
        let b = boxes[id.x];
        values[id.x] = value(b[0], b[1], b[2]);
    }
}
";

type Cuboid = [[f32; 2]; 3];

/// The enclosures of a function over boxes, computed on the device.
fn enclosures(device: &Device, tape: &Tape, boxes: &[Cuboid]) -> Option<Vec<[f32; 2]>> {
    let mut module = Module::new(Rounding::Outward);
    module.function("value", tape, Numbers::Interval).ok()?;
    let bindings = [module.binding(), Binding::Read, Binding::Write];
    let kernel = device.kernel("value", &module.shader(KERNEL), &bindings).unwrap();
    let values = module.constants();
    let constants = match module.binding() {
        Binding::Uniform => device.uniform(values.len()).unwrap(),
        _ => device.storage(values.len()).unwrap(),
    };
    device.write(&constants, &values).unwrap();
    let inputs = device.storage::<Cuboid>(boxes.len()).unwrap();
    device.write(&inputs, boxes).unwrap();
    let outputs = device.storage::<[f32; 2]>(boxes.len()).unwrap();
    let bound: [&dyn AsBinding; 3] = [&constants, &inputs, &outputs];
    device.run(&kernel, &bound, boxes.len()).unwrap();
    Some(device.read(&outputs, boxes.len()).unwrap())
}

/// Boxes of many sizes in a domain.
fn boxes(min: [f32; 3], max: [f32; 3]) -> Vec<Cuboid> {
    let mut state = 7_u64;
    let mut random = move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1 << 24) as f32
    };
    (0..1024)
        .map(|_| {
            let size = (-20.0 * random()).exp2();
            [0, 1, 2].map(|axis| {
                let side = (max[axis] - min[axis]) * size;
                let lo = min[axis] + random() * (max[axis] - min[axis] - side);
                [lo, (lo + side).max(lo)]
            })
        })
        .collect()
}

#[test]
fn programs_are_the_mirror_bit_for_bit() {
    let Some(device) = adapter::device() else { return };
    // Other devices may round otherwise; then both still enclose the value.
    let is_exact = device.report().kind == "software";
    let (mut surfaces, mut compared) = (0, 0);
    for surface in Catalogue::builtin().iter() {
        let scene = surface.scene().unwrap();
        let Geometry::Implicit(function) = &scene.geometry else { continue };
        let tape = function.tape(&scene.parameters, 128).unwrap();
        let corner = |v: glam::DVec3| v.as_vec3().to_array();
        let boxes = boxes(corner(scene.domain.min), corner(scene.domain.max));
        let Some(values) = enclosures(&device, &tape, &boxes) else { continue };
        let mut evaluator = tape.evaluator(&Interval::<Mirror>::point(Mirror(0.0)));
        let mut exact = tape.evaluator(&Interval::<f64>::point(0.0));
        // Where the method would not claim anything, nor does this.
        let trusted = BisectionGpu::default().supports(&scene).is_ok();
        let mut finite = 0;
        for (b, [lo, hi]) in boxes.iter().zip(values) {
            let expected = evaluator
                .evaluate(b.map(|[lo, hi]| Interval::<Mirror>::new(Mirror(lo), Mirror(hi))));
            let expected = expected.bounds().map(|x| x.0);
            let middle = b.map(|[lo, hi]| Interval::point(0.5 * (f64::from(lo) + f64::from(hi))));
            let inside = exact.evaluate(middle);
            if !expected.into_iter().all(f32::is_finite) || !inside.lo.is_finite() {
                // Beyond the precondition.
                continue;
            }
            finite += 1;
            if is_exact {
                let bits = [lo, hi].map(f32::to_bits);
                assert_eq!(bits, expected.map(f32::to_bits), "{}: {b:?}", scene.id);
            }
            assert!(
                !trusted || f64::from(lo) <= inside.hi && inside.lo <= f64::from(hi),
                "{}: {b:?} [{lo}, {hi}] {inside:?}",
                scene.id
            );
        }
        surfaces += 1;
        compared += finite;
    }
    assert!(surfaces >= 65 && compared > 1000 * 60, "{surfaces} surfaces, {compared} boxes");
}

#[test]
fn parameters_are_constants_in_a_buffer() {
    let function = zeroset_expr::Function::parse("a*x^2+y^2-b; a=2; b=0.1").unwrap();
    let mut sources = Vec::new();
    let mut constants = Vec::new();
    for a in ["2", "0.3"] {
        let mut values = Parameters::default();
        values.set("a", a);
        let tape = function.tape(&values, 128).unwrap();
        let mut module = Module::new(Rounding::Outward);
        module.function("value", &tape, Numbers::Interval).unwrap();
        sources.push(module.shader(""));
        constants.push(module.constants());
    }
    assert_eq!(sources[0], sources[1]);
    assert_ne!(constants[0], constants[1]);
}
