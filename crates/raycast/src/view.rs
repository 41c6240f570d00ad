//! Views: a camera and its pixels.

use std::fmt::{self, Display};

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

    /// Right, up and forward: unit vectors at right angles. They are NaN, and no ray is valid, if
    /// `eye` is `at`, or if `up` is 0 or along the view.
    pub fn frame(&self) -> [DVec3; 3] {
        let forward = (self.at - self.eye).normalize();
        let right = forward.cross(self.up).normalize();
        [right, right.cross(forward), forward]
    }
}

/// `eye=x,y,z,at=x,y,z,up=x,y,z,fov=DEGREES` or `..,ortho=HEIGHT`, as the command line takes it; the
/// numbers read back exactly.
impl Display for Camera {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (key, v) in [("eye", self.eye), ("at", self.at), ("up", self.up)] {
            write!(f, "{key}={:?},{:?},{:?},", v.x, v.y, v.z)?;
        }
        match self.projection {
            Projection::Perspective { fov } => write!(f, "fov={fov:?}"),
            Projection::Orthographic { height } => write!(f, "ortho={height:?}"),
        }
    }
}

/// A camera and the size of its image. Pixel (0, 0) is at the top left, its centre at (0.5, 0.5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    camera: Camera,
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

    /// The camera.
    pub fn camera(&self) -> Camera {
        self.camera
    }

    /// The ray through the centre of a pixel. Its direction is a unit vector before rounding to
    /// single precision, so that t is a distance to about seven digits.
    #[inline(always)]
    pub fn ray(&self, column: usize, row: usize) -> Ray {
        self.ray_at(column as f64 + 0.5, row as f64 + 0.5)
    }

    /// The ray through a place in the image, in pixels from the left and from the top: pixel (c, r)
    /// covers [c, c + 1] and [r, r + 1].
    #[inline(always)]
    pub fn ray_at(&self, column: f64, row: f64) -> Ray {
        let [right, up, forward] = self.frame;
        // In units of half the image's height.
        let half = 0.5 * self.height as f64;
        let u = (column - 0.5 * self.width as f64) / half;
        let v = (0.5 * self.height as f64 - row) / half;
        let offset = self.extent * (u * right + v * up);
        let (origin, direction) = match self.camera.projection {
            Projection::Perspective { .. } => (self.camera.eye, forward + offset),
            Projection::Orthographic { .. } => (self.camera.eye + offset, forward),
        };
        Ray::new(to_single(origin), to_single(direction.normalize()))
    }

    /// Half the image's height in space: at distance 1 in perspective.
    pub fn extent(&self) -> f64 {
        self.extent
    }

    /// The width in space of a pixel at distance `t` from the eye, along the view's middle; towards
    /// the edges of a perspective view it is less.
    pub fn footprint(&self, t: f64) -> f64 {
        match self.camera.projection {
            Projection::Perspective { .. } => 2.0 * t * self.extent / self.height as f64,
            Projection::Orthographic { height } => height / self.height as f64,
        }
    }
}

/// Rounds to single precision; -0 becomes 0.
#[inline(always)]
fn to_single(v: DVec3) -> Vec3 {
    v.as_vec3() + Vec3::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;

    fn domain() -> Domain {
        Domain::new(DVec3::new(-1.0, -2.0, -0.5), DVec3::new(3.0, 2.0, 0.5)).unwrap()
    }

    /// A camera at the origin that looks along y, with x to the right and z up.
    fn simple(projection: Projection) -> Camera {
        Camera { eye: DVec3::ZERO, at: DVec3::Y, up: DVec3::Z, projection }
    }

    #[test]
    fn pixel_centres_are_at_one_half() {
        // tan(45 degrees) = 1: half the height is 1 at distance 1.
        let view = View::new(simple(Projection::Perspective { fov: 90.0 }), 4, 2);
        for row in 0..2 {
            for column in 0..4 {
                let d = view.ray(column, row).direction.as_dvec3();
                let (u, v) = (d.x / d.y, d.z / d.y);
                assert!((u - (column as f64 + 0.5 - 2.0)).abs() < 1e-6, "{column} {row}: {u}");
                assert!((v - (0.5 - row as f64)).abs() < 1e-6, "{column} {row}: {v}");
                assert!((d.length() - 1.0).abs() < 1e-7);
                assert_eq!(view.ray(column, row).origin, Vec3::ZERO);
            }
        }
    }

    #[test]
    fn the_first_row_is_at_the_top_and_the_first_column_at_the_left() {
        let camera = Camera::facing(&domain());
        let [right, up, _] = camera.frame();
        let view = View::new(camera, 30, 20);
        let along = |ray: Ray, v: DVec3| ray.direction.as_dvec3().dot(v);
        let corners = [(0, 0), (29, 0), (0, 19), (29, 19)].map(|(c, r)| view.ray(c, r));
        assert!(along(corners[0], up) > 0.0 && along(corners[0], right) < 0.0);
        assert!(along(corners[1], up) > 0.0 && along(corners[1], right) > 0.0);
        assert!(along(corners[2], up) < 0.0 && along(corners[2], right) < 0.0);
        assert!(along(corners[3], up) < 0.0 && along(corners[3], right) > 0.0);
        assert!(up.z > 0.0);
    }

    #[test]
    fn the_frame_is_right_handed_towards_the_viewer() {
        let [right, up, forward] = Camera::facing(&domain()).frame();
        assert!((right.cross(up) + forward).length() < 1e-15);
        for (a, b) in [(right, up), (up, forward), (forward, right)] {
            assert!(a.dot(b).abs() < 1e-15 && (a.length() - 1.0).abs() < 1e-15);
        }
        assert_eq!(simple(Projection::Orthographic { height: 1.0 }).frame()[0], DVec3::X);
    }

    #[test]
    fn the_default_camera_fills_the_view_with_the_bounding_sphere() {
        for domain in [domain(), domain().with_ball(0.7).unwrap()] {
            let camera = Camera::facing(&domain);
            let [_, up, forward] = camera.frame();
            let view = View::new(camera, 1, 2000);
            let centre = domain.centre() - camera.eye;
            // The distance of the topmost and of the lowest ray from the centre is the radius.
            for row in [0, 1999] {
                let d = view.ray(0, row).direction.as_dvec3();
                let distance = centre.cross(d).length();
                let pixel = view.footprint(centre.length());
                assert!((distance - domain.radius()).abs() < pixel, "{distance}");
            }
            let toward = (camera.eye - domain.centre()).normalize();
            assert!((toward - DVec3::new(0.8, -1.0, 0.55).normalize()).length() < 1e-15);
            assert!((centre.normalize() - forward).length() < 1e-15);
            assert!(up.z > 0.0);
        }
    }

    #[test]
    fn orthographic_rays_are_parallel_and_start_in_a_plane() {
        let view = View::new(simple(Projection::Orthographic { height: 4.0 }), 6, 4);
        for row in 0..4 {
            for column in 0..6 {
                let ray = view.ray(column, row);
                assert_eq!(ray.direction, Vec3::Y);
                let expected = Vec3::new(column as f32 - 2.5, 0.0, 1.5 - row as f32);
                assert_eq!(ray.origin, expected);
            }
        }
        assert_eq!(view.footprint(1.0), 1.0);
        assert_eq!(view.footprint(1e9), 1.0);
    }

    #[test]
    fn a_footprint_is_what_neighbouring_rays_are_apart() {
        let view = View::new(simple(Projection::Perspective { fov: 40.0 }), 101, 101);
        let (t, [a, b]) = (7.0, [50, 51].map(|column| view.ray(column, 50)));
        let apart = (a.at(t) - b.at(t)).length();
        assert!((apart - view.footprint(t)).abs() < 1e-3 * apart);
    }

    #[test]
    fn no_direction_is_minus_zero() {
        let view = View::new(simple(Projection::Perspective { fov: 40.0 }), 3, 3);
        let middle = view.ray(1, 1);
        for x in middle.direction.to_array().into_iter().chain(middle.origin.to_array()) {
            assert!(x != 0.0 || x.is_sign_positive());
        }
    }

    #[test]
    fn a_camera_that_sees_nothing_has_no_valid_ray() {
        let good = simple(Projection::Perspective { fov: 40.0 });
        for bad in [
            Camera { at: good.eye, ..good },
            Camera { up: DVec3::Y, ..good },
            Camera { up: DVec3::ZERO, ..good },
            Camera { eye: DVec3::new(1e300, 0.0, 0.0), ..good },
        ] {
            let view = View::new(bad, 2, 2);
            assert!((0..4).all(|i| !view.ray(i % 2, i / 2).is_valid()), "{bad:?}");
        }
    }
}
