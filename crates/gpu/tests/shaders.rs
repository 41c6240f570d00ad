//! Every shader is valid, whatever the surface: no device is needed to see it.

use wgpu::naga;
use zeroset_cpu::amp::Adaptation;
use zeroset_cpu::{Amp, RootTest};
use zeroset_expr::{Parameters, Tape};
use zeroset_gpu::{amp, bisection, frames};
use zeroset_ia::Rounding;
use zeroset_raycast::Geometry;
use zeroset_raycast::catalogue::Catalogue;

/// Parses and validates a shader, as a device without optional features would.
fn validate(source: &str) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
    let mut validator = naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::default(),
    );
    validator.validate(&module).map(|_| ()).map_err(|e| e.emit_to_string(source))
}

fn tapes() -> Vec<(String, Tape)> {
    let mut tapes = Vec::new();
    for surface in Catalogue::builtin().iter() {
        let scene = surface.scene().unwrap();
        if let Geometry::Implicit(function) = &scene.geometry {
            tapes.push((scene.id, function.tape(&scene.parameters, 128).unwrap()));
        }
    }
    tapes
}

/// Equations with every operation that there is.
fn every_operation() -> Vec<(String, Tape)> {
    use zeroset_ia::{Binary, Unary};
    let unary = Unary::ALL.iter().map(|f| format!("{f}(x*y+0.3)-z"));
    let binary = Binary::ALL.iter().map(|f| format!("{f}(x+2, y*z+3)-1"));
    let others = ["x^7-y^-3+z", "abs(x)^2.5-y^100+z^-101", "(x+2)^0.3-y/(z+9)", "2-x"];
    unary
        .chain(binary)
        .chain(others.map(String::from))
        .map(|text| {
            let function = zeroset_expr::Function::parse(&text).unwrap();
            let tape = function.tape(&Parameters::default(), 128).unwrap();
            (text, tape)
        })
        .collect()
}

#[test]
fn shaders_of_points_are_valid() {
    for (name, tape) in tapes().into_iter().chain(every_operation()) {
        let plain = Amp {
            distance_adaptation: Adaptation::Off,
            silhouette_adaptation: Adaptation::Off,
            ..Amp::default()
        };
        let taylor = Amp { test: RootTest::Taylor, ..Amp::default() };
        for amp in [plain, Amp::default(), taylor] {
            let [rays, frames] = [amp::shader(&amp, &tape), frames::shader(&amp, &tape)];
            for source in [rays, frames] {
                validate(&source.unwrap()).unwrap_or_else(|e| panic!("{name}: {e}"));
            }
        }
    }
}

#[test]
fn shaders_of_intervals_are_valid_or_say_what_is_missing() {
    let mut missing = Vec::new();
    for (name, tape) in tapes().into_iter().chain(every_operation()) {
        for rounding in [Rounding::Outward, Rounding::Nearest] {
            match bisection::shader(&tape, rounding) {
                Ok(source) => validate(&source).unwrap_or_else(|e| panic!("{name}: {e}")),
                Err(error) => {
                    let text = error.to_string();
                    assert!(text.contains("has no interval form on devices"), "{name}: {text}");
                    missing.push(name.clone());
                }
            }
        }
    }
    missing.dedup();
    let operations = missing.iter().filter(|name| name.contains('(')).count();
    assert!(operations <= 9, "{missing:?}");
    // Of the surfaces, those by cosines and few others.
    let surfaces =
        Catalogue::builtin().functions().filter(|surface| missing.contains(&surface.id)).count();
    assert!(surfaces <= 4, "{missing:?}");
}
