//! A surface by id, file or equation.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use zeroset_expr::{Function, ParseError};

use super::{Catalogue, CatalogueError, Surface};

/// A text that is no surface.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ResolveError {
    /// It looks like an id, but none is so.
    #[error("there is no surface {id:?} in the catalogue, nor such a file, nor is it an equation{}", near(.suggestions))]
    Unknown {
        /// The text.
        id: String,
        /// Ids that may be meant.
        suggestions: Vec<String>,
    },
    /// It looks like a file, but there is none.
    #[error("there is no file {0:?}")]
    NoFile(String),
    /// It is a folder.
    #[error("{0:?} is a folder; give a file that holds an equation, or a catalogue")]
    Folder(String),
    /// The file holds several surfaces.
    #[error("{file} holds {} surfaces: choose one, as {file}#{}; there are {}", .ids.len(), .ids[0], .ids.join(", "))]
    Several {
        /// The file.
        file: String,
        /// The ids of its surfaces.
        ids: Vec<String>,
    },
    /// The file holds no surface of that id.
    #[error("{file} has no surface {id:?}; it has {}", .ids.join(", "))]
    NotInFile {
        /// The file.
        file: String,
        /// The id.
        id: String,
        /// The ids of its surfaces.
        ids: Vec<String>,
    },
    /// The catalogue in the file is wrong.
    #[error(transparent)]
    Catalogue(#[from] CatalogueError),
    /// The equation cannot be read.
    #[error(transparent)]
    Equation(#[from] ParseError),
    /// The equation in the file cannot be read.
    #[error("{file}: {error}")]
    EquationInFile {
        /// The file.
        file: String,
        /// The place in it.
        error: ParseError,
    },
}

fn near(suggestions: &[String]) -> String {
    match suggestions {
        [] => String::new(),
        ids => format!("; is one of these meant: {}?", ids.join(", ")),
    }
}

/// The surface that a text means: an id in `own` or in the built-in catalogue; else an existing file;
/// else an equation.
///
/// A file whose name ends in `.toml` is a catalogue: of one surface, or write `FILE#ID`. Any other
/// file holds one equation, in which `#` starts a comment. A surface without a domain gets one by
/// [`extent::find`](super::extent::find).
///
/// # Errors
/// If the text is none of these: with ids that may be meant, or the place in the equation.
pub fn resolve(text: &str, own: Option<&Catalogue>) -> Result<Surface, ResolveError> {
    let text = text.trim();
    let catalogues = || own.into_iter().chain([Catalogue::builtin()]);
    if let Some(surface) = catalogues().find_map(|catalogue| catalogue.get(text)) {
        return Ok(surface.clone());
    }
    if is_file(text) {
        return from_file(text, None);
    }
    if let Some((file, id)) = text.rsplit_once('#')
        && is_file(file)
    {
        return from_file(file, Some(id));
    }
    match Function::parse(text) {
        Ok(_) => Ok(Surface::new(text, text)),
        Err(_) if Path::new(text).is_dir() => Err(ResolveError::Folder(text.into())),
        Err(_) if is_like_file(text) => Err(ResolveError::NoFile(text.into())),
        Err(error) => {
            let suggestions: Vec<String> = catalogues()
                .flat_map(|catalogue| catalogue.suggest(text))
                .map(String::from)
                .collect();
            let is_like_id = text.starts_with(|c: char| c.is_ascii_alphabetic())
                && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
            if is_like_id && (text.len() > 1 || !suggestions.is_empty()) {
                return Err(ResolveError::Unknown { id: text.into(), suggestions });
            }
            Err(error.into())
        }
    }
}

/// Is there something to read, be it a pipe?
fn is_file(text: &str) -> bool {
    fs::metadata(text).is_ok_and(|entry| !entry.is_dir())
}

/// The text of a file that holds an equation.
fn read(file: &str) -> Result<String, CatalogueError> {
    /// Some devices never end.
    const LONGEST: u64 = 1 << 20;
    let mut text = String::new();
    let read = File::open(file).and_then(|f| f.take(LONGEST + 1).read_to_string(&mut text));
    let error = match read {
        Ok(_) if text.len() as u64 <= LONGEST => None,
        Ok(_) => Some(format!("it is longer than {LONGEST} bytes")),
        Err(error) => Some(error.to_string()),
    };
    match error {
        Some(error) => Err(CatalogueError::Unreadable { file: file.into(), error }),
        None => Ok(text.strip_prefix('\u{feff}').unwrap_or(&text).into()),
    }
}

/// A surface in a file: a catalogue's, or an equation.
fn from_file(file: &str, id: Option<&str>) -> Result<Surface, ResolveError> {
    let path = Path::new(file);
    let is_catalogue = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    if is_catalogue {
        let catalogue = Catalogue::load(path)?;
        let ids = || catalogue.iter().map(|surface| surface.id.clone()).collect::<Vec<_>>();
        return match (id, &catalogue.surfaces[..]) {
            (Some(id), _) => catalogue.get(id).cloned().ok_or_else(|| ResolveError::NotInFile {
                file: file.into(),
                id: id.into(),
                ids: ids(),
            }),
            (None, [only]) => Ok(only.clone()),
            (None, _) => Err(ResolveError::Several { file: file.into(), ids: ids() }),
        };
    }
    if let Some(id) = id {
        return Err(ResolveError::NotInFile {
            file: file.into(),
            id: id.into(),
            ids: vec!["an equation".into()],
        });
    }
    let equation = without_comments(&read(file)?);
    Function::parse(&equation)
        .map_err(|error| ResolveError::EquationInFile { file: file.into(), error })?;
    let stem =
        path.file_stem().map_or_else(|| file.into(), |stem| stem.to_string_lossy().into_owned());
    Ok(Surface::new(stem, equation))
}

/// The text with each comment replaced by spaces, so that places in it stay.
fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let code = line.find('#').unwrap_or(line.len());
        out.push_str(&line[..code]);
        let comment = line[code..].trim_end_matches(['\r', '\n']);
        out.extend(std::iter::repeat_n(' ', comment.len()));
        out.push_str(&line[code + comment.len()..]);
    }
    out
}

/// Does the text look like the path of a file, not like an equation or an id?
fn is_like_file(text: &str) -> bool {
    let file = text.rsplit_once('#').map_or(text, |(file, _)| file);
    let extension = Path::new(file).extension().and_then(|e| e.to_str()).unwrap_or_default();
    let known = ["toml", "txt", "eq", "equation"];
    known.iter().any(|e| extension.eq_ignore_ascii_case(e))
        || ["/", "./", "../", "~/"].iter().any(|start| file.starts_with(start))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_leave_places_as_they_are() {
        let text = "# a sphere\nx^2 + y^2 # two squares\n+ z^2 - 1";
        let code = without_comments(text);
        assert_eq!(code.len(), text.len());
        assert_eq!(code.split_whitespace().collect::<String>(), "x^2+y^2+z^2-1");
        assert_eq!(code.find("+ z"), text.find("+ z"));
        assert_eq!(without_comments("# é\r\nx"), "    \r\nx");
    }

    #[test]
    fn paths_look_like_files() {
        for path in ["own.toml", "dir/own.TOML#egg", "./egg", "/tmp/egg", "egg.txt"] {
            assert!(is_like_file(path), "{path}");
        }
        for text in ["x^2 + y/2 - 1", "barth-sextik", "x*y.", "1.5*x"] {
            assert!(!is_like_file(text), "{text}");
        }
    }
}
