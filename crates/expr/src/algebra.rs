//! Constructors of nodes: exact folding and one form for equal expressions.
//!
//! Every rule is an identity over the reals, undefined values included, so folding never changes
//! the function. Constants, symbolic ones too, move to one side of an operation, so that the tape
//! scales and offsets. A node that a constructor returns is left as it is by that constructor:
//! printing and reading again gives the same graph.

use num_traits::{One, Signed, Zero};
use zeroset_ia::{Binary, Unary};

use crate::chebyshev::Form;
use crate::graph::{Graph, Id, Node};
use crate::rational::{self, Rational, integer};

impl Graph {
    /// Makes any node by its constructor.
    pub(crate) fn make(&mut self, node: Node) -> Id {
        match node {
            Node::Add(a, b) => self.add(a, b),
            Node::Sub(a, b) => self.sub(a, b),
            Node::Mul(a, b) => self.mul(a, b),
            Node::Div(a, b) => self.div(a, b),
            Node::Neg(a) => self.neg(a),
            Node::Power(a, b) => self.power(a, b),
            Node::Unary(f, a) => self.unary(f, a),
            Node::Binary(f, a, b) => self.binary(f, a, b),
            Node::Chebyshev(form, n, a) => self.chebyshev(form, n, a),
            Node::Variable(_)
            | Node::Number(_)
            | Node::Pi
            | Node::Parameter(..)
            | Node::Root(_) => self.intern(node),
        }
    }

    /// A number.
    pub(crate) fn constant(&mut self, r: Rational) -> Id {
        self.intern(Node::Number(r))
    }

    /// The value of an operation on numbers, or the operation.
    fn fold(&mut self, node: Node) -> Id {
        let operands = node.operands().map(|a| self.number(a?));
        match rational::evaluate(&node, operands) {
            Some(r) => self.constant(r),
            None => self.intern(node),
        }
    }

    /// Both operands are numbers: nothing but folding applies.
    fn are_numbers(&self, a: Id, b: Id) -> bool {
        self.number(a).is_some() && self.number(b).is_some()
    }

    /// A product with a negative number as its factor, as that number and the rest.
    fn negative_product(&self, a: Id) -> Option<(Rational, Id)> {
        match *self.node(a) {
            Node::Mul(c, rest) => match self.number(c) {
                Some(c) if c.is_negative() => Some((c.clone(), rest)),
                _ => None,
            },
            _ => None,
        }
    }

    /// a + b; a constant comes last.
    pub(crate) fn add(&mut self, a: Id, b: Id) -> Id {
        if self.are_numbers(a, b) {
            return self.fold(Node::Add(a, b));
        }
        if self.is_integer(a, 0) {
            return b;
        }
        if self.is_integer(b, 0) {
            return a;
        }
        match (self.is_constant(a), self.is_constant(b)) {
            (true, false) => return self.add(b, a),
            (false, true) => {
                return match *self.node(a) {
                    Node::Add(a, c) if self.is_constant(c) => {
                        let c = self.add(c, b);
                        self.add(a, c)
                    }
                    Node::Sub(c, a) if self.is_constant(c) => {
                        let c = self.add(c, b);
                        self.sub(c, a)
                    }
                    Node::Neg(a) => self.sub(b, a),
                    _ => self.intern(Node::Add(a, b)),
                };
            }
            _ => {}
        }
        match (self.node(a), self.node(b)) {
            (_, &Node::Neg(b)) => return self.sub(a, b),
            (&Node::Neg(a), _) => return self.sub(b, a),
            _ => {}
        }
        if let Some((c, rest)) = self.negative_product(b) {
            let c = self.constant(-c);
            let b = self.mul(c, rest);
            return self.sub(a, b);
        }
        self.intern(Node::Add(a, b))
    }

    /// a - b; a constant b is negated and added.
    pub(crate) fn sub(&mut self, a: Id, b: Id) -> Id {
        if self.are_numbers(a, b) {
            return self.fold(Node::Sub(a, b));
        }
        if self.is_integer(b, 0) {
            return a;
        }
        if self.is_integer(a, 0) {
            return self.neg(b);
        }
        if a == b && self.is_total(a) {
            return self.constant(integer(0));
        }
        match (self.is_constant(a), self.is_constant(b)) {
            (false, true) => {
                let b = self.neg(b);
                return self.add(a, b);
            }
            (true, false) => {
                return match *self.node(b) {
                    Node::Add(b, c) if self.is_constant(c) => {
                        let c = self.sub(a, c);
                        self.sub(c, b)
                    }
                    Node::Sub(c, b) if self.is_constant(c) => {
                        let c = self.sub(a, c);
                        self.add(b, c)
                    }
                    Node::Neg(b) => self.add(b, a),
                    _ => self.intern(Node::Sub(a, b)),
                };
            }
            _ => {}
        }
        if let Some(c) = self.number(b) {
            let c = -c.clone();
            let c = self.constant(c);
            return self.add(a, c);
        }
        if let Node::Neg(b) = *self.node(b) {
            return self.add(a, b);
        }
        if let Some((c, rest)) = self.negative_product(b) {
            let c = self.constant(-c);
            let b = self.mul(c, rest);
            return self.add(a, b);
        }
        self.intern(Node::Sub(a, b))
    }

    /// -a.
    pub(crate) fn neg(&mut self, a: Id) -> Id {
        match *self.node(a) {
            Node::Neg(a) => a,
            Node::Sub(a, b) => self.sub(b, a),
            Node::Mul(c, b) if self.number(c).is_some() || self.scales(c, b) => {
                let c = self.neg(c);
                self.mul(c, b)
            }
            _ => self.fold(Node::Neg(a)),
        }
    }

    /// Is a * b a constant times a function?
    fn scales(&self, a: Id, b: Id) -> bool {
        self.is_constant(a) && !self.is_constant(b)
    }

    /// a b; a constant comes first, and absorbs signs and other constant factors.
    pub(crate) fn mul(&mut self, a: Id, b: Id) -> Id {
        if self.are_numbers(a, b) {
            return self.fold(Node::Mul(a, b));
        }
        if self.scales(b, a) || (self.number(b).is_some() && self.is_constant(a)) {
            return self.mul(b, a);
        }
        if self.is_integer(a, 0) && self.is_total(b) {
            return a;
        }
        if self.is_integer(a, 1) {
            return b;
        }
        if self.is_integer(a, -1) {
            return self.neg(b);
        }
        match *self.node(b) {
            Node::Mul(c, rest)
                if self.is_constant(a) && (self.scales(c, rest) || self.are_numbers(a, c)) =>
            {
                let c = self.mul(a, c);
                return self.mul(c, rest);
            }
            Node::Neg(b) if self.scales(a, b) => {
                let a = self.neg(a);
                return self.mul(a, b);
            }
            Node::Neg(b) => {
                let product = self.mul(a, b);
                return self.neg(product);
            }
            _ => {}
        }
        match *self.node(a) {
            Node::Neg(a) if !self.scales(a, b) => {
                let product = self.mul(a, b);
                self.neg(product)
            }
            _ if a == b => {
                let two = self.constant(integer(2));
                self.power(a, two)
            }
            _ => self.intern(Node::Mul(a, b)),
        }
    }

    /// a / b; division by a constant becomes multiplication.
    pub(crate) fn div(&mut self, a: Id, b: Id) -> Id {
        if self.are_numbers(a, b) {
            return self.fold(Node::Div(a, b));
        }
        if self.is_integer(b, 1) {
            return a;
        }
        if let Some(c) = self.number(b).filter(|c| !c.is_zero()) {
            let c = c.recip();
            let c = self.constant(c);
            return self.mul(c, a);
        }
        if self.scales(b, a) {
            let one = self.constant(integer(1));
            let c = self.div(one, b);
            return self.mul(c, a);
        }
        match (self.node(a), self.node(b)) {
            (_, &Node::Neg(b)) => {
                let quotient = self.div(a, b);
                self.neg(quotient)
            }
            (&Node::Neg(a), _) => {
                let quotient = self.div(a, b);
                self.neg(quotient)
            }
            (Node::Number(c), _) if c.is_negative() => {
                let c = -c.clone();
                let c = self.constant(c);
                let quotient = self.div(c, b);
                self.neg(quotient)
            }
            _ => self.intern(Node::Div(a, b)),
        }
    }

    /// a^b.
    pub(crate) fn power(&mut self, a: Id, b: Id) -> Id {
        let Some(n) = self.number(b).filter(|r| r.is_integer()).map(|r| r.numer().clone()) else {
            return self.intern(Node::Power(a, b));
        };
        if n.is_one() {
            return a;
        }
        if n.is_zero() && self.is_total(a) {
            return self.constant(integer(1));
        }
        if let Node::Neg(a) = *self.node(a) {
            let power = self.power(a, b);
            return if n.bit(0) { self.neg(power) } else { power };
        }
        self.fold(Node::Power(a, b))
    }

    /// f(a).
    pub(crate) fn unary(&mut self, f: Unary, a: Id) -> Id {
        self.fold(Node::Unary(f, a))
    }

    /// f(a, b); `pow` is another way to write a power.
    pub(crate) fn binary(&mut self, f: Binary, a: Id, b: Id) -> Id {
        match f {
            Binary::Pow => self.power(a, b),
            _ => self.fold(Node::Binary(f, a, b)),
        }
    }

    /// The Chebyshev polynomial `T_n(a)`.
    pub(crate) fn chebyshev(&mut self, form: Form, n: u32, a: Id) -> Id {
        match n {
            0 if self.is_total(a) => self.constant(integer(1)),
            1 => a,
            _ => self.intern(Node::Chebyshev(form, n, a)),
        }
    }
}
