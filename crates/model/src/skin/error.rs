//! Why a text is no molecule.

use std::path::PathBuf;

/// What is wrong with a molecule's file.
#[derive(Debug, thiserror::Error)]
pub enum MoleculeError {
    /// The file cannot be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A line says something else than it should.
    #[error("line {line}: {found:?} where there should be {expected}")]
    Line {
        /// Counted from 1.
        line: usize,
        /// What it says.
        found: String,
        /// What it should say.
        expected: &'static str,
    },
    /// An element whose radius is not known.
    #[error("line {line}: no radius for element {symbol:?}; there are those of {known}")]
    Element {
        /// Counted from 1.
        line: usize,
        /// What was given.
        symbol: String,
        /// The elements that have one.
        known: String,
    },
    /// There are fewer or more atoms than the first line says.
    #[error("{found} atoms where the first line says {expected}")]
    Count {
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
}
