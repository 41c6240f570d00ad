//! From pieces that may hold a root to answers.

use zeroset_ia::Rounding;
use zeroset_raycast::{Certificate, Domain, Hit, Ray, Request, Work};

use super::finish::{self, Finding, Finish};
use super::march::{MAX_DEPTH, Reason};
use super::method::{Bisection, Finishing, Stop};
use crate::implicit::Implicit;

/// What is asked of all rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// The range of t in which roots count.
    pub range: [f64; 2],
    /// d_stop or epsilon, coarser for shadow rays.
    pub stop: Stop,
}

impl Goal {
    /// What a request asks of a method.
    pub fn new(method: &Bisection, request: Request, range: [f64; 2]) -> Self {
        let coarser = if request == Request::Any { method.shadow } else { 0 };
        let stop = match method.stop {
            Stop::Depth(depth) => Stop::Depth(depth.saturating_sub(coarser)),
            Stop::Width(width) => Stop::Width(width * 2.0_f64.powi(coarser as i32)),
        };
        Self { range, stop }
    }

    /// How often a whole is bisected, `unit` long for 1 in t: to the stop, and for the certifying finish
    /// some levels further.
    #[inline(always)]
    pub fn depth(&self, method: &Bisection, whole: f64, unit: f64) -> u32 {
        let stop = match self.stop {
            Stop::Depth(depth) => depth,
            Stop::Width(width) => bisections(whole, width * unit),
        };
        let levels = match method.finish {
            Finishing::Accept => 0,
            Finishing::Certify => method.levels,
        };
        stop.saturating_add(levels)
    }
}

/// How often a length is halved until it is at most `width`.
#[inline(always)]
pub(super) fn bisections(length: f64, width: f64) -> u32 {
    (length / width).log2().ceil().clamp(0.0, f64::from(MAX_DEPTH)) as u32
}

impl Bisection {
    /// The certificate, or what is left of it when rounding proves nothing.
    pub fn proof(&self, certificate: Certificate) -> Certificate {
        match (self.rounding, certificate) {
            (Rounding::Nearest, Certificate::PROVEN_MISS) => Certificate::MISS,
            (Rounding::Nearest, Certificate::POSSIBLE_HIT) => Certificate::HIT,
            (Rounding::Nearest, Certificate::PROVEN_HIT) => Certificate::ROOT_HIT,
            _ => certificate,
        }
    }

    /// The answer for a ray of which every piece was excluded.
    pub fn miss(&self) -> Hit {
        Hit::miss(self.proof(Certificate::PROVEN_MISS), Work::default())
    }
}

/// What has been settled of a ray.
#[derive(Clone, Copy, Debug)]
pub struct Settled {
    /// From the first piece that was settled to this t, there is no root.
    empty_until: f64,
    /// How many pieces were settled.
    times: i32,
}

impl Default for Settled {
    fn default() -> Self {
        Self { empty_until: f64::NEG_INFINITY, times: 0 }
    }
}

/// Settles the pieces in which a traversal cannot exclude a root, in order along each ray: by the
/// certifying finish if the method has it, else as they are.
pub struct Settler<'a> {
    method: &'a Bisection,
    domain: &'a Domain,
    goal: &'a Goal,
    finish: Option<Finish<'a>>,
}

impl<'a> Settler<'a> {
    /// For the rays of a request.
    pub fn new(method: &'a Bisection, implicit: &'a Implicit, goal: &'a Goal) -> Self {
        let finish = (method.finish == Finishing::Certify).then(|| Finish::new(&implicit.tape));
        Self { method, domain: &implicit.domain, goal, finish }
    }

    /// Settles a piece of a ray whose range `range` contains all that counts; `whole` is the length of
    /// which pieces are fractions. Gives where the ray goes on, or puts the answer in `hit`.
    pub fn settle(
        &mut self,
        hit: &mut Hit,
        settled: &mut Settled,
        ray: Ray,
        range: [f64; 2],
        piece: [f64; 2],
        whole: f64,
        reason: Reason,
    ) -> Option<f64> {
        let finding = self
            .finished(hit, settled, ray, piece, whole, reason)
            .unwrap_or_else(|| self.accepted(ray, range, piece, reason));
        let (bracket, certificate) = match finding {
            Finding::EmptyUntil(t) => {
                settled.empty_until = t;
                return Some(t);
            }
            Finding::Root(bracket) => (bracket, Certificate::PROVEN_HIT),
            Finding::Unknown(bracket) => (bracket, Certificate::POSSIBLE_HIT),
            Finding::Unproven(bracket) => (bracket, Certificate::HIT),
        };
        hit.bracket = bracket;
        hit.certificate = self.method.proof(certificate);
        None
    }

    /// What the certifying finish finds from the start of a piece on.
    fn finished(
        &mut self,
        hit: &mut Hit,
        settled: &mut Settled,
        ray: Ray,
        [lo, hi]: [f64; 2],
        whole: f64,
        reason: Reason,
    ) -> Option<Finding> {
        let finish = self.finish.as_mut()?;
        let work = &mut hit.work;
        // A function whose enclosures tell nothing would have every piece settled.
        if work.gradients >= finish::RAY_BUDGET && reason == Reason::Small {
            return None;
        }
        let width = match self.goal.stop {
            Stop::Width(width) => width,
            Stop::Depth(depth) => whole * 2.0_f64.powi(-(depth as i32)),
        };
        // At least a few units in the last place of t.
        let width = width.max(8.0 * f64::EPSILON * hi.abs());
        let clip = self.domain.clip(ray, self.goal.range).expect("the ray meets the domain");
        let mut start = lo.max(settled.empty_until);
        loop {
            settled.times += 1;
            let finding = finish.settle(ray, clip, start, hi - lo, settled.times - 1, width, work);
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
    fn accepted(&self, ray: Ray, range: [f64; 2], piece: [f64; 2], reason: Reason) -> Finding {
        let [lo, hi] = [piece[0].max(range[0]), piece[1].min(range[1])];
        let bracket = [lo.min(hi), hi];
        match reason {
            Reason::Small => Finding::Unknown(bracket),
            Reason::Crossing => Finding::Unproven(bracket),
            Reason::Root => {
                let clip = self.domain.clip(ray, self.goal.range);
                match clip.and_then(|clip| clip.inner) {
                    Some([from, to]) if from <= piece[0] && piece[1] <= to => Finding::Root(piece),
                    _ => Finding::Unknown(bracket),
                }
            }
        }
    }
}
