//! Views: a camera and its pixels.

use glam::{DVec3, Vec3};

use crate::{Domain, Ray};

/// How space is mapped to the image plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Rays from the eye; the vertical field of view in degrees.
    Perspective {
        /// Vertical field of view, degrees.
        fov: f64,
    },
    /// Parallel rays; the height of the image in space.
    Orthographic {
        /// Height of the image, in units of space.
        height: f64,
    },
}

/// A camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where rays start (in an orthographic view, the centre of the plane where they start).
    pub eye: DVec3,
    /// The point that is seen in the middle of the image.
    pub at: DVec3,
    /// The direction that is up in the image.
    pub up: DVec3,
    /// Perspective or orthographic.
    pub projection: Projection,
}

impl Camera {
    /// The default camera of a domain: z up, looking at the centre from direction (0.8, -1, 0.55),
    /// 40 degrees vertically, the domain's bounding sphere filling the view.
    pub fn facing(domain: &Domain) -> Self {
        let fov = 40.0_f64;
        let distance = domain.radius() / (0.5 * fov).to_radians().sin();
        let at = domain.centre();
        let eye = at + distance * DVec3::new(0.8, -1.0, 0.55).normalize();
        Self { eye, at, up: DVec3::Z, projection: Projection::Perspective { fov } }
    }

    /// Right, up and forward: unit vectors, right-handed as seen from the eye.
    pub fn frame(&self) -> [DVec3; 3] {
        let forward = (self.at - self.eye).normalize();
        let right = forward.cross(self.up).normalize();
        [right, right.cross(forward), forward]
    }
}

/// A camera and the size of its image. Pixel (0, 0) is at the top left, its centre at (0.5, 0.5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: Camera,
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    frame: [DVec3; 3],
    /// Half the image's height in space: at distance 1 in perspective.
    extent: f64,
}

impl View {
    /// A view of `width` by `height` pixels.
    pub fn new(camera: Camera, width: usize, height: usize) -> Self {
        let extent = match camera.projection {
            Projection::Perspective { fov } => (0.5 * fov).to_radians().tan(),
            Projection::Orthographic { height } => 0.5 * height,
        };
        Self { camera, width, height, frame: camera.frame(), extent }
    }

    /// The ray through the centre of a pixel. Its direction is a unit vector before rounding to
    /// single precision, so that t is a distance to about seven digits.
    #[inline]
    pub fn ray(&self, column: usize, row: usize) -> Ray {
        let [right, up, forward] = self.frame;
        // In units of half the image's height.
        let half = 0.5 * self.height as f64;
        let u = (column as f64 + 0.5 - 0.5 * self.width as f64) / half;
        let v = (0.5 * self.height as f64 - (row as f64 + 0.5)) / half;
        let offset = self.extent * (u * right + v * up);
        let (origin, direction) = match self.camera.projection {
            Projection::Perspective { .. } => (self.camera.eye, forward + offset),
            Projection::Orthographic { .. } => (self.camera.eye + offset, forward),
        };
        Ray::new(to_single(origin), to_single(direction.normalize()))
    }

    /// The width in space of a pixel at distance `t` from the eye.
    pub fn footprint(&self, t: f64) -> f64 {
        match self.camera.projection {
            Projection::Perspective { .. } => 2.0 * t * self.extent / self.height as f64,
            Projection::Orthographic { height } => height / self.height as f64,
        }
    }
}

/// Rounds to single precision; -0 becomes 0.
#[inline]
fn to_single(v: DVec3) -> Vec3 {
    v.as_vec3() + Vec3::ZERO
}
