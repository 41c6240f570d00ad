//! What the shaders read, as they declare it.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3, Vec3};
use zeroset_raycast::{Bound, HalfSpace, Patch, Projection, View};

use crate::piece::{Formula, balanced};

/// The shader's `Frame`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct SentFrame {
    eye: Vec3,
    extent: f32,
    right: Vec3,
    width: f32,
    up: Vec3,
    height: f32,
    forward: Vec3,
    radius: f32,
}

impl SentFrame {
    /// Of a view, about the scene's centre.
    pub(super) fn new(view: &View, centre: DVec3, radius: f64) -> Self {
        let camera = view.camera();
        // In perspective rays start at the eye as rounded.
        let eye = match camera.projection {
            Projection::Perspective { .. } => view.ray(0, 0).origin.as_dvec3(),
            Projection::Orthographic { .. } => camera.eye,
        };
        let [right, up, forward] = camera.frame().map(|v| v.as_vec3());
        Self {
            eye: (eye - centre).as_vec3(),
            extent: view.extent() as f32,
            right,
            width: view.width as f32,
            up,
            height: view.height as f32,
            forward,
            radius: radius as f32,
        }
    }
}

/// The shader's `Patch`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct SentPatch {
    origin: Vec3,
    c: f32,
    diagonal: Vec3,
    radius: f32,
    mixed: Vec3,
    cut_offset: f32,
    b: Vec3,
    unused: f32,
    cut: Vec3,
    unused_too: f32,
    centre: Vec3,
    unused_again: f32,
}

/// The shader's `Corners`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct SentCorners {
    corner: [[f32; 4]; 4],
    linear: [[f32; 4]; 4],
}

/// A patch about the scene's centre.
pub(super) fn send(patch: &Patch, centre: DVec3, formula: Formula) -> (SentPatch, SentCorners) {
    // The paper's formulas take all numbers about one origin.
    let (origin, shift) = match formula {
        Formula::Local => (patch.origin - centre, DVec3::ZERO),
        Formula::Quotient | Formula::Reciprocal => (DVec3::ZERO, patch.origin - centre),
    };
    let (middle, radius) = patch.bound.ball();
    let quadric = match formula {
        Formula::Local => balanced(&patch.quadric, radius),
        Formula::Quotient | Formula::Reciprocal => patch.quadric.about(-shift),
    };
    let cut = patch.clip.map_or((DVec3::ZERO, 0.0), |HalfSpace { normal, offset }| {
        let length = normal.length();
        // As beyond faces, a little more than half counts.
        (normal / length, (offset + normal.dot(shift)) / length + 1e-6 * radius)
    });
    let [x, y, z] = [quadric.a.x_axis, quadric.a.y_axis, quadric.a.z_axis];
    let sent = SentPatch {
        origin: origin.as_vec3(),
        c: quadric.c as f32,
        diagonal: Vec3::new(x.x as f32, y.y as f32, z.z as f32),
        radius: radius as f32,
        mixed: Vec3::new(x.y as f32, y.z as f32, z.x as f32),
        cut_offset: cut.1 as f32,
        b: quadric.b.as_vec3(),
        unused: 0.0,
        cut: cut.0.as_vec3(),
        unused_too: 0.0,
        centre: (middle + shift).as_vec3(),
        unused_again: 0.0,
    };
    let corners = match patch.bound {
        Bound::Ball { .. } => SentCorners::default(),
        Bound::Tetrahedron(corners) => corners_of(corners.map(|corner| corner + shift)),
    };
    (sent, corners)
}

fn corners_of(corners: [DVec3; 4]) -> SentCorners {
    let [p, q, r, s] = corners.map(|corner| corner.extend(1.0));
    let columns = DMat4::from_cols(p, q, r, s).inverse().to_cols_array_2d();
    // Columns to rows.
    let linear = [0, 1, 2, 3].map(|row| [0, 1, 2, 3].map(|column| columns[column][row] as f32));
    SentCorners { corner: corners.map(|c| c.as_vec3().extend(0.0).to_array()), linear }
}

/// The shader's `Resolve`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct SentResolve {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) radius: f32,
    pub(super) unused: u32,
}

/// The shader's `Answer`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Answer {
    /// About the scene's centre.
    pub(super) position: Vec3,
    /// 0 where nothing was hit.
    pub(super) weight: f32,
    pub(super) normal: Vec3,
    unused: f32,
}
