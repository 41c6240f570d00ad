//! Animations: a picture for each frame, by a method that is prepared once.

use std::fs;
use std::time::{Duration, Instant};

use zeroset::raycast::{Intersector, Scene, View};
use zeroset::shade::Animation;

use crate::destination::FrameFiles;
use crate::failure::Failure;
use crate::frame::{Cost, Frame, Painter, milliseconds};
use crate::motion::MotionOptions;
use crate::numbers::short;
use crate::output;
use crate::watch::Bar;

/// What an animation is made of.
pub(crate) struct Animator<'a> {
    /// What moves.
    pub(crate) motion: &'a MotionOptions,
    /// What is drawn; its view is that of a camera at rest.
    pub(crate) painter: Painter<'a>,
    /// Where frames go.
    pub(crate) files: &'a FrameFiles,
    /// How many frames.
    pub(crate) frames: usize,
}

/// What became of the frames.
#[derive(Default)]
struct Tally {
    /// The frames that have files.
    there: Vec<usize>,
    /// How many of them had one before.
    kept: usize,
    /// How many of them show nothing.
    empty: usize,
    /// The frames that could not be made, and why.
    failed: Vec<(usize, Failure)>,
    /// How long each frame took: its parameters and its rays.
    times: Vec<Duration>,
    cast: Cost,
    shadows: Option<Cost>,
}

impl Animator<'_> {
    /// Draws the frames of a scene, and says what that cost. A frame that cannot be made does not
    /// keep others from being made.
    pub(crate) fn run(
        &self,
        mut scene: Scene,
        intersector: &mut dyn Intersector,
        prepared: Duration,
    ) -> Result<(), Failure> {
        let mut tally = Tally::default();
        let bar = Bar::new();
        for index in 0..self.frames {
            let file = self.files.file(index);
            if self.motion.resume && file.is_file() {
                tally.kept += 1;
                tally.there.push(index);
                continue;
            }
            match self.paint(index, &mut scene, intersector, &bar) {
                Ok(drawn) => {
                    drawn.frame.save(&file, &drawn.view)?;
                    tally.count(index, &drawn);
                }
                Err(Failure::Interrupted) => {
                    drop(bar);
                    let (there, frames) = (tally.there.len(), self.frames);
                    eprintln!("zeroset: {there} of {frames} frames are there; --resume keeps them");
                    return Err(Failure::Interrupted);
                }
                Err(why) => tally.failed.push((index, why)),
            }
        }
        drop(bar);
        join(self.motion, self.files, &tally.there)?;
        self.report(&tally, prepared)
    }

    /// Paints a frame: the intersector gets new parameters, and is not prepared again.
    fn paint(
        &self,
        index: usize,
        scene: &mut Scene,
        intersector: &mut dyn Intersector,
        bar: &Bar,
    ) -> Result<Drawn, Failure> {
        self.motion.set(&mut scene.parameters, index);
        let view = self.motion.view(self.painter.view, index);
        let what = format!("frame {} of {}", index + 1, self.frames);
        let start = Instant::now();
        intersector.set_parameters(&scene.parameters)?;
        let set = start.elapsed();
        let frame =
            Painter { view: &view, ..self.painter }.paint(&what, scene, intersector, bar)?;
        Ok(Drawn { time: set + frame.time(), frame, view })
    }

    /// Prints what was made and what it cost; names the frames that were not made.
    fn report(&self, tally: &Tally, prepared: Duration) -> Result<(), Failure> {
        let mut facts = Vec::new();
        if !tally.times.is_empty() {
            facts.push(format!("prepared once, in {} ms", short(milliseconds(prepared))));
            facts.extend(tally.costs());
        }
        if let Some(apng) = self.motion.apng.as_ref().filter(|_| !tally.there.is_empty()) {
            facts.push(format!("{}: {} frames a second", apng.display(), self.motion.fps));
        }
        if let ([first, ..], [.., last]) = (&tally.there[..], &tally.there[..]) {
            let [first, last] = [first, last].map(|index| self.files.file(*index));
            let kept = match tally.kept {
                0 => String::new(),
                kept => format!(", {kept} of them as they were"),
            };
            facts.push(format!(
                "{} frames{kept}: {} to {}",
                tally.there.len(),
                first.display(),
                last.display()
            ));
        }
        if tally.empty > 0 {
            eprintln!("zeroset: nothing was hit in {} frames", tally.empty);
        }
        output::print(facts.iter().map(|fact| format!("{fact}\n")).collect::<String>().as_bytes())?;
        match &tally.failed[..] {
            [] => Ok(()),
            [(index, why), ..] => Err(Failure::work(format!(
                "{} of {} frames could not be made; the first, {}: {why}",
                tally.failed.len(),
                self.frames,
                self.files.file(*index).display()
            ))),
        }
    }
}

/// A frame, its view, and how long its parameters and rays took.
struct Drawn {
    frame: Frame,
    view: View,
    time: Duration,
}

/// Joins frames to the animated PNG that is asked for.
pub(crate) fn join(
    motion: &MotionOptions,
    files: &FrameFiles,
    there: &[usize],
) -> Result<(), Failure> {
    let (Some(apng), [_, ..]) = (&motion.apng, there) else { return Ok(()) };
    let mut animation = Animation::new(motion.fps);
    for file in there.iter().map(|index| files.file(*index)) {
        let bytes = fs::read(&file).map_err(|error| {
            Failure::work(format!("cannot read the frame {}: {error}", file.display()))
        })?;
        animation.push(&file, &bytes).map_err(Failure::work)?;
    }
    animation.save(apng).map_err(Failure::work)
}

impl Tally {
    fn count(&mut self, index: usize, drawn: &Drawn) {
        self.there.push(index);
        self.empty += usize::from(drawn.frame.is_empty());
        self.times.push(drawn.time);
        self.cast += drawn.frame.cast;
        if let Some(cost) = drawn.frame.shadows {
            *self.shadows.get_or_insert_default() += cost;
        }
    }

    /// What the frames that were drawn cost, at least one.
    fn costs(&self) -> Vec<String> {
        let mut times: Vec<f64> = self.times.iter().copied().map(milliseconds).collect();
        times.sort_by(f64::total_cmp);
        let (count, [least, most]) = (times.len(), [times[0], times[times.len() - 1]]);
        let median = times[(count - 1) / 2].midpoint(times[count / 2]);
        let mut facts = vec![
            format!(
                "frames cast in {} ms (median), {} ms (least), {} ms (most); most/least {}",
                short(median),
                short(least),
                short(most),
                short(most / least)
            ),
            self.cast.evaluations("ray"),
        ];
        if let Some(cost) = self.shadows {
            let total: Duration = self.times.iter().sum();
            facts.push(format!(
                "{} shadow rays, {} % of the time",
                cost.rays,
                short(100.0 * cost.time.as_secs_f64() / total.as_secs_f64())
            ));
            facts.push(cost.evaluations("shadow ray"));
        }
        facts
    }
}
