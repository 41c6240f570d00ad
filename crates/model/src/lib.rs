//! Surfaces in quadratic pieces, \[stoll2006\], from the data that they approximate.
//!
//! Each module ends in [`Patches`](zeroset_raycast::Patches), which the methods of `zeroset-quadric` cast.
//!
//! | module | from | to |
//! |---|---|---|
//! | [`points`] | files of points | points with normals |
//! | [`slim`] | points with normals | balls with quadrics, blended |
//! | [`volume`] | files of samples on a grid, formulas | volumes |
//! | [`spline`] | volumes | tetrahedra of an isosurface |
//! | [`skin`] | molecules | skin surfaces: spheres and hyperboloids in tetrahedra |
//! | [`bilinear`] | quadrilaterals | each a quadric in the tetrahedron of its corners |

pub mod bilinear;
mod checksum;
mod neighbours;
pub mod points;
pub mod skin;
pub mod slim;
pub mod spline;
pub mod volume;
