//! Beams on a device: the methods `beam-uniform-gpu` and `beam-adaptive-gpu`.
//!
//! A level of the quadtree is three kernels: `cast` casts the beams of its cells, `scan` counts their
//! quarters, `quarter` writes them, in spatial order, as the next level's cells. How many there are stays on
//! the device, and only the answers are read. With outward rounding, answers are those of the CPU's
//! [`Arithmetic::Device`](crate::Arithmetic::Device), bit for bit.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use bytemuck::{Pod, Zeroable};
use zeroset_cpu::{Implicit, normals};
use zeroset_expr::Parameters;
use zeroset_gpu::bounded;
use zeroset_gpu::device::{
    self, AsBinding, Binding, Bound, Buffer, Clock, Groups, Kernel, Reader, Step,
};
use zeroset_gpu::program::{Module, Numbers, Parts, Trace};
use zeroset_gpu::{Choice, Device, DeviceError};
use zeroset_ia::{Interval, Rounding};
use zeroset_raycast::{
    Camera, Certificate, Domain, Error, Hit, Hits, Intersector, Knob, KnobError, Method, Progress,
    Rays, Report, Request, Sampling, Scene, Unsupported, View, Work, knob,
};

use crate::cast::DEEPEST;
use crate::form::{AffineBeam, Form, Symbol};
use crate::method::{Beam, Enclosure, Refinement, Stop};
use crate::optics::{Optics, Varying};
use crate::prepared;
use crate::quadtree;
use crate::region::Region;

/// Beam casting on a device.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamGpu {
    /// The method's settings; those of lanes have no meaning here.
    pub twin: Beam,
    /// Where it runs.
    pub device: Choice,
    /// Pixels that are cast together, at most, if the first cells are not larger; the image is tiled in bands
    /// of rows. Answers do not depend on it.
    pub band: usize,
}

impl BeamGpu {
    /// The method on the device that `auto` stands for.
    pub fn auto(twin: Beam) -> Self {
        Self { twin, device: Choice::Auto, band: 1 << 22 }
    }

    /// One beam a pixel.
    pub fn uniform() -> Self {
        Self::auto(Beam::uniform())
    }

    /// The quadtree.
    pub fn adaptive() -> Self {
        Self::auto(Beam::adaptive())
    }
}

impl Method for BeamGpu {
    fn id(&self) -> &'static str {
        match self.twin.refinement {
            Refinement::Uniform => "beam-uniform-gpu",
            Refinement::Adaptive => "beam-adaptive-gpu",
        }
    }

    fn summary(&self) -> &'static str {
        match self.twin.refinement {
            Refinement::Uniform => "beam-uniform on the GPU [ganacim2011]",
            Refinement::Adaptive => "beam-adaptive on the GPU [ganacim2011]",
        }
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        self.twin.supports(scene)?;
        // Wrong parameters and domains are for preparing to tell.
        if let Ok(implicit) = Implicit::new(self.id(), scene) {
            check(&self.twin, &implicit)?;
            let view = View::new(Camera::facing(&implicit.domain), 1, 1);
            match Optics::new(&view, &implicit.domain) {
                Ok(Some(optics)) => {
                    optics.check_device()?;
                    shader(&self.twin, &implicit, &optics)?;
                }
                Err(Error::Unsupported(why)) => return Err(why),
                // A view that has rays may come.
                _ => function(&self.twin, &implicit).map(|_| ())?,
            }
        }
        self.find_device()
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        let prepared = PreparedOnDevice::new(self, scene)?;
        // Drivers compile when a kernel first runs, which is part of preparing.
        let view = View::new(Camera::facing(&scene.domain), 1, 1);
        let mut hits = Hits::new(Request::First, 1);
        prepared.intersect(Rays::View(&view), &mut hits, &Progress::new())?;
        Ok(Box::new(prepared))
    }

    fn knobs(&self) -> Vec<Knob> {
        let mut knobs = self.twin.knobs();
        knobs.retain(|knob| !["isa", "arithmetic"].contains(&knob.name));
        knobs.push(device::knob(&self.device));
        knobs
    }

    fn set(&mut self, name: &str, value: &str) -> Result<(), KnobError> {
        match name {
            "device" => self.device = device::read_knob(value)?,
            name if self.knobs().iter().any(|knob| knob.name == name) => {
                self.twin.set(name, value)?;
            }
            _ => return Err(knob::unknown(self.id(), name, &self.knobs())),
        }
        Ok(())
    }

    fn for_precision(&mut self, width: f64, scene: &Scene) {
        self.twin.for_precision(width, scene);
    }

    fn sampling(&self) -> Sampling {
        Sampling::Footprint
    }

    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}

impl BeamGpu {
    /// Is there such a device?
    fn find_device(&self) -> Result<(), Unsupported> {
        Device::open(&self.device).map(|_| ()).map_err(|why| Unsupported(why.to_string()))
    }
}

const CAST: &str = include_str!("shaders/cast.wgsl");
const SCAN: &str = include_str!("shaders/scan.wgsl");
const QUARTER: &str = include_str!("shaders/quarter.wgsl");

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
fn function(method: &Beam, implicit: &Implicit) -> Result<Module, Unsupported> {
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
fn shader(
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

/// [`BeamGpu`] compiled for a scene.
struct PreparedOnDevice {
    method: BeamGpu,
    implicit: Implicit,
    /// What is on the device: kernels for a kind of view, buffers for a size of image.
    state: Mutex<Option<State>>,
}

struct State {
    device: Arc<Device>,
    kernels: Kernels,
    canvas: Option<Canvas>,
}

struct Kernels {
    source: String,
    constants: Buffer<[f32; 4]>,
    cast: Kernel,
    scan: Kernel,
    quarter: Kernel,
}

impl Kernels {
    fn new(device: &Device, module: &Module, kernel: &str) -> Result<Self, Error> {
        let source = module.shader(kernel);
        let values = module.constants();
        let constants = match module.binding() {
            Binding::Uniform => device.uniform(values.len())?,
            Binding::Read | Binding::Write => device.storage(values.len())?,
        };
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

/// The shader's `Settings`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
struct SentSettings {
    low: [f32; 4],
    high: [f32; 4],
    centre_low: [f32; 3],
    squared: f32,
    centre_high: [f32; 3],
    slack: f32,
    fixed: [f32; 3],
    far: f32,
    image: [f32; 2],
    unused: [f32; 2],
}

impl SentSettings {
    fn new(method: &Beam, optics: &Optics, domain: &Domain, image: [usize; 2]) -> Self {
        let region = Region::<f32>::new(domain);
        // Devices may take subnormal numbers for 0: outward.
        let normal = |x: f32, i: usize| match x {
            x if x == 0.0 || x.is_normal() => x,
            x if i == 0 && x < 0.0 => -f32::MIN_POSITIVE,
            x if i == 1 && x > 0.0 => f32::MIN_POSITIVE,
            _ => 0.0,
        };
        let end = |ends: [[f32; 2]; 3], i: usize| ends.map(|ends| normal(ends[i], i));
        let four = |[x, y, z]: [f32; 3]| [x, y, z, 0.0];
        let (centre, squared) =
            region.ball.map_or(([[0.0; 2]; 3], -1.0), |ball| (ball.centre, ball.squared));
        Self {
            low: four(end(region.bounds, 0)),
            high: four(end(region.bounds, 1)),
            centre_low: end(centre, 0),
            squared,
            centre_high: end(centre, 1),
            slack: if method.rounding == Rounding::Nearest { 0.0 } else { optics.slack },
            fixed: optics.fixed.to_array(),
            far: optics.range[1],
            image: image.map(|n| n as f32),
            unused: [0.0; 2],
        }
    }
}

/// The shader's `Level`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
struct SentLevel {
    size: u32,
    exponent: u32,
    number: u32,
    tolerance: f32,
    extent: [u32; 2],
    row: u32,
    width: u32,
}

/// The shader's `Cell`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct SentCell {
    place: u32,
    start: f32,
}

/// The shader's `Answer`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Answer {
    piece: [f32; 2],
    state: u32,
    intervals: u32,
}

const FOUND: u32 = 0x100;
const PROVEN: u32 = 0x200;

/// Invocations in a workgroup of `cast`.
const WORKGROUP: usize = 64;
/// An image's side in pixels, at most: a cell's column and row have 16 bits.
const LONGEST: usize = 1 << 16;

/// The buffers of an image's size, with room for the worst case, that every cell is subdivided.
struct Canvas {
    image: [usize; 2],
    /// The side of the first cells.
    first: u32,
    /// Rows of a band.
    rows: usize,
    settings: Buffer<SentSettings>,
    counts: Buffer<[u32; 4]>,
    begin: Buffer<SentCell>,
    answers: Buffer<Answer>,
    reader: Reader<Answer>,
    levels: Vec<LevelOnDevice>,
    clock: Option<Clock>,
    /// What the device knows: nothing is written twice.
    sent: Option<Told>,
}

/// What a device is told of a band.
#[derive(Clone, Debug, PartialEq)]
struct Told {
    constants: Vec<[f32; 4]>,
    settings: SentSettings,
    tolerance: f64,
    range: [f32; 2],
    row: usize,
}

struct LevelOnDevice {
    size: u32,
    level: Buffer<SentLevel>,
    cast: Bound,
    /// All but the last level have a next one.
    next: Option<[Bound; 2]>,
}

impl Canvas {
    fn new(
        device: &Device,
        kernels: &Kernels,
        method: &BeamGpu,
        image: [usize; 2],
    ) -> Result<Self, Error> {
        let first = method.twin.first(image);
        let side = first as usize;
        // Whole cells of the first level.
        let rows = (method.band / image[0] / side).max(1) * side;
        let rows = rows.min(image[1]);
        let pixels = image[0] * rows;
        if pixels * size_of::<Answer>() > device.largest_binding() as usize {
            return Err(Error::Unsupported(Unsupported(format!(
                "first cells of {first} pixels are too large on this device for an image of {} \
                 columns: set start to less",
                image[0]
            ))));
        }
        let levels = first.ilog2() as usize + 1;
        let settings = device.uniform(1)?;
        let counts = device.counts_of_groups(levels + 1)?;
        let begin = device.storage(image[0].div_ceil(side) * rows.div_ceil(side))?;
        let lists: [Buffer<SentCell>; 2] = [device.storage(pixels)?, device.storage(pixels)?];
        let quarters: Buffer<[u32; 2]> = device.storage(pixels)?;
        let sums: Buffer<u32> = device.storage(pixels.div_ceil(WORKGROUP))?;
        let answers = device.storage(pixels)?;
        let mut all = Vec::with_capacity(levels);
        for number in 0..levels {
            let level: Buffer<SentLevel> = device.uniform(1)?;
            let cells = if number == 0 { &begin } else { &lists[number % 2] };
            let buffers: [&dyn AsBinding; 8] =
                [&kernels.constants, &settings, &level, &counts, cells, &quarters, &sums, &answers];
            let cast = device.bind(&kernels.cast, &buffers)?;
            let next = if number + 1 < levels {
                let scan = device.bind(&kernels.scan, &[&level, &counts, &sums])?;
                let next = &lists[(number + 1) % 2];
                let buffers: [&dyn AsBinding; 6] = [&level, &counts, cells, &quarters, &sums, next];
                Some([scan, device.bind(&kernels.quarter, &buffers)?])
            } else {
                None
            };
            all.push(LevelOnDevice { size: first >> number, level, cast, next });
        }
        let (reader, clock) = (device.reader(pixels)?, device.clock()?);
        let levels = all;
        Ok(Self {
            image,
            first,
            rows,
            settings,
            counts,
            begin,
            answers,
            reader,
            levels,
            clock,
            sent: None,
        })
    }

    /// Is it for this image and method?
    fn fits(&self, method: &BeamGpu, image: [usize; 2]) -> bool {
        self.image == image && self.first == method.twin.first(image)
    }
}

impl PreparedOnDevice {
    fn new(method: &BeamGpu, scene: &Scene) -> Result<Self, Error> {
        let implicit = Implicit::new(method.id(), scene)?;
        check(&method.twin, &implicit)?;
        function(&method.twin, &implicit)?;
        method.find_device()?;
        Ok(Self { method: method.clone(), implicit, state: Mutex::default() })
    }

    /// Casts all beams; the answers are given row by row, band by band.
    fn cast(
        &self,
        state: &mut Option<State>,
        view: &View,
        optics: &Optics,
        progress: &Progress,
        see: &mut dyn FnMut(usize, &[Answer]),
    ) -> Result<Option<Duration>, Error> {
        let image = [view.width, view.height];
        let twin = &self.method.twin;
        let (module, kernel) = shader(twin, &self.implicit, optics)?;
        let source = module.shader(&kernel);
        if !state.as_ref().is_some_and(|s| s.kernels.source == source && !s.device.is_lost()) {
            // What was there makes room first.
            *state = None;
            let device = Device::open(&self.method.device)?;
            let kernels = Kernels::new(&device, &module, &kernel)?;
            *state = Some(State { device, kernels, canvas: None });
        }
        let State { device, kernels, canvas } = state.as_mut().expect("it was just made");
        if !canvas.as_ref().is_some_and(|canvas| canvas.fits(&self.method, image)) {
            *canvas = None;
            *canvas = Some(Canvas::new(device, kernels, &self.method, image)?);
        }
        let canvas = canvas.as_mut().expect("it was just made");
        let settings = SentSettings::new(twin, optics, &self.implicit.domain, image);
        let tolerance = twin.tolerance(view, optics, 1);
        let mut time = None;
        for row in (0..image[1]).step_by(canvas.rows) {
            progress.advance(0)?;
            let rows = canvas.rows.min(image[1] - row);
            let (constants, range) = (module.constants(), optics.range);
            let told = Told { constants, settings, tolerance, range, row };
            if canvas.sent.as_ref() != Some(&told) {
                canvas.sent = None;
                device.write(&kernels.constants, &told.constants)?;
                device.write(&canvas.settings, &[settings])?;
                self.send(device, canvas, view, optics, row, rows)?;
                canvas.sent = Some(told);
            }
            let mut steps = Vec::new();
            for (number, level) in canvas.levels.iter().enumerate() {
                let groups = Groups::Indirect(&canvas.counts, number);
                steps.push(Step { bound: &level.cast, groups });
                if let Some([scan, quarter]) = &level.next {
                    steps.push(Step { bound: scan, groups: Groups::Invocations(1) });
                    steps.push(Step { bound: quarter, groups });
                }
            }
            let elapsed = device.run_sequence(&steps, canvas.clock.as_ref())?;
            time = elapsed.map(|elapsed| elapsed + time.unwrap_or_default());
            let answers = device.read_with(&canvas.reader, &canvas.answers, rows * image[0])?;
            see(row, &answers);
            progress.advance(rows * image[0])?;
        }
        Ok(time)
    }

    /// Tells the device of a band: its first cells and its levels.
    fn send(
        &self,
        device: &Device,
        canvas: &Canvas,
        view: &View,
        optics: &Optics,
        row: usize,
        rows: usize,
    ) -> Result<(), DeviceError> {
        let image = canvas.image;
        let above = row as u32 / canvas.first;
        let cells: Vec<SentCell> =
            quadtree::cells([image[0], rows], canvas.first, optics.range[0].into())
                .into_iter()
                .map(|cell| SentCell {
                    place: cell.column | (cell.row + above) << 16,
                    start: optics.range[0],
                })
                .collect();
        let groups = cells.len().div_ceil(WORKGROUP) as u32;
        let columns = groups.min(65_535);
        let count = [columns, groups.div_ceil(columns), 1, cells.len() as u32];
        device.write(&canvas.begin, &cells)?;
        device.write(&canvas.counts, &[count])?;
        for (number, level) in (0..).zip(&canvas.levels) {
            // A band's last row of cells may reach beyond it, but not beyond the image.
            let sent = SentLevel {
                size: level.size,
                exponent: level.size.ilog2(),
                number,
                tolerance: self.method.twin.tolerance(view, optics, level.size) as f32,
                extent: quadtree::extent(image, (level.size / 2).max(1)),
                row: row as u32,
                width: image[0] as u32,
            };
            device.write(&level.level, &[sent])?;
        }
        Ok(())
    }

    /// Reads the answers of a band, which starts at a row of pixels; gives how many evaluations they cost.
    fn read(
        &self,
        first: u32,
        image: [usize; 2],
        row: usize,
        answers: &[Answer],
        hits: &mut Hits,
    ) -> u64 {
        let mut total = 0;
        let twin = &self.method.twin;
        let width = image[0];
        for (i, answer) in answers.iter().enumerate() {
            let (column, line) = (i % width, i / width);
            // The largest cell with this pixel that was excluded, or the pixel itself.
            let mut exponent = first.ilog2();
            let decided = loop {
                let corner = |n: usize| n >> exponent << exponent;
                let cell = &answers[corner(line) * width + corner(column)];
                if cell.state == exponent || exponent == 0 {
                    break cell;
                }
                exponent -= 1;
            };
            let is_first = |n: usize| n.is_multiple_of(1 << exponent);
            let intervals = if is_first(line) && is_first(column) { answer.intervals } else { 0 };
            total += u64::from(intervals);
            let work = Work { intervals: intervals.into(), ..Work::default() };
            let hit = if decided.state & FOUND == 0 {
                Hit::miss(twin.excluded(), work)
            } else {
                let certificate = twin.found(decided.state & PROVEN != 0);
                Hit { bracket: decided.piece.map(f64::from), certificate, work }
            };
            hits.set(row * width + i, hit);
        }
        total
    }
}

impl Intersector for PreparedOnDevice {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        let mut implicit = self.implicit.clone();
        implicit.set_parameters(values)?;
        check(&self.method.twin, &implicit)?;
        function(&self.method.twin, &implicit)?;
        self.implicit = implicit;
        Ok(())
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        assert_eq!(rays.len(), hits.len(), "one answer a ray");
        let view = prepared::view(self.method.id(), rays)?;
        let image = [view.width, view.height];
        progress.advance(0)?;
        if image.contains(&0) {
            return Ok(Report::default());
        }
        if image[0].max(image[1]) > LONGEST {
            return Err(Error::Unsupported(Unsupported(format!(
                "an image of {} x {} pixels is too large for beams on a device: at most {LONGEST} \
                 a side",
                image[0], image[1]
            ))));
        }
        let mut work = Work::default();
        let Some(optics) = Optics::new(view, &self.implicit.domain)? else {
            let no_ray = Work { nonfinite: 1, ..Work::default() };
            for index in 0..rays.len() {
                hits.set(index, Hit::miss(Certificate::MISS, no_ray));
                work += no_ray;
            }
            progress.advance(rays.len())?;
            return Ok(Report { work, device_time: None });
        };
        optics.check_device()?;
        let first = self.method.twin.first(image);
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let mut intervals = 0;
        let mut see = |row: usize, answers: &[Answer]| {
            intervals += self.read(first, image, row, answers, hits);
        };
        let cast = self.cast(&mut state, view, &optics, progress, &mut see);
        if cast.is_err() {
            // What is there now is not known.
            *state = None;
        }
        work.intervals = intervals;
        let device_time = cast?;
        work += normals::fill(&self.implicit.tape, self.method.twin.normals, rays, hits);
        Ok(Report { work, device_time })
    }
}
