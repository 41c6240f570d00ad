//! Pictures that are made on the device, from the camera to the image.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use zeroset::cpu::RootTest;
use zeroset::gpu::{AmpGpu, Frames, Look, Shadows, Sky, Surroundings};
use zeroset::raycast::{Method, Progress, Scene, View};
use zeroset::shade::shaded::{self, Palette};
use zeroset::shade::{Environment, Picture, ViewKind, environment};

use crate::animate;
use crate::destination::{Destination, FrameFiles, is_exr};
use crate::failure::Failure;
use crate::frame::milliseconds;
use crate::lighting::{self, LightOptions};
use crate::motion::MotionOptions;
use crate::numbers::short;
use crate::output;

/// The march of a method's twin, if the method is one that draws frames on the device.
pub(crate) fn march(method: &dyn Method, view: ViewKind) -> Result<AmpGpu, Failure> {
    if view != ViewKind::Shaded {
        return Err(Failure::usage(format!(
            "--resident is for --view shaded; --view {view} shows what stays on the device"
        )));
    }
    let tests = [RootTest::Sign, RootTest::Taylor];
    let mut march =
        tests.map(AmpGpu::new).into_iter().find(|march| march.id() == method.id()).ok_or_else(
            || {
                let ids = tests.map(|test| AmpGpu::new(test).id()).join(" or ");
                Failure::usage(format!("--resident is for --method {ids}, not {}", method.id()))
            },
        )?;
    for knob in method.knobs() {
        march.set(knob.name, &knob.value).map_err(Failure::usage)?;
    }
    Ok(march)
}

/// What is drawn.
pub(crate) struct Resident<'a> {
    pub(crate) march: AmpGpu,
    pub(crate) motion: &'a MotionOptions,
    pub(crate) light: &'a LightOptions,
    /// That of a camera at rest.
    pub(crate) view: &'a View,
    pub(crate) destination: &'a Destination,
    /// How many frames; `None` for one picture.
    pub(crate) frames: Option<usize>,
    pub(crate) progress: &'a Progress,
}

/// Times of one frame.
struct Times {
    /// From the parameters to the image on the device.
    drawn: Duration,
    /// The device's own.
    device: Option<Duration>,
    /// Reading the image back.
    read: Duration,
}

impl Resident<'_> {
    /// Draws the frames of a scene, and says what that cost.
    pub(crate) fn run(&self, mut scene: Scene) -> Result<(), Failure> {
        let files = self.files()?;
        let start = Instant::now();
        let mut frames = Frames::new(&self.march, &scene)?;
        let prepared = start.elapsed();
        let mut times = Vec::new();
        for (index, file) in files.iter().enumerate() {
            if self.frames.is_some() && self.motion.resume && file.is_file() {
                continue;
            }
            let drawn = self.draw(index, &mut scene, &mut frames);
            if let Err(Failure::Interrupted) = drawn {
                eprintln!("zeroset: {index} of {} frames are there", files.len());
            }
            let (picture, time) = drawn?;
            picture.save_png(file).map_err(Failure::work)?;
            times.push(time);
        }
        if let Some(count) = self.frames {
            let numbered = FrameFiles::new(self.destination, count);
            animate::join(self.motion, &numbered, &(0..count).collect::<Vec<_>>())?;
        }
        self.report(&files, &times, prepared)
    }

    /// The file of each picture, whose folders are made.
    fn files(&self) -> Result<Vec<PathBuf>, Failure> {
        let files = match self.frames {
            None => vec![self.destination.file()?],
            Some(count) => {
                let files = FrameFiles::new(self.destination, count);
                self.motion.make_folders(&files, count)?;
                (0..count).map(|index| files.file(index)).collect()
            }
        };
        if files.iter().any(|file| is_exr(file)) {
            return Err(Failure::usage("--resident makes .png files; an .exr file holds answers"));
        }
        output::make_folder_of(&files[0])?;
        Ok(files)
    }

    fn draw(
        &self,
        index: usize,
        scene: &mut Scene,
        frames: &mut Frames,
    ) -> Result<(Picture, Times), Failure> {
        let mut view = *self.view;
        let start = Instant::now();
        if self.frames.is_some() {
            view = self.motion.view(self.view, index);
            self.motion.set(&mut scene.parameters, index);
            frames.set_parameters(&scene.parameters)?;
        }
        let lights: Vec<_> = self
            .light
            .lights(&view)
            .iter()
            .map(|light| (light.direction.normalize_or_zero(), light.strength))
            .collect();
        let background = shaded::background(view.height);
        let Palette { front, back } = shaded::palette();
        let look = Look {
            lights: &lights,
            shadows: match self.light.shadows {
                lighting::Shadows::Off => Shadows::Off,
                lighting::Shadows::On => Shadows::On,
            },
            front,
            back,
            surroundings: match self.light.environment {
                Environment::Plain => Surroundings::Rows(&background),
                Environment::Sky => Surroundings::Sky(sky(&view)),
            },
        };
        let device = frames.draw(&view, &look, self.progress)?;
        let drawn = start.elapsed();
        let start = Instant::now();
        let pixels = frames.pixels()?;
        let read = start.elapsed();
        let picture = Picture::from_pixels(view.width, view.height, pixels);
        let mut description = String::from("Lambert shading, on the device");
        if look.shadows == Shadows::On {
            description += "; with shadows";
        }
        if self.light.environment == Environment::Sky {
            description += "; mirroring a sky over a chequered floor";
        }
        let picture = picture.map_err(Failure::work)?.described(&description);
        Ok((picture, Times { drawn, device, read }))
    }

    fn report(
        &self,
        files: &[PathBuf],
        times: &[Times],
        prepared: Duration,
    ) -> Result<(), Failure> {
        let mut facts = vec![format!("prepared once, in {} ms", short(milliseconds(prepared)))];
        if !times.is_empty() {
            let device: Option<Vec<_>> = times.iter().map(|t| t.device).collect();
            let device = device.map_or_else(
                || "the device has no clock".into(),
                |times| format!("on the device {}", spread(&times)),
            );
            let of =
                |part: fn(&Times) -> Duration| spread(&times.iter().map(part).collect::<Vec<_>>());
            facts.push(format!(
                "{} frames: {device}; with set-up {}; read back {}",
                times.len(),
                of(|t| t.drawn),
                of(|t| t.read)
            ));
        }
        match files {
            [file] => facts.push(file.display().to_string()),
            [first, .., last] => {
                facts.push(format!("{} .. {}", first.display(), last.display()));
            }
            [] => {}
        }
        output::print(format!("{}\n", facts.join("\n")).as_bytes())
    }
}

/// The sky of a view, as the device is told of it.
fn sky(view: &View) -> Sky {
    let environment::Sky { up, edges, zenith, horizon, tiles, sun } = environment::Sky::new(view);
    let [tile, clear, blur, facing] =
        [environment::TILE, environment::CLEAR, environment::BLUR, environment::FACING];
    Sky { up, edges, zenith, horizon, tiles, sun, tile, clear, blur, facing }
}

/// The median of some times, and their range.
fn spread(times: &[Duration]) -> String {
    let mut times = times.to_vec();
    times.sort_unstable();
    let ms = |time: Duration| short(milliseconds(time));
    let median = ms(times[times.len() / 2]);
    match times[..] {
        [_] => format!("{median} ms"),
        [first, .., last] => format!("{median} ms ({} .. {})", ms(first), ms(last)),
        [] => String::new(),
    }
}
