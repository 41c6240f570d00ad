//! The derivative of a tape along a direction, as a tape of its own.
//!
//! [`Dual`] has the rules of differentiation; here they are applied to symbols instead of values, and
//! what they do is written down. A tangent that is 0 because its operand is constant is left out, so
//! that the slope costs less than a dual.

use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::rc::Rc;

use zeroset_ia::constant::ZERO;
use zeroset_ia::{Binary, Constant, Dual, Number, Unary};

use crate::lower::allocate;
use crate::{Op, Tape};

/// x, y, z and the components of the direction.
const INPUTS: u32 = 6;

/// The tape whose value at (x, y, z, dx, dy, dz) is the derivative of `tape` along (dx, dy, dz).
pub(crate) fn slope(tape: &Tape) -> Tape {
    let recorder = Rc::new(RefCell::new(Recorder::default()));
    let symbol = |input| Symbol { recorder: recorder.clone(), value: Value::Place(input) };
    let zero = Dual::constant_value(symbol(0));
    let point =
        [0, 1, 2].map(|axis| Dual { value: symbol(axis), tangent: [symbol(axis + INPUTS / 2)] });
    let Dual { tangent: [slope], .. } = tape.evaluator(&zero).evaluate(point);
    let output = slope.place();
    let Recorder { ops, constants, .. } = recorder.take();
    let (ops, output) = needed(ops, output);
    let (instructions, output) = allocate(&ops, output, INPUTS);
    Tape::with_inputs(INPUTS, instructions, constants, output)
}

/// The operations so far: the k-th writes value `INPUTS + k`.
#[derive(Debug, Default)]
struct Recorder {
    ops: Vec<Op>,
    numbered: HashMap<Op, u32>,
    constants: Vec<Constant>,
    /// Where the constants that are doubles are.
    doubles: HashMap<u64, u32>,
}

impl Recorder {
    /// The value of an operation, old or new.
    fn push(&mut self, op: Op) -> u32 {
        *self.numbered.entry(op).or_insert_with(|| {
            self.ops.push(op);
            INPUTS + self.ops.len() as u32 - 1
        })
    }

    /// The place of a constant in the table.
    fn constant(&mut self, c: &Constant) -> u32 {
        let next = self.constants.len() as u32;
        let [lo, hi] = c.f64;
        let place = if lo == hi { *self.doubles.entry(lo.to_bits()).or_insert(next) } else { next };
        if place == next {
            self.constants.push(c.clone());
        }
        place
    }
}

/// A number that writes down what is done with it.
#[derive(Clone, Debug)]
struct Symbol {
    recorder: Rc<RefCell<Recorder>>,
    value: Value,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Value {
    /// The constant 0: nothing has to be computed.
    Zero,
    /// An input or the result of an operation.
    Place(u32),
}

impl Symbol {
    fn is_zero(&self) -> bool {
        self.value == Value::Zero
    }

    /// Where the value is; 0 is loaded.
    fn place(&self) -> u32 {
        match self.value {
            Value::Place(place) => place,
            Value::Zero => {
                let mut recorder = self.recorder.borrow_mut();
                let zero = recorder.constant(&ZERO);
                recorder.push(Op::Load(zero))
            }
        }
    }

    fn record(&self, op: Op) -> Self {
        let value = Value::Place(self.recorder.borrow_mut().push(op));
        Self { recorder: self.recorder.clone(), value }
    }

    /// Records an operation with a constant.
    fn record_with(&self, c: &Constant, op: impl Fn(u32) -> Op) -> Self {
        let constant = self.recorder.borrow_mut().constant(c);
        self.record(op(constant))
    }
}

impl Add for Symbol {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        match (self.is_zero(), o.is_zero()) {
            (true, _) => o,
            (_, true) => self,
            _ => self.record(Op::Add(self.place(), o.place())),
        }
    }
}

impl Sub for Symbol {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        match (self.is_zero(), o.is_zero()) {
            (_, true) => self,
            (true, _) => -o,
            _ => self.record(Op::Sub(self.place(), o.place())),
        }
    }
}

impl Mul for Symbol {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        match (self.is_zero(), o.is_zero()) {
            (true, _) => self,
            (_, true) => o,
            _ => self.record(Op::Mul(self.place(), o.place())),
        }
    }
}

impl Div for Symbol {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        if self.is_zero() { self } else { self.record(Op::Div(self.place(), o.place())) }
    }
}

impl Neg for Symbol {
    type Output = Self;
    fn neg(self) -> Self {
        if self.is_zero() { self } else { self.record(Op::Neg(self.place())) }
    }
}

impl Number for Symbol {
    fn constant(&self, c: &Constant) -> Self {
        if c.f64 == [0.0, 0.0] {
            Self { recorder: self.recorder.clone(), value: Value::Zero }
        } else {
            self.record_with(c, Op::Load)
        }
    }
    fn scale(self, c: &Constant) -> Self {
        if self.is_zero() { self } else { self.record_with(c, |c| Op::Scale(self.place(), c)) }
    }
    fn offset(self, c: &Constant) -> Self {
        if self.is_zero() {
            self.constant(c)
        } else {
            self.record_with(c, |c| Op::Offset(self.place(), c))
        }
    }
    fn sqr(self) -> Self {
        if self.is_zero() { self } else { self.record(Op::Sqr(self.place())) }
    }
    fn powi(self, n: i32) -> Self {
        self.record(Op::Powi(self.place(), n))
    }
    fn powc(self, c: &Constant) -> Self {
        self.record_with(c, |c| Op::Powc(self.place(), c))
    }
    fn unary(self, f: Unary) -> Self {
        self.record(Op::Unary(f, self.place()))
    }
    fn binary(self, f: Binary, o: Self) -> Self {
        self.record(Op::Binary(f, self.place(), o.place()))
    }
}

/// The operations on which the output depends, in order, and the output among them.
fn needed(ops: Vec<Op>, output: u32) -> (Vec<Op>, u32) {
    let mut is_needed = vec![false; INPUTS as usize + ops.len()];
    is_needed[output as usize] = true;
    for (k, op) in ops.iter().enumerate().rev() {
        if is_needed[INPUTS as usize + k] {
            op.operands().into_iter().flatten().for_each(|a| is_needed[a as usize] = true);
        }
    }
    let mut places: Vec<u32> = (0..INPUTS).collect();
    let mut kept = Vec::new();
    for (op, value) in ops.into_iter().zip(INPUTS as usize..) {
        // The place of a value that is dropped is never read.
        places.push(INPUTS + kept.len() as u32);
        if is_needed[value] {
            kept.push(op.map(|a| places[a as usize]));
        }
    }
    (kept, places[output as usize])
}
