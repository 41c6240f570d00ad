//! Evaluators: tapes with room for their intermediate values.

use zeroset_ia::{Constant, Number};

use crate::plan::{LAST, Plan, Step, Task};
use crate::{Op, Register};

/// Evaluates a tape over one kind of number.
#[derive(Clone, Debug)]
pub struct Evaluator<'a, N> {
    plan: &'a Plan,
    constants: &'a [Constant],
    registers: Vec<N>,
}

impl<'a, N: Number> Evaluator<'a, N> {
    #[inline(always)]
    pub(crate) fn new(
        plan: &'a Plan,
        constants: &'a [Constant],
        registers: usize,
        context: &N,
    ) -> Self {
        Self { plan, constants, registers: vec![context.clone(); registers] }
    }

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
    pub fn visit(&mut self, point: [N; 3], inspect: impl FnMut(&N)) -> N {
        let [x, y, z] = point;
        self.bind(0, x);
        self.bind(1, y);
        self.bind(2, z);
        self.run(inspect)
    }

    /// Sets x, y or z (axis 0, 1, 2), or another of the tape's inputs, for the next [`run`](Self::run).
    #[inline(always)]
    pub fn bind(&mut self, axis: usize, value: N) {
        self.registers[axis] = value;
    }

    /// The function's value at the point that has been bound; a run may overwrite the point. Every
    /// sub-value is shown to `inspect`, in order.
    #[inline(always)]
    pub fn run(&mut self, mut inspect: impl FnMut(&N)) -> N {
        let r = &mut self.registers[..];
        let constants = self.constants;
        let mut last = r[0].clone();
        for &Step { task, out } in &self.plan.steps {
            let value = match task {
                Task::One(Op::Load(i)) => last.constant(&constants[i as usize]),
                Task::One(Op::Add(a, b)) => get(r, &last, a) + get(r, &last, b),
                Task::One(Op::Sub(a, b)) => get(r, &last, a) - get(r, &last, b),
                Task::One(Op::Mul(a, b)) => get(r, &last, a) * get(r, &last, b),
                Task::One(Op::Div(a, b)) => get(r, &last, a) / get(r, &last, b),
                Task::One(Op::Neg(a)) => -get(r, &last, a),
                Task::One(Op::Scale(a, i)) => get(r, &last, a).scale(&constants[i as usize]),
                Task::One(Op::Offset(a, i)) => get(r, &last, a).offset(&constants[i as usize]),
                Task::One(Op::Sqr(a)) => get(r, &last, a).sqr(),
                Task::One(Op::Powi(a, n)) => get(r, &last, a).powi(n),
                Task::One(Op::Powc(a, i)) => get(r, &last, a).powc(&constants[i as usize]),
                Task::One(Op::Unary(f, a)) => get(r, &last, a).unary(f),
                Task::One(Op::Binary(f, a, b)) => get(r, &last, a).binary(f, get(r, &last, b)),
                Task::AddScaled(a, b, i) => {
                    let scaled = get(r, &last, b).scale(&constants[i as usize]);
                    inspect(&scaled);
                    get(r, &last, a) + scaled
                }
                Task::SubScaled(a, b, i) => {
                    let scaled = get(r, &last, b).scale(&constants[i as usize]);
                    inspect(&scaled);
                    get(r, &last, a) - scaled
                }
                Task::ScaledSub(a, i, b) => {
                    let scaled = get(r, &last, a).scale(&constants[i as usize]);
                    inspect(&scaled);
                    scaled - get(r, &last, b)
                }
                Task::MulScaled(a, b, i) => {
                    let scaled = get(r, &last, b).scale(&constants[i as usize]);
                    inspect(&scaled);
                    get(r, &last, a) * scaled
                }
            };
            inspect(&value);
            if out != LAST {
                r[out as usize] = value.clone();
            }
            last = value;
        }
        get(r, &last, self.plan.result)
    }
}

#[inline(always)]
fn get<N: Clone>(registers: &[N], last: &N, i: Register) -> N {
    if i == LAST { last.clone() } else { registers[i as usize].clone() }
}
