//! Any method on any scene at any precision, judged.
//!
//! ```text
//!  methods --compare--> answers, times ---+--> records (CSV, JSON)
//!                          |              |
//!  reference --classify--> truths --judge-+
//! ```
//!
//! - A [`Registry`] holds the methods: one line each.
//! - [`judge`](mod@judge) compares each answer, and each claim of its certificate, with the truth.
//! - [`compare`](mod@compare) runs methods on a scene and rays: judged first, timed then.
//! - A [`Record`] is one run as a row of a table.
//! - [`tune`] measures settings of AMP on a surface.
//! - [`conformance`] is the suite that every method must pass.

pub mod compare;
pub mod conformance;
pub mod judge;
pub mod machine;
pub mod methods;
pub mod record;
pub mod truth;
pub mod tune;

pub use compare::{Comparison, Options, Outcome, Run, Stage, Times, compare};
pub use conformance::{Failure, check};
pub use judge::{Judgement, Lie, Tally, Tolerance, Verdict, judge};
pub use machine::Machine;
pub use methods::{Registry, UnknownMethod, method, methods};
pub use record::{Context, Record, RecordError};
pub use truth::{Class, Footprints, Oracle, Remembering, Sample, Truth, Truths};
