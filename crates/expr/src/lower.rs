//! From a graph to a tape.
//!
//! Nodes without x, y and z are evaluated once, as intervals of any precision: they become the tape's
//! constants. The others become one instruction each (at most three), in an order that keeps few
//! values alive, and registers are used again once their value has been read for the last time.

use std::collections::HashMap;

use zeroset_ia::{BigInterval, Binary, Constant, Number};

use crate::graph::{Graph, Id, Node};
use crate::rational;
use crate::{Instruction, Op, ParameterError, Register, Tape};

/// Registers of x, y and z.
const VARIABLES: u32 = 3;

/// The graph with values for its parameters (those not given keep their defaults), and Chebyshev
/// polynomials written out. Folding is done anew: an exponent may have become a number.
pub(crate) fn specialise(source: &Graph, root: Id, values: &[Option<(Graph, Id)>]) -> (Graph, Id) {
    let mut graph = Graph::new();
    let values: Vec<_> = values
        .iter()
        .map(|value| value.as_ref().map(|(g, id)| graph.copy(g, *id, expand)))
        .collect();
    let root = graph.copy(source, root, |graph, node| match node {
        Node::Parameter(i, default) => values[i as usize].unwrap_or(default),
        node => expand(graph, node),
    });
    (graph, root)
}

fn expand(graph: &mut Graph, node: Node) -> Id {
    match node {
        Node::Chebyshev(form, n, x) => graph.expand_chebyshev(form, n, x),
        node => graph.make(node),
    }
}

/// The tape of a graph without parameters, its constants known to `precision` bits.
pub(crate) fn lower(graph: &Graph, root: Id, precision: usize) -> Result<Tape, ParameterError> {
    let mut lowering = Lowering {
        graph,
        precision: precision.max(128),
        values: HashMap::new(),
        places: HashMap::from([(0, 0), (1, 1), (2, 2)]),
        loads: HashMap::new(),
        instructions: Vec::new(),
        constants: Vec::new(),
    };
    let needs = needs(graph, root);
    let order = graph.postorder(root, |id| {
        let mut operands = graph.node(id).operands().map(|a| a.filter(|&a| !graph.is_constant(a)));
        // The operand that needs more registers first.
        if let [Some(a), Some(b)] = operands
            && needs[a as usize] < needs[b as usize]
        {
            operands.swap(0, 1);
        }
        operands
    });
    for id in order {
        lowering.node(id)?;
    }
    let output = lowering.place(root)?;
    let (instructions, output) = allocate(&lowering.instructions, output);
    Ok(Tape::new(instructions, lowering.constants, output))
}

/// How many registers the value of each node needs, counted as if it were a tree.
fn needs(graph: &Graph, root: Id) -> Vec<u32> {
    let mut needs = vec![1_u32; graph.len()];
    for id in graph.postorder(root, |id| graph.node(id).operands()) {
        needs[id as usize] = match graph.node(id).operands() {
            [Some(a), Some(b)] => {
                let (a, b) = (needs[a as usize], needs[b as usize]);
                if a == b { a + 1 } else { a.max(b) }
            }
            [Some(a), None] => needs[a as usize],
            _ => 1,
        };
    }
    needs
}

struct Lowering<'a> {
    graph: &'a Graph,
    precision: usize,
    /// The values of constant nodes.
    values: HashMap<Id, BigInterval>,
    /// Where the value of each node is; places are registers that are written once.
    places: HashMap<Id, Register>,
    /// Where constants have been loaded.
    loads: HashMap<Id, Register>,
    instructions: Vec<Op>,
    constants: Vec<Constant>,
}

impl Lowering<'_> {
    /// Writes the instructions of a node whose operands are in place.
    fn node(&mut self, id: Id) -> Result<(), ParameterError> {
        let constant = |a: Id| self.graph.is_constant(a);
        if constant(id) {
            return Ok(());
        }
        let place = match *self.graph.node(id) {
            Node::Variable(axis) => Register::from(axis),
            Node::Add(a, b) if constant(b) => self.offset(a, b, |c| c)?,
            Node::Add(a, b) if constant(a) => self.offset(b, a, |c| c)?,
            Node::Sub(a, b) if constant(b) => self.offset(a, b, |c| -c)?,
            Node::Sub(a, b) if constant(a) => {
                let b = self.place(b)?;
                let negated = self.push(Op::Neg(b));
                let c = self.value(a)?;
                let c = self.constant(c);
                self.push(Op::Offset(negated, c))
            }
            Node::Mul(a, b) if constant(b) => self.scale(a, b)?,
            Node::Mul(a, b) if constant(a) => self.scale(b, a)?,
            Node::Div(a, b) if constant(b) && !self.value(b)?.contains_zero() => {
                let one = BigInterval::from_f64(1.0, self.precision);
                let c = one / self.value(b)?;
                let c = self.constant(c);
                let a = self.place(a)?;
                self.push(Op::Scale(a, c))
            }
            Node::Power(a, b) => self.power(a, b)?,
            Node::Add(a, b) => self.pair(a, b, Op::Add)?,
            Node::Sub(a, b) => self.pair(a, b, Op::Sub)?,
            Node::Mul(a, b) => self.pair(a, b, Op::Mul)?,
            Node::Div(a, b) => self.pair(a, b, Op::Div)?,
            Node::Binary(f, a, b) => self.pair(a, b, |a, b| Op::Binary(f, a, b))?,
            Node::Neg(a) => {
                let a = self.place(a)?;
                self.push(Op::Neg(a))
            }
            Node::Unary(f, a) => {
                let a = self.place(a)?;
                self.push(Op::Unary(f, a))
            }
            Node::Number(_)
            | Node::Pi
            | Node::Root(_)
            | Node::Parameter(..)
            | Node::Chebyshev(..) => unreachable!("constants, and nodes that are expanded"),
        };
        self.places.insert(id, place);
        Ok(())
    }

    fn power(&mut self, a: Id, b: Id) -> Result<Register, ParameterError> {
        let exponent = self.graph.number(b).and_then(rational::to_integer);
        if let Some(n) = exponent.and_then(|n| i32::try_from(n).ok()) {
            let a = self.place(a)?;
            return Ok(self.push(if n == 2 { Op::Sqr(a) } else { Op::Powi(a, n) }));
        }
        if self.graph.is_constant(b) {
            let c = self.value(b)?;
            let c = self.constant(c);
            let a = self.place(a)?;
            return Ok(self.push(Op::Powc(a, c)));
        }
        self.pair(a, b, |a, b| Op::Binary(Binary::Pow, a, b))
    }

    fn pair(
        &mut self,
        a: Id,
        b: Id,
        op: impl FnOnce(Register, Register) -> Op,
    ) -> Result<Register, ParameterError> {
        let (a, b) = (self.place(a)?, self.place(b)?);
        Ok(self.push(op(a, b)))
    }

    fn offset(
        &mut self,
        a: Id,
        c: Id,
        sign: impl FnOnce(BigInterval) -> BigInterval,
    ) -> Result<Register, ParameterError> {
        let c = sign(self.value(c)?);
        let c = self.constant(c);
        let a = self.place(a)?;
        Ok(self.push(Op::Offset(a, c)))
    }

    fn scale(&mut self, a: Id, c: Id) -> Result<Register, ParameterError> {
        let c = self.value(c)?;
        let c = self.constant(c);
        let a = self.place(a)?;
        Ok(self.push(Op::Scale(a, c)))
    }

    fn push(&mut self, op: Op) -> Register {
        self.instructions.push(op);
        VARIABLES + self.instructions.len() as Register - 1
    }

    fn constant(&mut self, value: BigInterval) -> u32 {
        self.constants.push(Constant::new(value));
        self.constants.len() as u32 - 1
    }

    /// Where the value of a node is; a constant is loaded.
    fn place(&mut self, id: Id) -> Result<Register, ParameterError> {
        if let Some(&place) = self.places.get(&id).or_else(|| self.loads.get(&id)) {
            return Ok(place);
        }
        let value = self.value(id)?;
        let c = self.constant(value);
        let place = self.push(Op::Load(c));
        self.loads.insert(id, place);
        Ok(place)
    }

    /// The value of a constant node.
    fn value(&mut self, id: Id) -> Result<BigInterval, ParameterError> {
        let operands = |id| match self.graph.node(id) {
            Node::Root(_) => [None, None],
            node => node.operands(),
        };
        for id in self.graph.postorder(id, operands) {
            if !self.values.contains_key(&id) {
                let value = self.evaluate(id)?;
                self.values.insert(id, value);
            }
        }
        Ok(self.values[&id].clone())
    }

    fn evaluate(&self, id: Id) -> Result<BigInterval, ParameterError> {
        let get = |a: Id| self.values[&a].clone();
        let node = self.graph.node(id);
        let value = match *node {
            Node::Number(ref r) => rational::enclose(r, self.precision),
            Node::Pi => BigInterval::pi(self.precision),
            Node::Root(polynomial) => root(self.graph, polynomial, self.precision)?,
            Node::Add(a, b) => get(a) + get(b),
            Node::Sub(a, b) => get(a) - get(b),
            Node::Mul(a, b) => get(a) * get(b),
            Node::Div(a, b) => get(a) / get(b),
            Node::Neg(a) => -get(a),
            Node::Power(a, b) => match self.graph.number(b).and_then(rational::to_integer) {
                Some(2) => get(a).sqr(),
                Some(n) if i32::try_from(n).is_ok() => get(a).powi(n as i32),
                _ => get(a).binary(Binary::Pow, get(b)),
            },
            Node::Unary(f, a) => get(a).unary(f),
            Node::Binary(f, a, b) => get(a).binary(f, get(b)),
            Node::Variable(_) | Node::Parameter(..) | Node::Chebyshev(..) => {
                unreachable!("not a constant, or expanded")
            }
        };
        if value.is_empty() || !value.is_bounded() {
            let operands: Vec<f64> =
                node.operands().into_iter().flatten().map(|a| get(a).nearest()).collect();
            let message = format!(
                "a constant of the equation is not finite: {} of {operands:?}",
                operation(node)
            );
            return Err(ParameterError { message });
        }
        Ok(value)
    }
}

/// What a node does, for messages.
fn operation(node: &Node) -> String {
    match node {
        Node::Div(..) => "a quotient".into(),
        Node::Power(..) => "a power".into(),
        Node::Unary(f, _) => f.to_string(),
        Node::Binary(f, ..) => f.to_string(),
        _ => "a value".into(),
    }
}

/// The only real root of a polynomial in x, by bisection: its coefficients' size bounds it.
fn root(graph: &Graph, polynomial: Id, precision: usize) -> Result<BigInterval, ParameterError> {
    let tape = lower(graph, polynomial, precision + 64)?;
    let working = precision + 64;
    let zero = BigInterval::from_f64(0.0, working);
    let mut evaluator = tape.evaluator(&zero);
    let mut at = |x: &BigInterval| evaluator.evaluate([x.clone(), zero.clone(), zero.clone()]);
    let mut sign = |x: &BigInterval| {
        let value = at(x);
        i32::from(value.is_positive()) - i32::from(value.is_negative())
    };
    let fail =
        || ParameterError { message: "`root:` needs a polynomial with one real root".into() };
    let mut bound = 1.0_f64;
    let (mut lo, mut hi) = loop {
        let [lo, hi] = [-bound, bound].map(|x| BigInterval::from_f64(x, working));
        if sign(&lo) * sign(&hi) < 0 {
            break (lo, hi);
        }
        bound *= 2.0;
        if bound > 1e30 {
            return Err(fail());
        }
    };
    let below = sign(&lo);
    let half = BigInterval::from_f64(0.5, working);
    for _ in 0..working + 128 {
        let middle = ((lo.clone() + hi.clone()) * half.clone()).lower();
        match sign(&middle) {
            0 => break,
            s if s == below => lo = middle,
            _ => hi = middle,
        }
    }
    Ok(lo.hull(&hi).with_precision(precision))
}

/// Gives registers to places: one is free again after its value has been read for the last time.
fn allocate(places: &[Op], output: Register) -> (Vec<Instruction>, Register) {
    let mut last_read = HashMap::new();
    for (i, op) in places.iter().enumerate() {
        for place in reads(*op) {
            last_read.insert(place, i);
        }
    }
    last_read.insert(output, places.len());
    let mut registers: HashMap<Register, Register> = (0..VARIABLES).map(|v| (v, v)).collect();
    let mut free: Vec<Register> =
        (0..VARIABLES).filter(|v| !last_read.contains_key(v)).rev().collect();
    let mut count = VARIABLES;
    let mut instructions = Vec::with_capacity(places.len());
    for (i, op) in places.iter().enumerate() {
        let renamed = rename(*op, |place| registers[&place]);
        let mut dying: Vec<Register> =
            reads(*op).into_iter().filter(|p| last_read[p] == i).map(|p| registers[&p]).collect();
        dying.sort_unstable();
        dying.dedup();
        free.extend(dying.into_iter().rev());
        let out = free.pop().unwrap_or_else(|| {
            count += 1;
            count - 1
        });
        registers.insert(VARIABLES + i as Register, out);
        instructions.push(Instruction { op: renamed, out });
    }
    (instructions, registers[&output])
}

fn reads(op: Op) -> Vec<Register> {
    match op {
        Op::Load(_) => vec![],
        Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Div(a, b) | Op::Binary(_, a, b) => {
            vec![a, b]
        }
        Op::Neg(a)
        | Op::Scale(a, _)
        | Op::Offset(a, _)
        | Op::Sqr(a)
        | Op::Powi(a, _)
        | Op::Powc(a, _)
        | Op::Unary(_, a) => vec![a],
    }
}

fn rename(op: Op, f: impl Fn(Register) -> Register) -> Op {
    match op {
        Op::Load(c) => Op::Load(c),
        Op::Add(a, b) => Op::Add(f(a), f(b)),
        Op::Sub(a, b) => Op::Sub(f(a), f(b)),
        Op::Mul(a, b) => Op::Mul(f(a), f(b)),
        Op::Div(a, b) => Op::Div(f(a), f(b)),
        Op::Binary(g, a, b) => Op::Binary(g, f(a), f(b)),
        Op::Neg(a) => Op::Neg(f(a)),
        Op::Scale(a, c) => Op::Scale(f(a), c),
        Op::Offset(a, c) => Op::Offset(f(a), c),
        Op::Sqr(a) => Op::Sqr(f(a)),
        Op::Powi(a, n) => Op::Powi(f(a), n),
        Op::Powc(a, c) => Op::Powc(f(a), c),
        Op::Unary(g, a) => Op::Unary(g, f(a)),
    }
}
