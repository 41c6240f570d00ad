//! `zeroset render`: one picture by one method, or one for each frame of an animation.

use std::path::Path;
use std::time::Instant;

use clap::Args;
use zeroset::bench;
use zeroset::raycast::{Geometry, Method, Progress, Sampling, Scene, View};
use zeroset::shade::ViewKind;

use crate::animate::Animator;
use crate::destination::{self, Destination, FrameFiles, is_exr};
use crate::failure::Failure;
use crate::frame::{Painter, milliseconds};
use crate::lighting::LightOptions;
use crate::motion::MotionOptions;
use crate::numbers::short;
use crate::options::{self, CameraOptions, MethodOptions, SceneOptions, Size};
use crate::resident::{self, Resident};
use crate::watch::{self, Bar};
use crate::{output, surface};

const AFTER: &str = "\
Examples:
  zeroset render barth-sextic
  zeroset render klein --view certificate --legend --size 1024x1024
  zeroset render '-x^2-y^2-z^2+1' --camera eye=0,-4,0,fov=30 --out sphere.png
  zeroset render octdong --method beam-adaptive --samples 4
  zeroset render torus --method amp-sign --view error --legend --out error.png
  zeroset render klein --light 1,-1,2 --shadows on
  zeroset render barth-decic --method amp-sign-gpu --resident --animate azimuth=0:90:60 --out turn/
  zeroset render blinn-blobby-75 --environment sky
  zeroset render morph-hyperboloid-torus --animate w=0:1:60 --out frames/ --apng morph.png

Frames are numbered from 0: frame i of N has FROM + (TO - FROM)*i/(N - 1), exactly. Frames that are
there are overwritten, unless --resume keeps them. Ctrl-C keeps what is finished.";

/// Draws a surface by one method.
#[derive(Args, Clone, Debug)]
#[command(after_help = AFTER)]
pub(crate) struct Render {
    #[command(flatten)]
    scene: SceneOptions,
    /// The method; `zeroset list methods` lists them [default: kmarch; quadric for pieces]
    #[arg(long, value_name = "M")]
    method: Option<String>,
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
    /// Samples a pixel: each is cast as a pixel of an image that is finer by its root, and colours are
    /// averaged in linear light
    #[arg(long, value_name = "N", value_parser = samples, default_value = "1")]
    samples: usize,
    #[command(flatten)]
    light: LightOptions,
    #[command(flatten)]
    methods: MethodOptions,
    #[command(flatten)]
    motion: MotionOptions,
    /// Makes the whole picture on the device, with a method amp-sign-gpu or amp-taylor-gpu: rays,
    /// shadows, light and image stay there, and its clock times them
    #[arg(long)]
    resident: bool,
    /// The picture, or with .exr the hits as numbers too; for an animation a folder, or the file
    /// whose name gets the numbers of frames [default: out/SURFACE-METHOD-VIEW.png]
    #[arg(long, value_name = "FILE.png|FILE.exr|FOLDER", value_parser = destination::destination)]
    out: Option<Destination>,
}

/// What is needed to cast rays.
struct Setup {
    scene: Scene,
    view: View,
    method: Box<dyn Method>,
}

impl Render {
    /// Runs the command.
    pub(crate) fn run(&self) -> Result<(), Failure> {
        self.light.check(self.view)?;
        if self.samples > 1 && self.resident {
            return Err(Failure::usage("--samples is not for --resident"));
        }
        match self.motion.frames()? {
            frames if self.resident => self.stay(frames),
            Some(frames) => self.animate(frames),
            None => self.draw(),
        }
    }

    /// Draws one picture, or one for each frame, on the device.
    fn stay(&self, frames: Option<usize>) -> Result<(), Failure> {
        if self.legend {
            return Err(Failure::usage("--legend is not for --resident"));
        }
        let options = match frames {
            None => self.scene.clone(),
            Some(_) => self.motion.first_scene(&self.scene)?,
        };
        let Setup { scene, view, method } = self.setup(&options)?;
        let progress = watch::interruptible()?;
        let resident = Resident {
            march: resident::march(&*method, self.view)?,
            motion: &self.motion,
            light: &self.light,
            view: &view,
            destination: &self.destination(&scene),
            frames,
            progress: &progress,
        };
        resident.run(scene)
    }

    /// Draws one picture.
    fn draw(&self) -> Result<(), Failure> {
        let Setup { scene, view, method } = self.setup(&self.scene)?;
        let file = self.destination(&scene).file()?;
        self.check_legend(&file)?;
        output::make_folder_of(&file)?;

        let progress = watch::interruptible()?;
        let start = Instant::now();
        let intersector = method.prepare(&scene)?;
        let prepare_ms = milliseconds(start.elapsed());
        let painter = self.painter(&view, method.sampling(), &progress);
        let frame = painter.paint(method.id(), &scene, &*intersector, &Bar::new())?;
        frame.save(&file, &view)?;

        let cast_ms = milliseconds(frame.cast.time);
        let mut facts = vec![
            frame.summary(),
            format!("prepared in {} ms, cast in {} ms", short(prepare_ms), short(cast_ms)),
            frame.cast.evaluations("ray"),
        ];
        facts.extend(frame.shadow_lines().into_iter().flatten());
        facts.push(file.display().to_string());
        if frame.is_empty() {
            eprintln!(
                "zeroset: nothing was hit: is the surface in the domain, and the domain in view? \
                 See --domain and --camera"
            );
        }
        output::print(format!("{}\n", facts.join("\n")).as_bytes())
    }

    /// Draws a picture for each frame.
    fn animate(&self, frames: usize) -> Result<(), Failure> {
        let Setup { scene, view, method } = self.setup(&self.motion.first_scene(&self.scene)?)?;
        let files = FrameFiles::new(&self.destination(&scene), frames);
        self.check_legend(&files.file(0))?;
        self.motion.make_folders(&files, frames)?;

        let progress = watch::interruptible()?;
        let start = Instant::now();
        let mut intersector = method.prepare(&scene)?;
        let prepared = start.elapsed();
        let painter = self.painter(&view, method.sampling(), &progress);
        let animator = Animator { motion: &self.motion, painter, files: &files, frames };
        animator.run(scene, &mut *intersector, prepared)
    }

    fn painter<'a>(
        &'a self,
        view: &'a View,
        sampling: Sampling,
        progress: &'a Progress,
    ) -> Painter<'a> {
        let (kind, legend, light) = (self.view, self.legend, &self.light);
        let side = self.samples.isqrt();
        Painter { view, sampling, side, kind, legend, light, progress }
    }

    /// The scene, the camera and the method that are asked for.
    fn setup(&self, options: &SceneOptions) -> Result<Setup, Failure> {
        let (_, scene) = surface::scene(options)?;
        let view = self.camera.view(&scene.domain, self.size)?;
        let side = self.samples.isqrt();
        let view = View::new(view.camera(), side * view.width, side * view.height);
        let mut methods = [bench::method(self.method(&scene)).map_err(Failure::usage)?];
        self.methods.set(&mut methods, &scene)?;
        let [method] = methods;
        method.supports(&scene).map_err(Failure::work)?;
        Ok(Setup { scene, view, method })
    }

    /// The method's id.
    fn method(&self, scene: &Scene) -> &str {
        let default = match scene.geometry {
            Geometry::Patches(_) => "quadric",
            _ => "kmarch",
        };
        self.method.as_deref().unwrap_or(default)
    }

    fn destination(&self, scene: &Scene) -> Destination {
        self.out.clone().unwrap_or_else(|| {
            let stem = output::file_stem(&scene.id);
            let name = format!("{stem}-{}-{}.png", self.method(scene), self.view);
            Destination::File(Path::new("out").join(name))
        })
    }

    fn check_legend(&self, file: &Path) -> Result<(), Failure> {
        if self.legend && is_exr(file) {
            return Err(Failure::usage("--legend is for .png files; an .exr file holds numbers"));
        }
        if self.samples > 1 && is_exr(file) {
            let why = "--samples is for .png files; an .exr file holds the hit of each pixel";
            return Err(Failure::usage(why));
        }
        Ok(())
    }
}

/// Reads a number of samples: a square.
fn samples(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(n) if (1..=256).contains(&n) && n.isqrt().pow(2) == n => Ok(n),
        _ => Err("give a square from 1 to 256, such as 4 or 16".into()),
    }
}
