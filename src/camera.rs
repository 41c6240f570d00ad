//! Cameras from text.

use glam::DVec3;
use zeroset::raycast::{Camera, Domain, Projection};

use crate::failure::Failure;
use crate::numbers;

/// What a user says of the camera; the rest is the default.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct CameraText {
    eye: Option<DVec3>,
    at: Option<DVec3>,
    up: Option<DVec3>,
    projection: Option<Projection>,
}

impl CameraText {
    /// The camera for a domain. Without `eye` it looks from direction (0.8, -1, 0.55), from where
    /// the domain's bounding sphere fills the view.
    pub(crate) fn camera(&self, domain: &Domain) -> Result<Camera, Failure> {
        let standard = Camera::facing(domain);
        let (eye, centre) = (standard.eye.as_vec3(), standard.at.as_vec3());
        if !eye.is_finite() || eye == centre {
            let [min, max] = [domain.min, domain.max].map(|corner| corner.to_array());
            return Err(Failure::usage(format!(
                "the domain {min:?} to {max:?} is too large or too small to be seen along rays in \
                 single precision; give another --domain"
            )));
        }
        let at = self.at.unwrap_or(standard.at);
        let projection = self.projection.unwrap_or(standard.projection);
        let eye = self.eye.unwrap_or_else(|| {
            let away = standard.eye - standard.at;
            let distance = match projection {
                Projection::Perspective { fov } => domain.radius() / (0.5 * fov).to_radians().sin(),
                Projection::Orthographic { .. } => away.length(),
            };
            at + distance * away.normalize()
        });
        let camera = Camera { eye, at, up: self.up.unwrap_or(standard.up), projection };
        if !camera.eye.as_vec3().is_finite() || !camera.at.is_finite() {
            return Err(Failure::usage(format!(
                "the camera's eye {:?} is beyond single precision, in which rays start; give a nearer \
                 one with --camera, or another --domain",
                camera.eye.to_array()
            )));
        }
        if camera.frame().iter().any(|v| !v.is_finite()) {
            return Err(Failure::usage(format!(
                "the camera {camera} sees nothing: eye and at must differ, and up must not point \
                 along the view"
            )));
        }
        Ok(camera)
    }
}

/// Reads `eye=x,y,z,at=x,y,z,up=x,y,z,fov=degrees` or `..ortho=height`; any part may be left out.
pub(crate) fn parse(text: &str) -> Result<CameraText, String> {
    let mut camera = CameraText::default();
    for (key, value) in assignments(text)? {
        let twice = |is_set: bool| {
            if is_set {
                Err(format!("{key} is given twice, or both fov and ortho"))
            } else {
                Ok(())
            }
        };
        match key {
            "eye" => twice(camera.eye.replace(vector(key, &value)?).is_some())?,
            "at" => twice(camera.at.replace(vector(key, &value)?).is_some())?,
            "up" => twice(camera.up.replace(vector(key, &value)?).is_some())?,
            "fov" | "ortho" => {
                twice(camera.projection.replace(projection(key, &value)?).is_some())?;
            }
            _ => return Err(format!("there is no {key}; {EXPECTED}")),
        }
    }
    Ok(camera)
}

const EXPECTED: &str = "give eye=x,y,z,at=x,y,z,up=x,y,z and fov=degrees or ortho=height, or some of \
                        them";

/// Keys with their comma-separated values: a part with `=` starts a key.
fn assignments(text: &str) -> Result<Vec<(&str, Vec<&str>)>, String> {
    let mut assignments: Vec<(&str, Vec<&str>)> = Vec::new();
    for part in text.split(',') {
        match (part.split_once('='), assignments.last_mut()) {
            (Some((key, value)), _) => assignments.push((key.trim(), vec![value])),
            (None, Some((_, values))) => values.push(part),
            (None, None) => return Err(format!("{part:?} is no part of a camera; {EXPECTED}")),
        }
    }
    Ok(assignments)
}

fn vector(key: &str, values: &[&str]) -> Result<DVec3, String> {
    let &[x, y, z] = values else {
        return Err(format!("{key} has {} numbers; it takes three: {key}=x,y,z", values.len()));
    };
    Ok(DVec3::new(numbers::finite(x)?, numbers::finite(y)?, numbers::finite(z)?))
}

fn projection(key: &str, values: &[&str]) -> Result<Projection, String> {
    let &[value] = values else {
        return Err(format!("{key} has {} numbers; it takes one", values.len()));
    };
    let value = numbers::finite(value)?;
    match key {
        "fov" if value > 0.0 && value < 180.0 => Ok(Projection::Perspective { fov: value }),
        "fov" => Err(format!("fov is {value} degrees; it must lie between 0 and 180")),
        _ if value > 0.0 => Ok(Projection::Orthographic { height: value }),
        _ => Err(format!("ortho is {value}; the height of the view must be above 0")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn domain() -> Domain {
        Domain::new(DVec3::splat(-2.0), DVec3::splat(2.0)).unwrap()
    }

    #[test]
    fn nothing_said_is_the_default() {
        let camera = CameraText::default().camera(&domain()).unwrap();
        assert_eq!(camera, Camera::facing(&domain()));
    }

    #[test]
    fn text_reads_back() {
        for given in [
            "eye=3,-4,2.5,at=0,0.1,0,up=0,0,1,fov=30",
            "ortho=3",
            "fov=1e-3",
            "at=0.3,0,0",
            "up=1,0,0,eye=0,0,1e-7",
        ] {
            let camera = parse(given).unwrap().camera(&domain()).unwrap();
            let again = parse(&camera.to_string()).unwrap().camera(&domain()).unwrap();
            assert_eq!(camera, again, "{given}");
        }
    }

    #[test]
    fn the_bounding_sphere_fills_the_view_at_any_angle() {
        let camera = parse("fov=90").unwrap().camera(&domain()).unwrap();
        let distance = (camera.eye - camera.at).length();
        let radius = 12.0_f64.sqrt();
        assert!((distance * 45.0_f64.to_radians().sin() - radius).abs() < 1e-12);
    }

    #[test]
    fn nonsense_is_refused() {
        for (given, says) in [
            ("", "is no part"),
            ("1,2,3", "is no part"),
            ("eye=1,2", "three"),
            ("eye=1,2,x", "\"x\""),
            ("eye=1,2,nan", "not finite"),
            ("fov=0", "between 0 and 180"),
            ("fov=180", "between 0 and 180"),
            ("fov=1,2", "takes one"),
            ("ortho=-1", "above 0"),
            ("fov=20,ortho=1", "both"),
            ("at=0,0,0,at=0,0,0", "twice"),
            ("zoom=2", "no zoom"),
        ] {
            let error = parse(given).unwrap_err();
            assert!(error.contains(says), "{given}: {error}");
        }
        for given in ["eye=0,0,0", "eye=0,0,5", "up=0,0,0", "eye=1e39,0,0", "fov=1e-60"] {
            assert!(parse(given).unwrap().camera(&domain()).is_err(), "{given}");
        }
    }
}
