//! The function along a ray, F(t) = f(o + t d).

use glam::Vec3;
use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::Dual;
use zeroset_raycast::{Ray, Work};

use super::bernstein::Scaled;
use super::outward::{Double, Outward, Sign};
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

/// The points of a ray, in the arithmetic of `N`.
#[derive(Clone, Debug)]
pub(super) struct Line<N> {
    origin: [N; 3],
    pub(super) direction: [N; 3],
}

impl<N: Outward> Line<N> {
    pub(super) fn new(context: &N, ray: Ray) -> Self {
        let exact = |v: Vec3| v.to_array().map(|x| context.exact(f64::from(x)));
        Self { origin: exact(ray.origin), direction: exact(ray.direction) }
    }

    /// A value of t.
    pub(super) fn exact(&self, t: f64) -> N {
        self.origin[0].exact(t)
    }

    /// The points at t.
    pub(super) fn at(&self, t: N) -> [N; 3] {
        [0, 1, 2].map(|axis| self.origin[axis].clone() + self.direction[axis].clone() * t.clone())
    }
}

/// F along one ray, in the arithmetic of `N`.
pub(super) struct Curve<'a, N: Outward> {
    line: Line<N>,
    coarse: Line<Double>,
    values: Evaluator<'a, N>,
    slopes: Evaluator<'a, Dual<N, 1>>,
    form: Form<'a, N>,
    degree: u32,
    /// What the ray has cost.
    pub(super) work: Work,
}

enum Form<'a, N: Outward> {
    /// The Bernstein form of the ray polynomial.
    Polynomial(Evaluator<'a, Scaled<N>>),
    /// A Taylor expansion with its remainder.
    Smooth(Taylor<'a, N>),
}

impl<'a, N: Outward> Curve<'a, N> {
    pub(super) fn new(tape: &'a Tape, degree: Option<u32>, context: &N) -> Self {
        let zero = context.exact(0.0);
        let form = if degree.is_some_and(|d| d <= MAX_DEGREE) {
            Form::Polynomial(tape.evaluator(&Scaled::line(zero.clone(), zero.clone())))
        } else {
            Form::Smooth(Taylor::new(tape, context))
        };
        let nowhere = Ray::new(Vec3::ZERO, Vec3::ZERO);
        Self {
            line: Line::new(context, nowhere),
            coarse: Line::new(&Double::point(0.0), nowhere),
            values: tape.evaluator(context),
            slopes: tape.evaluator(&Dual::constant_value(zero)),
            form,
            degree: degree.unwrap_or(0),
            work: Work::default(),
        }
    }

    /// Turns to another ray.
    pub(super) fn aim(&mut self, ray: Ray) {
        self.line = Line::new(&self.line.origin[0], ray);
        self.coarse = Line::new(&self.coarse.origin[0], ray);
        self.work = Work::default();
    }

    /// An interval in the arithmetic of the curve.
    pub(super) fn between(&self, [lo, hi]: [f64; 2]) -> N {
        self.line.exact(0.0).between(lo, hi)
    }

    /// F(t).
    pub(super) fn value(&mut self, t: f64) -> N {
        self.work.intervals += 1;
        let value = self.values.evaluate(self.line.at(self.line.exact(t)));
        self.work.nonfinite += u64::from(!value.is_bounded());
        value
    }

    /// The sign of F(t): it is 0 only where F is certainly defined.
    pub(super) fn sign(&mut self, t: f64) -> Sign {
        let sign = self.value(t).sign();
        match &mut self.form {
            Form::Smooth(taylor) if sign == Sign::Zero => {
                if taylor.is_defined(&self.coarse, t) {
                    sign
                } else {
                    Sign::Unknown
                }
            }
            _ => sign,
        }
    }

    /// All slopes of F between two t.
    pub(super) fn slope(&mut self, ends: [f64; 2]) -> N {
        self.work.intervals += 1;
        slope(&mut self.slopes, &self.line, ends)
    }

    /// Do expansions have no remainder?
    pub(super) fn is_polynomial(&self) -> bool {
        matches!(self.form, Form::Polynomial(_))
    }

    /// What an expansion costs, in pieces that are merely split.
    pub(super) fn cost(&self) -> u32 {
        match self.form {
            Form::Polynomial(_) => 1 + self.degree * self.degree / 32,
            Form::Smooth(_) => 1,
        }
    }

    /// What is known of F between two t.
    pub(super) fn expand(&mut self, ends: [f64; 2]) -> Expansion<N> {
        self.work.intervals += 1;
        let Self { line, coarse, slopes, .. } = self;
        match &mut self.form {
            Form::Polynomial(evaluator) => {
                let [start, end] = ends.map(|t| line.at(line.exact(t)).into_iter());
                let mut lines = start.zip(end).map(|(a, b)| Scaled::line(a, b));
                let point = [0, 1, 2].map(|_| lines.next().expect("three axes"));
                Expansion::Terms(evaluator.evaluate(point).coefficients())
            }
            Form::Smooth(taylor) => taylor.expand(coarse, line, ends, || slope(slopes, line, ends)),
        }
    }
}

fn slope<N: Outward>(
    evaluator: &mut Evaluator<'_, Dual<N, 1>>,
    line: &Line<N>,
    [a, b]: [f64; 2],
) -> N {
    let mut directions = line.direction.iter();
    let point = line.at(line.exact(a).between(a, b)).map(|value| {
        let tangent = [directions.next().expect("three axes").clone()];
        Dual { value, tangent }
    });
    let [slope] = evaluator.evaluate(point).tangent;
    slope
}
