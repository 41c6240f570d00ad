//! Methods of the CPU on a device.

use std::sync::{Mutex, PoisonError};

use zeroset_cpu::{Implicit, Normals, normals};
use zeroset_expr::{Parameters, Tape};
use zeroset_raycast::{
    Error, Hits, Intersector, Knob, KnobError, Method, Progress, Rays, Report, Scene, Unsupported,
    knob,
};

use crate::chunks::{self, Job};
use crate::compiled::Compiled;
use crate::device::{self, Choice, Device};
use crate::program::Module;

/// A method of the CPU with its loop over points or boxes on a device: the same knobs, the same rules for
/// what its paper leaves open. Knobs of lanes have no meaning here.
#[derive(Clone, Debug, PartialEq)]
pub struct OnDevice<T> {
    /// The method's settings.
    pub twin: T,
    /// Where it runs.
    pub device: Choice,
}

impl<T> OnDevice<T> {
    /// The method on the device that `auto` stands for.
    pub fn auto(twin: T) -> Self {
        Self { twin, device: Choice::Auto }
    }

    /// Is there such a device?
    fn find_device(&self) -> Result<(), Unsupported> {
        Device::open(&self.device).map(|_| ()).map_err(|why| Unsupported(why.to_string()))
    }
}

/// A method of the CPU that can run on a device.
pub(crate) trait Twin: Method + Clone + 'static {
    /// What follows from the scene besides the shader.
    type Plan: Send + Sync;
    /// The shader but for its functions.
    fn kernel(&self) -> String;
    /// Id and summary on a device.
    fn names(&self) -> [&'static str; 2];
    /// The shader's functions.
    fn module(&self, tape: &Tape) -> Result<Module, Unsupported>;
    /// What follows from the scene; checks what the shader presupposes.
    fn plan(&self, implicit: &Implicit, published_step: Option<f64>) -> Result<Self::Plan, Error>;
    /// Answers rays, but for normals.
    fn cast(
        &self,
        job: &Job<'_>,
        implicit: &Implicit,
        plan: &Self::Plan,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error>;
    /// How normals are computed.
    fn normals(&self) -> Normals;
}

impl<T: Twin> Method for OnDevice<T> {
    fn id(&self) -> &'static str {
        self.twin.names()[0]
    }

    fn summary(&self) -> &'static str {
        self.twin.names()[1]
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        self.twin.supports(scene)?;
        // Wrong parameters and domains are for preparing to tell.
        if let Ok(implicit) = Implicit::new(self.id(), scene) {
            self.twin.module(&implicit.tape)?;
            if let Err(Error::Unsupported(why)) = self.twin.plan(&implicit, scene.published_step) {
                return Err(why);
            }
        }
        self.find_device()
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        let implicit = Implicit::new(self.id(), scene)?;
        let plan = self.twin.plan(&implicit, scene.published_step)?;
        let module = self.twin.module(&implicit.tape)?;
        self.find_device()?;
        let compiled = Mutex::new(Compiled::new(&self.device, &module, self.twin.kernel())?);
        let twin = self.twin.clone();
        let published_step = scene.published_step;
        let prepared = Prepared { twin, implicit, published_step, plan, compiled };
        chunks::warm_up(&prepared, &scene.domain)?;
        Ok(Box::new(prepared))
    }

    fn knobs(&self) -> Vec<Knob> {
        let of_lanes = ["isa", "packet", "arithmetic", "poles", "delta"];
        let mut knobs = self.twin.knobs();
        knobs.retain(|knob| !of_lanes.contains(&knob.name));
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

    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}

struct Prepared<T: Twin> {
    twin: T,
    implicit: Implicit,
    published_step: Option<f64>,
    plan: T::Plan,
    compiled: Mutex<Compiled>,
}

impl<T: Twin> Intersector for Prepared<T> {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        let mut implicit = self.implicit.clone();
        implicit.set_parameters(values)?;
        let plan = self.twin.plan(&implicit, self.published_step)?;
        let compiled = self.compiled.get_mut().unwrap_or_else(PoisonError::into_inner);
        compiled.update(&self.twin.module(&implicit.tape)?)?;
        (self.plan, self.implicit) = (plan, implicit);
        Ok(())
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        let Self { twin, implicit, plan, .. } = self;
        let mut compiled = self.compiled.lock().unwrap_or_else(PoisonError::into_inner);
        if compiled.is_stale() {
            compiled.update(&twin.module(&implicit.tape)?)?;
        }
        let job = Job {
            device: &compiled.device,
            kernel: &compiled.kernel,
            constants: &compiled.constants,
        };
        let mut report = twin.cast(&job, implicit, plan, rays, hits, progress)?;
        report.work += normals::fill(&implicit.tape, twin.normals(), rays, hits);
        Ok(report)
    }
}
