//! Ray casting methods on the CPU.
//!
//! | method | source | proves |
//! |---|---|---|
//! | [`Amp`] | \[singh2010\] Algorithm 1 with the sign test | nothing |
//! | [`Kmarch`] | \[knoll2007\] Appendix A | first hits, roots, misses |
//! | [`Reference`] | this project: slow, judged first | all it decides |

mod amp;
mod implicit;
mod isa;
mod kmarch;
mod normals;
mod reference;
mod tiles;

pub use amp::{Adaptation, Amp, RootTest};
pub use kmarch::{Finishing, Kmarch, Stop};
pub use reference::{Class, PreparedReference, Reference, Truth};
