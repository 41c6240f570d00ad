//! Interval operations, recorded and written as functions of the shading language.

use zeroset_expr::Op;
use zeroset_ia::{Binary, Interval, Number, Rounding, Unary, portable};
use zeroset_raycast::Unsupported;

use super::parts::{Parts, function};
use super::trace::Trace;

/// The marks: outward as `zeroset_ia::portable` has them. Working on bits, they also keep a compiler
/// from rewriting sums and products across them.
pub(super) fn marks(rounding: Rounding) -> &'static str {
    match rounding {
        Rounding::Nearest => include_str!("../shaders/nearest.wgsl"),
        Rounding::Outward | Rounding::Nudged => include_str!("../shaders/outward.wgsl"),
    }
}

/// An operation on one or two intervals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operation {
    Add,
    Sub,
    Mul,
    Div,
    Neg,
    Sqr,
    Powi(i32),
    Unary(Unary),
    Binary(Binary),
}

impl Operation {
    /// The operation of a tape; its constant is the second operand.
    pub(super) fn of(op: Op) -> Result<Self, Unsupported> {
        let none = |name: &str| {
            Err(Unsupported(format!("{name} has no interval form on devices; use a CPU method")))
        };
        Ok(match op {
            Op::Load(_) => unreachable!("a constant is no operation"),
            Op::Add(..) | Op::Offset(..) => Self::Add,
            Op::Sub(..) => Self::Sub,
            Op::Mul(..) | Op::Scale(..) => Self::Mul,
            Op::Div(..) => Self::Div,
            Op::Neg(_) => Self::Neg,
            Op::Sqr(_) => Self::Sqr,
            Op::Powi(_, n) => Self::Powi(n),
            Op::Powc(..) => Self::Binary(Binary::Pow),
            Op::Unary(f, _) if portable::has_unary(f) => Self::Unary(f),
            Op::Unary(f, _) => return none(f.name()),
            Op::Binary(f, ..) if portable::has_binary(f) => Self::Binary(f),
            Op::Binary(f, ..) => return none(f.name()),
        })
    }

    pub(super) fn name(self) -> String {
        match self {
            Self::Add => "interval_add".into(),
            Self::Sub => "interval_sub".into(),
            Self::Mul => "interval_mul".into(),
            Self::Div => "interval_div".into(),
            Self::Neg => "interval_neg".into(),
            Self::Sqr => "interval_sqr".into(),
            Self::Powi(n) if n < 0 => format!("interval_power_minus_{}", n.unsigned_abs()),
            Self::Powi(n) => format!("interval_power_{n}"),
            Self::Unary(f) => format!("interval_{f}"),
            Self::Binary(f) => format!("interval_{f}"),
        }
    }

    fn operands(self) -> usize {
        match self {
            Self::Add | Self::Sub | Self::Mul | Self::Div | Self::Binary(_) => 2,
            Self::Neg | Self::Sqr | Self::Powi(_) | Self::Unary(_) => 1,
        }
    }

    fn apply(self, x: Interval<Trace>, y: Interval<Trace>) -> Interval<Trace> {
        match self {
            Self::Add => x + y,
            Self::Sub => x - y,
            Self::Mul => x * y,
            Self::Div => x / y,
            Self::Neg => -x,
            Self::Sqr => x.sqr(),
            Self::Powi(n) => x.powi(n),
            Self::Unary(f) => x.unary(f),
            Self::Binary(f) => x.binary(f, y),
        }
    }

    /// The function in the shading language.
    pub(super) fn code(self) -> String {
        const WIDTH: usize = Interval::<Trace>::WIDTH;
        function(&self.name(), &vec![WIDTH; self.operands()], |reals| {
            let x = Interval::from_parts(&reals[..WIDTH]);
            let y = reals.get(WIDTH..2 * WIDTH).map_or(x, Interval::from_parts);
            self.apply(x, y)
        })
    }
}
