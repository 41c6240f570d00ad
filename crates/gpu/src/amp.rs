//! Adaptive marching points on the device: the methods `amp-sign-gpu` and `amp-taylor-gpu`.

use bytemuck::{Pod, Zeroable};
use zeroset_cpu::amp::{Adaptation, Amp, RootTest, Segment, Settings};
use zeroset_cpu::{Implicit, Normals};
use zeroset_expr::Tape;
use zeroset_ia::Rounding;
use zeroset_raycast::{
    Certificate, Certification, Certifier, Clip, Error, Hit, Hits, Progress, Ray, Rays, Report,
    Request, Unsupported, Work,
};

use crate::chunks::{self, Job, Traffic};
use crate::program::{Module, Numbers};
use crate::twin::{OnDevice, Twin};

/// The march of [`Amp`] on a device, a ray an invocation: same steps. What differs is what the device's
/// arithmetic may: see `docs/deviations.md`.
pub type AmpGpu = OnDevice<Amp>;

impl Default for AmpGpu {
    fn default() -> Self {
        Self::auto(Amp::default())
    }
}

impl AmpGpu {
    /// The march with a root test, and the default knobs.
    pub fn new(test: RootTest) -> Self {
        Self::auto(Amp { test, ..Amp::default() })
    }
}

const KERNEL: &str = concat!(include_str!("shaders/march.wgsl"), include_str!("shaders/amp.wgsl"));

/// The shader's functions: S and its slope along a direction.
pub(crate) fn module(tape: &Tape) -> Result<Module, Unsupported> {
    let mut module = Module::new(Rounding::Nearest);
    module.function("value", tape, Numbers::Plain)?;
    module.function("slope", &tape.slope(), Numbers::Plain)?;
    Ok(module)
}

/// What the compiler is told of the march besides, so that it leaves out what is not done.
pub(crate) fn known(amp: &Amp) -> String {
    format!(
        "const TAYLOR = {};\nconst DISTANCE_ADAPTATION = {};\nconst SILHOUETTE_ADAPTATION = {};\n",
        amp.test == RootTest::Taylor,
        amp.distance_adaptation == Adaptation::On,
        amp.silhouette_adaptation == Adaptation::On,
    )
}

/// The whole shader of a function, as it is compiled for a device.
///
/// # Errors
/// If an operation has no form on devices.
pub fn shader(amp: &Amp, tape: &Tape) -> Result<String, Unsupported> {
    Ok(module(tape)?.shader(&amp.kernel()))
}

impl Twin for Amp {
    type Plan = Settings;

    fn kernel(&self) -> String {
        known(self) + KERNEL
    }

    fn names(&self) -> [&'static str; 2] {
        match self.test {
            RootTest::Sign => ["amp-sign-gpu", "amp-sign on the GPU [singh2010]"],
            RootTest::Taylor => ["amp-taylor-gpu", "amp-taylor on the GPU [singh2010]"],
        }
    }

    fn module(&self, tape: &Tape) -> Result<Module, Unsupported> {
        module(tape)
    }

    fn plan(&self, implicit: &Implicit, published_step: Option<f64>) -> Result<Settings, Error> {
        Settings::new(self, implicit, published_step)
    }

    fn cast(
        &self,
        job: &Job<'_>,
        implicit: &Implicit,
        settings: &Settings,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        let mut settings = *settings;
        if hits.request == Request::Any && self.test == RootTest::Sign {
            // As on the CPU: the Taylor test knows only when bisection has not refuted the step.
            settings.bisections = 0;
        }
        let march = March { amp: self, implicit, settings, range: rays.range() };
        chunks::cast(job, &march, rays, hits, progress)
    }

    fn normals(&self) -> Normals {
        Normals::Gradient
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
    samples: u32,
    unused: u32,
}

impl SentMarch {
    pub(crate) fn new(settings: &Settings) -> Self {
        let Settings { step, tau1, tau2, tau3, epsilon, .. } = *settings;
        let [step, tau1, tau2, tau3, epsilon] = [step, tau1, tau2, tau3, epsilon].map(|x| x as f32);
        Self {
            step,
            tau1,
            tau2,
            tau3,
            epsilon,
            bisections: settings.bisections,
            // Ended by the conversion where they are more than can be counted.
            samples: settings.samples as u32,
            unused: 0,
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
        SentSettings { march: SentMarch::new(&self.settings), rays, unused: [0; 3] }
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
