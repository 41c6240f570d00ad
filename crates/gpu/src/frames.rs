//! Frames that stay on the device.

use std::sync::Arc;
use std::time::Duration;

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use zeroset_cpu::Implicit;
use zeroset_cpu::amp::{Amp, Settings};
use zeroset_expr::{Parameters, Tape};
use zeroset_raycast::{Camera, Error, Method, Progress, Projection, Scene, Unsupported, View};

use crate::amp::{AmpGpu, SentMarch, known, module};
use crate::compiled::Compiled;
use crate::device::{AsBinding, Buffer, Device, DeviceError};

/// The whole shader of frames of a function, as it is compiled for a device.
///
/// # Errors
/// If an operation has no form on devices.
pub fn shader(amp: &Amp, tape: &Tape) -> Result<String, Unsupported> {
    Ok(module(tape)?.shader(&kernel(amp)))
}

fn kernel(amp: &Amp) -> String {
    known(amp) + KERNEL
}

const KERNEL: &str =
    concat!(include_str!("shaders/march.wgsl"), include_str!("shaders/frame.wgsl"));

/// Lights of a frame at most.
pub const MOST_LIGHTS: usize = 8;

/// Are shadow rays cast?
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shadows {
    /// None.
    #[default]
    Off,
    /// One from each hit to each light that it faces.
    On,
}

/// What a frame looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look<'a> {
    /// Unit vectors towards lights at infinity, and what a white surface that faces them reflects.
    pub lights: &'a [(Vec3, f32)],
    /// Are shadow rays cast?
    pub shadows: Shadows,
    /// The linear colour of the side that the gradient points out of.
    pub front: Vec3,
    /// The linear colour of the other side.
    pub back: Vec3,
    /// What is seen past the surface.
    pub surroundings: Surroundings<'a>,
}

/// What surrounds a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surroundings<'a> {
    /// Bytes encoded as sRGB, one colour a row, which nothing mirrors.
    Rows(&'a [[u8; 3]]),
    /// A sky over a chequered floor, with the lights as suns, which the surface mirrors.
    Sky(Sky),
}

/// A sky over a chequered floor that is one unit below: linear colours, and where they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// The zenith's direction, a unit vector.
    pub up: Vec3,
    /// The directions of the tiles' edges.
    pub edges: [Vec3; 2],
    /// Straight up.
    pub zenith: Vec3,
    /// Where sky and floor meet.
    pub horizon: Vec3,
    /// Light and dark.
    pub tiles: [Vec3; 2],
    /// A light's.
    pub sun: Vec3,
    /// The side of a tile.
    pub tile: f32,
    /// How far one sees before half of the contrast is lost in haze.
    pub clear: f32,
    /// The angle over which a direction is blurred, in radians.
    pub blur: f32,
    /// The share of the light that is mirrored where the surface faces the eye.
    pub facing: f32,
}

/// Shaded frames by adaptive marching points, made on the device from the camera to the image
/// (Algorithm 2 of \[singh2010\]): for animations, and for times as the paper has them.
///
/// Rays are made in single precision, so a frame is a picture, not a set of answers: for those, and for
/// cameras farther away than single precision resolves, cast with [`AmpGpu`]. Surfaces are lit on both
/// sides by Lambert's law, with a little ambient light from above, and mirror a sky.
pub struct Frames {
    method: AmpGpu,
    implicit: Implicit,
    published_step: Option<f64>,
    settings: Settings,
    compiled: Compiled,
    canvas: Option<Canvas>,
}

/// The buffers of an image's size.
struct Canvas {
    /// Where they are: a lost device is followed by another.
    device: Arc<Device>,
    size: [usize; 2],
    settings: Buffer<SentSettings>,
    background: Buffer<u32>,
    image: Buffer<u32>,
}

/// The shader's `Settings`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct SentSettings {
    march: SentMarch,
    eye: [f32; 4],
    forward: [f32; 4],
    right: [f32; 4],
    up: [f32; 4],
    low: [f32; 4],
    high: [f32; 4],
    front: [f32; 4],
    back: [f32; 4],
    size: [u32; 2],
    rows: [u32; 2],
    lights: u32,
    shadows: u32,
    longest: f32,
    unused: u32,
    sky: SentSky,
    light: [[f32; 4]; MOST_LIGHTS],
}

/// The sky in the shader's `Settings`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct SentSky {
    up: [f32; 4],
    edges: [[f32; 4]; 2],
    zenith: [f32; 4],
    horizon: [f32; 4],
    tiles: [[f32; 4]; 2],
    sun: [f32; 4],
    /// Side of a tile, clear, blur, facing.
    numbers: [f32; 4],
}

impl SentSky {
    /// Zeros where there is none.
    fn new(surroundings: Surroundings<'_>) -> Self {
        let Surroundings::Sky(sky) = surroundings else { return Self::zeroed() };
        let with = |v: Vec3, w: f32| v.extend(w).to_array();
        Self {
            up: with(sky.up, 1.0),
            edges: sky.edges.map(|edge| with(edge, 0.0)),
            zenith: with(sky.zenith, 0.0),
            horizon: with(sky.horizon, 0.0),
            tiles: sky.tiles.map(|tile| with(tile, 0.0)),
            sun: with(sky.sun, 0.0),
            numbers: [sky.tile, sky.clear, sky.blur, sky.facing],
        }
    }
}

/// Pixels along the side of a workgroup's block.
const BLOCK: usize = 8;
/// Pixels of the first band of rows, and at most.
const BAND: [usize; 2] = [1 << 18, 1 << 22];
/// A band should take no longer: drivers reset a device that hangs, and one may want to stop.
const BAND_TIME: Duration = Duration::from_millis(300);

impl Frames {
    /// Compiles the march and the light for a scene.
    ///
    /// # Errors
    /// If the scene is unsupported, or there is no device.
    pub fn new(method: &AmpGpu, scene: &Scene) -> Result<Self, Error> {
        let implicit = Implicit::new(method.id(), scene)?;
        let published_step = scene.published_step;
        let settings = Settings::new(&method.twin, &implicit, published_step)?;
        let compiled =
            Compiled::new(&method.device, &module(&implicit.tape)?, kernel(&method.twin))?;
        let method = method.clone();
        let mut frames =
            Self { method, implicit, published_step, settings, compiled, canvas: None };
        // Drivers compile when a kernel first runs.
        let view = View::new(Camera::facing(&frames.implicit.domain), BLOCK, BLOCK);
        let look = Look {
            lights: &[],
            shadows: Shadows::Off,
            front: Vec3::ONE,
            back: Vec3::ONE,
            surroundings: Surroundings::Rows(&[[0; 3]; BLOCK]),
        };
        frames.draw(&view, &look, &Progress::new())?;
        frames.canvas = None;
        Ok(frames)
    }

    /// New values for the equation's parameters; the shader stays as it is.
    ///
    /// # Errors
    /// As [`Intersector::set_parameters`](zeroset_raycast::Intersector::set_parameters).
    pub fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        let mut implicit = self.implicit.clone();
        implicit.set_parameters(values)?;
        let settings = Settings::new(&self.method.twin, &implicit, self.published_step)?;
        self.compiled.update(&module(&implicit.tape)?)?;
        (self.settings, self.implicit) = (settings, implicit);
        Ok(())
    }

    /// Draws a frame, which stays on the device; gives the device's time, if it measures any.
    ///
    /// # Errors
    /// If there are more than [`MOST_LIGHTS`] lights, the image is larger than a buffer may be, the
    /// device fails, or the work was asked to stop.
    ///
    /// # Panics
    /// If there is not one colour a row.
    pub fn draw(
        &mut self,
        view: &View,
        look: &Look<'_>,
        progress: &Progress,
    ) -> Result<Option<Duration>, Error> {
        if look.lights.len() > MOST_LIGHTS {
            let count = look.lights.len();
            return Err(Error::Device(format!("{count} lights; a frame takes {MOST_LIGHTS}")));
        }
        if self.compiled.is_stale() {
            self.compiled.update(&module(&self.implicit.tape)?)?;
        }
        let device = Arc::clone(&self.compiled.device);
        let size = [view.width, view.height];
        let fits = |canvas: &Canvas| canvas.size == size && Arc::ptr_eq(&canvas.device, &device);
        if !self.canvas.as_ref().is_some_and(fits) {
            self.canvas = Some(self.canvas(size)?);
        }
        let canvas = self.canvas.as_ref().expect("made above");
        if let Surroundings::Rows(rows) = look.surroundings {
            assert_eq!(rows.len(), view.height, "one colour a row");
            let packed = |[r, g, b]: &[u8; 3]| u32::from_le_bytes([*r, *g, *b, 255]);
            let rows: Vec<u32> = rows.iter().map(packed).collect();
            device.write(&canvas.background, &rows)?;
        }
        let columns = view.width.div_ceil(BLOCK);
        let mut sent = self.sent(view, look);
        let [first, most] = BAND.map(|pixels| (pixels / view.width).max(BLOCK));
        let mut rows = first.next_multiple_of(BLOCK);
        let (mut row, mut total) = (0, None);
        while row < view.height {
            let end = (row + rows).min(view.height);
            sent.rows = [row, end].map(|row| row as u32);
            device.write(&canvas.settings, &[sent])?;
            let bound: [&dyn AsBinding; 4] =
                [&self.compiled.constants, &canvas.settings, &canvas.background, &canvas.image];
            let blocks = columns * (end - row).div_ceil(BLOCK);
            let start = std::time::Instant::now();
            let time = device.run(&self.compiled.kernel, &bound, blocks * BLOCK * BLOCK)?;
            total = time.map(|time| time + total.unwrap_or_default());
            if start.elapsed() > BAND_TIME {
                rows = (rows / 2).max(BLOCK).next_multiple_of(BLOCK);
            } else if start.elapsed() < BAND_TIME / 16 {
                rows = (8 * rows).min(most).next_multiple_of(BLOCK);
            }
            progress.advance((end - row) * view.width)?;
            row = end;
        }
        Ok(total)
    }

    /// Reads the last frame: bytes encoded as sRGB, row by row from the top.
    ///
    /// # Errors
    /// If none was drawn, or the device fails.
    pub fn pixels(&self) -> Result<Vec<[u8; 3]>, Error> {
        let none = || Error::Device("no frame was drawn".into());
        let canvas = self.canvas.as_ref().ok_or_else(none)?;
        let pixels = canvas.device.read(&canvas.image, canvas.image.len())?;
        let bytes = |pixel: u32| {
            let [r, g, b, _] = pixel.to_le_bytes();
            [r, g, b]
        };
        Ok(pixels.into_iter().map(bytes).collect())
    }

    fn canvas(&self, size: [usize; 2]) -> Result<Canvas, Error> {
        let [width, height] = size;
        let device = &self.compiled.device;
        let bytes = (width * height * size_of::<u32>()) as u64;
        let largest = device.largest_binding();
        if bytes > largest {
            return Err(DeviceError::Invalid(
                device.report().name.clone(),
                format!(
                    "an image of {width}x{height} pixels takes {} MiB, a buffer at most {}: draw it \
                     without keeping it on the device",
                    bytes >> 20,
                    largest >> 20
                ),
            )
            .into());
        }
        let (settings, image) = (device.uniform(1)?, device.storage(width * height)?);
        Ok(Canvas {
            device: Arc::clone(device),
            size,
            settings,
            background: device.storage(height)?,
            image,
        })
    }

    fn sent(&self, view: &View, look: &Look<'_>) -> SentSettings {
        let with = |v: DVec3, w: f64| [v.x, v.y, v.z, w].map(|x| x as f32);
        let [right, up, forward] = view.camera().frame();
        let extent = view.extent();
        let perspective = match view.camera().projection {
            Projection::Perspective { .. } => 1.0,
            Projection::Orthographic { .. } => 0.0,
        };
        let domain = &self.implicit.domain;
        let mut light = [[0.0; 4]; MOST_LIGHTS];
        for (sent, (direction, strength)) in light.iter_mut().zip(look.lights) {
            *sent = direction.extend(*strength).to_array();
        }
        SentSettings {
            march: SentMarch::new(&self.settings),
            eye: with(view.camera().eye, perspective),
            forward: with(forward, 0.0),
            right: with(extent * right, view.footprint(1.0)),
            up: with(extent * up, 0.0),
            low: with(domain.min, domain.ball.unwrap_or(0.0)),
            high: with(domain.max, domain.longest_side()),
            front: look.front.extend(0.0).to_array(),
            back: look.back.extend(0.0).to_array(),
            size: [view.width as u32, view.height as u32],
            rows: [0; 2],
            lights: look.lights.len() as u32,
            shadows: (look.shadows == Shadows::On).into(),
            longest: self.settings.longest as f32,
            unused: 0,
            sky: SentSky::new(look.surroundings),
            light,
        }
    }
}
