//! The function along a ray, F(t) = f(o + t d).

use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::{Dual, Number};
use zeroset_raycast::{Ray, Work};

use super::bernstein::Scaled;
use super::enclosure::{Enclosure, Sign};
use super::taylor::Taylor;

/// Polynomials of a higher degree are treated as any other function.
const MAX_DEGREE: u32 = 64;

/// What is known of F on a closed piece of the ray.
pub(super) enum Expansion<N> {
    /// It has no root there.
    Free,
    /// It is continuous there: an enclosure in Bernstein form of F and, by differences, of F'.
    Terms(Vec<N>),
    /// It may have a root, and may jump.
    Open,
}

/// F along one ray, in the arithmetic of `N`.
pub(super) struct Curve<'a, N: Enclosure> {
    origin: [N; 3],
    direction: [N; 3],
    values: Evaluator<'a, N>,
    slopes: Evaluator<'a, Dual<N, 1>>,
    form: Form<'a, N>,
    /// What the ray has cost.
    pub(super) work: Work,
}

enum Form<'a, N: Enclosure> {
    /// The Bernstein form of the ray polynomial.
    Polynomial(Evaluator<'a, Scaled<N>>),
    /// A Taylor expansion with its remainder.
    Smooth(Box<Taylor<'a, N>>),
}

impl<'a, N: Enclosure> Curve<'a, N> {
    pub(super) fn new(tape: &'a Tape, degree: Option<u32>, context: &N) -> Self {
        let zero = context.exact(0.0);
        let form = if degree.is_some_and(|d| d <= MAX_DEGREE) {
            Form::Polynomial(tape.evaluator(&Scaled::line(zero.clone(), zero.clone())))
        } else {
            Form::Smooth(Box::new(Taylor::new(tape, context)))
        };
        Self {
            origin: [0, 1, 2].map(|_| zero.clone()),
            direction: [0, 1, 2].map(|_| zero.clone()),
            values: tape.evaluator(context),
            slopes: tape.evaluator(&Dual::constant_value(zero)),
            form,
            work: Work::default(),
        }
    }

    /// Turns to another ray.
    pub(super) fn aim(&mut self, ray: Ray) {
        for axis in 0..3 {
            let context = &self.origin[axis];
            let origin = context.exact(f64::from(ray.origin[axis]));
            self.direction[axis] = context.exact(f64::from(ray.direction[axis]));
            self.origin[axis] = origin;
        }
        self.work = Work::default();
    }

    /// The points at t.
    fn at(&self, t: &N) -> [N; 3] {
        at(&self.origin, &self.direction, t)
    }

    /// F(t).
    pub(super) fn value(&mut self, t: f64) -> N {
        self.work.intervals += 1;
        let t = self.origin[0].exact(t);
        let point = self.at(&t);
        let value = self.values.evaluate(point);
        self.work.nonfinite += u64::from(!value.is_bounded());
        value
    }

    /// The sign of F(t). Of a function that may be undefined, 0 is never certain.
    pub(super) fn sign(&mut self, t: f64) -> Sign {
        match (self.value(t).sign(), &self.form) {
            (Sign::Zero, Form::Smooth(_)) => Sign::Unknown,
            (sign, _) => sign,
        }
    }

    /// All slopes of F between two t.
    pub(super) fn slope(&mut self, [a, b]: [f64; 2]) -> N {
        self.work.intervals += 1;
        let t = self.origin[0].between(a, b);
        let mut directions = self.direction.iter();
        let point = self.at(&t).map(|value| {
            let tangent = [directions.next().expect("three axes").clone()];
            Dual { value, tangent }
        });
        let [slope] = self.slopes.evaluate(point).tangent;
        slope
    }

    /// What is known of F between two t.
    pub(super) fn expand(&mut self, ends: [f64; 2]) -> Expansion<N> {
        self.work.intervals += 1;
        match &mut self.form {
            Form::Polynomial(evaluator) => {
                let [start, end] = ends.map(|t| {
                    at(&self.origin, &self.direction, &self.origin[0].exact(t)).into_iter()
                });
                let mut lines = start.zip(end).map(|(a, b)| Scaled::line(a, b));
                let point = [0, 1, 2].map(|_| lines.next().expect("three axes"));
                Expansion::Terms(evaluator.evaluate(point).coefficients())
            }
            Form::Smooth(taylor) => taylor.expand(&self.origin, &self.direction, ends),
        }
    }
}

/// The points at t.
pub(super) fn at<N: Number>(origin: &[N; 3], direction: &[N; 3], t: &N) -> [N; 3] {
    [0, 1, 2].map(|axis| origin[axis].clone() + direction[axis].clone() * t.clone())
}
