//! The tape of a slope computes what a dual does, in fewer operations.

mod expressions;

use expressions::{Functions, coordinate, expression};
use proptest::prelude::*;
use zeroset_expr::{Function, Parameters, Tape};
use zeroset_ia::{Dual, Interval, Number, Plain, Set};

fn tape(text: &str) -> Tape {
    let function = Function::parse(text).unwrap_or_else(|e| panic!("{}", e.render()));
    function.tape(&Parameters::default(), 128).expect("defaults are values")
}

/// The slope by the tape of slopes, and by a dual.
fn slopes<N: Number>(tape: &Tape, point: &[N; 3], direction: &[N; 3]) -> [N; 2] {
    let slope = tape.slope();
    let mut evaluator = slope.evaluator(&point[0]);
    for axis in 0..3 {
        evaluator.bind(axis, point[axis].clone());
        evaluator.bind(axis + 3, direction[axis].clone());
    }
    let dual = [0, 1, 2]
        .map(|axis| Dual { value: point[axis].clone(), tangent: [direction[axis].clone()] });
    let zero = Dual::constant_value(point[0].clone());
    let [by_dual] = tape.evaluator(&zero).evaluate(dual).tangent;
    [evaluator.run(|_| {}), by_dual]
}

#[test]
fn slopes_of_constant_operands_cost_nothing() {
    for (text, operations) in [
        ("x", 0),
        ("x + 2", 0),
        ("3*x", 1),
        // 2 x dx.
        ("x^2 - 1", 2),
        // x dy + y dx.
        ("x*y", 3),
        // floor has slope 0.
        ("floor(x)", 1),
        // -(2/x) dx / x.
        ("2/x", 5),
    ] {
        let slope = tape(text).slope();
        assert!(slope.instructions().len() <= operations, "{text}: {:#?}", slope.instructions());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn a_slope_is_the_tangent_of_a_dual(
        expression in expression(Functions::All),
        point in [coordinate(), coordinate(), coordinate()],
        direction in [coordinate(), coordinate(), coordinate()],
        radius in prop_oneof![Just(0.0), 1e-6_f64..1.0],
    ) {
        let Ok(function) = Function::parse(&expression.text()) else { return Ok(()) };
        let Ok(tape) = function.tape(&Parameters::default(), 128) else { return Ok(()) };
        let [Plain(a), Plain(b)] = slopes(&tape, &point.map(Plain), &direction.map(Plain));
        // 0 times infinity is left out.
        prop_assert!(a == b || b.is_nan(), "{expression:?}: {a} {b}");

        type I = Interval<f64, Set>;
        let range = point.map(|x| I::new(x - radius, x + radius));
        let [a, b] = slopes(&tape, &range, &direction.map(I::point));
        let lies_in = b.is_empty() || a.is_empty() || b.lo <= a.lo && a.hi <= b.hi;
        prop_assert!(lies_in, "{expression:?}: {a:?} {b:?}");
    }
}
