//! How far ends lie from the tightest ones: reported for each operation and arithmetic, and bounded.
//!
//! `cargo test -p zeroset-ia --test slack -- --nocapture` prints the table.

mod numbers;

use numbers::{Float, Operation, bounded, exactly};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;
use zeroset_ia::{Binary, Interval, Isa, Kernel, Packet, Rounding, Scalar, Set, Unary, dispatch};

/// Pairs of intervals for each operation.
const PAIRS: usize = 1600;

/// The largest argument of an elementary function for which all of them promise it.
const LARGEST: f64 = 100.0;

/// What an operation promises.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// No rounding at all.
    Exact,
    /// Arithmetic, for which the machine has a rounding.
    Arithmetic,
    Elementary,
}

fn kind(operation: &Operation) -> Kind {
    match operation {
        Operation::Neg
        | Operation::Unary(Unary::Abs | Unary::Sign | Unary::Floor | Unary::Ceil)
        | Operation::Binary(Binary::Min | Binary::Max) => Kind::Exact,
        Operation::Add | Operation::Sub | Operation::Mul | Operation::Div | Operation::Sqr => {
            Kind::Arithmetic
        }
        Operation::Unary(Unary::Sqrt) | Operation::Power(-1 | 2) => Kind::Arithmetic,
        _ => Kind::Elementary,
    }
}

/// Without `mod`, which is not in the standard and loose across its jumps.
fn operations() -> Vec<Operation> {
    let arithmetic = [
        Operation::Neg,
        Operation::Add,
        Operation::Sub,
        Operation::Mul,
        Operation::Div,
        Operation::Sqr,
    ];
    let powers = [-9, -4, -3, -2, -1, 2, 3, 4, 5, 12].map(Operation::Power);
    let unary = Unary::ALL.iter().map(|f| Operation::Unary(*f));
    let binary = Binary::ALL.iter().filter(|f| **f != Binary::Mod).map(|f| Operation::Binary(*f));
    arithmetic.into_iter().chain(powers).chain(unary).chain(binary).collect()
}

/// How large the first operand may be.
#[derive(Clone, Copy, PartialEq)]
enum Size {
    Promised,
    Larger,
}

/// Pairs of intervals, the same in each run.
fn pairs<S: Float>(operation: &Operation, size: Size) -> Vec<[Interval<S, Set>; 2]> {
    let mut runner = TestRunner::deterministic();
    let strategy = (bounded::<S>(), bounded::<S>());
    let is_elementary = kind(operation) == Kind::Elementary;
    let mut pairs = Vec::new();
    while pairs.len() < PAIRS {
        let (x, y) = strategy.new_tree(&mut runner).expect("intervals are found").current();
        if !is_elementary || x.is_bounded_by(LARGEST) == (size == Size::Promised) {
            pairs.push([x, y]);
        }
    }
    pairs
}

/// The tightest ends in `S`, from the exact range.
fn tightest<S: Scalar>(
    operation: &Operation,
    [x, y]: [Interval<S, Set>; 2],
) -> Option<Interval<S, Set>> {
    let exact = operation.apply(exactly(x), exactly(y));
    let [lo, hi] = exact.to_f64();
    (!exact.is_empty()).then(|| {
        let [lo, hi] = S::enclose_range(lo, hi);
        Interval::new(lo, hi)
    })
}

/// Where counting ends.
const MOST_STEPS: u32 = 1000;

/// How many floats lie from `end` to `other`.
fn steps<S: Float>(mut end: S, other: S, away: fn(S) -> S) -> u32 {
    let mut steps = 0;
    while end != other && steps < MOST_STEPS {
        end = away(end);
        steps += 1;
    }
    steps
}

/// Mean and worst slack.
#[derive(Default)]
struct Slack {
    sum: u32,
    ends: u32,
    worst: u32,
}

impl Slack {
    fn see<S: Float>(&mut self, tight: Interval<S, Set>, result: Interval<S, Set>, place: &str) {
        assert!(
            result.lo <= tight.lo && tight.hi <= result.hi,
            "{place}: {result:?} lacks {tight:?}"
        );
        for steps in [steps(tight.lo, result.lo, S::below), steps(tight.hi, result.hi, S::above)] {
            self.sum += steps;
            self.ends += 1;
            self.worst = self.worst.max(steps);
        }
    }

    fn report(&self, operation: &Operation, arithmetic: &str, limit: u32) {
        let mean = f64::from(self.sum) / f64::from(self.ends.max(1));
        println!(
            "{:28} {arithmetic:16} mean {mean:.3} worst {}",
            format!("{operation:?}"),
            self.worst
        );
        assert!(self.ends as usize > PAIRS / 40, "{operation:?}: only {} ends", self.ends);
        assert!(self.worst <= limit, "{operation:?} on {arithmetic}: {} units", self.worst);
    }
}

fn on_scalars<S: Float>(name: &str, elementary: u32) {
    for operation in operations() {
        let limit = match kind(&operation) {
            Kind::Exact => 0,
            Kind::Arithmetic => 1,
            Kind::Elementary => elementary,
        };
        let mut slack = Slack::default();
        for [x, y] in pairs::<S>(&operation, Size::Promised) {
            let result = operation.apply(x, y);
            let place = format!("{operation:?} {x:?} {y:?}");
            match tightest(&operation, [x, y]) {
                Some(tight) => slack.see(tight, result, &place),
                None => assert!(result.is_empty(), "{place}: {result:?} is empty"),
            }
        }
        slack.report(&operation, name, limit);
    }
}

/// Elementary functions of larger arguments: no wider, but for sine and cosine, of which the quarter turns
/// are not known far out.
fn beyond<S: Float>(name: &str, elementary: u32) {
    let functions = operations().into_iter().filter(|o| matches!(o, Operation::Unary(_)));
    for operation in functions.filter(|o| kind(o) == Kind::Elementary) {
        let mut slack = Slack::default();
        for pair in pairs::<S>(&operation, Size::Larger) {
            let result = operation.apply(pair[0], pair[1]);
            if let Some(tight) = tightest(&operation, pair) {
                slack.see(tight, result, &format!("{operation:?} {pair:?}"));
            }
        }
        let is_wave = matches!(operation, Operation::Unary(Unary::Sin | Unary::Cos));
        slack.report(&operation, name, if is_wave { MOST_STEPS } else { elementary });
    }
}

#[test]
fn of_larger_arguments() {
    beyond::<f64>("f64 beyond 100", 2);
    beyond::<f32>("f32 beyond 100", 1);
}

#[test]
fn of_double_precision() {
    on_scalars::<f64>("f64", 2);
}

#[test]
fn of_single_precision() {
    on_scalars::<f32>("f32", 1);
}

/// Sixteen pairs of intervals in lanes.
struct InLanes<'a> {
    operation: &'a Operation,
    pairs: &'a [[Interval<f32, Set>; 2]],
}

impl Kernel for InLanes<'_> {
    type Output = Vec<Interval<f32, Set>>;
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Self::Output {
        let load = |operand: usize| {
            let end = |end: f32| R::Scalar::from_f64(f64::from(end));
            let lo = zero.from_fn(|i| end(self.pairs[i][operand].lo));
            Interval::<R, Set>::new(lo, zero.from_fn(|i| end(self.pairs[i][operand].hi)))
        };
        let result = self.operation.apply(load(0), load(1));
        let end = |packet: R, i| packet.lane(i).to_f64() as f32;
        (0..16).map(|i| Interval::new(end(result.lo, i), end(result.hi, i))).collect()
    }
}

#[test]
fn of_lanes() {
    for operation in operations() {
        let pairs = pairs::<f32>(&operation, Size::Promised);
        let tight: Vec<_> = pairs.iter().map(|pair| tightest(&operation, *pair)).collect();
        for isa in Isa::available() {
            for rounding in [Rounding::Outward, Rounding::Nudged] {
                let is_embedded = isa == Isa::Avx512 && rounding == Rounding::Outward;
                let limit = match kind(&operation) {
                    Kind::Exact => 0,
                    Kind::Arithmetic => u32::from(!is_embedded),
                    Kind::Elementary => 1,
                };
                let mut slack = Slack::default();
                for (pairs, tight) in pairs.chunks_exact(16).zip(tight.chunks_exact(16)) {
                    let kernel = InLanes { operation: &operation, pairs };
                    let results = dispatch(isa, rounding, kernel);
                    for ((pair, tight), result) in pairs.iter().zip(tight).zip(results) {
                        let place = format!("{operation:?} {pair:?}");
                        match tight {
                            Some(tight) => slack.see(*tight, result, &place),
                            None => assert!(result.is_empty(), "{place}: {result:?} is empty"),
                        }
                    }
                }
                let name = format!("{} {rounding:?}", isa.name()).to_lowercase();
                slack.report(&operation, &name, limit);
            }
        }
    }
}
