//! Adaptive marching points on the device: the methods `amp-sign-gpu` and `amp-taylor-gpu`.

use std::sync::{Mutex, PoisonError};

use bytemuck::{Pod, Zeroable};
use zeroset_cpu::amp::{Adaptation, Amp, RootTest, Segment, Settings};
use zeroset_cpu::{Implicit, Normals, normals};
use zeroset_expr::{Parameters, Tape};
use zeroset_ia::Rounding;
use zeroset_raycast::{
    Certificate, Certification, Certifier, Clip, Error, Hit, Hits, Intersector, Knob, KnobError,
    Method, Progress, Ray, Rays, Report, Request, Scene, Unsupported, Work, knob,
};

use crate::chunks::{self, Job, Traffic};
use crate::compiled::Compiled;
use crate::device::Choice;
use crate::program::{Module, Numbers};
use crate::settings;

/// The march of [`Amp`] on a device, a ray an invocation: same knobs, same rule for what the paper leaves
/// open, same steps. What differs is what the device's arithmetic may: see `docs/deviations.md`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AmpGpu {
    /// The march; its instruction set has no meaning here.
    pub amp: Amp,
    /// Where it runs.
    pub device: Choice,
}

const KERNEL: &str = concat!(include_str!("shaders/march.wgsl"), include_str!("shaders/amp.wgsl"));

/// The shader's functions: S and its slope along a direction.
pub(crate) fn module(tape: &Tape) -> Result<Module, Unsupported> {
    let mut module = Module::new(Rounding::Nearest);
    module.function("value", tape, Numbers::Plain)?;
    module.function("slope", &tape.slope(), Numbers::Plain)?;
    Ok(module)
}

/// The whole shader of a function, as it is compiled for a device.
///
/// # Errors
/// If an operation has no form on devices.
pub fn shader(tape: &Tape) -> Result<String, Unsupported> {
    Ok(module(tape)?.shader(KERNEL))
}

impl AmpGpu {
    /// The march with a root test, and the default knobs.
    pub fn new(test: RootTest) -> Self {
        Self { amp: Amp { test, ..Amp::default() }, device: Choice::Auto }
    }
}

impl Method for AmpGpu {
    fn id(&self) -> &'static str {
        match self.amp.test {
            RootTest::Sign => "amp-sign-gpu",
            RootTest::Taylor => "amp-taylor-gpu",
        }
    }

    fn summary(&self) -> &'static str {
        match self.amp.test {
            RootTest::Sign => "amp-sign on the GPU [singh2010]",
            RootTest::Taylor => "amp-taylor on the GPU [singh2010]",
        }
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        self.amp.supports(scene)?;
        settings::shader(self.id(), scene, |tape| module(tape).map(|_| ()))?;
        settings::available(&self.device)
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        let implicit = Implicit::new(self.id(), scene)?;
        let published_step = scene.published_step;
        let settings = Settings::new(&self.amp, &implicit, published_step)?;
        let compiled = Compiled::new(&self.device, &module(&implicit.tape)?, KERNEL)?;
        let method = self.clone();
        let compiled = Mutex::new(compiled);
        let prepared = Prepared { method, implicit, published_step, settings, compiled };
        chunks::warm_up(&prepared, &scene.domain)?;
        Ok(Box::new(prepared))
    }

    fn knobs(&self) -> Vec<Knob> {
        settings::knobs(self.amp.knobs(), &self.device)
    }

    fn set(&mut self, name: &str, value: &str) -> Result<(), KnobError> {
        match name {
            "device" => self.device = settings::read_device(value)?,
            name if self.knobs().iter().any(|knob| knob.name == name) => {
                self.amp.set(name, value)?;
            }
            _ => return Err(knob::unknown(self.id(), name, &self.knobs())),
        }
        Ok(())
    }

    fn for_precision(&mut self, width: f64, scene: &Scene) {
        self.amp.for_precision(width, scene);
    }

    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}

struct Prepared {
    method: AmpGpu,
    implicit: Implicit,
    published_step: Option<f64>,
    settings: Settings,
    compiled: Mutex<Compiled>,
}

impl Intersector for Prepared {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        let mut implicit = self.implicit.clone();
        implicit.set_parameters(values)?;
        let settings = Settings::new(&self.method.amp, &implicit, self.published_step)?;
        let compiled = self.compiled.get_mut().unwrap_or_else(PoisonError::into_inner);
        compiled.update(&module(&implicit.tape)?, KERNEL)?;
        (self.settings, self.implicit) = (settings, implicit);
        Ok(())
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        let mut settings = self.settings;
        if hits.request == Request::Any && self.method.amp.test == RootTest::Sign {
            // As on the CPU: the Taylor test knows only when bisection has not refuted the step.
            settings.bisections = 0;
        }
        let mut compiled = self.compiled.lock().unwrap_or_else(PoisonError::into_inner);
        if compiled.is_stale() {
            compiled.update(&module(&self.implicit.tape)?, KERNEL)?;
        }
        let job = Job {
            device: &compiled.device,
            kernel: &compiled.kernel,
            constants: &compiled.constants,
        };
        let amp = &self.method.amp;
        let march = March { amp, implicit: &self.implicit, settings, range: rays.range() };
        let mut report = chunks::cast(&job, &march, rays, hits, progress)?;
        report.work += normals::fill(&self.implicit.tape, Normals::Gradient, rays, hits);
        Ok(report)
    }
}

/// The march as the device is told of it.
struct March<'a> {
    amp: &'a Amp,
    implicit: &'a Implicit,
    settings: Settings,
    range: [f64; 2],
}

/// A ray on its way.
struct Marcher {
    ray: Ray,
    clip: Clip,
    segment: Segment,
}

/// The shader's `March`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct SentMarch {
    step: f32,
    tau1: f32,
    tau2: f32,
    tau3: f32,
    epsilon: f32,
    bisections: u32,
    distance_adaptation: u32,
    silhouette_adaptation: u32,
    test: u32,
    samples: u32,
    unused: [u32; 2],
}

impl SentMarch {
    pub(crate) fn new(test: RootTest, settings: &Settings) -> Self {
        let Settings { step, tau1, tau2, tau3, epsilon, .. } = *settings;
        let [step, tau1, tau2, tau3, epsilon] = [step, tau1, tau2, tau3, epsilon].map(|x| x as f32);
        Self {
            step,
            tau1,
            tau2,
            tau3,
            epsilon,
            bisections: settings.bisections,
            distance_adaptation: (settings.distance_adaptation == Adaptation::On).into(),
            silhouette_adaptation: (settings.silhouette_adaptation == Adaptation::On).into(),
            test: match test {
                RootTest::Sign => 0,
                RootTest::Taylor => 1,
            },
            // Ended by the conversion where they are more than can be counted.
            samples: settings.samples as u32,
            unused: [0; 2],
        }
    }
}

/// The shader's `Settings`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct SentSettings {
    march: SentMarch,
    rays: u32,
    unused: [u32; 3],
}

/// The shader's `Segment`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct SentSegment {
    start: [f32; 3],
    length: f32,
    direction: [f32; 3],
    unused: f32,
}

/// The shader's `Answer`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct SentAnswer {
    bracket: [f32; 2],
    found: u32,
    points: u32,
    gradients: u32,
    nonfinite: u32,
}

impl<'a> Traffic for March<'a> {
    type Ready = Marcher;
    type Sent = SentSegment;
    type Answer = SentAnswer;
    type Settings = SentSettings;
    type Reader = Option<Certifier<'a>>;

    fn ready(&self, ray: Ray) -> Result<Marcher, Hit> {
        let miss =
            |nonfinite| Err(Hit::miss(Certificate::MISS, Work { nonfinite, ..Work::default() }));
        match self.implicit.domain.clip(ray, self.range) {
            None => miss(0),
            Some(clip) => {
                let segment = Segment::new(ray, clip.outer);
                if segment.is_resolved(&self.settings) {
                    Ok(Marcher { ray, clip, segment })
                } else {
                    miss(1)
                }
            }
        }
    }

    fn sent(&self, marcher: &Marcher) -> SentSegment {
        let Segment { start, direction, length, .. } = marcher.segment;
        SentSegment { start, length, direction, unused: 0.0 }
    }

    fn settings(&self, rays: u32) -> SentSettings {
        SentSettings { march: SentMarch::new(self.amp.test, &self.settings), rays, unused: [0; 3] }
    }

    fn reader(&self) -> Option<Certifier<'a>> {
        (self.amp.certify == Certification::On).then(|| Certifier::new(&self.implicit.tape))
    }

    fn read(
        &self,
        certifier: &mut Option<Certifier<'a>>,
        Marcher { ray, clip, segment }: Marcher,
        answer: &SentAnswer,
    ) -> Result<Hit, Marcher> {
        let work = Work {
            points: answer.points.into(),
            gradients: answer.gradients.into(),
            nonfinite: answer.nonfinite.into(),
            ..Work::default()
        };
        if answer.found == 0 {
            return Ok(Hit::miss(Certificate::MISS, work));
        }
        let bracket = answer.bracket.map(|s| segment.t(s.into()));
        let mut hit = Hit { bracket, certificate: Certificate::HIT, work };
        if let Some(certifier) = certifier {
            let slack = self.settings.slack / ray.direction.as_dvec3().length();
            certifier.certify(ray, clip, slack, &mut hit);
        }
        Ok(hit)
    }
}
