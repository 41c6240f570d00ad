//! Ray casting methods on the GPU.
//!
//! | method | source | proves |
//! |---|---|---|
//! | [`AmpGpu`] | \[singh2010\] Algorithm 1: `amp-sign-gpu`, `amp-taylor-gpu` | nothing, or roots with the knob `certify` |
//! | [`BisectionGpu`] | \[knoll2007\]: `tbisect-gpu` | first hits, roots, misses |
//!
//! Each is a method of `zeroset_cpu` [on a device](OnDevice), with the same knobs: rays are made ready and
//! answers read there, and only the loop over points or boxes runs on the device. [`Frames`] keeps whole
//! frames on the device. [`device`](mod@device) is a small typed layer over wgpu; [`program`] writes
//! functions as shader code.

pub mod amp;
pub mod bisection;
pub mod bounded;
mod chunks;
mod compiled;
pub mod device;
pub mod frames;
pub mod program;
mod twin;

pub use amp::AmpGpu;
pub use bisection::BisectionGpu;
pub use device::{AdapterReport, Choice, Device, DeviceError, adapters};
pub use frames::{Frames, Look, MOST_LIGHTS, Shadows, Sky, Surroundings};
pub use twin::OnDevice;
