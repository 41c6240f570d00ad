//! The traversal: [knoll2007] Section 5.3 and Appendix A, on packets of any width.

use zeroset_expr::{Evaluator, Tape};
use zeroset_ia::interval::Flavor;
use zeroset_ia::{Interval, Kernel, Packet, Pair, Raw, Scalar, Set};
use zeroset_raycast::{Ray, Work};

use super::slab::{Axis, Bounds, Lattice};

/// The march starts with four slabs: where it starts with one, nearly all are bisected twice.
pub(super) const FIRST: u32 = 2;
/// Finest slab: 2^-40 of the domain.
pub(super) const MAX_DEPTH: u32 = 40;

/// A ray of a march.
#[derive(Clone, Copy, Debug)]
pub(super) struct Marcher {
    /// Its index in the tile.
    pub ray: usize,
    /// Its geometry.
    pub line: Ray,
    /// The range of t that contains all that count.
    pub range: [f64; 2],
    /// Slabs are bisected this often before they count as hit.
    pub depth: u32,
}

/// What becomes of a slab at a ray's last depth in which the function may vanish.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict {
    /// The ray ends here.
    Stop,
    /// There is no root before this q: the ray goes on there.
    Continue(f64),
}

/// Decides about slabs, and collects the answers.
pub(super) trait Judge {
    /// The slab between two boundaries, at the marcher's last depth, may hold a root. `dropped` says
    /// whether an earlier slab was dropped without proof.
    fn reached(&mut self, axis: Axis, marcher: &Marcher, slab: [f64; 2], dropped: bool) -> Verdict;
    /// The march has ended for a ray, with or without an answer.
    fn finished(&mut self, marcher: &Marcher, dropped: bool, work: Work);
}

/// The march of a tile's rays, grouped by axis.
pub(super) struct March<'a, J> {
    pub tape: &'a Tape,
    pub bounds: &'a Bounds,
    /// The depth of the first slabs, at most that of any ray.
    pub first: u32,
    pub groups: &'a [(Axis, Vec<Marcher>)],
    pub judge: &'a mut J,
}

impl<J: Judge> March<'_, J> {
    /// Marches every group, a packet at a time.
    #[inline(always)]
    fn run<R: Packet, F: Flavor>(self, zero: R) {
        let mut evaluator = self.tape.evaluator(&Interval::<R, F>::point(zero));
        for (axis, marchers) in self.groups {
            for packet in marchers.chunks(R::LANES) {
                let lattice = Lattice::new(zero, *axis, self.bounds, packet);
                march(&mut evaluator, lattice, *axis, self.first, packet, self.judge);
            }
        }
    }
}

/// Bounded functions: raw intervals, two packets of sixteen at a time.
pub(super) struct RawMarch<'a, J>(pub March<'a, J>);

impl<J: Judge> Kernel for RawMarch<'_, J> {
    type Output = ();
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) {
        self.0.run::<Pair<R>, Raw>(Pair(zero, zero));
    }
}

/// Functions with poles or partial domains: set-based intervals.
pub(super) struct SetMarch<'a, J>(pub March<'a, J>);

impl<J: Judge> Kernel for SetMarch<'_, J> {
    type Output = ();
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) {
        self.0.run::<R, Set>(zero);
    }
}

/// Marches one packet. Every ray descends into a slab only if its own function may vanish there.
#[inline(always)]
fn march<R: Packet, F: Flavor>(
    evaluator: &mut Evaluator<'_, Interval<R, F>>,
    mut lattice: Lattice<R>,
    axis: Axis,
    first: u32,
    packet: &[Marcher],
    judge: &mut impl Judge,
) {
    let zero = lattice.zero();
    let infinity = zero.splat(R::Scalar::INFINITY);
    let one = zero.splat(R::Scalar::from_f64(1.0));
    let mut last = [0_u64; MAX_DEPTH as usize + 1];
    for (lane, marcher) in packet.iter().enumerate() {
        last[marcher.depth as usize] |= 1 << lane;
    }
    let mut alive = if packet.len() == 64 { u64::MAX } else { (1 << packet.len()) - 1 };
    let mut dropped = 0_u64;
    let mut evaluations = zero;
    // The rays that descended to each depth, and the slab's index there.
    let mut descended = [0_u64; MAX_DEPTH as usize + 1];
    descended[first as usize] = alive;
    let (mut depth, mut index) = (first, 0_u64);
    let mut width = lattice.width(first);
    let mut near = lattice.boundary(0, width);
    let [k, u, v] = axis.all();
    while alive != 0 {
        let far = lattice.boundary(index + 1, width);
        let active = descended[depth as usize] & alive & lattice.meets(&near, &far);
        if active != 0 {
            let boxes = lattice.boxes(&near, &far);
            evaluator.bind(k, boxes[0]);
            evaluator.bind(u, boxes[1]);
            evaluator.bind(v, boxes[2]);
            let value = evaluator.run(
                #[inline(always)]
                |_| {},
            );
            evaluations = evaluations + zero.select(active, one, zero);
            let mut vanishing = active & !zero.lt(value.lo) & !value.hi.lt(zero);
            if F::SET {
                // The empty interval: the function is undefined in the whole slab.
                vanishing &= value.lo.le(value.lo);
            }
            let mut reached = vanishing & last[depth as usize];
            if reached != 0 {
                if F::SET {
                    // The infinite-interval rule of Section 5.4.
                    let unbounded = !(value.hi - value.lo).lt(infinity) & reached;
                    dropped |= unbounded;
                    reached &= !unbounded;
                }
                let slab = [near.q.to_f64(), far.q.to_f64()];
                while reached != 0 {
                    let lane = reached.trailing_zeros();
                    reached &= reached - 1;
                    let marcher = &packet[lane as usize];
                    match judge.reached(axis, marcher, slab, dropped >> lane & 1 == 1) {
                        Verdict::Stop => alive &= !(1 << lane),
                        Verdict::Continue(q) => lattice.skip(1 << lane, q),
                    }
                }
            }
            let descending = vanishing & !last[depth as usize] & alive;
            if descending != 0 {
                depth += 1;
                index *= 2;
                width = lattice.width(depth);
                descended[depth as usize] = descending;
                continue;
            }
        }
        // On to the next slab; where both halves of a slab are done, to the one after that.
        let up = index.trailing_ones().min(depth - first);
        depth -= up;
        index = (index >> up) + 1;
        if depth == first && index == 1 << first {
            break;
        }
        width = lattice.width(depth);
        alive &= lattice.goes_on_at(&far);
        near = far;
    }
    for (lane, marcher) in packet.iter().enumerate() {
        let intervals = evaluations.lane(lane).to_f64() as u64;
        let work = Work { intervals, ..Work::default() };
        judge.finished(marcher, dropped >> lane & 1 == 1, work);
    }
}
