//! Every operation contains the exact result, and a smaller interval never has a larger result; where a
//! decoration says that raw intervals may be used, they do not leave the decorated one.

mod numbers;

use numbers::{Float, Operation, bounded, exactly, interval, nested, operation};
use proptest::prelude::*;
use zeroset_ia::{Decorated, Decoration, Interval, Number, Raw, Set};

fn contains<S: Float>(outer: Interval<S, Set>, inner: Interval<S, Set>) -> bool {
    inner.is_empty() || outer.lo <= inner.lo && inner.hi <= outer.hi
}

fn check_inclusion<S: Float>(
    operation: &Operation,
    x: Interval<S, Set>,
    y: Interval<S, Set>,
) -> Result<(), TestCaseError> {
    let result = operation.apply(x, y);
    let exact = operation.apply(exactly(x), exactly(y));
    prop_assert!(
        exactly(result).contains(&exact),
        "{operation:?} {x:?} {y:?}: {result:?} lacks {:?}",
        exact.to_f64()
    );
    prop_assert_eq!(result.is_empty(), exact.is_empty(), "{:?} {:?} {:?}", operation, x, y);
    Ok(())
}

fn check_monotony<S: Float>(
    operation: &Operation,
    [x, wide_x]: [Interval<S, Set>; 2],
    [y, wide_y]: [Interval<S, Set>; 2],
) -> Result<(), TestCaseError> {
    let (result, wide) = (operation.apply(x, y), operation.apply(wide_x, wide_y));
    prop_assert!(
        contains(wide, result),
        "{operation:?} {x:?} {y:?} gives {result:?}; {wide_x:?} {wide_y:?} gives {wide:?}"
    );
    Ok(())
}

fn check_raw<S: Float>(
    operation: &Operation,
    x: Interval<S, Set>,
    y: Interval<S, Set>,
) -> Result<(), TestCaseError> {
    let decorated = operation.apply(Decorated::new(x), Decorated::new(y));
    let (range, limit) = (decorated.interval, 2f64.powi(100));
    let is_bounded = [x, y, range].iter().all(|x| x.is_bounded_by(limit));
    if !is_bounded || decorated.decoration < Decoration::Defined {
        return Ok(());
    }
    let [a, b] = [x, y].map(|x| Interval::<S, Raw>::new(x.lo, x.hi));
    let [lo, hi] = operation.apply(a, b).bounds();
    let exact = operation.apply(exactly(x), exactly(y));
    let place = format!("{operation:?} {x:?} {y:?}: [{lo:?}, {hi:?}], decorated {range:?}");
    prop_assert!(exactly(Interval::<S, Set>::new(lo, hi)).contains(&exact), "{place}");
    // But for the cut of signs at 0.
    prop_assert!(range.lo.below() <= lo && hi <= range.hi.above(), "{place}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(50_000) })]

    #[test]
    fn single_precision_contains_the_exact_result(
        operation in operation(), x in interval::<f32>(), y in interval::<f32>()
    ) {
        check_inclusion(&operation, x, y)?;
    }

    #[test]
    fn double_precision_contains_the_exact_result(
        operation in operation(), x in interval::<f64>(), y in interval::<f64>()
    ) {
        check_inclusion(&operation, x, y)?;
    }

    #[test]
    fn raw_intervals_of_single_precision_stay_in_decorated_ones(
        operation in operation(), x in bounded::<f32>(), y in bounded::<f32>()
    ) {
        check_raw(&operation, x, y)?;
    }

    #[test]
    fn raw_intervals_of_double_precision_stay_in_decorated_ones(
        operation in operation(), x in bounded::<f64>(), y in bounded::<f64>()
    ) {
        check_raw(&operation, x, y)?;
    }

    #[test]
    fn single_precision_is_inclusion_monotone(
        operation in operation(), x in nested::<f32>(), y in nested::<f32>()
    ) {
        check_monotony(&operation, x, y)?;
    }

    #[test]
    fn double_precision_is_inclusion_monotone(
        operation in operation(), x in nested::<f64>(), y in nested::<f64>()
    ) {
        check_monotony(&operation, x, y)?;
    }
}

/// Powers are exact at 1, where the gaps between floats change.
fn powers_grow_with_their_base_beside_one<S: Float>() {
    let one = S::from_f64(1.0);
    let mut floats = vec![one];
    for _ in 0..6 {
        floats.insert(0, floats[0].below());
        floats.push(floats[floats.len() - 1].above());
    }
    for n in (-9..=9).filter(|n| *n != 0) {
        for (i, &x) in floats.iter().enumerate() {
            for &y in &floats[i..] {
                let [point, wide] = [y, x].map(|lo| Interval::<S, Set>::new(lo, y));
                let [part, whole] = [point, wide].map(|x| x.powi(n));
                assert!(contains(whole, part), "{wide:?}^{n}: {whole:?}, {part:?}");
                let [part, whole] = [Interval::point(x), wide].map(|x: Interval<S, Set>| x.powi(n));
                assert!(contains(whole, part), "{wide:?}^{n}: {whole:?}, {part:?}");
            }
        }
    }
}

#[test]
fn powers_are_inclusion_monotone_beside_one() {
    powers_grow_with_their_base_beside_one::<f32>();
    powers_grow_with_their_base_beside_one::<f64>();
}
