//! `zeroset render`: one picture by one method.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use zeroset::bench::{self, Sample, Tolerance, Truths, judge, truth};
use zeroset::raycast::{Certificate, Hits, Intersector, Method, Progress, Rays, Request, Scene};
use zeroset::raycast::{Report, View};
use zeroset::shade::{self, Agreement, ViewKind};

use crate::failure::Failure;
use crate::numbers::{percent, short};
use crate::options::{self, CameraOptions, MethodOptions, SceneOptions, Size};
use crate::pictures::agreement;
use crate::watch::{self, Bar};
use crate::{output, surface};

const AFTER: &str = "\
Examples:
  zeroset render barth-sextic
  zeroset render klein --view certificate --legend --size 1024x1024
  zeroset render '-x^2-y^2-z^2+1' --camera eye=0,-4,0,fov=30 --out sphere.png
  zeroset render torus --method amp-sign --view error --legend --out error.png";

/// Draws a surface by one method.
#[derive(Args, Clone, Debug)]
#[command(after_help = AFTER)]
pub(crate) struct Render {
    #[command(flatten)]
    scene: SceneOptions,
    /// The method; `zeroset list methods` lists them
    #[arg(long, value_name = "M", default_value = "kmarch")]
    method: String,
    /// The size in pixels
    #[arg(long, value_name = "WxH", value_parser = options::size, default_value = "512x512")]
    #[arg(allow_hyphen_values = true)]
    size: Size,
    #[command(flatten)]
    camera: CameraOptions,
    /// What is shown: normal, shaded, depth, steps (evaluations), certificate, or error (against
    /// the reference)
    #[arg(long, value_name = "VIEW", value_parser = options::view_kind, default_value = "shaded")]
    view: ViewKind,
    /// Draws below the picture what its colours mean
    #[arg(long)]
    legend: bool,
    #[command(flatten)]
    methods: MethodOptions,
    /// The picture, or with .exr the hits as numbers too [default:
    /// out/SURFACE-METHOD-VIEW.png]
    #[arg(long, value_name = "FILE.png|FILE.exr", value_parser = image_file)]
    out: Option<PathBuf>,
}

impl Render {
    /// Runs the command.
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let (_, scene) = surface::scene(&self.scene)?;
        let view = self.camera.view(&scene.domain, self.size)?;
        let mut methods = [bench::method(&self.method).map_err(Failure::usage)?];
        self.methods.set(&mut methods, &scene)?;
        let [method] = methods;
        method.supports(&scene).map_err(Failure::work)?;
        let file = self.out.clone().unwrap_or_else(|| self.default_file(&scene));
        if self.legend && is_exr(&file) {
            return Err(Failure::usage("--legend is for .png files; an .exr file holds numbers"));
        }
        output::make_folder_of(&file)?;

        let progress = watch::interruptible()?;
        let request =
            if self.view.needs_normals() { Request::FirstWithNormal } else { Request::First };
        let mut hits = Hits::new(request, view.width * view.height);
        let start = Instant::now();
        let intersector = method.prepare(&scene)?;
        let prepare_ms = 1e3 * start.elapsed().as_secs_f64();
        let start = Instant::now();
        let report = cast(&*intersector, method.as_ref(), &view, &mut hits, &progress)?;
        let frame_ms = 1e3 * start.elapsed().as_secs_f64();

        let agreement = match self.view {
            ViewKind::Error => Some(against_reference(&scene, &view, &hits, &progress)?),
            _ => None,
        };
        let picture =
            shade::picture(self.view, &view, &hits, agreement.as_deref()).map_err(Failure::work)?;
        if is_exr(&file) {
            shade::exr::save(&file, &view, &hits, Some(&picture)).map_err(Failure::work)?;
        } else {
            let picture = if self.legend { picture.with_legend() } else { Ok(picture) };
            picture.and_then(|picture| picture.save_png(&file)).map_err(Failure::work)?;
        }
        let facts = [
            summary(&hits),
            format!("prepared in {} ms, cast in {} ms", short(prepare_ms), short(frame_ms)),
            work(&report, hits.len()),
            file.display().to_string(),
        ];
        if !hits.certificate.iter().any(|c| c.is_hit()) {
            eprintln!(
                "zeroset: nothing was hit: is the surface in the domain, and the domain in view? \
                 See --domain and --camera"
            );
        }
        output::print(format!("{}\n", facts.join("\n")).as_bytes())
    }

    fn default_file(&self, scene: &Scene) -> PathBuf {
        let stem = output::file_stem(&scene.id);
        Path::new("out").join(format!("{stem}-{}-{}.png", self.method, self.view))
    }
}

/// Casts the view's rays.
fn cast(
    intersector: &dyn Intersector,
    method: &dyn Method,
    view: &View,
    hits: &mut Hits,
    progress: &Progress,
) -> Result<Report, Failure> {
    let rays = hits.len();
    let report = Bar::new().follow(method.id(), rays, progress, || {
        intersector.intersect(Rays::View(view), hits, progress)
    })?;
    Ok(report)
}

/// How each answer agrees with the reference.
fn against_reference(
    scene: &Scene,
    view: &View,
    hits: &Hits,
    progress: &Progress,
) -> Result<Vec<Agreement>, Failure> {
    let rays = Rays::View(view);
    let oracle = truth::reference(scene)?;
    let sample = Sample::every(1, rays);
    let truths = Bar::new().follow("reference", rays.len(), progress, || {
        oracle.classify(rays, &sample.indices, progress)
    })?;
    let truths = Truths { sample, truths };
    Ok(agreement(&judge(rays, hits, &truths, Tolerance::Footprint)))
}

/// Hits, and the share of each certificate.
fn summary(hits: &Hits) -> String {
    let count = |c| hits.certificate.iter().filter(|given| **given == c).count();
    let shares: Vec<_> = Certificate::ALL
        .into_iter()
        .filter(|c| count(*c) > 0)
        .map(|c| format!("{c} {}", percent(count(c), hits.len())))
        .collect();
    let found = hits.certificate.iter().filter(|c| c.is_hit()).count();
    format!("{found} hits of {} rays: {}", hits.len(), shares.join(", "))
}

/// Evaluations a ray.
fn work(report: &Report, rays: usize) -> String {
    let a_ray = |count: u64| short(count as f64 / rays as f64);
    let work = report.work;
    let mut text = format!(
        "evaluations a ray: {} points, {} gradients, {} intervals",
        a_ray(work.points),
        a_ray(work.gradients),
        a_ray(work.intervals)
    );
    if work.nonfinite > 0 {
        text += &format!("; {} gave NaN or infinity", work.nonfinite);
    }
    text
}

/// A file that pictures can be written to.
fn image_file(text: &str) -> Result<PathBuf, String> {
    let file = PathBuf::from(text);
    let is_png = has_extension(&file, "png");
    if is_png || is_exr(&file) { Ok(file) } else { Err("name a .png or .exr file".into()) }
}

fn is_exr(file: &Path) -> bool {
    has_extension(file, "exr")
}

fn has_extension(file: &Path, extension: &str) -> bool {
    file.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}
