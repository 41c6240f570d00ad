//! Hash-consed expressions.

use std::collections::HashMap;

use num_traits::One;
use zeroset_ia::{Binary, Unary};

use crate::chebyshev::Form;
use crate::rational::{self, Rational};

/// The place of a node in its graph; operands come before the nodes that use them.
pub(crate) type Id = u32;

/// An operation and its operands.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Node {
    /// x, y or z.
    Variable(u8),
    /// An exact number.
    Number(Rational),
    /// The circle's constant.
    Pi,
    /// A parameter and its default value.
    Parameter(u32, Id),
    /// The only real root of a polynomial, whose unknown is written as x.
    Root(Id),
    /// a + b.
    Add(Id, Id),
    /// a - b.
    Sub(Id, Id),
    /// a b.
    Mul(Id, Id),
    /// a / b.
    Div(Id, Id),
    /// -a.
    Neg(Id),
    /// a^b.
    Power(Id, Id),
    /// f(a).
    Unary(Unary, Id),
    /// f(a, b).
    Binary(Binary, Id, Id),
    /// `T_n(a)`, to be evaluated in the given form.
    Chebyshev(Form, u32, Id),
}

impl Node {
    /// The nodes that this one refers to, in order.
    pub(crate) fn operands(&self) -> [Option<Id>; 2] {
        match *self {
            Self::Variable(_) | Self::Number(_) | Self::Pi => [None, None],
            Self::Parameter(_, a)
            | Self::Root(a)
            | Self::Neg(a)
            | Self::Unary(_, a)
            | Self::Chebyshev(_, _, a) => [Some(a), None],
            Self::Add(a, b)
            | Self::Sub(a, b)
            | Self::Mul(a, b)
            | Self::Div(a, b)
            | Self::Power(a, b)
            | Self::Binary(_, a, b) => [Some(a), Some(b)],
        }
    }

    /// The same operation on other operands.
    pub(crate) fn map(&self, f: impl Fn(Id) -> Id) -> Self {
        match self.clone() {
            leaf @ (Self::Variable(_) | Self::Number(_) | Self::Pi) => leaf,
            Self::Parameter(i, a) => Self::Parameter(i, f(a)),
            Self::Root(a) => Self::Root(f(a)),
            Self::Neg(a) => Self::Neg(f(a)),
            Self::Unary(g, a) => Self::Unary(g, f(a)),
            Self::Chebyshev(form, n, a) => Self::Chebyshev(form, n, f(a)),
            Self::Add(a, b) => Self::Add(f(a), f(b)),
            Self::Sub(a, b) => Self::Sub(f(a), f(b)),
            Self::Mul(a, b) => Self::Mul(f(a), f(b)),
            Self::Div(a, b) => Self::Div(f(a), f(b)),
            Self::Power(a, b) => Self::Power(f(a), f(b)),
            Self::Binary(g, a, b) => Self::Binary(g, f(a), f(b)),
        }
    }

    /// The node with its operands exchanged, if that is the same function.
    fn commuted(&self) -> Option<Self> {
        match *self {
            Self::Add(a, b) => Some(Self::Add(b, a)),
            Self::Mul(a, b) => Some(Self::Mul(b, a)),
            Self::Binary(f @ (Binary::Min | Binary::Max | Binary::Hypot), a, b) => {
                Some(Self::Binary(f, b, a))
            }
            _ => None,
        }
    }
}

/// What is known about a node.
#[derive(Clone, Copy, Debug)]
struct Facts {
    /// Independent of x, y and z.
    constant: bool,
    /// Defined and finite everywhere.
    total: bool,
}

/// Expressions that share their common parts.
///
/// Nodes are made by the constructors in `algebra`, so a graph holds folded nodes only. An operation
/// that commutes keeps the order in which it was first written.
#[derive(Clone, Debug)]
pub(crate) struct Graph {
    nodes: Vec<Node>,
    facts: Vec<Facts>,
    ids: HashMap<Node, Id>,
}

impl PartialEq for Graph {
    fn eq(&self, other: &Self) -> bool {
        self.nodes == other.nodes
    }
}

impl Graph {
    /// A graph that holds x, y and z, as nodes 0, 1 and 2.
    pub(crate) fn new() -> Self {
        let mut graph = Self { nodes: Vec::new(), facts: Vec::new(), ids: HashMap::new() };
        for axis in 0..3 {
            graph.intern(Node::Variable(axis));
        }
        graph
    }

    /// The number of nodes.
    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// A node.
    pub(crate) fn node(&self, id: Id) -> &Node {
        &self.nodes[id as usize]
    }

    /// Is it independent of x, y and z?
    pub(crate) fn is_constant(&self, id: Id) -> bool {
        self.facts[id as usize].constant
    }

    /// Is it defined and finite for all x, y and z?
    pub(crate) fn is_total(&self, id: Id) -> bool {
        self.facts[id as usize].total
    }

    /// The exact value of a number.
    pub(crate) fn number(&self, id: Id) -> Option<&Rational> {
        match self.node(id) {
            Node::Number(r) => Some(r),
            _ => None,
        }
    }

    /// Is it the number n?
    pub(crate) fn is_integer(&self, id: Id, n: i32) -> bool {
        self.number(id).is_some_and(|r| r.denom().is_one() && *r.numer() == n.into())
    }

    /// The default values of parameters.
    pub(crate) fn default_values(&self) -> HashMap<u32, Id> {
        let default = |node: &Node| match *node {
            Node::Parameter(i, default) => Some((i, default)),
            _ => None,
        };
        self.nodes.iter().filter_map(default).collect()
    }

    /// The place of a node, old or new.
    pub(crate) fn intern(&mut self, node: Node) -> Id {
        let commuted = || node.commuted().and_then(|n| self.ids.get(&n));
        if let Some(&id) = self.ids.get(&node).or_else(commuted) {
            return id;
        }
        let facts = self.facts_of(&node);
        let id = Id::try_from(self.nodes.len()).expect("the size of equations is limited");
        self.facts.push(facts);
        self.nodes.push(node.clone());
        self.ids.insert(node, id);
        id
    }

    fn facts_of(&self, node: &Node) -> Facts {
        let operands = || node.operands().into_iter().flatten();
        let constant = match node {
            Node::Variable(_) => false,
            Node::Root(_) => true,
            _ => operands().all(|a| self.is_constant(a)),
        };
        let total = match node {
            // Values of parameters are checked apart.
            Node::Root(_) | Node::Parameter(..) => return Facts { constant, total: true },
            Node::Div(..) => false,
            Node::Power(_, b) => {
                self.number(*b).and_then(rational::to_integer).is_some_and(|n| n >= 0)
            }
            Node::Unary(f, _) => is_total(*f),
            Node::Binary(f, ..) => matches!(f, Binary::Min | Binary::Max | Binary::Hypot),
            _ => true,
        };
        Facts { constant, total: total && operands().all(|a| self.is_total(a)) }
    }

    /// The nodes that `root` is made of, operands first, each once, in the order of first use.
    ///
    /// `operands` may hide the operands of some nodes, or change their order.
    pub(crate) fn postorder(&self, root: Id, operands: impl Fn(Id) -> [Option<Id>; 2]) -> Vec<Id> {
        let mut order = Vec::new();
        let mut seen = vec![false; self.len()];
        // Not recursive: a sum of many terms is as deep as it is long.
        let mut stack = vec![(root, operands(root).into_iter().flatten())];
        seen[root as usize] = true;
        while let Some((id, rest)) = stack.last_mut() {
            match rest.next() {
                Some(a) if seen[a as usize] => {}
                Some(a) => {
                    seen[a as usize] = true;
                    stack.push((a, operands(a).into_iter().flatten()));
                }
                None => {
                    order.push(*id);
                    stack.pop();
                }
            }
        }
        order
    }

    /// Copies an expression of another graph into this one; `make` makes each node from its copied
    /// operands.
    pub(crate) fn copy(
        &mut self,
        source: &Self,
        root: Id,
        make: impl Fn(&mut Self, Node) -> Id,
    ) -> Id {
        let mut copies = vec![0; source.len()];
        for id in source.postorder(root, |id| source.node(id).operands()) {
            let node = source.node(id).map(|a| copies[a as usize]);
            copies[id as usize] = make(self, node);
        }
        copies[root as usize]
    }
}

/// Is the function defined and finite for all real arguments?
pub(crate) fn is_total(f: Unary) -> bool {
    match f {
        Unary::Sqrt
        | Unary::Log
        | Unary::Log2
        | Unary::Log10
        | Unary::Logp1
        | Unary::Tan
        | Unary::Asin
        | Unary::Acos
        | Unary::Acosh
        | Unary::Atanh => false,
        Unary::Cbrt
        | Unary::Abs
        | Unary::Sign
        | Unary::Floor
        | Unary::Ceil
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
        | Unary::Asinh => true,
    }
}
