//! Quadrics on a device, rasterised: the methods `quadric-gpu` and `quadric-brute-gpu`.
//!
//! Bounds are drawn as instances, the square around a ball's disc or the faces of a tetrahedron; what is
//! linear over them is worked out at their corners. Where a scene blends, three passes are drawn: visibility,
//! weighted sums, and means (\[stoll2006\] Section 5.1.1).

mod buffers;
mod painter;
mod prepared;

use std::ops::RangeInclusive;
use std::sync::Arc;

use zeroset_gpu::device::{self, Format};
use zeroset_gpu::{Choice, Device};
use zeroset_raycast::{
    Blending, Error, GeometryKind, Intersector, Knob, KnobError, Method, Patches, Scene, Sides,
    Unsupported, knob,
};

use crate::method::{FORMULAS, Staging, patches};
use crate::piece::Formula;

/// Quadrics in bounds, drawn by a device.
#[derive(Clone, Debug, PartialEq)]
pub struct QuadricsGpu {
    /// Incremental: what is linear over a bound's shape on the screen is worked out at its corners, and patches
    /// turned away are culled. Brute: all is worked out for each fragment, and nothing is culled.
    pub staging: Staging,
    /// Default: local.
    pub formula: Formula,
    /// What weighted sums are kept in. Default: single; the paper compares half and byte.
    pub sums: Format,
    /// Whether patches turned away are culled. Default: as the staging says.
    pub culling: Culling,
    /// Where it runs.
    pub device: Choice,
}

/// What becomes of patches that surely show their inside alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Culling {
    /// They are not drawn.
    Patches,
    /// Each of their fragments finds out.
    Fragments,
}

/// Radii of scenes: squares of what is much smaller are numbers still.
const SIZES: RangeInclusive<f64> = 1e-9..=1e9;
const SUMS: [(&str, Format); 3] =
    [("single", Format::Single), ("half", Format::Half), ("byte", Format::Byte)];
const CULLINGS: [(&str, Culling); 2] =
    [("patches", Culling::Patches), ("fragments", Culling::Fragments)];

impl QuadricsGpu {
    /// The method `quadric-gpu`, on the device that `auto` stands for.
    pub fn incremental() -> Self {
        Self {
            staging: Staging::Incremental,
            formula: Formula::Local,
            sums: Format::Single,
            culling: Culling::Patches,
            device: Choice::Auto,
        }
    }

    /// The method `quadric-brute-gpu`.
    pub fn brute() -> Self {
        Self { staging: Staging::Brute, culling: Culling::Fragments, ..Self::incremental() }
    }

    /// The device, if it can do what is asked.
    fn open(&self, patches: &Patches) -> Result<Arc<Device>, Unsupported> {
        let device = Device::open(&self.device).map_err(|why| Unsupported(why.to_string()))?;
        let is_blended = patches.blending() != Blending::None;
        if is_blended && patches.sides() == Sides::Both {
            let why = "devices blend one root of a ball: both sides are for surfaces that are not blended";
            return Err(Unsupported(why.into()));
        }
        let radius = patches.domain().radius();
        if !SIZES.contains(&radius) {
            return Err(Unsupported(format!(
                "a scene of radius {radius:e} is out of the range of single precision: scale it to between \
                 {:e} and {:e}",
                SIZES.start(),
                SIZES.end()
            )));
        }
        if is_blended && self.sums == Format::Single && !device.adds_singles() {
            return Err(Unsupported(format!(
                "the device {} cannot add numbers of 32 bits: set sums=half",
                device.report().name
            )));
        }
        Ok(device)
    }
}

impl Method for QuadricsGpu {
    fn id(&self) -> &'static str {
        match self.staging {
            Staging::Incremental => "quadric-gpu",
            Staging::Brute => "quadric-brute-gpu",
        }
    }

    fn summary(&self) -> &'static str {
        match self.staging {
            Staging::Incremental => {
                "quadrics in bounds rasterised on the GPU, incrementally [stoll2006]"
            }
            Staging::Brute => "the same with everything in the fragment stage [stoll2006]",
        }
    }

    fn geometry(&self) -> GeometryKind {
        GeometryKind::Patches
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        self.open(patches(self.id(), scene)?).map(|_| ())
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        let patches = patches(self.id(), scene)?;
        self.open(patches)?;
        Ok(Box::new(prepared::PreparedOnDevice::new(self, Arc::clone(patches))))
    }

    fn knobs(&self) -> Vec<Knob> {
        vec![
            Knob {
                name: "formula",
                value: knob::name(&FORMULAS, &self.formula),
                doc: "local (about the ray's point beside the patch's middle, without cancellation), or the paper's about the eye: quotient (Eq. 7) or reciprocal (Eq. 15); default local",
            },
            Knob {
                name: "sums",
                value: knob::name(&SUMS, &self.sums),
                doc: "what weighted sums are kept in where a scene blends: single, half or byte (default single)",
            },
            Knob {
                name: "culling",
                value: knob::name(&CULLINGS, &self.culling),
                doc: "patches (those turned away are not drawn) or fragments (each finds out); default patches, but fragments for quadric-brute-gpu",
            },
            device::knob(&self.device),
        ]
    }

    fn set(&mut self, name: &str, value: &str) -> Result<(), KnobError> {
        match name {
            "formula" => self.formula = knob::choice(name, value, &FORMULAS)?,
            "sums" => self.sums = knob::choice(name, value, &SUMS)?,
            "culling" => self.culling = knob::choice(name, value, &CULLINGS)?,
            "device" => self.device = device::read_knob(value)?,
            _ => return Err(knob::unknown(self.id(), name, &self.knobs())),
        }
        Ok(())
    }

    /// Roots come in closed form.
    fn for_precision(&mut self, _: f64, _: &Scene) {}

    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}
