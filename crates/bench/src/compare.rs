//! Methods on a scene and rays, judged and timed.

use std::time::Duration;

use zeroset_raycast::{Error, Hits, Knob, Method, Progress, Rays, Request, Scene, Work};

use crate::{Judgement, Oracle, Tolerance, Truths};

/// How to compare.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// What is asked of the methods; only answers to [`Request::First`] and
    /// [`Request::FirstWithNormal`] are judged.
    pub request: Request,
    /// Timed frames a method.
    pub runs: usize,
    /// How long the reference may take; beyond, an even subsample is judged. Zero judges nothing.
    pub judging: Duration,
    /// How far from the first root a hit may lie; by default a pixel's footprint for views, and
    /// 1e-3 of the domain's longest side for batches.
    pub tolerance: Option<Tolerance>,
}

impl Default for Options {
    fn default() -> Self {
        Self { request: Request::First, runs: 5, judging: Duration::from_secs(8), tolerance: None }
    }
}

/// What is being done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The reference classifies rays.
    Classify,
    /// A method compiles itself for the scene.
    Prepare(&'static str),
    /// A method answers, to be judged; this warms it up too.
    Answer(&'static str),
    /// A method is timed.
    Time(&'static str),
}

/// Methods compared on a scene and rays.
#[derive(Debug)]
pub struct Comparison {
    /// What is known of the rays; `None` if nothing was judged, and `no_truth` says why.
    pub truths: Option<Truths>,
    /// Why nothing was judged.
    pub no_truth: Option<Error>,
    /// One a method, in order; methods that were not reached are left out.
    pub runs: Vec<Run>,
    /// Was the work asked to stop before all was done?
    pub interrupted: bool,
}

/// A method on a scene and rays.
#[derive(Debug)]
pub struct Run {
    /// The method's id.
    pub method: &'static str,
    /// Its knobs.
    pub knobs: Vec<Knob>,
    /// What came of it.
    pub outcome: Result<Outcome, Error>,
}

/// What a method answered, what that was worth, and how long it took.
#[derive(Debug)]
pub struct Outcome {
    /// The answers.
    pub hits: Hits,
    /// Evaluations of one frame.
    pub work: Work,
    /// Answers by certificate, in the order of `Certificate::ALL`.
    pub certificates: [usize; 6],
    /// The verdicts; `None` if nothing was judged.
    pub judgement: Option<Judgement>,
    /// How long preparing took.
    pub prepare: Duration,
    /// How long frames took; `None` if interrupted before one was timed.
    pub times: Option<Times>,
    /// Time on the device in the median frame, for methods that have one.
    pub device_time: Option<Duration>,
}

/// Times of equal frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Times {
    /// How many.
    pub runs: usize,
    /// The median.
    pub median: Duration,
    /// The shortest.
    pub min: Duration,
    /// The longest.
    pub max: Duration,
}

impl Times {
    /// Millions of rays a second, in the median frame.
    pub fn mrays_per_second(&self, rays: usize) -> f64 {
        rays as f64 / self.median.as_secs_f64() / 1e6
    }
}

/// Runs each method on the scene's rays: prepared, judged, then timed. `watch` is told the stage and
/// how much of it is done, from 0 to 1. A method that fails has its error in its [`Run`]; if
/// `progress` is asked to stop, what is finished is returned.
pub fn compare(
    scene: &Scene,
    rays: Rays<'_>,
    methods: &[Box<dyn Method>],
    options: &Options,
    progress: &Progress,
    watch: &mut dyn FnMut(Stage, f64),
) -> Comparison {
    watch(Stage::Classify, 0.0);
    todo!("{scene:?} {rays:?} {methods:?} {options:?} {progress:?}")
}

/// As [`compare`], judged by another oracle than the reference.
pub fn compare_with(
    oracle: &dyn Oracle,
    scene: &Scene,
    rays: Rays<'_>,
    methods: &[Box<dyn Method>],
    options: &Options,
    progress: &Progress,
    watch: &mut dyn FnMut(Stage, f64),
) -> Comparison {
    let _ = oracle;
    compare(scene, rays, methods, options, progress, watch)
}
