//! Balls until every point is covered.

use rayon::prelude::*;
use zeroset_raycast::patches::weight;
use zeroset_raycast::{Error, Progress};

use super::{Ball, Options, Summary, fit};
use crate::neighbours::Neighbours;
use crate::points::Cloud;

/// Centres that are tried together. What a ball is does not depend on the others, so that only those are in
/// vain that an earlier one of the same batch covers.
const BATCH: usize = 64;

/// In a random order, a point that is not covered becomes the centre of a ball.
pub(super) fn balls(
    cloud: &Cloud,
    options: &Options,
    progress: &Progress,
) -> Result<Vec<Ball>, Error> {
    let near = Neighbours::new(&cloud.points);
    let error = options.error * cloud.diagonal();
    let order = shuffled(cloud.points.len(), options.seed);
    let mut is_covered = vec![false; cloud.points.len()];
    let mut balls = Vec::new();
    let mut next = 0;
    while next < order.len() {
        let mut centres = Vec::with_capacity(BATCH);
        while centres.len() < BATCH && next < order.len() {
            if !is_covered[order[next]] {
                centres.push(order[next]);
            }
            next += 1;
        }
        let fits: Vec<_> = centres
            .par_iter()
            .map(|&index| {
                progress.advance(0)?;
                Ok(fit::largest(cloud, &near, index, error, options.cover))
            })
            .collect::<Result<_, Error>>()?;
        for (index, fit) in centres.into_iter().zip(fits) {
            if is_covered[index] {
                continue;
            }
            let mut newly = 0;
            for i in fit.covered {
                newly += usize::from(!std::mem::replace(&mut is_covered[i], true));
            }
            progress.advance(newly)?;
            balls.push(fit.ball);
        }
    }
    Ok(balls)
}

/// The numbers below `count` in an order without pattern.
fn shuffled(count: usize, seed: u64) -> Vec<usize> {
    // SplitMix64.
    let scattered = |i: u64| {
        let mut z = i.wrapping_add(seed << 32).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    };
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by_cached_key(|&i| scattered(i as u64));
    order
}

/// The distances of the points from the mean of the quadrics by their weights, to first order.
pub(super) fn summary(balls: &[Ball], cloud: &Cloud) -> Summary {
    let near = Neighbours::new(&cloud.points);
    // For each point the sums of w f/|grad f| and of w, and the number of balls.
    let mut sums = vec![(0.0, 0.0, 0_u32); cloud.points.len()];
    for ball in balls {
        for i in near.within(ball.centre, ball.radius) {
            let x = cloud.points[i] - ball.centre;
            let w = weight(x.length() / ball.radius);
            let steepness = 2.0 * ball.quadric.half_gradient(x).length();
            if steepness > 0.0 {
                let sum = &mut sums[i];
                *sum = (sum.0 + w * ball.quadric.value(x) / steepness, sum.1 + w, sum.2 + 1);
            }
        }
    }
    let distances = || sums.iter().filter(|s| s.1 > 0.0).map(|s| (s.0 / s.1).abs());
    let count = sums.len().max(1) as f64;
    let diagonal = cloud.diagonal().max(f64::MIN_POSITIVE);
    Summary {
        rms: (distances().map(|d| d * d).sum::<f64>() / count).sqrt() / diagonal,
        worst: distances().fold(0.0, f64::max) / diagonal,
        overlap: sums.iter().map(|s| f64::from(s.2)).sum::<f64>() / count,
    }
}
