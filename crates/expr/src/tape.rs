//! Tapes: straight lines of number operations.

use zeroset_ia::{Binary, Constant, Number, Unary};

use crate::plan::Plan;
use crate::{Evaluator, graph, slope};

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

impl Op {
    /// The registers that it reads.
    pub fn operands(self) -> [Option<Register>; 2] {
        match self {
            Self::Load(_) => [None, None],
            Self::Add(a, b)
            | Self::Sub(a, b)
            | Self::Mul(a, b)
            | Self::Div(a, b)
            | Self::Binary(_, a, b) => [Some(a), Some(b)],
            Self::Neg(a)
            | Self::Scale(a, _)
            | Self::Offset(a, _)
            | Self::Sqr(a)
            | Self::Powi(a, _)
            | Self::Powc(a, _)
            | Self::Unary(_, a) => [Some(a), None],
        }
    }

    /// The constant that it reads.
    pub fn constant(self) -> Option<u32> {
        match self {
            Self::Load(c) | Self::Scale(_, c) | Self::Offset(_, c) | Self::Powc(_, c) => Some(c),
            _ => None,
        }
    }

    /// The same operation on other registers.
    pub(crate) fn map(self, mut f: impl FnMut(Register) -> Register) -> Self {
        match self {
            Self::Load(c) => Self::Load(c),
            Self::Add(a, b) => Self::Add(f(a), f(b)),
            Self::Sub(a, b) => Self::Sub(f(a), f(b)),
            Self::Mul(a, b) => Self::Mul(f(a), f(b)),
            Self::Div(a, b) => Self::Div(f(a), f(b)),
            Self::Neg(a) => Self::Neg(f(a)),
            Self::Scale(a, c) => Self::Scale(f(a), c),
            Self::Offset(a, c) => Self::Offset(f(a), c),
            Self::Sqr(a) => Self::Sqr(f(a)),
            Self::Powi(a, n) => Self::Powi(f(a), n),
            Self::Powc(a, c) => Self::Powc(f(a), c),
            Self::Unary(g, a) => Self::Unary(g, f(a)),
            Self::Binary(g, a, b) => Self::Binary(g, f(a), f(b)),
        }
    }

    /// Is it defined and continuous for all real operands?
    pub fn is_continuous(self) -> bool {
        match self {
            Self::Div(..) | Self::Powc(..) => false,
            Self::Powi(_, n) => n >= 0,
            Self::Unary(f, _) => {
                graph::is_total(f) && !matches!(f, Unary::Sign | Unary::Floor | Unary::Ceil)
            }
            Self::Binary(f, ..) => matches!(f, Binary::Min | Binary::Max | Binary::Hypot),
            _ => true,
        }
    }
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
    inputs: usize,
    instructions: Vec<Instruction>,
    constants: Vec<Constant>,
    registers: usize,
    output: Register,
    plan: Plan,
}

impl Tape {
    /// A tape from its parts.
    ///
    /// # Panics
    /// If an instruction refers to a register that has not been written, or to a missing constant.
    pub fn new(instructions: Vec<Instruction>, constants: Vec<Constant>, output: Register) -> Self {
        Self::with_inputs(3, instructions, constants, output)
    }

    /// A tape whose first registers hold the given number of inputs.
    pub(crate) fn with_inputs(
        inputs: u32,
        instructions: Vec<Instruction>,
        constants: Vec<Constant>,
        output: Register,
    ) -> Self {
        let mut written = vec![true; inputs as usize];
        let read = |written: &[bool], r: Register| {
            let is_written = written.get(r as usize) == Some(&true);
            assert!(is_written, "register {r} is read before it is set");
        };
        for Instruction { op, out } in &instructions {
            op.operands().into_iter().flatten().for_each(|r| read(&written, r));
            if let Some(c) = op.constant() {
                assert!((c as usize) < constants.len(), "no constant {c}");
            }
            let out = *out as usize;
            if written.len() <= out {
                written.resize(out + 1, false);
            }
            written[out] = true;
        }
        read(&written, output);
        let plan = Plan::new(&instructions, output);
        let (inputs, registers) = (inputs as usize, written.len());
        Self { inputs, instructions, constants, registers, output, plan }
    }

    /// The derivative along a direction, as a tape over (x, y, z, dx, dy, dz): an evaluator's
    /// [`bind`](Evaluator::bind) takes the components of the direction as axes 3, 4 and 5.
    ///
    /// The rules, and what an interval's slope encloses, are those of [`Dual`](zeroset_ia::Dual).
    pub fn slope(&self) -> Self {
        slope::slope(self)
    }

    /// How many registers hold inputs: x, y and z, and for a slope the direction.
    pub fn inputs(&self) -> usize {
        self.inputs
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

    /// The number of registers that an evaluator needs.
    pub fn registers(&self) -> usize {
        self.registers
    }

    /// The total degree, if this is a polynomial in x, y, z.
    ///
    /// Terms that cancel are counted, so the true degree may be lower.
    pub fn degree(&self) -> Option<u32> {
        let mut degrees = vec![Some(1_u32); self.registers];
        for Instruction { op, out } in &self.instructions {
            let [a, b] = op.operands().map(|r| r.and_then(|r| degrees[r as usize]));
            degrees[*out as usize] = match *op {
                Op::Load(_) => Some(0),
                Op::Add(..) | Op::Sub(..) => a.zip(b).map(|(a, b)| a.max(b)),
                Op::Mul(..) => a.zip(b).map(|(a, b)| a.saturating_add(b)),
                Op::Neg(_) | Op::Scale(..) | Op::Offset(..) => a,
                Op::Sqr(_) => a.map(|a| a.saturating_mul(2)),
                Op::Powi(_, n) => a.zip(u32::try_from(n).ok()).map(|(a, n)| a.saturating_mul(n)),
                Op::Div(..) | Op::Powc(..) | Op::Unary(..) | Op::Binary(..) => None,
            };
        }
        degrees[self.output as usize]
    }

    /// Is the function continuous on all of space because each of its operations is?
    ///
    /// False for divisions, roots, logarithms, jumps and the like: their values have to be looked at.
    pub fn is_continuous(&self) -> bool {
        self.instructions.iter().all(|i| i.op.is_continuous())
    }

    /// An evaluator over numbers like `context`, which it reuses from call to call.
    #[inline(always)]
    pub fn evaluator<N: Number>(&self, context: &N) -> Evaluator<'_, N> {
        Evaluator::new(&self.plan, &self.constants, self.registers, context)
    }
}
