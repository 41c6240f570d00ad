//! Pipelines and buffers for a scene, and images for a view's size.

use std::sync::Arc;
use std::time::Duration;

use glam::DVec3;
use zeroset_gpu::device::{
    AsBinding, Binding, Bound as BoundKernel, BoundPipeline, Buffer, Clock, DepthStart, DepthTest,
    Format, Groups, Kernel, Mixing, Pass, Reader, Step, Texture,
};
use zeroset_gpu::{Device, DeviceError};
use zeroset_raycast::{Blending, Bound, Patches, Projection, Sides, View};

use super::buffers::{Answer, SentCorners, SentFrame, SentPatch, SentResolve, send};
use super::{Culling, QuadricsGpu};
use crate::method::Staging;
use crate::piece::Formula;

const SPLAT: &str = include_str!("../shaders/splat.wgsl");
const FIRST: &str = include_str!("../shaders/first.wgsl");
const VISIBLE: &str = include_str!("../shaders/visible.wgsl");
const ADD: &str = include_str!("../shaders/add.wgsl");
const RESOLVE: &str = include_str!("../shaders/resolve.wgsl");

/// What draws a scene in views of one kind.
pub(super) struct Painter {
    pub(super) device: Arc<Device>,
    kind: Kind,
    centre: DVec3,
    radius: f64,
    frame: Buffer<SentFrame>,
    /// What each pass draws.
    passes: Vec<Vec<Drawn>>,
    resolve: Kernel,
    sums: Format,
    clock: Option<Clock>,
    canvas: Option<Canvas>,
}

/// A part of the patches with the pipeline that draws it.
struct Drawn {
    bound: BoundPipeline,
    vertices: u32,
    instances: u32,
}

/// Kinds of views that are drawn by different shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Perspective,
    Orthographic,
}

impl Kind {
    pub(super) fn of(view: &View) -> Self {
        match view.camera().projection {
            Projection::Perspective { .. } => Self::Perspective,
            Projection::Orthographic { .. } => Self::Orthographic,
        }
    }
}

/// The images of a view's size.
struct Canvas {
    size: [u32; 2],
    position: Texture,
    normal: Texture,
    depth: Texture,
    answers: Buffer<Answer>,
    reader: Reader<Answer>,
    resolve: BoundKernel,
}

/// Patches of one kind of bound, as many as a buffer holds.
struct Part {
    is_solid: bool,
    patches: Buffer<SentPatch>,
    corners: Buffer<SentCorners>,
    count: u32,
}

impl Painter {
    pub(super) fn new(
        device: Arc<Device>,
        method: &QuadricsGpu,
        patches: &Patches,
        kind: Kind,
    ) -> Result<Self, DeviceError> {
        let domain = patches.domain();
        let (centre, radius) = (domain.centre(), domain.radius());
        let frame = device.uniform(1)?;
        let parts = parts(&device, method, patches, centre)?;
        let stages: Vec<Stage> = match patches.blending() {
            Blending::None => vec![Stage {
                paint: FIRST,
                colours: vec![(Format::Single, Mixing::Replace); 2],
                test: DepthTest::Nearest,
                offset: 0.0,
            }],
            Blending::Weighted { offset } => vec![
                Stage { paint: VISIBLE, colours: Vec::new(), test: DepthTest::Nearest, offset },
                Stage {
                    paint: ADD,
                    colours: vec![(method.sums, Mixing::Add); 2],
                    test: DepthTest::NotBehind,
                    offset: 0.0,
                },
            ],
        };
        let mut passes = Vec::new();
        for stage in &stages {
            let mut drawn = Vec::new();
            for is_solid in [false, true] {
                let of_kind: Vec<_> = parts.iter().filter(|p| p.is_solid == is_solid).collect();
                if of_kind.is_empty() {
                    continue;
                }
                let source = stage.source(method, patches, kind, is_solid);
                let bindings = [Binding::Uniform, Binding::Read, Binding::Read];
                let pipeline =
                    device.pipeline("quadrics", &source, &bindings, &stage.colours, stage.test)?;
                for part in of_kind {
                    let buffers: [&dyn AsBinding; 3] = [&frame, &part.patches, &part.corners];
                    let bound = device.bind_pipeline(&pipeline, &buffers)?;
                    let (vertices, instances) =
                        if is_solid { (3, 4 * part.count) } else { (4, part.count) };
                    drawn.push(Drawn { bound, vertices, instances });
                }
            }
            passes.push(drawn);
        }
        let sums = if stages.len() > 1 { method.sums } else { Format::Single };
        let source = format!(
            "const SUMS = {};\nconst BYTES = {};\n{RESOLVE}",
            stages.len() > 1,
            sums == Format::Byte
        );
        let bindings = [Binding::Uniform, Binding::Texture, Binding::Texture, Binding::Write];
        let resolve = device.kernel("resolve", &source, &bindings)?;
        let clock = device.clock()?;
        Ok(Self { device, kind, centre, radius, frame, passes, resolve, sums, clock, canvas: None })
    }

    /// Is it for such views, and still there?
    pub(super) fn fits(&self, kind: Kind) -> bool {
        self.kind == kind && !self.device.is_lost()
    }

    /// The origin of all positions.
    pub(super) fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Draws a view; gives what each pixel shows, and the time on the device.
    pub(super) fn draw(
        &mut self,
        view: &View,
    ) -> Result<(Vec<Answer>, Option<Duration>), DeviceError> {
        let size = [view.width as u32, view.height as u32];
        if self.canvas.as_ref().is_none_or(|canvas| canvas.size != size) {
            // What was there makes room first.
            self.canvas = None;
            self.canvas = Some(self.canvas(size)?);
        }
        let Some(canvas) = &self.canvas else { unreachable!("it was just made") };
        self.device.write(&self.frame, &[SentFrame::new(view, self.centre, self.radius)])?;
        let draws: Vec<Vec<_>> = self
            .passes
            .iter()
            .map(|drawn| drawn.iter().map(|d| (&d.bound, d.vertices, d.instances)).collect())
            .collect();
        let colours = [&canvas.position, &canvas.normal];
        let last = draws.len() - 1;
        let passes: Vec<_> = draws
            .iter()
            .enumerate()
            .map(|(i, draws)| Pass {
                draws,
                colours: if i == last { &colours } else { &[] },
                depth: &canvas.depth,
                start: if i == 0 { DepthStart::Far } else { DepthStart::Kept },
            })
            .collect();
        let pixels = view.width * view.height;
        let step = Step { bound: &canvas.resolve, groups: Groups::Invocations(pixels) };
        let time = self.device.draw(&passes, &[step], self.clock.as_ref())?;
        let answers = self.device.read_with(&canvas.reader, &canvas.answers, pixels)?;
        Ok((answers, time))
    }

    fn canvas(&self, size: [u32; 2]) -> Result<Canvas, DeviceError> {
        let device = &self.device;
        let pixels = size[0] as usize * size[1] as usize;
        let [position, normal] = [self.sums; 2].map(|format| device.texture(format, size));
        let (position, normal) = (position?, normal?);
        let answers = device.storage(pixels)?;
        let settings = device.uniform(1)?;
        let (width, height, radius) = (size[0], size[1], self.radius as f32);
        device.write(&settings, &[SentResolve { width, height, radius, unused: 0 }])?;
        let buffers: [&dyn AsBinding; 4] = [&settings, &position, &normal, &answers];
        let resolve = device.bind(&self.resolve, &buffers)?;
        let (depth, reader) = (device.texture(Format::Depth, size)?, device.reader(pixels)?);
        Ok(Canvas { size, position, normal, depth, answers, reader, resolve })
    }
}

/// One pass over all patches.
struct Stage {
    paint: &'static str,
    colours: Vec<(Format, Mixing)>,
    test: DepthTest,
    /// In radii.
    offset: f64,
}

impl Stage {
    fn source(
        &self,
        method: &QuadricsGpu,
        patches: &Patches,
        kind: Kind,
        is_solid: bool,
    ) -> String {
        let is_front = patches.sides() == Sides::Front;
        let constants = [
            ("TETRAHEDRA", is_solid),
            ("LOCAL", method.formula == Formula::Local),
            ("RECIPROCAL", method.formula == Formula::Reciprocal),
            ("BRUTE", method.staging == Staging::Brute),
            ("BOTH", !is_front),
            // In an orthographic view there is no eye to turn away from.
            ("CULLED", is_front && method.culling == Culling::Patches && kind == Kind::Perspective),
            ("PERSPECTIVE", kind == Kind::Perspective),
            ("BYTES", method.sums == Format::Byte),
        ];
        let mut text = String::new();
        for (name, value) in constants {
            text += &format!("const {name} = {value};\n");
        }
        text + &format!("const OFFSET = {:?};\n{SPLAT}{}", self.offset.min(1e6) as f32, self.paint)
    }
}

/// The patches in buffers.
fn parts(
    device: &Device,
    method: &QuadricsGpu,
    patches: &Patches,
    centre: DVec3,
) -> Result<Vec<Part>, DeviceError> {
    let largest = size_of::<SentPatch>().max(size_of::<SentCorners>());
    let most = device.largest_binding() as usize / largest;
    let mut parts = Vec::new();
    for is_solid in [false, true] {
        let of_kind: Vec<_> = patches
            .all()
            .iter()
            .filter(|patch| matches!(patch.bound, Bound::Tetrahedron(_)) == is_solid)
            .collect();
        for chunk in of_kind.chunks(most) {
            let (sent, corners): (Vec<_>, Vec<_>) =
                chunk.iter().map(|patch| send(patch, centre, method.formula)).unzip();
            // Balls have no corners.
            let corners = if is_solid { corners } else { vec![SentCorners::default()] };
            let part = Part {
                is_solid,
                patches: device.storage(sent.len())?,
                corners: device.storage(corners.len())?,
                count: sent.len() as u32,
            };
            device.write(&part.patches, &sent)?;
            device.write(&part.corners, &corners)?;
            parts.push(part);
        }
    }
    Ok(parts)
}
