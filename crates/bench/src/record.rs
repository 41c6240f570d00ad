//! Records: one row a run.

use std::path::Path;

use serde::{Deserialize, Serialize};
use zeroset_raycast::{Rays, Scene};

use crate::{Comparison, Machine};

/// What a comparison does not know of itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Context {
    /// The equation as given.
    pub equation: String,
    /// The shared knob, if used: the bracket width that was asked for.
    pub precision: Option<f64>,
    /// The revision of the program.
    pub revision: String,
}

/// One run as one row. Numbers are printed so that they read back exactly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// When, in UTC: `2026-01-31T12:34:56Z`.
    pub date: String,
    /// The revision of the program.
    pub revision: String,
    /// The processor's name.
    pub cpu: String,
    /// The instruction set that lanes use.
    pub isa: String,
    /// The operating system and architecture.
    pub os: String,
    /// Worker threads.
    pub threads: usize,
    /// The scene's id.
    pub scene: String,
    /// The equation.
    pub equation: String,
    /// Parameters set away from their defaults: `a=0.3 b=1`.
    pub parameters: String,
    /// The box's corners, and the ball's radius if there is one: `x0 y0 z0 x1 y1 z1 [r]`.
    pub domain: String,
    /// `perspective FOV` or `orthographic HEIGHT`, then eye, at and up; empty for a batch.
    pub camera: String,
    /// Pixels in a row; for a batch, rays.
    pub width: usize,
    /// Rows; for a batch, 1.
    pub height: usize,
    /// The method's id.
    pub method: String,
    /// Its knobs: `depth=10 rounding=outward`.
    pub knobs: String,
    /// The bracket width asked for with the shared knob, in t.
    pub precision: Option<f64>,
    /// `ok`, or why there is no answer.
    pub outcome: String,
    /// Time to prepare, milliseconds.
    pub prepare_ms: Option<f64>,
    /// Timed frames.
    pub runs: usize,
    /// Median time of a frame, milliseconds.
    pub median_ms: Option<f64>,
    /// Shortest time of a frame, milliseconds.
    pub min_ms: Option<f64>,
    /// Longest time of a frame, milliseconds.
    pub max_ms: Option<f64>,
    /// Time on the device in the last frame, milliseconds.
    pub device_ms: Option<f64>,
    /// Millions of rays a second in the median frame.
    pub mrays_per_second: Option<f64>,
    /// Function values at points, all rays.
    pub points: u64,
    /// Values with derivatives, all rays.
    pub gradients: u64,
    /// Interval enclosures, all rays.
    pub intervals: u64,
    /// Evaluations that gave NaN or infinity, and rays that are no rays.
    pub nonfinite: u64,
    /// Answers with this certificate.
    pub proven_hit: usize,
    /// Answers with this certificate.
    pub possible_hit: usize,
    /// Answers with this certificate.
    pub root_hit: usize,
    /// Answers with this certificate.
    pub hit: usize,
    /// Answers with this certificate.
    pub proven_miss: usize,
    /// Answers with this certificate.
    pub miss: usize,
    /// Every how many-th ray (pixel, in both axes) was judged; 0 if none.
    pub judged_step: usize,
    /// How many were judged.
    pub judged: usize,
    /// Judged rays whose first root is a crossing.
    pub transversal: usize,
    /// Judged rays whose first root is a touch.
    pub tangential: usize,
    /// Judged rays without a root.
    pub rootless: usize,
    /// Judged rays whose truth is not known.
    pub undecidable: usize,
    /// Hits within the tolerance of the first root.
    pub correct_hits: usize,
    /// Misses where there is no root.
    pub correct_misses: usize,
    /// Misses where there is a crossing.
    pub false_misses_transversal: usize,
    /// Misses where there is a touch.
    pub false_misses_tangential: usize,
    /// Hits where there is no root.
    pub false_hits: usize,
    /// False hits where no neighbouring pixel has a root either.
    pub clear_false_hits: Option<usize>,
    /// Hits away from the first root.
    pub wrong_sheets: usize,
    /// Answers whose truth is not known.
    pub undecided: usize,
    /// Certificates that the truth contradicts.
    pub lies: usize,
    /// Median distance from the first root along the ray, in units of space.
    pub median_dt: Option<f64>,
    /// Greatest distance from the first root along the ray, in units of space.
    pub worst_dt: Option<f64>,
}

/// A file of records that cannot be read or written.
#[derive(Debug, thiserror::Error)]
#[error("{path}: {message}")]
pub struct RecordError {
    /// The file.
    pub path: String,
    /// What is wrong.
    pub message: String,
}

impl Record {
    /// One record for each run of a comparison.
    pub fn of(
        comparison: &Comparison,
        scene: &Scene,
        rays: Rays<'_>,
        machine: &Machine,
        context: &Context,
    ) -> Vec<Self> {
        todo!("{comparison:?} {scene:?} {rays:?} {machine:?} {context:?}")
    }
}

/// Writes records as CSV, replacing the file at once.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, records: &[Record]) -> Result<(), RecordError> {
    todo!("{path:?} {records:?}")
}

/// Adds records to a CSV file, which is replaced at once; it need not exist.
///
/// # Errors
/// If the file is not one of records, or cannot be written.
pub fn append(path: &Path, records: &[Record]) -> Result<(), RecordError> {
    todo!("{path:?} {records:?}")
}

/// Reads records from CSV.
///
/// # Errors
/// If the file cannot be read, or is not one of records.
pub fn read(path: &Path) -> Result<Vec<Record>, RecordError> {
    todo!("{path:?}")
}

/// Records as a JSON array.
pub fn json(records: &[Record]) -> String {
    todo!("{records:?}")
}
