//! The range over a union is the union of the ranges: nothing is lost where a box is split, and nothing
//! is gained but for functions that are known to be loose.

mod numbers;

use numbers::{Float, Operation, interval, operation};
use proptest::prelude::*;
use zeroset_ia::{Binary, Interval, Set};

/// The two parts of an interval on either side of a member.
fn parts<S: Float>(x: Interval<S, Set>, t: f64) -> [Interval<S, Set>; 2] {
    let [lo, hi] = [x.lo.to_f64().max(-S::HUGE), x.hi.to_f64().min(S::HUGE)];
    let middle = S::from_f64(lo * (1.0 - t) + hi * t).max(x.lo).min(x.hi);
    // An empty interval has empty parts.
    if x.is_empty() { [x, x] } else { [Interval::new(x.lo, middle), Interval::new(middle, x.hi)] }
}

fn check<S: Float>(
    operation: &Operation,
    whole: [Interval<S, Set>; 2],
    split: [[Interval<S, Set>; 2]; 2],
) -> Result<(), TestCaseError> {
    let range = operation.apply(whole[0], whole[1]);
    let [first, second] = split.map(|[x, y]| operation.apply(x, y));
    let union = first.hull(second);
    let place = format!("{operation:?} {whole:?}: {range:?}, in parts {first:?} {second:?}");
    prop_assert!(union.is_empty() || range.lo <= union.lo && union.hi <= range.hi, "{place}");
    // Across its jumps the remainder takes the whole range of remainders.
    if !matches!(operation, Operation::Binary(Binary::Mod)) {
        prop_assert!(
            range.is_empty() && union.is_empty() || range.lo == union.lo && range.hi == union.hi,
            "{place}"
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(20_000) })]

    #[test]
    fn of_single_precision(
        operation in operation(), x in interval::<f32>(), y in interval::<f32>(), t in 0.0..1.0f64
    ) {
        let ([a, b], [c, d]) = (parts(x, t), parts(y, t));
        check(&operation, [x, y], [[a, y], [b, y]])?;
        check(&operation, [x, y], [[x, c], [x, d]])?;
    }

    #[test]
    fn of_double_precision(
        operation in operation(), x in interval::<f64>(), y in interval::<f64>(), t in 0.0..1.0f64
    ) {
        let ([a, b], [c, d]) = (parts(x, t), parts(y, t));
        check(&operation, [x, y], [[a, y], [b, y]])?;
        check(&operation, [x, y], [[x, c], [x, d]])?;
    }
}
