//! Interval evaluations a second on one core, beside a native-code evaluator of another project.
//!
//! The Barth sextic and decic over the same boxes in single precision: outward on the widest lanes that
//! this machine has, and by fidget's just-in-time compiler, which evaluates one interval a call and
//! rounds to nearest.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fidget_core::context::{Context, Node};
use fidget_core::eval::{Function, MathFunction, Tape as _, TracingEvaluator};
use fidget_core::types::Interval as FidgetInterval;
use fidget_core::var::Var;
use fidget_jit::JitFunction;
use zeroset_expr::{Op, Parameters, Tape};
use zeroset_ia::{Interval, Isa, Kernel, Packet, Pair, Raw, Real, Rounding, Scalar, dispatch};
use zeroset_raycast::Geometry;
use zeroset_raycast::catalogue::Catalogue;

/// Boxes that stay in the nearest cache.
const BOXES: usize = 512;
/// The sides of the boxes.
const SIDE: f32 = 0.015_625;

/// The lower corner of a box, along an axis.
fn corner(i: usize, axis: usize) -> f32 {
    (((3 * i + axis) * 37) % 97) as f32 / 24.25 - 2.0
}

fn tape(surface: &str) -> Tape {
    let scene = Catalogue::builtin().get(surface).expect("it is in the catalogue").scene();
    let Geometry::Implicit(function) = scene.expect("a scene").geometry else {
        unreachable!("catalogue surfaces are functions")
    };
    function.tape(&Parameters::default(), 128).expect("defaults are values")
}

/// The same operations for fidget.
fn translate(tape: &Tape, context: &mut Context) -> Node {
    let mut registers: BTreeMap<u32, Node> = BTreeMap::new();
    registers.extend([(0, context.x()), (1, context.y()), (2, context.z())]);
    for instruction in tape.instructions() {
        let at = |r| registers[&r];
        let constant = |c: u32| tape.constants()[c as usize].nearest_f32;
        let node = match instruction.op {
            Op::Load(c) => Ok(context.constant(constant(c))),
            Op::Add(a, b) => context.add(at(a), at(b)),
            Op::Sub(a, b) => context.sub(at(a), at(b)),
            Op::Mul(a, b) => context.mul(at(a), at(b)),
            Op::Neg(a) => context.neg(at(a)),
            Op::Scale(a, c) => context.mul(at(a), constant(c)),
            Op::Offset(a, c) => context.add(at(a), constant(c)),
            Op::Sqr(a) => context.square(at(a)),
            op => panic!("{op:?} is in neither surface"),
        };
        registers.insert(instruction.out, node.expect("a node of this context"));
    }
    registers[&tape.output()]
}

/// Evaluates all boxes on lanes.
struct OnLanes<'a> {
    tape: &'a Tape,
    rounds: u64,
}

impl Kernel for OnLanes<'_> {
    type Output = Duration;
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Duration {
        // Four vectors at a time: the more, the less the interpretation of the tape counts.
        let zero = Pair(Pair(zero, zero), Pair(zero, zero));
        let lanes = Pair::<Pair<R>>::LANES;
        let side = zero.splat(R::Scalar::from_f64(SIDE.into()));
        let mut boxes = Vec::new();
        for first in (0..BOXES).step_by(lanes) {
            let range = |axis| {
                let lo = zero.from_fn(|i| R::Scalar::from_f64(corner(first + i, axis).into()));
                Interval::<_, Raw>::new(lo, lo + side)
            };
            boxes.push([range(0), range(1), range(2)]);
        }
        let mut evaluator = self.tape.evaluator(&boxes[0][0]);
        let start = Instant::now();
        for _ in 0..self.rounds {
            for &point in black_box(&boxes) {
                black_box(evaluator.evaluate(point));
            }
        }
        start.elapsed()
    }
}

fn intervals(criterion: &mut Criterion) {
    for surface in ["barth-sextic", "barth-decic"] {
        let tape = tape(surface);
        let mut group = criterion.benchmark_group(format!("intervals/{surface}"));
        group.throughput(Throughput::Elements(BOXES as u64));
        let isa = Isa::best();
        group.bench_function(format!("lanes-outward-{}", isa.name()), |bencher| {
            bencher.iter_custom(|rounds| {
                dispatch(isa, Rounding::Outward, OnLanes { tape: &tape, rounds })
            });
        });

        let mut context = Context::new();
        let root = translate(&tape, &mut context);
        let function = JitFunction::new(&context, &[root]).expect("it compiles");
        let compiled = function.interval_tape(Default::default());
        let place = |var| compiled.vars().get(&var).expect("it has x, y and z");
        let places = [place(Var::X), place(Var::Y), place(Var::Z)];
        let boxes: Vec<[FidgetInterval; 3]> = (0..BOXES)
            .map(|i| {
                let mut point = [FidgetInterval::new(0.0, 0.0); 3];
                for (axis, place) in places.into_iter().enumerate() {
                    let lo = corner(i, axis);
                    point[place] = FidgetInterval::new(lo, lo + SIDE);
                }
                point
            })
            .collect();
        let mut evaluator = JitFunction::new_interval_eval();
        group.bench_function("fidget-jit", |bencher| {
            bencher.iter(|| {
                for point in black_box(&boxes) {
                    black_box(evaluator.eval(&compiled, point).expect("three variables"));
                }
            });
        });
        group.finish();
    }
}

criterion_group!(benches, intervals);
criterion_main!(benches);
