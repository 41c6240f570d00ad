//! Text on pictures.

use crate::Picture;
use crate::font::{self, COLUMNS, ROWS};

/// Pixels a side of a font's dot.
const DOT: usize = 2;
/// The width of a character with the space after it, in pixels.
pub(crate) const CELL: usize = (COLUMNS + 1) * DOT;
/// The height of a line with the space below it, in pixels.
pub(crate) const LINE: usize = (ROWS + 2) * DOT;

/// The width of a line of text in pixels.
pub(crate) fn width(text: &str) -> usize {
    (CELL * text.chars().count()).saturating_sub(DOT)
}

/// Writes a line with its top left corner at `[x, y]`; what lies outside is cut off.
pub(crate) fn write(picture: &mut Picture, [x, y]: [usize; 2], text: &str, ink: [u8; 3]) {
    for (i, character) in text.chars().enumerate() {
        let glyph = font::glyph(character);
        for (row, bits) in glyph.rows.iter().enumerate() {
            for column in (0..COLUMNS).filter(|c| bits >> (COLUMNS - 1 - c) & 1 == 1) {
                let dot = [x + i * CELL + column * DOT, y + (glyph.drop + row) * DOT];
                picture.fill(dot, [DOT, DOT], ink);
            }
        }
    }
}

/// Breaks text into lines of at most `width` pixels: at line ends, between words, and within words
/// that are too long.
pub(crate) fn wrap(text: &str, width: usize) -> Vec<String> {
    let most = ((width + DOT) / CELL).max(1);
    let mut lines = Vec::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        let mut length = 0;
        for word in paragraph.split_whitespace() {
            let letters: Vec<char> = word.chars().collect();
            for (n, part) in letters.chunks(most).enumerate() {
                let space = usize::from(length > 0 && n == 0);
                if length > 0 && (n > 0 || length + space + part.len() > most) {
                    lines.push(std::mem::take(&mut line));
                    length = 0;
                } else if space == 1 {
                    line.push(' ');
                    length += 1;
                }
                line.extend(part);
                length += part.len();
            }
        }
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_words() {
        let width = 10 * CELL;
        assert_eq!(wrap("one two three", width), ["one two", "three"]);
        assert_eq!(wrap("0123456789 a", width), ["0123456789", "a"]);
        assert_eq!(wrap("a\n\nb", width), ["a", "", "b"]);
        assert_eq!(wrap("abcdefghijklm no", width), ["abcdefghij", "klm no"]);
        assert_eq!(wrap("ab", 0), ["a", "b"]);
        assert!(wrap("", width).is_empty());
    }

    #[test]
    fn text_fits_its_width_and_line() {
        let text = "Agjpqy|;";
        let mut picture = Picture::filled(width(text) + 20, LINE + 20, [255; 3]).unwrap();
        write(&mut picture, [0, 0], text, [0; 3]);
        let row_length = picture.width();
        for (i, pixel) in picture.pixels().iter().enumerate() {
            let outside = i % row_length >= width(text) || i / row_length >= LINE;
            assert!(!outside || *pixel == [255; 3], "{i}");
        }
        assert!(picture.pixels().contains(&[0; 3]));
        write(&mut picture, [usize::MAX / 2, 3], text, [0; 3]);
    }
}
