//! Proofs of roots: opposite signs at the ends of a bracket, and continuity between them.

use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::{Decorated, Interval, Set};

use crate::{Certificate, Clip, Hit, Knob, KnobError, Ray, Work, knob};

type I = Interval<f64, Set>;

/// What a method that proves nothing does with its hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Certification {
    /// They stay as they are.
    #[default]
    Off,
    /// A [`Certifier`] proves what it can.
    On,
}

const CERTIFICATIONS: [(&str, Certification); 2] =
    [("on", Certification::On), ("off", Certification::Off)];

impl Certification {
    /// The knob `certify` with this value.
    pub fn knob(self) -> Knob {
        Knob {
            name: "certify",
            value: knob::name(&CERTIFICATIONS, &self),
            doc: "on, or off: a hit is a root-hit where f = 0 is proven to have a root in its bracket (default off)",
        }
    }

    /// Reads the knob's value.
    ///
    /// # Errors
    /// [`KnobError::Value`] lists the values.
    pub fn read(value: &str) -> Result<Self, KnobError> {
        knob::choice("certify", value, &CERTIFICATIONS)
    }
}

/// Encloses the function along rays in outward double precision, and proves roots by it.
///
/// A ray is exact, and so is the t at which a sign is taken. Evaluators are reused from call to call,
/// so one certifier serves many rays of one thread.
#[derive(Debug)]
pub struct Certifier<'a> {
    values: Evaluator<'a, I>,
    /// Only if the function is not continuous on all of space because each of its operations is.
    continuity: Option<Evaluator<'a, Decorated<f64>>>,
}

impl<'a> Certifier<'a> {
    /// For the function of a tape over x, y and z.
    pub fn new(tape: &'a Tape) -> Self {
        let zero = I::point(0.0);
        Self {
            values: tape.evaluator(&zero),
            continuity: (!tape.is_continuous()).then(|| tape.evaluator(&Decorated::new(zero))),
        }
    }

    /// F's enclosure over a closed range of t.
    pub fn value(&mut self, ray: Ray, range: [f64; 2], work: &mut Work) -> I {
        work.intervals += 1;
        self.values.evaluate(ray.over(range))
    }

    /// The sign of F(t): 1 or -1 where it is certain, else 0.
    pub fn sign(&mut self, ray: Ray, t: f64, work: &mut Work) -> i32 {
        let value = self.value(ray, [t, t], work);
        i32::from(value.lo > 0.0) - i32::from(value.hi < 0.0)
    }

    /// Is F proven to be defined and continuous over a closed range of t?
    pub fn is_continuous(&mut self, ray: Ray, range: [f64; 2]) -> bool {
        match &mut self.continuity {
            None => true,
            Some(evaluator) => {
                evaluator.evaluate(ray.over(range).map(Decorated::new)).is_continuous()
            }
        }
    }

    /// Is F, continuous on the range, proven to have opposite signs at its ends? Then it has a root
    /// between them: a pole changes sign too, but no continuous function does without a root.
    pub fn changes_sign(&mut self, ray: Ray, [a, b]: [f64; 2], work: &mut Work) -> bool {
        let [before, after] = [a, b].map(|t| self.sign(ray, t, work));
        before * after < 0 && self.is_continuous(ray, [a, b])
    }

    /// Makes a `hit` a `root-hit` if a root in its bracket, that counts, is proven.
    ///
    /// The bracket is cut with the part of the ray that is surely in the domain and range. Where no
    /// change of sign is proven in it, it is tried once more widened by `slack`, in t, at both ends:
    /// rounded values have a root a little beside its place. A bracket is changed only if that proves
    /// a root.
    pub fn certify(&mut self, ray: Ray, clip: Clip, slack: f64, hit: &mut Hit) {
        let Some([from, to]) = clip.inner.filter(|_| hit.certificate == Certificate::HIT) else {
            return;
        };
        let [lo, hi] = hit.bracket;
        for slack in [0.0, slack] {
            let bracket = [(lo - slack).max(from), (hi + slack).min(to)];
            if bracket[0] < bracket[1] && self.changes_sign(ray, bracket, &mut hit.work) {
                hit.bracket = bracket;
                hit.certificate = Certificate::ROOT_HIT;
                return;
            }
        }
    }
}
