//! Duals and jets against differences of the function at high precision, and against each other.

mod numbers;

use numbers::{Operation, exactly, operation};
use proptest::prelude::*;
use zeroset_ia::{
    BigInterval, Binary, Constant, Decorated, Dual, Enclosure, Interval, Jet, Number, Plain, Set,
    Unary,
};

const P: usize = 640;
const ORDER: usize = 4;

/// An argument at which few operations have a kink or a jump.
fn argument() -> impl Strategy<Value = f64> {
    prop_oneof![-3.0..3.0f64, 0.01..1.0f64, 1.0..20.0f64]
}

/// The operation along a line: the second operand is `1.3 x + 0.7`.
fn along<N: Number>(operation: &Operation, x: N) -> N {
    let y = x.clone().scale(&Constant::from_f64(1.3)).offset(&Constant::from_f64(0.7));
    operation.apply(x, y)
}

fn big(x: f64) -> BigInterval {
    BigInterval::from_f64(x, P)
}

/// `2^-n`.
fn small(n: i32) -> BigInterval {
    big(2f64.powi(-n))
}

fn is_at_most(x: &BigInterval, bound: &BigInterval) -> bool {
    !bound.is_below(&x.clone().unary(Unary::Abs))
}

fn jet_at(operation: &Operation, x: BigInterval) -> Jet<BigInterval> {
    let one = big(1.0);
    along(operation, Jet::variable(x, one, ORDER))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(4000) })]

    #[test]
    fn a_tangent_is_the_limit_of_differences(operation in operation(), x in argument()) {
        let dual = along(&operation, Dual::<_, 1>::variable(big(x), 0));
        let step = small(100);
        let rise = along(&operation, big(x) + step.clone()) - along(&operation, big(x) - step.clone());
        let quotient = rise / (step.clone() + step);
        let tangent = dual.tangent[0].clone();
        if dual.value.is_bounded() && tangent.is_bounded() && quotient.is_bounded() {
            let size = tangent.clone().sqr() + big(1.0);
            prop_assert!(
                is_at_most(&(tangent.clone() - quotient.clone()), &(size * small(80))),
                "{operation:?} at {x}: {:?}, differences give {:?}", tangent.to_f64(), quotient.to_f64()
            );
        }
    }

    #[test]
    fn a_jet_extrapolates_the_function(operation in operation(), x in argument()) {
        let jet = jet_at(&operation, big(x));
        let coefficients = jet.coefficients();
        prop_assert_eq!(coefficients.len(), ORDER + 1);
        if coefficients.iter().all(BigInterval::is_bounded) {
            let step = small(60);
            let series = coefficients.iter().rev().cloned()
                .reduce(|sum, c| sum * step.clone() + c).expect("coefficients");
            let error = along(&operation, big(x) + step) - series;
            // What follows is of order five, with a coefficient like those before.
            let size = coefficients.iter().cloned().map(|c| c.unary(Unary::Abs))
                .fold(big(1.0), |sum, c| sum + c);
            let bound = size * small(60 * (ORDER as i32 + 1)) * small(-30);
            prop_assert!(is_at_most(&error, &bound), "{operation:?} at {x}: {:?}", error.to_f64());
        }
    }

    #[test]
    fn a_jet_over_an_interval_contains_those_at_its_points(
        operation in operation(), x in argument(), width in 0.0..0.5f64, t in 0.0..=1.0f64
    ) {
        let box_x = Interval::<f64, Set>::new(x, x + width);
        let inside = (x + t * width).min(box_x.hi);
        let over_box = along(&operation, Jet::variable(box_x, Interval::point(1.0), ORDER));
        let at_point = jet_at(&operation, big(inside));
        for (k, (wide, exact)) in over_box.coefficients().iter().zip(at_point.coefficients()).enumerate() {
            // At the point itself nothing may be known.
            if exact.is_bounded() || k == 0 {
                prop_assert!(
                    wide.is_empty() || exactly(*wide).contains(exact),
                    "{operation:?} over {box_x:?}, order {k}: {wide:?} lacks {:?}", exact.to_f64()
                );
            }
        }
    }

    #[test]
    fn jets_and_duals_agree(operation in operation(), x in argument(), width in 0.0..0.1f64) {
        let box_x = Interval::<f64, Set>::new(x, x + width);
        let jet = along(&operation, Jet::variable(box_x, Interval::point(1.0), 1));
        let dual = along(&operation, Dual::<_, 1>::variable(box_x, 0));
        let (value, tangent) = (jet.value(), jet.coefficients()[1]);
        if !(value.is_empty() || tangent.is_empty() || dual.tangent[0].is_empty()) {
            let meet = |x: Interval<f64, Set>, y: Interval<f64, Set>| x.lo <= y.hi && y.lo <= x.hi;
            prop_assert!(meet(*value, dual.value), "{operation:?} {box_x:?}");
            prop_assert!(meet(tangent, dual.tangent[0]), "{operation:?} {box_x:?} {jet:?} {dual:?}");
        }
    }

    #[test]
    fn plain_numbers_lie_in_their_interval(operation in operation(), x in argument()) {
        let plain = along(&operation, Plain(x)).0;
        // Powers of plain numbers are products too.
        let range = along(&operation, Decorated::new(Interval::<f64, Set>::point(x))).interval;
        if plain.is_finite() && range.is_bounded_by(f64::MAX) {
            prop_assert!(range.contains(plain), "{operation:?} at {x}: {plain} outside {range:?}");
        }
    }
}

#[test]
fn the_gradient_has_a_tangent_an_axis() {
    let point = |x| Interval::<f64, Set>::point(x);
    let [x, y, z] = [0, 1, 2].map(|i| Dual::<_, 3>::variable(point(i as f64 + 1.0), i));
    let f = x * y + z.sqr();
    for (tangent, expected) in f.tangent.iter().zip([2.0, 1.0, 6.0]) {
        assert!(tangent.contains(expected), "{tangent:?} {expected}");
    }
}

#[test]
fn a_jet_claims_nothing_across_kinks_jumps_and_poles() {
    let over = |lo: f64, hi: f64| {
        Jet::variable(Interval::<f64, Set>::new(lo, hi), Interval::point(1.0), 2)
    };
    let knows = |jet: Jet<Interval<f64, Set>>| {
        jet.coefficients()[1..].iter().all(|c| c.is_bounded_by(f64::MAX))
    };
    let one = |x: &Jet<Interval<f64, Set>>| x.constant(&Constant::integer(1));
    let x = over(-1.0, 1.0);
    assert!(!knows(x.clone().unary(Unary::Abs)) && knows(over(0.5, 1.0).unary(Unary::Abs)));
    assert!(!knows(over(0.0, 1.0).unary(Unary::Abs)));
    assert!(!knows(x.clone().unary(Unary::Floor)) && knows(over(0.5, 0.6).unary(Unary::Floor)));
    assert!(!knows(x.clone().unary(Unary::Sign)) && knows(over(0.5, 0.6).unary(Unary::Sign)));
    assert!(!knows(one(&x) / x.clone()));
    assert!(!knows(over(1.0, 2.0).unary(Unary::Tan)) && knows(over(1.0, 1.5).unary(Unary::Tan)));
    assert!(!knows(over(0.0, 1.0).unary(Unary::Sqrt)) && !knows(x.clone().unary(Unary::Cbrt)));
    assert!(!knows(over(0.0, 1.0).unary(Unary::Log)));
    assert!(!knows(over(0.5, 1.0).unary(Unary::Asin)) && knows(over(0.5, 0.9).unary(Unary::Asin)));
    assert!(!knows(x.clone().binary(Binary::Max, one(&x).scale(&Constant::from_f64(0.5)))));
    assert!(!knows(x.clone().binary(Binary::Hypot, x.clone())));
    assert!(!knows(x.clone().binary(Binary::Atan2, x.clone())));
    assert!(!knows(x.clone().binary(Binary::Atan2, -one(&x))));
    assert!(knows(x.clone().binary(Binary::Atan2, one(&x))));
    let three = one(&x).scale(&Constant::integer(3));
    assert!(
        !knows(x.binary(Binary::Mod, three.clone()))
            && knows(over(0.5, 1.0).binary(Binary::Mod, three))
    );
}

#[test]
fn a_dual_of_a_kink_keeps_the_slopes_on_both_sides() {
    let over = |lo, hi| Dual::<_, 1>::variable(Interval::<f64, Set>::new(lo, hi), 0);
    let slope = |x: Dual<Interval<f64, Set>, 1>| x.tangent[0];
    let kink = slope(over(-1.0, 2.0).unary(Unary::Abs));
    assert!(kink.contains(-1.0) && kink.contains(1.0));
    let zero = Dual::constant_value(Interval::point(0.0));
    let ramp = slope(over(-1.0, 2.0).binary(Binary::Max, zero));
    assert!(ramp.contains(0.0) && ramp.contains(1.0));
    let touching = slope(over(0.0, 2.0).binary(Binary::Max, zero));
    assert!(touching.contains(1.0));
    assert!(slope(over(2.0, 3.0).binary(Binary::Min, zero)).contains(0.0));
    assert!(Enclosure::is_positive(&slope(over(1.0, 2.0).powi(-2).scale(&Constant::integer(-1)))));
}
