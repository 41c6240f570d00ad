//! Ray casting methods on the CPU.
//!
//! | method | source | proves |
//! |---|---|---|
//! | [`Amp`] | \[singh2010\] Algorithm 1: `amp-sign`, `amp-taylor` | nothing, or roots with the knob `certify` |
//! | [`Bisection`] | \[knoll2007\]: `kmarch`, `tbisect`, `mitchell` | first hits, roots, misses |
//! | [`Reference`] | this project: slow, judged first | all it decides |

pub mod amp;
mod bisection;
mod implicit;
pub mod isa;
pub mod normals;
mod numbers;
mod reference;
pub mod tiles;

pub use amp::{Adaptation, Amp, RootTest};
pub use bisection::{
    Algorithm, Arithmetic, Bisection, Finishing, Goal, Packets, Poles, Reason, Settled, Settler,
    Stop,
};
pub use implicit::Implicit;
pub use normals::Normals;
pub use numbers::Numbers;
pub use reference::{Class, PreparedReference, Reference, Truth};
