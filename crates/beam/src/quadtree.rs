//! The subdivision of the image: cells, breadth first, in spatial order.

use zeroset_raycast::Hit;

/// The base of a beam: a square of the image, `size` pixels a side, cut with the image; and where its beam
/// starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    /// In cells of its level.
    pub column: u32,
    /// In cells of its level.
    pub row: u32,
    /// Nothing is seen before this t.
    pub start: f64,
}

impl Cell {
    /// Those of its quarters that are in an image of so many of them, from left to right and from top to
    /// bottom.
    pub(crate) fn quarters(
        self,
        [columns, rows]: [u32; 2],
        start: f64,
    ) -> impl Iterator<Item = Self> {
        let quarter = move |i: u32| Self {
            column: 2 * self.column + (i & 1),
            row: 2 * self.row + (i >> 1),
            start,
        };
        (0..4).map(quarter).filter(move |cell| cell.column < columns && cell.row < rows)
    }
}

/// How many cells of a size there are along an image's sides.
pub(crate) fn extent(image: [usize; 2], size: u32) -> [u32; 2] {
    image.map(|n| (n as u32).div_ceil(size))
}

/// The size of cells, a power of two, that hold an image in one.
pub(crate) fn whole(image: [usize; 2]) -> u32 {
    (image[0].max(image[1]).max(1) as u32).next_power_of_two()
}

/// All cells of a size, in the order of the quadtree: neighbours stay together.
pub(crate) fn cells(image: [usize; 2], size: u32, start: f64) -> Vec<Cell> {
    let mut side = whole(image).max(size);
    let mut cells = vec![Cell { column: 0, row: 0, start }];
    while side > size {
        side /= 2;
        let extent = extent(image, side);
        cells = cells.into_iter().flat_map(|cell| cell.quarters(extent, start)).collect();
    }
    cells
}

/// What was done on one level of the quadtree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level {
    /// The side of its cells, in pixels.
    pub size: u32,
    /// Beams that were cast.
    pub cells: u64,
    /// Those of them that may see the surface.
    pub found: u64,
    /// Interval evaluations.
    pub intervals: u64,
    /// Interval evaluations that 32 neighbouring beams would have to wait for if they went in step, times
    /// 32: what threads of a GPU do, which share their instructions.
    pub in_step: u64,
}

/// An image's subdivision.
#[derive(Clone, Debug, PartialEq)]
pub struct Subdivision {
    /// From the largest cells on; none if the camera has no rays.
    pub levels: Vec<Level>,
    /// The answer of each pixel.
    pub hits: Vec<Hit>,
    /// The side of the cell in which each answer was found: that of the cell that was excluded, or 1.
    pub sizes: Vec<u32>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_cover_each_pixel_once_and_neighbours_stay_together() {
        for (image, size) in [([8, 8], 1), ([5, 3], 1), ([1, 1], 4), ([300, 1], 16), ([37, 29], 8)]
        {
            let all = cells(image, size, 0.5);
            let extent = extent(image, size);
            assert_eq!(all.len() as u32, extent[0] * extent[1], "{image:?} {size}");
            let mut seen = std::collections::HashSet::new();
            for cell in &all {
                assert!(cell.column < extent[0] && cell.row < extent[1]);
                assert!(seen.insert((cell.column, cell.row)));
            }
        }
        let place = |cell: &Cell| (cell.column, cell.row);
        let first: Vec<_> = cells([8, 8], 1, 0.0).iter().take(5).map(place).collect();
        assert_eq!(first, [(0, 0), (1, 0), (0, 1), (1, 1), (2, 0)]);
    }
}
