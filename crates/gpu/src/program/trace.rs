//! A real that writes down what is done with it.

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

use zeroset_ia::portable::{self, DIVISION_STEPS, ROOT_STEPS};
use zeroset_ia::{Binary, Constant, Portable, Real, Unary};

/// An operation on floats; operands are numbers of earlier ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Node {
    /// The n-th float given.
    Input(u32),
    /// The float with these bits.
    Literal(u32),
    Add(u32, u32),
    Sub(u32, u32),
    Mul(u32, u32),
    Div(u32, u32),
    Neg(u32),
    Sqrt(u32),
    Abs(u32),
    Floor(u32),
    Min(u32, u32),
    Max(u32, u32),
    /// The third where the first is less than the second, else the fourth.
    SelectLt(u32, u32, u32, u32),
    /// So many floats down.
    Down(u32, u32),
    /// So many floats up.
    Up(u32, u32),
    /// 2 to an integer.
    Exp2Integer(u32),
    Exponent(u32),
}

#[derive(Default)]
struct Recorder {
    nodes: Vec<Node>,
    numbers: HashMap<Node, u32>,
}

thread_local! {
    // A real is a copy of a few bits and cannot own what it writes to.
    static RECORDER: RefCell<Recorder> = RefCell::default();
}

/// The result of a recorded operation: a real of which only what is done with it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trace(u32);

/// Records what `work` does with so many floats; gives all operations, each of which is there once, and
/// the numbers of the results.
pub(super) fn record(
    inputs: usize,
    work: impl FnOnce(&[Trace]) -> Vec<Trace>,
) -> (Vec<Node>, Vec<u32>) {
    RECORDER.take();
    let inputs: Vec<Trace> = (0..inputs as u32).map(|i| Trace::of(Node::Input(i))).collect();
    let results = work(&inputs).into_iter().map(|t| t.0).collect();
    (RECORDER.take().nodes, results)
}

impl Trace {
    fn of(node: Node) -> Self {
        RECORDER.with_borrow_mut(|Recorder { nodes, numbers }| {
            Self(*numbers.entry(node).or_insert_with(|| {
                nodes.push(node);
                nodes.len() as u32 - 1
            }))
        })
    }
}

impl Add for Trace {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::of(Node::Add(self.0, o.0))
    }
}

impl Sub for Trace {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::of(Node::Sub(self.0, o.0))
    }
}

impl Mul for Trace {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self::of(Node::Mul(self.0, o.0))
    }
}

impl Div for Trace {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        Self::of(Node::Div(self.0, o.0))
    }
}

impl Neg for Trace {
    type Output = Self;
    fn neg(self) -> Self {
        Self::of(Node::Neg(self.0))
    }
}

impl Real for Trace {
    type Scalar = f32;
    const OUTWARD: bool = true;

    fn splat(self, c: f32) -> Self {
        Self::of(Node::Literal(c.to_bits()))
    }
    fn sqrt(self) -> Self {
        Self::of(Node::Sqrt(self.0))
    }
    fn abs(self) -> Self {
        Self::of(Node::Abs(self.0))
    }
    fn floor(self) -> Self {
        Self::of(Node::Floor(self.0))
    }
    fn min(self, o: Self) -> Self {
        Self::of(Node::Min(self.0, o.0))
    }
    fn max(self, o: Self) -> Self {
        Self::of(Node::Max(self.0, o.0))
    }
    fn select_lt(self, o: Self, x: Self, y: Self) -> Self {
        Self::of(Node::SelectLt(self.0, o.0, x.0, y.0))
    }
    fn down(self) -> Self {
        Self::of(Node::Down(self.0, 1))
    }
    fn up(self) -> Self {
        Self::of(Node::Up(self.0, 1))
    }
    fn div_down(self, o: Self) -> Self {
        Self::of(Node::Down((self / o).0, DIVISION_STEPS))
    }
    fn div_up(self, o: Self) -> Self {
        Self::of(Node::Up((self / o).0, DIVISION_STEPS))
    }
    fn sqrt_down(self) -> Self {
        Self::of(Node::Down(self.sqrt().0, ROOT_STEPS))
    }
    fn sqrt_up(self) -> Self {
        Self::of(Node::Up(self.sqrt().0, ROOT_STEPS))
    }
    fn map<const N: usize, const M: usize>(
        _: [Self; N],
        _: impl Fn([f32; N]) -> [f32; M],
    ) -> [Self; M] {
        unreachable!("what is recorded has no value yet; ranges have portable forms");
    }
    fn unary_range(f: Unary, x: [Self; 2]) -> [Self; 2] {
        portable::unary_range(f, x)
    }
    fn binary_range(f: Binary, x: [Self; 2], y: [Self; 2]) -> [Self; 2] {
        portable::binary_range(f, x, y)
    }
    fn power_range(x: [Self; 2], c: &Constant) -> [Self; 2] {
        let y = portable::enclosure(c).map(|c| x[0].splat(c));
        portable::binary_range(Binary::Pow, x, y)
    }
}

impl Portable for Trace {
    fn exp2_integer(self) -> Self {
        Self::of(Node::Exp2Integer(self.0))
    }
    fn exponent(self) -> Self {
        Self::of(Node::Exponent(self.0))
    }
}
