//! The search for the first root, from small t to large.

use zeroset_raycast::{Ray, Work};

use super::bernstein;
use super::curve::{Curve, Expansion};
use super::ladder::{Found, Goal, Isolated, Ladder, Place, Rung, climb, climb_with, spacing};
use super::outward::{Outward, Sign};

/// Bisection with derivative tests, then interval Newton.
pub(super) struct Bisection<'a, N: Outward> {
    curve: Curve<'a, N>,
    /// Pieces to look at for each ray, weighted by the cost of expansions.
    budget: u32,
    left: u32,
}

/// A closed piece of the ray.
struct Piece<N> {
    ends: [f64; 2],
    /// Of F at the ends.
    signs: [Sign; 2],
    /// Encloses F, which is then continuous here.
    terms: Option<Vec<N>>,
}

enum Verdict<N> {
    Free,
    /// F' is enclosed, and has one sign.
    Monotone(N),
    /// Smaller pieces may tell.
    Open,
    /// Rounding hides F, and will on smaller pieces.
    Blurred,
}

enum Step {
    /// Nothing, or the first root.
    Done(Found),
    /// Its left part, then its right part.
    Cut(Split),
    /// What the rungs above say.
    Ask,
}

impl<'a, N: Outward> Bisection<'a, N> {
    pub(super) fn new(curve: Curve<'a, N>, budget: u32) -> Self {
        Self { curve, budget, left: budget }
    }

    /// What to do with the next piece.
    fn step(&mut self, piece: &mut Piece<N>, goal: &Goal, higher: &mut Ladder<'_>) -> Step {
        if self.left == 0 {
            return Step::Ask;
        }
        self.left -= 1;
        match self.judge(piece) {
            Verdict::Free => return Step::Done(Found::Nothing),
            Verdict::Monotone(slope) => {
                if let Some(found) = self.cross(piece, &slope, goal, higher) {
                    return Step::Done(found);
                }
            }
            Verdict::Blurred if !higher.is_empty() => return Step::Ask,
            Verdict::Blurred | Verdict::Open => {}
        }
        if goal.is_resolved(piece.ends) {
            return Step::Ask;
        }
        match self.split_point(piece.ends) {
            Some(split) if split.sign != Sign::Unknown || higher.is_empty() => Step::Cut(split),
            _ => Step::Ask,
        }
    }

    fn judge(&mut self, piece: &mut Piece<N>) -> Verdict<N> {
        if let Some(terms) = &piece.terms {
            let verdict = verdict(terms, piece.ends);
            if !(matches!(verdict, Verdict::Open) && bernstein::is_blurred(terms)) {
                return verdict;
            }
        }
        piece.terms = None;
        self.left = self.left.saturating_sub(self.curve.cost());
        match self.curve.expand(piece.ends) {
            Expansion::Free => Verdict::Free,
            Expansion::Open => Verdict::Open,
            Expansion::Terms(terms) => {
                let blurred = self.curve.is_polynomial() && bernstein::is_blurred(&terms);
                let verdict = match verdict(&terms, piece.ends) {
                    Verdict::Open if blurred => Verdict::Blurred,
                    verdict => verdict,
                };
                piece.terms = Some(terms);
                verdict
            }
        }
    }

    /// The root in a piece on which F is continuous and F' has one sign; `None` if it is not certain
    /// whether there is one.
    fn cross(
        &mut self,
        piece: &Piece<N>,
        slope: &N,
        goal: &Goal,
        higher: &mut Ladder<'_>,
    ) -> Option<Found> {
        let [a, b] = piece.ends;
        let slope = slope.bounds();
        if !excludes_zero(slope) {
            return None;
        }
        let rising = slope[0] > 0.0;
        let bracket = match (rising, piece.signs) {
            (true, [Sign::Positive, _] | [_, Sign::Negative])
            | (false, [Sign::Negative, _] | [_, Sign::Positive]) => return Some(Found::Nothing),
            (_, [Sign::Zero, _]) => [a, a],
            (_, [_, Sign::Zero]) => [b, b],
            (_, signs) if signs[0].opposes(signs[1]) => piece.ends,
            _ => return None,
        };
        Some(self.narrow(Isolated { bracket, slope }, goal, higher))
    }

    /// Interval Newton, `m - F(m) / F'([a, b])`, until the bracket is narrow or stays as it is.
    fn refine(&mut self, root: Isolated, goal: &Goal) -> Isolated {
        let Isolated { bracket: [mut a, mut b], mut slope } = root;
        let rising = slope[0] > 0.0;
        loop {
            let root = Isolated { bracket: [a, b], slope };
            let m = 0.5 * a + 0.5 * b;
            if root.found(goal).is_some() || !(a < m && m < b) {
                return root;
            }
            let before = b - a;
            let value = self.curve.value(m);
            match value.sign() {
                Sign::Zero => return Isolated { bracket: [m, m], ..root },
                Sign::Negative if rising => a = m,
                Sign::Positive if !rising => a = m,
                Sign::Negative | Sign::Positive => b = m,
                Sign::Unknown | Sign::Undefined => {}
            }
            let [lo, hi] = (value / self.curve.between(slope)).bounds();
            a = a.max((m - hi).next_down());
            b = b.min((m - lo).next_up());
            if !(b - a < 0.75 * before) {
                return Isolated { bracket: [a, b], ..root };
            }
            if !goal.is_met([a, b]) {
                let fresh = self.curve.slope([a, b]).bounds();
                if excludes_zero(fresh) {
                    slope = fresh;
                }
            }
        }
    }

    /// A double inside the piece, in eighths of it, at which the sign of F is certain.
    fn split_point(&mut self, [a, b]: [f64; 2]) -> Option<Split> {
        let mut fallback = None;
        for eighths in [4, 3, 5] {
            let part = (b - a) * f64::from(eighths) / 8.0;
            let t = a + part;
            // Terms are split at u, so t has to be exact.
            if !(a < t && t < b && t - a == part && b - t == (b - a) - part) {
                break;
            }
            let split = Split { t, eighths, sign: self.curve.sign(t) };
            if split.sign != Sign::Unknown {
                return Some(split);
            }
            fallback = fallback.or(Some(split));
        }
        fallback
    }
}

fn excludes_zero([lo, hi]: [f64; 2]) -> bool {
    lo > 0.0 || hi < 0.0
}

#[derive(Clone, Copy)]
struct Split {
    t: f64,
    eighths: u8,
    sign: Sign,
}

fn verdict<N: Outward>(terms: &[N], [a, b]: [f64; 2]) -> Verdict<N> {
    if matches!(bernstein::sign(terms), Sign::Positive | Sign::Negative) {
        return Verdict::Free;
    }
    match bernstein::slope(terms) {
        Some(slope) => Verdict::Monotone(slope.clone() / (slope.exact(b) - slope.exact(a))),
        None => Verdict::Open,
    }
}

impl<N: Outward> Piece<N> {
    /// The root that a piece too narrow to split is known to contain.
    fn certain(&self, goal: &Goal) -> Option<Found> {
        let [a, b] = self.ends;
        let bracket = match self.signs {
            [Sign::Zero, _] => [a, a],
            [_, Sign::Zero] => [a, b],
            [s, r] if s.opposes(r) && self.terms.is_some() => [a, b],
            _ => return None,
        };
        let certain = goal.is_met(bracket) && goal.place(bracket) == Place::Inside;
        certain.then_some(Found::Multiple(bracket))
    }

    fn cut(self, split: Split) -> [Self; 2] {
        let [a, b] = self.ends;
        let [left, right] = match self.terms {
            Some(terms) => bernstein::split(terms, split.eighths).map(Some),
            None => [None, None],
        };
        [
            Self { ends: [a, split.t], signs: [self.signs[0], split.sign], terms: left },
            Self { ends: [split.t, b], signs: [split.sign, self.signs[1]], terms: right },
        ]
    }
}

/// The smallest range around another with room to be halved exactly many times: its ends are
/// multiples of an eighth of a power of two below its width.
fn grid([lo, hi]: [f64; 2]) -> [f64; 2] {
    let width = (hi - lo).max(64.0 * spacing(lo, hi)).max(f64::MIN_POSITIVE * 1e16);
    let exponent = (width.to_bits() >> 52 & 0x7ff) as i32 - 1023;
    let cell = (f64::from(exponent) - 3.0).exp2();
    let a = (lo / cell).floor() * cell;
    let b = (hi / cell).ceil() * cell;
    if a < b { [a, b] } else { [a, a + cell] }
}

impl<N: Outward> Rung for Bisection<'_, N> {
    fn aim(&mut self, ray: Ray) {
        self.curve.aim(ray);
        self.left = self.budget;
    }

    fn work(&self) -> Work {
        self.curve.work
    }

    fn narrow(&mut self, root: Isolated, goal: &Goal, higher: &mut Ladder<'_>) -> Found {
        let root = self.refine(root, goal);
        root.found(goal).unwrap_or_else(|| climb_with(higher, root, goal))
    }

    fn search(&mut self, range: [f64; 2], goal: &Goal, higher: &mut Ladder<'_>) -> Found {
        let ends = grid(range);
        let signs = ends.map(|t| self.curve.sign(t));
        let mut stack = vec![Piece { ends, signs, terms: None }];
        while let Some(mut piece) = stack.pop() {
            let [a, b] = piece.ends;
            if b < range[0] || range[1] < a {
                continue;
            }
            match self.step(&mut piece, goal, higher) {
                Step::Done(Found::Nothing) => {}
                Step::Done(found) => return found,
                Step::Cut(split) => {
                    let [left, right] = piece.cut(split);
                    stack.push(right);
                    stack.push(left);
                }
                Step::Ask => {
                    let open = [a.max(range[0]), b.min(range[1])];
                    match climb(higher, open, goal).unwrap_or(Found::Stuck(open)) {
                        Found::Nothing => {}
                        stuck @ Found::Stuck(_) => return piece.certain(goal).unwrap_or(stuck),
                        found => return found,
                    }
                }
            }
        }
        Found::Nothing
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use zeroset_expr::{Instruction, Op, Tape};
    use zeroset_ia::{BigInterval, Constant};
    use zeroset_raycast::Domain;

    use super::super::ladder::is_within;
    use super::super::outward::Double;
    use super::*;

    /// `x^2 + y^2 + z^2 - 1`
    fn sphere() -> Tape {
        let ops =
            [Op::Sqr(0), Op::Sqr(1), Op::Sqr(2), Op::Add(3, 4), Op::Add(6, 5), Op::Offset(7, 0)];
        let instructions =
            ops.iter().enumerate().map(|(i, &op)| Instruction { op, out: i as u32 + 3 }).collect();
        Tape::new(instructions, vec![Constant::from_f64(-1.0)], 8)
    }

    fn search<N: Outward>(context: &N, origin: Vec3, direction: Vec3) -> Found {
        let tape = sphere();
        let ray = Ray::new(origin, direction);
        let domain = Domain::new(DVec3::splat(-2.0), DVec3::splat(2.0)).unwrap();
        let clip = domain.clip(ray, [0.0, f64::INFINITY]).unwrap();
        let mut search = Bisection::new(Curve::new(&tape, Some(2), context), 1000);
        search.aim(ray);
        let goal = Goal { clip, resolution: 1e-12, width: 1e-12 };
        search.search(clip.outer, &goal, &mut [])
    }

    fn assert_sphere<N: Outward>(context: &N) {
        let found = search(context, Vec3::new(-3.0, 0.0, 0.0), Vec3::X);
        let Found::Simple([lo, hi]) = found else { panic!("{found:?}") };
        assert!(lo <= 2.0 && 2.0 <= hi && hi - lo <= 1e-12);
        // Beside the sphere, and past it.
        let d = Vec3::new(1.0, 0.1, 0.0);
        assert_eq!(search(context, Vec3::new(-3.0, 1.125, 0.0), d), Found::Nothing);
        assert_eq!(search(context, Vec3::new(1.5, 0.0, 0.0), d), Found::Nothing);
        // From inside.
        let found = search(context, Vec3::ZERO, Vec3::new(0.0, 0.0, -0.25));
        let Found::Simple([lo, hi]) = found else { panic!("{found:?}") };
        assert!(lo <= 4.0 && 4.0 <= hi);
        // A tangent: F >= 0 with a double root at 2.
        let found = search(context, Vec3::new(-2.0, 1.0, 0.0), Vec3::X);
        let Found::Stuck([lo, hi]) = found else { panic!("{found:?}") };
        assert!(lo <= 2.0 && 2.0 - 1e-7 <= hi && hi - lo <= 1e-11);
    }

    #[test]
    fn a_sphere_is_found_in_doubles() {
        assert_sphere(&Double::point(0.0));
    }

    #[test]
    fn a_sphere_is_found_in_longer_numbers() {
        assert_sphere(&BigInterval::from_f64(0.0, 128));
    }

    #[test]
    fn grids_can_be_halved() {
        for range in [[0.0, 4.0], [1e6, 1e6 + 3.0], [-3.7, 9.1], [5.0, 5.0], [0.0, 0.0]] {
            let [mut a, b] = grid(range);
            assert!(a <= range[0] && range[1] <= b && a < b, "{range:?}");
            while !is_within([a, b], 1e-12) {
                let m = a + (b - a) / 2.0;
                assert!(m - a == b - m && a < m, "{range:?}: {a} {m} {b}");
                a = m;
            }
        }
    }
}
