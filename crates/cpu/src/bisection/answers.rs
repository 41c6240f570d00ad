//! The answers of a tile.

use zeroset_ia::Rounding;
use zeroset_raycast::{Certificate, Domain, Hit, Work};

use super::clock::Clock;
use super::cut::{Bounds, Cut};
use super::finish::{self, Finding, Finish};
use super::march::{Judge, Marcher, Reason, Verdict};
use super::method::{Bisection, Finishing, Stop};
use super::prepared::Goal;
use crate::implicit::Implicit;

/// The answers of a tile, and the finish that makes them.
pub(super) struct Answers<'a> {
    method: &'a Bisection,
    bounds: &'a Bounds,
    domain: &'a Domain,
    goal: &'a Goal,
    /// One a ray.
    pub hits: Vec<Hit>,
    /// One a ray, if there is a finish.
    settled: Vec<Settled>,
    finish: Option<Finish<'a>>,
}

/// What the finish has done for a ray.
#[derive(Clone, Copy, Debug)]
struct Settled {
    /// From the first piece that was settled to this t, there is no root.
    empty_until: f64,
    /// How many pieces were settled.
    times: i32,
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
        let nothing = Settled { empty_until: f64::NEG_INFINITY, times: 0 };
        let miss = Hit::miss(proof(method, Certificate::PROVEN_MISS), Work::default());
        Self {
            method,
            bounds,
            domain: &implicit.domain,
            goal,
            hits: vec![miss; rays],
            settled: vec![nothing; if certify { rays } else { 0 }],
            finish: certify.then(|| Finish::new(&implicit.tape)),
        }
    }

    /// What the certifying finish finds from the start of a piece on.
    fn settle(
        &mut self,
        marcher: &Marcher,
        [lo, hi]: [f64; 2],
        whole: f64,
        reason: Reason,
    ) -> Option<Finding> {
        let finish = self.finish.as_mut()?;
        let Marcher { ray, line, .. } = *marcher;
        // A function whose enclosures tell nothing would have every piece settled.
        if self.hits[ray].work.gradients >= finish::RAY_BUDGET && reason == Reason::Small {
            return None;
        }
        let width = match self.goal.stop {
            Stop::Width(width) => width,
            Stop::Depth(depth) => whole * 2.0_f64.powi(-(depth as i32)),
        };
        // At least a few units in the last place of t.
        let width = width.max(8.0 * f64::EPSILON * hi.abs());
        let clip =
            self.domain.clip(line, self.goal.range).expect("a marching ray meets the domain");
        let settled = &mut self.settled[ray];
        let work = &mut self.hits[ray].work;
        let mut start = lo.max(settled.empty_until);
        loop {
            settled.times += 1;
            let finding = finish.settle(line, clip, start, hi - lo, settled.times - 1, width, work);
            match finding {
                // The march does not come back to the rest of the piece.
                Finding::EmptyUntil(t) if t < hi => {
                    if work.gradients >= finish::RAY_BUDGET {
                        return Some(Finding::Unknown([t, hi]));
                    }
                    start = t;
                }
                _ => return Some(finding),
            }
        }
    }

    /// What is told of a piece as it is.
    fn accept(&self, marcher: &Marcher, piece: [f64; 2], reason: Reason) -> Finding {
        let Marcher { line, range, .. } = *marcher;
        let [lo, hi] = [piece[0].max(range[0]), piece[1].min(range[1])];
        let bracket = [lo.min(hi), hi];
        match reason {
            Reason::Small => Finding::Unknown(bracket),
            Reason::Crossing => Finding::Unproven(bracket),
            Reason::Root => {
                let clip = self.domain.clip(line, self.goal.range);
                match clip.and_then(|clip| clip.inner) {
                    Some([from, to]) if from <= piece[0] && piece[1] <= to => Finding::Root(piece),
                    _ => Finding::Unknown(bracket),
                }
            }
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
        let ray = marcher.ray;
        let clock = Clock::new(marcher, cut, self.bounds);
        let piece = clock.range(piece);
        let finding = self.settle(marcher, piece, clock.whole, reason);
        let finding = finding.unwrap_or_else(|| self.accept(marcher, piece, reason));
        let (bracket, certificate) = match finding {
            Finding::EmptyUntil(t) => {
                self.settled[ray].empty_until = t;
                return Verdict::Continue(clock.q(t));
            }
            Finding::Root(bracket) => (bracket, Certificate::PROVEN_HIT),
            Finding::Unknown(bracket) => (bracket, Certificate::POSSIBLE_HIT),
            Finding::Unproven(bracket) => (bracket, Certificate::HIT),
        };
        let hit = &mut self.hits[ray];
        hit.bracket = bracket;
        let certificate = if dropped { without_first(certificate) } else { certificate };
        hit.certificate = proof(self.method, certificate);
        Verdict::Stop
    }

    fn finished(&mut self, marcher: &Marcher, dropped: bool, work: Work) {
        let hit = &mut self.hits[marcher.ray];
        hit.work += work;
        if dropped && !hit.certificate.is_hit() {
            hit.certificate = Certificate::MISS;
        }
    }
}

/// The certificate, or what is left of it when rounding proves nothing.
fn proof(method: &Bisection, certificate: Certificate) -> Certificate {
    match (method.rounding, certificate) {
        (Rounding::Nearest, Certificate::PROVEN_MISS) => Certificate::MISS,
        (Rounding::Nearest, Certificate::POSSIBLE_HIT) => Certificate::HIT,
        (Rounding::Nearest, Certificate::PROVEN_HIT) => Certificate::ROOT_HIT,
        _ => certificate,
    }
}

/// The certificate without its FIRST bit.
fn without_first(certificate: Certificate) -> Certificate {
    match certificate {
        Certificate::PROVEN_HIT => Certificate::ROOT_HIT,
        Certificate::POSSIBLE_HIT => Certificate::HIT,
        other => other,
    }
}
