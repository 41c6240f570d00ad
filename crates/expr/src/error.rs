//! What can be wrong with an equation or a parameter.

use std::ops::Range;

/// An equation that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ParseError {
    /// What is wrong, and what was expected.
    pub message: String,
    /// Where: bytes of `source`.
    pub span: Range<usize>,
    /// What to write instead, if that can be guessed.
    pub help: Option<String>,
    /// The text that was read.
    pub text: String,
}

/// A parameter that cannot be given.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ParameterError {
    /// What is wrong, with the value and the names that exist.
    pub message: String,
}
