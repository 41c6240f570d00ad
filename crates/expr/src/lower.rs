//! Expressions to tapes.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

use num_traits::One;
use zeroset_ia::{Binary, Constant, Unary};

use crate::graph::{Graph, Id, Node};
use crate::prelude::{self, Fault, Prelude};
use crate::rational::integer;
use crate::tape::{Instruction, Op, Register, Tape};

/// The tape of the expression at `root`, which has no Chebyshev polynomials of variables.
///
/// # Errors
/// If a constant is beyond double precision, or an integer exponent too large.
pub(crate) fn lower(graph: &Graph, root: Id, prelude: &Prelude) -> Result<Tape, Fault> {
    let mut lowering = Lowering {
        graph,
        prelude,
        ops: Vec::new(),
        numbered: HashMap::new(),
        constants: Vec::new(),
        constant_places: HashMap::new(),
        places: HashMap::new(),
    };
    for id in schedule(graph, root) {
        let place = lowering.lower(id).map_err(|message| Fault { id, message })?;
        lowering.places.insert(id, place);
    }
    let (instructions, output) = allocate(&lowering.ops, lowering.places[&root], 3);
    Ok(Tape::new(instructions, lowering.constants, output))
}

/// The nodes that depend on x, y, z, operands first, ordered so that few values live at once.
///
/// The operand that needs more registers comes first [Sethi and Ullman 1970].
fn schedule(graph: &Graph, root: Id) -> Vec<Id> {
    let varying = |id: Id| graph.node(id).operands().map(|a| a.filter(|a| !graph.is_constant(*a)));
    let mut needs = vec![0_u32; graph.len()];
    for id in graph.postorder(root, varying) {
        needs[id as usize] = match varying(id).map(|a| a.map(|a| needs[a as usize])) {
            [Some(a), Some(b)] if a == b => a + 1,
            [a, b] => a.max(b).unwrap_or(0).max(1),
        };
    }
    graph.postorder(root, |id| match varying(id) {
        [Some(a), Some(b)] if needs[b as usize] > needs[a as usize] => [Some(b), Some(a)],
        operands => operands,
    })
}

/// Operations in order: the k-th writes value 3 + k, and the first three values are x, y, z.
struct Lowering<'a> {
    graph: &'a Graph,
    prelude: &'a Prelude,
    ops: Vec<Op>,
    numbered: HashMap<Op, u32>,
    constants: Vec<Constant>,
    constant_places: HashMap<Id, u32>,
    places: HashMap<Id, u32>,
}

impl Lowering<'_> {
    /// The value of a node whose operands were lowered.
    fn lower(&mut self, id: Id) -> Result<u32, String> {
        let is_constant = |id| self.graph.is_constant(id);
        let op = match *self.graph.node(id) {
            Node::Variable(axis) => return Ok(axis.into()),
            Node::Add(a, c) if is_constant(c) => Op::Offset(self.place(a)?, self.constant(c)?),
            Node::Sub(c, a) if is_constant(c) => {
                let negative = Op::Neg(self.place(a)?);
                Op::Offset(self.push(negative), self.constant(c)?)
            }
            Node::Mul(c, a) if is_constant(c) => Op::Scale(self.place(a)?, self.constant(c)?),
            Node::Add(a, b) => Op::Add(self.place(a)?, self.place(b)?),
            Node::Sub(a, b) => Op::Sub(self.place(a)?, self.place(b)?),
            Node::Mul(a, b) => Op::Mul(self.place(a)?, self.place(b)?),
            Node::Div(a, b) => Op::Div(self.place(a)?, self.place(b)?),
            Node::Neg(a) => Op::Neg(self.place(a)?),
            Node::Power(a, b) if is_constant(b) => return self.power(a, b),
            Node::Power(a, b) => Op::Binary(Binary::Pow, self.place(a)?, self.place(b)?),
            Node::Unary(f, a) => Op::Unary(f, self.place(a)?),
            Node::Binary(f, a, b) => Op::Binary(f, self.place(a)?, self.place(b)?),
            ref node @ (Node::Number(_)
            | Node::Pi
            | Node::Parameter(..)
            | Node::Root(_)
            | Node::Chebyshev(..)) => unreachable!("{node:?} is a constant or was expanded"),
        };
        Ok(self.push(op))
    }

    /// a^b with a constant exponent.
    fn power(&mut self, a: Id, b: Id) -> Result<u32, String> {
        let exponent = self.prelude.value(b);
        let half = exponent.exact().is_some_and(|r| (r * integer(2)).is_one());
        let integer = exponent.integer();
        let a = self.place(a)?;
        let op = match integer {
            Some(1) => return Ok(a),
            // Squares of squares, which x^2 and x^4 share where both are there.
            Some(n @ (2 | 4 | 8)) => {
                return Ok((0..n.ilog2()).fold(a, |power, _| self.push(Op::Sqr(power))));
            }
            Some(n) => Op::Powi(a, prelude::exponent(n)?),
            None if half => Op::Unary(Unary::Sqrt, a),
            None => Op::Powc(a, self.constant(b)?),
        };
        Ok(self.push(op))
    }

    /// The value of an operand; a constant is loaded where it is needed.
    fn place(&mut self, id: Id) -> Result<u32, String> {
        if self.graph.is_constant(id) {
            let load = Op::Load(self.constant(id)?);
            return Ok(self.push(load));
        }
        Ok(self.places[&id])
    }

    /// The place of a constant in the table.
    fn constant(&mut self, id: Id) -> Result<u32, String> {
        if let Some(&place) = self.constant_places.get(&id) {
            return Ok(place);
        }
        let constant = self.prelude.value(id).constant(self.prelude.precision);
        if constant.f64.iter().any(|end| !end.is_finite()) {
            return Err("has a constant beyond the range of doubles".into());
        }
        let place = self.constants.len() as u32;
        self.constants.push(constant);
        self.constant_places.insert(id, place);
        Ok(place)
    }

    /// The value of an operation, old or new.
    fn push(&mut self, op: Op) -> u32 {
        *self.numbered.entry(op).or_insert_with(|| {
            self.ops.push(op);
            self.ops.len() as u32 + 2
        })
    }
}

/// Gives values registers, which are used again once their value was used for the last time. The first
/// `inputs` values are given, the k-th operation writes value `inputs + k`.
pub(crate) fn allocate(ops: &[Op], output: u32, inputs: u32) -> (Vec<Instruction>, Register) {
    let mut last_uses = vec![0; ops.len() + inputs as usize];
    for (i, op) in ops.iter().enumerate() {
        for value in op.operands().into_iter().flatten() {
            last_uses[value as usize] = i;
        }
    }
    last_uses[output as usize] = usize::MAX;
    // The lowest free register first: a small file stays in the cache.
    let mut free = BinaryHeap::new();
    let used = |axis: u32| ops.iter().any(|op| op.operands().contains(&Some(axis)));
    free.extend((0..inputs).filter(|&axis| axis != output && !used(axis)).map(Reverse));
    let mut registers: Vec<Register> = (0..inputs).collect();
    let mut count = inputs;
    let mut instructions = Vec::with_capacity(ops.len());
    for (i, op) in ops.iter().enumerate() {
        let [a, b] = op.operands();
        for value in [a, b.filter(|_| a != b)].into_iter().flatten() {
            if last_uses[value as usize] == i {
                free.push(Reverse(registers[value as usize]));
            }
        }
        let out = free.pop().map_or_else(
            || {
                count += 1;
                count - 1
            },
            |Reverse(r)| r,
        );
        instructions.push(Instruction { op: op.map(|value| registers[value as usize]), out });
        registers.push(out);
    }
    (instructions, registers[output as usize])
}
