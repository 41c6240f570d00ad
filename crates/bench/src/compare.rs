//! Methods on a scene and rays, judged and timed.

use std::time::{Duration, Instant};

use zeroset_raycast::{
    Certificate, Error, Hits, Intersector, Knob, Method, Progress, RayBatch, Rays, Request,
    Sampling, Scene, Work,
};

use crate::{Footprints, Judgement, Oracle, Sample, Tolerance, Truth, Truths, judge, truth};

/// How to compare.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// What is asked of the methods; answers to [`Request::Any`] are not judged.
    pub request: Request,
    /// Timed frames a method, at most.
    pub runs: usize,
    /// How long the timed frames of a method may take together; one is always timed.
    pub timing: Duration,
    /// A method is left out if a frame would take longer, by the rays of a sample.
    pub frame: Option<Duration>,
    /// How long the reference may take; beyond, an even subsample is judged. Zero judges nothing.
    pub judging: Duration,
    /// Where an even subsample starts: at the first ray for 0.
    pub seed: u64,
    /// How far from the first root a hit may lie; by default a pixel's footprint for views, and
    /// 1e-3 of the domain's longest side for batches.
    pub tolerance: Option<Tolerance>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            request: Request::First,
            runs: 5,
            timing: Duration::from_secs(5),
            frame: None,
            judging: Duration::from_secs(8),
            seed: 0,
            tolerance: None,
        }
    }
}

impl Options {
    fn is_judged(&self) -> bool {
        self.request != Request::Any && !self.judging.is_zero()
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
    /// What is known of the rays; `None` if no method was judged by it.
    pub truths: Option<Truths>,
    /// What is known of the pixels, for methods whose answers hold for them; `None` if there were none, or
    /// nothing was judged.
    pub footprints: Option<Truths>,
    /// Why the reference has no answer, if it was asked and has none.
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
    /// What its answers hold for, and are judged by.
    pub sampling: Sampling,
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
    /// How long frames took; `None` if none was timed.
    pub times: Option<Times>,
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
    /// Time on the device in the median frame, for methods that have one.
    pub device: Option<Duration>,
}

impl Times {
    /// The times of frames and of the device in them; `None` if there are none.
    fn of(frames: &mut [(Duration, Option<Duration>)]) -> Option<Self> {
        frames.sort();
        let middle = [frames.len().checked_sub(1)? / 2, frames.len() / 2];
        let [(a, device_a), (b, device_b)] = middle.map(|i| frames[i]);
        let median = (a + b) / 2;
        let device = device_a.zip(device_b).map(|(a, b)| (a + b) / 2);
        Some(Self {
            runs: frames.len(),
            median,
            min: frames[0].0,
            max: frames[frames.len() - 1].0,
            device,
        })
    }

    /// Millions of rays a second, in the median frame.
    pub fn mrays_per_second(&self, rays: usize) -> f64 {
        rays as f64 / self.median.as_secs_f64() / 1e6
    }
}

impl Outcome {
    /// How many rays hit.
    pub fn hit_count(&self) -> usize {
        self.hits.certificate.iter().filter(|c| c.is_hit()).count()
    }
}

/// Runs each method on the scene's rays: prepared, judged against the reference, then timed.
///
/// `watch` is told the stage and how much of it is done, from 0 to 1. A method that fails has its
/// error in its [`Run`]. If `progress` is asked to stop, what is finished is returned. Work is spread
/// over the current pool of threads.
pub fn compare(
    scene: &Scene,
    rays: Rays<'_>,
    methods: &[Box<dyn Method>],
    options: &Options,
    progress: &Progress,
    watch: &mut dyn FnMut(Stage, f64),
) -> Comparison {
    let known = match options.is_judged().then(|| truth::reference(scene)).transpose() {
        Ok(Some(oracle)) => Known::of(&oracle, rays, methods, options, progress, watch),
        Ok(None) => Ok(Known::default()),
        Err(error) => Err(error),
    };
    run_all(known, scene, rays, methods, options, progress, watch)
}

/// As [`compare`], but judged against another oracle than the reference.
pub fn compare_with(
    oracle: &dyn Oracle,
    scene: &Scene,
    rays: Rays<'_>,
    methods: &[Box<dyn Method>],
    options: &Options,
    progress: &Progress,
    watch: &mut dyn FnMut(Stage, f64),
) -> Comparison {
    let known = if options.is_judged() {
        Known::of(oracle, rays, methods, options, progress, watch)
    } else {
        Ok(Known::default())
    };
    run_all(known, scene, rays, methods, options, progress, watch)
}

/// What is known of rays, and of pixels.
#[derive(Default)]
struct Known {
    rays: Option<Truths>,
    footprints: Option<Truths>,
}

impl Known {
    /// What these methods are judged by.
    fn of(
        oracle: &dyn Oracle,
        rays: Rays<'_>,
        methods: &[Box<dyn Method>],
        options: &Options,
        progress: &Progress,
        watch: &mut dyn FnMut(Stage, f64),
    ) -> Result<Self, Error> {
        let has = |sampling| methods.iter().any(|method| method.sampling() == sampling);
        let mut ask = |oracle: &dyn Oracle| {
            classify(oracle, rays, options.judging, options.seed, progress, watch)
        };
        let has_footprints = has(Sampling::Footprint) && matches!(rays, Rays::View(_));
        Ok(Self {
            rays: has(Sampling::Ray).then(|| ask(oracle)).transpose()?,
            footprints: has_footprints.then(|| ask(&Footprints(oracle))).transpose()?,
        })
    }
}

/// Each method, judged against what is known.
fn run_all(
    known: Result<Known, Error>,
    scene: &Scene,
    rays: Rays<'_>,
    methods: &[Box<dyn Method>],
    options: &Options,
    progress: &Progress,
    watch: &mut dyn FnMut(Stage, f64),
) -> Comparison {
    let (known, no_truth) = match known {
        Ok(known) => (known, None),
        Err(error) => (Known::default(), Some(error)),
    };
    let mut runs = Vec::new();
    let tolerance = options.tolerance.unwrap_or(match rays {
        Rays::View(_) => Tolerance::Footprint,
        Rays::Batch(_) => Tolerance::Distance(1e-3 * scene.domain.longest_side()),
    });
    for method in methods {
        if progress.is_stopped() {
            break;
        }
        let sampling = method.sampling();
        let truths = match sampling {
            Sampling::Ray => &known.rays,
            Sampling::Footprint => &known.footprints,
        };
        let judge =
            |hits: &Hits| truths.as_ref().map(|truths| judge(rays, hits, truths, tolerance));
        let outcome = run(method.as_ref(), scene, rays, options, &judge, progress, watch);
        if matches!(outcome, Err(Error::Interrupted)) {
            break;
        }
        runs.push(Run { method: method.id(), sampling, knobs: method.knobs(), outcome });
    }
    let Known { rays: truths, footprints } = known;
    Comparison { truths, footprints, no_truth, runs, interrupted: progress.is_stopped() }
}

/// The truth on ever finer grids, up to all rays, as long as the next is expected to fit the budget.
fn classify(
    oracle: &dyn Oracle,
    rays: Rays<'_>,
    budget: Duration,
    seed: u64,
    progress: &Progress,
    watch: &mut dyn FnMut(Stage, f64),
) -> Result<Truths, Error> {
    /// Rays in the first grid, at least.
    const FIRST: usize = 64;
    watch(Stage::Classify, 0.0);
    // Rays at a time, so that progress is seen and all threads have enough to do.
    let chunk = 256 * rayon::current_num_threads();
    let start = Instant::now();
    let mut known: Vec<Option<Truth>> = vec![None; rays.len()];
    let mut count = 0;
    let mut sample = Sample::coarsest(FIRST, seed, rays);
    loop {
        let new: Vec<_> = sample.indices.iter().copied().filter(|i| known[*i].is_none()).collect();
        for indices in new.chunks(chunk) {
            let truths = oracle.classify(rays, indices, progress)?;
            for (&index, truth) in indices.iter().zip(truths) {
                known[index] = Some(truth);
            }
            count += indices.len();
            watch(Stage::Classify, count as f64 / rays.len() as f64);
        }
        let Some(finer) = sample.finer(rays) else { break };
        let expected = start.elapsed().as_secs_f64() / count as f64 * finer.indices.len() as f64;
        if expected > budget.as_secs_f64() {
            break;
        }
        sample = finer;
    }
    watch(Stage::Classify, 1.0);
    // Every grid holds the coarser ones, so all that is known is in the last.
    Ok(Truths { sample, truths: known.into_iter().flatten().collect() })
}

/// One method: prepared, judged, timed.
fn run(
    method: &dyn Method,
    scene: &Scene,
    rays: Rays<'_>,
    options: &Options,
    judge: &dyn Fn(&Hits) -> Option<Judgement>,
    progress: &Progress,
    watch: &mut dyn FnMut(Stage, f64),
) -> Result<Outcome, Error> {
    let id = method.id();
    watch(Stage::Prepare(id), 0.0);
    let start = Instant::now();
    let intersector = method.prepare(scene)?;
    let prepare = start.elapsed();

    watch(Stage::Answer(id), 0.0);
    if let Some(limit) = options.frame {
        let expected = expected_time(intersector.as_ref(), rays, options, progress)?;
        if expected > limit {
            return Err(Error::TooSlow(format!(
                "left out: a frame would take about {} s; name the method to run it all the same",
                expected.as_secs()
            )));
        }
    }
    let mut hits = Hits::new(options.request, rays.len());
    let report = intersector.intersect(rays, &mut hits, progress)?;
    let judgement = judge(&hits);

    let mut frames = Vec::with_capacity(options.runs);
    let mut again = Hits::new(options.request, rays.len());
    let timing = Instant::now();
    for i in 0..options.runs {
        if i > 0 && timing.elapsed() > options.timing {
            break;
        }
        watch(Stage::Time(id), i as f64 / options.runs as f64);
        let start = Instant::now();
        match intersector.intersect(rays, &mut again, progress) {
            Ok(report) => frames.push((start.elapsed(), report.device_time)),
            // What was judged and timed so far is worth keeping.
            Err(Error::Interrupted) => break,
            Err(error) => return Err(error),
        }
    }
    watch(Stage::Time(id), 1.0);
    let certificates =
        Certificate::ALL.map(|c| hits.certificate.iter().filter(|given| **given == c).count());
    let times = Times::of(&mut frames);
    Ok(Outcome { hits, work: report.work, certificates, judgement, prepare, times })
}

/// How long a frame will take, from an even sample of its rays; nothing for methods that need a view.
fn expected_time(
    intersector: &dyn Intersector,
    rays: Rays<'_>,
    options: &Options,
    progress: &Progress,
) -> Result<Duration, Error> {
    /// Rays in the sample, about.
    const PROBE: usize = 256;
    let step = rays.len().div_ceil(PROBE).max(1);
    // Not aligned with the rows of a view.
    let sample: Vec<_> = (0..rays.len()).step_by(step | 1).map(|i| rays.get(i)).collect();
    let mut hits = Hits::new(options.request, sample.len());
    let batch = RayBatch { rays: sample, range: rays.range() };
    let start = Instant::now();
    match intersector.intersect(Rays::Batch(&batch), &mut hits, progress) {
        Ok(_) if !batch.rays.is_empty() => {
            Ok(start.elapsed().mul_f64(rays.len() as f64 / batch.rays.len() as f64))
        }
        Ok(_) | Err(Error::Unsupported(_)) => Ok(Duration::ZERO),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_an_even_number_lies_between_the_middle_two() {
        let ms = Duration::from_millis;
        assert_eq!(Times::of(&mut []), None);
        let times = Times::of(&mut [(ms(9), None), (ms(1), None), (ms(2), None)]).unwrap();
        assert_eq!((times.min, times.median, times.max), (ms(1), ms(2), ms(9)));
        let times = Times::of(&mut [(ms(8), Some(ms(6))), (ms(4), Some(ms(2)))]).unwrap();
        assert_eq!((times.median, times.device), (ms(6), Some(ms(4))));
    }
}
