//! One function over each number: the price of intervals, derivatives and lanes.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use zeroset_expr::{Function, Parameters, Tape};
use zeroset_ia::{
    Dual, Interval, Isa, Kernel, Number, Packet, Plain, Raw, Rounding, Scalar, dispatch,
};

const BARTH_SEXTIC: &str = "4*(phi^2*x^2-y^2)*(phi^2*y^2-z^2)*(phi^2*z^2-x^2)\
                            -(1+2*phi)*(x^2+y^2+z^2-1)^2; phi = (1+sqrt(5))/2";

/// Points that stay in the nearest cache.
const POINTS: usize = 32;

/// A coordinate of a point, between -2 and 2.
fn coordinate(seed: usize) -> f64 {
    ((seed * 37) % 97) as f64 / 24.25 - 2.0
}

/// An interval of the width that a ray caster meets near a surface.
fn interval(x: f64) -> Interval<f64, Raw> {
    Interval::new(x, x + 0.015_625)
}

/// Times a tape over numbers made from coordinates.
fn bench<N: Number>(criterion: &mut Criterion, tape: &Tape, name: &str, number: impl Fn(f64) -> N) {
    let points: Vec<[N; 3]> =
        (0..POINTS).map(|i| [0, 1, 2].map(|k| number(coordinate(3 * i + k)))).collect();
    let mut group = criterion.benchmark_group("evaluation");
    group.throughput(Throughput::Elements(POINTS as u64));
    group.bench_function(name, |bencher| {
        let mut evaluator = tape.evaluator(&points[0][0]);
        bencher.iter(|| {
            for point in black_box(&points) {
                black_box(evaluator.evaluate(point.clone()));
            }
        });
    });
    group.finish();
}

/// Times a tape over intervals in lanes, with the packets made outside of the clock.
struct Measure<'a> {
    tape: &'a Tape,
    rounds: u64,
}

impl Kernel for Measure<'_> {
    type Output = Duration;
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Duration {
        let width = zero.splat(R::Scalar::from_f64(0.015_625));
        let side = |seed: usize| {
            let lo = zero.from_fn(|i| R::Scalar::from_f64(coordinate(seed + 11 * i)));
            Interval::<R, Raw>::new(lo, lo + width)
        };
        let boxes: Vec<[_; 3]> =
            (0..POINTS).map(|i| [side(3 * i), side(3 * i + 1), side(3 * i + 2)]).collect();
        let mut evaluator = self.tape.evaluator(&boxes[0][0]);
        let start = Instant::now();
        for _ in 0..self.rounds {
            let mut all = Interval::point(zero);
            for &point in black_box(&boxes) {
                all = all.hull(evaluator.evaluate(point));
            }
            black_box(all);
        }
        start.elapsed()
    }
}

fn evaluation(criterion: &mut Criterion) {
    let function = Function::parse(BARTH_SEXTIC).expect("it is an equation");
    let tape = function.tape(&Parameters::default(), 128).expect("defaults are values");
    bench(criterion, &tape, "plain/f64", Plain);
    bench(criterion, &tape, "interval/f64", interval);
    bench(criterion, &tape, "dual interval/f64", |x| Dual::<_, 1>::variable(interval(x), 0));

    let isa = Isa::best();
    let mut group = criterion.benchmark_group("evaluation");
    for (name, rounding) in [("outward", Rounding::Outward), ("nearest", Rounding::Nearest)] {
        group.throughput(Throughput::Elements((16 * POINTS) as u64));
        let id = BenchmarkId::new(format!("lanes {name}"), isa.name());
        group.bench_function(id, |bencher| {
            bencher.iter_custom(|rounds| dispatch(isa, rounding, Measure { tape: &tape, rounds }));
        });
    }
    group.finish();
}

criterion_group!(benches, evaluation);
criterion_main!(benches);
