//! Frames that stay on the device.

use std::sync::Arc;
use std::time::Duration;

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use zeroset_cpu::Implicit;
use zeroset_cpu::amp::{Amp, Settings};
use zeroset_expr::{Parameters, Tape};
use zeroset_raycast::{Camera, Error, Method, Progress, Projection, Scene, Unsupported, View};
use zeroset_shade::environment::{BLUR, CLEAR, FACING, TILE};
use zeroset_shade::shaded::{self, Palette};
use zeroset_shade::{Environment, Light, Sky};

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
    let of_sky = format!(
        "const FACING = {FACING:?};\nconst TILE = {TILE:?};\nconst CLEAR = {CLEAR:?};\nconst BLUR = {BLUR:?};\n"
    );
    known(amp) + &of_sky + KERNEL
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
    /// The lights; which pixels they do not reach is found out here.
    pub lights: &'a [Light],
    /// Are shadow rays cast?
    pub shadows: Shadows,
    /// The surface's colours.
    pub palette: Palette,
    /// What surrounds it.
    pub environment: Environment,
}

impl<'a> Look<'a> {
    /// Under lights without shadows, as [`shaded::picture`] has it.
    pub fn lit(lights: &'a [Light]) -> Self {
        Self {
            lights,
            shadows: Shadows::Off,
            palette: shaded::palette(),
            environment: Environment::Plain,
        }
    }
}

/// Shaded frames by adaptive marching points, made on the device from the camera to the image
/// (Algorithm 2 of \[singh2010\]): for animations, and for times as the paper has them.
///
/// Rays are made in single precision, so a frame is a picture, not a set of answers: for those, and for
/// cameras farther away than single precision resolves, cast with [`AmpGpu`]. It is lit, and mirrors what
/// surrounds it, as [`shaded::picture`] has it.
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
}

impl SentSky {
    fn new(view: &View, environment: Environment) -> Self {
        let with = |v: Vec3, w: f32| v.extend(w).to_array();
        let Sky { up, edges, zenith, horizon, tiles, sun } = Sky::new(view);
        let is_seen = match environment {
            Environment::Plain => 0.0,
            Environment::Sky => 1.0,
        };
        Self {
            up: with(up, is_seen),
            edges: edges.map(|edge| with(edge, 0.0)),
            zenith: with(zenith, 0.0),
            horizon: with(horizon, 0.0),
            tiles: tiles.map(|tile| with(tile, 0.0)),
            sun: with(sun, 0.0),
        }
    }
}

/// Pixels along the side of a workgroup's block.
const BLOCK: usize = 8;
/// Pixels of the first band of rows.
const FIRST_BAND: usize = 1 << 20;
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
        frames.draw(&view, &Look::lit(&[]), &Progress::new())?;
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
        let background: Vec<u32> = shaded::background(view.height)
            .into_iter()
            .map(|[r, g, b]| u32::from_le_bytes([r, g, b, 255]))
            .collect();
        device.write(&canvas.background, &background)?;
        let columns = view.width.div_ceil(BLOCK);
        let mut sent = self.sent(view, look);
        let mut rows = (FIRST_BAND / view.width).max(BLOCK).next_multiple_of(BLOCK);
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
        let [right, up, forward] = view.camera.frame();
        let extent = view.extent();
        let perspective = match view.camera.projection {
            Projection::Perspective { .. } => 1.0,
            Projection::Orthographic { .. } => 0.0,
        };
        let domain = &self.implicit.domain;
        let mut light = [[0.0; 4]; MOST_LIGHTS];
        for (sent, light) in light.iter_mut().zip(look.lights) {
            *sent = light.direction.normalize_or_zero().extend(light.strength).to_array();
        }
        SentSettings {
            march: SentMarch::new(&self.settings),
            eye: with(view.camera.eye, perspective),
            forward: with(forward, 0.0),
            right: with(extent * right, view.footprint(1.0)),
            up: with(extent * up, 0.0),
            low: with(domain.min, domain.ball.unwrap_or(0.0)),
            high: with(domain.max, domain.longest_side()),
            front: look.palette.front.extend(0.0).to_array(),
            back: look.palette.back.extend(0.0).to_array(),
            size: [view.width as u32, view.height as u32],
            rows: [0; 2],
            lights: look.lights.len() as u32,
            shadows: (look.shadows == Shadows::On).into(),
            longest: self.settings.longest as f32,
            unused: 0,
            sky: SentSky::new(view, look.environment),
            light,
        }
    }
}
