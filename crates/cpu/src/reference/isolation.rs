//! The first root of a ray polynomial, isolated exactly.

use zeroset_expr::{Evaluator, Tape};
use zeroset_raycast::{Ray, Work};

use super::exact::Exact;
use super::search::{Found, Goal, Ladder, Place, Rung, climb};
use super::sturm::{Chain, Dyadic, Polynomial};

/// Sturm's theorem on the exact ray polynomial, for functions with rational coefficients.
pub(super) struct Isolation<'a> {
    evaluator: Evaluator<'a, Exact>,
    ray: Option<Ray>,
    roots: Option<Roots>,
    work: Work,
}

/// A ray polynomial, ready for counting.
enum Roots {
    /// It vanishes everywhere.
    All,
    /// Its distinct roots, and those of them that are multiple.
    Some { distinct: Counter, multiple: Counter },
    /// It is not exact, or too large.
    Unknown,
}

struct Counter {
    polynomial: Polynomial,
    chain: Chain,
}

/// A bound of degree^3 times bits: about a tenth of a second.
const MAX_SIZE: u64 = 10_000_000;

impl<'a> Isolation<'a> {
    pub(super) fn new(tape: &'a Tape) -> Self {
        let evaluator = tape.evaluator(&Exact::line(0.0, 0.0));
        Self { evaluator, ray: None, roots: None, work: Work::default() }
    }

    fn isolate(&mut self) -> Roots {
        let Some(ray) = self.ray else { return Roots::Unknown };
        self.work.intervals += 1;
        let line = |axis| Exact::line(f64::from(ray.origin[axis]), f64::from(ray.direction[axis]));
        let Some(p) = self.evaluator.evaluate([line(0), line(1), line(2)]).polynomial() else {
            return Roots::Unknown;
        };
        if p.is_zero() {
            return Roots::All;
        }
        if (p.degree() as u64).pow(3).saturating_mul(p.bits()) > MAX_SIZE {
            return Roots::Unknown;
        }
        let common = p.gcd(&p.derivative());
        let distinct = p.quotient(&common);
        let multiple = distinct.gcd(&common);
        Roots::Some { distinct: Counter::new(distinct), multiple: Counter::new(multiple) }
    }
}

impl Counter {
    fn new(polynomial: Polynomial) -> Self {
        let chain = Chain::new(&polynomial);
        Self { polynomial, chain }
    }

    /// The number of roots in `[a, b]`.
    fn count(&self, [a, b]: [f64; 2]) -> usize {
        let [a, b] = [a, b].map(Dyadic::new);
        usize::from(self.polynomial.sign_at(&a) == 0) + self.chain.count(&a, &b)
    }
}

/// The first of the distinct roots in a range.
fn first(distinct: &Counter, multiple: &Counter, range: [f64; 2], goal: &Goal) -> Found {
    let mut bracket = range;
    if distinct.count(bracket) == 0 {
        return Found::Nothing;
    }
    loop {
        let [a, b] = bracket;
        let alone = distinct.count(bracket) == 1;
        let place = goal.place(bracket);
        if goal.is_met(bracket) && alone && place != Place::Edge {
            break;
        }
        let m = 0.5 * a + 0.5 * b;
        if !(a < m && m < b) {
            if a < b {
                // Neighbouring doubles: the root may be one of them.
                let end = if distinct.count([a, a]) == 1 { a } else { b };
                if distinct.count([end, end]) == 1 && distinct.count([a, end]) == 1 {
                    bracket = [end, end];
                }
            }
            break;
        }
        bracket = if distinct.count([a, m]) > 0 { [a, m] } else { [m, b] };
    }
    match goal.place(bracket) {
        Place::Outside => Found::Nothing,
        Place::Edge => Found::Stuck(bracket),
        Place::Inside if distinct.count(bracket) == 1 && multiple.count(bracket) == 0 => {
            Found::Simple(bracket)
        }
        Place::Inside => Found::Multiple(bracket),
    }
}

impl Rung for Isolation<'_> {
    fn aim(&mut self, ray: Ray) {
        self.ray = Some(ray);
        self.roots = None;
        self.work = Work::default();
    }

    fn work(&self) -> Work {
        self.work
    }

    fn search(&mut self, range: [f64; 2], goal: &Goal, higher: &mut Ladder<'_>) -> Found {
        let roots = match self.roots.take() {
            Some(roots) => roots,
            None => self.isolate(),
        };
        let found = match &roots {
            Roots::Unknown => climb(higher, range, goal).unwrap_or(Found::Stuck(range)),
            Roots::Some { distinct, multiple } => first(distinct, multiple, range, goal),
            Roots::All => {
                // Every t is a root, the first where the domain begins.
                let start =
                    |inner: [f64; 2]| Some(inner[0].max(range[0])).filter(|&t| t <= inner[1]);
                match goal.clip.inner.and_then(start) {
                    Some(t) => Found::Multiple([range[0], t]),
                    None => Found::Stuck(range),
                }
            }
        };
        self.roots = Some(roots);
        found
    }
}
