//! Which tetrahedra hold a part of an isosurface.

use rayon::prelude::*;
use zeroset_raycast::{Error, Progress};

use super::lattice::Lattice;
use super::mask::{Ordinates, SAMPLES};
use super::tets::{Cell, Tets};
use super::{Filter, Sector, Spline};
use crate::volume::Volume;

/// Which side of an isosurface is its outside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Outside {
    /// Where values are below the isovalue, as around what is dense: f = isovalue - s.
    #[default]
    Below,
    /// Where values are above it, as around a distance: f = s - isovalue.
    Above,
}

/// What was found in a part of the volume.
#[derive(Default)]
struct Part {
    cells: Vec<Cell>,
    dropped: u64,
}

/// The isosurface of a volume: of its spline without a filter, with the outside where values are below.
///
/// # Errors
/// As for [`Spline::new`] and [`Spline::isosurface`].
pub fn isosurface(volume: &Volume, isovalue: f64, progress: &Progress) -> Result<Tets, Error> {
    Spline::new(volume, Filter::None)?.isosurface(isovalue, Outside::Below, progress)
}

impl Spline<'_> {
    /// The tetrahedra with min(ordinates) < isovalue < max(ordinates): no other holds a part of the
    /// isosurface, since a polynomial lies between its ordinates. `progress` counts cubes.
    ///
    /// Cubes with a sample that is no finite number, or with such a neighbour, are dropped and counted.
    ///
    /// # Errors
    /// If the isovalue is not finite or no tetrahedron is found; [`Error::Interrupted`] if the work should
    /// stop.
    pub fn isosurface(
        &self,
        isovalue: f64,
        outside: Outside,
        progress: &Progress,
    ) -> Result<Tets, Error> {
        if !isovalue.is_finite() {
            return Err(Error::Patches(format!(
                "the isovalue {isovalue} is not finite; give a number"
            )));
        }
        let [_, ny, nz] = self.lattice.size;
        // The order of the parts is that of the volume, whichever thread finds them.
        let parts: Vec<Part> = (1..nz - 1)
            .into_par_iter()
            .map(|k| {
                let mut part = Part::default();
                for j in 1..ny - 1 {
                    self.search_row(j, k, isovalue, &mut part);
                    progress.advance(self.lattice.size[0] - 2)?;
                }
                Ok(part)
            })
            .collect::<Result<_, Error>>()?;
        let dropped = parts.iter().map(|part| part.dropped).sum();
        let cells: Vec<Cell> = parts.into_iter().flat_map(|part| part.cells).collect();
        if cells.is_empty() {
            return Err(self.nothing(isovalue, dropped));
        }
        let Lattice { size, spacing, origin, .. } = self.lattice;
        Ok(Tets::new(Lattice::new(size, spacing, origin), isovalue, outside, dropped, cells))
    }

    /// Searches the cubes of a row along x.
    fn search_row(&self, j: usize, k: usize, isovalue: f64, part: &mut Part) {
        let nx = self.lattice.size[0];
        let values = self.volume.values();
        let rows: [&[f32]; 9] = std::array::from_fn(|row| {
            let start = self.lattice.number([0, j - 1 + row % 3, k - 1 + row / 3]);
            &values[start..start + nx]
        });
        // Of each column: the least and the greatest sample, and whether all are finite.
        let column = |i: usize| {
            rows.iter().fold(
                (f32::INFINITY, f32::NEG_INFINITY, true),
                |(least, most, finite), row| {
                    let v = row[i];
                    (least.min(v), most.max(v), finite & v.is_finite())
                },
            )
        };
        let mut window = [column(0), column(0), column(1)];
        for i in 1..nx - 1 {
            window = [window[1], window[2], column(i + 1)];
            let [a, b, c] = window;
            if !(a.2 & b.2 & c.2) {
                part.dropped += 1;
                continue;
            }
            // Ordinates are means: without samples on both sides there are none.
            let least = f64::from(a.0.min(b.0).min(c.0));
            let most = f64::from(a.1.max(b.1).max(c.1));
            if !(least < isovalue && isovalue < most) {
                continue;
            }
            let samples = self.samples([i, j, k]);
            let sectors = crossed(&samples, isovalue);
            if sectors != 0 {
                let number = self.lattice.number([i, j, k]) as u32;
                part.cells.push(Cell { number, sectors, samples });
            }
        }
    }

    /// Why an isosurface is empty.
    fn nothing(&self, isovalue: f64, dropped: u64) -> Error {
        let size = self.lattice.size;
        let cubes: u64 = size.into_iter().map(|n| n as u64 - 2).product();
        Error::Patches(match self.volume.range() {
            Some([least, most]) if dropped < cubes => {
                let and = match dropped {
                    0 => String::new(),
                    _ => format!(
                        "; {dropped} of {cubes} cubes were dropped for samples that are not finite"
                    ),
                };
                format!(
                    "the isovalue {isovalue} meets no tetrahedron: samples lie between {least} and {most}{and}"
                )
            }
            _ => format!(
                "each of the {cubes} cubes has a sample near by that is not finite: \
                 write the volume with numbers for them"
            ),
        })
    }
}

/// The tetrahedra, by the bits of their numbers, whose ordinates lie on both sides.
fn crossed(samples: &[f32; SAMPLES], isovalue: f64) -> u32 {
    let ordinates = Ordinates::new(samples);
    Sector::all().fold(0, |sectors, sector| {
        let own = ordinates.of(sector);
        let is_crossed = own.iter().any(|b| *b < isovalue) && own.iter().any(|b| *b > isovalue);
        sectors | u32::from(is_crossed) << sector.number()
    })
}
