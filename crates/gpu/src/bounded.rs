//! May a device's intervals be trusted on a domain?

use zeroset_expr::{Op, Tape};
use zeroset_ia::{Decorated, Decoration, Interval, Mirror, Scalar};
use zeroset_raycast::{Domain, Unsupported};

/// 2^100: sub-values are at most as large.
const LARGEST: f64 = f64::from_bits((1023 + 100) << 52);

/// The root-box check: over the domain, and a little beyond, every operation is defined, and every
/// sub-value is bounded, by the CPU's intervals and by the device's wider ones. Then this holds for every
/// smaller box too, which the device's intervals presuppose.
///
/// # Errors
/// If it does not hold, or the domain is out of single precision.
pub(crate) fn check(tape: &Tape, domain: &Domain) -> Result<(), Unsupported> {
    let refused = |why: &str| {
        Err(Unsupported(format!(
            "on this domain {why}; intervals on devices take functions that are defined and bounded \
             throughout in single precision: use a CPU method"
        )))
    };
    let reach = domain.min.abs().max(domain.max.abs()).max_element();
    if !(reach < LARGEST && domain.longest_side() > LARGEST.recip()) {
        return refused("coordinates are too large or too small");
    }
    let sides = around(domain).map(|[lo, hi]| f32::enclose_range(lo, hi));

    let mut bounded = true;
    let mut defined = true;
    let point = sides.map(|[lo, hi]| Decorated::new(Interval::new(lo, hi)));
    tape.evaluator(&point[0]).visit(point, |x| {
        bounded &= x.interval.is_bounded_by(LARGEST);
        defined &= x.decoration >= Decoration::Defined;
    });
    if !defined {
        return refused("the function is not defined everywhere");
    }
    let point = sides.map(|[lo, hi]| Interval::<Mirror>::new(Mirror(lo), Mirror(hi)));
    let within =
        |x: &Interval<Mirror>| -LARGEST <= f64::from(x.lo.0) && f64::from(x.hi.0) <= LARGEST;
    let portable = tape.instructions().iter().all(|i| match i.op {
        Op::Unary(f, _) => zeroset_ia::portable::has_unary(f),
        Op::Binary(f, ..) => zeroset_ia::portable::has_binary(f),
        _ => true,
    });
    // Without portable forms there is no shader either, which says what is missing.
    if bounded && portable {
        for divisor in divisors(tape) {
            let x = divisor.evaluator(&point[0]).evaluate(point);
            // A power's base, too.
            if !(x.lo.0 > 0.0 || x.hi.0 < 0.0) {
                return refused("a divisor may vanish");
            }
        }
        tape.evaluator(&point[0]).visit(point, |x| bounded &= within(x));
    }
    if bounded { Ok(()) } else { refused("the function is not bounded") }
}

/// The domain's box and a little more: the boxes of a ray in it reach some units in the last place beyond.
pub(crate) fn around(domain: &Domain) -> [[f64; 2]; 3] {
    let beyond = domain.min.abs().max(domain.max.abs()).max_element() * 2.0_f64.powi(-18);
    [0, 1, 2].map(|axis| [domain.min[axis] - beyond, domain.max[axis] + beyond])
}

/// By what is divided, each as a tape of its own.
fn divisors(tape: &Tape) -> impl Iterator<Item = Tape> {
    tape.instructions().iter().enumerate().filter_map(|(i, instruction)| {
        let divisor = match instruction.op {
            Op::Div(_, b) => b,
            Op::Powi(a, n) if n < 0 => a,
            _ => return None,
        };
        Some(Tape::new(tape.instructions()[..i].to_vec(), tape.constants().to_vec(), divisor))
    })
}
