//! Palettes: numbers in 0..1 to colours.

use crate::Colour;

/// Entries of a palette: one more and bytes would repeat.
const ENTRIES: usize = 256;

/// A sequence of colours, even to the eye.
#[derive(Clone, Debug, PartialEq)]
pub struct Palette {
    entries: Vec<[u8; 3]>,
}

impl Palette {
    /// A path through lightness, chroma and hue in degrees (see [`Colour::oklch`]): straight
    /// between evenly spaced anchors.
    ///
    /// # Panics
    /// If there are fewer than two anchors.
    pub fn through(anchors: &[[f32; 3]]) -> Self {
        assert!(anchors.len() >= 2, "a palette has two ends");
        let entries = (0..ENTRIES)
            .map(|i| {
                let x = i as f32 / (ENTRIES - 1) as f32 * (anchors.len() - 1) as f32;
                let first = (x as usize).min(anchors.len() - 2);
                let [[l0, c0, h0], [l1, c1, h1]] = [anchors[first], anchors[first + 1]];
                let mix = |a: f32, b: f32| a + (b - a) * (x - first as f32);
                Colour::oklch(mix(l0, l1), mix(c0, c1), mix(h0, h1)).bytes()
            })
            .collect();
        Self { entries }
    }

    /// Violet over blue, teal and green to yellow, dark to light: for counts.
    pub fn dusk() -> Self {
        Self::through(&[
            [0.22, 0.09, 305.0],
            [0.40, 0.13, 280.0],
            [0.56, 0.11, 220.0],
            [0.73, 0.15, 160.0],
            [0.92, 0.18, 105.0],
        ])
    }

    /// Cream over rose to deep blue, light to dark: for depth, near to far.
    pub fn haze() -> Self {
        Self::through(&[
            [0.96, 0.05, 95.0],
            [0.80, 0.11, 55.0],
            [0.62, 0.12, 5.0],
            [0.45, 0.12, -50.0],
            [0.30, 0.09, -85.0],
        ])
    }

    /// Near white to deep blue: for errors of correct answers, beside which loud colours stand out.
    pub fn ice() -> Self {
        Self::through(&[
            [0.965, 0.012, 210.0],
            [0.82, 0.06, 225.0],
            [0.64, 0.10, 240.0],
            [0.46, 0.12, 257.0],
            [0.30, 0.10, 270.0],
        ])
    }

    /// The colour at `x`, clamped to 0..1; NaN is 0.
    pub fn at(&self, x: f32) -> [u8; 3] {
        // The conversion saturates, and takes NaN to 0.
        let entry = (x * (ENTRIES - 1) as f32 + 0.5) as usize;
        self.entries[entry.min(ENTRIES - 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The square root of the light that the eye weighs.
    fn lightness(bytes: [u8; 3]) -> f32 {
        Colour::from_bytes(bytes).0.dot(glam::Vec3::new(0.2126, 0.7152, 0.0722)).cbrt()
    }

    #[test]
    fn lightness_is_monotone_and_even() {
        for (palette, sign) in
            [(Palette::dusk(), 1.0), (Palette::haze(), -1.0), (Palette::ice(), -1.0)]
        {
            let at = |i: usize| sign * lightness(palette.at(i as f32 / 16.0));
            let steps: Vec<f32> = (0..16).map(|i| at(i + 1) - at(i)).collect();
            let mean = steps.iter().sum::<f32>() / 16.0;
            for step in &steps {
                assert!(*step > 0.5 * mean && *step < 1.6 * mean, "{steps:?}");
            }
        }
    }

    #[test]
    fn any_number_has_a_colour() {
        let palette = Palette::dusk();
        assert_eq!(palette.at(f32::NAN), palette.at(0.0));
        assert_eq!(palette.at(f32::NEG_INFINITY), palette.at(0.0));
        assert_eq!(palette.at(f32::INFINITY), palette.at(1.0));
        assert_ne!(palette.at(0.0), palette.at(1.0));
    }
}
