//! Set-based results of IEEE 1788, and that nearest numbers never panic.

mod numbers;

use numbers::{Operation, finite, interval, operation};
use proptest::prelude::*;
use zeroset_ia::{Binary, Constant, Dual, Interval, Nearest, Number, Raw, Set, Unary};

const INFINITY: f64 = f64::INFINITY;
const EMPTY: [f64; 2] = [f64::NAN; 2];
const ENTIRE: [f64; 2] = [-INFINITY, INFINITY];

fn over(x: [f64; 2]) -> Interval<f64, Set> {
    Interval::new(x[0], x[1])
}

/// Equal but for a few units in the last place outward.
fn is_about(actual: Interval<f64, Set>, expected: [f64; 2]) -> bool {
    if expected[0].is_nan() {
        return actual.is_empty();
    }
    let below = (0..6).fold(expected[0], |x, _| x.next_down());
    let above = (0..6).fold(expected[1], |x, _| x.next_up());
    below <= actual.lo && actual.lo <= expected[0] && expected[1] <= actual.hi && actual.hi <= above
}

#[test]
fn functions_of_one_argument_are_set_based() {
    let pi = std::f64::consts::PI;
    for (f, x, expected) in [
        (Unary::Sqrt, [-1.0, 4.0], [0.0, 2.0]),
        (Unary::Sqrt, [-2.0, -1.0], EMPTY),
        (Unary::Log, [-1.0, 1.0], [-INFINITY, 0.0]),
        (Unary::Log, [0.0, 0.0], EMPTY),
        (Unary::Log, [1.0, INFINITY], [0.0, INFINITY]),
        (Unary::Logp1, [-5.0, 0.0], [-INFINITY, 0.0]),
        (Unary::Logp1, [-5.0, -1.0], EMPTY),
        (Unary::Asin, [-3.0, 0.0], [-pi / 2.0, 0.0]),
        (Unary::Asin, [1.5, 3.0], EMPTY),
        (Unary::Acos, [0.0, 3.0], [0.0, pi / 2.0]),
        (Unary::Acosh, [-3.0, 1.0], [0.0, 0.0]),
        (Unary::Acosh, [-3.0, 0.5], EMPTY),
        (Unary::Atanh, [0.0, 2.0], [0.0, INFINITY]),
        (Unary::Atanh, [1.0, 2.0], EMPTY),
        (Unary::Tan, [1.0, 2.0], ENTIRE),
        (Unary::Tan, [0.0, 4.0], ENTIRE),
        (Unary::Sin, [0.0, 2.0], [0.0, 1.0]),
        (Unary::Sin, [0.0, INFINITY], [-1.0, 1.0]),
        (Unary::Sin, [1.0, 7.5], [-1.0, 1.0]),
        (Unary::Cos, [-1.0, 4.0], [-1.0, 1.0]),
        (Unary::Cos, [3.0, 3.5], [-1.0, 3.5f64.cos()]),
        (Unary::Exp, [-INFINITY, 0.0], [0.0, 1.0]),
        (Unary::Expm1, [-INFINITY, 0.0], [-1.0, 0.0]),
        (Unary::Tanh, ENTIRE, [-1.0, 1.0]),
        (Unary::Cosh, [-1.0, 0.5], [1.0, 1f64.cosh()]),
        (Unary::Atan, ENTIRE, [-pi / 2.0, pi / 2.0]),
        (Unary::Abs, [-3.0, 2.0], [0.0, 3.0]),
        (Unary::Sign, [-3.0, 0.0], [-1.0, 0.0]),
        (Unary::Floor, [-0.5, 2.5], [-1.0, 2.0]),
        (Unary::Ceil, [-0.5, INFINITY], [0.0, INFINITY]),
        (Unary::Exp, EMPTY, EMPTY),
    ] {
        let y = over(x).unary(f);
        assert!(is_about(y, expected), "{f}({x:?}) = {y:?}, not {expected:?}");
    }
}

#[test]
fn functions_of_two_arguments_are_set_based() {
    let pi = std::f64::consts::PI;
    for (f, x, y, expected) in [
        (Binary::Mod, [5.5, 5.75], [2.0, 2.0], [1.5, 1.75]),
        (Binary::Mod, [-0.5, 0.5], [2.0, 3.0], [0.0, 3.0]),
        (Binary::Mod, [0.5, 1.5], [2.0, INFINITY], [0.5, 1.5]),
        (Binary::Mod, [1.0, 1.25], [-2.0, -2.0], [-1.0, -0.75]),
        (Binary::Mod, [5.5, 5.75], [-2.0, 3.0], [-2.0, 3.0]),
        (Binary::Mod, [5.5, 5.75], [0.0, 0.0], EMPTY),
        (Binary::Atan2, [0.0, 0.0], [-1.0, -1.0], [pi, pi]),
        (Binary::Atan2, [0.0, 1.0], [-1.0, 1.0], [0.0, pi]),
        (Binary::Atan2, [-1.0, 1.0], [-1.0, 1.0], [-pi, pi]),
        (Binary::Atan2, [-1.0, -0.0], [-1.0, -1.0], [-pi, pi]),
        (Binary::Atan2, [-1.0, 1.0], [0.0, 1.0], [-pi / 2.0, pi / 2.0]),
        (Binary::Atan2, [0.0, 0.0], [0.0, 0.0], EMPTY),
        (Binary::Atan2, [1.0, INFINITY], [1.0, INFINITY], [0.0, pi / 2.0]),
        (Binary::Hypot, [-3.0, 1.0], [4.0, 4.0], [4.0, 5.0]),
        (Binary::Pow, [0.0, 4.0], [0.5, 0.5], [0.0, 2.0]),
        (Binary::Pow, [-1.0, 0.0], [1.0, 2.0], [0.0, 0.0]),
        (Binary::Pow, [0.0, 0.0], [-1.0, 0.0], EMPTY),
        (Binary::Pow, [0.0, 2.0], [-1.0, 0.0], [0.5, INFINITY]),
        (Binary::Pow, [0.5, 2.0], [-1.0, 1.0], [0.5, 2.0]),
        (Binary::Pow, [-2.0, -1.0], [2.0, 2.0], EMPTY),
        (Binary::Min, [0.0, 3.0], [1.0, 2.0], [0.0, 2.0]),
        (Binary::Max, [0.0, 3.0], [1.0, 2.0], [1.0, 3.0]),
        (Binary::Max, [0.0, 3.0], EMPTY, EMPTY),
    ] {
        let z = over(x).binary(f, over(y));
        assert!(is_about(z, expected), "{f}({x:?}, {y:?}) = {z:?}, not {expected:?}");
    }
}

#[test]
fn quotients_are_set_based() {
    for (x, y, expected) in [
        ([1.0, 2.0], [0.0, 1.0], [1.0, INFINITY]),
        ([1.0, 2.0], [-1.0, 0.0], [-INFINITY, -1.0]),
        ([-2.0, -1.0], [-0.0, 1.0], [-INFINITY, -1.0]),
        ([-1.0, 2.0], [0.0, 1.0], ENTIRE),
        ([1.0, 2.0], [-1.0, 1.0], ENTIRE),
        ([0.0, 0.0], [-1.0, 1.0], [0.0, 0.0]),
        ([0.0, 0.0], [0.0, 1.0], [0.0, 0.0]),
        ([1.0, 2.0], [0.0, 0.0], EMPTY),
        ([1.0, 2.0], [0.0, -0.0], EMPTY),
        ([1.0, INFINITY], [1.0, INFINITY], [0.0, INFINITY]),
        (ENTIRE, [-4.0, -2.0], ENTIRE),
        (EMPTY, [0.0, 1.0], EMPTY),
        ([0.0, 1.0], EMPTY, EMPTY),
        ([6.0, 8.0], [2.0, 4.0], [1.5, 4.0]),
        ([-6.0, 8.0], [-4.0, -2.0], [-4.0, 3.0]),
    ] {
        let z = over(x) / over(y);
        assert!(is_about(z, expected), "{x:?} / {y:?} = {z:?}, not {expected:?}");
    }
    assert!(is_about(over([0.0, 2.0]).powi(-2), [0.25, INFINITY]));
    assert!(is_about(over([-2.0, 1.0]).powi(3), [-8.0, 1.0]));
    assert!(is_about(over([-2.0, 1.0]).powi(4), [0.0, 16.0]));
    assert!(over([1.0, 2.0]).is_bounded_by(2.0) && !over([1.0, 2.0]).is_bounded_by(1.5));
    assert!(!over(EMPTY).is_bounded_by(INFINITY));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(20_000) })]

    #[test]
    fn nearest_numbers_never_panic_and_are_not_widened(
        operation in operation(), x in interval::<f64>(), y in interval::<f64>(), a in finite::<f32>()
    ) {
        let near = |x: Interval<f64, Set>| Interval::<_, Set>::new(Nearest(x.lo), Nearest(x.hi));
        let papers = operation.apply(near(x), near(y));
        let proven = operation.apply(x, y);
        // Rounded to nearest, the range lies in the proven one.
        if !matches!(operation, Operation::Binary(Binary::Mod)) {
            prop_assert!(
                papers.is_empty() || proven.lo <= papers.lo.0 && papers.hi.0 <= proven.hi,
                "{operation:?} {x:?} {y:?}: {papers:?} {proven:?}"
            );
        }
        // Not even where the raw form has no business.
        let _ = operation.apply(Interval::<_, Raw>::point(Nearest(a)), Interval::point(Nearest(0.0)));
        let _ = operation.apply(Interval::<_, Raw>::new(x.lo, x.hi), Interval::new(y.lo, y.hi));
        let _ = operation.apply(Dual::<_, 1>::variable(x, 0), Dual::variable(y, 0));
    }
}

#[test]
fn a_point_constant_stays_a_point() {
    let x = Interval::<Nearest<f32>, Set>::point(Nearest(2.0));
    let tenth = x.constant(&Constant::from_f64(0.1));
    assert_eq!(tenth.lo, tenth.hi);
    let y = Interval::<f32, Set>::point(2.0).constant(&Constant::from_f64(0.1));
    assert!(y.lo < y.hi && y.lo.next_up() == y.hi);
    let sine = x.unary(Unary::Sin);
    assert_eq!(sine.lo, sine.hi, "nearest functions are not widened");
    assert_eq!(f64::from(sine.lo.0), f64::from(2f64.sin() as f32));
}
