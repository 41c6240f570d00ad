//! Surfaces in pieces: files that `zeroset slim build` made.

use std::path::Path;

use zeroset::model::slim::Slim;
use zeroset::raycast::Scene;

use crate::destination::has_extension;
use crate::failure::Failure;

/// The scene of a file of pieces; none if the text names no such file.
pub(crate) fn scene(text: &str) -> Result<Option<Scene>, Failure> {
    let path = Path::new(text.trim());
    if !has_extension(path, "slim") {
        return Ok(None);
    }
    let patches = Slim::read(path).map_err(Failure::work)?.patches()?;
    let id = path.file_stem().unwrap_or_default().to_string_lossy();
    Ok(Some(Scene::of_patches(id, patches)))
}
