//! Beams on a device: the methods `beam-uniform-gpu` and `beam-adaptive-gpu`.
//!
//! A level of the quadtree is three kernels: `cast` casts the beams of its cells, `scan` counts their
//! quarters, `quarter` writes them, in spatial order, as the next level's cells. How many there are stays on
//! the device, and only the answers are read. With outward rounding, answers are those of the CPU's
//! [`Arithmetic::Device`](crate::Arithmetic::Device), bit for bit.

mod canvas;
mod kernels;
mod prepared;

use zeroset_cpu::Implicit;
use zeroset_gpu::device;
use zeroset_gpu::{Choice, Device};
use zeroset_raycast::{
    Camera, Error, Hits, Intersector, Knob, KnobError, Method, Progress, Rays, Request, Sampling,
    Scene, Unsupported, View, knob,
};

use crate::method::{Beam, Refinement};
use crate::optics::Optics;

pub(crate) use kernels::check;

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
                    kernels::shader(&self.twin, &implicit, &optics)?;
                }
                Err(Error::Unsupported(why)) => return Err(why),
                // A view that has rays may come.
                _ => kernels::function(&self.twin, &implicit).map(|_| ())?,
            }
        }
        self.find_device()
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        let prepared = prepared::PreparedOnDevice::new(self, scene)?;
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
