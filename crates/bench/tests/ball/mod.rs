//! The unit sphere in closed form: an oracle, and a method with a fault to order.
#![allow(dead_code, reason = "each test uses a part")]

use glam::{DVec3, Vec3};
use zeroset_bench::{Class, Oracle, Truth};
use zeroset_expr::{Function, ParameterError, Parameters};
use zeroset_ia::{Interval, Number, Set, Unary};
use zeroset_raycast::{
    Certificate, Domain, Error, Hit, Hits, Intersector, Knob, KnobError, Method, Progress, Ray,
    Rays, Report, Request, Scene, Unsupported, Work, knob,
};

/// The sphere of radius 1 in a box of half side 1.5.
pub(crate) fn scene() -> Scene {
    let function = Function::parse("x^2 + y^2 + z^2 - 1").unwrap();
    let domain = Domain::new(DVec3::splat(-1.5), DVec3::splat(1.5)).unwrap();
    Scene::new("sphere", function, domain)
}

/// What is known of a valid ray, from the quadratic a t^2 + 2 b t + c = 0 in interval arithmetic.
fn truth(ray: Ray, range: [f64; 2], domain: &Domain) -> Truth {
    type I = Interval<f64, Set>;
    let known = |class, bracket| Truth::new(class, bracket, Work::default());
    let none = known(Class::None, [f64::INFINITY; 2]);
    let undecidable = |from: f64| known(Class::Undecidable, [from, f64::INFINITY]);

    let Some(clip) = domain.clip(ray, range) else { return none };
    let [mut a, mut b, mut c] = [0.0, 0.0, -1.0].map(I::point);
    for axis in 0..3 {
        let o = I::point(f64::from(ray.origin[axis]));
        let d = I::point(f64::from(ray.direction[axis]));
        (a, b, c) = (a + d.sqr(), b + o * d, c + o.sqr());
    }
    let discriminant = b.sqr() - a * c;
    if discriminant.hi < 0.0 {
        return none;
    }
    if !(discriminant.lo > 0.0) {
        return undecidable(clip.outer[0]);
    }
    let root = discriminant.unary(Unary::Sqrt);
    for t in [(-b - root) / a, (-b + root) / a] {
        if t.hi < clip.outer[0] || clip.outer[1] < t.lo {
            continue;
        }
        return match clip.inner {
            Some([lo, hi]) if lo <= t.lo && t.hi <= hi => known(Class::Transversal, [t.lo, t.hi]),
            _ => undecidable(t.lo.max(clip.outer[0])),
        };
    }
    none
}

/// The truth about the sphere.
pub(crate) struct Sphere {
    /// How often it was asked; it may be slow.
    pub(crate) domain: Domain,
    /// A pause a ray, for a slow oracle.
    pub(crate) pause: std::time::Duration,
}

impl Sphere {
    pub(crate) fn of(scene: &Scene) -> Self {
        Self { domain: scene.domain, pause: std::time::Duration::ZERO }
    }
}

impl Oracle for Sphere {
    fn classify(
        &self,
        rays: Rays<'_>,
        indices: &[usize],
        progress: &Progress,
    ) -> Result<Vec<Truth>, Error> {
        std::thread::sleep(self.pause * indices.len() as u32);
        progress.advance(indices.len())?;
        Ok(indices.iter().map(|i| truth(rays.get(*i), rays.range(), &self.domain)).collect())
    }
}

/// What is wrong with a [`Ball`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fault {
    Nothing,
    // Answers.
    MissesSome,
    FindsNothing,
    Shifts(f64),
    ProvesShifted,
    ProvesMisses,
    ProvesHits,
    ProvesLateHits,
    // Form.
    ReversesBrackets,
    LeavesTheRange,
    IgnoresRange,
    KeepsBrackets,
    TrustsBadRays,
    LongNormals,
    NormalsInwards,
    // Dependence.
    OnIndex,
    OnCount,
    OnThreads,
    OnRequest,
    AnyProvesMisses,
    // Manners.
    ReportsNoWork,
    CountsByRay,
    WorksForNothing,
    NeverStops,
    TakesAnyKnob,
    TakesAnyValue,
    PrintsKnobsBadly,
    TakesAnyParameter,
    ParametersStick,
    PreparesUnsupported,
    Shouts,
}

/// The unit sphere as a method.
#[derive(Clone, Debug)]
pub(crate) struct Ball {
    pub(crate) fault: Fault,
    pub(crate) depth: f64,
}

impl Ball {
    pub(crate) fn with(fault: Fault) -> Self {
        Self { fault, depth: 10.0 }
    }
    pub(crate) fn boxed_with(fault: Fault) -> Box<dyn Method> {
        Box::new(Self::with(fault))
    }
}

impl Method for Ball {
    fn id(&self) -> &'static str {
        if self.fault == Fault::Shouts { "BALL" } else { "ball" }
    }
    fn summary(&self) -> &'static str {
        "the unit sphere in closed form"
    }
    fn supports(&self, _: &Scene) -> Result<(), Unsupported> {
        if self.fault == Fault::PreparesUnsupported {
            return Err(Unsupported("not today".into()));
        }
        Ok(())
    }
    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        Ok(Box::new(Prepared { domain: scene.domain, fault: self.fault, shift: 0.0 }))
    }
    fn knobs(&self) -> Vec<Knob> {
        let value = match self.fault {
            Fault::PrintsKnobsBadly => format!("{} levels", self.depth),
            _ => self.depth.to_string(),
        };
        vec![Knob { name: "depth", value, doc: "for show; 10" }]
    }
    fn set(&mut self, name: &str, value: &str) -> Result<(), KnobError> {
        match name {
            "depth" if self.fault == Fault::TakesAnyValue => {
                self.depth = value.parse().unwrap_or(0.0);
            }
            "depth" => self.depth = knob::number(name, value, [0.0, 50.0])?,
            _ if self.fault == Fault::TakesAnyKnob => {}
            _ => return Err(knob::unknown(self.id(), name, &self.knobs())),
        }
        Ok(())
    }
    fn for_precision(&mut self, _: f64, _: &Scene) {}
    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}

struct Prepared {
    domain: Domain,
    fault: Fault,
    shift: f64,
}

impl Intersector for Prepared {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        if self.fault == Fault::ParametersStick && values.iter().next().is_some() {
            self.shift = 1e-9;
        }
        match values.iter().next() {
            Some((name, _)) if self.fault != Fault::TakesAnyParameter => {
                let message = format!("no parameter {name:?}");
                Err(ParameterError { message }.into())
            }
            _ => Ok(()),
        }
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        let mut work = Work::default();
        for i in 0..rays.len() {
            let ray = rays.get(i);
            let hit = if ray.is_valid() {
                self.answer(ray, i, rays, hits.request)
            } else {
                let nonfinite = u64::from(self.fault != Fault::TrustsBadRays);
                Hit::miss(Certificate::MISS, Work { nonfinite, ..Work::default() })
            };
            hits.set(i, hit);
            work += hit.work;
            if hits.request == Request::FirstWithNormal && hit.certificate.is_hit() {
                let length = match self.fault {
                    Fault::LongNormals => 1.01,
                    Fault::NormalsInwards => -1.0,
                    _ => 1.0,
                };
                hits.normal[i] = length * ray.at(hit.t()).normalize_or_zero().as_vec3();
            }
        }
        let stopped = progress.advance(rays.len());
        if self.fault != Fault::NeverStops {
            stopped?;
        }
        if self.fault == Fault::ReportsNoWork {
            work = Work::default();
        }
        if self.fault == Fault::CountsByRay {
            work = hits.total_work();
        }
        if self.fault == Fault::WorksForNothing && rays.is_empty() {
            work.points = 1;
        }
        Ok(Report { work, device_time: None })
    }
}

impl Prepared {
    fn answer(&self, ray: Ray, index: usize, rays: Rays<'_>, request: Request) -> Hit {
        let range = match self.fault {
            Fault::IgnoresRange => [0.0, f64::INFINITY],
            _ => rays.range(),
        };
        let truth = truth(ray, range, &self.domain);
        let work = Work { points: 1, ..Work::default() };
        let [lo, hi] = truth.bracket.map(|t| t + self.shift);
        let certificate = match truth.class {
            Class::None => return self.miss(ray, Certificate::PROVEN_MISS, work),
            Class::Undecidable => Certificate::POSSIBLE_HIT,
            _ => Certificate::PROVEN_HIT,
        };
        let clip = self.domain.clip(ray, rays.range());
        let end = clip.map_or(hi, |clip| clip.outer[1]);
        let honest = Hit { bracket: [lo, hi.min(end.max(lo))], certificate, work };
        let miss = |certificate| Hit::miss(certificate, work);
        let moved = |by: f64, certificate| Hit {
            bracket: honest.bracket.map(|t| t + by),
            certificate,
            work,
        };
        // A quarter of the rays, by their own bits.
        let bits = ray.direction.to_array().map(f32::to_bits);
        let is_chosen = bits.into_iter().fold(0, |a, b| a ^ b) % 4 == 0;
        match self.fault {
            Fault::FindsNothing => miss(Certificate::MISS),
            Fault::MissesSome if is_chosen => miss(Certificate::MISS),
            Fault::Shifts(by) => moved(by, Certificate::HIT),
            Fault::ProvesShifted if is_chosen => moved(-0.01, Certificate::PROVEN_HIT),
            Fault::ProvesLateHits if is_chosen => moved(0.01, Certificate::POSSIBLE_HIT),
            Fault::ProvesMisses if is_chosen => miss(Certificate::PROVEN_MISS),
            Fault::ReversesBrackets => Hit { bracket: [hi, lo.next_down()], ..honest },
            Fault::LeavesTheRange if clip.is_some() => {
                Hit { bracket: [lo, end.next_up()], ..honest }
            }
            Fault::OnIndex if index.is_multiple_of(5) => miss(Certificate::MISS),
            Fault::OnCount if rays.len() < 10 => miss(Certificate::MISS),
            Fault::OnThreads if rayon::current_num_threads() == 1 => miss(Certificate::MISS),
            Fault::OnRequest if request == Request::FirstWithNormal => {
                Hit { certificate: Certificate::HIT, ..honest }
            }
            Fault::AnyProvesMisses if request == Request::Any && is_chosen => {
                miss(Certificate::PROVEN_MISS)
            }
            _ => honest,
        }
    }

    fn miss(&self, ray: Ray, certificate: Certificate, work: Work) -> Hit {
        match self.fault {
            Fault::KeepsBrackets => Hit { bracket: [0.0, 1.0], certificate, work },
            Fault::ProvesHits => {
                let t = self.domain.clip(ray, [0.0, f64::INFINITY]).map(|clip| clip.outer[1]);
                match t {
                    Some(t) => Hit { bracket: [t, t], certificate: Certificate::PROVEN_HIT, work },
                    None => Hit::miss(certificate, work),
                }
            }
            _ => Hit::miss(certificate, work),
        }
    }
}

/// A ray towards the sphere's centre from distance 3, and one beside it.
pub(crate) fn rays() -> [Ray; 2] {
    let towards = Ray::new(Vec3::new(0.0, 0.0, 3.0), Vec3::NEG_Z);
    [towards, Ray::new(Vec3::new(1.2, 0.0, 3.0), Vec3::NEG_Z)]
}
