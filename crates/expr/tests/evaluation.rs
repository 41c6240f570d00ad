//! Tapes give the values of the expression as written: over doubles, intervals and duals.

mod expressions;

use std::sync::atomic::{AtomicU32, Ordering};

use expressions::big::Nearly;
use expressions::rounded::Rounded;
use expressions::{Expr, Functions, coordinate, expression};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use zeroset_expr::{Function, Parameters, Tape};
use zeroset_ia::{Dual, Interval, Number, Plain, Scalar, Set};

/// The tape of the text; none if the function is constant or somewhere undefined for all x, y, z.
fn tape(e: &Expr) -> Option<Tape> {
    let function = Function::parse(&e.text()).ok()?;
    Some(function.tape(&Parameters::default(), 128).expect("defaults are values"))
}

fn evaluate<N: Number>(tape: &Tape, point: [N; 3]) -> N {
    tape.evaluator(&point[0]).evaluate(point)
}

/// Runs a check that tells whether there was anything to compare, which must not be rare.
fn check<S: Strategy>(
    cases: u32,
    strategy: S,
    check: impl Fn(S::Value) -> Result<bool, TestCaseError>,
) {
    let compared = AtomicU32::new(0);
    let config = ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(cases) };
    let result = TestRunner::new(config).run(&strategy, |value| {
        compared.fetch_add(check(value)?.into(), Ordering::Relaxed);
        Ok(())
    });
    if let Err(fault) = result {
        panic!("{fault}");
    }
    let compared = compared.into_inner();
    assert!(compared > cases / 4, "only {compared} of {cases} cases compare anything");
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    [coordinate(), coordinate(), coordinate()]
}

#[test]
fn doubles_agree_with_the_tree() {
    check(5_000, (expression(Functions::All), point()), |(e, point)| {
        let expected = e.evaluate(&point.map(Rounded::exact));
        let Some(tape) = tape(&e).filter(|_| expected.is_known()) else { return Ok(false) };
        let Plain(value) = evaluate(&tape, point.map(Plain));
        prop_assert!(expected.agrees_with(value), "{} = {value}, not {expected:?}", e.text());
        Ok(true)
    });
}

/// A box, a larger one, and a point in the smaller.
fn boxes() -> impl Strategy<Value = [[f64; 5]; 3]> {
    let width = || prop_oneof![Just(0.0), 0.0..0.1, 0.0..4.0];
    let axis = || {
        let widths = [width(), width(), width(), width()];
        (coordinate(), widths).prop_map(|(x, [left, right, more_left, more_right])| {
            let (lo, hi) = (x - left, x + right);
            [lo - more_left, lo, x, hi, hi + more_right]
        })
    };
    [axis(), axis(), axis()]
}

fn interval<S: Scalar>(lo: f64, hi: f64) -> Interval<S, Set> {
    let (lo, hi) = (S::enclose_range(lo, lo)[0], S::enclose_range(hi, hi)[1]);
    Interval::new(lo, hi)
}

fn check_inclusion<S: Scalar>(e: &Expr, axes: [[f64; 5]; 3]) -> Result<bool, TestCaseError> {
    let Some(tape) = tape(e) else { return Ok(false) };
    let text = e.text();
    let inner = evaluate(&tape, axes.map(|[_, lo, _, hi, _]| interval::<S>(lo, hi)));
    let outer = evaluate(&tape, axes.map(|[lo, .., hi]| interval::<S>(lo, hi)));
    let is_nested = inner.is_empty() || outer.lo <= inner.lo && inner.hi <= outer.hi;
    prop_assert!(is_nested, "{text}: {inner:?} is not in {outer:?}");
    let value = e.evaluate(&axes.map(|[_, _, x, ..]| Nearly::exact(x)));
    let Some([lo, hi]) = value.bounds() else { return Ok(false) };
    // The value itself lies somewhere between two neighbouring doubles.
    let has = inner.lo.to_f64() <= hi && lo <= inner.hi.to_f64();
    prop_assert!(has, "{text}: {inner:?} lacks a value in [{lo}, {hi}]");
    Ok(true)
}

#[test]
fn double_intervals_contain_values_and_grow_with_their_boxes() {
    check(5_000, (expression(Functions::All), boxes()), |(e, axes)| {
        check_inclusion::<f64>(&e, axes)
    });
}

#[test]
fn single_intervals_contain_values_and_grow_with_their_boxes() {
    check(5_000, (expression(Functions::All), boxes()), |(e, axes)| {
        check_inclusion::<f32>(&e, axes)
    });
}

fn gradient<N: Number>(tape: &Tape, point: [N; 3]) -> [N; 3] {
    let [x, y, z] = point;
    let variables = [Dual::variable(x, 0), Dual::variable(y, 1), Dual::variable(z, 2)];
    evaluate(tape, variables).tangent
}

#[test]
fn duals_agree_with_symbolic_derivatives() {
    check(5_000, (expression(Functions::Smooth), point()), |(e, point)| {
        let Some(tape) = tape(&e) else { return Ok(false) };
        let slopes = gradient(&tape, point.map(Plain));
        let mut compared = false;
        for (axis, Plain(slope)) in slopes.into_iter().enumerate() {
            let expected = e.derivative(axis).evaluate(&point.map(Rounded::exact));
            // Where the slope is computed another way its rounding may be that of larger terms.
            let is_close = expected.agrees_with(slope)
                || (expected.value - slope).abs() <= 1e-6 * expected.value.abs().max(1.0);
            prop_assert!(
                !expected.is_known() || is_close,
                "{}: slope {slope} along {axis}, not {expected:?}",
                e.text()
            );
            compared |= expected.is_known() && expected.value != 0.0;
        }
        Ok(compared)
    });
}

#[test]
fn dual_intervals_contain_symbolic_derivatives() {
    check(3_000, (expression(Functions::Smooth), boxes()), |(e, axes)| {
        let Some(tape) = tape(&e) else { return Ok(false) };
        let slopes = gradient(&tape, axes.map(|[_, lo, _, hi, _]| interval::<f64>(lo, hi)));
        let point = axes.map(|[_, _, x, ..]| Nearly::exact(x));
        let mut compared = false;
        for (axis, slope) in slopes.into_iter().enumerate() {
            let Some([lo, hi]) = e.derivative(axis).evaluate(&point).bounds() else { continue };
            let has = slope.lo <= hi && lo <= slope.hi;
            prop_assert!(has, "{}: {slope:?} lacks [{lo}, {hi}] along {axis}", e.text());
            compared |= [lo, hi] != [0.0, 0.0];
        }
        Ok(compared)
    });
}
