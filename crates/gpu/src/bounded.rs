//! May a device's intervals be trusted on a domain?

use zeroset_expr::{Op, Tape};
use zeroset_ia::{Binary, Decorated, Decoration, Interval, Mirror, Scalar, Unary, portable};
use zeroset_raycast::{Domain, Unsupported};

/// 2^100: sub-values are at most as large.
const LARGEST: f64 = f64::from_bits((1023 + 100) << 52);

/// 2^50: what is squared within an operation is at most as large.
const LARGEST_SQUARED: f64 = f64::from_bits((1023 + 50) << 52);
/// 2^-16: a divisor is at least as large, as a part of the largest sub-value that it is made from.
const MARGIN: f64 = f64::from_bits((1023 - 16) << 52);

/// The root-box check: over the domain, and a little beyond, every operation is defined, and every
/// sub-value is bounded, by the CPU's intervals and by the device's wider ones. Then this holds for every
/// smaller box too, which the device's intervals presuppose.
///
/// # Errors
/// If it does not hold, or the domain is out of single precision.
pub fn check(tape: &Tape, domain: &Domain) -> Result<(), Unsupported> {
    check_within(tape, domain, LARGEST)
}

/// 2^50: sub-values of functions over affine forms are at most as large, so that their linear parts, which may
/// be larger than the values, do not overflow.
const LARGEST_AFFINE: f64 = f64::from_bits((1023 + 50) << 52);

/// The same for affine forms, which divide by sub-values, and need their squares too.
///
/// # Errors
/// If it does not hold, or the function divides or takes logarithms.
pub fn check_affine(tape: &Tape, domain: &Domain) -> Result<(), Unsupported> {
    let divides = |op| match op {
        Op::Div(..) => true,
        Op::Powi(_, n) => n < 0,
        Op::Unary(f, _) => {
            matches!(f, Unary::Log | Unary::Log2 | Unary::Log10 | Unary::Logp1)
        }
        _ => false,
    };
    if tape.instructions().iter().any(|instruction| divides(instruction.op)) {
        return Err(Unsupported(
            "affine forms on devices take functions without quotients and logarithms; use intervals, \
             or a CPU method"
                .into(),
        ));
    }
    check_within(tape, domain, LARGEST_AFFINE)
}

/// The check with another limit for sub-values.
fn check_within(tape: &Tape, domain: &Domain, largest: f64) -> Result<(), Unsupported> {
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

    // An operand that is out of range is not shown as a sub-value.
    let constants = tape.constants().iter().flat_map(portable::enclosure);
    if !constants.into_iter().all(|c| f64::from(c.abs()) <= largest) {
        return refused("a constant is too large");
    }

    let mut bounded = true;
    let mut defined = true;
    let point = sides.map(|[lo, hi]| Decorated::new(Interval::new(lo, hi)));
    tape.evaluator(&point[0]).visit(point, |x| {
        bounded &= x.interval.is_bounded_by(largest);
        defined &= x.decoration >= Decoration::Defined;
    });
    if !defined {
        return refused("the function is not defined everywhere");
    }
    let has_forms = tape.instructions().iter().all(|i| match i.op {
        Op::Unary(f, _) => portable::has_unary(f),
        Op::Binary(f, ..) => portable::has_binary(f),
        _ => true,
    });
    // Without portable forms there is no shader either, which says what is missing.
    if bounded && has_forms {
        let point = sides.map(|[lo, hi]| Interval::<Mirror>::new(Mirror(lo), Mirror(hi)));
        for (operand, role) in operands(tape) {
            // The value, and the largest on the way to it.
            let mut greatest = 0.0_f64;
            let x = operand.evaluator(&point[0]).visit(point, |x| {
                greatest = greatest.max(size(x));
            });
            match role {
                // The device may round otherwise than the mirror, by some units of what is largest.
                Role::Divisor if !(least(&x) > MARGIN * greatest.max(size(&x))) => {
                    return refused("a divisor may vanish");
                }
                Role::Squared if !(size(&x) <= LARGEST_SQUARED) => bounded = false,
                Role::Divisor | Role::Squared => {}
            }
        }
        tape.evaluator(&point[0]).visit(point, |x| bounded &= size(x) <= largest);
    }
    if bounded { Ok(()) } else { refused("the function is not bounded") }
}

/// The largest absolute value; NaN if an end is none.
fn size(x: &Interval<Mirror>) -> f64 {
    let [lo, hi] = x.bounds().map(|x| f64::from(x.0));
    if lo.is_nan() || hi.is_nan() { f64::NAN } else { lo.abs().max(hi.abs()) }
}

/// The smallest absolute value.
fn least(x: &Interval<Mirror>) -> f64 {
    let [lo, hi] = x.bounds().map(|x| f64::from(x.0));
    lo.max(-hi)
}

/// The domain's box and a little more: the boxes of a ray in it reach some units in the last place beyond.
pub(crate) fn around(domain: &Domain) -> [[f64; 2]; 3] {
    let beyond = domain.min.abs().max(domain.max.abs()).max_element() * 2.0_f64.powi(-18);
    [0, 1, 2].map(|axis| [domain.min[axis] - beyond, domain.max[axis] + beyond])
}

/// What an operand must not be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// Zero.
    Divisor,
    /// Beyond the root of what is bounded: the operation squares it within.
    Squared,
}

/// Operands on which there are conditions, each as a tape of its own.
fn operands(tape: &Tape) -> impl Iterator<Item = (Tape, Role)> {
    let before = |i: usize, operand| {
        Tape::new(tape.instructions()[..i].to_vec(), tape.constants().to_vec(), operand)
    };
    tape.instructions().iter().enumerate().flat_map(move |(i, instruction)| {
        let conditions = match instruction.op {
            Op::Div(_, b) => vec![(b, Role::Divisor)],
            Op::Powi(a, n) if n < 0 => vec![(a, Role::Divisor)],
            Op::Binary(Binary::Hypot, a, b) => vec![(a, Role::Squared), (b, Role::Squared)],
            _ => Vec::new(),
        };
        conditions.into_iter().map(move |(operand, role)| (before(i, operand), role))
    })
}
