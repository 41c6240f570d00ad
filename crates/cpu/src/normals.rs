//! Unit normals at hits.

use rayon::prelude::*;
use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::{Dual, plain::Plain};
use zeroset_raycast::{Hits, Knob, KnobError, Rays, Request, Work, knob};

use glam::{DVec3, Vec3};

/// How normals are computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Normals {
    /// The gradient by forward-mode differentiation.
    Gradient,
    /// Central differences with a stencil of this width in space: \[knoll2007\] Section 5.7. The value is
    /// taken half a width to each side.
    Stencil(f64),
}

/// The knob `normals` with its value.
pub fn knob(normals: Normals) -> Knob {
    Knob {
        name: "normals",
        value: match normals {
            Normals::Gradient => "gradient".into(),
            Normals::Stencil(width) => knob::text(width),
        },
        doc: "gradient, or the width in space of a central differences stencil (default gradient)",
    }
}

/// Reads the knob's value.
///
/// # Errors
/// If it is neither `gradient` nor a width above 0.
pub fn read(value: &str) -> Result<Normals, KnobError> {
    if value.trim() == "gradient" {
        return Ok(Normals::Gradient);
    }
    let width = knob::number("normals", value, [f64::MIN_POSITIVE, f64::MAX]);
    width.map(Normals::Stencil).map_err(|_| KnobError::Value {
        knob: "normals".into(),
        value: value.into(),
        expected: "gradient, or a width above 0".into(),
    })
}

/// Fills in the normals if they were asked for: the unit gradient at the middle of each bracket, in
/// double precision. Where that is not finite, as where an infinite derivative meets an argument that stands
/// still, central differences stand in; it is zero where it vanishes or they are not finite either. Gives
/// what that cost, but for these.
pub fn fill(tape: &Tape, normals: Normals, rays: Rays<'_>, hits: &mut Hits) -> Work {
    if hits.request != Request::FirstWithNormal {
        return Work::default();
    }
    let each = match normals {
        Normals::Gradient => Work { gradients: 1, ..Work::default() },
        Normals::Stencil(_) => Work { points: 6, ..Work::default() },
    };
    let (bracket, certificate) = (&hits.bracket, &hits.certificate);
    hits.normal.par_chunks_mut(1024).enumerate().for_each(|(chunk, vectors)| {
        let mut gradient = Gradient::new(tape, normals);
        for (i, vector) in vectors.iter_mut().enumerate() {
            let index = 1024 * chunk + i;
            *vector = Vec3::ZERO;
            if !certificate[index].is_hit() {
                continue;
            }
            let [lo, hi] = bracket[index];
            *vector = unit(gradient.at(rays.get(index).at(0.5 * (lo + hi))));
        }
    });
    let mut total = Work::default();
    for index in (0..hits.len()).filter(|index| certificate[*index].is_hit()) {
        total += each;
        if let Some(work) = hits.work.get_mut(index) {
            *work += each;
        }
    }
    total
}

/// The gradient, or what stands in for it.
struct Gradient<'a> {
    duals: Option<Evaluator<'a, Dual<Plain<f64>, 3>>>,
    values: Evaluator<'a, Plain<f64>>,
    normals: Normals,
}

/// The width of the stencil that stands in for a gradient, to the size of coordinates.
const STAND_IN: f64 = 1.0 / (1 << 20) as f64;

impl<'a> Gradient<'a> {
    fn new(tape: &'a Tape, normals: Normals) -> Self {
        let zero = Plain(0.0_f64);
        let duals =
            (normals == Normals::Gradient).then(|| tape.evaluator(&Dual::constant_value(zero)));
        Self { duals, values: tape.evaluator(&zero), normals }
    }

    /// Its direction, of any length.
    fn at(&mut self, p: DVec3) -> DVec3 {
        if let Some(duals) = &mut self.duals {
            let point = [0, 1, 2].map(|axis| Dual::variable(Plain(p[axis]), axis));
            let gradient = DVec3::from(duals.evaluate(point).tangent.map(|t| t.0));
            if gradient.is_finite() {
                return gradient;
            }
        }
        let width = match self.normals {
            Normals::Gradient => STAND_IN * p.abs().max_element(),
            Normals::Stencil(width) => width,
        };
        let mut value = |p: DVec3| self.values.evaluate(p.to_array().map(Plain)).0;
        DVec3::from(DVec3::AXES.map(|axis| {
            let half = 0.5 * width * axis;
            value(p + half) - value(p - half)
        }))
    }
}

/// The unit vector along `v`, scaled first so that its square neither overflows nor vanishes.
fn unit(v: DVec3) -> Vec3 {
    let largest = v.abs().max_element();
    if !(largest > 0.0 && largest.is_finite()) {
        return Vec3::ZERO;
    }
    (v / largest).normalize().as_vec3()
}
