//! Interval operations, recorded and written as functions of the shading language.

use zeroset_expr::Op;
use zeroset_ia::{Binary, Interval, Number, Rounding, Unary, portable};
use zeroset_raycast::Unsupported;

use super::trace::{Node, Trace, record};

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
        let (nodes, results) = record(2 * self.operands(), |ends| {
            let x = Interval::new(ends[0], ends[1]);
            let y = ends.get(2..4).map_or(x, |ends| Interval::new(ends[0], ends[1]));
            self.apply(x, y).bounds()
        });
        let needed = needed(&nodes, results);
        let parameters = if self.operands() == 2 { "a: vec2f, b: vec2f" } else { "a: vec2f" };
        let mut text = format!("fn {}({parameters}) -> vec2f {{\n", self.name());
        for (i, node) in nodes.iter().enumerate() {
            if needed[i] {
                text += &format!("    let v{i} = {};\n", expression(*node));
            }
        }
        text += &format!("    return vec2f(v{}, v{});\n}}\n\n", results[0], results[1]);
        text
    }
}

/// On which operations do the results depend?
fn needed(nodes: &[Node], results: [u32; 2]) -> Vec<bool> {
    let mut needed = vec![false; nodes.len()];
    results.iter().for_each(|r| needed[*r as usize] = true);
    for (i, node) in nodes.iter().enumerate().rev() {
        if needed[i] {
            node.operands().into_iter().flatten().for_each(|a| needed[a as usize] = true);
        }
    }
    needed
}

impl Node {
    fn operands(self) -> [Option<u32>; 4] {
        match self {
            Self::Input(_) | Self::Literal(_) => [None; 4],
            Self::Add(a, b)
            | Self::Sub(a, b)
            | Self::Mul(a, b)
            | Self::Div(a, b)
            | Self::Min(a, b)
            | Self::Max(a, b) => [Some(a), Some(b), None, None],
            Self::Neg(a)
            | Self::Sqrt(a)
            | Self::Abs(a)
            | Self::Floor(a)
            | Self::Down(a, _)
            | Self::Up(a, _)
            | Self::Exp2Integer(a)
            | Self::Exponent(a) => [Some(a), None, None, None],
            Self::SelectLt(a, b, x, y) => [a, b, x, y].map(Some),
        }
    }
}

fn expression(node: Node) -> String {
    match node {
        Node::Input(i) => format!("{}.{}", ["a", "b"][i as usize / 2], ["x", "y"][i as usize % 2]),
        // By its bits: decimal literals are rounded by every compiler in its own way.
        Node::Literal(bits) => format!("bitcast<f32>({bits:#x}u)"),
        Node::Add(a, b) => format!("v{a} + v{b}"),
        Node::Sub(a, b) => format!("v{a} - v{b}"),
        Node::Mul(a, b) => format!("v{a} * v{b}"),
        Node::Div(a, b) => format!("v{a} / v{b}"),
        Node::Neg(a) => format!("-v{a}"),
        Node::Sqrt(a) => format!("sqrt(v{a})"),
        Node::Abs(a) => format!("abs(v{a})"),
        Node::Floor(a) => format!("floor(v{a})"),
        Node::Min(a, b) => format!("min(v{a}, v{b})"),
        Node::Max(a, b) => format!("max(v{a}, v{b})"),
        Node::SelectLt(a, b, x, y) => format!("select(v{y}, v{x}, v{a} < v{b})"),
        Node::Down(a, steps) => format!("step_down(v{a}, {steps}u)"),
        Node::Up(a, steps) => format!("step_up(v{a}, {steps}u)"),
        Node::Exp2Integer(a) => format!("bitcast<f32>(u32(i32(v{a}) + 127) << 23u)"),
        Node::Exponent(a) => format!("f32(i32(bitcast<u32>(v{a}) >> 23u) - 127)"),
    }
}
