//! Certificates in false colour.

use zeroset_raycast::{Certificate, Hits, View};

use crate::legend::{Key, Legend};
use crate::picture::check_hits;
use crate::{Colour, Picture, ShadeError};

/// The colour of a certificate.
///
/// Blues: nothing before the answer is proven. Oranges: something may have been missed. Strong
/// colours hold a proven root, pale ones may hold none, and dark ones are misses. The axis from
/// blue to orange is one that colour-blind eyes see, and lightness tells the rest.
pub fn colour(certificate: Certificate) -> [u8; 3] {
    let [lightness, chroma, hue] = match certificate {
        Certificate::PROVEN_HIT => [0.58, 0.16, 250.0],
        Certificate::POSSIBLE_HIT => [0.84, 0.08, 225.0],
        Certificate::ROOT_HIT => [0.68, 0.18, 50.0],
        Certificate::HIT => [0.90, 0.11, 88.0],
        Certificate::PROVEN_MISS => [0.27, 0.05, 262.0],
        _ => [0.40, 0.065, 45.0],
    };
    Colour::oklch(lightness, chroma, hue).bytes()
}

/// What was proved of each ray, in the [`colour`] of its certificate.
///
/// # Errors
/// If the hits are not those of the view.
pub fn picture(view: &View, hits: &Hits) -> Result<Picture, ShadeError> {
    check_hits(view, hits)?;
    let colours = Certificate::ALL.map(|c| (c, colour(c)));
    let keys = colours.iter().map(|(c, colour)| Key::new(*colour, c.name())).collect();
    let counts: Vec<String> = Certificate::ALL
        .iter()
        .map(|c| (c, hits.certificate.iter().filter(|k| *k == c).count()))
        .filter(|(_, n)| *n > 0)
        .map(|(c, n)| format!("{n} {c}"))
        .collect();
    let description = format!("certificates: {}", counts.join(", "));
    Picture::painted(view, description, Some(Legend { scale: None, keys }), |i| {
        let certificate = hits.certificate[i];
        colours
            .iter()
            .find(|(c, _)| *c == certificate)
            .map_or_else(|| colour(certificate), |(_, colour)| *colour)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_certificates_differ_even_without_hue() {
        let mut greys: Vec<f32> = Certificate::ALL
            .iter()
            .map(|c| {
                Colour::from_bytes(colour(*c)).0.dot(glam::Vec3::new(0.2126, 0.7152, 0.0722)).cbrt()
            })
            .collect();
        greys.sort_by(f32::total_cmp);
        assert!(greys.windows(2).all(|w| w[1] - w[0] > 0.03), "{greys:?}");
    }
}
