//! The catalogue of surfaces.
//!
//! | module | holds |
//! |---|---|
//! | [`surface`] | a surface: its equation, domain, sources, and what is known of it |
//! | [`symmetry`] | maps of space that leave a surface as it is |
//! | [`entry`] | the form of catalogue files, and what can be wrong with them |
//! | [`extent`] | domains found from functions |
//! | [`mod@resolve`] | a surface by id, file or equation |

pub mod entry;
pub mod extent;
pub mod resolve;
pub mod surface;
pub mod symmetry;

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

pub use entry::CatalogueError;
pub use resolve::{ResolveError, resolve};
pub use surface::{Status, Surface};
pub use symmetry::{Axis, Rotation, Symmetry};

/// Surfaces with different ids, in the order of their file.
#[derive(Clone, Debug)]
pub struct Catalogue {
    surfaces: Vec<Surface>,
}

/// The most suggestions for an unknown id.
const SUGGESTIONS: usize = 10;

impl Catalogue {
    /// The surfaces of the four papers.
    pub fn builtin() -> &'static Self {
        static BUILTIN: LazyLock<Catalogue> = LazyLock::new(|| {
            const TEXT: &str = include_str!("../../catalogue/surfaces.toml");
            let read = entry::read(TEXT, "the built-in catalogue");
            let surfaces = read.unwrap_or_else(|error| panic!("{error}"));
            Catalogue { surfaces: surfaces.into_iter().map(|(surface, _)| surface).collect() }
        });
        &BUILTIN
    }

    /// Reads a file of the form that the built-in `crates/raycast/catalogue/surfaces.toml` documents.
    ///
    /// # Errors
    /// If the file cannot be read, or an entry is wrong, its equation included: with the line, the
    /// surface and the key.
    pub fn load(path: &Path) -> Result<Self, CatalogueError> {
        let file = path.display().to_string();
        let text = fs::read_to_string(path).map_err(|error| CatalogueError::Unreadable {
            file: file.clone(),
            error: error.to_string(),
        })?;
        Self::parse(&text, &file)
    }

    /// Reads a catalogue's text; `file` names it in errors.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn parse(text: &str, file: &str) -> Result<Self, CatalogueError> {
        let read = entry::read(text, file)?;
        let mut surfaces = Vec::with_capacity(read.len());
        for (surface, equation) in read {
            entry::check_equation(&surface, equation, text, file)?;
            surfaces.push(surface);
        }
        Ok(Self { surfaces })
    }

    /// The surface of that id.
    pub fn get(&self, id: &str) -> Option<&Surface> {
        self.surfaces.iter().find(|surface| surface.id == id)
    }

    /// Every surface.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Surface> {
        self.surfaces.iter()
    }

    /// Every surface with an f of its own: all but other forms of one.
    pub fn functions(&self) -> impl Iterator<Item = &Surface> {
        self.surfaces.iter().filter(|surface| surface.form_of.is_none())
    }

    /// Ids that a misspelt one may mean, most likely first: those few letters away, or that share a
    /// part between dashes.
    pub fn suggest(&self, id: &str) -> Vec<&str> {
        let id = id.to_lowercase();
        let allowed = match id.len() {
            0..=2 => 0,
            3..=4 => 1,
            _ => 2,
        };
        let parts: Vec<&str> = id.split('-').filter(|part| part.len() > 2).collect();
        let mut near: Vec<(usize, &str)> = Vec::new();
        for Surface { id: known, .. } in &self.surfaces {
            let distance = strsim::damerau_levenshtein(&id, known);
            let shares = known.split('-').any(|part| parts.contains(&part));
            if distance <= allowed {
                near.push((distance, known));
            } else if shares {
                near.push((allowed + distance, known));
            }
        }
        near.sort_by_key(|(distance, _)| *distance);
        near.truncate(SUGGESTIONS);
        near.into_iter().map(|(_, known)| known).collect()
    }
}
