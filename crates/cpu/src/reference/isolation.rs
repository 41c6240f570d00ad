//! The first root of a ray polynomial, isolated exactly.

use zeroset_raycast::{Domain, Ray, Work};

use super::exact::ExactTape;
use super::ladder::{Found, Goal, Isolated, Ladder, Place, Rung, climb, climb_with};
use super::sturm::{Chain, Point, Polynomial};

/// Sturm's theorem on the exact ray polynomial.
pub(super) struct Isolation<'a> {
    tape: &'a ExactTape,
    domain: Domain,
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
    /// It is too large.
    Unknown,
}

struct Counter {
    polynomial: Polynomial,
    chain: Chain,
}

/// A bound of degree^3 times bits: about a tenth of a second.
const MAX_SIZE: u64 = 10_000_000;

impl<'a> Isolation<'a> {
    pub(super) fn new(tape: &'a ExactTape, domain: Domain) -> Self {
        Self { tape, domain, ray: None, roots: None, work: Work::default() }
    }

    fn isolate(&mut self, ray: Ray) -> Roots {
        self.work.intervals += 1;
        let p = self.tape.polynomial(ray);
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
    fn count(&self, a: &Point, b: &Point) -> usize {
        if a > b {
            return 0;
        }
        usize::from(self.polynomial.sign_at(a) == 0) + self.chain.count(a, b)
    }
}

/// The part of a ray in a box, exactly; doubles bound the part that is asked for.
struct Span([Point; 2]);

impl Span {
    fn new(domain: &Domain, ray: Ray, [lo, hi]: [f64; 2]) -> Self {
        let [mut lo, mut hi] = [Point::new(lo), Point::new(hi)];
        for axis in 0..3 {
            let direction = ray.direction[axis];
            if direction == 0.0 {
                continue;
            }
            let origin = Point::new(f64::from(ray.origin[axis]));
            let at = |bound: f64| {
                Point::new(bound).difference_over(&origin, &Point::new(f64::from(direction)))
            };
            let (enter, leave) = (at(domain.min[axis]), at(domain.max[axis]));
            let (enter, leave) = if direction > 0.0 { (enter, leave) } else { (leave, enter) };
            lo = lo.max(enter);
            hi = hi.min(leave);
        }
        Self([lo, hi])
    }

    /// The number of roots in the part of the bracket that counts.
    fn count(&self, counter: &Counter, [a, b]: [f64; 2]) -> usize {
        let [lo, hi] = &self.0;
        counter.count(lo.max(&Point::new(a)), hi.min(&Point::new(b)))
    }
}

/// The first of the distinct roots in a bracket, which is narrowed.
fn first(
    [distinct, multiple]: [&Counter; 2],
    span: &Span,
    mut bracket: [f64; 2],
    place: impl Fn([f64; 2]) -> Place,
    goal: &Goal,
) -> Found {
    let count = |bracket| span.count(distinct, bracket);
    if count(bracket) == 0 {
        return Found::Nothing;
    }
    while !(goal.is_met(bracket) && count(bracket) == 1 && place(bracket) != Place::Edge) {
        let [a, b] = bracket;
        let m = 0.5 * a + 0.5 * b;
        let parts = if a < m && m < b { [[a, m], [m, b]] } else { [[a, a], [b, b]] };
        match parts.into_iter().find(|&part| part != bracket && count(part) > 0) {
            Some(part) => bracket = part,
            None => break,
        }
    }
    match place(bracket) {
        Place::Outside => Found::Nothing,
        Place::Edge => Found::Stuck(bracket),
        Place::Inside if count(bracket) == 1 && span.count(multiple, bracket) == 0 => {
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

    fn narrow(&mut self, root: Isolated, goal: &Goal, higher: &mut Ladder<'_>) -> Found {
        match self.search(root.bracket, goal, &mut []) {
            Found::Stuck(_) => climb_with(higher, root, goal),
            found => found,
        }
    }

    fn search(&mut self, range: [f64; 2], goal: &Goal, higher: &mut Ladder<'_>) -> Found {
        let Some(ray) = self.ray else { return Found::Stuck(range) };
        let roots = match self.roots.take() {
            Some(roots) => roots,
            None => self.isolate(ray),
        };
        let found = match &roots {
            Roots::Unknown => climb(higher, range, goal).unwrap_or(Found::Stuck(range)),
            Roots::Some { distinct, multiple } => {
                let span = Span::new(&self.domain, ray, range);
                // Of a box the span is exact; whether a ball is left has been enclosed.
                let place = |bracket| match self.domain.ball {
                    None => Place::Inside,
                    Some(_) => goal.place(bracket),
                };
                first([distinct, multiple], &span, range, place, goal)
            }
            Roots::All => {
                // Every t is a root, the first where the domain begins.
                let Span([start, end]) = Span::new(&self.domain, ray, range);
                let begins = goal.clip.inner.map_or(range[1], |inner| inner[0].max(range[0]));
                let bracket = [range[0], begins];
                if start > end && self.domain.ball.is_none() {
                    Found::Nothing
                } else if goal.is_met(bracket) && begins <= range[1] {
                    Found::Multiple(bracket)
                } else {
                    Found::Stuck(range)
                }
            }
        };
        self.roots = Some(roots);
        found
    }
}
