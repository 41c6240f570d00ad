//! Methods and intersectors.

use std::fmt::Debug;
use std::time::Duration;

use zeroset_expr::Parameters;

use crate::{Error, GeometryKind, Hits, Knob, KnobError, Progress, Rays, Scene, Unsupported, Work};

/// What a ray stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// Itself.
    Ray,
    /// The footprint of its pixel: answers hold for a beam.
    Footprint,
}

/// An algorithm and its knobs, a plain value. Preparing it for a scene is timed apart.
pub trait Method: Debug + Send + Sync {
    /// Its name: the algorithm in kebab-case, with `-gpu` if it runs there.
    fn id(&self) -> &'static str;
    /// One line: what it is, with the paper's key.
    fn summary(&self) -> &'static str;
    /// The kind of geometry that it is for.
    fn geometry(&self) -> GeometryKind {
        GeometryKind::Function
    }
    /// Can it handle the scene?
    ///
    /// # Errors
    /// [`Unsupported`] says what it lacks.
    fn supports(&self, scene: &Scene) -> Result<(), Unsupported>;
    /// Compiles itself for a scene.
    ///
    /// # Errors
    /// If the scene is unsupported, or its domain or parameters are invalid.
    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error>;
    /// The knobs and their values.
    fn knobs(&self) -> Vec<Knob>;
    /// Sets a knob: the command line's `METHOD.knob=value`.
    ///
    /// # Errors
    /// If there is no such knob, or it does not take the value.
    fn set(&mut self, knob: &str, value: &str) -> Result<(), KnobError>;
    /// Sets the knobs so that brackets are at most `width` wide in t, if the method can.
    fn for_precision(&mut self, width: f64, scene: &Scene);
    /// What a ray stands for.
    fn sampling(&self) -> Sampling {
        Sampling::Ray
    }
    /// A copy.
    fn boxed(&self) -> Box<dyn Method>;
}

/// A method compiled for one scene.
///
/// The answer for a ray depends on that ray alone: not on the others, their order or the threads.
pub trait Intersector: Send + Sync {
    /// New values for the equation's parameters, without preparing again.
    ///
    /// # Errors
    /// If a name is unknown or a value is no finite constant; the old values then stay.
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error>;
    /// Answers each ray, as `hits.request` asks. Rays that are no rays are counted and missed.
    ///
    /// # Errors
    /// If the rays are unsupported, or the work was asked to stop.
    ///
    /// # Panics
    /// If `hits` has not as many entries as there are rays.
    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error>;
}

/// What a request cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Evaluations by kind.
    pub work: Work,
    /// Time on the device, for methods that have one.
    pub device_time: Option<Duration>,
}
