//! Quadratic super splines: a volume as a continuous function in quadratic pieces, and its isosurfaces.
//!
//! Each sample has a cube of the grid's spacing around it, cut into 24 tetrahedra (the type-6 partition). On
//! each of these the spline is a polynomial of degree two, whose ten ordinates (Bernstein-Bezier coefficients)
//! are means of samples near by. Samples at the border have no cube: they only support their neighbours.
//!
//! After Rössl, Zeilfelder, Nürnberger and Seidel, Reconstruction of volume data with quadratic super splines,
//! 2004, which \[stoll2006\] Section 5.1.2 takes its isosurfaces from. `docs/spline.md` has the masks, what they
//! keep and how exact they are.

mod file;
mod isosurface;
mod lattice;
mod mask;
mod sector;
mod tets;

use std::borrow::Cow;

use glam::DVec3;
use zeroset_raycast::{Error, Quadric};

use crate::volume::Volume;
use lattice::Lattice;
use mask::{Ordinates, SAMPLES};

pub use isosurface::{Outside, isosurface};
pub use sector::Sector;
pub use tets::{Tet, Tets};

/// What is done to samples before the spline is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// Nothing, as in the paper: quadratic functions are found up to a constant.
    #[default]
    None,
    /// f - (sum of second differences along the axes)/8, which takes that constant away: quadratic functions
    /// are found as they are, smooth ones with errors of higher order. At the border, second differences are
    /// continued linearly. This is not in the paper.
    Laplacian,
}

/// The spline of a volume.
#[derive(Clone, Debug)]
pub struct Spline<'a> {
    volume: Cow<'a, Volume>,
    lattice: Lattice,
}

impl<'a> Spline<'a> {
    /// The spline of a volume, whose samples are filtered first.
    ///
    /// # Errors
    /// If a size is below 3: then no cube has all of its neighbours.
    pub fn new(volume: &'a Volume, filter: Filter) -> Result<Self, Error> {
        let [x, y, z] = volume.size();
        if x.min(y).min(z) < 3 {
            return Err(Error::Patches(format!(
                "a volume of {x} x {y} x {z} samples has no spline; it takes at least 3 along each axis"
            )));
        }
        let volume = match filter {
            Filter::None => Cow::Borrowed(volume),
            Filter::Laplacian => Cow::Owned(sharpened(volume)),
        };
        let lattice = Lattice::of(&volume);
        Ok(Self { volume, lattice })
    }

    /// The polynomial of a tetrahedron, about the centre of its cube, which is the cube of this sample.
    ///
    /// # Panics
    /// If the sample lies at the border or outside.
    pub fn quadric(&self, cell: [usize; 3], sector: Sector) -> Quadric {
        sector.quadric(&self.ordinates(cell, sector), self.lattice.spacing)
    }

    /// The ordinates of a tetrahedron: b00, b11, b22, b33, b01, b02, b03, b12, b13, b23.
    ///
    /// # Panics
    /// If the sample lies at the border or outside.
    pub fn ordinates(&self, cell: [usize; 3], sector: Sector) -> [f64; 10] {
        assert!(self.lattice.is_inside(cell), "sample {cell:?} has no cube");
        Ordinates::new(&self.samples(cell)).of(sector)
    }

    /// The spline's value at a point, if the point lies in a cube.
    pub fn value(&self, point: DVec3) -> Option<f64> {
        let (quadric, from_centre) = self.piece(point)?;
        Some(quadric.value(from_centre))
    }

    /// The spline's gradient at a point, if the point lies in a cube: that of one of the pieces there.
    pub fn gradient(&self, point: DVec3) -> Option<DVec3> {
        let (quadric, from_centre) = self.piece(point)?;
        Some(2.0 * quadric.half_gradient(from_centre))
    }

    /// The polynomial at a point, and the point relative to its origin.
    fn piece(&self, point: DVec3) -> Option<(Quadric, DVec3)> {
        let (cell, steps) = self.lattice.locate(point)?;
        Some((self.quadric(cell, Sector::holding(steps)), steps * self.lattice.spacing))
    }

    /// The samples of a cube and its neighbours, with x fastest.
    fn samples(&self, [i, j, k]: [usize; 3]) -> [f32; SAMPLES] {
        let values = self.volume.values();
        let mut samples = [0.0; SAMPLES];
        for (row, samples) in samples.chunks_exact_mut(3).enumerate() {
            let start = self.lattice.number([i - 1, j - 1 + row % 3, k - 1 + row / 3]);
            samples.copy_from_slice(&values[start..start + 3]);
        }
        samples
    }
}

/// The samples less an eighth of their second differences.
fn sharpened(volume: &Volume) -> Volume {
    let size = volume.size();
    let values = volume.values();
    let strides = [1, size[0], size[0] * size[1]];
    let mut sharp = Vec::with_capacity(values.len());
    for k in 0..size[2] {
        for j in 0..size[1] {
            for i in 0..size[0] {
                let at = i + strides[1] * j + strides[2] * k;
                let mut sum = 0.0;
                for (axis, n) in [i, j, k].into_iter().enumerate() {
                    let start = at - n * strides[axis];
                    let line = |n: usize| f64::from(values[start + n * strides[axis]]);
                    sum += second_difference(line, n, size[axis]);
                }
                sharp.push((f64::from(values[at]) - 0.125 * sum) as f32);
            }
        }
    }
    volume.with_values(sharp)
}

/// The second difference of a line of `length` samples at the n-th, continued linearly to its ends.
fn second_difference(line: impl Fn(usize) -> f64, n: usize, length: usize) -> f64 {
    let inside = |n: usize| line(n - 1) + line(n + 1) - 2.0 * line(n);
    let last = length - 2;
    match n.clamp(1, last) {
        // Of three samples there is but one.
        inner if inner == n || last == 1 => inside(inner),
        1 => 2.0 * inside(1) - inside(2),
        _ => 2.0 * inside(last) - inside(last - 1),
    }
}
