//! What is wrong with a file of points.

use std::fmt;

/// Why a file gives no points: what was wrong where, and what to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}{place}: {what}; {remedy}")]
pub struct Error {
    /// The file.
    pub file: String,
    /// Where in it.
    pub place: Place,
    /// What was wrong.
    pub what: String,
    /// What to do.
    pub remedy: String,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Nowhere in particular.
    Whole,
    /// A line, from 1.
    Line(usize),
    /// A byte of the uncompressed file, from 0.
    Byte(usize),
}

impl Error {
    pub(crate) fn new(
        file: &str,
        place: Place,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self { file: file.into(), place, what: what.into(), remedy: remedy.into() }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::Line(line) => write!(f, ", line {line}"),
            Self::Byte(byte) => write!(f, ", byte {byte}"),
        }
    }
}
