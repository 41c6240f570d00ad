//! What can be wrong with volumes.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::MOST_SAMPLES;

/// What is wrong with data, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Fault(String);

impl Fault {
    pub(crate) fn new(text: impl Into<String>) -> Self {
        Self(text.into())
    }
}

/// A file that cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The system refused.
    #[error("{}: {source}", file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The file holds something else than it should.
    #[error("{}: {fault}", file.display())]
    Data {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        fault: Fault,
    },
}

impl ReadError {
    pub(crate) fn data(file: &Path, fault: Fault) -> Self {
        Self::Data { file: file.into(), fault }
    }
}

/// All bytes of a file. Devices and pipes are refused: they may have no end.
pub(crate) fn bytes_of(file: &Path) -> Result<Vec<u8>, ReadError> {
    let failed = |source| ReadError::Io { file: file.into(), source };
    if !fs::metadata(file).map_err(failed)?.is_file() {
        return Err(ReadError::data(file, Fault::new("this is no ordinary file; name one")));
    }
    fs::read(file).map_err(failed)
}

/// A size as people write it.
pub(super) fn shown(size: [usize; 3]) -> String {
    let [x, y, z] = size;
    format!("{x} x {y} x {z}")
}

/// How many samples a size has.
pub(super) fn samples(size: [usize; 3]) -> Result<usize, Fault> {
    let product = size.into_iter().try_fold(1_usize, usize::checked_mul);
    match product {
        Some(0) => Err(Fault::new(format!(
            "a size of {} has no samples; each must be at least 1",
            shown(size)
        ))),
        Some(count) if count <= MOST_SAMPLES => Ok(count),
        _ => Err(Fault::new(format!(
            "a size of {} has more samples than the most allowed, {MOST_SAMPLES}; \
             take a part, or fewer samples",
            shown(size)
        ))),
    }
}
