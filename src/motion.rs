//! What moves from frame to frame.

use std::path::PathBuf;

use clap::Args;
use glam::DQuat;
use zeroset::expr::Parameters;
use zeroset::raycast::{Camera, View};

use crate::destination::{FrameFiles, has_extension, is_png};
use crate::failure::Failure;
use crate::numbers;
use crate::options::SceneOptions;
use crate::track::{self, Track};
use crate::{output, surface};

/// The name that turns the camera.
const AZIMUTH: &str = "azimuth";

/// What moves from frame to frame.
#[derive(Args, Clone, Debug)]
pub(crate) struct MotionOptions {
    /// Draws FRAMES pictures, in which a parameter of the equation goes from FROM to TO in even
    /// steps; azimuth turns the camera by degrees about the axis `up` through `at`. Repeatable:
    /// all advance together. An equation's domain, if found, is that of the first frame
    #[arg(long = "animate", value_name = "NAME=FROM:TO:FRAMES", value_parser = track::track)]
    #[arg(allow_hyphen_values = true)]
    tracks: Vec<Track>,
    /// Also writes the frames as an animated PNG
    #[arg(long, value_name = "FILE.png", value_parser = animation_file, requires = "tracks")]
    pub(crate) apng: Option<PathBuf>,
    /// Frames a second of the animated PNG
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    #[arg(default_value_t = 24, requires = "apng", allow_hyphen_values = true)]
    pub(crate) fps: u16,
    /// Keeps frames whose files are there, whatever options they were made with
    #[arg(long, requires = "tracks")]
    pub(crate) resume: bool,
}

impl MotionOptions {
    /// How many frames; `None` without an animation.
    pub(crate) fn frames(&self) -> Result<Option<usize>, Failure> {
        let Some(first) = self.tracks.first() else { return Ok(None) };
        for (i, track) in self.tracks.iter().enumerate() {
            if track.frames != first.frames {
                return Err(Failure::usage(format!(
                    "--animate {first} has {} frames and --animate {track} has {}: they advance \
                     together; give the same number",
                    first.frames, track.frames
                )));
            }
            if let Some(other) = self.tracks[..i].iter().find(|other| other.name == track.name) {
                return Err(Failure::usage(format!(
                    "--animate {other} and --animate {track} both move {}",
                    track.name
                )));
            }
            if track.name == AZIMUTH {
                for end in [&track.from, &track.to] {
                    numbers::finite(end)
                        .map_err(|why| Failure::usage(format!("--animate {track}: {why}")))?;
                }
            }
        }
        Ok(Some(first.frames))
    }

    /// The options of the scene in the first frame. The last frame's values are checked too, so
    /// that wrong ones are found before any work.
    pub(crate) fn first_scene(&self, options: &SceneOptions) -> Result<SceneOptions, Failure> {
        for track in self.parameters() {
            if let Some((name, value)) = options.parameters.iter().find(|(n, _)| *n == track.name) {
                return Err(Failure::usage(format!(
                    "--param {name}={value} and --animate {track} both set {name}; leave one out"
                )));
            }
        }
        let with = |value: fn(&Track) -> &str| {
            let mut options = options.clone();
            let values = self.parameters().map(|t| (t.name.clone(), value(t).to_owned()));
            options.parameters.extend(values);
            options
        };
        surface::scene(&with(|track| &track.to))?;
        Ok(with(|track| &track.from))
    }

    /// Refuses an animated PNG that the files of frames do not allow, and makes the folders.
    pub(crate) fn make_folders(&self, files: &FrameFiles, frames: usize) -> Result<(), Failure> {
        if let Some(apng) = &self.apng {
            if files.are_exr() {
                return Err(Failure::usage("--apng joins .png frames; an .exr file holds numbers"));
            }
            if (0..frames).any(|frame| files.file(frame) == *apng) {
                return Err(Failure::usage(format!(
                    "--apng {} is the file of a frame; name another",
                    apng.display()
                )));
            }
            output::make_folder_of(apng)?;
        }
        output::make_folder_of(&files.file(0))
    }

    /// Sets the parameters to their values in a frame.
    pub(crate) fn set(&self, parameters: &mut Parameters, frame: usize) {
        for track in self.parameters() {
            parameters.set(&track.name, &track.value(frame));
        }
    }

    /// The tracks that move parameters.
    fn parameters(&self) -> impl Iterator<Item = &Track> {
        self.tracks.iter().filter(|track| track.name != AZIMUTH)
    }

    /// The view in a frame.
    pub(crate) fn view(&self, view: &View, frame: usize) -> View {
        let Some(track) = self.tracks.iter().find(|track| track.name == AZIMUTH) else {
            return *view;
        };
        let [from, to] = [&track.from, &track.to]
            .map(|end| numbers::finite(end).expect("checked with the number of frames"));
        let share = frame as f64 / (track.frames - 1).max(1) as f64;
        let camera = turned(&view.camera(), from + (to - from) * share);
        View::new(camera, view.width, view.height)
    }
}

/// The camera, turned about the axis `up` through `at`: to the right for positive degrees.
fn turned(camera: &Camera, degrees: f64) -> Camera {
    let turn = DQuat::from_axis_angle(camera.up.normalize(), degrees.to_radians());
    Camera { eye: camera.at + turn * (camera.eye - camera.at), ..*camera }
}

/// The name of an animated PNG.
fn animation_file(text: &str) -> Result<PathBuf, String> {
    let file = PathBuf::from(text);
    let is_animation = is_png(&file) || has_extension(&file, "apng");
    if is_animation { Ok(file) } else { Err("name a .png or .apng file".into()) }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use zeroset::raycast::Projection;

    use super::*;

    #[test]
    fn the_camera_turns_about_the_axis_that_is_up() {
        let camera = Camera {
            eye: DVec3::new(1.0, -4.0, 3.0),
            at: DVec3::new(1.0, 0.0, 1.0),
            up: 5.0 * DVec3::Z,
            projection: Projection::Perspective { fov: 40.0 },
        };
        let [start, quarter, full] = [0.0, 90.0, 360.0].map(|degrees| turned(&camera, degrees));
        assert_eq!(start, camera);
        // From the front to the right.
        assert!((quarter.eye - DVec3::new(5.0, 0.0, 3.0)).length() < 1e-12, "{quarter}");
        assert!((full.eye - camera.eye).length() < 1e-12, "{full}");
        assert_eq!((quarter.at, quarter.up), (camera.at, camera.up));
    }
}
