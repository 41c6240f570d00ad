//! The answers of a tile.

use zeroset_raycast::{Certificate, Hit, Work};

use super::clock::Clock;
use super::cut::{Bounds, Cut};
use super::march::{Judge, Marcher, Reason, Verdict};
use super::method::{Bisection, Finishing};
use super::settler::{Goal, Settled, Settler};
use crate::implicit::Implicit;

/// The answers of a tile, and the settler that makes them.
pub(super) struct Answers<'a> {
    settler: Settler<'a>,
    bounds: &'a Bounds,
    /// One a ray.
    pub hits: Vec<Hit>,
    /// One a ray, if there is a finish.
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
        let certify = method.finish == Finishing::Certify;
        Self {
            settler: Settler::new(method, implicit, goal),
            bounds,
            hits: vec![method.miss(); rays],
            settled: vec![Settled::default(); if certify { rays } else { 0 }],
        }
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
        let (hit, mut none) = (&mut self.hits[ray], Settled::default());
        let settled = self.settled.get_mut(ray).unwrap_or(&mut none);
        let piece = clock.range(piece);
        let next = self.settler.settle(hit, settled, line, range, piece, clock.whole, reason);
        if next.is_none() && dropped {
            hit.certificate = hit.certificate.without(Certificate::FIRST);
        }
        next.map_or(Verdict::Stop, |t| Verdict::Continue(clock.q(t)))
    }

    fn finished(&mut self, ray: usize, dropped: bool, work: Work) {
        let hit = &mut self.hits[ray];
        hit.work += work;
        if dropped && !hit.certificate.is_hit() {
            hit.certificate = Certificate::MISS;
        }
    }
}
