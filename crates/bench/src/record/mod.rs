//! Records: one row a run.

mod table;

use std::time::Duration;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use zeroset_gpu::{Choice, device};
use zeroset_raycast::{Camera, Domain, Projection, Rays, Sampling, Scene, View, Work};

use crate::machine::now;
use crate::{Class, Comparison, Machine, Run, Tally, Verdict};

pub use table::{RecordError, append, json, read, write};

/// What a comparison does not know of itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Context {
    /// The equation as given.
    pub equation: String,
    /// The shared knob, if used: the bracket width that was asked for.
    pub precision: Option<f64>,
    /// The revision of the program.
    pub revision: String,
}

/// One run as one row. Numbers are printed so that they read back exactly.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// When, in UTC: `2026-01-31T12:34:56Z`.
    pub date: String,
    /// The revision of the program.
    pub revision: String,
    /// The processor's name.
    pub cpu: String,
    /// The instruction set that lanes use.
    pub isa: String,
    /// The device that the method ran on, with its driver; empty if it has none.
    pub device: String,
    /// The operating system and architecture.
    pub os: String,
    /// Worker threads.
    pub threads: usize,
    /// The scene's id.
    pub scene: String,
    /// The equation.
    pub equation: String,
    /// Parameters set away from their defaults: `a=0.3; b=1`.
    pub parameters: String,
    /// The box's corners, and the ball's radius if there is one: `x0,y0,z0,x1,y1,z1[,r]`.
    pub domain: String,
    /// `eye=x,y,z,at=x,y,z,up=x,y,z` and `fov=DEGREES` or `ortho=HEIGHT`; empty for a batch.
    pub camera: String,
    /// Pixels in a row; for a batch, rays.
    pub width: usize,
    /// Rows; for a batch, 1.
    pub height: usize,
    /// The method's id.
    pub method: String,
    /// Its knobs: `depth=10; rounding=outward`.
    pub knobs: String,
    /// The bracket width asked for with the shared knob, in t.
    pub precision: Option<f64>,
    /// What was asked of the method: `first`, `first-with-normal` or `any`; empty if it failed.
    pub request: String,
    /// `ok`, or why there is no answer.
    pub outcome: String,
    /// Time to prepare, milliseconds.
    pub prepare_ms: Option<f64>,
    /// Timed frames.
    pub runs: usize,
    /// Median time of a frame, milliseconds.
    pub median_ms: Option<f64>,
    /// Shortest time of a frame, milliseconds.
    pub min_ms: Option<f64>,
    /// Longest time of a frame, milliseconds.
    pub max_ms: Option<f64>,
    /// Time on the device in the median frame, milliseconds.
    pub device_ms: Option<f64>,
    /// Millions of rays a second in the median frame.
    pub mrays_per_second: Option<f64>,
    /// Function values at points, all rays.
    pub points: u64,
    /// Values with derivatives, all rays.
    pub gradients: u64,
    /// Interval enclosures, all rays.
    pub intervals: u64,
    /// Evaluations that gave NaN or infinity, and rays that are no rays.
    pub nonfinite: u64,
    /// Answers with this certificate.
    pub proven_hit: usize,
    /// Answers with this certificate.
    pub possible_hit: usize,
    /// Answers with this certificate.
    pub root_hit: usize,
    /// Answers with this certificate.
    pub hit: usize,
    /// Answers with this certificate.
    pub proven_miss: usize,
    /// Answers with this certificate.
    pub miss: usize,
    /// Every how many-th ray (pixel, in both axes) was judged; 0 if none.
    pub judged_step: usize,
    /// The seed of where they start.
    pub seed: u64,
    /// How many were judged.
    pub judged: usize,
    /// Judged rays whose first root is a crossing.
    pub transversal: usize,
    /// Judged rays whose first root is a touch.
    pub tangential: usize,
    /// Judged rays without a root.
    pub rootless: usize,
    /// Judged rays whose truth is not known.
    pub undecidable: usize,
    /// Hits within the tolerance of the first root.
    pub correct_hits: usize,
    /// Misses where there is no root.
    pub correct_misses: usize,
    /// Misses where there is a crossing.
    pub false_misses_transversal: usize,
    /// Misses where there is a touch.
    pub false_misses_tangential: usize,
    /// Hits where there is no root, or none so early.
    pub false_hits: usize,
    /// Pixels without a root, nor one in any neighbouring pixel; known if all pixels were judged.
    pub clear_misses: Option<usize>,
    /// False hits among these.
    pub clear_false_hits: Option<usize>,
    /// Hits away from the first root.
    pub wrong_sheets: usize,
    /// Answers whose truth is not known.
    pub undecided: usize,
    /// Certificates that the truth contradicts.
    pub lies: usize,
    /// Median distance from the first root along the ray, in units of space.
    pub median_dt: Option<f64>,
    /// Greatest distance from the first root along the ray, in units of space.
    pub worst_dt: Option<f64>,
}

impl Record {
    /// One record for each run of a comparison of these rays, with the current date.
    pub fn of(
        comparison: &Comparison,
        scene: &Scene,
        rays: Rays<'_>,
        machine: &Machine,
        context: &Context,
    ) -> Vec<Self> {
        let mut shared = Self {
            date: now(),
            revision: context.revision.clone(),
            cpu: machine.cpu.clone(),
            isa: machine.isa.clone(),
            os: machine.os.clone(),
            threads: machine.threads,
            scene: scene.id.clone(),
            equation: context.equation.clone(),
            parameters: pairs(scene.parameters.iter()),
            domain: domain_text(&scene.domain),
            width: rays.len(),
            height: 1,
            precision: context.precision,
            ..Self::default()
        };
        if let Rays::View(view) = rays {
            shared.camera = view.camera().to_string();
            (shared.width, shared.height) = (view.width, view.height);
        }
        let row = |run: &Run| {
            let mut row = shared.clone();
            let truths = match run.sampling {
                Sampling::Ray => &comparison.truths,
                Sampling::Footprint => &comparison.footprints,
            };
            if let Some(truths) = truths {
                row.judged_step = truths.sample.step;
                row.seed = truths.sample.seed;
            }
            row.with_run(run)
        };
        comparison.runs.iter().map(row).collect()
    }

    fn with_run(mut self, run: &Run) -> Self {
        self.method = run.method.into();
        self.knobs = pairs(run.knobs.iter().map(|k| (k.name, k.value.as_str())));
        if let Some(knob) = run.knobs.iter().find(|knob| knob.name == "device") {
            self.device = device::find(&Choice::read(&knob.value))
                .map(|device| format!("{}, {}", device.name, device.driver))
                .unwrap_or_default();
        }
        let outcome = match &run.outcome {
            Ok(outcome) => outcome,
            Err(error) => {
                self.outcome = error.to_string();
                self.judged_step = 0;
                return self;
            }
        };
        self.outcome = "ok".into();
        self.request = outcome.hits.request.name().into();
        self.prepare_ms = Some(milliseconds(outcome.prepare));
        if let Some(times) = outcome.times {
            self.runs = times.runs;
            self.median_ms = Some(milliseconds(times.median));
            self.min_ms = Some(milliseconds(times.min));
            self.max_ms = Some(milliseconds(times.max));
            self.device_ms = times.device.map(milliseconds);
            self.mrays_per_second = Some(times.mrays_per_second(self.width * self.height));
        }
        let Work { points, gradients, intervals, nonfinite } = outcome.work;
        (self.points, self.gradients, self.intervals) = (points, gradients, intervals);
        self.nonfinite = nonfinite;
        [
            self.proven_hit,
            self.possible_hit,
            self.root_hit,
            self.hit,
            self.proven_miss,
            self.miss,
        ] = outcome.certificates;
        if let Some(judgement) = &outcome.judgement {
            self.set_tally(&judgement.tally);
        }
        self
    }

    fn set_tally(&mut self, tally: &Tally) {
        self.judged = tally.judged;
        [self.transversal, self.tangential, self.rootless, self.undecidable] =
            Class::ALL.map(|class| tally.class(class));
        self.correct_hits = tally.count(Verdict::CorrectHit);
        self.correct_misses = tally.count(Verdict::CorrectMiss);
        self.false_misses_transversal = tally.count_in(Class::Transversal, Verdict::FalseMiss);
        self.false_misses_tangential = tally.count_in(Class::Tangential, Verdict::FalseMiss);
        self.false_hits = tally.count(Verdict::FalseHit);
        self.clear_misses = tally.clear_misses;
        self.clear_false_hits = tally.clear_false_hits;
        self.wrong_sheets = tally.count(Verdict::WrongSheet);
        self.undecided = tally.count(Verdict::Undecided);
        self.lies = tally.lies;
        self.median_dt = tally.median_dt;
        self.worst_dt = tally.worst_dt;
    }

    /// The domain, read back exactly; `None` if the column is damaged.
    pub fn domain(&self) -> Option<Domain> {
        let n = numbers(&self.domain)?;
        let (corners, ball) = (n.get(..6)?, n.get(6).copied());
        let domain = Domain::new(DVec3::from_slice(corners), DVec3::from_slice(&corners[3..]));
        Some(Domain { ball, ..domain.ok()? })
    }

    /// The view, read back exactly; `None` for a batch, or if the column is damaged.
    pub fn view(&self) -> Option<View> {
        let values = |key: &str| {
            let (_, rest) = self.camera.split_once(&format!("{key}="))?;
            // Up to the next key.
            let end = rest.find('=').map_or(Some(rest.len()), |next| rest[..next].rfind(','))?;
            numbers(&rest[..end])
        };
        let vector = |key| match values(key)?[..] {
            [x, y, z] => Some(DVec3::new(x, y, z)),
            _ => None,
        };
        let projection = match (values("fov").as_deref(), values("ortho").as_deref()) {
            (Some(&[fov]), None) => Projection::Perspective { fov },
            (None, Some(&[height])) => Projection::Orthographic { height },
            _ => return None,
        };
        let [eye, at, up] = [vector("eye")?, vector("at")?, vector("up")?];
        Some(View::new(Camera { eye, at, up, projection }, self.width, self.height))
    }
}

fn domain_text(domain: &Domain) -> String {
    let corners = [domain.min, domain.max].map(|p| p.to_array());
    text(corners.into_iter().flatten().chain(domain.ball))
}

/// Numbers with as many digits as it takes to read them back exactly.
fn text(numbers: impl Iterator<Item = f64>) -> String {
    numbers.map(|x| format!("{x:?}")).collect::<Vec<_>>().join(",")
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split(',').map(|word| word.parse().ok()).collect()
}

fn pairs<'a>(pairs: impl Iterator<Item = (&'a str, &'a str)>) -> String {
    pairs.map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join("; ")
}

fn milliseconds(duration: Duration) -> f64 {
    1e3 * duration.as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn domains_and_cameras_read_back_exactly() {
        let third = 1.0 / 3.0;
        let mut domain = Domain::new(DVec3::new(-third, -1e-300, 0.1), DVec3::splat(2.0)).unwrap();
        let mut record = Record { domain: domain_text(&domain), ..Record::default() };
        assert_eq!(record.domain(), Some(domain));
        domain.ball = Some(third.sqrt());
        record.domain = domain_text(&domain);
        assert_eq!(record.domain(), Some(domain));

        let mut camera = Camera::facing(&domain);
        for projection in [camera.projection, Projection::Orthographic { height: third }] {
            camera.projection = projection;
            (record.width, record.height) = (64, 48);
            record.camera = camera.to_string();
            assert_eq!(record.view(), Some(View::new(camera, 64, 48)));
        }
        assert_eq!(Record::default().view(), None);
        assert_eq!(Record { camera: "fov=1,eye=1,2".into(), ..record }.view(), None);
    }
}
