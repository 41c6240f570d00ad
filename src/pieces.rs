//! Surfaces in pieces: files that `zeroset slim build` and `zeroset volume build` made.

use std::path::Path;

use zeroset::model::slim::Slim;
use zeroset::model::spline::Tets;
use zeroset::raycast::{Scene, Sides};

use crate::destination::has_extension;
use crate::failure::Failure;

/// The scene of a file of pieces; none if the text names no such file.
pub(crate) fn scene(text: &str) -> Result<Option<Scene>, Failure> {
    let path = Path::new(text.trim());
    let patches = if has_extension(path, "slim") {
        Slim::read(path).map_err(Failure::work)?.patches()?
    } else if has_extension(path, "tets") {
        // Where a volume ends, the surface is seen from inside.
        Tets::read(path).map_err(Failure::work)?.patches(Sides::Both)?
    } else {
        return Ok(None);
    };
    let id = path.file_stem().unwrap_or_default().to_string_lossy();
    Ok(Some(Scene::of_patches(id, patches)))
}
