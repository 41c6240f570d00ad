//! `zeroset compare`: methods on one surface and view, judged against the reference and timed.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use zeroset::bench::{
    self, Comparison, Context, Machine, Options, Record, Registry, Stage, record,
};
use zeroset::raycast::{Error, Method, Rays, Request, Scene, View};
use zeroset::shade::sheet::{self, Tile};
use zeroset::shade::{self, Picture, ViewKind};

use crate::failure::Failure;
use crate::numbers::short;
use crate::options::{self, CameraOptions, MethodOptions, SceneOptions, Size};
use crate::pictures::agreement;
use crate::watch::{self, Bar};
use crate::{output, surface, table};

const EXAMPLES: &str = "\
Examples:
  zeroset compare barth-sextic
  zeroset compare 'x^4+y^4+z^4=1' --methods amp-sign,kmarch --precision 1e-6
  zeroset compare steiner --set amp-sign.step=0.01 --runs 20 --out out/steiner
  zeroset compare klein --json > klein.json

Files: SURFACE-METHOD.png, SURFACE-METHOD-error.png and SURFACE-METHOD.exr (the hits as numbers) for
each method, SURFACE-sheet.png with all pictures, and records.csv, to which a row is added for each
method, with camera, knobs, threads, machine and revision.
";

/// Runs methods on a surface: a table of times and errors, pictures, error maps, records.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES, after_long_help = format!("{EXAMPLES}\n{}", table::LEGEND))]
pub(crate) struct Compare {
    #[command(flatten)]
    scene: SceneOptions,
    /// The methods, separated by commas, or all [default: all that support the surface, but for those
    /// that would need more than 10 s for a frame]
    #[arg(long, value_name = "A,B|all", value_delimiter = ',')]
    methods: Vec<String>,
    /// Timed frames a method, after one to warm up; fewer where they take more than 5 s together
    #[arg(long, value_name = "N", value_parser = options::runs, default_value = "5")]
    #[arg(allow_hyphen_values = true)]
    runs: usize,
    /// The size in pixels
    #[arg(long, value_name = "WxH", value_parser = options::size, default_value = "256x256")]
    #[arg(allow_hyphen_values = true)]
    size: Size,
    #[command(flatten)]
    camera: CameraOptions,
    /// What the pictures show: normal, shaded, depth, steps (evaluations), certificate or error;
    /// normal and shaded need normals, which are then part of the timed frames
    #[arg(long, value_name = "VIEW", value_parser = options::view_kind, default_value = "shaded")]
    view: ViewKind,
    #[command(flatten)]
    knobs: MethodOptions,
    /// Where the subsample of pixels starts that is judged if the reference is slow: at the first for
    /// 0, else at one that depends on the number
    #[arg(long, value_name = "N", default_value = "0")]
    seed: u64,
    /// Prints the records as JSON instead of the table
    #[arg(long)]
    json: bool,
    /// The folder for pictures and records; made if missing
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
}

/// A method that would need longer for a frame is left out unless it is asked for by name.
const SLOWEST_FRAME: Duration = Duration::from_secs(10);

impl Compare {
    /// Runs the command.
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let (equation, scene) = surface::scene(&self.scene)?;
        let view = self.camera.view(&scene.domain, self.size)?;
        let mut methods = self.select(&scene)?;
        self.knobs.set(&mut methods, &scene)?;
        output::make_folder(&self.out)?;
        let record_file = self.out.join("records.csv");
        if record_file.exists() {
            // Better known before the work than after.
            record::read(&record_file).map_err(Failure::work)?;
        }

        let progress = watch::interruptible()?;
        let normals = self.view.needs_normals();
        let options = Options {
            request: if normals { Request::FirstWithNormal } else { Request::First },
            runs: self.runs,
            seed: self.seed,
            // Methods that were asked for by name run however long they take.
            frame: self.is_default_selection().then_some(SLOWEST_FRAME),
            ..Options::default()
        };
        let bar = Bar::new();
        let rays = Rays::View(&view);
        let comparison =
            bench::compare(&scene, rays, &methods, &options, &progress, &mut |stage, share| {
                bar.show(&title(stage), share);
            });
        drop(bar);

        let context = Context {
            equation,
            precision: Some(self.knobs.precision(&scene)),
            revision: env!("ZEROSET_REVISION").into(),
        };
        let machine = Machine::this();
        if comparison.interrupted && comparison.runs.is_empty() {
            return Err(Failure::Interrupted);
        }
        let records = Record::of(&comparison, &scene, rays, &machine, &context);
        let mut files = self.draw(&comparison, &scene, &view)?;
        if !records.is_empty() {
            record::append(&record_file, &records).map_err(Failure::work)?;
            files.push(record_file);
        }

        if self.json {
            output::print(record::json(&records).as_bytes())?;
            output::print(b"\n")?;
        } else {
            let heading = format!(
                "{}, {}x{} pixels, precision {:?}; {}, {}, {} threads",
                scene.id,
                view.width,
                view.height,
                self.knobs.precision(&scene),
                machine.cpu,
                machine.isa,
                machine.threads
            );
            let tables = table::tables(&comparison, rays.len());
            let mut text = format!("{heading}\n\n{tables}\n");
            if !files.is_empty() {
                text += "\nWritten:\n";
                text.extend(files.iter().map(|f| format!("  {}\n", f.display())));
            }
            output::print(text.as_bytes())?;
        }
        verdict(&comparison)
    }

    /// Were no methods asked for by name?
    fn is_default_selection(&self) -> bool {
        self.methods.is_empty() || self.methods == ["all"]
    }

    /// The methods asked for.
    fn select(&self, scene: &Scene) -> Result<Vec<Box<dyn Method>>, Failure> {
        let registry = Registry::standard();
        if self.is_default_selection() {
            let methods: Vec<_> = registry
                .iter()
                .filter(|m| m.geometry() == scene.geometry.kind())
                .filter(|m| match m.supports(scene) {
                    Ok(()) => true,
                    Err(why) => {
                        eprintln!("zeroset: {} is left out: {why}", m.id());
                        false
                    }
                })
                .map(Method::boxed)
                .collect();
            return match methods.is_empty() {
                true => Err(Failure::work(format!("no method supports {}", scene.id))),
                false => Ok(methods),
            };
        }
        let mut methods: Vec<Box<dyn Method>> = Vec::new();
        for id in &self.methods {
            if id.trim() == "all" {
                return Err(Failure::usage("--methods takes all, or names, not both"));
            }
            let method = registry.method(id.trim()).map_err(Failure::usage)?;
            if methods.iter().any(|m| m.id() == method.id()) {
                return Err(Failure::usage(format!("--methods names {} twice", method.id())));
            }
            methods.push(method);
        }
        Ok(methods)
    }

    /// Writes the pictures and the hits of each method that answered, and the sheet.
    fn draw(
        &self,
        comparison: &Comparison,
        scene: &Scene,
        view: &View,
    ) -> Result<Vec<PathBuf>, Failure> {
        let stem = output::file_stem(&scene.id);
        let file = |name: &str| self.out.join(format!("{stem}-{name}"));
        let runs: Vec<_> = comparison
            .runs
            .iter()
            .filter_map(|run| {
                let outcome = run.outcome.as_ref().ok()?;
                Some((run.method, outcome, outcome.judgement.as_ref().map(agreement)))
            })
            .collect();
        let answers: Vec<_> =
            runs.iter().map(|(_, outcome, a)| (&outcome.hits, a.as_deref())).collect();
        let mut files = Vec::new();
        let mut save = |picture: &Picture, path: PathBuf| {
            files.push(path.clone());
            picture.save_png(&path).map_err(Failure::work)
        };

        let shown = if self.view.needs_reference() {
            Vec::new()
        } else {
            shade::pictures(self.view, view, &answers).map_err(Failure::work)?
        };
        let is_judged = comparison.truths.is_some() || comparison.footprints.is_some();
        let errors = if is_judged {
            shade::pictures(ViewKind::Error, view, &answers).map_err(Failure::work)?
        } else {
            Vec::new()
        };
        let mut tiles = Vec::new();
        for (i, (method, outcome, _)) in runs.iter().enumerate() {
            let (shown, error) = (shown.get(i), errors.get(i));
            if let Some(picture) = shown {
                save(picture, file(&format!("{method}.png")))?;
            }
            if let Some(picture) = error {
                save(picture, file(&format!("{method}-error.png")))?;
            }
            let time = outcome
                .times
                .map_or(String::new(), |t| format!("\n{} ms", short(1e3 * t.median.as_secs_f64())));
            let pictures: Vec<_> = [shown, error].into_iter().flatten().collect();
            tiles.push(Tile::new(format!("{method}{time}"), &pictures));
        }
        if !(shown.is_empty() && errors.is_empty()) {
            let sheet = sheet::sheet(&scene.id, &tiles).map_err(Failure::work)?;
            save(&sheet, file("sheet.png"))?;
        }
        for (method, outcome, _) in &runs {
            let path = file(&format!("{method}.exr"));
            shade::exr::save(&path, view, &outcome.hits, None).map_err(Failure::work)?;
            files.push(path);
        }
        Ok(files)
    }
}

/// What is being done.
fn title(stage: Stage) -> String {
    match stage {
        Stage::Classify => "reference".into(),
        Stage::Prepare(id) => format!("{id}: prepare"),
        Stage::Answer(id) => format!("{id}: warm up, judge"),
        Stage::Time(id) => format!("{id}: time"),
    }
}

/// Was everything done?
fn verdict(comparison: &Comparison) -> Result<(), Failure> {
    if comparison.interrupted {
        return Err(Failure::Interrupted);
    }
    // A method that is left out because it is slow has not failed: the table says so.
    let has_failed = |error: &Error| !matches!(error, Error::TooSlow(_));
    let failed: Vec<_> = comparison
        .runs
        .iter()
        .filter(|run| run.outcome.as_ref().is_err_and(has_failed))
        .map(|run| run.method)
        .collect();
    if failed.is_empty() {
        Ok(())
    } else {
        Err(Failure::work(format!("no answer from {}", failed.join(", "))))
    }
}
