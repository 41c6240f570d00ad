//! The kernels: functions recorded from the CPU's, and the text that calls them.

use zeroset_cpu::Implicit;
use zeroset_gpu::Device;
use zeroset_gpu::bounded;
use zeroset_gpu::device::{Binding, Buffer, Kernel};
use zeroset_gpu::program::{Module, Numbers, Parts, Trace};
use zeroset_ia::Interval;
use zeroset_raycast::{Error, Unsupported};

use crate::cast::DEEPEST;
use crate::form::{AffineBeam, Form, Symbol};
use crate::method::{Beam, Enclosure, Stop};
use crate::optics::{Optics, Varying};

const CAST: &str =
    concat!(include_str!("../shaders/level.wgsl"), include_str!("../shaders/cast.wgsl"));
const SCAN: &str = concat!(
    "const INVOCATIONS = 256u;\n",
    include_str!("../shaders/level.wgsl"),
    include_str!("../shaders/prefix.wgsl"),
    include_str!("../shaders/scan.wgsl"),
);
const QUARTER: &str = concat!(
    "const INVOCATIONS = 64u;\n",
    include_str!("../shaders/level.wgsl"),
    include_str!("../shaders/prefix.wgsl"),
    include_str!("../shaders/quarter.wgsl"),
);

/// What the shader computes with.
fn numbers(method: &Beam) -> Numbers {
    match method.enclosure {
        Enclosure::Interval => Numbers::Interval,
        Enclosure::Affine => Numbers::Affine,
    }
}

/// May a device's numbers be trusted on a scene?
pub(crate) fn check(method: &Beam, implicit: &Implicit) -> Result<(), Unsupported> {
    match method.enclosure {
        Enclosure::Interval => bounded::check(&implicit.tape, &implicit.domain),
        Enclosure::Affine => bounded::check_affine(&implicit.tape, &implicit.domain),
    }
}

/// The shader's functions so far: F.
pub(super) fn function(method: &Beam, implicit: &Implicit) -> Result<Module, Unsupported> {
    let mut module = Module::new(method.rounding);
    module.function("value", &implicit.tape, numbers(method))?;
    Ok(module)
}

/// Adds what the shader does with forms, as the CPU does.
fn record<N: Form<Trace> + Parts>(module: &mut Module) {
    let interval = |x: &[Trace]| Interval::<Trace>::new(x[0], x[1]);
    let (one, form) = (1, N::WIDTH);
    let first = |x: &[Trace]| N::from_parts(&x[..form]);
    for (name, symbol) in [("form_u", Symbol::U), ("form_v", Symbol::V), ("form_t", Symbol::T)] {
        module.record(name, &[2], |x| N::variable(interval(x), symbol));
    }
    module.record("form_point", &[one], |x| N::point(x[0]));
    module.record("form_widened", &[form, one], |x| first(x).widened(x[form]));
    module.record("form_along", &[form, form, form], |x| {
        let [direction, t] = [form, 2 * form].map(|at| N::from_parts(&x[at..at + form]));
        first(x).along(direction, t)
    });
    module.record("form_cut", &[form, 2], |x| first(x).cut(x[form], x[form + 1]));
    module.record("form_range", &[form], |x| {
        let [lo, hi] = first(x).range();
        Interval::<Trace>::new(lo, hi)
    });
}

/// All of the shader's functions, and the text of the kernel that calls them.
pub(super) fn shader(
    method: &Beam,
    implicit: &Implicit,
    optics: &Optics,
) -> Result<(Module, String), Unsupported> {
    let mut module = function(method, implicit)?;
    for (name, tape) in ["lens_x", "lens_y", "lens_z"].into_iter().zip(&optics.tapes) {
        module.function(name, tape, numbers(method))?;
    }
    match method.enclosure {
        Enclosure::Interval => record::<Interval<Trace>>(&mut module),
        Enclosure::Affine => record::<AffineBeam<Trace>>(&mut module),
    }
    let sees = method.stop == Stop::Seen && implicit.tape.is_continuous();
    let constants = format!(
        "alias Form = {};\nconst PERSPECTIVE = {};\nconst SEES = {sees};\nconst DEEPEST = {DEEPEST}u;\n",
        numbers(method).type_name(),
        optics.varying == Varying::Direction
    );
    let kernel = constants + CAST;
    Ok((module, kernel))
}

pub(super) struct Kernels {
    pub(super) source: String,
    pub(super) constants: Buffer<[f32; 4]>,
    pub(super) cast: Kernel,
    pub(super) scan: Kernel,
    pub(super) quarter: Kernel,
}

impl Kernels {
    pub(super) fn new(device: &Device, module: &Module, kernel: &str) -> Result<Self, Error> {
        let source = module.shader(kernel);
        let constants = module.buffer(device)?;
        use Binding::{Read, Uniform, Write};
        let bindings = [module.binding(), Uniform, Uniform, Read, Read, Write, Write, Write];
        Ok(Self {
            cast: device.kernel("beams", &source, &bindings)?,
            scan: device.kernel("scan", SCAN, &[Uniform, Write, Write])?,
            quarter: device.kernel(
                "quarter",
                QUARTER,
                &[Uniform, Read, Read, Read, Read, Write],
            )?,
            constants,
            source,
        })
    }
}
