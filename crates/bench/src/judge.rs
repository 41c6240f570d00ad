//! Answers judged against the truth.

use zeroset_raycast::{Certificate, Hit, Hits, Rays};

use crate::{Class, Truth, Truths};

/// What an answer is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// A hit within the tolerance of the first root.
    CorrectHit,
    /// No root, no hit.
    CorrectMiss,
    /// There is a root, but the answer is a miss.
    FalseMiss,
    /// There is no root, or none so early, but the answer is a hit.
    FalseHit,
    /// A hit further from the first root than the tolerance.
    WrongSheet,
    /// The truth is not known.
    Undecided,
    /// The ray was not judged.
    NotSampled,
}

/// A certificate that the truth contradicts: the worst fault a method can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Lie {
    /// `proven-miss`, but there is a root.
    RootMissed,
    /// FIRST is set, but a root lies before the bracket.
    RootBefore,
    /// ROOT is set, but the bracket holds none.
    NoRoot,
}

/// How far from the first root a hit may lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// The width of a pixel at the root; only for views.
    Footprint,
    /// A distance in units of space.
    Distance(f64),
}

/// The verdicts on a set of answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// One a ray.
    pub verdict: Vec<Verdict>,
    /// From the first root to the middle of the bracket, along the ray, in units of space; positive
    /// where the answer lies behind the root. NaN but for [`Verdict::CorrectHit`] and
    /// [`Verdict::WrongSheet`].
    pub dt: Vec<f64>,
    /// The rays whose certificates lie, and how.
    pub lies: Vec<(usize, Lie)>,
    /// All of this counted.
    pub tally: Tally,
}

/// Verdicts counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// How many answers were judged.
    pub judged: usize,
    /// Counts by class of truth and verdict, in the order of [`Class::ALL`] and [`Verdict::ALL`].
    pub table: [[usize; 6]; 4],
    /// How many pixels are clear misses: no root there, nor in any of the eight neighbours. `None`
    /// where only a sample was judged, and for batches.
    pub clear_misses: Option<usize>,
    /// False hits among them.
    pub clear_false_hits: Option<usize>,
    /// Lies.
    pub lies: usize,
    /// Median of |dt| over correct hits and wrong sheets.
    pub median_dt: Option<f64>,
    /// Greatest |dt| over correct hits and wrong sheets.
    pub worst_dt: Option<f64>,
}

/// The verdict on one answer, and its dt. The direction of its ray has the length `speed`.
pub fn verdict(hit: Hit, truth: Truth, speed: f64, tolerance: f64) -> (Verdict, f64) {
    todo!("{hit:?} {truth:?} {speed} {tolerance}")
}

/// The claim of a certificate that the truth contradicts, if any.
pub fn lie(hit: Hit, truth: Truth) -> Option<Lie> {
    todo!("{hit:?} {truth:?} {:?} {:?}", Certificate::HIT, Class::None)
}

/// Judges the answers to `rays`.
///
/// # Panics
/// If `hits` or `truths` are not for as many rays.
pub fn judge(rays: Rays<'_>, hits: &Hits, truths: &Truths, tolerance: Tolerance) -> Judgement {
    todo!("{rays:?} {hits:?} {truths:?} {tolerance:?}")
}

impl Tally {
    /// Answers of a verdict over all classes of truth.
    pub fn count(&self, verdict: Verdict) -> usize {
        todo!("{verdict:?}")
    }
}

impl Verdict {
    /// The verdicts on judged answers.
    pub const ALL: [Self; 6] = [
        Self::CorrectHit,
        Self::CorrectMiss,
        Self::FalseMiss,
        Self::FalseHit,
        Self::WrongSheet,
        Self::Undecided,
    ];

    /// The name, as printed.
    pub fn name(self) -> &'static str {
        match self {
            Self::CorrectHit => "correct-hit",
            Self::CorrectMiss => "correct-miss",
            Self::FalseMiss => "false-miss",
            Self::FalseHit => "false-hit",
            Self::WrongSheet => "wrong-sheet",
            Self::Undecided => "undecided",
            Self::NotSampled => "not-sampled",
        }
    }
}

impl Lie {
    /// What is wrong.
    pub fn name(self) -> &'static str {
        match self {
            Self::RootMissed => "proven miss, but there is a root",
            Self::RootBefore => "proven first, but a root lies before",
            Self::NoRoot => "proven root, but there is none in the bracket",
        }
    }
}
