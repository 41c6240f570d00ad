//! A ray casting method outside the workspace: uniform samples, a test for a change of sign, and
//! bisection. It proves nothing, and says so.

use glam::{DVec3, Vec3};
use zeroset_expr::{Evaluator, Function, Parameters, Tape};
use zeroset_ia::{Dual, Plain};
use zeroset_raycast::knob;
use zeroset_raycast::{Certificate, Domain, Geometry, Hit, Hits, Ray, Rays, Request, Scene, Work};
use zeroset_raycast::{Error, Intersector, Knob, KnobError, Method, Progress, Report, Unsupported};

/// The algorithm and its knobs.
#[derive(Clone, Debug)]
pub struct Uniform {
    /// Samples between entering the domain and leaving it.
    pub samples: u32,
    /// Bisections of the interval where the sign changes.
    pub bisections: u32,
}

impl Default for Uniform {
    fn default() -> Self {
        Self { samples: 256, bisections: 10 }
    }
}

impl Method for Uniform {
    fn id(&self) -> &'static str {
        "uniform"
    }

    fn summary(&self) -> &'static str {
        "uniform samples, sign test, bisection"
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        function(scene).map(|_| ())
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        let function = function(scene)?.clone();
        let tape = function.tape(&scene.parameters, PRECISION)?;
        Ok(Box::new(Prepared { method: self.clone(), domain: scene.domain, function, tape }))
    }

    fn knobs(&self) -> Vec<Knob> {
        let knob = |name, value: u32, doc| Knob { name, value: value.to_string(), doc };
        vec![
            knob("samples", self.samples, "samples from entering the domain to leaving it [256]"),
            knob("bisections", self.bisections, "bisections where the sign changes [10]"),
        ]
    }

    fn set(&mut self, name: &str, value: &str) -> Result<(), KnobError> {
        let (field, limits) = match name {
            "samples" => (&mut self.samples, [2.0, 1e6]),
            "bisections" => (&mut self.bisections, [0.0, 100.0]),
            _ => return Err(knob::unknown(self.id(), name, &self.knobs())),
        };
        *field = knob::number(name, value, limits)?.round() as u32;
        Ok(())
    }

    fn for_precision(&mut self, width: f64, scene: &Scene) {
        // A ray is in the domain for at most its diagonal.
        let step = 2.0 * scene.domain.radius() / f64::from(self.samples);
        self.bisections = (step / width).log2().ceil().clamp(0.0, 100.0) as u32;
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
        _ => Err(Unsupported("uniform casts rays at functions only".into())),
    }
}

/// The method compiled for a scene.
struct Prepared {
    method: Uniform,
    domain: Domain,
    function: Function,
    tape: Tape,
}

impl Intersector for Prepared {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        self.tape = self.function.tape(values, PRECISION)?;
        Ok(())
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        assert_eq!(rays.len(), hits.len(), "one answer a ray");
        let mut values = self.tape.evaluator(&Plain(0.0));
        let mut gradients = self.tape.evaluator(&Dual::constant_value(Plain(0.0)));
        let mut work = Work::default();
        for i in 0..rays.len() {
            let ray = rays.get(i);
            let mut hit = self.cast(ray, rays.range(), &mut values);
            if hits.request == Request::FirstWithNormal {
                hits.normal[i] = normal(ray, &mut hit, &mut gradients);
            }
            hits.set(i, hit);
            work += hit.work;
            progress.advance(1)?;
        }
        Ok(Report { work, device_time: None })
    }
}

impl Prepared {
    /// The answer for one ray.
    fn cast(&self, ray: Ray, range: [f64; 2], values: &mut Evaluator<'_, Plain<f64>>) -> Hit {
        let mut work = Work::default();
        if !ray.is_valid() {
            work.nonfinite += 1;
            return Hit::miss(Certificate::MISS, work);
        }
        let Some(clip) = self.domain.clip(ray, range) else {
            return Hit::miss(Certificate::MISS, work);
        };
        let mut value = |t: f64| {
            work.points += 1;
            let Plain(f) = values.evaluate(ray.at(t).to_array().map(Plain));
            work.nonfinite += u64::from(!f.is_finite());
            f
        };
        let [enter, leave] = clip.outer;
        let samples = self.method.samples;
        let mut a = enter;
        let mut fa = value(a);
        for i in 1..=samples {
            let share = f64::from(i) / f64::from(samples);
            let mut b = if i == samples { leave } else { enter + share * (leave - enter) };
            let fb = value(b);
            if !differ(fa, fb) {
                (a, fa) = (b, fb);
                continue;
            }
            for _ in 0..self.method.bisections {
                let middle = 0.5 * (a + b);
                let fm = value(middle);
                if differ(fa, fm) { b = middle } else { (a, fa) = (middle, fm) }
            }
            return Hit { bracket: [a, b], certificate: Certificate::HIT, work };
        }
        Hit::miss(Certificate::MISS, work)
    }
}

/// Do signs differ, or is one zero? Not for NaN.
fn differ(a: f64, b: f64) -> bool {
    (a <= 0.0 && b >= 0.0) || (a >= 0.0 && b <= 0.0)
}

/// The unit gradient in the middle of the bracket; zero for a miss, or where there is none.
fn normal(ray: Ray, hit: &mut Hit, gradients: &mut Evaluator<'_, Dual<Plain<f64>, 3>>) -> Vec3 {
    if !hit.certificate.is_hit() {
        return Vec3::ZERO;
    }
    hit.work.gradients += 1;
    let point = ray.at(hit.t());
    let variables = [0, 1, 2].map(|axis| Dual::variable(Plain(point[axis]), axis));
    let gradient = gradients.evaluate(variables).tangent.map(|t| t.0);
    DVec3::from(gradient).normalize_or_zero().as_vec3()
}
