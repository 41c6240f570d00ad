//! Options that several commands share.

use clap::Args;
use glam::DVec3;
use zeroset::bench::Registry;
use zeroset::raycast::{Domain, Method, Scene, View};
use zeroset::shade::ViewKind;

use crate::camera::{self, CameraText};
use crate::failure::Failure;
use crate::numbers;

/// The greatest width and height of an image.
const LONGEST_SIDE: usize = 16384;
/// The most pixels of an image: their answers take about 4 GB.
const MOST_PIXELS: usize = 1 << 26;

/// A surface, the values of its parameters, and where its roots count.
#[derive(Args, Clone, Debug)]
pub(crate) struct SceneOptions {
    /// A catalogue id; else a file that holds an equation, or pieces (FILE.slim, FILE.tets), or a catalogue of
    /// your own: FILE.toml, or FILE.toml#ID; else an equation such as "x^4+y^4+z^4=1"
    #[arg(value_name = "SURFACE", allow_hyphen_values = true)]
    pub(crate) surface: String,
    /// Sets a parameter of the equation to a number or a constant expression; repeatable [default:
    /// the values of the catalogue or the equation]
    #[arg(long = "param", value_name = "NAME=VALUE", value_parser = assignment)]
    #[arg(allow_hyphen_values = true)]
    pub(crate) parameters: Vec<(String, String)>,
    /// The closed box in which roots count [default: the catalogue's box and ball; for an equation
    /// [-2, 2]^3, or the box found from the function]
    #[arg(long, value_name = "X0,Y0,Z0,X1,Y1,Z1", value_parser = domain)]
    #[arg(allow_hyphen_values = true)]
    pub(crate) domain: Option<Domain>,
}

/// The camera.
#[derive(Args, Clone, Debug)]
pub(crate) struct CameraOptions {
    /// eye=x,y,z,at=x,y,z,up=x,y,z and fov=DEGREES (vertical) or ortho=HEIGHT, or some of them
    /// [default: at the domain's centre from direction (0.8, -1, 0.55), z up, fov=40, the domain's
    /// bounding sphere filling the view]
    #[arg(long, value_name = "KEY=VALUE,..", value_parser = camera::parse)]
    #[arg(allow_hyphen_values = true)]
    camera: Option<CameraText>,
}

impl CameraOptions {
    /// The view of a domain.
    pub(crate) fn view(&self, domain: &Domain, size: Size) -> Result<View, Failure> {
        let camera = self.camera.clone().unwrap_or_default().camera(domain)?;
        let view = View::new(camera, size.width, size.height);
        let (right, bottom) = (size.width - 1, size.height - 1);
        let corners = [(0, 0), (right, 0), (0, bottom), (right, bottom)];
        if corners.iter().all(|(column, row)| view.ray(*column, *row).is_valid()) {
            Ok(view)
        } else {
            Err(Failure::usage(format!(
                "rays of the camera {} start beyond single precision; make ortho smaller",
                view.camera()
            )))
        }
    }
}

/// How methods are set.
#[derive(Args, Clone, Debug)]
pub(crate) struct MethodOptions {
    /// The wanted width of the bracket in t, for every method; for AMP it sets the bisections, not
    /// the base step [default: 1e-4 of the domain's longest side]
    #[arg(long, value_name = "W", value_parser = numbers::positive, allow_hyphen_values = true)]
    precision: Option<f64>,
    /// Sets a knob of a method, after --precision; repeatable; `zeroset list methods` shows the
    /// knobs [default: those of each method's paper]
    #[arg(long = "set", value_name = "METHOD.KNOB=VALUE", value_parser = setting)]
    #[arg(allow_hyphen_values = true)]
    settings: Vec<Setting>,
    /// Where methods on the GPU run: a number or a part of a name, as `zeroset devices` lists them
    /// [default: the variable ZEROSET_DEVICE, else number 0]
    #[arg(long, value_name = "DEVICE", value_parser = device)]
    device: Option<String>,
}

/// A knob of a method with its value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Setting {
    method: String,
    knob: String,
    value: String,
}

impl MethodOptions {
    /// The wanted width of brackets.
    pub(crate) fn precision(&self, scene: &Scene) -> f64 {
        // Division by an exact number: for a side of 2 this is 0.0002, not 0.00020000000000000001.
        self.precision.unwrap_or(scene.domain.longest_side() / 1e4)
    }

    /// Sets the knobs of methods for a scene.
    pub(crate) fn set(
        &self,
        methods: &mut [Box<dyn Method>],
        scene: &Scene,
    ) -> Result<(), Failure> {
        for method in &mut *methods {
            method.for_precision(self.precision(scene), scene);
            if let Some(device) = &self.device
                && method.knobs().iter().any(|knob| knob.name == "device")
            {
                method.set("device", device).map_err(Failure::usage)?;
            }
        }
        for Setting { method: id, knob, value } in &self.settings {
            match methods.iter_mut().find(|m| m.id() == id) {
                Some(method) => method.set(knob, value).map_err(Failure::usage)?,
                None => {
                    Registry::standard().method(id).map_err(Failure::usage)?;
                    let used: Vec<_> = methods.iter().map(|m| m.id()).collect();
                    return Err(Failure::usage(format!(
                        "--set {id}.{knob}={value}: {id} is not among the methods used: {}",
                        used.join(", ")
                    )));
                }
            }
        }
        Ok(())
    }
}

/// The size of an image in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size {
    /// Pixels in a row.
    pub(crate) width: usize,
    /// Rows.
    pub(crate) height: usize,
}

/// Reads `WxH`.
pub(crate) fn size(text: &str) -> Result<Size, String> {
    let side = |text: &str| match text.trim().parse::<usize>() {
        Ok(pixels) if (1..=LONGEST_SIDE).contains(&pixels) => Ok(pixels),
        Ok(pixels) => Err(format!("{pixels} pixels are not between 1 and {LONGEST_SIDE}")),
        Err(_) => Err(format!("{text:?} is no number of pixels between 1 and {LONGEST_SIDE}")),
    };
    let (width, height) =
        text.split_once(['x', 'X']).ok_or("give WIDTHxHEIGHT, such as 512x512")?;
    let (width, height) = (side(width)?, side(height)?);
    if width * height > MOST_PIXELS {
        return Err(format!("{} pixels are more than {MOST_PIXELS}", width * height));
    }
    Ok(Size { width, height })
}

/// Reads `x0,y0,z0,x1,y1,z1`.
fn domain(text: &str) -> Result<Domain, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let &[x0, y0, z0, x1, y1, z1] = &parts[..] else {
        return Err(format!("{} numbers; give six: x0,y0,z0,x1,y1,z1", parts.len()));
    };
    let corner = |x, y, z| -> Result<DVec3, String> {
        Ok(DVec3::new(numbers::finite(x)?, numbers::finite(y)?, numbers::finite(z)?))
    };
    Domain::new(corner(x0, y0, z0)?, corner(x1, y1, z1)?).map_err(|e| e.to_string())
}

/// Reads the name of a device that there is.
fn device(text: &str) -> Result<String, String> {
    zeroset::gpu::device::find(&zeroset::gpu::Choice::read(text))
        .map(|_| text.into())
        .map_err(|e| e.to_string())
}

/// Reads `NAME=VALUE`.
fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() && !value.trim().is_empty() => {
            Ok((name.trim().into(), value.trim().into()))
        }
        _ => Err("give NAME=VALUE, such as a=0.3".into()),
    }
}

/// Reads `METHOD.KNOB=VALUE`.
fn setting(text: &str) -> Result<Setting, String> {
    let parts = text.split_once('=').and_then(|(name, value)| {
        let (method, knob) = name.split_once('.')?;
        Some([method, knob, value].map(|part| part.trim().to_owned()))
    });
    match parts {
        Some([method, knob, value]) if !method.is_empty() && !knob.is_empty() => {
            Ok(Setting { method, knob, value })
        }
        _ => Err("give METHOD.KNOB=VALUE, such as kmarch.depth=12".into()),
    }
}

/// Reads what a picture shows.
pub(crate) fn view_kind(text: &str) -> Result<ViewKind, String> {
    ViewKind::from_name(text).map_err(|e| e.to_string())
}

/// Reads a number of threads.
pub(crate) fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..=1024) => Ok(n),
        _ => Err("give a number from 1 to 1024".into()),
    }
}

/// Reads a number of timed frames.
pub(crate) fn runs(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..=1_000_000) => Ok(n),
        _ => Err("give a number from 1 to 1000000".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_limits() {
        assert_eq!(size("512x256"), Ok(Size { width: 512, height: 256 }));
        assert_eq!(size("16384x4096"), Ok(Size { width: 16384, height: 4096 }));
        for bad in [
            "16384x16384",
            "",
            "512",
            "0x0",
            "0x1",
            "1x0",
            "100000x100000",
            "16385x1",
            "-1x4",
            "ax4",
            "4x",
        ] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn domains_are_boxes() {
        let unit = Domain::new(DVec3::NEG_ONE, DVec3::ONE).unwrap();
        assert_eq!(domain("-1,-1,-1, 1,1,1"), Ok(unit));
        for bad in ["", "1", "1,1,1,1,1,1", "1,1,1,-1,-1,-1", "0,0,0,1,1,nan", "0,0,0,1,1,inf", "a"]
        {
            assert!(domain(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn assignments_keep_signs_and_further_equals() {
        assert_eq!(assignment("a=-0.3"), Ok(("a".into(), "-0.3".into())));
        assert!(assignment("a").is_err() && assignment("=1").is_err() && assignment("a=").is_err());
        let set = |m: &str, k: &str, v: &str| {
            Ok(Setting { method: m.into(), knob: k.into(), value: v.into() })
        };
        assert_eq!(setting("amp.step=-1"), set("amp", "step", "-1"));
        for bad in ["amp", "amp.step", "step=1", ".step=1", "amp.=1"] {
            assert!(setting(bad).is_err(), "{bad}");
        }
    }
}
