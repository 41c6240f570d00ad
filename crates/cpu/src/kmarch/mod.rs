//! Coherent K-marching with interval arithmetic, [knoll2007].
//!
//! Rays are marched in packets along their common dominant axis K. A slab of the domain is bisected
//! along K while `0 in F(X, Y, Z)` for some ray (Eq. 5), to the depth d_stop; slabs where 0 is not in
//! F hold no root. The pseudocode of Appendix A is damaged in print; this follows Section 5.3.
//! Departures from the paper are listed in `docs/deviations.md`.

mod finish;
mod march;
mod slab;

use zeroset_expr::{Parameters, Tape};
use zeroset_ia::{
    Decorated, Decoration, Interval, Isa, Kernel, Nearest, Rounding, Scalar, dispatch, widest,
};
use zeroset_raycast::{
    Certificate, Domain, Error, Hit, Hits, Intersector, Knob, KnobError, Method, Progress, Ray,
    Rays, Report, Scene, Unsupported, Work, knob,
};

use crate::implicit::Implicit;
use crate::{isa, normals, tiles};
use finish::{Finding, Finish};
use march::{FIRST, Judge, MAX_DEPTH, March, Marcher, RawMarch, SetMarch, Verdict};
use slab::{Axis, Bounds, Clock};

/// What ends the bisection of a ray's slabs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// d_stop: slabs of 2^-d of the domain along K.
    Depth(u32),
    /// Slabs at most this wide in t (Eq. 6, by ray).
    Width(f64),
}

/// What happens to a slab at the last depth that may hold a root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finishing {
    /// It is a hit, as in the paper: it may hold no root.
    Accept,
    /// The march goes [`levels`](Kmarch::levels) deeper, then the finish proves a root by certified
    /// opposite signs of a continuous F, or proves the slab empty and the march goes on.
    Certify,
}

/// Knoll's K-marching: the method `kmarch`.
#[derive(Clone, Debug, PartialEq)]
pub struct Kmarch {
    /// d_stop or epsilon. Default: depth 10, the paper's.
    pub stop: Stop,
    /// Default: outward; the paper rounds to nearest.
    pub rounding: Rounding,
    /// Default: certify; the paper accepts.
    pub finish: Finishing,
    /// Depths beyond the stop that the certifying finish searches. Default: 4.
    pub levels: u32,
    /// The instruction set; `None` is the widest there is.
    pub isa: Option<Isa>,
}

impl Default for Kmarch {
    fn default() -> Self {
        Self {
            stop: Stop::Depth(10),
            rounding: Rounding::Outward,
            finish: Finishing::Certify,
            levels: 4,
            isa: None,
        }
    }
}

const ROUNDINGS: [(&str, Rounding); 3] =
    [("outward", Rounding::Outward), ("nudged", Rounding::Nudged), ("nearest", Rounding::Nearest)];
const FINISHES: [(&str, Finishing); 2] =
    [("accept", Finishing::Accept), ("certify", Finishing::Certify)];

impl Method for Kmarch {
    fn id(&self) -> &'static str {
        "kmarch"
    }

    fn summary(&self) -> &'static str {
        "coherent K-marching with interval arithmetic [knoll2007]"
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        Implicit::function(self.id(), scene).map(|_| ())
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        let implicit = Implicit::new(self.id(), scene)?;
        let form = Form::of(&implicit.tape, &implicit.domain)?;
        Ok(Box::new(Prepared { method: self.clone(), implicit, form }))
    }

    fn knobs(&self) -> Vec<Knob> {
        let (depth, width) = match self.stop {
            Stop::Depth(depth) => (depth.to_string(), "off".to_string()),
            Stop::Width(width) => ("off".to_string(), knob::text(width)),
        };
        vec![
            Knob {
                name: "depth",
                value: depth,
                doc: "d_stop, bisections along K; 0 to 40 (default 10)",
            },
            Knob {
                name: "width",
                value: width,
                doc: "epsilon: width of the last slabs in t, instead of depth (default off)",
            },
            Knob {
                name: "rounding",
                value: knob::name(&ROUNDINGS, &self.rounding),
                doc: "outward, nudged (the same on every instruction set) or nearest (the paper's, without proofs); default outward",
            },
            Knob {
                name: "finish",
                value: knob::name(&FINISHES, &self.finish),
                doc: "certify, or accept every last slab as the paper does (default certify)",
            },
            Knob {
                name: "levels",
                value: self.levels.to_string(),
                doc: "depths beyond the stop that the certifying finish searches (default 4)",
            },
            isa::knob(self.isa),
        ]
    }

    fn set(&mut self, knob: &str, value: &str) -> Result<(), KnobError> {
        match knob {
            // The other of the two says what stops; so that all knobs can be set from a record.
            "depth" | "width" if value.trim() == "off" => {}
            "depth" => self.stop = Stop::Depth(knob::whole(knob, value, [0, MAX_DEPTH])?),
            "width" => {
                self.stop = Stop::Width(knob::number(knob, value, [f64::MIN_POSITIVE, f64::MAX])?);
            }
            "rounding" => self.rounding = knob::choice(knob, value, &ROUNDINGS)?,
            "finish" => self.finish = knob::choice(knob, value, &FINISHES)?,
            "levels" => self.levels = knob::whole(knob, value, [0, MAX_DEPTH])?,
            "isa" => self.isa = isa::read(value)?,
            _ => return Err(knob::unknown(self.id(), knob, &self.knobs())),
        }
        Ok(())
    }

    fn for_precision(&mut self, width: f64, _: &Scene) {
        self.stop = Stop::Width(width);
    }

    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}

/// The arithmetic that a scene needs.
#[derive(Clone, Copy, Debug)]
struct Form {
    bounds: Bounds,
    arithmetic: Arithmetic,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Arithmetic {
    /// Every sub-value is defined and bounded in single precision.
    Raw,
    /// Some sub-value is unbounded or undefined: single precision, set-based.
    Set,
    /// Something is too large for single precision: double precision, set-based.
    Double,
}

/// Single precision is used for numbers up to here.
const LARGEST_SINGLE: f64 = f64::from_bits((1023 + 100) << 52);
/// 2^900: coordinates are at most as large, so that nothing overflows on the way to a slab.
const LARGEST: f64 = f64::from_bits((1023 + 900) << 52);

impl Form {
    /// The root-box check: one evaluation over the whole domain.
    ///
    /// # Errors
    /// If the domain reaches beyond 2^900.
    fn of(tape: &Tape, domain: &Domain) -> Result<Self, Error> {
        let reach = domain.min.abs().max(domain.max.abs()).max_element();
        if reach > LARGEST {
            return Err(Error::Domain(format!(
                "the domain reaches to {reach:e}; kmarch takes domains within 2^900 of the origin"
            )));
        }
        let (single, double) = (Bounds::new::<f32>(domain), Bounds::new::<f64>(domain));
        let arithmetic = if reach > LARGEST_SINGLE {
            Arithmetic::Double
        } else if is_bounded::<f32>(tape, &single, LARGEST_SINGLE) {
            Arithmetic::Raw
        } else if is_bounded::<f64>(tape, &double, LARGEST) {
            Arithmetic::Double
        } else {
            Arithmetic::Set
        };
        let bounds = if arithmetic == Arithmetic::Double { double } else { single };
        Ok(Self { bounds, arithmetic })
    }
}

/// Over the domain, are all sub-values within the limit, and is every operation defined everywhere?
/// Then this holds for every smaller box too, which raw intervals presuppose.
fn is_bounded<S: Scalar>(tape: &Tape, bounds: &Bounds, limit: f64) -> bool {
    let point = bounds.ranges::<S>().map(|[lo, hi]| Decorated::new(Interval::new(lo, hi)));
    let mut bounded = true;
    tape.evaluator(&point[0]).visit(point, |x| {
        bounded &= x.interval.is_bounded_by(limit) && x.decoration >= Decoration::Defined;
    });
    bounded
}

struct Prepared {
    method: Kmarch,
    implicit: Implicit,
    form: Form,
}

impl Intersector for Prepared {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        self.implicit.set_parameters(values)?;
        self.form = Form::of(&self.implicit.tape, &self.implicit.domain)?;
        Ok(())
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        let mut report = tiles::cast(rays, hits, progress, |tile| self.cast(tile, rays.range()))?;
        report.work += normals::fill(&self.implicit.tape, rays, hits);
        Ok(report)
    }
}

impl Prepared {
    /// Answers the rays of a tile.
    fn cast(&self, rays: &[Ray], range: [f64; 2]) -> Vec<Hit> {
        let groups = widest(
            #[inline(always)]
            || self.groups(rays, range),
        );
        // A ray that misses the domain.
        let miss = Hit::miss(self.method.proof(Certificate::PROVEN_MISS), Work::default());
        let mut answers = Answers {
            method: &self.method,
            bounds: &self.form.bounds,
            domain: &self.implicit.domain,
            range,
            hits: vec![miss; rays.len()],
            settled: vec![Settled { empty_until: f64::NEG_INFINITY, times: 0 }; rays.len()],
            finish: (self.method.finish == Finishing::Certify)
                .then(|| Finish::new(&self.implicit.tape)),
        };
        let march = March {
            tape: &self.implicit.tape,
            bounds: &self.form.bounds,
            first: self.first(),
            groups: &groups,
            judge: &mut answers,
        };
        let isa = self.method.isa.unwrap_or_else(Isa::best);
        match (self.form.arithmetic, self.method.rounding) {
            (Arithmetic::Raw, rounding) => dispatch(isa, rounding, RawMarch(march)),
            (Arithmetic::Set, rounding) => dispatch(isa, rounding, SetMarch(march)),
            (Arithmetic::Double, Rounding::Nearest) => SetMarch(march).run(Nearest(0.0_f64)),
            (Arithmetic::Double, _) => SetMarch(march).run(0.0_f64),
        }
        answers.hits
    }

    /// The depth of the slabs with which marches start.
    fn first(&self) -> u32 {
        match self.method.stop {
            Stop::Depth(depth) => depth.min(FIRST),
            Stop::Width(_) => FIRST,
        }
    }

    /// The rays that meet the domain, by axis.
    #[inline(always)]
    fn groups(&self, rays: &[Ray], range: [f64; 2]) -> Vec<(Axis, Vec<Marcher>)> {
        let mut groups: Vec<(Axis, Vec<Marcher>)> = Vec::with_capacity(Axis::COUNT);
        let stop = match self.method.stop {
            Stop::Depth(depth) => depth,
            Stop::Width(_) => 0,
        };
        let depths = [self.deepest(0, stop), self.deepest(1, stop), self.deepest(2, stop)];
        let mut last = 0;
        for (ray, line) in rays.iter().enumerate() {
            let Some(clip) = self.implicit.domain.clip(*line, range) else { continue };
            let axis = Axis::of(*line);
            // Neighbours mostly share their axis.
            if groups.get(last).is_none_or(|(a, _)| *a != axis) {
                last = groups.iter().position(|(a, _)| *a == axis).unwrap_or_else(|| {
                    groups.push((axis, Vec::with_capacity(rays.len())));
                    groups.len() - 1
                });
            }
            let depth = match self.method.stop {
                Stop::Depth(_) => depths[axis.k],
                Stop::Width(width) => self.depth(*line, axis, width),
            };
            groups[last].1.push(Marcher { ray, line: *line, range: clip.outer, depth });
        }
        groups
    }

    /// How often the slabs of a ray are bisected for a width in t.
    fn depth(&self, line: Ray, axis: Axis, width: f64) -> u32 {
        let bounds = &self.form.bounds;
        let clock = Clock::new(line, axis, bounds.start(axis));
        self.deepest(axis.k, bisections(bounds.length(axis) * clock.pace, width))
    }

    fn deepest(&self, k: usize, stop: u32) -> u32 {
        let levels = match self.method.finish {
            Finishing::Accept => 0,
            Finishing::Certify => self.method.levels,
        };
        // Slabs finer than the rounding of coordinates gain nothing.
        (stop + levels).min(self.form.bounds.finest(k)).min(MAX_DEPTH).max(self.first())
    }
}

/// How often a length is halved until it is at most `width`.
fn bisections(length: f64, width: f64) -> u32 {
    (length / width).log2().ceil().clamp(0.0, f64::from(MAX_DEPTH)) as u32
}

impl Kmarch {
    /// The certificate, or what is left of it when rounding proves nothing.
    fn proof(&self, certificate: Certificate) -> Certificate {
        match (self.rounding, certificate) {
            (Rounding::Nearest, Certificate::PROVEN_MISS) => Certificate::MISS,
            (Rounding::Nearest, Certificate::POSSIBLE_HIT) => Certificate::HIT,
            (Rounding::Nearest, Certificate::PROVEN_HIT) => Certificate::ROOT_HIT,
            _ => certificate,
        }
    }
}

/// The answers of a tile, and the finish that makes them.
struct Answers<'a> {
    method: &'a Kmarch,
    bounds: &'a Bounds,
    domain: &'a Domain,
    range: [f64; 2],
    hits: Vec<Hit>,
    settled: Vec<Settled>,
    finish: Option<Finish<'a>>,
}

/// What the finish has done for a ray.
#[derive(Clone, Copy, Debug)]
struct Settled {
    /// From the first slab that was settled to this t, there is no root.
    empty_until: f64,
    /// How many slabs were settled.
    times: i32,
}

impl Judge for Answers<'_> {
    fn reached(&mut self, axis: Axis, marcher: &Marcher, slab: [f64; 2], dropped: bool) -> Verdict {
        let Marcher { ray, line, range, .. } = *marcher;
        let clock = Clock::new(line, axis, self.bounds.start(axis));
        let [lo, hi] = clock.range(slab);
        let slab = [lo.max(range[0]), hi.min(range[1])];
        let mut work = Work::default();
        let unknown = Finding::Unknown([slab[0].min(slab[1]), slab[1]]);
        let finding = match &mut self.finish {
            // A function whose enclosures tell nothing would have every slab settled.
            Some(_) if self.hits[ray].work.gradients >= finish::RAY_BUDGET => unknown,
            Some(finish) => {
                let width = match self.method.stop {
                    Stop::Width(width) => width,
                    Stop::Depth(_) => 2.0_f64.powi(self.method.levels as i32) * (hi - lo),
                };
                // At least a few units in the last place of t.
                let width = width.max(8.0 * f64::EPSILON * hi.abs());
                let clip =
                    self.domain.clip(line, self.range).expect("a marching ray meets the domain");
                let settled = &mut self.settled[ray];
                let start = lo.max(settled.empty_until);
                settled.times += 1;
                finish.settle(line, clip, start, hi - lo, settled.times - 1, width, &mut work)
            }
            None => unknown,
        };
        let hit = &mut self.hits[ray];
        hit.work += work;
        let (bracket, certificate) = match finding {
            Finding::EmptyUntil(t) => {
                self.settled[ray].empty_until = t;
                return Verdict::Continue(clock.q(t));
            }
            Finding::Root(bracket) => (bracket, Certificate::PROVEN_HIT),
            Finding::Unknown(bracket) => (bracket, Certificate::POSSIBLE_HIT),
        };
        hit.bracket = bracket;
        let certificate = if dropped { without_first(certificate) } else { certificate };
        hit.certificate = self.method.proof(certificate);
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

/// The certificate without its FIRST bit.
fn without_first(certificate: Certificate) -> Certificate {
    match certificate {
        Certificate::PROVEN_HIT => Certificate::ROOT_HIT,
        Certificate::POSSIBLE_HIT => Certificate::HIT,
        other => other,
    }
}
