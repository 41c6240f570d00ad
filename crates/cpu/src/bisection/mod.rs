//! Casting by bisection with interval arithmetic, [knoll2007]: three algorithms, one traversal.
//!
//! A piece of a ray is bisected while `0 in F(X, Y, Z)` (Eq. 5), to the depth d_stop; pieces where 0 is
//! not in F hold no root. The algorithms of Section 6.5 differ in where rays are cut, and in what ends
//! the bisection:
//!
//! | algorithm | pieces | bisected until |
//! |---|---|---|
//! | [`Kmarch`](Algorithm::Kmarch) | slabs across the packet's common axis K | they are small |
//! | [`Tbisect`](Algorithm::Tbisect) | parts of each ray's own range of t | they are small |
//! | [`Mitchell`](Algorithm::Mitchell) | the same | F is monotone there: then without intervals |
//!
//! `bundle` has the rays, `cut`, `clock` and `lattice` the geometry, `march` the traversal, `monotone` Mitchell's
//! test, `finish` the proofs, `settler` what they make of a piece.
//! Departures from the paper are listed in `docs/deviations.md`.

mod answers;
mod bundle;
mod clock;
mod cut;
mod finish;
mod form;
mod lattice;
mod march;
mod method;
mod monotone;
mod prepared;
mod settler;

pub use march::Reason;
pub use method::{Algorithm, Arithmetic, Bisection, Finishing, Packets, Poles, Stop};
pub use settler::{Goal, Settled, Settler};
