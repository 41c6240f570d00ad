//! Lights and surroundings from text.

use clap::{Args, ValueEnum};
use glam::{DVec3, Vec3};
use zeroset::raycast::View;
use zeroset::shade::{Environment, Light, ViewKind, shaded};

use crate::failure::Failure;
use crate::numbers;

/// Lights, whether they cast shadows, and what surrounds the surface.
#[derive(Args, Clone, Debug)]
pub(crate) struct LightOptions {
    /// The direction towards a light at infinity, in the coordinates of the equation, of any
    /// length; repeatable: n lights have 1/n of the light each [default: a strong light above and
    /// to the left of the eye, and a weak one at its right]
    #[arg(long = "light", value_name = "X,Y,Z", value_parser = direction)]
    #[arg(allow_hyphen_values = true)]
    lights: Vec<Vec3>,
    /// Whether a shadow ray is cast from each hit to each light that it faces
    #[arg(long, value_name = "on|off", value_enum, default_value_t, hide_possible_values = true)]
    pub(crate) shadows: Shadows,
    /// What surrounds the surface: plain, greys that nothing mirrors; or sky, a sky over a chequered
    /// floor, with the lights as suns, which the surface mirrors
    #[arg(long, value_name = "plain|sky", value_parser = environment, default_value_t)]
    pub(crate) environment: Environment,
}

/// Are shadow rays cast?
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Shadows {
    /// None.
    #[default]
    Off,
    /// One from each hit to each light that it faces.
    On,
}

impl LightOptions {
    /// Refuses light on pictures that show none.
    pub(crate) fn check(&self, view: ViewKind) -> Result<(), Failure> {
        let option = match (&self.lights[..], self.shadows, self.environment) {
            (_, Shadows::On, _) => "--shadows on",
            ([_, ..], _, _) => "--light",
            (_, _, Environment::Sky) => "--environment sky",
            _ => return Ok(()),
        };
        if view == ViewKind::Shaded {
            return Ok(());
        }
        Err(Failure::usage(format!("{option} is for --view shaded; --view {view} shows no light")))
    }

    /// The lights of a view.
    pub(crate) fn lights(&self, view: &View) -> Vec<Light> {
        if self.lights.is_empty() {
            return shaded::lights(view);
        }
        let strength = 1.0 / self.lights.len() as f32;
        self.lights.iter().map(|direction| Light::new(*direction, strength)).collect()
    }
}

/// Reads the name of an environment.
fn environment(text: &str) -> Result<Environment, String> {
    Environment::from_name(text).map_err(|error| error.to_string())
}

/// Reads `X,Y,Z`, and makes it a unit vector.
fn direction(text: &str) -> Result<Vec3, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let &[x, y, z] = &parts[..] else {
        return Err(format!("{} numbers; give three: x,y,z", parts.len()));
    };
    let given = DVec3::new(numbers::finite(x)?, numbers::finite(y)?, numbers::finite(z)?);
    if given == DVec3::ZERO {
        return Err("0,0,0 is no direction".into());
    }
    // Squares of what is left neither overflow nor all vanish.
    Ok((given / given.abs().max_element()).normalize().as_vec3())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_of_any_length_but_zero() {
        let unit = Vec3::new(0.6, 0.0, -0.8);
        for text in ["3,0,-4", "3e300, 0, -4e300", "3e-310,0,-4e-310"] {
            assert!((direction(text).unwrap() - unit).length() < 1e-6, "{text}");
        }
        for (text, says) in [
            ("0,0,0", "no direction"),
            ("-0,0,0", "no direction"),
            ("1,2", "three"),
            ("", "three"),
            ("1,2,3,4", "three"),
            ("1,2,up", "\"up\""),
            ("1,2,nan", "finite"),
            ("inf,2,3", "finite"),
        ] {
            let error = direction(text).unwrap_err();
            assert!(error.contains(says), "{text}: {error}");
        }
    }
}
