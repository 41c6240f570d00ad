//! Interval bisection on the device: the method `tbisect-gpu`.

use std::sync::atomic::{AtomicU32, Ordering};

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use zeroset_cpu::{Bisection, Goal, Implicit, Normals, Reason, Settled, Settler};
use zeroset_expr::Tape;
use zeroset_ia::{Interval, Rounding, Scalar, Set};
use zeroset_raycast::{
    Certificate, Domain, Error, Hit, Hits, Progress, Ray, Rays, Report, Unsupported, Work,
};

use crate::bounded;
use crate::chunks::{self, Job, Traffic};
use crate::program::{Module, Numbers};
use crate::twin::{OnDevice, Twin};

/// `tbisect` on a device, a ray an invocation.
///
/// The device excludes pieces of the ray, and the CPU settles what is left as it does for `tbisect`. With
/// outward rounding, excluded is proven: intervals there make no use of what a shading language does
/// not promise (`zeroset_ia::portable`).
pub type BisectionGpu = OnDevice<Bisection>;

impl Default for BisectionGpu {
    fn default() -> Self {
        Self::auto(Bisection::tbisect())
    }
}

const KERNEL: &str = include_str!("shaders/tbisect.wgsl");

/// The shader's function: F over intervals.
fn module(tape: &Tape, rounding: Rounding) -> Result<Module, Unsupported> {
    let mut module = Module::new(rounding);
    module.function("value", tape, Numbers::Interval)?;
    Ok(module)
}

/// The whole shader of a function, as it is compiled for a device.
///
/// # Errors
/// If an operation has no form on devices.
pub fn shader(tape: &Tape, rounding: Rounding) -> Result<String, Unsupported> {
    Ok(module(tape, rounding)?.shader(KERNEL))
}

impl Twin for Bisection {
    type Plan = ();

    fn kernel(&self) -> String {
        KERNEL.into()
    }

    fn names(&self) -> [&'static str; 2] {
        ["tbisect-gpu", "tbisect on the GPU [knoll2007]"]
    }

    fn module(&self, tape: &Tape) -> Result<Module, Unsupported> {
        module(tape, self.rounding)
    }

    fn plan(&self, implicit: &Implicit, _: Option<f64>) -> Result<(), Error> {
        Ok(bounded::check(&implicit.tape, &implicit.domain)?)
    }

    fn cast(
        &self,
        job: &Job<'_>,
        implicit: &Implicit,
        (): &(),
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        let goal = Goal::new(self, hits.request, rays.range());
        let march = March { method: self, implicit, goal: &goal, ticket: AtomicU32::new(0) };
        chunks::cast(job, &march, rays, hits, progress)
    }

    fn normals(&self) -> Normals {
        self.normals
    }
}

/// The march as the device is told of it.
struct March<'a> {
    method: &'a Bisection,
    implicit: &'a Implicit,
    goal: &'a Goal,
    /// What the answers of the latest run are marked with.
    ticket: AtomicU32,
}

/// The deepest pieces: an index is exact in single precision.
const MAX_DEPTH: u32 = 23;
/// A ray that comes back more often than this ends with a possible hit.
const MOST_ROUNDS: u32 = 64;

/// A ray on its way.
struct Marcher {
    ray: Ray,
    /// The range of t that contains all that counts.
    range: [f64; 2],
    /// The ray from the start of the range on, as the device has it: t = range[0] + s unit.
    base: [[f32; 2]; 3],
    direction: [f32; 3],
    length: f32,
    unit: f64,
    /// Does the device have exactly this ray, within the box where its intervals may be trusted?
    trusted: bool,
    /// The piece to go on with.
    index: u32,
    depth: u32,
    /// Pieces of this depth are settled.
    last: u32,
    rounds: u32,
    hit: Hit,
    settled: Settled,
}

type I = Interval<f64, Set>;

impl Marcher {
    fn new(ray: Ray, range: [f64; 2], domain: &Domain, last: u32, miss: Hit) -> Self {
        // A power of two makes the largest component one of [1, 2): exact, but for the tiniest of others.
        let largest = f64::from(ray.direction.abs().max_element());
        let scale = 2.0_f64.powi(-(largest.log2().floor() as i32));
        let scaled = ray.direction.as_dvec3() * scale;
        let direction = scaled.to_array().map(|x| x as f32);
        let base: [[f32; 2]; 3] = std::array::from_fn(|axis| {
            let along = I::point(range[0]) * I::point(f64::from(ray.direction[axis]));
            let start = I::point(f64::from(ray.origin[axis])) + along;
            normal(f32::enclose_range(start.lo, start.hi))
        });
        let whole = (I::point(range[1]) - I::point(range[0])) * I::point(scale.recip());
        let [_, length] = f32::enclose_range(whole.lo, whole.hi);
        let is_normal = |x: f32| x == 0.0 || x.is_normal();
        let is_inside = bounded::around(domain).into_iter().enumerate().all(|(axis, [lo, hi])| {
            let [from, to] = base[axis].map(f64::from);
            let step = f64::from(length) * scaled[axis];
            lo <= from.min(from + step) && to.max(to + step) <= hi
        });
        let trusted = is_inside
            && DVec3::from(direction.map(f64::from)) == scaled
            && direction.into_iter().all(is_normal)
            && base.iter().flatten().all(|x| x.is_finite())
            && length.is_finite()
            && f64::from(length) > 2.0_f64.powi(-90);
        Self {
            ray,
            range,
            base,
            direction,
            length,
            unit: scale,
            trusted,
            index: 0,
            depth: 0,
            last,
            rounds: 0,
            hit: miss,
            settled: Settled::default(),
        }
    }

    /// The piece's range of t, rounded outward.
    fn piece(&self, index: u32) -> [f64; 2] {
        // Exact: 24 and 24 bits, and powers of two.
        let t = |index: u32| {
            f64::from(index)
                * 2.0_f64.powi(-(self.last as i32))
                * f64::from(self.length)
                * self.unit
        };
        let start = I::point(self.range[0]);
        let [from, to] = [index, index + 1].map(|i| start + I::point(t(i)));
        [from.lo.max(self.range[0]), to.hi.min(self.range[1])]
    }

    /// Goes on at the piece that holds t, or behind the piece `index`, if that is farther. False at the
    /// end of the ray.
    fn go_on(&mut self, t: f64, index: u32) -> bool {
        let pieces = 2.0_f64.powi(self.last as i32);
        let place = (t - self.range[0]) / (f64::from(self.length) * self.unit) * pieces;
        // A piece earlier than rounding may put it; not a number never.
        let next = (place - 1.0).floor().clamp(0.0, pieces) as u32;
        let next = next.max(index + 1);
        if next >= 1 << self.last {
            return false;
        }
        let up = next.trailing_zeros().min(self.last);
        (self.index, self.depth) = (next >> up, self.last - up);
        self.rounds += 1;
        true
    }
}

/// A range without subnormal ends.
fn normal([lo, hi]: [f32; 2]) -> [f32; 2] {
    let least = f32::MIN_POSITIVE;
    [if lo.abs() >= least { lo } else { -least }, if hi.abs() >= least { hi } else { least }]
}

/// The shader's `Settings`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct SentSettings {
    rays: u32,
    ticket: u32,
    unused: [u32; 2],
}

/// The shader's `Line`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct SentLine {
    base_lo: [f32; 3],
    length: f32,
    base_hi: [f32; 3],
    index: u32,
    direction: [f32; 3],
    depths: u32,
}

/// The shader's `Answer`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct SentAnswer {
    index: u32,
    found: u32,
    intervals: u32,
    ticket: u32,
}

impl<'a> Traffic for March<'a> {
    type Ready = Marcher;
    type Sent = SentLine;
    type Answer = SentAnswer;
    type Settings = SentSettings;
    type Reader = Settler<'a>;

    fn ready(&self, ray: Ray) -> Result<Marcher, Hit> {
        let miss = self.method.miss();
        let clip = self.implicit.domain.clip(ray, self.goal.range).ok_or(miss)?;
        let [from, to] = clip.outer;
        let depth = self.goal.depth(self.method, to - from, 1.0).min(MAX_DEPTH);
        Ok(Marcher::new(ray, clip.outer, &self.implicit.domain, depth, miss))
    }

    fn sent(&self, marcher: &Marcher) -> SentLine {
        let Marcher { base, direction, length, index, depth, last, .. } = *marcher;
        SentLine {
            base_lo: base.map(|x| x[0]),
            length,
            base_hi: base.map(|x| x[1]),
            index,
            direction,
            depths: depth | last << 8,
        }
    }

    fn settings(&self, rays: u32) -> SentSettings {
        let ticket = self.ticket.fetch_add(1, Ordering::Relaxed) + 1;
        SentSettings { rays, ticket, unused: [0; 2] }
    }

    fn reader(&self) -> Settler<'a> {
        Settler::new(self.method, self.implicit, self.goal)
    }

    fn read(
        &self,
        settler: &mut Settler<'a>,
        mut marcher: Marcher,
        answer: &SentAnswer,
    ) -> Result<Hit, Marcher> {
        marcher.hit.work += Work { intervals: answer.intervals.into(), ..Work::default() };
        // What no kernel has written is no answer.
        let is_answered = answer.ticket == self.ticket.load(Ordering::Relaxed);
        if answer.found == 1 && is_answered {
            let piece = marcher.piece(answer.index);
            let Marcher { ray, range, rounds, .. } = marcher;
            let whole = range[1] - range[0];
            let (hit, settled) = (&mut marcher.hit, &mut marcher.settled);
            // By rounding the last piece may lie beyond the range: it holds nothing that counts.
            let next = if piece[0] > piece[1] {
                None
            } else {
                settler.settle(hit, settled, ray, range, piece, whole, Reason::Small)
            };
            if let Some(t) = next
                && marcher.go_on(t, answer.index)
            {
                if rounds < MOST_ROUNDS {
                    return Err(marcher);
                }
                marcher.hit.bracket = [piece[0].max(t).min(range[1]), range[1]];
                marcher.hit.certificate = self.method.proof(Certificate::POSSIBLE_HIT);
            }
        }
        if !(marcher.trusted && is_answered) {
            marcher.hit.certificate = marcher.hit.certificate.without(Certificate::FIRST);
        }
        Ok(marcher.hit)
    }
}
