//! Coherent K-marching with interval arithmetic, [knoll2007].
//!
//! Rays are marched in packets along their common dominant axis K. A slab of the domain is bisected
//! along K while `0 in F(X, Y, Z)` for some ray (Eq. 5), to the depth d_stop; slabs where 0 is not in
//! F hold no root. The pseudocode of Appendix A is damaged in print; this follows Section 5.3.
//! Departures from the paper are listed in `docs/deviations.md`.

mod finish;
mod march;
mod slab;

use std::collections::BTreeMap;

use zeroset_expr::{Function, Parameters, Tape};
use zeroset_ia::{Interval, Isa, Kernel, Nearest, Rounding, Scalar, Set, dispatch};
use zeroset_raycast::{
    Certificate, Clip, Domain, Error, Geometry, Hit, Hits, Intersector, Knob, KnobError, Method,
    Progress, Ray, Rays, Report, Scene, Unsupported, Work, knob,
};

use crate::{normals, tiles};
use finish::{Finding, Finish};
use march::{Judge, MAX_DEPTH, March, Marcher, RawMarch, SetMarch, Verdict};
use slab::{Axis, Bounds, Track};

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
const ISAS: [(&str, Option<Isa>); 4] = [
    ("auto", None),
    ("portable", Some(Isa::Portable)),
    ("avx2", Some(Isa::Avx2)),
    ("avx512", Some(Isa::Avx512)),
];

fn name_of<T: PartialEq>(choices: &[(&'static str, T)], value: &T) -> String {
    let (name, _) = choices.iter().find(|(_, v)| v == value).expect("every value has a name");
    (*name).into()
}

impl Method for Kmarch {
    fn id(&self) -> &'static str {
        "kmarch"
    }

    fn summary(&self) -> &'static str {
        "coherent K-marching with interval arithmetic [knoll2007]"
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        function(scene).map(|_| ())
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        let function = function(scene)?.clone();
        let domain =
            Domain { ball: scene.domain.ball, ..Domain::new(scene.domain.min, scene.domain.max)? };
        let tape = function.tape(&scene.parameters, PRECISION)?;
        let form = Form::of(&tape, &domain);
        Ok(Box::new(Prepared { method: self.clone(), function, domain, tape, form }))
    }

    fn knobs(&self) -> Vec<Knob> {
        let (depth, width) = match self.stop {
            Stop::Depth(depth) => (depth.to_string(), "off".to_string()),
            Stop::Width(width) => ("off".to_string(), width.to_string()),
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
                doc: "epsilon: width of the last slabs in t, instead of depth",
            },
            Knob {
                name: "rounding",
                value: name_of(&ROUNDINGS, &self.rounding),
                doc: "outward, nudged (the same on every instruction set) or nearest (the paper's, without proofs)",
            },
            Knob {
                name: "finish",
                value: name_of(&FINISHES, &self.finish),
                doc: "certify, or accept every last slab as the paper does",
            },
            Knob {
                name: "levels",
                value: self.levels.to_string(),
                doc: "depths beyond the stop that the certifying finish searches (default 4)",
            },
            Knob {
                name: "isa",
                value: name_of(&ISAS, &self.isa),
                doc: "instruction set: auto, portable, avx2 or avx512",
            },
        ]
    }

    fn set(&mut self, knob: &str, value: &str) -> Result<(), KnobError> {
        let integer = |max: u32| {
            knob::number(knob, value, [0.0, f64::from(max)]).and_then(|x| {
                if x.fract() == 0.0 {
                    Ok(x as u32)
                } else {
                    Err(KnobError::Value {
                        knob: knob.into(),
                        value: value.into(),
                        expected: format!("a whole number from 0 to {max}"),
                    })
                }
            })
        };
        match knob {
            // The other of the two says what stops; so that all knobs can be set from a record.
            "depth" | "width" if value.trim() == "off" => {}
            "depth" => self.stop = Stop::Depth(integer(MAX_DEPTH)?),
            "width" => {
                self.stop = Stop::Width(knob::number(knob, value, [f64::MIN_POSITIVE, f64::MAX])?);
            }
            "rounding" => self.rounding = knob::choice(knob, value, &ROUNDINGS)?,
            "finish" => self.finish = knob::choice(knob, value, &FINISHES)?,
            "levels" => self.levels = integer(MAX_DEPTH)?,
            "isa" => self.isa = knob::choice(knob, value, &ISAS)?,
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

/// Bits to which constants are known.
const PRECISION: usize = 128;

fn function(scene: &Scene) -> Result<&Function, Unsupported> {
    match &scene.geometry {
        Geometry::Implicit(function) => Ok(function),
        _ => Err(Unsupported("kmarch casts rays at functions only".into())),
    }
}

/// The arithmetic that a scene needs, from one evaluation over the whole domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// Every sub-value is bounded in single precision.
    Raw,
    /// Some sub-value is unbounded or empty: single precision, set-based.
    Set,
    /// Some sub-value is too large for single precision, all are bounded in double precision.
    Double,
}

impl Form {
    /// The root-box check.
    fn of(tape: &Tape, domain: &Domain) -> Self {
        if is_bounded::<f32>(tape, domain) {
            Self::Raw
        } else if is_bounded::<f64>(tape, domain) {
            Self::Double
        } else {
            Self::Set
        }
    }
}

/// Are all sub-values over the domain non-empty and at most 2^100 (2^900 in double precision)?
fn is_bounded<S: Scalar>(tape: &Tape, domain: &Domain) -> bool {
    let limit = if size_of::<S>() == 4 { 2.0_f64.powi(100) } else { 2.0_f64.powi(900) };
    let bounds = Bounds::<S>::new(domain);
    let zero = Interval::<S, Set>::point(S::from_f64(0.0));
    let mut bounded = true;
    let point = bounds.0.map(|[lo, hi]| Interval::new(lo, hi));
    tape.evaluator(&zero).visit(point, |x| {
        bounded &= x.lo.to_f64() >= -limit && x.hi.to_f64() <= limit;
    });
    bounded
}

struct Prepared {
    method: Kmarch,
    function: Function,
    domain: Domain,
    tape: Tape,
    form: Form,
}

impl Intersector for Prepared {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        self.tape = self.function.tape(values, PRECISION)?;
        self.form = Form::of(&self.tape, &self.domain);
        Ok(())
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        tiles::cast(rays, hits, progress, |tile| self.cast(tile, rays.range()))?;
        normals::fill(&self.tape, rays, hits);
        Ok(Report { work: hits.total_work(), device_time: None })
    }
}

impl Prepared {
    /// Answers the rays of a tile.
    fn cast(&self, rays: &[Ray], range: [f64; 2]) -> Vec<Hit> {
        let clips: Vec<_> = rays.iter().map(|r| self.domain.clip(*r, range)).collect();
        let mut groups: BTreeMap<Axis, Vec<Marcher>> = BTreeMap::new();
        for (ray, clip) in clips.iter().enumerate() {
            if let Some(clip) = clip {
                let axis = Axis::of(rays[ray]);
                groups.entry(axis).or_default().push(self.marcher(ray, rays[ray], *clip, axis));
            }
        }
        let groups: Vec<_> = groups.into_iter().collect();
        let mut answers = Answers {
            method: &self.method,
            rays,
            clips: &clips,
            // A ray that misses the domain.
            hits: vec![
                Hit::miss(self.proof(Certificate::PROVEN_MISS), Work::default());
                rays.len()
            ],
            empty_until: vec![f64::NEG_INFINITY; rays.len()],
            finish: (self.method.finish == Finishing::Certify).then(|| Finish::new(&self.tape)),
        };
        let march =
            March { tape: &self.tape, domain: &self.domain, groups: &groups, judge: &mut answers };
        let isa = self.method.isa.unwrap_or_else(Isa::best);
        match (self.form, self.method.rounding) {
            (Form::Raw, rounding) => dispatch(isa, rounding, RawMarch(march)),
            (Form::Set, rounding) => dispatch(isa, rounding, SetMarch(march)),
            (Form::Double, Rounding::Nearest) => SetMarch(march).run(Nearest(0.0_f64)),
            (Form::Double, _) => SetMarch(march).run(0.0_f64),
        }
        answers.hits
    }

    /// The certificate, or what is left of it when rounding proves nothing.
    fn proof(&self, certificate: Certificate) -> Certificate {
        self.method.proof(certificate)
    }

    fn marcher(&self, ray: usize, r: Ray, clip: Clip, axis: Axis) -> Marcher {
        let (track, length, resolution) = match self.form {
            Form::Double => {
                let bounds = Bounds::<f64>::new(&self.domain);
                (Track::new(r, clip.outer, axis, &bounds), bounds.length(axis), bounds.resolution())
            }
            _ => {
                let bounds = Bounds::<f32>::new(&self.domain);
                (Track::new(r, clip.outer, axis, &bounds), bounds.length(axis), bounds.resolution())
            }
        };
        // Slabs finer than the rounding of coordinates gain nothing.
        let finest = (length / resolution).log2().floor().max(0.0) as u32;
        let stop = match self.method.stop {
            Stop::Depth(depth) => depth,
            Stop::Width(width) => depth_for(length * track.pace[1], width),
        };
        let levels = match self.method.finish {
            Finishing::Accept => 0,
            Finishing::Certify => self.method.levels,
        };
        Marcher { ray, track, depth: (stop + levels).min(finest).min(MAX_DEPTH) }
    }
}

/// The least depth at which slabs of a march `length` long are at most `width` wide.
fn depth_for(length: f64, width: f64) -> u32 {
    (length / width).log2().ceil().clamp(0.0, f64::from(MAX_DEPTH)) as u32
}

impl Kmarch {
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
    rays: &'a [Ray],
    clips: &'a [Option<Clip>],
    hits: Vec<Hit>,
    /// From where the march met its first slab to here, a ray is proven to have no root.
    empty_until: Vec<f64>,
    finish: Option<Finish<'a>>,
}

impl Judge for Answers<'_> {
    fn reached(&mut self, marcher: &Marcher, slab: [f64; 2], dropped: bool) -> Verdict {
        let clip = self.clips[marcher.ray].expect("a marching ray meets the domain");
        let [lo, hi] = marcher.track.t(slab);
        let slab = [lo.max(clip.outer[0]), hi.min(clip.outer[1])];
        // At least a few units in the last place of t.
        let width = match self.method.stop {
            Stop::Width(width) => width,
            Stop::Depth(_) => 2.0_f64.powi(self.method.levels as i32) * (hi - lo),
        }
        .max(8.0 * f64::EPSILON * hi.abs());
        let mut work = Work::default();
        let spent = self.hits[marcher.ray].work.gradients;
        let unknown = Finding::Unknown([slab[0].min(slab[1]), slab[1]]);
        let finding = match &mut self.finish {
            // A function whose enclosures tell nothing would have every slab settled.
            Some(_) if spent >= finish::RAY_BUDGET => unknown,
            Some(finish) => {
                let start = lo.max(self.empty_until[marcher.ray]);
                let ray = self.rays[marcher.ray];
                finish.settle(ray, clip, start, hi - lo, width, &mut work)
            }
            None => unknown,
        };
        let (bracket, certificate) = match finding {
            Finding::EmptyUntil(t) => {
                self.hits[marcher.ray].work += work;
                self.empty_until[marcher.ray] = t;
                return Verdict::Continue(marcher.track.q(t));
            }
            Finding::Root(bracket) => (bracket, Certificate::PROVEN_HIT),
            Finding::Unknown(bracket) => (bracket, Certificate::POSSIBLE_HIT),
        };
        let hit = &mut self.hits[marcher.ray];
        hit.work += work;
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
