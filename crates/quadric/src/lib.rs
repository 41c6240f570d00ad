//! Rays cast at quadrics, each in a bound of its own: \[stoll2006\].
//!
//! | method | what it does |
//! |---|---|
//! | [`Quadrics::incremental`]: `quadric` | over a hierarchy of boxes; patches turned away from the eye are culled |
//! | [`Quadrics::brute`]: `quadric-brute` | the same without culling |
//! | [`QuadricsGpu`]: `quadric-gpu`, `quadric-brute-gpu` | rasterised on a device |
//! | [`QuadricReference`]: `quadric-reference` | enclosures of roots, with more bits where needed |
//!
//! A **patch** is a quadric in a ball or in a tetrahedron; a **piece** is a patch in numbers of one precision;
//! a **crossing** is a root in the bound. `equation` solves, `piece` clips, `blend` makes one hit of a sheet,
//! `culling` leaves out what shows its back. Departures from the paper are listed in `docs/deviations.md`.

mod blend;
mod culling;
mod equation;
mod gpu;
mod hierarchy;
mod method;
mod piece;
mod prepared;
mod reference;

pub use culling::is_hidden;
pub use equation::{Equation, Roots};
pub use gpu::{Culling, QuadricsGpu};
pub use method::{Precision, Quadrics, Staging};
pub use piece::Formula;
pub use reference::{PreparedQuadricReference, QuadricReference};
