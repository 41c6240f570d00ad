//! The answers of a tile.

use zeroset_raycast::{Certificate, Hit, Work};

use super::clock::Clock;
use super::cut::{Bounds, Cut};
use super::march::{Judge, Marcher, Reason, Verdict};
use super::settler::{Goal, Settled, Settler};
use crate::bisection::Bisection;
use crate::implicit::Implicit;

/// The answers of a tile, and the settler that makes them.
pub(super) struct Answers<'a> {
    settler: Settler<'a>,
    bounds: &'a Bounds,
    /// One a ray.
    pub hits: Vec<Hit>,
    settled: Vec<Settled>,
}

impl<'a> Answers<'a> {
    /// Every ray misses the domain, so far.
    pub(super) fn new(
        method: &'a Bisection,
        implicit: &'a Implicit,
        bounds: &'a Bounds,
        goal: &'a Goal,
        rays: usize,
    ) -> Self {
        let settler = Settler::new(method, implicit, goal);
        let hits = vec![method.miss(); rays];
        Self { settler, bounds, hits, settled: vec![Settled::default(); rays] }
    }
}

impl Judge for Answers<'_> {
    fn reached(
        &mut self,
        cut: Cut,
        marcher: &Marcher,
        piece: [f64; 2],
        reason: Reason,
        dropped: bool,
    ) -> Verdict {
        let Marcher { ray, line, range, .. } = *marcher;
        let clock = Clock::new(marcher, cut, self.bounds);
        let (hit, settled) = (&mut self.hits[ray], &mut self.settled[ray]);
        let piece = clock.range(piece);
        let next = self.settler.settle(hit, settled, line, range, piece, clock.whole, reason);
        if next.is_none() && dropped {
            hit.certificate = hit.certificate.without(Certificate::FIRST);
        }
        next.map_or(Verdict::Stop, |t| Verdict::Continue(clock.q(t)))
    }

    fn finished(&mut self, marcher: &Marcher, dropped: bool, work: Work) {
        let hit = &mut self.hits[marcher.ray];
        hit.work += work;
        if dropped && !hit.certificate.is_hit() {
            hit.certificate = Certificate::MISS;
        }
    }
}
