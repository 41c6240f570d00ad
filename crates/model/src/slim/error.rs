//! Why there is no SLIM surface.

/// Why a surface was not built, read or written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An option that has no meaning.
    #[error("{0}")]
    Options(String),
    /// Points that make no surface.
    #[error("{0}")]
    Cloud(String),
    /// Balls that make no surface.
    #[error("{0}")]
    Balls(String),
    /// A file that cannot be used.
    #[error("{file}: {what}")]
    File {
        /// The file.
        file: String,
        /// What was wrong, and what to do.
        what: String,
    },
    /// The caller asked to stop.
    #[error("interrupted")]
    Interrupted,
}
