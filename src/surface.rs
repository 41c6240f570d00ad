//! Surfaces by name, file or equation.

use zeroset::expr::{Parameters, ParseError};
use zeroset::raycast::catalogue::{self, ResolveError, Surface};
use zeroset::raycast::{Error, Scene};

use crate::failure::Failure;
use crate::options::SceneOptions;

/// The surface that a text means.
pub(crate) fn resolve(text: &str) -> Result<Surface, Failure> {
    catalogue::resolve(text, None).map_err(|error| match error {
        ResolveError::Equation(error) => unreadable(&error),
        ResolveError::EquationInFile { file, error } => match unreadable(&error) {
            Failure::Usage(why) => Failure::usage(format!("in {file}: {why}")),
            other => other,
        },
        error => Failure::usage(error),
    })
}

/// The surface asked for, and its scene.
pub(crate) fn scene(options: &SceneOptions) -> Result<(Surface, Scene), Failure> {
    let mut surface = resolve(&options.surface)?;
    surface.domain = options.domain.or(surface.domain);
    let mut parameters = Parameters::default();
    for (name, value) in &options.parameters {
        parameters.set(name, value);
    }
    // Wrong values would be found by the first method, but after folders are made.
    let function = surface.function().map_err(|error| unreadable(&error))?;
    function.tape(&parameters, 128).map_err(Error::from)?;
    let scene = surface.scene_with(&parameters).map_err(|error| unreadable(&error))?;
    Ok((surface, scene))
}

/// The place in the equation, and what to write instead.
pub(crate) fn unreadable(error: &ParseError) -> Failure {
    let text = error.render();
    Failure::usage(text.strip_prefix("error: ").unwrap_or(&text).trim_end())
}
