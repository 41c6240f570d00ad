//! Work in false colour.

use zeroset_raycast::{Hits, View, Work};

use crate::legend::{Legend, Scale, Tick};
use crate::palette::Palette;
use crate::picture::check_hits;
use crate::{Picture, ShadeError};

/// Decades that the colours span: 1 to 10^4 evaluations.
const DECADES: usize = 4;

/// Evaluations of all kinds: points, gradients and intervals.
pub fn evaluations(work: &Work) -> u64 {
    work.points.saturating_add(work.gradients).saturating_add(work.intervals)
}

/// The evaluations for each ray, hit or miss, on a logarithmic scale from 1 (dark) to 10^4 (light).
///
/// The scale is fixed, so that pictures of different methods compare; what lies outside is clamped.
///
/// # Errors
/// If the hits are not those of the view.
pub fn picture(view: &View, hits: &Hits) -> Result<Picture, ShadeError> {
    check_hits(view, hits)?;
    let palette = Palette::dusk();
    let ticks = (0..=DECADES)
        .map(|d| Tick {
            position: d as f32 / DECADES as f32,
            label: 10_u64.pow(d as u32).to_string(),
        })
        .collect();
    let scale = Scale { title: "evaluations a ray".into(), palette: palette.clone(), ticks };
    let legend = Legend { scale: Some(scale), keys: Vec::new() };
    let most = hits.work.iter().map(evaluations).max().unwrap_or(0);
    let description = format!("evaluations a ray, from 1 to 10000 in decades; the most is {most}");
    Picture::painted(view, description, Some(legend), |i| {
        let count = evaluations(&hits.work[i]).max(1) as f64;
        palette.at((count.log10() / DECADES as f64) as f32)
    })
}
