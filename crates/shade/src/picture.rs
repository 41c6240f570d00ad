//! Pictures in memory.

use std::path::Path;

use glam::Vec3;
use zeroset_raycast::{Hits, View};

use crate::{Colour, Legend, ShadeError, legend, png, write_atomically};

/// Pixels of three bytes encoded as sRGB, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
    description: String,
    legend: Option<Legend>,
}

impl Picture {
    /// A picture of one colour.
    ///
    /// # Errors
    /// [`ShadeError::Empty`] without pixels, [`ShadeError::TooLarge`] with more than can be
    /// counted.
    pub fn filled(width: usize, height: usize, colour: [u8; 3]) -> Result<Self, ShadeError> {
        let count = count(width, height)?;
        let pixels = vec![colour; count];
        Ok(Self { width, height, pixels, description: String::new(), legend: None })
    }

    /// A picture of the given pixels.
    ///
    /// # Errors
    /// If there are not `width` times `height`, or none.
    pub fn from_pixels(
        width: usize,
        height: usize,
        pixels: Vec<[u8; 3]>,
    ) -> Result<Self, ShadeError> {
        let wanted = count(width, height)?;
        if pixels.len() != wanted {
            let got = pixels.len();
            return Err(ShadeError::Count { what: "colours", got, width, height });
        }
        Ok(Self { width, height, pixels, description: String::new(), legend: None })
    }

    /// The picture of a view, pixel by pixel; `paint` gets the pixel's index.
    pub(crate) fn painted(
        view: &View,
        description: impl Into<String>,
        legend: Option<Legend>,
        paint: impl FnMut(usize) -> [u8; 3],
    ) -> Result<Self, ShadeError> {
        let pixels = (0..count(view.width, view.height)?).map(paint).collect();
        let description = description.into();
        Ok(Self { width: view.width, height: view.height, pixels, description, legend })
    }

    /// Pixels in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The pixels, row by row from the top, encoded as sRGB.
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// What the picture shows, in words; it goes into the PNG.
    pub fn description(&self) -> &str {
        &self.description
    }

    /// The picture with another description.
    pub fn described(self, description: impl Into<String>) -> Self {
        Self { description: description.into(), ..self }
    }

    /// What the colours mean.
    pub fn legend(&self) -> Option<&Legend> {
        self.legend.as_ref()
    }

    /// The picture with its legend drawn below it; as it is, if it has none.
    ///
    /// # Errors
    /// [`ShadeError::TooLarge`], if there are more pixels than can be counted.
    pub fn with_legend(&self) -> Result<Self, ShadeError> {
        let Some(legend) = &self.legend else { return Ok(self.clone()) };
        let width = self.width.max(legend::NARROWEST);
        let height = self.height.saturating_add(legend.height(width));
        let mut picture = Self::filled(width, height, legend::paper())?;
        picture.paste(self, [(width - self.width) / 2, 0], 1);
        legend.draw(&mut picture, [0, self.height], width);
        Ok(picture.described(self.description.as_str()))
    }

    /// The picture at a smaller size: each pixel is the mean of `side` by `side` of these, in linear light.
    ///
    /// # Errors
    /// [`ShadeError::Empty`] if there are not so many.
    pub fn averaged(&self, side: usize) -> Result<Self, ShadeError> {
        if side == 1 {
            return Ok(self.clone());
        }
        let mut picture =
            Self::filled(self.width / side.max(1), self.height / side.max(1), [0; 3])?;
        let width = picture.width;
        for (i, pixel) in picture.pixels.iter_mut().enumerate() {
            let (column, row) = (side * (i % width), side * (i / width));
            let rows = self.pixels.chunks(self.width).skip(row).take(side);
            let part = rows.flat_map(|row| &row[column..column + side]);
            let sum: Vec3 = part.map(|bytes| Colour::from_bytes(*bytes).0).sum();
            *pixel = Colour(sum / (side * side) as f32).bytes();
        }
        picture.legend.clone_from(&self.legend);
        Ok(picture.described(self.description.as_str()))
    }

    /// Saves the picture as PNG, with its description. Missing folders are created; the file is
    /// whole or absent.
    ///
    /// # Errors
    /// If the folder cannot be made or written, or PNG cannot hold the picture.
    pub fn save_png(&self, path: &Path) -> Result<(), ShadeError> {
        write_atomically(path, &self.png(path)?)
    }

    /// The bytes of the picture's PNG file, with its description; `path` is for messages.
    ///
    /// # Errors
    /// If PNG cannot hold the picture.
    pub fn png(&self, path: &Path) -> Result<Vec<u8>, ShadeError> {
        png::encode(path, self)
    }

    /// Colours the part of a rectangle that lies in the picture.
    pub(crate) fn fill(&mut self, [x, y]: [usize; 2], [w, h]: [usize; 2], colour: [u8; 3]) {
        let columns = x.min(self.width)..x.saturating_add(w).min(self.width);
        for row in y.min(self.height)..y.saturating_add(h).min(self.height) {
            let start = row * self.width;
            self.pixels[start + columns.start..start + columns.end].fill(colour);
        }
    }

    /// Copies another picture, each pixel to a square of `zoom` a side; what lies outside is cut
    /// off.
    pub(crate) fn paste(&mut self, other: &Self, [x, y]: [usize; 2], zoom: usize) {
        for (i, pixel) in other.pixels.iter().enumerate() {
            let [column, row] = [i % other.width, i / other.width];
            self.fill([x + zoom * column, y + zoom * row], [zoom, zoom], *pixel);
        }
    }
}

/// How many pixels, at least one.
fn count(width: usize, height: usize) -> Result<usize, ShadeError> {
    if width == 0 || height == 0 {
        return Err(ShadeError::Empty { width, height });
    }
    // Three bytes each, in one vector.
    width.checked_mul(height).filter(|n| *n <= isize::MAX as usize / 3).ok_or(
        ShadeError::TooLarge { width, height, limit: "make it smaller or cut it into parts" },
    )
}

/// Checks that there is one answer for each pixel.
pub(crate) fn check_count(view: &View, what: &'static str, got: usize) -> Result<(), ShadeError> {
    let (width, height) = (view.width, view.height);
    if count(width, height)? == got {
        Ok(())
    } else {
        Err(ShadeError::Count { what, got, width, height })
    }
}

/// Checks that the hits are those of the view: as many of everything as pixels.
pub(crate) fn check_hits(view: &View, hits: &Hits) -> Result<(), ShadeError> {
    check_count(view, "brackets", hits.bracket.len())?;
    check_count(view, "certificates", hits.certificate.len())?;
    check_count(view, "counts of work", hits.work.len())?;
    if hits.normal.is_empty() { Ok(()) } else { check_count(view, "normals", hits.normal.len()) }
}

/// Checks that the hits are those of the view and have normals.
pub(crate) fn check_normals(
    view: &View,
    hits: &Hits,
    kind: &'static str,
) -> Result<(), ShadeError> {
    check_hits(view, hits)?;
    if hits.normal.is_empty() { Err(ShadeError::NoNormals(kind)) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawing_stays_inside() {
        let mut picture = Picture::filled(3, 2, [0; 3]).unwrap();
        picture.fill([2, 1], [9, usize::MAX], [1; 3]);
        picture.fill([7, 0], [1, 1], [2; 3]);
        picture.fill([0, 9], [1, 1], [2; 3]);
        let blot = Picture::filled(5, 5, [3; 3]).unwrap();
        picture.paste(&blot, [9, 9], 1);
        picture.paste(&blot, [0, 1], 2);
        assert_eq!(picture.pixels(), [[0; 3], [0; 3], [0; 3], [3; 3], [3; 3], [3; 3]]);
    }

    #[test]
    fn pictures_are_averaged_in_linear_light() {
        let (black, white) = ([0; 3], [255; 3]);
        let pixels = [[black, white, white, white, black], [black, white, white, white, black]];
        let picture = Picture::from_pixels(5, 2, pixels.concat()).unwrap();
        let half = picture.averaged(2).unwrap();
        assert_eq!((half.width(), half.height()), (2, 1));
        assert_eq!(half.pixels(), [[188; 3], white]);
        assert_eq!(picture.averaged(1).unwrap(), picture);
        assert!(matches!(picture.averaged(3), Err(ShadeError::Empty { .. })));
    }

    #[test]
    fn empty_and_uncountable_pictures_are_errors() {
        assert!(matches!(
            Picture::filled(0, 5, [0; 3]),
            Err(ShadeError::Empty { width: 0, height: 5 })
        ));
        assert!(matches!(Picture::filled(usize::MAX, 2, [0; 3]), Err(ShadeError::TooLarge { .. })));
    }
}
