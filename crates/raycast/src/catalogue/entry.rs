//! The form of catalogue files, which `crates/raycast/catalogue/surfaces.toml` documents.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::ops::Range;

use glam::DVec3;
use serde::Deserialize;
use toml::{Spanned, Value};
use zeroset_expr::{Definitions, Parameter, ParseError};

use super::{Rotation, Status, Surface, Symmetry};
use crate::Domain;

/// What can be wrong with a catalogue.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CatalogueError {
    /// The file cannot be read.
    #[error("{file} cannot be read: {error}")]
    Unreadable {
        /// The file.
        file: String,
        /// What the system says.
        error: String,
    },
    /// There is no surface in the file.
    #[error("{file} has no surface: start one with [[surface]], then its id and equation")]
    NoSurface {
        /// The file.
        file: String,
    },
    /// An entry is wrong.
    #[error("{file}:{place}: {message}")]
    Entry {
        /// The file.
        file: String,
        /// Where it is wrong.
        place: Place,
        /// What is wrong.
        message: String,
    },
}

/// A place in a catalogue file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The line, counted from 1.
    pub line: usize,
    /// The id of the surface there.
    pub surface: Option<String>,
    /// The key there.
    pub key: Option<String>,
}

impl Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.line)?;
        if let Some(surface) = &self.surface {
            write!(f, ", surface {surface}")?;
        }
        if let Some(key) = &self.key {
            write!(f, ", key {key}")?;
        }
        Ok(())
    }
}

impl Place {
    /// The place of a byte of the text.
    fn of(text: &str, offset: usize) -> Self {
        let offset = text.floor_char_boundary(offset);
        let (before, after) = text.split_at(offset);
        let line_end = after.find('\n').map_or(text.len(), |i| offset + i);
        // The entry around: from its header, or the start, to the next header.
        let header = "[[surface]]";
        let start = text[..line_end].rfind(header);
        let end = text[line_end..].find(header).map_or(text.len(), |i| line_end + i);
        let value = |line: &str, key: &str| {
            let rest = line.trim_start().strip_prefix(key)?.trim_start().strip_prefix('=')?;
            Some(rest.split('#').next()?.trim().trim_matches(['"', '\'']).to_owned())
        };
        let surface = start.and_then(|start| text[start..end].lines().find_map(|l| value(l, "id")));
        let key = |line: &str| {
            let key = line.split_once('=')?.0.trim();
            let is_key = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
            (!key.is_empty() && key.chars().all(is_key)).then(|| key.to_owned())
        };
        let key = match start {
            Some(start) if offset > start => text[start..line_end].lines().rev().find_map(key),
            _ => None,
        };
        Self { line: before.matches('\n').count() + 1, surface, key }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    surface: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    id: Spanned<String>,
    equation: Spanned<String>,
    name: Option<String>,
    #[serde(default)]
    params: BTreeMap<String, Spanned<Value>>,
    #[serde(default)]
    tables: BTreeMap<String, Vec<Spanned<Value>>>,
    domain: Option<Spanned<[f64; 6]>>,
    ball: Option<Spanned<f64>>,
    degree: Option<u32>,
    zero_set_degree: Option<u32>,
    algebraic_form: Option<String>,
    variant_of: Option<String>,
    form_of: Option<String>,
    #[serde(default)]
    papers: Vec<String>,
    published_step: Option<Spanned<f64>>,
    #[serde(default)]
    status: Status,
    printed_as: Option<String>,
    correction: Option<String>,
    sign: Option<String>,
    simple_roots_only: Option<bool>,
    singular_kind: Option<String>,
    singular_locus: Option<String>,
    #[serde(default)]
    symmetries: Vec<Symmetry>,
    #[serde(default)]
    rotations: Vec<Rotation>,
    #[serde(default)]
    points: Vec<[Spanned<Value>; 3]>,
    #[serde(default)]
    facts: Vec<String>,
}

/// What is wrong, and where in the text.
struct Fault {
    span: Range<usize>,
    message: String,
}

impl Fault {
    fn new<T>(at: &Spanned<T>, message: impl Into<String>) -> Self {
        Self { span: at.span(), message: message.into() }
    }

    fn within(self, text: &str, file: &str) -> CatalogueError {
        let place = Place::of(text, self.span.start);
        CatalogueError::Entry { file: file.into(), place, message: self.message }
    }
}

/// Reads a catalogue's text, all but the equations, of which it tells where they are.
pub(super) fn read(text: &str, file: &str) -> Result<Vec<(Surface, Range<usize>)>, CatalogueError> {
    let entries: File = toml::from_str(text).map_err(|error| {
        let fault = Fault { span: error.span().unwrap_or(0..0), message: error.message().into() };
        fault.within(text, file)
    })?;
    if entries.surface.is_empty() {
        return Err(CatalogueError::NoSurface { file: file.into() });
    }
    let mut surfaces: Vec<(Surface, Range<usize>)> = Vec::with_capacity(entries.surface.len());
    for entry in entries.surface {
        let (id, equation) = (entry.id.clone(), entry.equation.span());
        let surface = entry.surface(text).map_err(|fault| fault.within(text, file))?;
        if surfaces.iter().any(|(other, _)| other.id == surface.id) {
            let fault = Fault::new(&id, format!("there are two surfaces {}", surface.id));
            return Err(fault.within(text, file));
        }
        surfaces.push((surface, equation));
    }
    Ok(surfaces)
}

/// Reads the equation of a surface, which is somewhere in the text.
pub(super) fn check_equation(
    surface: &Surface,
    equation: Range<usize>,
    text: &str,
    file: &str,
) -> Result<(), CatalogueError> {
    let Err(error) = surface.function() else {
        return Ok(());
    };
    // The fault itself, if it is in the equation, and the equation is written without escapes.
    let within = match text[equation.clone()].find(&surface.equation) {
        Some(start) if error.text == surface.equation => start + error.span.start,
        _ => 0,
    };
    let place = Place::of(text, equation.start + within);
    Err(CatalogueError::Entry {
        file: file.into(),
        // Lines of an equation may look like keys.
        place: Place { key: Some("equation".into()), ..place },
        message: described(&error),
    })
}

fn described(error: &ParseError) -> String {
    match &error.help {
        Some(help) => format!("{} ({help})", error.message),
        None => error.message.clone(),
    }
}

impl Entry {
    fn surface(self, text: &str) -> Result<Surface, Fault> {
        let id = self.id.get_ref();
        let is_id = id.chars().all(|c| c.is_ascii_alphanumeric() || c == '-')
            && id.starts_with(|c: char| c.is_ascii_alphabetic());
        if !is_id {
            let message =
                format!("{id:?} is no id: an id is letters, digits and dashes, a letter first");
            return Err(Fault::new(&self.id, message));
        }
        let parameter = |(name, value): (&String, &Spanned<Value>)| {
            Ok(Parameter { name: name.clone(), default: constant(text, value)? })
        };
        let table = |(name, entries): (&String, &Vec<Spanned<Value>>)| {
            let entries =
                entries.iter().map(|value| constant(text, value)).collect::<Result<_, _>>()?;
            Ok((name.clone(), entries))
        };
        let definitions = Definitions {
            parameters: self.params.iter().map(parameter).collect::<Result<_, _>>()?,
            tables: self.tables.iter().map(table).collect::<Result<_, _>>()?,
        };
        let point = |[x, y, z]: &[Spanned<Value>; 3]| {
            Ok([constant(text, x)?, constant(text, y)?, constant(text, z)?])
        };
        let points = self.points.iter().map(point).collect::<Result<_, _>>()?;
        if let Some(step) = &self.published_step
            && !(*step.get_ref() > 0.0 && step.get_ref().is_finite())
        {
            return Err(Fault::new(step, format!("the step {} is not above 0", step.get_ref())));
        }
        let domain = domain(self.domain, self.ball)?;
        Ok(Surface {
            name: self.name.unwrap_or_else(|| id.clone()),
            id: self.id.into_inner(),
            equation: self.equation.into_inner(),
            definitions,
            domain,
            degree: self.degree,
            zero_set_degree: self.zero_set_degree,
            algebraic_form: self.algebraic_form,
            variant_of: self.variant_of,
            form_of: self.form_of,
            papers: self.papers,
            published_step: self.published_step.map(Spanned::into_inner),
            status: self.status,
            printed_as: self.printed_as,
            correction: self.correction,
            sign: self.sign,
            simple_roots_only: self.simple_roots_only.unwrap_or(true),
            singular_kind: self.singular_kind,
            singular_locus: self.singular_locus,
            symmetries: self.symmetries,
            rotations: self.rotations,
            points,
            facts: self.facts,
        })
    }
}

fn domain(
    corners: Option<Spanned<[f64; 6]>>,
    ball: Option<Spanned<f64>>,
) -> Result<Option<Domain>, Fault> {
    let domain = match &corners {
        Some(corners) => {
            let [x0, y0, z0, x1, y1, z1] = *corners.get_ref();
            let domain = Domain::new(DVec3::new(x0, y0, z0), DVec3::new(x1, y1, z1));
            Some(domain.map_err(|error| Fault::new(corners, error.to_string()))?)
        }
        None => None,
    };
    match (domain, ball) {
        (Some(domain), Some(ball)) => {
            let cut = domain.with_ball(*ball.get_ref());
            cut.map(Some).map_err(|error| Fault::new(&ball, error.to_string()))
        }
        (None, Some(ball)) => Err(Fault::new(&ball, "a ball needs a domain that it cuts")),
        (domain, None) => Ok(domain),
    }
}

/// A constant as text: a string's own, or a number exactly as it is written in the file.
fn constant(text: &str, value: &Spanned<Value>) -> Result<String, Fault> {
    match value.get_ref() {
        Value::String(constant) => Ok(constant.clone()),
        Value::Integer(integer) => Ok(integer.to_string()),
        Value::Float(float) if float.is_finite() => Ok(text[value.span()].replace('_', "")),
        _ => Err(Fault::new(
            value,
            format!(
                "{} is no constant: give a number or an expression in quotes",
                &text[value.span()]
            ),
        )),
    }
}
