//! Colours.

use glam::Vec3;

/// A colour in linear light with the primaries of sRGB; 1 is the display's white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colour(pub Vec3);

impl Colour {
    /// The colour of a lightness in 0..1, a chroma of 0 to about 0.3 and a hue in degrees.
    ///
    /// The space is Oklch, polar Oklab (B. Ottosson, "A perceptual color space for image
    /// processing", 2020): equal steps look about equal. Where a display cannot show the chroma,
    /// the greatest that it can is taken.
    pub fn oklch(lightness: f32, chroma: f32, hue: f32) -> Self {
        let at = |chroma: f32| {
            let (sin, cos) = hue.to_radians().sin_cos();
            from_oklab(lightness, chroma * cos, chroma * sin)
        };
        let shown = |c: Vec3| c.min_element() >= -1e-4 && c.max_element() <= 1.0 + 1e-4;
        if shown(at(chroma)) {
            return Self(at(chroma));
        }
        let (mut low, mut high) = (0.0, chroma);
        for _ in 0..12 {
            let middle = 0.5 * (low + high);
            if shown(at(middle)) { low = middle } else { high = middle }
        }
        Self(at(low))
    }

    /// The colour of three bytes encoded as sRGB.
    pub fn from_bytes(bytes: [u8; 3]) -> Self {
        Self(Vec3::from(bytes.map(|b| decode(f32::from(b) / 255.0))))
    }

    /// Three bytes encoded as sRGB, clamped; NaN becomes 0.
    pub fn bytes(self) -> [u8; 3] {
        self.0.to_array().map(|x| byte(encode(x)))
    }
}

/// 0..1 to 0..255, rounded and clamped; NaN becomes 0.
pub(crate) fn byte(x: f32) -> u8 {
    (255.0 * x + 0.5) as u8
}

fn from_oklab(lightness: f32, a: f32, b: f32) -> Vec3 {
    let cube = |x: f32| x * x * x;
    let l = cube(lightness + 0.396_337_78 * a + 0.215_803_76 * b);
    let m = cube(lightness - 0.105_561_346 * a - 0.063_854_17 * b);
    let s = cube(lightness - 0.089_484_18 * a - 1.291_485_5 * b);
    Vec3::new(
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_38 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    )
}

/// Linear light to sRGB's encoding (IEC 61966-2-1).
fn encode(x: f32) -> f32 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// sRGB's encoding to linear light (IEC 61966-2-1).
fn decode(x: f32) -> f32 {
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_decoding_and_encoding() {
        for b in 0..=255 {
            assert_eq!(Colour::from_bytes([b; 3]).bytes(), [b; 3]);
        }
    }

    #[test]
    fn the_encoding_is_that_of_srgb() {
        // Half of the light is encoded as 188, not as 128.
        assert_eq!(Colour(Vec3::splat(0.5)).bytes(), [188; 3]);
        assert_eq!(Colour(Vec3::ONE).bytes(), [255; 3]);
    }

    #[test]
    fn what_is_no_colour_is_clamped() {
        let odd = Vec3::new(f32::NAN, f32::INFINITY, f32::NEG_INFINITY);
        assert_eq!(Colour(odd).bytes(), [0, 255, 0]);
    }

    #[test]
    fn oklch_without_chroma_is_grey_and_too_much_is_reduced() {
        assert_eq!(Colour::oklch(1.0, 0.0, 0.0).bytes(), [255; 3]);
        assert_eq!(Colour::oklch(0.0, 0.0, 0.0).bytes(), [0; 3]);
        // The lightness, chroma and hue of sRGB's red.
        assert_eq!(Colour::oklch(0.627_955, 0.257_683, 29.233_9).bytes(), [255, 0, 0]);
        let reduced = Colour::oklch(0.9, 0.5, 265.0).0;
        assert!(reduced.min_element() >= -1e-3 && reduced.max_element() <= 1.001, "{reduced}");
    }
}
