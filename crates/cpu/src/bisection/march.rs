//! The traversal: [knoll2007] Section 5.3 and Appendix A, on packets of any width.

use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::interval::Flavor;
use zeroset_ia::{Interval, Kernel, Packet, Pair, Raw, Scalar, Set};
use zeroset_raycast::{Ray, Work};

use super::bundle::{self, Bundle, Few};
use super::cut::{Bounds, Cut, Cutting, Rays, Slabs};
use super::lattice::Lattice;
use super::method::Poles;
use super::monotone::{Monotone, NoTest, Piece, Refining, Test, evaluate};

/// The march starts with four pieces: where it starts with one, nearly all are bisected twice.
pub(super) const FIRST: u32 = 2;
/// Finest piece: 2^-40 of the whole.
pub(super) const MAX_DEPTH: u32 = 40;

/// A ray on which more pieces than this were dropped ends there, without an answer: in a pole, every
/// piece is.
const MOST_DROPPED: f64 = 4096.0;

/// A ray of a march.
#[derive(Clone, Copy, Debug)]
pub(super) struct Marcher {
    /// Its index in the tile.
    pub ray: usize,
    /// Its geometry.
    pub line: Ray,
    /// The range of t that contains all that count.
    pub range: [f64; 2],
}

/// What becomes of a piece that is bisected no further.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict {
    /// The ray ends here.
    Stop,
    /// There is no root before this q: the ray goes on there.
    Continue(f64),
}

/// Why a piece is bisected no further.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// It is small enough: it may hold a root.
    Small,
    /// The function is monotone on it and changes its sign, as rounded values have it.
    Crossing,
    /// The same, proven, as is that the function is continuous.
    Root,
}

/// Decides about pieces, and collects the answers.
pub(super) trait Judge {
    /// The piece between two boundaries may hold a root. `dropped` says whether an earlier piece was
    /// dropped without proof.
    fn reached(
        &mut self,
        cut: Cut,
        marcher: &Marcher,
        piece: [f64; 2],
        reason: Reason,
        dropped: bool,
    ) -> Verdict;
    /// The march has ended for the ray of this index, with or without an answer.
    fn finished(&mut self, ray: usize, dropped: bool, work: Work);
}

/// The march of a tile's rays, grouped by what they are cut by.
pub(super) struct March<'a, J> {
    pub tape: &'a Tape,
    /// The slope's tape, to end the bisection where the function is monotone.
    pub slope: Option<(&'a Tape, Refining)>,
    pub bounds: &'a Bounds,
    /// The depth of the first pieces, at most that of any ray.
    pub first: u32,
    /// Enclosures of values narrower than this count as hit.
    pub delta: f64,
    pub poles: Poles,
    pub groups: &'a [(Cut, Vec<Bundle>)],
    pub judge: &'a mut J,
}

impl<J: Judge> March<'_, J> {
    /// Marches every group, a packet at a time.
    #[inline(always)]
    fn run<R: Packet, F: Flavor>(self, zero: R) {
        const { assert!(bundle::SIZE.is_multiple_of(R::LANES), "packets divide bundles") };
        let mut evaluator = self.tape.evaluator(&Interval::<R, F>::point(zero));
        let mut monotone = self
            .slope
            .map(|(slope, refining)| Monotone::<R, F>::new(self.tape, slope, refining, zero));
        let limits = Limits { first: self.first, delta: self.delta, poles: self.poles };
        for (cut, bundles) in self.groups {
            for packet in bundles.iter().flat_map(|bundle| bundle.packets(R::LANES)) {
                match cut {
                    Cut::Slabs(_) => {
                        let lattice = Lattice::<R, Slabs>::new(zero, *cut, self.bounds, packet);
                        march(
                            &mut evaluator,
                            lattice,
                            *cut,
                            limits,
                            packet,
                            &mut NoTest,
                            self.judge,
                        );
                    }
                    Cut::Rays => {
                        let lattice = Lattice::<R, Rays>::new(zero, *cut, self.bounds, packet);
                        march(
                            &mut evaluator,
                            lattice,
                            *cut,
                            limits,
                            packet,
                            &mut monotone,
                            self.judge,
                        );
                    }
                }
            }
        }
    }
}

/// Bounded functions: raw intervals, two packets of vectors at a time.
pub(super) struct RawPairs<'a, J>(pub March<'a, J>);

impl<J: Judge> Kernel for RawPairs<'_, J> {
    type Output = ();
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) {
        self.0.run::<Pair<R>, Raw>(Pair(zero, zero));
    }
}

/// Bounded functions: raw intervals, one vector at a time.
pub(super) struct RawVectors<'a, J>(pub March<'a, J>);

impl<J: Judge> Kernel for RawVectors<'_, J> {
    type Output = ();
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) {
        self.0.run::<R, Raw>(zero);
    }
}

/// Functions with poles or partial domains: set-based intervals.
pub(super) struct SetVectors<'a, J>(pub March<'a, J>);

impl<J: Judge> Kernel for SetVectors<'_, J> {
    type Output = ();
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) {
        self.0.run::<R, Set>(zero);
    }
}

/// What ends the bisection of every ray's pieces.
#[derive(Clone, Copy, Debug)]
struct Limits {
    first: u32,
    delta: f64,
    poles: Poles,
}

/// The mask of so many lanes from the first on, at least one.
fn lanes(count: usize) -> u64 {
    u64::MAX >> (64 - count)
}

/// Marches one packet. Every ray descends into a piece only if its own function may vanish there.
#[inline(always)]
fn march<R: Packet, F: Flavor, C: Cutting>(
    evaluator: &mut Evaluator<'_, Interval<R, F>>,
    mut lattice: Lattice<R, C>,
    cut: Cut,
    Limits { first, delta, poles }: Limits,
    packet: Few<'_>,
    test: &mut impl Test<R, C>,
    judge: &mut impl Judge,
) {
    let zero = lattice.zero();
    test.restart(zero);
    let infinity = zero.splat(R::Scalar::INFINITY);
    let one = zero.splat(R::Scalar::from_f64(1.0));
    let narrow = zero.splat(R::Scalar::from_f64(delta));
    let mut last = [0_u64; MAX_DEPTH as usize + 1];
    // Run by run, since rays mostly share their depth, and one lane's store would wait for the other's.
    let mut from = 0;
    for run in packet.depths().chunk_by(|a, b| a == b) {
        last[run[0] as usize] |= lanes(run.len()) << from;
        from += run.len();
    }
    let mut alive = lanes(packet.len());
    let mut dropped = 0_u64;
    let (mut drops, most) = (zero, zero.splat(R::Scalar::from_f64(MOST_DROPPED)));
    let mut evaluations = zero;
    // The rays that descended to each depth, and the piece's index there.
    let mut descended = [0_u64; MAX_DEPTH as usize + 1];
    descended[first as usize] = alive;
    let (mut depth, mut index) = (first, 0_u64);
    let mut near = lattice.boundary(0, first);
    while alive != 0 {
        let far = lattice.boundary(index + 1, depth);
        let active = descended[depth as usize] & alive & lattice.meets(&near, &far);
        if active != 0 {
            lattice.bind(evaluator, &near, &far);
            let value = evaluate(evaluator, zero);
            evaluations = evaluations + zero.select(active, one, zero);
            let mut vanishing = active & !zero.lt(value.lo) & !value.hi.lt(zero);
            if F::SET {
                // The empty interval: the function is undefined in the whole piece.
                vanishing &= value.lo.le(value.lo);
            }
            let mut small = vanishing & last[depth as usize];
            if delta > 0.0 {
                small |= vanishing & (value.hi - value.lo).lt(narrow);
            }
            let mut unbounded = 0;
            if F::SET && (small != 0 || test.is_on()) {
                unbounded = vanishing & !(value.hi - value.lo).lt(infinity);
                if poles == Poles::Hidden {
                    // The infinite-interval rule of Section 5.4.
                    let hidden = unbounded & small;
                    dropped |= hidden;
                    vanishing &= !hidden;
                    small &= !unbounded;
                    if hidden != 0 {
                        drops = drops + zero.select(hidden, one, zero);
                        alive &= !most.lt(drops);
                    }
                }
            }
            if test.is_on() {
                // Copies, so that the originals need not be in memory.
                let (mask, ends) = (vanishing & !unbounded, [near, far]);
                let found = test.examine(&Piece { lattice, ends, mask, depth, packet });
                vanishing &= !found.empty;
                small &= vanishing & !found.crossing;
                let mut crossing = found.crossing;
                while crossing != 0 {
                    let lane = crossing.trailing_zeros();
                    crossing &= crossing - 1;
                    let piece = found.piece.map(|q| q.lane(lane as usize).to_f64());
                    let root = found.proven >> lane & 1 == 1;
                    let reason = if root { Reason::Root } else { Reason::Crossing };
                    let marcher = &packet.marcher(lane as usize);
                    match judge.reached(cut, marcher, piece, reason, dropped >> lane & 1 == 1) {
                        Verdict::Stop => alive &= !(1 << lane),
                        Verdict::Continue(q) => lattice.skip(1 << lane, q),
                    }
                }
                vanishing &= !found.crossing;
            }
            let mut reached = small;
            while reached != 0 {
                let lane = reached.trailing_zeros();
                reached &= reached - 1;
                let marcher = &packet.marcher(lane as usize);
                let piece = [near.q, far.q].map(|q| q.lane(lane as usize).to_f64());
                match judge.reached(cut, marcher, piece, Reason::Small, dropped >> lane & 1 == 1) {
                    Verdict::Stop => alive &= !(1 << lane),
                    Verdict::Continue(q) => lattice.skip(1 << lane, q),
                }
            }
            let descending = vanishing & !small & alive;
            if descending != 0 {
                depth += 1;
                index *= 2;
                descended[depth as usize] = descending;
                continue;
            }
        }
        // On to the next piece; where both halves of a piece are done, to the one after that.
        let up = index.trailing_ones().min(depth - first);
        depth -= up;
        index = (index >> up) + 1;
        if depth == first && index == 1 << first {
            break;
        }
        alive &= lattice.goes_on_at(&far);
        near = far;
    }
    for lane in 0..packet.len() {
        let intervals = evaluations.lane(lane).to_f64() as u64;
        let mut work = Work { intervals, ..Work::default() };
        work += test.work(lane);
        judge.finished(packet.ray(lane), dropped >> lane & 1 == 1, work);
    }
}
