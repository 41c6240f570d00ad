//! Surfaces in pieces: built-in ones, and files that `zeroset slim build` and `zeroset volume build` made.

use std::path::Path;

use zeroset::model::slim::Slim;
use zeroset::model::spline::Tets;
use zeroset::model::{bilinear, skin};
use zeroset::raycast::{Error, Patches, Scene, Sides};

use crate::destination::has_extension;
use crate::failure::Failure;

/// A built-in surface in pieces.
pub(crate) struct Builtin {
    /// What it is called.
    pub(crate) id: &'static str,
    /// What it is.
    pub(crate) name: &'static str,
    patches: fn() -> Result<Patches, Error>,
    /// Where its domain is another's, so that both are seen alike: what that one is called.
    seen_as: Option<&'static str>,
}

/// The built-in surfaces in pieces.
pub(crate) const BUILTINS: [Builtin; 5] = [
    Builtin {
        id: "skin-water",
        name: "Skin surface of a water molecule",
        patches: || skin::Skin::default().patches(&skin::water().atoms()),
        seen_as: None,
    },
    Builtin {
        id: "skin-ethanol",
        name: "Skin surface of an ethanol molecule",
        patches: || skin::Skin::default().patches(&skin::ethanol().atoms()),
        seen_as: None,
    },
    Builtin {
        id: "skin-benzene",
        name: "Skin surface of a benzene molecule",
        patches: || skin::Skin::default().patches(&skin::benzene().atoms()),
        seen_as: None,
    },
    Builtin {
        id: "folded-strip",
        name: "Twisted bilinear quadrilaterals",
        patches: || bilinear::patches(&bilinear::folded_strip()),
        seen_as: None,
    },
    Builtin {
        id: "folded-strip-triangles",
        name: "The same quadrilaterals as two triangles each",
        patches: || bilinear::triangle_patches(&bilinear::folded_strip()),
        // Triangles are cut from planes by tetrahedra that reach far above them.
        seen_as: Some("folded-strip"),
    },
];

/// The scene of a text that names pieces; none if it names something else.
pub(crate) fn scene(text: &str) -> Result<Option<Scene>, Failure> {
    let text = text.trim();
    if let Some(builtin) = BUILTINS.iter().find(|builtin| builtin.id == text) {
        let mut scene = Scene::of_patches(builtin.id, (builtin.patches)()?);
        if let Some(other) = builtin.seen_as.map(self::scene).transpose()?.flatten() {
            scene.domain = other.domain;
        }
        return Ok(Some(scene));
    }
    let path = Path::new(text);
    let patches = if has_extension(path, "slim") {
        Slim::read(path).map_err(Failure::work)?.patches()
    } else if has_extension(path, "tets") {
        // Where a volume ends, the surface is seen from inside.
        Tets::read(path).map_err(Failure::work)?.patches(Sides::Both)?
    } else {
        return Ok(None);
    };
    let id = path.file_stem().unwrap_or_default().to_string_lossy();
    Ok(Some(Scene::of_patches(id, patches)))
}
