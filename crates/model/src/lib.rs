//! Surfaces in quadratic pieces, \[stoll2006\], from the data that they approximate.
//!
//! Each module ends in [`Patches`](zeroset_raycast::Patches), which the methods of `zeroset-quadric` cast.

mod neighbours;
pub mod points;
pub mod slim;
