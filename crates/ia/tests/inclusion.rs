//! Every operation contains the exact result, and a smaller interval never has a larger result.

mod numbers;

use numbers::{Float, Operation, exactly, interval, nested, operation};
use proptest::prelude::*;
use zeroset_ia::{Interval, Set};

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
