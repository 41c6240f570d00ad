//! The search for the first root, from small t to large.

use zeroset_raycast::{Clip, Ray, Work};

use super::bernstein;
use super::curve::{Curve, Expansion};
use super::outward::{Outward, Sign};

/// What a search found in a range of t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Found {
    /// There is no root that counts.
    Nothing,
    /// The first root lies here alone, and F' does not vanish there.
    Simple([f64; 2]),
    /// The first root lies here, and may be multiple, or more than one.
    Multiple([f64; 2]),
    /// The first root does not lie before this; nothing else is known.
    Stuck([f64; 2]),
}

/// Where roots count, and how narrow their enclosures shall be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Goal {
    pub(super) clip: Clip,
    /// Of the pieces that the ray is cut into, at least.
    pub(super) resolution: f64,
    /// Of the bracket of a root, at most.
    pub(super) width: f64,
}

/// Where a root in a bracket lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    Inside,
    Outside,
    Edge,
}

impl Goal {
    pub(super) fn place(&self, [lo, hi]: [f64; 2]) -> Place {
        let Clip { outer, inner } = self.clip;
        if hi < outer[0] || outer[1] < lo {
            Place::Outside
        } else if inner.is_some_and(|inner| inner[0] <= lo && hi <= inner[1]) {
            Place::Inside
        } else {
            Place::Edge
        }
    }

    /// Is the bracket narrow enough?
    pub(super) fn is_met(&self, bracket: [f64; 2]) -> bool {
        is_within(bracket, self.width)
    }

    /// Is the piece too narrow to be cut?
    fn is_resolved(&self, piece: [f64; 2]) -> bool {
        is_within(piece, self.resolution)
    }
}

/// Is it at most so wide, or four units in the last place?
fn is_within([lo, hi]: [f64; 2], width: f64) -> bool {
    hi - lo <= width.max(4.0 * spacing(lo, hi))
}

/// The distance between the doubles near the larger of two.
fn spacing(a: f64, b: f64) -> f64 {
    let t = a.abs().max(b.abs());
    t.next_up() - t
}

/// A search in some arithmetic; where that is too coarse, it asks the rungs above.
pub(super) trait Rung {
    /// Turns to another ray.
    fn aim(&mut self, ray: Ray);
    /// The first root in the range. There is none before it that counts.
    fn search(&mut self, range: [f64; 2], goal: &Goal, higher: &mut Ladder<'_>) -> Found;
    /// What the ray has cost.
    fn work(&self) -> Work;
}

/// Rungs in the order of their cost.
pub(super) type Ladder<'a> = [Box<dyn Rung + 'a>];

/// Asks the lowest rung, if there is one.
pub(super) fn climb(ladder: &mut Ladder<'_>, range: [f64; 2], goal: &Goal) -> Option<Found> {
    let (rung, higher) = ladder.split_first_mut()?;
    Some(rung.search(range, goal, higher))
}

/// Bisection with derivative tests, then interval Newton.
pub(super) struct Bisection<'a, N: Outward> {
    curve: Curve<'a, N>,
    /// Pieces to look at for each ray.
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
    Open,
}

impl<'a, N: Outward> Bisection<'a, N> {
    pub(super) fn new(curve: Curve<'a, N>, budget: u32) -> Self {
        Self { curve, budget, left: budget }
    }

    fn judge(&mut self, piece: &mut Piece<N>) -> Verdict<N> {
        if let Some(terms) = &piece.terms {
            let verdict = verdict(terms, piece.ends);
            if !(matches!(verdict, Verdict::Open) && bernstein::is_blurred(terms)) {
                return verdict;
            }
        }
        piece.terms = None;
        match self.curve.expand(piece.ends) {
            Expansion::Free => Verdict::Free,
            Expansion::Open => Verdict::Open,
            Expansion::Terms(terms) => {
                let verdict = verdict(&terms, piece.ends);
                piece.terms = Some(terms);
                verdict
            }
        }
    }

    /// The root in a piece on which F is continuous and F' has one sign; `None` if it is not certain
    /// whether there is one.
    fn cross(&mut self, piece: &Piece<N>, slope: N, goal: &Goal) -> Option<Found> {
        let [a, b] = piece.ends;
        let rising = slope.sign() == Sign::Positive;
        let bracket = match (rising, piece.signs) {
            (true, [Sign::Positive, _] | [_, Sign::Negative])
            | (false, [Sign::Negative, _] | [_, Sign::Positive]) => return Some(Found::Nothing),
            (_, [Sign::Zero, _]) => [a, a],
            (_, [_, Sign::Zero]) => [b, b],
            (_, signs) if signs[0].opposes(signs[1]) => {
                self.refine(piece.ends, signs[0], slope, goal)
            }
            _ => return None,
        };
        Some(match goal.place(bracket) {
            Place::Outside => Found::Nothing,
            Place::Inside if goal.is_met(bracket) => Found::Simple(bracket),
            _ => Found::Stuck(bracket),
        })
    }

    /// Interval Newton, `m - F(m) / F'([a, b])`, until the bracket is narrow or stays as it is.
    fn refine(&mut self, ends: [f64; 2], sign: Sign, mut slope: N, goal: &Goal) -> [f64; 2] {
        let [mut a, mut b] = ends;
        loop {
            let done = goal.is_met([a, b]) && goal.place([a, b]) != Place::Edge;
            let m = 0.5 * a + 0.5 * b;
            if done || !(a < m && m < b) {
                return [a, b];
            }
            let before = b - a;
            let value = self.curve.value(m);
            match value.sign() {
                Sign::Zero => return [m, m],
                s if s == sign => a = m,
                s if s.opposes(sign) => b = m,
                _ => {}
            }
            let [lo, hi] = (value / slope.clone()).bounds();
            a = a.max((m - hi).next_down());
            b = b.min((m - lo).next_up());
            if !(b - a < 0.75 * before) {
                return [a, b];
            }
            if !goal.is_met([a, b]) {
                let fresh = self.curve.slope([a, b]);
                if matches!(fresh.sign(), Sign::Positive | Sign::Negative) {
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

    fn halves(self, split: Split) -> [Self; 2] {
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

    fn search(&mut self, range: [f64; 2], goal: &Goal, higher: &mut Ladder<'_>) -> Found {
        let ends = grid(range);
        let signs = ends.map(|t| self.curve.sign(t));
        let mut stack = vec![Piece { ends, signs, terms: None }];
        while let Some(mut piece) = stack.pop() {
            let [a, b] = piece.ends;
            if b < range[0] || range[1] < a {
                continue;
            }
            let stuck = [a.max(range[0]), b.min(range[1])];
            if self.left == 0 {
                return Found::Stuck(stuck);
            }
            self.left -= 1;
            let found = match self.judge(&mut piece) {
                Verdict::Free => continue,
                Verdict::Monotone(slope) => self.cross(&piece, slope, goal),
                Verdict::Open => None,
            };
            let open = match found {
                None => stuck,
                Some(Found::Stuck([lo, hi])) => [lo.max(range[0]), hi],
                Some(Found::Nothing) => continue,
                Some(found) => return found,
            };
            let split = if found.is_none() && !goal.is_resolved(piece.ends) {
                self.split_point(piece.ends)
            } else {
                None
            };
            match split {
                Some(split) if split.sign != Sign::Unknown || higher.is_empty() => {
                    let [left, right] = piece.halves(split);
                    stack.push(right);
                    stack.push(left);
                }
                _ => match climb(higher, open, goal) {
                    Some(Found::Nothing) => {}
                    Some(found @ (Found::Simple(_) | Found::Multiple(_))) => return found,
                    Some(found @ Found::Stuck(_)) => return piece.certain(goal).unwrap_or(found),
                    None => return piece.certain(goal).unwrap_or(Found::Stuck(open)),
                },
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
        let found = search.search(clip.outer, &goal, &mut []);
        eprintln!("{found:?} {:?} left {}", search.work(), search.left);
        found
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
