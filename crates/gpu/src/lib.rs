//! Ray casting methods on the GPU.
//!
//! | method | source | proves |
//! |---|---|---|
//! | [`AmpGpu`] | \[singh2010\] | nothing |
//! | [`BisectionGpu`] | \[knoll2007\]: `tbisect` | first hits, roots, misses |
//!
//! Each is the twin of a method of `zeroset_cpu`, with the same knobs: rays are made ready and answers
//! read there, and only the loop over points or boxes runs on the device. [`Frames`] keeps whole frames on the device. [`device`] is a small typed
//! layer over wgpu; [`program`] writes functions as shader code.

pub mod amp;
pub mod bisection;
mod bounded;
mod chunks;
mod compiled;
pub mod device;
pub mod frames;
pub mod program;
mod settings;

pub use amp::AmpGpu;
pub use bisection::BisectionGpu;
pub use device::{AdapterReport, Choice, Device, DeviceError, adapters};
pub use frames::{Frames, Look, MOST_LIGHTS, Shadows};
