//! Numbers as the reals that they are made of, and functions recorded from what is done with these.

use zeroset_ia::{Affine, Interval};

use super::trace::{Node, Trace, record};

/// A number that a recorded function takes or gives.
pub trait Parts {
    /// How many reals it is made of: 1 is an `f32` of the shading language, 2 a `vec2f`, more an array.
    const WIDTH: usize;
    /// The number of these reals.
    fn from_parts(parts: &[Trace]) -> Self;
    /// Its reals.
    fn parts(&self) -> Vec<Trace>;
}

impl Parts for Trace {
    const WIDTH: usize = 1;

    fn from_parts(parts: &[Self]) -> Self {
        parts[0]
    }
    fn parts(&self) -> Vec<Self> {
        vec![*self]
    }
}

impl Parts for Interval<Trace> {
    const WIDTH: usize = 2;

    fn from_parts(parts: &[Trace]) -> Self {
        Self::new(parts[0], parts[1])
    }
    fn parts(&self) -> Vec<Trace> {
        self.bounds().to_vec()
    }
}

/// Centre, slopes, error, and the ends of the range.
impl Parts for Affine<Trace, 3> {
    const WIDTH: usize = 7;

    fn from_parts(parts: &[Trace]) -> Self {
        Self {
            centre: parts[0],
            slopes: [parts[1], parts[2], parts[3]],
            error: parts[4],
            range: Interval::new(parts[5], parts[6]),
        }
    }
    fn parts(&self) -> Vec<Trace> {
        let Self { centre, slopes: [a, b, c], error, range } = *self;
        vec![centre, a, b, c, error, range.lo, range.hi]
    }
}

/// The shading language's type of so many reals.
pub(super) fn type_of(width: usize) -> String {
    match width {
        1 => "f32".into(),
        2 => "vec2f".into(),
        n => format!("array<f32, {n}>"),
    }
}

/// A function of numbers of these widths, recorded from what `f` does with their reals.
pub(super) fn function<N: Parts>(
    name: &str,
    widths: &[usize],
    f: impl FnOnce(&[Trace]) -> N,
) -> String {
    let (nodes, results) = record(widths.iter().sum(), |reals| f(reals).parts());
    let names = ["a", "b", "c"];
    // The input's expression, real by real.
    let inputs: Vec<String> = widths
        .iter()
        .zip(names)
        .flat_map(|(&width, name)| (0..width).map(move |part| part_of(name, width, part)))
        .collect();
    let parameters: Vec<String> = widths
        .iter()
        .zip(names)
        .map(|(&width, name)| format!("{name}: {}", type_of(width)))
        .collect();
    let needed = needed(&nodes, &results);
    let result = type_of(N::WIDTH);
    let mut text = format!("fn {name}({}) -> {result} {{\n", parameters.join(", "));
    for (i, node) in nodes.iter().enumerate() {
        if needed[i] {
            text += &format!("    let v{i} = {};\n", node.expression(&inputs));
        }
    }
    let results: Vec<String> = results.iter().map(|r| format!("v{r}")).collect();
    let value = if N::WIDTH == 1 {
        results[0].clone()
    } else {
        format!("{result}({})", results.join(", "))
    };
    text + &format!("    return {value};\n}}\n\n")
}

/// A real of a number.
fn part_of(name: &str, width: usize, part: usize) -> String {
    match width {
        1 => name.into(),
        2 => format!("{name}.{}", ["x", "y"][part]),
        _ => format!("{name}[{part}]"),
    }
}

/// On which operations do the results depend?
fn needed(nodes: &[Node], results: &[u32]) -> Vec<bool> {
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

    fn expression(self, inputs: &[String]) -> String {
        match self {
            Self::Input(i) => inputs[i as usize].clone(),
            // By its bits: decimal literals are rounded by every compiler in its own way.
            Self::Literal(bits) => format!("bitcast<f32>({bits:#x}u)"),
            Self::Add(a, b) => format!("v{a} + v{b}"),
            Self::Sub(a, b) => format!("v{a} - v{b}"),
            Self::Mul(a, b) => format!("v{a} * v{b}"),
            Self::Div(a, b) => format!("v{a} / v{b}"),
            Self::Neg(a) => format!("-v{a}"),
            Self::Sqrt(a) => format!("sqrt(v{a})"),
            Self::Abs(a) => format!("abs(v{a})"),
            Self::Floor(a) => format!("floor(v{a})"),
            Self::Min(a, b) => format!("min(v{a}, v{b})"),
            Self::Max(a, b) => format!("max(v{a}, v{b})"),
            Self::SelectLt(a, b, x, y) => format!("select(v{y}, v{x}, v{a} < v{b})"),
            Self::Down(a, steps) => format!("step_down(v{a}, {steps}u)"),
            Self::Up(a, steps) => format!("step_up(v{a}, {steps}u)"),
            Self::Exp2Integer(a) => format!("bitcast<f32>(u32(i32(v{a}) + 127) << 23u)"),
            Self::Exponent(a) => format!("f32(i32(bitcast<u32>(v{a}) >> 23u) - 127)"),
        }
    }
}
