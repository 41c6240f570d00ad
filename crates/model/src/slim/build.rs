//! Covering points with balls.

use std::time::Instant;

use rayon::prelude::*;
use zeroset_raycast::Progress;

use super::grow::{Grown, grown};
use super::patch::Surface;
use super::samples::Samples;
use super::shuffle::shuffled;
use super::{Ball, Error, Slim, Summary};
use crate::points::Cloud;

/// How a surface is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The most that a ball's quadric may miss its points by, as the root of the weighted mean of squares, in
    /// diagonals of the points' box. \[stoll2006\] has 1e-4.
    pub error: f64,
    /// The part of a ball's radius in which points are covered, above 0 and up to 1. With 1 there are fewest
    /// balls, and gaps between them.
    pub cover: f64,
    /// What becomes of sharp edges.
    pub edges: Edges,
    /// What the order of the balls depends on.
    pub seed: u64,
}

/// What becomes of sharp edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    /// They are rounded: a ball has one quadric.
    Ignore,
    /// Where one quadric will not do and normals fall in two clusters, a ball has two, each cut by a plane
    /// through the edge (\[stoll2006\] Fig. 8).
    Clip,
}

impl Default for Options {
    fn default() -> Self {
        Self { error: 1e-4, cover: 0.82, edges: Edges::Ignore, seed: 0 }
    }
}

/// The fewest and the most balls that are grown at once.
const BATCH: [usize; 2] = [8, 2048];

/// A surface within `options.error` of the points: points in random order, each that is not covered yet
/// becomes the centre of a ball that grows while its quadric is good. Progress counts covered points.
///
/// Balls are grown in parallel ahead of the order, and those whose centre was covered meanwhile are thrown
/// away, so that the surface does not depend on the number of threads.
///
/// # Errors
/// If an option has no meaning, the points are fewer than two, not finite or all at one place, or the caller
/// asks to stop.
pub fn build(
    cloud: &Cloud,
    options: &Options,
    progress: &Progress,
) -> Result<(Slim, Summary), Error> {
    let start = Instant::now();
    options.check()?;
    check(cloud)?;
    let samples = Samples::new(cloud);
    let cover = cover(&samples, options, progress)?;
    let mut balls = Vec::with_capacity(cover.balls.len());
    for ball in &cover.balls {
        balls.extend(in_space(ball, cloud, samples.unit));
    }
    let slim = Slim::new(balls, Slim::OFFSET)?;
    let mut summary = Summary::of(&slim, cloud);
    summary.grown = cover.grown;
    summary.failed = cover.balls.iter().filter(|ball| ball.failed).count();
    summary.time = start.elapsed();
    Ok((slim, summary))
}

impl Options {
    fn check(&self) -> Result<(), Error> {
        let Self { error, cover, .. } = *self;
        if !(error > 0.0 && error < 1.0) {
            let what = format!("the error {error} is not between 0 and 1 diagonals; 1e-4 is usual");
            return Err(Error::Options(what));
        }
        if !(cover > 0.0 && cover <= 1.0) {
            let what = format!("the cover {cover} is not between 0 and 1 radii; 0.82 is usual");
            return Err(Error::Options(what));
        }
        Ok(())
    }
}

/// Clouds that are read pass; one put together by hand may not.
fn check(cloud: &Cloud) -> Result<(), Error> {
    let refused = |what: String| Err(Error::Cloud(what));
    let [points, normals] = [&cloud.points, &cloud.normals];
    if points.len() != normals.len() || points.len() < 2 {
        let [points, normals] = [points.len(), normals.len()];
        return refused(format!(
            "{points} points with {normals} normals make no surface; it takes two, each with a normal"
        ));
    }
    if points.len() > u32::MAX as usize {
        return refused(format!("{} points are more than 2^32; thin them out", points.len()));
    }
    for (i, (p, n)) in points.iter().zip(normals).enumerate() {
        if !(p.is_finite() && (n.length_squared() - 1.0).abs() < 1e-6) {
            return refused(format!(
                "point {i}, {p}, is not finite or its normal {n} is not 1 long"
            ));
        }
    }
    let diagonal = cloud.diagonal();
    if !(1e-60..=1e60).contains(&diagonal) {
        return refused(format!("the box of the points has the diagonal {diagonal:e}; scale them"));
    }
    Ok(())
}

/// Balls that cover all points.
struct Cover {
    balls: Vec<Grown>,
    /// Balls grown, those thrown away too.
    grown: usize,
}

fn cover(samples: &Samples, options: &Options, progress: &Progress) -> Result<Cover, Error> {
    let stopped = |_| Error::Interrupted;
    let order = shuffled(samples.points.len(), options.seed);
    let mut covered = vec![false; order.len()];
    let mut rest = order.iter().copied();
    let mut found = Vec::new();
    let mut cover = Cover { balls: Vec::new(), grown: 0 };
    let mut size = BATCH[0];
    loop {
        let batch: Vec<u32> = rest.by_ref().filter(|&i| !covered[i as usize]).take(size).collect();
        if batch.is_empty() {
            return Ok(cover);
        }
        let grow = |&centre: &u32| {
            progress.advance(0).map_err(stopped)?;
            Ok(grown(samples, centre, options.error, options.edges))
        };
        let candidates = batch.par_iter().map(grow).collect::<Result<Vec<_>, Error>>()?;
        cover.grown += candidates.len();
        let before = cover.balls.len();
        for (&centre, ball) in batch.iter().zip(candidates) {
            let Some(ball) = ball else {
                // Without a surface there is nothing to cover with: the neighbours' balls may do.
                continue;
            };
            if covered[centre as usize] {
                continue;
            }
            let radius = options.cover * ball.radius;
            samples.tree.within(samples.points[centre as usize], radius, &mut found);
            let mut fresh = 0;
            for near in &found {
                fresh += usize::from(!std::mem::replace(&mut covered[near.index as usize], true));
            }
            progress.advance(fresh).map_err(stopped)?;
            cover.balls.push(ball);
        }
        // Large balls make most of a batch waste, so that its size follows what is kept.
        let kept = cover.balls.len() - before;
        size = match () {
            () if 4 * kept > 3 * batch.len() => 2 * size,
            () if 2 * kept < batch.len() => size / 2,
            () => size,
        };
        size = size.clamp(BATCH[0], BATCH[1]);
    }
}

/// The ball, or the two halves of a ball at an edge, in the units of the cloud.
fn in_space(grown: &Grown, cloud: &Cloud, unit: f64) -> impl Iterator<Item = Ball> {
    let centre = cloud.points[grown.centre as usize];
    let radius = unit * grown.radius;
    let parts = match grown.surface {
        Surface::Whole(surface) => [Some((surface, None)), None],
        Surface::Edge(crease) => {
            crease.clipped(radius).map(|(side, clip)| Some((side, Some(clip))))
        }
    };
    let ball = move |(surface, clip): (super::quadratic::Quadratic, _)| Ball {
        centre,
        radius,
        quadric: surface.quadric(radius),
        clip,
    };
    parts.into_iter().flatten().map(ball)
}
