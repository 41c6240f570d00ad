//! Surfaces by name, file or equation.

use zeroset::expr::{Parameters, ParseError};
use zeroset::raycast::catalogue::{self, ResolveError, Surface};
use zeroset::raycast::{Error, Scene};

use crate::failure::Failure;
use crate::options::SceneOptions;
use crate::pieces;

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

/// The scene asked for, and its equation, or the name of its pieces.
pub(crate) fn scene(options: &SceneOptions) -> Result<(String, Scene), Failure> {
    if let Some(scene) = pieces::scene(&options.surface)? {
        if options.domain.is_some() || !options.parameters.is_empty() {
            let why = "--param and --domain are for equations; pieces are bounded themselves";
            return Err(Failure::usage(why));
        }
        return Ok((options.surface.trim().into(), scene));
    }
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
    Ok((surface.equation, scene))
}

/// The place in the equation, and what to write instead.
pub(crate) fn unreadable(error: &ParseError) -> Failure {
    let text = error.render();
    Failure::usage(text.strip_prefix("error: ").unwrap_or(&text).trim_end())
}
