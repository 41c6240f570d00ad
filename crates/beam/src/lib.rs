//! Beam casting, \[ganacim2011\]: whole pixels at once, with interval arithmetic.
//!
//! | method | what it casts | proves |
//! |---|---|---|
//! | [`Beam::uniform`]: `beam-uniform` | one beam a pixel | first hits and misses of whole pixels |
//! | [`Beam::adaptive`]: `beam-adaptive` | beams of the cells of a quadtree, down to pixels | the same |
//! | [`BeamGpu`]: `beam-uniform-gpu`, `beam-adaptive-gpu` | the same on a device | the same |
//!
//! A **beam** holds all rays through its base, a rectangle of the image. A **cell** is a base with the
//! depth at which its beam starts. A **piece** of a beam is its part over a range of t; its box encloses
//! it. `optics` makes boxes of beams, `cast` bisects one packet of beams, `quadtree` is the image's
//! subdivision. Departures from the paper are listed in `docs/deviations.md`.

mod cast;
mod form;
mod gpu;
mod method;
mod optics;
mod prepared;
mod quadtree;
mod region;

pub use gpu::BeamGpu;
pub use method::{Arithmetic, Beam, Enclosure, FILLING, Refinement, Start, Stop};
pub use prepared::PreparedBeams;
pub use quadtree::{Level, Subdivision};
