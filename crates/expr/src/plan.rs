//! Plans: how an evaluator runs a tape. The operations and their results are the tape's; fewer steps
//! and fewer trips through registers make it faster.

use std::collections::BTreeSet;

use crate::{Instruction, Op, Register};

/// An operation, or two of which the first scales an operand of the second by a constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Task {
    One(Op),
    /// a + c b.
    AddScaled(Register, Register, u32),
    /// a - c b.
    SubScaled(Register, Register, u32),
    /// c a - b.
    ScaledSub(Register, u32, Register),
    /// a (c b).
    MulScaled(Register, Register, u32),
}

impl Task {
    fn renamed(self, mut name: impl FnMut(Register) -> Register) -> Self {
        match self {
            Self::One(op) => Self::One(op.map(name)),
            Self::AddScaled(a, b, c) => Self::AddScaled(name(a), name(b), c),
            Self::SubScaled(a, b, c) => Self::SubScaled(name(a), name(b), c),
            Self::ScaledSub(a, c, b) => Self::ScaledSub(name(a), c, name(b)),
            Self::MulScaled(a, b, c) => Self::MulScaled(name(a), name(b), c),
        }
    }

    /// The task with its operand `scaled`, which is `c a`, replaced; `None` if there is no such task.
    fn with_scaled(self, scaled: Register, a: Register, c: u32) -> Option<Self> {
        let Self::One(op) = self else { return None };
        match op {
            Op::Add(x, s) | Op::Add(s, x) if s == scaled => Some(Self::AddScaled(x, a, c)),
            Op::Sub(x, s) if s == scaled => Some(Self::SubScaled(x, a, c)),
            Op::Sub(s, x) if s == scaled => Some(Self::ScaledSub(a, c, x)),
            Op::Mul(x, s) | Op::Mul(s, x) if s == scaled => Some(Self::MulScaled(x, a, c)),
            _ => None,
        }
    }
}

/// A task and where its result goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Step {
    pub task: Task,
    pub out: Register,
}

/// In place of a register: the result of the step before, which most steps read. It is passed on
/// directly, and goes to a register only if a later step reads it there.
pub(crate) const LAST: Register = Register::MAX;

/// The steps of a tape.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub steps: Vec<Step>,
    /// Where the function's value is in the end.
    pub result: Register,
}

impl Plan {
    pub(crate) fn new(instructions: &[Instruction], output: Register) -> Self {
        let mut steps = fuse(instructions, output);
        let result = match steps.last() {
            Some(last) if last.out == output => LAST,
            _ => output,
        };
        // Backwards, with the registers that are read further on.
        let mut read = BTreeSet::from([result]);
        for i in (0..steps.len()).rev() {
            let before = i.checked_sub(1).map(|i| steps[i].out);
            let Step { task, out } = &mut steps[i];
            if !read.remove(out) {
                *out = LAST;
            }
            *task = task.renamed(|r| {
                if Some(r) == before {
                    return LAST;
                }
                read.insert(r);
                r
            });
        }
        Self { steps, result }
    }
}

/// The instructions as steps, scalings joined with the only step that reads them.
fn fuse(instructions: &[Instruction], output: Register) -> Vec<Step> {
    let step = |i: &Instruction| Some(Step { task: Task::One(i.op), out: i.out });
    let mut steps: Vec<Option<Step>> = instructions.iter().map(step).collect();
    for (i, instruction) in instructions.iter().enumerate() {
        let Instruction { op: Op::Scale(a, c), out } = *instruction else { continue };
        let Some(j) = only_reader(instructions, i, output) else { continue };
        let is_unchanged = instructions[i + 1..j].iter().all(|between| between.out != a);
        if let Some(reader) = &mut steps[j]
            && is_unchanged
            && let Some(task) = reader.task.with_scaled(out, a, c)
        {
            reader.task = task;
            steps[i] = None;
        }
    }
    steps.into_iter().flatten().collect()
}

/// The only instruction that reads what instruction `i` writes, and reads it once.
fn only_reader(instructions: &[Instruction], i: usize, output: Register) -> Option<usize> {
    let written = instructions[i].out;
    let mut reader = None;
    for (j, Instruction { op, out }) in instructions.iter().enumerate().skip(i + 1) {
        let mut reads = 0;
        op.map(|r| {
            reads += usize::from(r == written);
            r
        });
        if reads > 1 || reads == 1 && reader.is_some() {
            return None;
        }
        if reads == 1 {
            reader = Some(j);
        }
        if *out == written {
            return reader;
        }
    }
    if written == output { None } else { reader }
}
