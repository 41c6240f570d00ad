//! The certified finish: from a slab that may hold a root to a proof about it.
//!
//! Bisection with natural intervals flags a few slabs before a root, however fine they are, and some
//! where there is none. The finish settles them one ray at a time, in double precision.

use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::{Decorated, Dual, Interval, Set};
use zeroset_raycast::{Clip, Ray, Work};

type I = Interval<f64, Set>;

/// What is proved about a slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Finding {
    /// It holds no root.
    Empty,
    /// A root lies in the range, and the range starts before every root at or after the slab's start.
    Root([f64; 2]),
    /// It may hold a root, or none.
    Unknown,
}

/// Settles slabs of a function.
pub(super) struct Finish<'a> {
    values: Evaluator<'a, I>,
    slopes: Evaluator<'a, Dual<I, 1>>,
    /// Only if the function is not continuous wherever it is defined.
    continuity: Option<Evaluator<'a, Decorated<f64>>>,
}

/// How many enclosures of value and slope a slab may cost.
const BUDGET: u64 = 48;

/// How many a ray may cost before a slab is accepted unsettled.
pub(super) const RAY_BUDGET: u64 = 512;

impl<'a> Finish<'a> {
    pub(super) fn new(tape: &'a Tape) -> Self {
        let zero = I::point(0.0);
        Self {
            values: tape.evaluator(&zero),
            slopes: tape.evaluator(&Dual::constant_value(zero)),
            continuity: (!tape.is_continuous()).then(|| tape.evaluator(&Decorated::new(zero))),
        }
    }

    /// Settles the slab `[t0, t1]` of a ray, with a bracket at most `width` wide.
    pub(super) fn settle(
        &mut self,
        ray: Ray,
        clip: Clip,
        slab: [f64; 2],
        width: f64,
        work: &mut Work,
    ) -> Finding {
        let slab = [slab[0].max(clip.outer[0]), slab[1].min(clip.outer[1])];
        if !(slab[0] <= slab[1]) {
            return Finding::Empty;
        }
        if let Some(bracket) = self.sign_change(ray, clip, slab, width, work) {
            return Finding::Root(bracket);
        }
        self.bisect(ray, clip, slab, width, work)
    }

    /// A range of the given width, from shortly before the slab, at whose ends the function has
    /// opposite signs.
    fn sign_change(
        &mut self,
        ray: Ray,
        clip: Clip,
        slab: [f64; 2],
        width: f64,
        work: &mut Work,
    ) -> Option<[f64; 2]> {
        let inner = clip.inner?;
        let from = (slab[0] - width / 8.0).max(inner[0]);
        // Rounded down so that the printed difference is not above the width.
        let to = (from + width).next_down().min(inner[1]);
        if !(from < to) {
            return None;
        }
        // Where the slab starts outside the surely inner part, a root there would come first.
        if from > slab[0] && self.value(ray, [slab[0], from], work).contains_zero() {
            return None;
        }
        (self.changes_sign(ray, [from, to], work)).then_some([from, to])
    }

    /// The first root in the slab, by bisection and the monotonicity test of [mitchell1990].
    fn bisect(
        &mut self,
        ray: Ray,
        clip: Clip,
        slab: [f64; 2],
        width: f64,
        work: &mut Work,
    ) -> Finding {
        let mut pieces = vec![slab];
        let mut spent = 0;
        while let Some([a, b]) = pieces.pop() {
            spent += 1;
            let point = along(ray, [a, b]);
            let d = ray.direction.as_dvec3().to_array();
            let variables: [Dual<I, 1>; 3] = std::array::from_fn(|axis| Dual {
                value: point[axis],
                tangent: [I::point(d[axis])],
            });
            let value = self.slopes.evaluate(variables);
            work.gradients += 1;
            if value.value.is_empty() || !value.value.contains_zero() {
                continue;
            }
            let monotone = !value.tangent[0].contains_zero() && !value.tangent[0].is_empty();
            if monotone && self.is_continuous(ray, [a, b]) {
                let [fa, fb] = [a, b].map(|t| self.value(ray, [t, t], work));
                if sign(fa) * sign(fb) > 0 {
                    continue;
                }
                if sign(fa) * sign(fb) < 0 {
                    let certain = clip.inner.is_some_and(|i| i[0] <= a && b <= i[1]);
                    return if certain && b - a <= width {
                        Finding::Root([a, b])
                    } else {
                        Finding::Unknown
                    };
                }
            }
            let middle = 0.5 * (a + b);
            if spent >= BUDGET || !(a < middle && middle < b) {
                return Finding::Unknown;
            }
            pieces.push([middle, b]);
            pieces.push([a, middle]);
        }
        Finding::Empty
    }

    /// Does the function, continuous on the range, have opposite signs at its ends?
    fn changes_sign(&mut self, ray: Ray, [a, b]: [f64; 2], work: &mut Work) -> bool {
        let [fa, fb] = [a, b].map(|t| self.value(ray, [t, t], work));
        sign(fa) * sign(fb) < 0 && self.is_continuous(ray, [a, b])
    }

    /// The function's enclosure over a range of t.
    fn value(&mut self, ray: Ray, range: [f64; 2], work: &mut Work) -> I {
        work.intervals += 1;
        self.values.evaluate(along(ray, range))
    }

    /// Is the function proven to be defined and continuous over a range of t?
    fn is_continuous(&mut self, ray: Ray, range: [f64; 2]) -> bool {
        match &mut self.continuity {
            None => true,
            Some(evaluator) => {
                evaluator.evaluate(along(ray, range).map(Decorated::new)).is_continuous()
            }
        }
    }
}

/// The points of a ray over a range of t.
fn along(ray: Ray, [a, b]: [f64; 2]) -> [I; 3] {
    let o = ray.origin.as_dvec3();
    let d = ray.direction.as_dvec3();
    let t = I::new(a, b);
    std::array::from_fn(|axis| I::point(o[axis]) + t * I::point(d[axis]))
}

/// The sign of all members, or 0.
fn sign(x: I) -> i32 {
    i32::from(x.lo > 0.0) - i32::from(x.hi < 0.0)
}
