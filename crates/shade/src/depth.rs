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
    check_hits(view, hits)?;
    let palette = Palette::haze();
    let background = Colour::oklch(0.14, 0.015, 270.0).bytes();
    let unknown = Colour::oklch(0.6, 0.0, 0.0).bytes();
    let depth = |i: usize| hits.certificate[i].is_hit().then(|| hits.get(i).t());

    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for t in (0..hits.len()).filter_map(depth).filter(|t| t.is_finite()) {
        range = [range[0].min(t), range[1].max(t)];
    }
    let (legend, description) = if range[0] <= range[1] {
        let ticks = [0.0, 0.5, 1.0].map(|x| Tick {
            position: x,
            label: digits(range[0] + (range[1] - range[0]) * f64::from(x)),
        });
        let scale = Scale { title: "t".into(), palette: palette.clone(), ticks: ticks.to_vec() };
        let words = format!("t from {} to {}", digits(range[0]), digits(range[1]));
        (Some(Legend { scale: Some(scale), keys: Vec::new() }), words)
    } else {
        (None, "t; there are no hits".into())
    };
    Picture::painted(view, description, legend, |i| match depth(i) {
        None => background,
        Some(t) if t.is_finite() => palette.at(position(t, range)),
        Some(_) => unknown,
    })
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
