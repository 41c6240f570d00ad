//! Tapes: straight lines of number operations.

use zeroset_ia::{Binary, Constant, Number, Unary};

/// A place for an intermediate value; the first three hold x, y and z.
pub type Register = u32;

/// One operation of [`Number`]; constants are indices into the tape's table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// The constant itself.
    Load(u32),
    /// a + b.
    Add(Register, Register),
    /// a - b.
    Sub(Register, Register),
    /// a b.
    Mul(Register, Register),
    /// a / b.
    Div(Register, Register),
    /// -a.
    Neg(Register),
    /// c a.
    Scale(Register, u32),
    /// a + c.
    Offset(Register, u32),
    /// a^2.
    Sqr(Register),
    /// a^n.
    Powi(Register, i32),
    /// a^c.
    Powc(Register, u32),
    /// f(a).
    Unary(Unary, Register),
    /// f(a, b).
    Binary(Binary, Register, Register),
}

/// An operation and where its result goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Instruction {
    /// What to do.
    pub op: Op,
    /// Where the result goes.
    pub out: Register,
}

/// A function with values for its parameters, ready for evaluation over any number.
#[derive(Clone, Debug)]
pub struct Tape {
    instructions: Vec<Instruction>,
    constants: Vec<Constant>,
    registers: usize,
    output: Register,
}

impl Tape {
    /// A tape from its parts.
    ///
    /// # Panics
    /// If an instruction refers to a register that has not been written, or to a missing constant.
    pub fn new(instructions: Vec<Instruction>, constants: Vec<Constant>, output: Register) -> Self {
        let mut written = vec![true; 3];
        let read = |written: &[bool], r: Register| {
            assert!(
                written.get(r as usize) == Some(&true),
                "register {r} is read before it is set"
            );
        };
        for Instruction { op, out } in &instructions {
            let constant = |c: u32| assert!((c as usize) < constants.len(), "no constant {c}");
            match *op {
                Op::Load(c) => constant(c),
                Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Div(a, b) => {
                    read(&written, a);
                    read(&written, b);
                }
                Op::Binary(_, a, b) => {
                    read(&written, a);
                    read(&written, b);
                }
                Op::Neg(a) | Op::Sqr(a) | Op::Powi(a, _) | Op::Unary(_, a) => read(&written, a),
                Op::Scale(a, c) | Op::Offset(a, c) | Op::Powc(a, c) => {
                    read(&written, a);
                    constant(c);
                }
            }
            let out = *out as usize;
            if written.len() <= out {
                written.resize(out + 1, false);
            }
            written[out] = true;
        }
        read(&written, output);
        Self { instructions, constants, registers: written.len(), output }
    }

    /// The operations in order.
    pub fn instructions(&self) -> &[Instruction] {
        &self.instructions
    }

    /// The constants that operations refer to.
    pub fn constants(&self) -> &[Constant] {
        &self.constants
    }

    /// The register that holds the result.
    pub fn output(&self) -> Register {
        self.output
    }

    /// The total degree in x, y and z, if the operations make a polynomial.
    pub fn degree(&self) -> Option<u32> {
        let mut degrees = vec![Some(1_u32); self.registers];
        for &Instruction { op, out } in &self.instructions {
            let of = |r: Register| degrees[r as usize];
            degrees[out as usize] = match op {
                Op::Load(_) => Some(0),
                Op::Add(a, b) | Op::Sub(a, b) => of(a).zip(of(b)).map(|(a, b)| a.max(b)),
                Op::Mul(a, b) => of(a).zip(of(b)).and_then(|(a, b)| a.checked_add(b)),
                Op::Neg(a) | Op::Scale(a, _) | Op::Offset(a, _) => of(a),
                Op::Sqr(a) => of(a).and_then(|a| a.checked_mul(2)),
                Op::Powi(a, n) if n >= 0 => of(a).and_then(|a| a.checked_mul(n.unsigned_abs())),
                Op::Div(..) | Op::Powi(..) | Op::Powc(..) | Op::Unary(..) | Op::Binary(..) => None,
            };
        }
        degrees[self.output as usize]
    }

    /// Is the function defined and continuous everywhere, whatever its arguments?
    pub fn is_everywhere_continuous(&self) -> bool {
        self.instructions.iter().all(|i| match i.op {
            Op::Div(..) | Op::Powc(..) => false,
            Op::Powi(_, n) => n >= 0,
            Op::Unary(f, _) => matches!(
                f,
                Unary::Abs
                    | Unary::Cbrt
                    | Unary::Exp
                    | Unary::Exp2
                    | Unary::Exp10
                    | Unary::Expm1
                    | Unary::Sin
                    | Unary::Cos
                    | Unary::Atan
                    | Unary::Sinh
                    | Unary::Cosh
                    | Unary::Tanh
                    | Unary::Asinh
            ),
            Op::Binary(f, ..) => matches!(f, Binary::Min | Binary::Max | Binary::Hypot),
            _ => true,
        })
    }

    /// An evaluator over numbers like `context`, which it reuses from call to call.
    #[inline(always)]
    pub fn evaluator<N: Number>(&self, context: &N) -> Evaluator<'_, N> {
        Evaluator { tape: self, registers: vec![context.clone(); self.registers] }
    }
}

/// A tape with room for its intermediate values.
#[derive(Clone, Debug)]
pub struct Evaluator<'a, N> {
    tape: &'a Tape,
    registers: Vec<N>,
}

impl<N: Number> Evaluator<'_, N> {
    /// The function's value at (x, y, z).
    #[inline(always)]
    pub fn evaluate(&mut self, point: [N; 3]) -> N {
        self.visit(
            point,
            #[inline(always)]
            |_| {},
        )
    }

    /// The function's value at (x, y, z); every sub-value is shown to `inspect`, in order.
    #[inline(always)]
    pub fn visit(&mut self, point: [N; 3], mut inspect: impl FnMut(&N)) -> N {
        let [x, y, z] = point;
        let r = &mut self.registers[..];
        r[0] = x;
        r[1] = y;
        r[2] = z;
        let constants = &self.tape.constants[..];
        for &Instruction { op, out } in &self.tape.instructions {
            let value = match op {
                Op::Load(i) => r[0].constant(&constants[i as usize]),
                Op::Add(a, b) => get(r, a) + get(r, b),
                Op::Sub(a, b) => get(r, a) - get(r, b),
                Op::Mul(a, b) => get(r, a) * get(r, b),
                Op::Div(a, b) => get(r, a) / get(r, b),
                Op::Neg(a) => -get(r, a),
                Op::Scale(a, i) => get(r, a).scale(&constants[i as usize]),
                Op::Offset(a, i) => get(r, a).offset(&constants[i as usize]),
                Op::Sqr(a) => get(r, a).sqr(),
                Op::Powi(a, n) => get(r, a).powi(n),
                Op::Powc(a, i) => get(r, a).powc(&constants[i as usize]),
                Op::Unary(f, a) => get(r, a).unary(f),
                Op::Binary(f, a, b) => get(r, a).binary(f, get(r, b)),
            };
            inspect(&value);
            r[out as usize] = value;
        }
        r[self.tape.output as usize].clone()
    }
}

#[inline(always)]
fn get<N: Clone>(registers: &[N], i: Register) -> N {
    registers[i as usize].clone()
}
