//! Depth in false colour.

use zeroset_raycast::{Hits, View};

use crate::legend::{Legend, Scale, Tick, digits};
use crate::palette::Palette;
use crate::picture::check_hits;
use crate::{Colour, Picture, ShadeError};

/// The distance t of each hit, near bright and far dark, over the range of the hits.
///
/// t is the middle of the bracket. Misses are nearly black; hits whose t is infinite or NaN are
/// grey.
///
/// # Errors
/// If the hits are not those of the view.
pub fn picture(view: &View, hits: &Hits) -> Result<Picture, ShadeError> {
    picture_within(view, hits, range(hits))
}

/// The least and the greatest finite t of the hits; `None` if there is none.
pub fn range(hits: &Hits) -> Option<[f64; 2]> {
    (0..hits.len()).filter_map(|i| depth(hits, i)).filter(|t| t.is_finite()).fold(
        None,
        |range, t| {
            let [near, far] = range.unwrap_or([t, t]);
            Some([near.min(t), far.max(t)])
        },
    )
}

/// Like [`picture`], over a given range of t, so that pictures compare; what lies outside is
/// clamped. Without a range, all hits are as bright as the nearest.
///
/// # Errors
/// If the hits are not those of the view.
pub fn picture_within(
    view: &View,
    hits: &Hits,
    range: Option<[f64; 2]>,
) -> Result<Picture, ShadeError> {
    check_hits(view, hits)?;
    let palette = Palette::haze();
    let background = Colour::oklch(0.14, 0.015, 270.0).bytes();
    let unknown = Colour::oklch(0.6, 0.0, 0.0).bytes();
    let (legend, description) = match range {
        Some(range) => (Some(legend(&palette, range)), describe(range)),
        None => (None, "t; there are no hits".into()),
    };
    Picture::painted(view, description, legend, |i| match depth(hits, i) {
        None => background,
        Some(t) if t.is_finite() => palette.at(range.map_or(0.0, |range| position(t, range))),
        Some(_) => unknown,
    })
}

/// The middle of a hit's bracket; `None` for a miss.
fn depth(hits: &Hits, pixel: usize) -> Option<f64> {
    hits.certificate[pixel].is_hit().then(|| hits.get(pixel).t())
}

fn legend(palette: &Palette, [near, far]: [f64; 2]) -> Legend {
    let ticks = [(0.0, near), (0.5, 0.5 * near + 0.5 * far), (1.0, far)]
        .map(|(position, t)| Tick { position, label: digits(t) })
        .to_vec();
    let scale = Scale { title: "t".into(), palette: palette.clone(), ticks };
    Legend { scale: Some(scale), keys: Vec::new() }
}

fn describe([near, far]: [f64; 2]) -> String {
    format!("t from {} to {}", digits(near), digits(far))
}

/// Where t lies in a range, 0 to 1; 0 if the range is a point.
fn position(t: f64, [near, far]: [f64; 2]) -> f32 {
    // Halves, since the difference of two finite numbers may be infinite.
    let length = 0.5 * far - 0.5 * near;
    if length > 0.0 { ((0.5 * t - 0.5 * near) / length) as f32 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_in_the_range() {
        assert_eq!(position(3.0, [3.0, 3.0]), 0.0);
        assert_eq!(position(2.0, [1.0, 3.0]), 0.5);
        assert_eq!(position(f64::MAX, [-f64::MAX, f64::MAX]), 1.0);
    }
}
