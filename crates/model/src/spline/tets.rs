//! An isosurface as tetrahedra.

use rayon::prelude::*;
use zeroset_raycast::{Blending, Bound, Error, Patch, Patches, Sides};

use super::lattice::Lattice;
use super::mask::{Ordinates, SAMPLES};
use super::sector::SECTORS;
use super::{Outside, Sector};

/// A cube with tetrahedra that hold a part of the isosurface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cell {
    /// Its number in the volume.
    pub(super) number: u32,
    /// Those tetrahedra, by the bits of their numbers.
    pub(super) sectors: u32,
    /// The samples of the cube and its neighbours, with x fastest.
    pub(super) samples: [f32; SAMPLES],
}

/// The tetrahedra that hold a part of an isosurface.
///
/// Of each cube only the 27 samples are kept that its tetrahedra depend on: about 12 bytes a tetrahedron, of
/// which a patch takes 272.
#[derive(Clone, Debug, PartialEq)]
pub struct Tets {
    pub(super) lattice: Lattice,
    pub(super) isovalue: f64,
    pub(super) outside: Outside,
    pub(super) dropped: u64,
    pub(super) cells: Vec<Cell>,
    count: usize,
}

/// One of the tetrahedra.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tet {
    /// The sample that its cube belongs to.
    pub cell: [usize; 3],
    /// Which of the cube's tetrahedra it is.
    pub sector: Sector,
    /// b00, b11, b22, b33, b01, b02, b03, b12, b13, b23 of the spline s.
    pub ordinates: [f64; 10],
}

impl Cell {
    /// The tetrahedra.
    fn sectors(&self) -> impl Iterator<Item = Sector> + use<> {
        let sectors = self.sectors;
        (0..SECTORS).filter(move |n| sectors >> n & 1 == 1).map(Sector::numbered)
    }
}

impl Tets {
    pub(super) fn new(
        lattice: Lattice,
        isovalue: f64,
        outside: Outside,
        dropped: u64,
        cells: Vec<Cell>,
    ) -> Self {
        let count = cells.iter().map(|cell| cell.sectors.count_ones() as usize).sum();
        Self { lattice, isovalue, outside, dropped, cells, count }
    }

    /// How many tetrahedra there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Are there none?
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// How many cubes have tetrahedra.
    pub fn cubes(&self) -> usize {
        self.cells.len()
    }

    /// How many cubes were dropped, since they or neighbours have samples that are not finite.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// The isovalue.
    pub fn isovalue(&self) -> f64 {
        self.isovalue
    }

    /// Which side is the outside.
    pub fn outside(&self) -> Outside {
        self.outside
    }

    /// The tetrahedra in the order of their cubes in the volume.
    pub fn all(&self) -> impl Iterator<Item = Tet> {
        self.cells.iter().flat_map(|cell| self.of(cell))
    }

    /// Those of a cube.
    fn of(&self, cell: &Cell) -> impl Iterator<Item = Tet> + use<> {
        let ordinates = Ordinates::new(&cell.samples);
        let place = self.lattice.cell(cell.number as usize);
        cell.sectors().map(move |sector| Tet {
            cell: place,
            sector,
            ordinates: ordinates.of(sector),
        })
    }

    /// The isosurface f = 0 in tetrahedra, each about the centre of its cube, with f = isovalue - s or its
    /// negative, so that f > 0 outside: \[stoll2006\] Section 5.1.2.
    ///
    /// # Errors
    /// If there are none.
    pub fn patches(&self, sides: Sides) -> Result<Patches, Error> {
        let cells = self.cells.par_iter();
        let patches = cells.flat_map_iter(|cell| self.of(cell).map(|tet| self.patch(&tet)));
        Patches::new(patches.collect(), sides, Blending::None)
    }

    fn patch(&self, tet: &Tet) -> Patch {
        let corners = tet.sector.corners();
        let mut ordinates = tet.ordinates.map(|b| b - self.isovalue);
        if self.outside == Outside::Below {
            ordinates = ordinates.map(|b| -b);
        }
        Patch {
            origin: self.lattice.centre(tet.cell),
            quadric: tet.sector.quadric(&ordinates, self.lattice.spacing),
            bound: Bound::Tetrahedron(corners.map(|corner| self.lattice.corner(tet.cell, corner))),
            clip: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubes_are_as_small_as_documented() {
        assert_eq!((size_of::<Cell>(), size_of::<Patch>()), (116, 272));
    }
}
