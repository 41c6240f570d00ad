//! The constants of an expression, evaluated once for given parameters.

use std::collections::HashMap;

use zeroset_ia::{BigInterval, Binary, Constant, Number, Unary};

use crate::chebyshev;
use crate::graph::{Graph, Id, Node};
use crate::rational::{self, MAX_EXPONENT, Rational};
use crate::root;

/// The value of a constant: exact where it is rational and short, else an enclosure.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Exact(Rational),
    Enclosed(BigInterval),
}

impl Value {
    /// The exact value, if it is known.
    pub(crate) fn exact(&self) -> Option<&Rational> {
        match self {
            Self::Exact(r) => Some(r),
            Self::Enclosed(_) => None,
        }
    }

    /// The interval that contains the value.
    pub(crate) fn enclosure(&self, precision: usize) -> BigInterval {
        match self {
            Self::Exact(r) => rational::enclose(r, precision),
            Self::Enclosed(big) => big.clone(),
        }
    }

    /// The value as a constant.
    pub(crate) fn constant(&self, precision: usize) -> Constant {
        Constant::new(self.enclosure(precision))
    }

    /// The integer that it certainly is.
    pub(crate) fn integer(&self) -> Option<i64> {
        match self {
            Self::Exact(r) => rational::to_integer(r),
            Self::Enclosed(big) => {
                let [lo, hi] = big.to_f64();
                // Beyond 2^53 such a double may not be the value.
                let is = lo == hi && lo.fract() == 0.0 && lo.abs() < 9e15;
                is.then_some(lo as i64)
            }
        }
    }
}

/// An expression that has no value.
#[derive(Debug)]
pub(crate) struct Fault {
    pub(crate) id: Id,
    /// What it is or has, as in "is undefined".
    pub(crate) message: String,
}

/// The values of an expression's constants.
#[derive(Debug)]
pub(crate) struct Prelude {
    values: HashMap<Id, Value>,
    /// Bits of the significands.
    pub(crate) precision: usize,
}

impl Prelude {
    /// Evaluates the constants that `root` is made of; `given` replaces defaults of parameters.
    pub(crate) fn new(
        graph: &Graph,
        root: Id,
        given: &HashMap<u32, Value>,
        precision: usize,
    ) -> Result<Self, Fault> {
        let mut prelude = Self { values: HashMap::new(), precision };
        let operands = |id| match graph.node(id) {
            Node::Parameter(i, _) if given.contains_key(i) => [None, None],
            node => node.operands(),
        };
        for id in graph.postorder(root, operands) {
            if graph.is_constant(id) {
                let value = match graph.node(id) {
                    Node::Parameter(i, _) if given.contains_key(i) => given[i].clone(),
                    node => prelude
                        .evaluate(graph, node)
                        .and_then(finite)
                        .map_err(|message| Fault { id, message })?,
                };
                prelude.values.insert(id, value);
            }
        }
        Ok(prelude)
    }

    /// The value of a constant.
    ///
    /// # Panics
    /// If the prelude was not made for it.
    pub(crate) fn value(&self, id: Id) -> &Value {
        &self.values[&id]
    }

    fn evaluate(&self, graph: &Graph, node: &Node) -> Result<Value, String> {
        if let Node::Root(p) = *node {
            return root::only_root(graph, p, &self.values, self.precision);
        }
        let operands = node.operands().map(|a| Some(self.value(a?)));
        if let Some(r) = rational::evaluate(node, operands.map(|a| a?.exact())) {
            return Ok(Value::Exact(r));
        }
        let big = |id: Id| self.value(id).enclosure(self.precision);
        Ok(Value::Enclosed(match *node {
            Node::Number(ref r) => return Ok(Value::Exact(r.clone())),
            Node::Parameter(_, default) => return Ok(self.value(default).clone()),
            Node::Pi => BigInterval::pi(self.precision),
            Node::Add(a, b) => big(a) + big(b),
            Node::Sub(a, b) => big(a) - big(b),
            Node::Mul(a, b) if a == b => big(a).sqr(),
            Node::Mul(a, b) => big(a) * big(b),
            Node::Div(a, b) => big(a) / big(b),
            Node::Neg(a) => -big(a),
            Node::Unary(f, a) => big(a).unary(f),
            Node::Binary(f, a, b) => big(a).binary(f, big(b)),
            Node::Power(a, b) => match self.value(b).integer() {
                Some(n) => big(a).powi(exponent(n)?),
                None => big(a).binary(Binary::Pow, big(b)),
            },
            Node::Chebyshev(_, n, a) => return Ok(self.chebyshev(n, self.value(a))),
            Node::Variable(_) | Node::Root(_) => unreachable!("{node:?} is no operation"),
        }))
    }

    /// `T_n` of a constant.
    fn chebyshev(&self, n: u32, x: &Value) -> Value {
        if let Some(r) = x.exact()
            && (r.numer().bits() + r.denom().bits()) * u64::from(n) < 4096
        {
            return Value::Exact(chebyshev::evaluate(n, r));
        }
        let x = x.enclosure(self.precision);
        let [one, n] = [1, n].map(|n| BigInterval::from_f64(f64::from(n), self.precision));
        let clamped = x.clone().binary(Binary::Max, -one.clone()).binary(Binary::Min, one.clone());
        let inner = (n.clone() * clamped.unary(Unary::Acos)).unary(Unary::Cos);
        let beyond = x.unary(Unary::Abs).binary(Binary::Max, one).unary(Unary::Acosh);
        Value::Enclosed(inner * (n * beyond).unary(Unary::Cosh))
    }
}

/// An exponent within its limit.
pub(crate) fn exponent(n: i64) -> Result<i32, String> {
    i32::try_from(n)
        .ok()
        .filter(|n| n.unsigned_abs() <= MAX_EXPONENT)
        .ok_or_else(|| format!("has the exponent {n}: integers are limited to {MAX_EXPONENT}"))
}

fn finite(value: Value) -> Result<Value, String> {
    match &value {
        Value::Enclosed(big) if big.is_empty() => Err("is undefined".into()),
        Value::Enclosed(big) if !big.is_bounded() => Err("has no finite value".into()),
        _ => Ok(value),
    }
}
