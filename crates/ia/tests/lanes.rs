//! A lane computes what the scalar with the same rounding computes, bit for bit, on every
//! instruction set; embedded rounding tightens it, down to the exact result at most.

mod numbers;

use std::marker::PhantomData;

use numbers::{Operation, bounded, exactly, interval, operation};
use proptest::prelude::*;
use zeroset_ia::interval::Flavor;
use zeroset_ia::{
    Decorated, Decoration, Interval, Isa, Kernel, Nearest, Packet, Pair, Plain, Raw, Register,
    Rounding, Scalar, Set, dispatch, dispatch_register,
};

type Ends = [f64; 2];

/// Evaluates an operation on lanes, once alone and once with a copy beside it.
struct Evaluate<'a, F> {
    operation: &'a Operation,
    x: &'a [Interval<f32, Set>],
    y: &'a [Interval<f32, Set>],
    flavor: PhantomData<F>,
}

impl<F: Flavor> Evaluate<'_, F> {
    #[inline(always)]
    fn evaluate<R: Packet>(&self, zero: R) -> Vec<Ends> {
        let load = |values: &[Interval<f32, Set>]| {
            let lo = zero.from_fn(|i| R::Scalar::from_f64(f64::from(values[i % 16].lo)));
            let hi = zero.from_fn(|i| R::Scalar::from_f64(f64::from(values[i % 16].hi)));
            Interval::<R, F>::new(lo, hi)
        };
        let result = self.operation.apply(load(self.x), load(self.y));
        (0..R::LANES).map(|i| [result.lo.lane(i).to_f64(), result.hi.lane(i).to_f64()]).collect()
    }
}

impl<F: Flavor> Kernel for Evaluate<'_, F> {
    type Output = [Vec<Ends>; 2];
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Self::Output {
        [self.evaluate(zero), self.evaluate(Pair(zero, zero))]
    }
}

fn on_lanes<F: Flavor>(
    isa: Isa,
    rounding: Rounding,
    operation: &Operation,
    x: &[Interval<f32, Set>],
    y: &[Interval<f32, Set>],
) -> [Vec<Ends>; 2] {
    dispatch(isa, rounding, Evaluate::<F> { operation, x, y, flavor: PhantomData })
}

/// As many of the operands as narrow registers hold.
fn on_registers<F: Flavor>(
    rounding: Rounding,
    operation: &Operation,
    x: &[Interval<f32, Set>],
    y: &[Interval<f32, Set>],
) -> impl Iterator<Item = (usize, Ends)> {
    let evaluate = move |register| {
        let work = Evaluate::<F> { operation, x, y, flavor: PhantomData };
        let [alone, _] = dispatch_register(register, rounding, work);
        alone.into_iter().enumerate()
    };
    Register::available().into_iter().flat_map(evaluate)
}

fn on_scalars<S: Scalar, F: Flavor>(
    operation: &Operation,
    x: &Interval<f32, Set>,
    y: &Interval<f32, Set>,
) -> Ends {
    let load = |x: &Interval<f32, Set>| {
        Interval::<S, F>::new(S::from_f64(f64::from(x.lo)), S::from_f64(f64::from(x.hi)))
    };
    let result = operation.apply(load(x), load(y));
    [result.lo.to_f64(), result.hi.to_f64()]
}

fn same_bits(x: Ends, y: Ends) -> bool {
    x.iter().zip(y).all(|(x, y)| x.to_bits() == y.to_bits() || x.is_nan() && y.is_nan())
}

fn lies_in(x: Ends, y: Ends) -> bool {
    x.iter().all(|x| x.is_nan()) || y[0] <= x[0] && x[1] <= y[1]
}

/// May the raw form evaluate it?
fn meets_precondition(operation: &Operation, x: Interval<f32, Set>, y: Interval<f32, Set>) -> bool {
    let result = operation.apply(Decorated::new(x), Decorated::new(y));
    let limit = 2f64.powi(100);
    [x, y, result.interval].iter().all(|x| x.is_bounded_by(limit))
        && result.decoration >= Decoration::Defined
}

fn lanes(
    of: impl Strategy<Value = Interval<f32, Set>>,
) -> impl Strategy<Value = Vec<Interval<f32, Set>>> {
    prop::collection::vec(of, 16)
}

fn check_lanes<F: Flavor>(
    operation: &Operation,
    x: &[Interval<f32, Set>],
    y: &[Interval<f32, Set>],
) -> Result<(), TestCaseError> {
    let meets = |i: usize| F::SET || meets_precondition(operation, x[i], y[i]);
    for (i, ends) in on_registers::<F>(Rounding::Nudged, operation, x, y) {
        let expected = on_scalars::<f32, F>(operation, &x[i], &y[i]);
        prop_assert!(!meets(i) || same_bits(ends, expected), "{operation:?} {ends:?} {expected:?}");
    }
    for (i, ends) in on_registers::<F>(Rounding::Nearest, operation, x, y) {
        let expected = on_scalars::<Nearest<f32>, F>(operation, &x[i], &y[i]);
        prop_assert!(!meets(i) || same_bits(ends, expected), "{operation:?} {ends:?} {expected:?}");
    }
    for isa in Isa::available() {
        let [nudged, nudged_pair] = on_lanes::<F>(isa, Rounding::Nudged, operation, x, y);
        let [nearest, nearest_pair] = on_lanes::<F>(isa, Rounding::Nearest, operation, x, y);
        let [outward, outward_pair] = on_lanes::<F>(isa, Rounding::Outward, operation, x, y);
        for i in 0..16 {
            if !meets(i) {
                continue;
            }
            let place = format!("{operation:?} {:?} {:?} on {}", x[i], y[i], isa.name());
            let expected = on_scalars::<f32, F>(operation, &x[i], &y[i]);
            let papers = on_scalars::<Nearest<f32>, F>(operation, &x[i], &y[i]);
            prop_assert!(same_bits(nudged[i], expected), "{place}: {:?} {expected:?}", nudged[i]);
            prop_assert!(same_bits(nearest[i], papers), "{place}: {:?} {papers:?}", nearest[i]);
            prop_assert!(lies_in(outward[i], expected), "{place}: {:?} {expected:?}", outward[i]);
            prop_assert!(isa == Isa::Avx512 || same_bits(outward[i], expected), "{place}");
            if isa == Isa::Avx512 && i < 6 {
                let exact = operation.apply(exactly(x[i]), exactly(y[i]));
                let tight = exactly(Interval::<f64, Set>::new(outward[i][0], outward[i][1]));
                prop_assert!(
                    tight.contains(&exact),
                    "{place}: {:?} {:?}",
                    outward[i],
                    exact.to_f64()
                );
            }
            if F::SET {
                let scalar = operation.apply(x[i], y[i]);
                prop_assert!(same_bits(expected, scalar.bounds().map(f64::from)));
            } else {
                let set = on_scalars::<f32, Set>(operation, &x[i], &y[i]);
                let decorated = operation.apply(Decorated::new(x[i]), Decorated::new(y[i]));
                // But for the cut at 0.
                let [lo, hi] = decorated.interval.bounds();
                let vouched = [lo.next_down(), hi.next_up()].map(f64::from);
                if matches!(operation, Operation::Power(_)) {
                    // Products are rounded one by one; what is decorated allows for that.
                    prop_assert!(lies_in(expected, vouched), "{place}: {expected:?} {vouched:?}");
                } else {
                    prop_assert!(same_bits(expected, set), "{place}: raw {expected:?} set {set:?}");
                }
                prop_assert!(expected.iter().all(|end| end.is_finite()), "{place}");
            }
            for half in [i, i + 16] {
                prop_assert!(same_bits(nudged_pair[half], nudged[i]));
                prop_assert!(same_bits(nearest_pair[half], nearest[i]));
                prop_assert!(same_bits(outward_pair[half], outward[i]));
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(5000) })]

    #[test]
    fn set_based_lanes_equal_scalars(
        operation in operation(), x in lanes(interval()), y in lanes(interval())
    ) {
        check_lanes::<Set>(&operation, &x, &y)?;
    }

    #[test]
    fn raw_lanes_equal_scalars(
        operation in operation(), x in lanes(bounded()), y in lanes(bounded())
    ) {
        check_lanes::<Raw>(&operation, &x, &y)?;
    }
}

/// The primitives of a packet, on hostile floats.
struct Primitives<'a>(&'a [f32]);

impl Primitives<'_> {
    #[inline(always)]
    fn evaluate<R: Packet>(&self, zero: R) -> Vec<f64> {
        let load = |shift: usize| {
            zero.from_fn(|i| R::Scalar::from_f64(f64::from(self.0[(i + shift) % self.0.len()])))
        };
        let mut values = Vec::new();
        for shift in 0..self.0.len() {
            let (x, y) = (load(0), load(shift));
            let packets = [
                x + y,
                x - y,
                x * y,
                x / y,
                -x,
                x.abs(),
                x.floor(),
                x.ceil(),
                x.sqrt(),
                x.select_lt(y, x, y),
                (x * y).down(),
                (x * y).up(),
                x.select(x.lt(y), x, y),
                x.select(x.le(y), y, x),
                zero.splat(R::Scalar::from_f64(2.5)),
                Plain(x).0,
            ];
            values.extend(packets.iter().flat_map(|p| (0..R::LANES).map(|i| p.lane(i).to_f64())));
        }
        values
    }
}

impl Kernel for Primitives<'_> {
    type Output = [Vec<f64>; 2];
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Self::Output {
        [self.evaluate(zero), self.evaluate(Pair(zero, zero))]
    }
}

/// The same on scalars, in the same order.
fn primitives_of<S: Scalar>(floats: &[f32], lanes: usize) -> Vec<f64> {
    let at = |i: usize| S::from_f64(f64::from(floats[i % floats.len()]));
    let mut values = Vec::new();
    for shift in 0..floats.len() {
        let mut packets: [Vec<S>; 16] = Default::default();
        for i in 0..lanes {
            let (x, y) = (at(i), at(i + shift));
            let scalars = [
                x + y,
                x - y,
                x * y,
                x / y,
                -x,
                x.abs(),
                x.floor(),
                x.ceil(),
                x.sqrt(),
                x.select_lt(y, x, y),
                (x * y).down(),
                (x * y).up(),
                if x < y { x } else { y },
                if x <= y { y } else { x },
                S::from_f64(2.5),
                x,
            ];
            for (packet, scalar) in packets.iter_mut().zip(scalars) {
                packet.push(scalar);
            }
        }
        values.extend(packets.iter().flatten().map(|x| x.to_f64()));
    }
    values
}

#[test]
fn primitives_equal_those_of_scalars() {
    // An odd number of them, so that the halves of a pair differ.
    let floats = [
        3.0,
        0.0,
        -0.0,
        1.0,
        -1.5,
        f32::MAX,
        f32::MIN,
        f32::MIN_POSITIVE,
        -f32::MIN_POSITIVE,
        1e-45,
        -1e-45,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::NAN,
        16_777_217.0,
        -8_388_608.5,
        0.1,
    ];
    let same = |lanes: [Vec<f64>; 2], scalars: &[Vec<f64>; 2]| {
        let pairs = lanes.iter().flatten().zip(scalars.iter().flatten());
        lanes.iter().map(Vec::len).eq(scalars.iter().map(Vec::len)) && { pairs }
            .all(|(a, b)| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan())
    };
    for register in Register::available() {
        let lanes = match register {
            Register::Four => 4,
            Register::Eight => 8,
            Register::Sixteen => 16,
        };
        let run = |rounding| dispatch_register(register, rounding, Primitives(&floats));
        let expected = [lanes, 2 * lanes].map(|lanes| primitives_of::<f32>(&floats, lanes));
        assert!(same(run(Rounding::Nudged), &expected), "{register:?}");
        let expected =
            [lanes, 2 * lanes].map(|lanes| primitives_of::<Nearest<f32>>(&floats, lanes));
        assert!(same(run(Rounding::Nearest), &expected), "{register:?}");
    }
    let nudged = [16, 32].map(|lanes| primitives_of::<f32>(&floats, lanes));
    let nearest = [16, 32].map(|lanes| primitives_of::<Nearest<f32>>(&floats, lanes));
    for isa in Isa::available() {
        let run = |rounding| dispatch(isa, rounding, Primitives(&floats));
        assert!(same(run(Rounding::Nudged), &nudged), "{}", isa.name());
        assert!(same(run(Rounding::Outward), &nudged), "{}", isa.name());
        assert!(same(run(Rounding::Nearest), &nearest), "{}", isa.name());
    }
}
