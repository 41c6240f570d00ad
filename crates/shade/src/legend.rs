//! Legends: what false colours mean.

use crate::palette::Palette;
use crate::text::{self, CELL, LINE};
use crate::{Colour, Picture};

/// The least width at which legends can be read, in pixels.
pub(crate) const NARROWEST: usize = 240;

/// Space around and between things.
const GAP: usize = 8;
/// Height of a scale's bar.
const BAR: usize = 14;
/// Side of a key's swatch.
const SWATCH: usize = 14;

/// A scale of colours, and keys for single ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    pub(crate) scale: Option<Scale>,
    pub(crate) keys: Vec<Key>,
}

/// A bar of colours with numbers below.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Scale {
    pub title: String,
    pub palette: Palette,
    pub ticks: Vec<Tick>,
}

/// A number on a scale.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    /// 0 at the left end, 1 at the right.
    pub position: f32,
    pub label: String,
}

/// A colour and its name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Key {
    pub colour: [u8; 3],
    pub label: String,
}

impl Key {
    pub(crate) fn new(colour: [u8; 3], label: impl Into<String>) -> Self {
        Self { colour, label: label.into() }
    }

    fn width(&self) -> usize {
        SWATCH + GAP + text::width(&self.label)
    }
}

/// The colour under legends and captions.
pub(crate) fn paper() -> [u8; 3] {
    Colour::oklch(0.985, 0.003, 90.0).bytes()
}

/// The colour of text.
pub(crate) fn ink() -> [u8; 3] {
    Colour::oklch(0.30, 0.01, 270.0).bytes()
}

impl Legend {
    /// The height of the legend in pixels, when it is `width` wide.
    pub(crate) fn height(&self, width: usize) -> usize {
        let scale = if self.scale.is_some() { LINE + BAR + GAP / 2 + LINE + GAP } else { 0 };
        GAP + scale + self.rows(width).len() * (LINE + GAP / 2) + GAP / 2
    }

    /// Draws the legend with its top left corner at `[x, y]`.
    pub(crate) fn draw(&self, picture: &mut Picture, [x, y]: [usize; 2], width: usize) {
        let left = x + GAP;
        let mut top = y + GAP;
        if let Some(scale) = &self.scale {
            scale.draw(picture, [left, top], width.saturating_sub(2 * GAP).max(1));
            top += LINE + BAR + GAP / 2 + LINE + GAP;
        }
        for row in self.rows(width) {
            for (offset, key) in row {
                picture.fill([left + offset, top], [SWATCH, SWATCH], ink());
                picture.fill([left + offset + 1, top + 1], [SWATCH - 2, SWATCH - 2], key.colour);
                text::write(picture, [left + offset + SWATCH + GAP, top], &key.label, ink());
            }
            top += LINE + GAP / 2;
        }
    }

    /// The keys in rows, each key with its place in the row: columns of equal width.
    fn rows(&self, width: usize) -> Vec<Vec<(usize, &Key)>> {
        let cell = self.keys.iter().map(Key::width).max().unwrap_or(0) + 2 * GAP;
        let columns = (width / cell).max(1);
        // As many columns as fit, but no last row of one beside a row of many.
        let rows = self.keys.len().div_ceil(columns).max(1);
        let columns = self.keys.len().div_ceil(rows).max(1);
        self.keys
            .chunks(columns)
            .map(|row| row.iter().enumerate().map(|(i, key)| (i * cell, key)).collect())
            .collect()
    }
}

impl Scale {
    fn draw(&self, picture: &mut Picture, [x, y]: [usize; 2], width: usize) {
        text::write(picture, [x, y], &self.title, ink());
        let bar = y + LINE;
        picture.fill([x, bar], [width, BAR], ink());
        let inner = width.saturating_sub(2);
        for column in 0..inner {
            let colour = self.palette.at(column as f32 / inner.max(2) as f32);
            picture.fill([x + 1 + column, bar + 1], [1, BAR - 2], colour);
        }
        // The ends are worth more than what lies between.
        let mut order: Vec<&Tick> = self.ticks.iter().collect();
        order.sort_by_key(|t| t.position > 0.0 && t.position < 1.0);
        let mut taken: Vec<[usize; 2]> = Vec::new();
        for tick in order {
            let wide = text::width(&tick.label);
            let at = (tick.position * width.saturating_sub(1) as f32) as usize;
            let start = at.saturating_sub(wide / 2).min(width.saturating_sub(wide));
            if taken.iter().any(|[a, b]| start < b + CELL && *a < start + wide + CELL) {
                continue;
            }
            taken.push([start, start + wide]);
            picture.fill([x + at, bar + BAR], [1, GAP / 2], ink());
            text::write(picture, [x + start, bar + BAR + GAP / 2 + 2], &tick.label, ink());
        }
    }
}

/// A number in about four digits.
pub(crate) fn digits(x: f64) -> String {
    let magnitude = x.abs();
    if x == 0.0 {
        return "0".into();
    }
    if !(1e-3..1e5).contains(&magnitude) {
        return format!("{x:.3e}");
    }
    let decimals = (3 - magnitude.log10().floor() as i32).clamp(0, 6) as usize;
    format!("{x:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        let cases = [(0.0, "0"), (2.34567, "2.346"), (-12345.6, "-12346"), (0.01234567, "0.01235")];
        for (x, text) in cases {
            assert_eq!(digits(x), text);
        }
        assert_eq!(digits(1.5e300), "1.500e300");
        assert_eq!(digits(f64::NAN), "NaN");
    }

    #[test]
    fn any_width_can_be_drawn_on() {
        let keys = ["one", "two", "a longer one"].map(|k| Key::new([9; 3], k)).to_vec();
        let ticks = [-1.0, 0.0, f32::NAN, 1.0, 7.0]
            .map(|position| Tick { position, label: "1e-300".into() })
            .to_vec();
        let scale = Scale { title: "title".into(), palette: Palette::dusk(), ticks };
        let legend = Legend { scale: Some(scale), keys };
        for width in [1, 2, 17, 100, 1000] {
            let mut picture = Picture::filled(width, legend.height(width), paper()).unwrap();
            legend.draw(&mut picture, [0, 0], width);
        }
    }
}
