//! Enclosures hold what they enclose, on every surface of the catalogue and on random equations.
//!
//! Values are compared with 256 bits. Where a decorated interval proves that f is defined at a point,
//! every enclosure over a box around the point holds the value there.

mod equations;

use equations::{
    LANES, Nest, around, big, exact, holds, is_in, on_equations, on_the_catalogue, value,
};
use proptest::prelude::*;
use zeroset_expr::Tape;
use zeroset_ia::{
    Affine, BigInterval, Decorated, Decoration, Dual, Interval, Number, Plain, Scalar,
};

/// Values are in enclosures, enclosures of boxes in those of larger ones.
fn check_inclusion<S: Scalar>(tape: &Tape, nest: &Nest) -> Result<bool, TestCaseError> {
    let boxes = [(0, 4), (1, 3), (2, 2)].map(|(i, j)| nest.map(|a| around::<S>(a[i], a[j])));
    let decorated = boxes.map(|b| value(tape, b.map(Decorated::new)));
    let sets = boxes.map(|b| value(tape, b));
    for [outer, inner] in [[0, 1], [1, 2]] {
        let (d, s) = ([decorated[inner], decorated[outer]], [sets[inner], sets[outer]]);
        prop_assert!(is_in(s[0], s[1]), "{:?} in {:?}, but {s:?}", boxes[inner], boxes[outer]);
        prop_assert!(is_in(d[0].interval, d[1].interval), "{:?}: {d:?}", boxes[outer]);
        prop_assert!(d[1].decoration <= d[0].decoration, "{:?}: {d:?}", boxes[outer]);
    }
    if decorated[2].decoration < Decoration::Defined {
        return Ok(false);
    }
    let exact = exact(tape, nest);
    for i in 0..3 {
        for x in [sets[i], decorated[i].interval] {
            prop_assert!(holds(x, &exact), "{:?}: {x:?} lacks {:?}", boxes[i], exact.to_f64());
        }
    }
    Ok(true)
}

fn check_both_precisions(tape: &Tape, nests: &[Nest; LANES]) -> Result<bool, TestCaseError> {
    let mut compared = false;
    for nest in nests {
        compared |= check_inclusion::<f32>(tape, nest)?;
        compared |= check_inclusion::<f64>(tape, nest)?;
    }
    Ok(compared)
}

fn variables<N: Number>([x, y, z]: [N; 3]) -> [Dual<N, 3>; 3] {
    [Dual::variable(x, 0), Dual::variable(y, 1), Dual::variable(z, 2)]
}

/// The mean slope between two points of an axis, the other coordinates those of the nest's point.
fn mean_slope(tape: &Tape, nest: &Nest, axis: usize, ends: [BigInterval; 2]) -> BigInterval {
    let [a, b] = ends.clone().map(|end| {
        let mut point = nest.map(|axis| big(axis[2]));
        point[axis] = end;
        value(tape, point)
    });
    let [lo, hi] = ends;
    (b - a) / (hi - lo)
}

/// Tangents hold the mean slopes across the box; slopes are the limits of mean slopes.
fn check_slopes(tape: &Tape, nests: &[Nest; LANES]) -> Result<bool, TestCaseError> {
    let mut compared = false;
    for nest in nests {
        let tiny = nest.map(|[_, _, x, ..]| {
            let step = f64::EPSILON * x.abs().max(1.0);
            [x, x - step, x, x + step, x]
        });
        for (nest, is_tiny) in [(nest, false), (&tiny, true)] {
            let boxes = nest.map(|[_, lo, _, hi, _]| around::<f64>(lo, hi));
            if !value(tape, boxes.map(Decorated::new)).is_continuous() {
                continue;
            }
            let mut bounded = true;
            let boxes = variables(boxes);
            let tangents = tape.evaluator(&boxes[0]).visit(boxes, |x| {
                bounded &= x.tangent.iter().chain([&x.value]).all(|x| x.is_bounded_by(1e100));
            });
            let slopes = value(tape, variables(nest.map(|axis| Plain(axis[2]))));
            for (axis, tangent) in tangents.tangent.into_iter().enumerate() {
                let [_, lo, x, hi, _] = nest[axis];
                if lo == hi || tangent.is_empty() {
                    continue;
                }
                let slope = mean_slope(tape, nest, axis, [big(lo), big(hi)]);
                let told = format!("{nest:?} along {axis}: {tangent:?} and {:?}", slope.to_f64());
                prop_assert!(holds(tangent, &slope), "{told}");
                compared = true;
                // A wide tangent is that of a kink, or close to a pole.
                let width = tangent.hi - tangent.lo;
                if !(is_tiny && bounded && width <= 1e-6 * tangent.hi.abs().max(1e-6)) {
                    continue;
                }
                let step = big(2_f64.powi(-80));
                let ends = [big(x) - step.clone(), big(x) + step];
                let limit = mean_slope(tape, nest, axis, ends);
                let Plain(found) = slopes.tangent[axis];
                let near = around::<f64>(found - 4.0 * width, found + 4.0 * width);
                prop_assert!(holds(near, &limit), "{told}: {found} {:?}", limit.to_f64());
            }
        }
    }
    Ok(compared)
}

/// Where raw intervals may be used, the value is within the error of the linear part, and in the interval.
fn check_affine<S: Scalar>(
    tape: &Tape,
    nest: &Nest,
    symbols: [usize; 3],
) -> Result<bool, TestCaseError> {
    let boxes = nest.map(|[_, lo, _, hi, _]| around::<S>(lo, hi));
    let mut is_raw = true;
    let decorated = boxes.map(Decorated::new);
    tape.evaluator(&decorated[0]).visit(decorated, |x| {
        is_raw &= x.interval.is_bounded_by(1e30) && x.decoration >= Decoration::Defined;
    });
    let mut forms = boxes.map(|x| Affine::<S, 3>::variable(Interval::new(x.lo, x.hi), 0));
    for (form, symbol) in forms.iter_mut().zip(symbols) {
        form.slopes.swap(0, symbol);
    }
    // The point in the box, by symbols; nearly as far as they go.
    let noise = nest.map(|[_, lo, x, hi, _]| {
        let share = if lo < hi { (x - lo) / (hi - lo) } else { 0.5 };
        big(0.998 * (2.0 * share.clamp(0.0, 1.0) - 1.0))
    });
    let linear = |form: &Affine<S, 3>| {
        let mut sum = big(form.centre.to_f64());
        for (slope, noise) in form.slopes.iter().zip(&noise) {
            sum = sum + big(slope.to_f64()) * noise.clone();
        }
        sum
    };
    let point = [0, 1, 2].map(|axis| linear(&forms[axis]));
    let is_inside = point.iter().zip(boxes).all(|(x, range)| holds(range, x));
    if !is_raw || !is_inside {
        return Ok(false);
    }
    let found = value(tape, forms);
    let exact = value(tape, point);
    let error = around::<S>(-found.error.to_f64(), found.error.to_f64());
    let off = exact.clone() - linear(&found);
    let told = || format!("{boxes:?}, {symbols:?}: {found:?}, but {:?}", exact.to_f64());
    prop_assert!(holds(error, &off), "{}, off by {:?}", told(), off.to_f64());
    let range = around::<S>(found.range.lo.to_f64(), found.range.hi.to_f64());
    prop_assert!(holds(range, &exact), "{}", told());
    Ok(true)
}

fn check_affine_forms(tape: &Tape, nests: &[Nest; LANES]) -> Result<bool, TestCaseError> {
    let mut compared = false;
    for nest in nests {
        for symbols in [[0, 1, 2], [0, 0, 1], [2, 2, 2]] {
            compared |= check_affine::<f32>(tape, nest, symbols)?;
            compared |= check_affine::<f64>(tape, nest, symbols)?;
        }
    }
    Ok(compared)
}

#[test]
fn values_are_in_affine_forms() {
    on_the_catalogue(5, check_affine_forms);
    on_equations(500, check_affine_forms);
}

#[test]
fn values_are_in_enclosures_and_enclosures_nest() {
    on_the_catalogue(5, check_both_precisions);
    on_equations(500, check_both_precisions);
}

#[test]
fn slopes_are_in_tangents() {
    on_the_catalogue(3, check_slopes);
    on_equations(200, check_slopes);
}
