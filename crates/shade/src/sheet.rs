//! Contact sheets.

use crate::legend::{self, Legend, ink, paper};
use crate::text::{self, LINE};
use crate::{Picture, ShadeError};

/// Space around and between pictures, in pixels.
const GAP: usize = 16;
/// The shape of a sheet whose columns are not given: width over height.
const SHAPE: f64 = 1.5;

/// Pictures in a grid, each above its caption, with every legend once at the foot.
///
/// The columns are chosen so that the sheet is somewhat wider than high. Captions are broken to the
/// width of the column; a line end in a caption is kept. An empty title takes no space.
///
/// # Errors
/// [`ShadeError::Empty`] without pictures, [`ShadeError::TooLarge`] if there are more pixels than
/// can be counted.
pub fn sheet(title: &str, tiles: &[(String, &Picture)]) -> Result<Picture, ShadeError> {
    let shape = |columns: usize| {
        let grid = Grid::new(title, tiles, columns);
        (grid.width() as f64 / grid.height() as f64 / SHAPE).ln().abs()
    };
    let columns = (1..=tiles.len().min(12)).min_by(|a, b| shape(*a).total_cmp(&shape(*b)));
    sheet_in_columns(title, tiles, columns.unwrap_or(1))
}

/// Like [`sheet`], with the number of columns given; 0 is taken as 1.
///
/// # Errors
/// As for [`sheet`].
pub fn sheet_in_columns(
    title: &str,
    tiles: &[(String, &Picture)],
    columns: usize,
) -> Result<Picture, ShadeError> {
    if tiles.is_empty() {
        return Err(ShadeError::Empty { width: 0, height: 0 });
    }
    let grid = Grid::new(title, tiles, columns.clamp(1, tiles.len()));
    let mut sheet = Picture::filled(grid.width(), grid.height(), paper())?;
    grid.draw(&mut sheet);
    Ok(sheet.described(title))
}

struct Tile<'a> {
    picture: &'a Picture,
    caption: Vec<String>,
}

impl Tile<'_> {
    fn height(&self) -> usize {
        self.picture.height() + GAP / 2 + self.caption.len() * LINE
    }
}

/// Where everything goes.
struct Grid<'a> {
    title: Vec<String>,
    /// Width of a column.
    column: usize,
    columns: usize,
    rows: Vec<Vec<Tile<'a>>>,
    legends: Vec<&'a Legend>,
}

impl<'a> Grid<'a> {
    fn new(title: &str, tiles: &[(String, &'a Picture)], columns: usize) -> Self {
        let widest = tiles.iter().map(|(_, p)| p.width()).max().unwrap_or(0);
        let column = widest.max(legend::NARROWEST);
        let tile = |(caption, picture): &(String, &'a Picture)| Tile {
            picture,
            caption: text::wrap(caption, column),
        };
        let rows = tiles.chunks(columns).map(|row| row.iter().map(tile).collect()).collect();
        let mut legends: Vec<&Legend> = Vec::new();
        for legend in tiles.iter().filter_map(|(_, p)| p.legend()) {
            if !legends.contains(&legend) {
                legends.push(legend);
            }
        }
        let mut grid = Self { title: Vec::new(), column, columns, rows, legends };
        grid.title = text::wrap(title, grid.width() - 2 * GAP);
        grid
    }

    fn width(&self) -> usize {
        GAP + self.columns * (self.column + GAP)
    }

    fn height(&self) -> usize {
        let rows: usize = self.rows.iter().map(|row| row_height(row) + GAP).sum();
        let legends: usize = self.legends.iter().map(|l| l.height(self.legend_width()) + GAP).sum();
        GAP + self.title_height() + rows + legends
    }

    fn title_height(&self) -> usize {
        if self.title.is_empty() { 0 } else { self.title.len() * LINE + GAP / 2 }
    }

    /// Wide enough to read, and not so wide that the eye gets lost.
    fn legend_width(&self) -> usize {
        (self.width() - 2 * GAP).min(720)
    }

    fn draw(&self, sheet: &mut Picture) {
        let mut y = GAP;
        for (i, line) in self.title.iter().enumerate() {
            text::write(sheet, [GAP, y + i * LINE], line, ink());
        }
        y += self.title_height();
        for row in &self.rows {
            for (i, tile) in row.iter().enumerate() {
                let x = GAP + i * (self.column + GAP);
                sheet.paste(tile.picture, x, y);
                let below = y + tile.picture.height() + GAP / 2;
                for (line, words) in tile.caption.iter().enumerate() {
                    text::write(sheet, [x, below + line * LINE], words, ink());
                }
            }
            y += row_height(row) + GAP;
        }
        for legend in &self.legends {
            legend.draw(sheet, [GAP / 2, y], self.legend_width());
            y += legend.height(self.legend_width()) + GAP;
        }
    }
}

fn row_height(row: &[Tile<'_>]) -> usize {
    row.iter().map(Tile::height).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_picture_is_on_the_sheet() {
        let pictures: Vec<Picture> =
            (1..=5).map(|i| Picture::filled(10 * i, 20, [i as u8; 3]).unwrap()).collect();
        let tiles: Vec<_> = pictures.iter().map(|p| ("caption".to_string(), p)).collect();
        for columns in [0, 1, 2, 5, 99] {
            let sheet = sheet_in_columns("five", &tiles, columns).unwrap();
            for (i, picture) in pictures.iter().enumerate() {
                let colour = [i as u8 + 1; 3];
                let count = sheet.pixels().iter().filter(|p| **p == colour).count();
                assert_eq!(count, picture.pixels().len(), "{columns} columns");
            }
        }
    }

    #[test]
    fn a_sheet_of_nothing_is_an_error() {
        assert!(matches!(sheet("none", &[]), Err(ShadeError::Empty { .. })));
    }

    #[test]
    fn many_pictures_make_a_sheet_wider_than_high() {
        let picture = Picture::filled(300, 300, [7; 3]).unwrap();
        let tiles = vec![("a method\nand its numbers".to_string(), &picture); 12];
        let sheet = sheet("", &tiles).unwrap();
        let shape = sheet.width() as f64 / sheet.height() as f64;
        assert!((1.0..2.0).contains(&shape), "{} by {}", sheet.width(), sheet.height());
    }
}
