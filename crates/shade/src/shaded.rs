//! Surfaces in the light.

use glam::Vec3;
use zeroset_raycast::{Hits, View};

use crate::environment::Surroundings;
use crate::legend::{Key, Legend};
use crate::normals::{Side, seen};
use crate::picture::{check_count, check_normals};
use crate::{Colour, Environment, Picture, ShadeError};

/// A light at infinity.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// The direction towards it, in world space, of any length.
    pub direction: Vec3,
    /// What a white surface that faces it reflects; 1 is the display's white.
    pub strength: f32,
    /// The pixels that it does not reach; empty if it reaches all.
    pub blocked: Vec<bool>,
}

impl Light {
    /// A light that reaches everything that faces it.
    pub fn new(direction: Vec3, strength: f32) -> Self {
        Self { direction, strength, blocked: Vec::new() }
    }
}

/// The default lights of a view: a strong one above and to the left of the eye, and a weak one at
/// its right.
pub fn lights(view: &View) -> Vec<Light> {
    let [right, up, forward] = view.camera().frame().map(|v| v.as_vec3());
    vec![
        Light::new(-0.7 * right + 0.9 * up - 0.7 * forward, 0.88),
        Light::new(0.8 * right + 0.1 * up - 0.8 * forward, 0.12),
    ]
}

/// The linear colours of a surface's sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palette {
    /// The side that the gradient points out of.
    pub front: Vec3,
    /// The other.
    pub back: Vec3,
}

/// Ivory and a cool blue.
pub fn palette() -> Palette {
    let (front, back) = (Colour::oklch(0.91, 0.045, 80.0), Colour::oklch(0.80, 0.065, 245.0));
    Palette { front: front.0, back: back.0 }
}

/// The bytes of a shaded picture's background, one colour a row: a soft ramp of greys.
pub fn background(height: usize) -> Vec<[u8; 3]> {
    let last = height.max(2) - 1;
    let grey = |row| Colour::oklch(0.95 - 0.11 * row as f32 / last as f32, 0.006, 260.0);
    (0..height).map(|row| grey(row).bytes()).collect()
}

/// The surface under lights, by Lambert's law on both sides:
/// colour (ambient + sum of strength max(n.l, 0)), with n facing the eye.
///
/// The side that the gradient points out of is ivory, the other a cool blue. The ambient light is
/// brighter from the camera's top. Hits without a normal are grey. The sum is in linear light, and
/// the bytes are encoded as sRGB. In an [`Environment`] that can be mirrored, this is the surface's
/// own colour, and what it mirrors is added.
///
/// # Errors
/// If the hits are not those of the view or have no normals, or a light's blocked pixels are not
/// those of the view.
pub fn picture(
    view: &View,
    hits: &Hits,
    lights: &[Light],
    environment: Environment,
) -> Result<Picture, ShadeError> {
    check_normals(view, hits, "shaded")?;
    for light in lights.iter().filter(|l| !l.blocked.is_empty()) {
        check_count(view, "blocked pixels", light.blocked.len())?;
    }
    let up = view.camera().frame()[1].as_vec3();
    let directions: Vec<Vec3> = lights.iter().map(|l| l.direction.normalize_or_zero()).collect();
    let Palette { front, back } = palette();
    let none = Colour::oklch(0.55, 0.0, 0.0).bytes();
    let background = background(view.height);
    let sky = match environment {
        Environment::Plain => None,
        Environment::Sky => Some(Surroundings::new(view, lights)),
    };
    let direction =
        |i: usize| view.ray(i % view.width, i / view.width).direction.normalize_or_zero();

    let mut description = String::from("Lambert shading; ivory where the gradient faces the eye");
    if lights.iter().any(|l| !l.blocked.is_empty()) {
        description += "; with shadows";
    }
    if sky.is_some() {
        description += "; mirroring a sky over a chequered floor";
    }
    let keys = vec![
        Key::new(Colour(front).bytes(), "seen from f > 0"),
        Key::new(Colour(back).bytes(), "seen from f < 0"),
    ];
    let legend = Legend { scale: None, keys };
    Picture::painted(view, description, Some(legend), |i| {
        if !hits.certificate[i].is_hit() {
            return match &sky {
                None => background[i / view.width],
                Some(sky) => Colour(sky.light(direction(i), i)).bytes(),
            };
        }
        let Some(seen) = seen(view, i, hits.normal[i]) else { return none };
        let mut light = 0.08 + 0.05 * seen.normal.dot(up);
        for (direction, source) in directions.iter().zip(lights) {
            if !source.blocked.get(i).is_some_and(|blocked| *blocked) {
                light += source.strength * seen.normal.dot(*direction).max(0.0);
            }
        }
        let colour = if seen.side == Side::Front { front } else { back };
        let own = light * colour;
        match &sky {
            None => Colour(own).bytes(),
            Some(sky) => Colour(sky.polish(own, direction(i), seen.normal, i)).bytes(),
        }
    })
}
