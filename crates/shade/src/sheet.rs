//! Contact sheets.

use crate::legend::{self, Legend, ink, paper};
use crate::text::{self, LINE};
use crate::{Picture, ShadeError};

/// Space around and between pictures, in pixels.
const GAP: usize = 16;
/// The greatest width of a legend, in pixels.
const LEGEND: usize = 480;
/// Pictures at least this wide are not enlarged, in pixels.
const SMALLEST: usize = 160;
/// The shape of a sheet whose columns are not given: width over height.
const SHAPE: f64 = 1.5;

/// One or more pictures side by side above a caption.
#[derive(Clone, Debug)]
pub struct Tile<'a> {
    caption: String,
    pictures: Vec<&'a Picture>,
}

impl<'a> Tile<'a> {
    /// Pictures and their caption, whose line ends are kept.
    pub fn new(caption: impl Into<String>, pictures: &[&'a Picture]) -> Self {
        Self { caption: caption.into(), pictures: pictures.to_vec() }
    }

    fn width(&self, zoom: usize) -> usize {
        let gaps = self.pictures.len().saturating_sub(1) * GAP / 2;
        self.pictures.iter().map(|p| zoom * p.width()).sum::<usize>() + gaps
    }
}

/// Tiles in a grid, with every legend once at the foot.
///
/// The columns are chosen so that the sheet is somewhat wider than high. Captions are broken to the
/// width of the column. Pictures that are all small are enlarged, each pixel to a square. An empty
/// title takes no space.
///
/// # Errors
/// [`ShadeError::Empty`] without pictures, [`ShadeError::TooLarge`] if there are more pixels than
/// can be counted.
pub fn sheet(title: &str, tiles: &[Tile<'_>]) -> Result<Picture, ShadeError> {
    // How far from the best shape, and how much of the grid is empty.
    let fault = |columns: usize| {
        let grid = Grid::new(title, tiles, columns);
        let shape = (grid.width() as f64 / grid.height() as f64 / SHAPE).ln().abs();
        let places = columns * tiles.len().div_ceil(columns);
        shape + 1.0 - tiles.len() as f64 / places as f64
    };
    let columns = (1..=tiles.len().min(12)).min_by(|a, b| fault(*a).total_cmp(&fault(*b)));
    sheet_in_columns(title, tiles, columns.unwrap_or(1))
}

/// Like [`sheet`], with the number of columns given; 0 is taken as 1.
///
/// # Errors
/// As for [`sheet`].
pub fn sheet_in_columns(
    title: &str,
    tiles: &[Tile<'_>],
    columns: usize,
) -> Result<Picture, ShadeError> {
    if tiles.iter().all(|tile| tile.pictures.is_empty()) {
        return Err(ShadeError::Empty { width: 0, height: 0 });
    }
    let grid = Grid::new(title, tiles, columns.clamp(1, tiles.len()));
    let mut sheet = Picture::filled(grid.width(), grid.height(), paper())?;
    grid.draw(&mut sheet);
    Ok(sheet.described(title))
}

/// A tile whose caption is broken into lines.
struct Cell<'a> {
    tile: &'a Tile<'a>,
    caption: Vec<String>,
}

/// Where everything goes.
struct Grid<'a> {
    title: Vec<String>,
    /// Pixels a side of a picture's pixel.
    zoom: usize,
    /// Width of a column.
    column: usize,
    columns: usize,
    rows: Vec<Vec<Cell<'a>>>,
    legends: Vec<&'a Legend>,
}

impl<'a> Grid<'a> {
    fn new(title: &str, tiles: &'a [Tile<'a>], columns: usize) -> Self {
        let pictures = || tiles.iter().flat_map(|tile| tile.pictures.iter().copied());
        let widest = pictures().map(Picture::width).max().unwrap_or(1);
        let zoom = SMALLEST.div_ceil(widest);
        let content = tiles.iter().map(|tile| tile.width(zoom)).max().unwrap_or(0);
        let column = content.max(legend::NARROWEST);
        let cell = |tile: &'a Tile<'a>| Cell { tile, caption: text::wrap(&tile.caption, column) };
        let rows = tiles.chunks(columns).map(|row| row.iter().map(cell).collect()).collect();
        let mut legends: Vec<&Legend> = Vec::new();
        for legend in pictures().filter_map(Picture::legend) {
            if !legends.contains(&legend) {
                legends.push(legend);
            }
        }
        let mut grid = Self { title: Vec::new(), zoom, column, columns, rows, legends };
        grid.title = text::wrap(title, grid.width() - 2 * GAP);
        grid
    }

    fn width(&self) -> usize {
        GAP + self.columns * (self.column + GAP)
    }

    fn height(&self) -> usize {
        let rows: usize = self.rows.iter().map(|row| self.row_height(row) + GAP).sum();
        let legends: usize = self.legend_rows().map(|row| self.legend_height(row) + GAP).sum();
        GAP + self.title_height() + rows + legends
    }

    fn title_height(&self) -> usize {
        if self.title.is_empty() { 0 } else { self.title.len() * LINE + GAP / 2 }
    }

    fn row_height(&self, row: &[Cell<'_>]) -> usize {
        let lines = row.iter().map(|cell| cell.caption.len()).max().unwrap_or(0);
        self.picture_height(row) + GAP / 2 + lines * LINE
    }

    fn picture_height(&self, row: &[Cell<'_>]) -> usize {
        let heights = row.iter().flat_map(|cell| cell.tile.pictures.iter().map(|p| p.height()));
        self.zoom * heights.max().unwrap_or(0)
    }

    /// Legends stand side by side where there is room.
    fn legend_rows(&self) -> impl Iterator<Item = &[&'a Legend]> {
        self.legends.chunks((self.width() / (LEGEND + GAP)).max(1))
    }

    fn legend_width(&self) -> usize {
        (self.width() - 2 * GAP).min(LEGEND)
    }

    fn legend_height(&self, row: &[&Legend]) -> usize {
        row.iter().map(|l| l.height(self.legend_width())).max().unwrap_or(0)
    }

    fn draw(&self, sheet: &mut Picture) {
        let mut y = GAP;
        write_lines(sheet, [GAP, y], &self.title);
        y += self.title_height();
        for row in &self.rows {
            for (i, cell) in row.iter().enumerate() {
                let left = GAP + i * (self.column + GAP);
                let mut x = left;
                for picture in &cell.tile.pictures {
                    sheet.paste(picture, [x, y], self.zoom);
                    x += self.zoom * picture.width() + GAP / 2;
                }
                write_lines(sheet, [left, y + self.picture_height(row) + GAP / 2], &cell.caption);
            }
            y += self.row_height(row) + GAP;
        }
        for row in self.legend_rows() {
            for (i, legend) in row.iter().enumerate() {
                legend.draw(sheet, [GAP / 2 + i * (LEGEND + GAP), y], self.legend_width());
            }
            y += self.legend_height(row) + GAP;
        }
    }
}

fn write_lines(sheet: &mut Picture, [x, y]: [usize; 2], lines: &[String]) {
    for (i, line) in lines.iter().enumerate() {
        text::write(sheet, [x, y + i * LINE], line, ink());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_picture_is_on_the_sheet() {
        let pictures: Vec<Picture> =
            (1..=6).map(|i| Picture::filled(30 * i, 20, [i as u8; 3]).unwrap()).collect();
        let tiles: Vec<_> =
            pictures.chunks(2).map(|p| Tile::new("caption", &[&p[0], &p[1]])).collect();
        for columns in [0, 1, 2, 3, 99] {
            let sheet = sheet_in_columns("six", &tiles, columns).unwrap();
            for (i, picture) in pictures.iter().enumerate() {
                let colour = [i as u8 + 1; 3];
                let count = sheet.pixels().iter().filter(|p| **p == colour).count();
                assert_eq!(count, picture.pixels().len(), "{columns} columns");
            }
        }
    }

    #[test]
    fn small_pictures_are_enlarged() {
        let picture = Picture::filled(32, 8, [7; 3]).unwrap();
        let sheet = sheet("", &[Tile::new("", &[&picture])]).unwrap();
        let count = sheet.pixels().iter().filter(|p| **p == [7; 3]).count();
        assert_eq!(count, 5 * 5 * 32 * 8);
    }

    #[test]
    fn a_sheet_of_nothing_is_an_error() {
        assert!(matches!(sheet("none", &[]), Err(ShadeError::Empty { .. })));
        let bare = [Tile::new("a caption alone", &[])];
        assert!(matches!(sheet("none", &bare), Err(ShadeError::Empty { .. })));
    }

    #[test]
    fn many_pictures_make_a_sheet_wider_than_high() {
        let picture = Picture::filled(300, 300, [7; 3]).unwrap();
        let tiles = vec![Tile::new("a method\nand its numbers", &[&picture]); 12];
        let sheet = sheet("", &tiles).unwrap();
        let shape = sheet.width() as f64 / sheet.height() as f64;
        assert!((1.0..2.0).contains(&shape), "{} by {}", sheet.width(), sheet.height());
    }
}
