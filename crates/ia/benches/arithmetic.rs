//! Interval arithmetic on the widest lanes: the price of outward rounding, in time a lane.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use zeroset_ia::{Interval, Isa, Kernel, Number, Packet, Raw, Rounding, Scalar, Unary, dispatch};

#[derive(Clone, Copy)]
enum Operation {
    Add,
    Mul,
    Div,
    Sqr,
    Function(Unary),
}

impl Operation {
    fn name(self) -> &'static str {
        match self {
            Self::Add => "add",
            Self::Mul => "mul",
            Self::Div => "div",
            Self::Sqr => "sqr",
            Self::Function(f) => f.name(),
        }
    }

    #[inline(always)]
    fn apply<N: Number>(self, x: N, y: N) -> N {
        match self {
            Self::Add => x + y,
            Self::Mul => x * y,
            Self::Div => x / y,
            Self::Sqr => x.sqr(),
            Self::Function(f) => x.unary(f),
        }
    }
}

/// Packets that stay in the nearest cache.
const PACKETS: usize = 32;

/// Times an operation, with the packets made outside of the clock.
struct Measure {
    operation: Operation,
    rounds: u64,
}

impl Kernel for Measure {
    type Output = Duration;
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Duration {
        let packet = |seed: usize| {
            let lo = zero
                .from_fn(|i| R::Scalar::from_f64(0.5 + ((seed * 37 + i * 11) % 97) as f64 / 64.0));
            let width = zero.splat(R::Scalar::from_f64(0.125));
            Interval::<R, Raw>::new(lo, lo + width)
        };
        let mut x: Vec<_> = (0..PACKETS).map(packet).collect();
        let mut y: Vec<_> = (PACKETS..2 * PACKETS).map(packet).collect();
        let start = Instant::now();
        for _ in 0..self.rounds {
            let (x, y) = (black_box(&mut x), black_box(&mut y));
            let mut all = Interval::point(zero);
            for (&mut x, &mut y) in x.iter_mut().zip(y) {
                all = all.hull(self.operation.apply(x, y));
            }
            black_box(all);
        }
        start.elapsed()
    }
}

fn arithmetic(criterion: &mut Criterion) {
    let isa = Isa::best();
    let mut group = criterion.benchmark_group("arithmetic");
    group.throughput(Throughput::Elements((16 * PACKETS) as u64));
    for operation in [
        Operation::Add,
        Operation::Mul,
        Operation::Div,
        Operation::Sqr,
        Operation::Function(Unary::Exp),
        Operation::Function(Unary::Sin),
    ] {
        for (name, rounding) in [
            ("outward", Rounding::Outward),
            ("nudged", Rounding::Nudged),
            ("nearest", Rounding::Nearest),
        ] {
            let id = BenchmarkId::new(operation.name(), format!("{name}/{}", isa.name()));
            group.bench_function(id, |bencher| {
                bencher
                    .iter_custom(|rounds| dispatch(isa, rounding, Measure { operation, rounds }));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, arithmetic);
criterion_main!(benches);
