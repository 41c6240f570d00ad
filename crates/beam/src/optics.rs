//! From the image to space: the boxes of beams.
//!
//! The ray through (u, v), in pixels, is `origin + t direction`. In perspective the origin is the eye, and
//! `direction = w / |w|` with `w = a + u b + v c`; in an orthographic view the direction is fixed, and
//! `origin = a + u b + v c`. Over a base U x V, intervals enclose the vector that varies; a piece's box is
//! `origin + T direction`. So t is a distance along rays of unit length, as rays have it: a beam's t and its
//! rays' t are the same number.
//!
//! Rays are rounded to single precision ([`View::ray_at`]), and a beam holds them as rounded: the
//! enclosure is widened by [`slack`](Optics::slack).

use std::sync::LazyLock;

use glam::{DVec3, Vec3};
use zeroset_expr::{Function, Parameters, Tape};
use zeroset_raycast::{Domain, Error, Projection, Unsupported, View};

/// What of a ray varies over the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Varying {
    /// Perspective.
    Direction,
    /// Orthographic.
    Origin,
}

/// A view's rays, as functions of the place in the image.
#[derive(Clone, Debug)]
pub(crate) struct Optics {
    pub varying: Varying,
    /// The components of the vector that varies, over x = u and y = v in pixels.
    pub tapes: [Tape; 3],
    /// How far rounding moves them, at most.
    pub slack: f32,
    /// The vector that does not vary: exact.
    pub fixed: Vec3,
    /// Holds each t at which a ray is in the domain.
    pub range: [f32; 2],
    /// Coordinates along the beams are at most as large.
    reach: f64,
}

/// One component of a unit vector along `a + u b + v c`, in a frame of unit vectors in which its last
/// component is 1.
static DIRECTION: LazyLock<Function> = LazyLock::new(|| {
    let text = "(ka + kb*x + kc*y) / sqrt(1 + (scale*(x - middle))^2 + (scale*(y - centre))^2); \
                ka = 1; kb = 1; kc = 1; scale = 1; middle = 1; centre = 1";
    Function::parse(text).expect("an equation")
});

/// One component of `a + u b + v c`.
static ORIGIN: LazyLock<Function> = LazyLock::new(|| {
    Function::parse("ka + kb*x + kc*y; ka = 1; kb = 1; kc = 1").expect("an equation")
});

/// Bits to which constants are known.
const PRECISION: usize = 128;
/// 2^100: coordinates are at most as large.
const FARTHEST: f64 = f64::from_bits((1023 + 100) << 52);
/// 2^60: the same on devices, where the squares of distances must not overflow.
const FARTHEST_ON_DEVICE: f64 = f64::from_bits((1023 + 60) << 52);
/// Half the image's height or width at distance 1, at most: an angle of 179.9998 degrees.
const WIDEST: f64 = f64::from_bits((1023 + 20) << 52);
/// 2^-40: how far the camera's frame may be from unit vectors at right angles, far below what rays are rounded
/// by.
const SKEWEST: f64 = f64::from_bits((1023 - 40) << 52);
/// More than the relative error of the length of a ray's direction.
const LENGTH_ERROR: f64 = f64::from_bits((1023 - 20) << 52);

impl Optics {
    /// The rays of a view; none if its camera has none.
    ///
    /// # Errors
    /// If it is too far away or too wide for single precision.
    pub(crate) fn new(view: &View, domain: &Domain) -> Result<Option<Self>, Error> {
        let (camera, size) = (view.camera(), [view.width as f64, view.height as f64]);
        let corners = [0.0, 1.0].map(|v| [0.0, 1.0].map(|u| view.ray_at(u * size[0], v * size[1])));
        if !corners.as_flattened().iter().all(|ray| ray.is_valid()) {
            return Ok(None);
        }
        let [right, up, forward] = camera.frame();
        // Space a pixel, and the image's middle in pixels.
        let (scale, middle) = (view.extent() / (0.5 * size[1]), size.map(|n| 0.5 * n));
        let (b, c) = (scale * right, -scale * up);
        let reach = scale.abs() * middle[0].max(middle[1]);
        let eye = camera.eye.abs().max_element();
        let refused = |what: &str| {
            let why = format!("{what} for beams in single precision");
            Err(Error::Unsupported(Unsupported(why)))
        };
        // The formula for directions presumes a frame at right angles, which there is not if `up` is nearly
        // along the view.
        let skew = [right.dot(up), right.dot(forward), up.dot(forward)];
        let stretch = [right, up, forward].map(|v| v.length_squared() - 1.0);
        if !skew.iter().chain(&stretch).all(|x| x.abs() < SKEWEST) {
            return refused("up is too nearly along the view");
        }
        let range = range(view, domain, reach);
        let farthest = eye.max(reach).max(range[1]);
        if !(farthest < FARTHEST) {
            return refused("the camera or the domain is too far away");
        }
        let number = |x: f64| format!("{x:e}");
        let tape = |function: &Function, values: &[(&str, f64)]| {
            let mut parameters = Parameters::default();
            values.iter().for_each(|(name, value)| parameters.set(name, &number(*value)));
            function.tape(&parameters, PRECISION)
        };
        let a = |middle_of_image: DVec3| middle_of_image - middle[0] * b - middle[1] * c;
        let ray = view.ray(0, 0);
        let (varying, at_zero, slack, fixed) = match camera.projection {
            Projection::Perspective { .. } => {
                if !(reach < WIDEST) {
                    return refused("the field of view is too wide");
                }
                // Half a unit in the last place of a number below 1, and as much for double precision.
                (Varying::Direction, a(forward), f32::EPSILON / 2.0, ray.origin)
            }
            Projection::Orthographic { .. } => {
                let largest = eye + 2.0 * reach;
                let slack = (largest as f32) * f32::EPSILON + f32::MIN_POSITIVE;
                (Varying::Origin, a(camera.eye), slack, ray.direction)
            }
        };
        let mut tapes = Vec::with_capacity(3);
        for axis in 0..3 {
            let linear = [("ka", at_zero[axis]), ("kb", b[axis]), ("kc", c[axis])];
            tapes.push(match varying {
                Varying::Direction => {
                    let rest = [("scale", scale), ("middle", middle[0]), ("centre", middle[1])];
                    tape(&DIRECTION, &[linear, rest].concat())?
                }
                Varying::Origin => tape(&ORIGIN, &linear)?,
            });
        }
        let tapes = tapes.try_into().expect("three");
        let range = [(range[0] as f32).next_down().max(0.0), (range[1] as f32).next_up()];
        Ok(Some(Self { varying, tapes, slack, fixed, range, reach: farthest }))
    }
}

impl Optics {
    /// May a device compute with it?
    ///
    /// # Errors
    /// If something is too far away.
    pub(crate) fn check_device(&self) -> Result<(), Unsupported> {
        let is_normal = |x: f32| x == 0.0 || x.is_normal();
        if self.reach < FARTHEST_ON_DEVICE && self.fixed.to_array().into_iter().all(is_normal) {
            return Ok(());
        }
        let why = "the camera or the domain is too far away, or a part of the view's direction too small, \
                   for beams on a device: use a CPU method";
        Err(Unsupported(why.into()))
    }
}

/// Holds each t at which a ray of the view may be in the domain.
fn range(view: &View, domain: &Domain, reach: f64) -> [f64; 2] {
    let camera = view.camera();
    let corner = |i: usize| {
        let ends = [domain.min, domain.max];
        DVec3::new(ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2].z)
    };
    let [near, far] = match camera.projection {
        Projection::Perspective { .. } => {
            // Where rays start: the eye as rounded.
            let eye = view.ray(0, 0).origin.as_dvec3();
            let near = (eye.clamp(domain.min, domain.max) - eye).length();
            let far = (0..8).map(|i| (corner(i) - eye).length()).fold(0.0, f64::max);
            [near * (1.0 - LENGTH_ERROR), far * (1.0 + LENGTH_ERROR)]
        }
        Projection::Orthographic { .. } => {
            let [_, _, forward] = camera.frame();
            let away = (0..8).map(|i| corner(i) - camera.eye);
            let (mut near, mut far) = (f64::INFINITY, 0.0_f64);
            for v in away {
                // Origins are rounded too, by units of their coordinates.
                let size = v.length() + camera.eye.length() + 2.0 * reach;
                let slack = size * LENGTH_ERROR;
                near = near.min(v.dot(forward) - slack);
                far = far.max(v.dot(forward) + slack);
            }
            [near, far]
        }
    };
    [near.max(0.0), far.max(near).max(0.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    use zeroset_raycast::Camera;

    #[test]
    fn frames_that_are_not_at_right_angles_are_refused() {
        let domain = Domain::new(DVec3::splat(-1.0), DVec3::splat(1.0)).expect("a box");
        let eye = DVec3::new(2.3, 3.5, 4.7);
        // Beside the view by less and less; what is left of `up` is then noise.
        for (beside, is_refused) in [(1.0, false), (1e-2, false), (1e-9, true), (1e-12, true)] {
            let up = eye + beside * DVec3::X;
            let camera = Camera { eye, at: DVec3::ZERO, up, ..Camera::facing(&domain) };
            let optics = Optics::new(&View::new(camera, 8, 8), &domain);
            let refused = matches!(optics, Err(Error::Unsupported(_)));
            assert_eq!(refused, is_refused, "{beside}: {optics:?}");
        }
    }

    #[test]
    fn ranges_begin_where_rays_do() {
        // Single precision has no such eye: rays start a little before it, inside the box.
        let domain = Domain::new(DVec3::splat(-1000.0), DVec3::splat(1000.0)).expect("a box");
        let eye = DVec3::new(1000.00003, 0.0, 0.0);
        let camera = Camera { eye, at: DVec3::new(0.0, 500.0, 0.0), ..Camera::facing(&domain) };
        let optics = Optics::new(&View::new(camera, 8, 8), &domain).expect("a view");
        assert_eq!(optics.expect("rays").range[0], 0.0);
    }
}
