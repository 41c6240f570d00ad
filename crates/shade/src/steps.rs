//! Work in false colour.

use zeroset_raycast::{Hits, View, Work};

use crate::legend::{Legend, Scale, Tick};
use crate::palette::Palette;
use crate::picture::check_hits;
use crate::{Picture, ShadeError};

/// Evaluations of all kinds: points, gradients and intervals.
pub fn evaluations(work: &Work) -> u64 {
    work.points.saturating_add(work.gradients).saturating_add(work.intervals)
}

/// The least and the greatest number of evaluations for a ray; zeros if there are no rays.
pub fn range(hits: &Hits) -> [u64; 2] {
    let counts = || hits.work.iter().map(evaluations);
    [counts().min().unwrap_or(0), counts().max().unwrap_or(0)]
}

/// The evaluations for each ray, hit or miss, on a logarithmic scale over their range: few are
/// dark, many light.
///
/// # Errors
/// If the hits are not those of the view.
pub fn picture(view: &View, hits: &Hits) -> Result<Picture, ShadeError> {
    picture_within(view, hits, range(hits))
}

/// Like [`picture`], on a logarithmic scale from `least` to `most`, so that pictures compare; what
/// lies outside is clamped. 0 is taken as 1, and a range that is no range as a decade.
///
/// # Errors
/// If the hits are not those of the view.
pub fn picture_within(
    view: &View,
    hits: &Hits,
    [least, most]: [u64; 2],
) -> Result<Picture, ShadeError> {
    check_hits(view, hits)?;
    let least = least.max(1);
    let most = if most > least { most } else { least.saturating_mul(10) };
    let logarithm = |count: u64| (count.max(1) as f64).log10();
    let (low, high) = (logarithm(least), logarithm(most));
    let position = |count: u64| ((logarithm(count) - low) / (high - low)) as f32;

    let palette = Palette::dusk();
    let decades = (0..20).map(|d| 10_u64.pow(d)).filter(|n| (least..most).contains(n));
    let ticks = [least, most]
        .into_iter()
        .chain(decades)
        .map(|n| Tick { position: position(n), label: n.to_string() })
        .collect();
    let scale = Scale { title: "evaluations a ray".into(), palette: palette.clone(), ticks };
    let legend = Legend { scale: Some(scale), keys: Vec::new() };
    let [fewest, greatest] = range(hits);
    let description = format!(
        "evaluations a ray: {fewest} to {greatest}; colours from {least} to {most}, logarithmic"
    );
    Picture::painted(view, description, Some(legend), |i| {
        palette.at(position(evaluations(&hits.work[i])))
    })
}
