//! Mitchell's test: where the function is monotone along a ray, bisection with intervals can end.
//!
//! A piece on which the slope's enclosure excludes 0 holds a root if, and only if, the function's signs
//! at its ends differ; the root is then refined without intervals [mitchell1990].

use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::interval::Flavor;
use zeroset_ia::{Interval, Packet, Plain, Scalar};
use zeroset_raycast::Work;

use super::bundle::Few;
use super::cut::Rays;
use super::lattice::{Boundary, Lattice};
use super::march::MAX_DEPTH;

/// What happens to a piece on which the function is monotone and changes its sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refining {
    /// It is bisected without intervals, to the ray's last depth.
    Here,
    /// It is left to the certifying finish as it is.
    Later,
}

/// The pieces of a packet's rays between two boundaries.
pub(super) struct Piece<'a, R: Packet, C> {
    pub lattice: Lattice<R, C>,
    pub ends: [Boundary<R>; 2],
    /// The lanes in which the function may vanish and is bounded.
    pub mask: u64,
    pub depth: u32,
    pub packet: Few<'a>,
}

/// A test of pieces in which the function may vanish, before they are bisected.
pub(super) trait Test<R: Packet, C> {
    /// Is there a test?
    fn is_on(&self) -> bool;
    /// Counts work from 0, for the next packet.
    fn restart(&mut self, zero: R);
    /// Looks at the piece.
    fn examine(&mut self, piece: &Piece<'_, R, C>) -> Found<R>;
    /// The work of a lane since the last restart.
    fn work(&self, lane: usize) -> Work;
}

/// No test: every piece is bisected.
pub(super) struct NoTest;

impl<R: Packet, C> Test<R, C> for NoTest {
    #[inline(always)]
    fn is_on(&self) -> bool {
        false
    }
    #[inline(always)]
    fn restart(&mut self, _: R) {}
    #[inline(always)]
    fn examine(&mut self, piece: &Piece<'_, R, C>) -> Found<R> {
        Found::nothing(piece)
    }
    #[inline(always)]
    fn work(&self, _: usize) -> Work {
        Work::default()
    }
}

impl<R: Packet, F: Flavor> Test<R, Rays> for Option<Monotone<'_, R, F>> {
    #[inline(always)]
    fn is_on(&self) -> bool {
        self.is_some()
    }
    #[inline(always)]
    fn restart(&mut self, zero: R) {
        if let Some(monotone) = self {
            monotone.count = Count { intervals: zero, slopes: zero, points: zero };
        }
    }
    /// Out of line: most marches never come here.
    #[inline(never)]
    fn examine(&mut self, piece: &Piece<'_, R, Rays>) -> Found<R> {
        let monotone = self.as_mut().expect("the test is on");
        piece.lattice.zero().region(
            #[inline(always)]
            || monotone.examine(piece),
        )
    }
    #[inline(always)]
    fn work(&self, lane: usize) -> Work {
        self.as_ref().map_or(Work::default(), |monotone| monotone.work(lane))
    }
}

/// The test for a packet's rays.
pub(super) struct Monotone<'a, R: Packet, F: Flavor> {
    refining: Refining,
    /// Is the function continuous wherever it is evaluated?
    is_continuous: bool,
    values: Evaluator<'a, Interval<R, F>>,
    slopes: Evaluator<'a, Interval<R, F>>,
    points: Evaluator<'a, Plain<R>>,
    count: Count<R>,
}

/// Evaluations in each lane.
#[derive(Clone, Copy)]
struct Count<R> {
    intervals: R,
    slopes: R,
    points: R,
}

/// What was found about a piece, by lanes.
pub(super) struct Found<R> {
    /// There is no root.
    pub empty: u64,
    /// The function is monotone and changes its sign.
    pub crossing: u64,
    /// It surely does, and is continuous, in the piece below.
    pub proven: u64,
    /// What is left of the piece, in q.
    pub piece: [R; 2],
}

impl<R: Packet> Found<R> {
    /// Nothing was found about a piece.
    #[inline(always)]
    fn nothing<C>(piece: &Piece<'_, R, C>) -> Self {
        let [near, far] = &piece.ends;
        Self { empty: 0, crossing: 0, proven: 0, piece: [near.q, far.q] }
    }
}

/// Signs by lanes; neither where they are unknown.
#[derive(Clone, Copy)]
struct Signs {
    negative: u64,
    positive: u64,
}

impl<'a, R: Packet, F: Flavor> Monotone<'a, R, F> {
    #[inline(always)]
    pub(super) fn new(tape: &'a Tape, slope: &'a Tape, refining: Refining, zero: R) -> Self {
        let context = Interval::<R, F>::point(zero);
        Self {
            refining,
            is_continuous: tape.is_continuous(),
            values: tape.evaluator(&context),
            slopes: slope.evaluator(&context),
            points: tape.evaluator(&Plain(zero)),
            count: Count { intervals: zero, slopes: zero, points: zero },
        }
    }

    #[inline(always)]
    fn examine(&mut self, piece: &Piece<'_, R, Rays>) -> Found<R> {
        let &Piece { ref lattice, ends: [ref near, ref far], mask, .. } = piece;
        if mask == 0 {
            return Found::nothing(piece);
        }
        let zero = lattice.zero();
        lattice.bind(&mut self.slopes, near, far);
        lattice.bind_direction(&mut self.slopes);
        let slope = evaluate(&mut self.slopes, zero);
        add(&mut self.count.slopes, mask);
        let monotone = mask & (zero.lt(slope.lo) | slope.hi.lt(zero));
        if monotone == 0 {
            return Found::nothing(piece);
        }
        let (a, b) = (self.signs(lattice, near, monotone), self.signs(lattice, far, monotone));
        let mut empty = monotone & (a.negative & b.negative | a.positive & b.positive);
        let crossing = monotone & (a.negative & b.positive | a.positive & b.negative);
        // A jump, unlike a slope, may come back.
        if R::OUTWARD && !self.is_continuous {
            empty = 0;
        }
        let mut proven = if R::OUTWARD && self.is_continuous { crossing } else { 0 };
        if self.refining == Refining::Later || crossing == 0 {
            return Found { empty, crossing, proven, ..Found::nothing(piece) };
        }
        let piece = self.bisect(piece, a.negative, crossing);
        if proven != 0 {
            let [a, b] = [lattice.at(piece[0]), lattice.at(piece[1])];
            let (a, b) = (self.signs(lattice, &a, proven), self.signs(lattice, &b, proven));
            proven &= a.negative & b.positive | a.positive & b.negative;
        }
        Found { empty, crossing, proven, piece }
    }

    /// Bisects with values at points, in each lane as often as slabs would still have been.
    #[inline(always)]
    fn bisect(&mut self, piece: &Piece<'_, R, Rays>, negative: u64, crossing: u64) -> [R; 2] {
        let &Piece { ref lattice, ref ends, depth, packet, .. } = piece;
        let [mut lo, mut hi] = [ends[0].q, ends[1].q];
        let zero = lattice.zero();
        let half = zero.splat(R::Scalar::from_f64(0.5));
        let mut ending = [0_u64; MAX_DEPTH as usize + 1];
        for (lane, depth) in packet.depths().iter().enumerate() {
            ending[*depth as usize] |= 1 << lane;
        }
        let mut active = crossing;
        for done in &ending[depth as usize..] {
            active &= !done;
            if active == 0 {
                break;
            }
            let middle = half * (lo + hi);
            let value = self.point(lattice, &lattice.at(middle));
            add(&mut self.count.points, active);
            // Does the root lie beyond the middle?
            let beyond = !(value.lt(zero) ^ negative);
            lo = zero.select(active & beyond, middle, lo);
            hi = zero.select(active & !beyond, middle, hi);
        }
        [lo, hi]
    }

    /// The signs where the rays are at a boundary: proven, if the real proves anything.
    #[inline(always)]
    fn signs(&mut self, lattice: &Lattice<R, Rays>, at: &Boundary<R>, mask: u64) -> Signs {
        let zero = lattice.zero();
        if !R::OUTWARD {
            let value = self.point(lattice, at);
            add(&mut self.count.points, mask);
            return Signs { negative: mask & value.lt(zero), positive: mask & zero.lt(value) };
        }
        // Cut with the box, a point beside it would be another one.
        let mask = mask & lattice.is_inside(at);
        lattice.bind(&mut self.values, at, at);
        let value = evaluate(&mut self.values, zero);
        add(&mut self.count.intervals, mask);
        Signs { negative: mask & value.hi.lt(zero), positive: mask & zero.lt(value.lo) }
    }

    /// The rounded value at a boundary.
    #[inline(always)]
    fn point(&mut self, lattice: &Lattice<R, Rays>, at: &Boundary<R>) -> R {
        lattice.bind_point(&mut self.points, at);
        let Plain(value) = evaluate_point(&mut self.points, lattice.zero());
        value
    }

    #[inline(always)]
    fn work(&self, lane: usize) -> Work {
        let Count { intervals, slopes, points } = self.count;
        let [intervals, gradients, points] =
            [intervals, slopes, points].map(|n| n.lane(lane).to_f64() as u64);
        Work { intervals, gradients, points, nonfinite: 0 }
    }
}

/// Adds 1 in the lanes of a mask.
#[inline(always)]
fn add<R: Packet>(count: &mut R, mask: u64) {
    let zero = count.splat(R::Scalar::from_f64(0.0));
    *count = *count + zero.select(mask, zero.splat(R::Scalar::from_f64(1.0)), zero);
}

/// Out of line: the evaluator's loop is long, and called from several places.
#[inline(never)]
pub(super) fn evaluate<R: Packet, F: Flavor>(
    evaluator: &mut Evaluator<'_, Interval<R, F>>,
    zero: R,
) -> Interval<R, F> {
    zero.region(
        #[inline(always)]
        || {
            evaluator.run(
                #[inline(always)]
                |_| {},
            )
        },
    )
}

/// The same for points.
#[inline(never)]
fn evaluate_point<R: Packet>(evaluator: &mut Evaluator<'_, Plain<R>>, zero: R) -> Plain<R> {
    zero.region(
        #[inline(always)]
        || {
            evaluator.run(
                #[inline(always)]
                |_| {},
            )
        },
    )
}
