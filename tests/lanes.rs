//! Lanes give what scalars give, bit for bit, on every surface of the catalogue and on random
//! equations; rounding in hardware gives tighter enclosures that still hold the values.

mod equations;

use equations::{LANES, Nest, around, exact, holds, is_in, on_equations, on_the_catalogue, value};
use proptest::prelude::*;
use zeroset_expr::Tape;
use zeroset_ia::{
    Decorated, Decoration, Interval, Isa, Kernel, Nearest, Packet, Plain, Raw, Real, Rounding,
    Scalar, Set, dispatch,
};

/// How many numbers [`answers`] gives, and where those of raw intervals start.
const ANSWERS: usize = 5;
const RAW: usize = 3;

/// The set-based ends, the value at a corner, and the raw ends.
#[inline(always)]
fn answers<R: Real>(tape: &Tape, lo: [R; 3], hi: [R; 3]) -> [R; ANSWERS] {
    let set = value(tape, [0, 1, 2].map(|k| Interval::<R, Set>::new(lo[k], hi[k])));
    let corner = value(tape, [Plain(lo[0]), Plain(hi[1]), Plain(lo[2])]);
    let raw = value(tape, [0, 1, 2].map(|k| Interval::<R, Raw>::new(lo[k], hi[k])));
    [set.lo, set.hi, corner.0, raw.lo, raw.hi]
}

struct OnLanes<'a>(&'a Tape, &'a [[Interval<f32, Set>; 3]; LANES]);

impl Kernel for OnLanes<'_> {
    type Output = Vec<[f64; ANSWERS]>;
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Self::Output {
        let load = |end: fn(Interval<f32, Set>) -> f32| {
            [0, 1, 2].map(
                #[inline(always)]
                |k| zero.from_fn(|i| R::Scalar::from_f64(end(self.1[i][k]).into())),
            )
        };
        let found = answers(self.0, load(|x| x.lo), load(|x| x.hi));
        (0..R::LANES).map(|i| found.map(|x| x.lane(i).to_f64())).collect()
    }
}

fn on_scalars<S: Scalar>(tape: &Tape, boxes: &[Interval<f32, Set>; 3]) -> [f64; ANSWERS] {
    let scalar = |x: f32| S::from_f64(x.into());
    answers(tape, boxes.map(|x| scalar(x.lo)), boxes.map(|x| scalar(x.hi))).map(S::to_f64)
}

/// May raw intervals be used: is every sub-value defined, and bounded?
fn is_raw(tape: &Tape, boxes: &[Interval<f32, Set>; 3]) -> bool {
    let (boxes, mut holds) = (boxes.map(Decorated::new), true);
    tape.evaluator(&boxes[0]).visit(boxes, |x| {
        holds &= x.decoration >= Decoration::Defined;
        holds &= x.interval.is_bounded_by(2_f64.powi(100));
    });
    holds
}

/// Lanes give what scalars give; rounding in hardware is tighter, and still holds the value.
fn check_lanes(tape: &Tape, nests: &[Nest; LANES]) -> Result<bool, TestCaseError> {
    let boxes = nests.map(|nest| nest.map(|axis| around::<f32>(axis[1], axis[3])));
    let nudged = boxes.map(|b| on_scalars::<f32>(tape, &b));
    let nearest = boxes.map(|b| on_scalars::<Nearest<f32>>(tape, &b));
    let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
    for isa in Isa::available() {
        let on = |rounding| dispatch(isa, rounding, OnLanes(tape, &boxes));
        let lanes = [Rounding::Nudged, Rounding::Nearest, Rounding::Outward].map(on);
        for i in 0..LANES {
            // Raw intervals mean nothing elsewhere.
            let count = if is_raw(tape, &boxes[i]) { ANSWERS } else { RAW };
            for k in 0..count {
                let (a, b) = (lanes[0][i][k], nudged[i][k]);
                prop_assert!(same(a, b), "{isa:?} nudged {:?}: {k}: {a:e}, {b:e}", boxes[i]);
                let (a, b) = (lanes[1][i][k], nearest[i][k]);
                prop_assert!(same(a, b), "{isa:?} nearest {:?}: {k}: {a:e}, {b:e}", boxes[i]);
            }
            let end = |of: &[f64; ANSWERS], k| Interval::<f64, Set>::new(of[k], of[k + 1]);
            let tight = &lanes[2][i];
            for k in [0, RAW].into_iter().filter(|k| *k < count) {
                let (tight, wide) = (end(tight, k), end(&nudged[i], k));
                prop_assert!(is_in(tight, wide), "{isa:?} {:?}: {tight:?} {wide:?}", boxes[i]);
            }
            let point = nests[i].map(|axis| Decorated::new(around::<f64>(axis[2], axis[2])));
            if value(tape, point).decoration >= Decoration::Defined {
                prop_assert!(
                    holds(end(tight, 0), &exact(tape, &nests[i])),
                    "{isa:?} {:?}",
                    boxes[i]
                );
            }
        }
    }
    Ok(true)
}

#[test]
fn lanes_give_what_scalars_give() {
    on_the_catalogue(4, check_lanes);
    on_equations(300, check_lanes);
}
