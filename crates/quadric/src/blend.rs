//! Hits of one ray, become one: \[stoll2006\] Section 5.1.1.

use glam::DVec3;
use zeroset_raycast::patches::weight;

use crate::piece::Crossing;

/// A root of a ball's quadric, with what blending needs of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fragment {
    pub(crate) crossing: Crossing,
    /// How much further along t the same sheet may lie.
    pub(crate) reach: f64,
}

/// The first sheet: its mean t by the weights, and its mean unit normal, of any length. None if nothing has a
/// weight.
///
/// In the paper a pass over all quadrics leaves the least depth, moved away by an offset, in the depth buffer,
/// and a second one adds up what lies before it.
pub(crate) fn sheet(fragments: &[Fragment]) -> Option<Crossing> {
    let ends = fragments.iter().map(|f| f.crossing.t + f.reach);
    let end = ends.fold(f64::INFINITY, f64::min);
    let (mut total, mut t, mut normal) = (0.0, 0.0, DVec3::ZERO);
    // About the first one: means of far places lose nothing.
    let first = fragments.iter().map(|f| f.crossing.t).fold(f64::INFINITY, f64::min);
    for Fragment { crossing, .. } in fragments.iter().filter(|f| f.crossing.t <= end) {
        let w = weight(crossing.distance);
        total += w;
        t += w * (crossing.t - first);
        normal += w * crossing.gradient.normalize_or_zero();
    }
    (total > 0.0).then(|| Crossing { t: first + t / total, gradient: normal, distance: 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fragment(t: f64, distance: f64, reach: f64) -> Fragment {
        Fragment { crossing: Crossing { t, gradient: 3.0 * DVec3::X, distance }, reach }
    }

    #[test]
    fn means_are_weighted() {
        let one = sheet(&[fragment(1e9, 0.3, 0.5)]).unwrap();
        assert_eq!((one.t, one.gradient.normalize()), (1e9, DVec3::X));
        let two = sheet(&[fragment(10.0, 0.0, 0.5), fragment(10.2, 0.5, 0.5)]).unwrap();
        let w = (-1.0_f64).exp();
        assert!((two.t - (10.0 + 0.2 * w / (1.0 + w))).abs() < 1e-12);
    }

    #[test]
    fn later_sheets_do_not_count() {
        let near = fragment(10.0, 0.2, 0.5);
        for others in [vec![fragment(10.51, 0.0, 9.0)], vec![fragment(20.0, 0.0, 0.1)]] {
            let all: Vec<_> = others.into_iter().chain([near]).collect();
            assert_eq!(sheet(&all).unwrap().t, 10.0);
        }
        // The ball with the least reach says where the sheet ends.
        let all = [fragment(10.0, 0.2, 5.0), fragment(10.1, 0.2, 0.1), fragment(10.3, 0.2, 1.0)];
        assert!((sheet(&all).unwrap().t - 10.05).abs() < 1e-12);
        assert!(sheet(&[]).is_none() && sheet(&[fragment(1.0, 1.0, 1.0)]).is_none());
    }
}
