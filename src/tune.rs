//! `zeroset tune`: AMP's constants for a surface, by measurement.

use clap::Args;
use comfy_table::{CellAlignment, Table, presets};
use zeroset::bench::tune::{self, Grid, Trial};
use zeroset::bench::{self, Sample, Truths, truth};
use zeroset::raycast::{Error, Method, Progress, Rays, Scene, View};

use crate::failure::Failure;
use crate::numbers::short;
use crate::options::{self, CameraOptions, MethodOptions, SceneOptions, Size};
use crate::watch::{self, Bar};
use crate::{frame::milliseconds, output, surface};

const AFTER: &str = "\
Examples:
  zeroset tune barth-decic
  zeroset tune 'x^4+y^4+z^4=1' --method amp-taylor --miss-rate 1e-4
  zeroset tune chmutov-8 --method amp-sign-gpu --size 256x256

Steps from 4 times to a quarter of the default, each with four thresholds tau1; tau2 and tau3 follow
tau1. A ray is lost where a root that crosses is missed, or a later sheet is hit; the miss rate counts
lost rays and false hits, for each ray whose first root crosses. The cheapest settings, by evaluations
with a gradient counted as two values, that keep the miss rate are recommended. An asterisk marks the
settings that no other beats in both.";

/// Recommends a base step and thresholds for a surface, measured against the reference.
#[derive(Args, Clone, Debug)]
#[command(after_help = AFTER)]
pub(crate) struct Tune {
    #[command(flatten)]
    scene: SceneOptions,
    /// amp-sign, amp-taylor, or one of them with -gpu
    #[arg(long, value_name = "M", default_value = "amp-sign")]
    method: String,
    /// The largest share of rays that may be lost or hit nothing
    #[arg(long, value_name = "RATE", value_parser = crate::numbers::positive)]
    #[arg(default_value = "0.001", allow_hyphen_values = true)]
    miss_rate: f64,
    /// The size of the view in pixels; what is missed depends on it little
    #[arg(long, value_name = "WxH", value_parser = options::size, default_value = "128x128")]
    #[arg(allow_hyphen_values = true)]
    size: Size,
    #[command(flatten)]
    camera: CameraOptions,
    #[command(flatten)]
    methods: MethodOptions,
}

impl Tune {
    /// Runs the command.
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let (_, scene) = surface::scene(&self.scene)?;
        let view = self.camera.view(&scene.domain, self.size)?;
        let mut methods = [bench::method(&self.method).map_err(Failure::usage)?];
        self.methods.set(&mut methods, &scene)?;
        let [method] = methods;
        let has = |name| method.knobs().iter().any(|knob| knob.name == name);
        if !(has("step") && has("tau1")) {
            return Err(Failure::usage(format!(
                "{} has no step and threshold to tune; --method takes amp-sign, amp-taylor and their \
                 -gpu twins",
                method.id()
            )));
        }
        method.supports(&scene).map_err(Failure::work)?;

        let progress = watch::interruptible()?;
        let grid = Grid::around(base(&*method, &scene)?);
        let (truths, trials) = measure(&*method, &scene, &view, &grid, &progress)?;
        let mut text = format!(
            "{}, {}: {} of {} rays judged, the first root crosses on {}\n\n{}\n\n",
            scene.id,
            method.id(),
            truths.truths.len(),
            view.width * view.height,
            trials.first().map_or(0, |trial| trial.crossed),
            table(&trials)
        );
        text += &self.advice(&*method, &trials);
        output::print(text.as_bytes())
    }

    /// What to set.
    fn advice(&self, method: &dyn Method, trials: &[Trial]) -> String {
        let set = |trial: &Trial| {
            let id = method.id();
            let [step, tau1] = [trial.step, trial.tau1].map(three_digits);
            format!("--set {id}.step={step} --set {id}.tau1={tau1}")
        };
        if let Some(best) = tune::recommended(trials, self.miss_rate) {
            return format!("For a miss rate of at most {:?}:\n  {}\n", self.miss_rate, set(best));
        }
        let rates = trials.iter().map(Trial::error_rate);
        let least = rates.fold(f64::INFINITY, f64::min);
        let best = tune::recommended(trials, least).map(set).unwrap_or_default();
        format!(
            "No setting keeps a miss rate of {:?}. The least is {}:\n  {best}\nRoots in pairs and double \
             roots are found by amp-taylor, or proved by kmarch.\n",
            self.miss_rate,
            short(least)
        )
    }
}

/// The base step that the method would take.
fn base(method: &dyn Method, scene: &Scene) -> Result<f64, Failure> {
    let set = method.knobs().into_iter().find(|knob| knob.name == "step");
    if let Some(step) = set.and_then(|knob| knob.value.parse().ok()) {
        return Ok(step);
    }
    zeroset::cpu::Amp::default().step(scene).map_err(Failure::work)
}

fn measure(
    method: &dyn Method,
    scene: &Scene,
    view: &View,
    grid: &Grid,
    progress: &Progress,
) -> Result<(Truths, Vec<Trial>), Failure> {
    let rays = Rays::View(view);
    let bar = Bar::new();
    let oracle = truth::reference(scene)?;
    let sample = Sample::every(1, rays);
    let truths = bar.follow("reference", rays.len(), progress, || {
        oracle.classify(rays, &sample.indices, progress)
    })?;
    let truths = Truths { sample, truths };
    let count = grid.steps.len() * grid.thresholds.len();
    let mut done = 0_usize;
    let trials: Result<_, Error> =
        tune::tune(method, scene, rays, &truths, grid, progress, &mut |_| {
            done += 1;
            bar.show("settings", done as f64 / count as f64);
        });
    Ok((truths, trials?))
}

/// A number of a grid, to three significant digits: 0.0106, 3, 1.25e-5.
fn three_digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().expect("a number was printed");
    zeroset::raycast::knob::text(rounded)
}

fn table(trials: &[Trial]) -> String {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING);
    table.set_header([
        "",
        "step",
        "tau1",
        "lost",
        "false hits",
        "miss rate",
        "values a ray",
        "gradients a ray",
        "ms",
    ]);
    for trial in trials {
        let a_ray = |n: u64| short(n as f64 / trial.judged.max(1) as f64);
        table.add_row([
            if tune::is_on_frontier(trials, trial) { "*" } else { "" }.into(),
            three_digits(trial.step),
            three_digits(trial.tau1),
            trial.lost.to_string(),
            trial.false_hits.to_string(),
            short(trial.error_rate()),
            a_ray(trial.work.points),
            a_ray(trial.work.gradients),
            short(milliseconds(trial.time)),
        ]);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.trim_fmt()
}
