//! The certified finish: from a slab that may hold a root to a proof about it.
//!
//! Bisection with natural intervals flags a few slabs before a root, however fine they are, and some
//! where there is none. The finish settles them one ray at a time, in double precision.

use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::{Dual, Interval, Set};
use zeroset_raycast::{Certifier, Clip, Ray, Work};

type I = Interval<f64, Set>;

/// What is proved from a slab on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Finding {
    /// There is no root from the slab's start to this t.
    EmptyUntil(f64),
    /// A root lies in the range, and the range starts before every root at or after the slab's start.
    Root([f64; 2]),
    /// There is no root before the range; it may hold one.
    Unknown([f64; 2]),
    /// A root was found in the range; nothing is proved.
    Unproven([f64; 2]),
}

/// Settles slabs of a function.
pub(super) struct Finish<'a> {
    certifier: Certifier<'a>,
    slopes: Evaluator<'a, Dual<I, 1>>,
}

/// A piece of a ray, by the enclosures of value and slope.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Piece {
    Empty,
    /// The function is continuous and monotone, with opposite signs at the ends.
    Crossing,
    Undecided,
}

/// How many pieces are tried for a slab, before the march goes on where they ended.
const PIECES: u32 = 48;
/// A piece this many slabs long without a root: back to the march. Eight times as many at each return,
/// for then the march's enclosures tell little.
const FAR: f64 = 64.0;
/// The shortest piece, as a part of the bracket's width.
const FINEST: f64 = 1.0 / 64.0;

/// How many enclosures of value and slope a ray may cost before a slab is accepted unsettled.
pub(super) const RAY_BUDGET: u64 = 256;

impl<'a> Finish<'a> {
    pub(super) fn new(tape: &'a Tape) -> Self {
        let zero = I::point(0.0);
        Self {
            certifier: Certifier::new(tape),
            slopes: tape.evaluator(&Dual::constant_value(zero)),
        }
    }

    /// Proves what it can from `start`, the start of a slab, on, piece by piece along the ray. A piece
    /// grows after a proof and shrinks after a failure. A bracket is at most `width` wide. The march
    /// of this ray has come back `returns` times.
    pub(super) fn settle(
        &mut self,
        ray: Ray,
        clip: Clip,
        start: f64,
        slab: f64,
        returns: i32,
        width: f64,
        work: &mut Work,
    ) -> Finding {
        let far = FAR * slab * 8.0_f64.powi(returns);
        let end = clip.outer[1];
        let mut from = start.max(clip.outer[0]);
        let mut step = 4.0 * slab;
        let mut tried = f64::NEG_INFINITY;
        for _ in 0..PIECES {
            let to = (from + step).min(end);
            match self.examine(ray, [from, to], work) {
                Piece::Empty if to >= end => return Finding::EmptyUntil(f64::INFINITY),
                Piece::Empty => {
                    from = to;
                    step *= 2.0;
                    if step > far {
                        break;
                    }
                }
                Piece::Crossing => return self.narrow(ray, clip, [from, to], width, work),
                Piece::Undecided => {
                    if step <= width && tried != from {
                        tried = from;
                        if let Some(bracket) = self.sign_change(ray, clip, from, width, work) {
                            return Finding::Root(bracket);
                        }
                    }
                    if step <= FINEST * width || !(from < from + 0.25 * step) {
                        return Finding::Unknown([from, to]);
                    }
                    step *= 0.25;
                }
            }
        }
        Finding::EmptyUntil(from)
    }

    /// Looks at a piece: natural enclosure, mean value form, monotonicity [mitchell1990].
    fn examine(&mut self, ray: Ray, range: [f64; 2], work: &mut Work) -> Piece {
        let point = ray.over(range);
        let d = ray.direction.as_dvec3().to_array();
        let variables: [Dual<I, 1>; 3] =
            std::array::from_fn(|axis| Dual { value: point[axis], tangent: [I::point(d[axis])] });
        let Dual { value, tangent: [slope] } = self.slopes.evaluate(variables);
        work.gradients += 1;
        if value.is_empty() || !value.contains_zero() {
            return Piece::Empty;
        }
        // What follows rests on the mean value theorem.
        if !slope.is_bounded_by(f64::MAX) || !self.certifier.is_continuous(ray, range) {
            return Piece::Undecided;
        }
        if slope.lo > 0.0 || slope.hi < 0.0 {
            let [a, b] = range.map(|t| self.certifier.sign(ray, t, work));
            return match a * b {
                1 => Piece::Empty,
                -1 => Piece::Crossing,
                _ => Piece::Undecided,
            };
        }
        let middle = 0.5 * (range[0] + range[1]);
        let offset = I::new(range[0], range[1]) - I::point(middle);
        let centred = self.certifier.value(ray, [middle, middle], work) + slope * offset;
        if centred.contains_zero() { Piece::Undecided } else { Piece::Empty }
    }

    /// Narrows a range at whose ends a monotone function has opposite signs.
    fn narrow(
        &mut self,
        ray: Ray,
        clip: Clip,
        [mut a, mut b]: [f64; 2],
        width: f64,
        work: &mut Work,
    ) -> Finding {
        let before = self.certifier.sign(ray, a, work);
        while b - a > width {
            let middle = 0.5 * (a + b);
            match before * self.certifier.sign(ray, middle, work) {
                1 => a = middle,
                -1 => b = middle,
                // The root is too near the middle: put the middle off it.
                _ => {
                    let near = [middle - 0.25 * width, middle + 0.25 * width];
                    let near = [near[0].max(a), near[1].min(b)];
                    if !self.certifier.changes_sign(ray, near, work) {
                        return Finding::Unknown([a, b]);
                    }
                    [a, b] = near;
                    break;
                }
            }
        }
        match clip.inner {
            Some([lo, hi]) if lo <= a && b <= hi => Finding::Root([a, b]),
            _ => Finding::Unknown([a, b]),
        }
    }

    /// A range of the given width, from shortly before `start`, at whose ends the function has
    /// opposite signs; there is no root from the slab's start to `start`.
    fn sign_change(
        &mut self,
        ray: Ray,
        clip: Clip,
        start: f64,
        width: f64,
        work: &mut Work,
    ) -> Option<[f64; 2]> {
        let inner = clip.inner?;
        let from = (start - width / 8.0).max(inner[0]);
        // Rounded down so that the printed difference is not above the width.
        let to = (from + width).next_down().min(inner[1]);
        if !(from < to) {
            return None;
        }
        // Where the slab starts outside the surely inner part, a root there would come first.
        if from > start && self.certifier.value(ray, [start, from], work).contains_zero() {
            return None;
        }
        (self.certifier.changes_sign(ray, [from, to], work)).then_some([from, to])
    }
}
