//! How good a surface is.

use std::fmt;
use std::time::Duration;

use zeroset_raycast::patches::weight;

use super::Slim;
use crate::neighbours::Neighbours;
use crate::points::Cloud;

/// A surface measured against the points that it was built from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Summary {
    /// Points.
    pub points: usize,
    /// Balls; one at an edge counts twice, once for each side.
    pub balls: usize,
    /// Balls that were grown, those thrown away too.
    pub grown: usize,
    /// Balls that were kept although their error is too large: they cannot be smaller.
    pub failed: usize,
    /// Points that no ball holds.
    pub outside: usize,
    /// The root of the mean square, over the points that a ball holds, of the blended distance: the mean of
    /// Taubin's, f / |grad f|, by the balls' weights. In diagonals.
    pub rms: f64,
    /// The greatest, in diagonals.
    pub max: f64,
    /// The mean number of balls that hold a point.
    pub overlap: f64,
    /// The time it took to build.
    pub time: Duration,
}

impl Summary {
    /// Measures a surface; the counts of building are left at 0.
    pub fn of(slim: &Slim, cloud: &Cloud) -> Self {
        let tree = Neighbours::new(&cloud.points);
        let count = cloud.points.len();
        let mut sums = vec![[0.0f64; 2]; count];
        let (mut found, mut held) = (Vec::new(), 0usize);
        for ball in slim.balls() {
            tree.within(ball.centre, ball.radius, &mut found);
            for near in &found {
                let i = near.index as usize;
                let x = cloud.points[i] - ball.centre;
                if ball.contains(x) {
                    let w = weight(near.square.sqrt() / ball.radius);
                    let gradient = 2.0 * ball.quadric.half_gradient(x).length();
                    let distance = ball.quadric.value(x) / gradient;
                    sums[i][0] += w * distance;
                    sums[i][1] += w;
                    held += 1;
                }
            }
        }
        let diagonal = cloud.diagonal();
        let blended = sums.iter().filter(|s| s[1] > 0.0).map(|s| s[0] / s[1] / diagonal);
        let inside = sums.iter().filter(|s| s[1] > 0.0).count();
        let (square, max) =
            blended.fold((0.0, 0.0f64), |(sum, max), e| (sum + e * e, max.max(e.abs())));
        Self {
            points: count,
            balls: slim.balls().len(),
            outside: count - inside,
            rms: (square / inside.max(1) as f64).sqrt(),
            max,
            overlap: held as f64 / count as f64,
            ..Self::default()
        }
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { points, balls, failed, outside, rms, max, overlap, time, .. } = self;
        write!(f, "{points} points, {balls} balls ({failed} too coarse), rms {rms:.2e} L, ")?;
        write!(f, "max {max:.2e} L, overlap {overlap:.2}, ")?;
        if *outside > 0 {
            write!(f, "{outside} points outside, ")?;
        }
        write!(f, "{:.2} s", time.as_secs_f64())
    }
}
