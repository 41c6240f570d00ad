//! What surrounds a surface: seen past it, and mirrored by it (\[singh2010\], Fig. 1).

use std::fmt;

use glam::Vec3;
use zeroset_raycast::View;

use crate::{Colour, Light, ShadeError};

/// What surrounds a surface, infinitely far away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Environment {
    /// A soft ramp of greys, which nothing mirrors.
    #[default]
    Plain,
    /// A sky over a chequered floor, with the lights as suns. The surface mirrors it, as polished
    /// stone does.
    Sky,
}

impl Environment {
    /// All environments.
    pub const ALL: [Self; 2] = [Self::Plain, Self::Sky];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Sky => "sky",
        }
    }

    /// The environment of that name.
    ///
    /// # Errors
    /// [`ShadeError::UnknownEnvironment`] lists the names.
    pub fn from_name(name: &str) -> Result<Self, ShadeError> {
        Self::ALL.into_iter().find(|environment| environment.name() == name).ok_or_else(|| {
            ShadeError::UnknownEnvironment {
                name: name.into(),
                known: Self::ALL.map(Self::name).join(", "),
            }
        })
    }
}

impl fmt::Display for Environment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The share of the light that is mirrored where the surface faces the eye.
pub const FACING: f32 = 0.22;

/// The side of a tile, in units of the eye's height above the floor.
pub const TILE: f32 = 0.8;

/// How far one sees before half of the contrast is lost in haze, in the same unit.
pub const CLEAR: f32 = 7.0;

/// The angle over which a direction is blurred, so that tiles do not alias where surfaces curve:
/// radians.
pub const BLUR: f32 = 0.005;

/// Where a sky over a chequered floor is, and its linear colours.
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
}

impl Sky {
    /// The sky of a view: its zenith is where the camera's `up` points, so that it stays where it is
    /// when the camera's azimuth turns.
    pub fn new(view: &View) -> Self {
        let up = view.camera().up.normalize_or(glam::DVec3::Z).as_vec3();
        let (a, b) = up.any_orthonormal_pair();
        Self {
            up,
            edges: [a, b],
            zenith: Colour::oklch(0.50, 0.12, 255.0).0,
            horizon: Colour::oklch(0.93, 0.035, 225.0).0,
            tiles: [Colour::oklch(0.78, 0.03, 80.0).0, Colour::oklch(0.42, 0.05, 45.0).0],
            sun: Colour::oklch(0.98, 0.03, 90.0).0,
        }
    }

    /// The floor, one unit below; `depth` is by how much the direction, a unit vector, goes down.
    fn floor(&self, direction: Vec3, depth: f32) -> Vec3 {
        let distance = 1.0 / depth.max(1e-4);
        // A blur of the direction grows with the square of the distance when it reaches the floor.
        let blur = BLUR * distance * distance;
        let [a, b] =
            self.edges.map(|edge| stripes(direction.dot(edge) * distance / TILE, blur / TILE));
        let [light, dark] = self.tiles;
        let tiles = dark.lerp(light, 0.5 + 0.5 * a * b);
        tiles.lerp(self.horizon, 1.0 - (-distance / CLEAR).exp2())
    }
}

/// The light of a sky with suns, by direction.
pub(crate) struct Surroundings<'a> {
    sky: Sky,
    lights: &'a [Light],
    /// Unit vectors towards them.
    towards: Vec<Vec3>,
}

impl<'a> Surroundings<'a> {
    pub(crate) fn new(view: &View, lights: &'a [Light]) -> Self {
        let towards = lights.iter().map(|light| light.direction.normalize_or_zero()).collect();
        Self { sky: Sky::new(view), lights, towards }
    }

    /// The light from a direction, a unit vector, as it reaches a pixel: suns that are blocked
    /// there do not.
    pub(crate) fn light(&self, direction: Vec3, pixel: usize) -> Vec3 {
        let height = direction.dot(self.sky.up);
        let around = if height > 0.0 {
            self.sky.horizon.lerp(self.sky.zenith, height.sqrt())
        } else {
            self.sky.floor(direction, -height)
        };
        let mut light = around;
        for (towards, source) in self.towards.iter().zip(self.lights) {
            if !source.blocked.get(pixel).is_some_and(|blocked| *blocked) {
                light += source.strength * glow(direction.dot(*towards)) * self.sky.sun;
            }
        }
        light
    }

    /// What a surface shows: its own colour, and what it mirrors, r = d - 2 (n.d) n, more of it the
    /// more obliquely it is seen (C. Schlick, "An inexpensive BRDF model", 1994).
    pub(crate) fn polish(&self, own: Vec3, direction: Vec3, normal: Vec3, pixel: usize) -> Vec3 {
        let cosine = -direction.dot(normal);
        let mirrored = self.light(direction + 2.0 * cosine * normal, pixel);
        let share = FACING + (1.0 - FACING) * (1.0 - cosine.clamp(0.0, 1.0)).powi(5);
        own.lerp(mirrored, share)
    }
}

/// A sun's disc, 3 degrees wide, and the glow around it, by the cosine of the angle from its centre.
fn glow(cosine: f32) -> f32 {
    let angle = cosine.clamp(-1.0, 1.0).acos().to_degrees();
    let disc = (2.5 - angle).clamp(0.0, 1.0);
    let around = |degrees: f32| (-(angle / degrees).powi(2)).exp();
    6.0 * disc + 0.7 * around(6.0) + 0.25 * around(20.0)
}

/// The mean over a width of the wave that is 1 on (0, 1), -1 on (1, 2), and so on.
fn stripes(x: f32, width: f32) -> f32 {
    // The integral of the wave: 0 at even numbers, 1 at odd ones.
    let integral = |x: f32| 1.0 - (x.rem_euclid(2.0) - 1.0).abs();
    let width = width.max(1e-3);
    (integral(x + 0.5 * width) - integral(x - 0.5 * width)) / width
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use zeroset_raycast::{Camera, Domain};

    use super::*;

    fn view() -> View {
        let domain = Domain::new(DVec3::NEG_ONE, DVec3::ONE).unwrap();
        View::new(Camera::facing(&domain), 4, 4)
    }

    #[test]
    fn names_lead_back_to_environments() {
        for environment in Environment::ALL {
            assert_eq!(Environment::from_name(environment.name()).unwrap(), environment);
        }
        let message = Environment::from_name("forest").unwrap_err().to_string();
        assert_eq!(message, "there is no environment \"forest\"; there are plain, sky");
    }

    #[test]
    fn the_sky_is_blue_above_and_chequered_below() {
        let view = view();
        let around = Surroundings::new(&view, &[]);
        let above = around.light(Vec3::Z, 0);
        assert!(above.z > above.x, "{above}");
        assert_eq!(above, around.sky.zenith);
        // Neighbouring tiles differ, tiles across a corner do not.
        let [a, b] = around.sky.edges;
        let tile = |i: f32, j: f32| {
            let at = TILE * ((i + 0.5) * a + (j + 0.5) * b);
            around.light((at - around.sky.up).normalize(), 0)
        };
        let difference = |p: Vec3, q: Vec3| (p - q).abs().max_element();
        assert!(difference(tile(0.0, 0.0), tile(0.0, 1.0)) > 0.1);
        assert!(difference(tile(0.0, 0.0), tile(-1.0, 0.0)) > 0.1);
        assert!(difference(tile(0.0, 0.0), tile(-1.0, -1.0)) < 1e-4);
        // Floor and sky meet in haze.
        let level = |height: f32| around.light((a + height * around.sky.up).normalize(), 0);
        assert!(difference(level(1e-6), level(-1e-6)) < 0.01);
    }

    #[test]
    fn suns_stand_where_lights_do_unless_they_are_blocked() {
        let view = view();
        let lights =
            [Light { blocked: vec![false, true], ..Light::new(Vec3::new(0.0, 3.0, 4.0), 0.5) }];
        let around = Surroundings::new(&view, &lights);
        let none = Surroundings::new(&view, &[]);
        let towards = Vec3::new(0.0, 0.6, 0.8);
        assert!((around.light(towards, 0) - none.light(towards, 0)).min_element() > 1.0);
        assert_eq!(around.light(towards, 1), none.light(towards, 1));
        let away = around.light(-towards, 0) - none.light(-towards, 0);
        assert!(away.abs().max_element() < 1e-6);
    }

    #[test]
    fn surfaces_mirror_what_lies_at_the_mirrored_angle() {
        let view = view();
        let around = Surroundings::new(&view, &[]);
        // From above onto a slope of 45 degrees: what is seen lies to the side.
        let normal = Vec3::new(1.0, 0.0, 1.0).normalize();
        let shown = around.polish(Vec3::ZERO, -Vec3::Z, normal, 0);
        let cosine = 0.5_f32.sqrt();
        let share = FACING + (1.0 - FACING) * (1.0 - cosine).powi(5);
        let expected = share * around.light(Vec3::X, 0);
        assert!((shown - expected).abs().max_element() < 1e-2, "{shown} {expected}");
        // Along the surface it is a mirror, and seen from the front mostly itself.
        let along = around.polish(Vec3::ONE, Vec3::Y, normal, 0);
        assert!((along - around.light(Vec3::Y, 0)).abs().max_element() < 1e-5);
        let front = around.polish(Vec3::ZERO, -Vec3::Z, Vec3::Z, 0);
        assert!((front - FACING * around.sky.zenith).abs().max_element() < 1e-5);
    }

    #[test]
    fn stripes_are_a_wave_that_blur_levels() {
        assert_eq!([0.5, 1.5, 2.5, -0.5].map(|x| stripes(x, 0.01).round()), [1.0, -1.0, 1.0, -1.0]);
        assert!(stripes(0.5, 2.0).abs() < 1e-6 && stripes(0.5, 1e9).abs() < 1e-3);
    }
}
