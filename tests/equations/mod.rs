//! What is evaluated: the surfaces of the catalogue and random equations, over nested boxes.
#![allow(dead_code, reason = "each test uses its part")]

use std::cell::Cell;

use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::TestRunner;
use zeroset_expr::{Function, Parameters, Tape};
use zeroset_ia::{BigInterval, Binary, Interval, Number, Scalar, Set, Unary};
use zeroset_raycast::catalogue::Catalogue;

/// Bits of what counts as exact.
const BITS: usize = 256;

/// A box in a box, and a point in the smaller: `[outer, inner, point, inner, outer]` on each axis.
pub(crate) type Nest = [[f64; 5]; 3];

#[inline(always)]
pub(crate) fn value<N: Number>(tape: &Tape, point: [N; 3]) -> N {
    tape.evaluator(&point[0]).evaluate(point)
}

pub(crate) fn around<S: Scalar>(lo: f64, hi: f64) -> Interval<S, Set> {
    Interval::new(S::enclose_range(lo, lo)[0], S::enclose_range(hi, hi)[1])
}

pub(crate) fn big(x: f64) -> BigInterval {
    BigInterval::from_f64(x, BITS)
}

/// Does an interval of floats hold a member of a narrow enclosure?
pub(crate) fn holds<S: Scalar>(x: Interval<S, Set>, exact: &BigInterval) -> bool {
    let x = BigInterval::from_bounds(x.lo.to_f64(), x.hi.to_f64(), BITS);
    !x.intersect(exact).is_empty()
}

pub(crate) fn is_in<S: Scalar>(x: Interval<S, Set>, outer: Interval<S, Set>) -> bool {
    x.is_empty() || outer.lo <= x.lo && x.hi <= outer.hi
}

/// Boxes in [min, max]^3, some of them points, flat, or with corners at round numbers.
fn nest(min: [f64; 3], max: [f64; 3]) -> impl Strategy<Value = Nest> {
    let place = || prop_oneof![1 => (0..13_i32).prop_map(|n| f64::from(n) / 12.0), 2 => 0.0..1.0];
    let width = || {
        let decades = (0.1..1.0, -9..0_i32).prop_map(|(m, e)| m * 10_f64.powi(e));
        prop_oneof![1 => Just(0.0), 3 => decades, 1 => 0.0..0.6]
    };
    let axis = || (place(), [width(), width(), width(), width()]);
    [axis(), axis(), axis()].prop_map(move |axes| {
        let mut k = 0;
        axes.map(|(place, widths)| {
            let side = max[k] - min[k];
            let x = min[k] + place * side;
            let [a, b, c, d] = widths.map(|w| w * side);
            k += 1;
            [x - a - b, x - a, x, x + c, x + c + d]
        })
    })
}

/// Random equations, every name of a function among them.
fn equation() -> impl Strategy<Value = String> {
    let number = select(&["0", "1", "2", "3", "0.1", "0.75", "2.5e2", "1e-3", "pi", "1/3"][..]);
    let leaf = prop_oneof![5 => select(&["x", "y", "z"][..]), 3 => number];
    let unary: Vec<_> = Unary::ALL.iter().map(|f| f.name()).collect();
    let binary: Vec<_> = Binary::ALL.iter().map(|f| f.name()).collect();
    leaf.prop_map(String::from).prop_recursive(5, 32, 2, move |inner| {
        let pair = (inner.clone(), inner.clone());
        let operator = select(&["+", "-", "*", "/"][..]);
        prop_oneof![
            8 => (operator, pair.clone()).prop_map(|(o, (a, b))| format!("({a}){o}({b})")),
            1 => inner.clone().prop_map(|a| format!("-({a})")),
            2 => (inner.clone(), -3..6).prop_map(|(a, n)| format!("({a})^{n}")),
            1 => inner.clone().prop_map(|a| format!("({a})^1.7")),
            3 => (select(unary.clone()), inner.clone()).prop_map(|(f, a)| format!("{f}({a})")),
            1 => (select(binary.clone()), pair).prop_map(|(f, (a, b))| format!("{f}({a}, {b})")),
        ]
    })
}

fn tape(function: &Function) -> Tape {
    function.tape(&Parameters::default(), BITS).expect("defaults are values")
}

/// Runs a check, which tells whether there was anything to compare, on many boxes of a tape.
fn run<S: Strategy>(
    cases: u32,
    strategy: S,
    check: impl Fn(S::Value) -> Result<bool, TestCaseError>,
) -> u32 {
    let compared = Cell::new(0);
    let config = ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(cases) };
    let result = TestRunner::new(config).run(&strategy, |value| {
        compared.set(compared.get() + u32::from(check(value)?));
        Ok(())
    });
    result.unwrap_or_else(|fault| panic!("{fault}"));
    compared.get()
}

pub(crate) type Check = fn(&Tape, &[Nest; LANES]) -> Result<bool, TestCaseError>;

/// Boxes in a check, one a lane.
pub(crate) const LANES: usize = 16;

fn nests(min: [f64; 3], max: [f64; 3]) -> impl Strategy<Value = [Nest; LANES]> {
    prop::collection::vec(nest(min, max), LANES).prop_map(|v| v.try_into().expect("so many"))
}

/// Runs a check on each surface of the catalogue, over its domain.
pub(crate) fn on_the_catalogue(cases: u32, check: Check) {
    for surface in Catalogue::builtin().functions() {
        let scene = surface.scene().expect("the catalogue is well formed");
        let tape = tape(&surface.function().expect("the catalogue is well formed"));
        let (min, max) = (scene.domain.min.to_array(), scene.domain.max.to_array());
        let compared = run(cases, nests(min, max), |boxes| {
            check(&tape, &boxes).map_err(|e| TestCaseError::fail(format!("{}: {e}", surface.id)))
        });
        assert!(4 * compared > cases, "{}: {compared} of {cases} compared", surface.id);
    }
}

/// Runs a check on random equations; those that the language refuses are passed over.
pub(crate) fn on_equations(cases: u32, check: Check) {
    let compared = run(cases, (equation(), nests([-3.0; 3], [3.0; 3])), |(text, boxes)| {
        let Ok(function) = Function::parse(&text) else { return Ok(false) };
        check(&tape(&function), &boxes)
            .map_err(|error| TestCaseError::fail(format!("{text}: {error}")))
    });
    assert!(4 * compared > cases, "{compared} of {cases} compared");
}

/// The exact value at the point of a nest.
pub(crate) fn exact(tape: &Tape, nest: &Nest) -> BigInterval {
    value(tape, nest.map(|axis| big(axis[2])))
}
