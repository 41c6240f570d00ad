//! Why there is no picture, or no file of it.

use std::io;
use std::path::PathBuf;

/// A picture that cannot be made or saved.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShadeError {
    /// No pixels.
    #[error("a picture of {width} by {height} pixels is empty; give at least 1 by 1")]
    Empty {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// More pixels than a file or the memory's addresses can count.
    #[error("a picture of {width} by {height} pixels is too large; {limit}")]
    TooLarge {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// What is allowed.
        limit: &'static str,
    },
    /// Values that do not belong to the pixels.
    #[error("{got} {what} for {width} by {height} pixels; there must be one a pixel")]
    Count {
        /// What there should be one of for each pixel.
        what: &'static str,
        /// How many there are.
        got: usize,
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// Answers that do not belong to the shadow rays.
    #[error("{got} answers for {rays} shadow rays; there must be one a ray")]
    Answers {
        /// How many there are.
        got: usize,
        /// How many there should be.
        rays: usize,
    },
    /// Hits without normals, where a picture needs them.
    #[error(
        "the picture {0:?} needs normals, and the hits have none; ask for first hits with normals"
    )]
    NoNormals(&'static str),
    /// An error map without a reference.
    #[error("the picture \"error\" needs a comparison with the reference, and there is none")]
    NoReference,
    /// No such environment.
    #[error("there is no environment {name:?}; there are {known}")]
    UnknownEnvironment {
        /// What was asked for.
        name: String,
        /// The names that there are.
        known: String,
    },
    /// No such picture.
    #[error("there is no picture {name:?}; there are {known}")]
    UnknownKind {
        /// What was asked for.
        name: String,
        /// The pictures that exist.
        known: String,
    },
    /// A folder that is missing and cannot be made.
    #[error(
        "cannot create the folder {path:?}: {source}; choose an output folder that can be written"
    )]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A file that cannot be written.
    #[error(
        "cannot write {path:?}: {source}; check that its folder can be written and has room, or \
         choose another output folder"
    )]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A picture that is no frame of an animation.
    #[error("{path:?} cannot be animated: {reason}")]
    Frame {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A picture that the format cannot hold.
    #[error("cannot encode {path:?}: {reason}")]
    Encoding {
        /// The file.
        path: PathBuf,
        /// What the encoder says.
        reason: String,
    },
}
