//! Functions: what an equation says.

use std::collections::HashMap;
use std::fmt::{self, Display};

use crate::definitions::{Chunk, Context};
use crate::graph::{Graph, Id, Node};
use crate::lower::lower;
use crate::names;
use crate::parser::{Parser, Place};
use crate::prelude::{Fault, Prelude, Value};
use crate::rational::Rational;
use crate::{ParameterError, ParseError, Tape};

/// The fewest bits of a constant's significand.
const MIN_PRECISION: usize = 128;

/// A named parameter of a function.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in the equation.
    pub name: String,
    /// Its default value: an exact constant expression such as `0.3`, `(1+sqrt(5))/2` or
    /// `root:7*u^3+7*u+1` (the only real root of a polynomial).
    pub default: String,
}

/// What an equation may refer to besides x, y, z, w and pi.
#[derive(Clone, Debug, Default)]
pub struct Definitions {
    /// Parameters with their default values.
    pub parameters: Vec<Parameter>,
    /// Tables of constants by name, for `sum(i, 1, n, table[i] ...)`; the first entry has index 1.
    pub tables: Vec<(String, Vec<String>)>,
}

/// Values for a function's parameters, as exact constant expressions; others keep their defaults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parameters {
    values: Vec<(String, String)>,
}

impl Parameters {
    /// Sets a parameter; the last value wins.
    pub fn set(&mut self, name: &str, value: &str) {
        self.values.retain(|(n, _)| n != name);
        self.values.push((name.into(), value.into()));
    }
    /// The value set for a name.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.values.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str())
    }
    /// Names and values, in the order in which they were set.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.values.iter().map(|(n, v)| (n.as_str(), v.as_str()))
    }
}

/// A function f(x, y, z) with named parameters; the surface is f = 0.
///
/// Functions are equal if they are the same folded expression with the same parameters. The text
/// that [`Display`] writes reads as an equal function.
#[derive(Clone, Debug)]
pub struct Function {
    text: String,
    parameters: Vec<Parameter>,
    graph: Graph,
    /// The function as it was written.
    root: Id,
    /// The function by operations of numbers alone.
    expanded: Id,
}

impl Function {
    /// Reads an equation such as `x^2 + y^2 = r^2; r = 1`.
    ///
    /// # Errors
    /// With the place, what was expected, and near names.
    pub fn parse(text: &str) -> Result<Self, ParseError> {
        Self::parse_with(text, &Definitions::default())
    }

    /// Reads an equation that may use the given definitions; its own take precedence.
    ///
    /// # Errors
    /// As [`parse`](Self::parse).
    pub fn parse_with(text: &str, definitions: &Definitions) -> Result<Self, ParseError> {
        let mut context = Context::new();
        context.define(definitions)?;
        let all = Chunk::new(text, None)?;
        let equation = context.split(&all)?;
        let root = Parser::new(&mut context, equation.clone(), Place::Equation).equation()?;
        context.check_unused()?;
        let expanded = context.graph.expand(root);
        if context.graph.is_constant(expanded) {
            let message = "there is no x, y or z in this equation, or all cancel";
            return Err(equation.error(equation.span(), message));
        }
        tape(&context.graph, expanded, &HashMap::new(), MIN_PRECISION).map_err(|fault| {
            let message = explain(&context.graph, &context.parameters, &fault);
            match context.written.get(&fault.id) {
                Some((chunk, span)) => chunk.error(span.clone(), message),
                None => equation.error(equation.span(), message),
            }
        })?;

        // Only what is used, numbered in the order of its first use.
        let used = used_parameters(&context.graph, root);
        let places: HashMap<u32, u32> = used.iter().copied().zip(0..).collect();
        let mut graph = Graph::new();
        let root = graph.copy(&context.graph, root, |graph, node| match node {
            Node::Parameter(old, default) => graph.make(Node::Parameter(places[&old], default)),
            node => graph.make(node),
        });
        let parameters = used.iter().map(|&i| context.parameters[i as usize].clone()).collect();
        let expanded = graph.expand(root);
        Ok(Self { text: text.into(), parameters, graph, root, expanded })
    }

    /// The text that was read.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The parameters with their defaults, in the order of first use; `w` (default 0.5) is one.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// The total degree if this is, with the default parameters, a polynomial in x, y, z.
    ///
    /// As for [`Tape::degree`], terms that cancel are counted.
    pub fn degree(&self) -> Option<u32> {
        self.tape(&Parameters::default(), MIN_PRECISION).ok()?.degree()
    }

    /// The tape for the given parameter values, its constants known to `precision` bits (at least 128).
    ///
    /// # Errors
    /// An unknown name, or a value that is no finite constant or makes another constant infinite.
    pub fn tape(&self, values: &Parameters, precision: usize) -> Result<Tape, ParameterError> {
        let precision = precision.max(MIN_PRECISION);
        let mut given = HashMap::new();
        for (name, value) in values.iter() {
            let index = self.parameters.iter().position(|p| p.name == name);
            let index = index.ok_or_else(|| self.unknown(name))?;
            given.insert(index as u32, read_value(name, value, precision)?);
        }
        tape(&self.graph, self.expanded, &given, precision).map_err(|fault| {
            let mut message = explain(&self.graph, &self.parameters, &fault);
            for (i, (name, value)) in values.iter().enumerate() {
                message += if i == 0 { " for " } else { ", " };
                message += &format!("{name} = {}", shortened(value));
            }
            ParameterError { message }
        })
    }

    fn unknown(&self, name: &str) -> ParameterError {
        let known = || self.parameters.iter().map(|p| p.name.as_str());
        let mut message = format!("this equation has no parameter `{name}`: ");
        if self.parameters.is_empty() {
            message += "it has none";
        } else {
            message += &format!("it has {}", known().collect::<Vec<_>>().join(", "));
        }
        if let Some(near) = names::nearest(name, known()) {
            message += &format!("; did you mean {near}?");
        }
        ParameterError { message }
    }
}

impl PartialEq for Function {
    fn eq(&self, other: &Self) -> bool {
        let names = |f: &Self| f.parameters.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
        self.graph == other.graph && self.root == other.root && names(self) == names(other)
    }
}

impl Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = |id| self.graph.print(id, &self.parameters);
        f.write_str(&text(self.root))?;
        let defaults = self.graph.default_values();
        for (i, Parameter { name, .. }) in self.parameters.iter().enumerate() {
            let default = defaults[&(i as u32)];
            let half = Rational::new(1.into(), 2.into());
            if name != "w" || self.graph.number(default) != Some(&half) {
                write!(f, "; {name} = {}", text(default))?;
            }
        }
        Ok(())
    }
}

impl Graph {
    /// The expression with polynomials of variables written as operations of numbers.
    fn expand(&mut self, root: Id) -> Id {
        let source = self.clone();
        self.copy(&source, root, |graph, node| match node {
            Node::Chebyshev(form, n, a) if !graph.is_constant(a) => {
                graph.expand_chebyshev(form, n, a)
            }
            node => graph.make(node),
        })
    }
}

/// The parameters that `root` is made of, in the order in which its text names them.
fn used_parameters(graph: &Graph, root: Id) -> Vec<u32> {
    let mut used = Vec::new();
    let mut seen = vec![false; graph.len()];
    let mut stack = vec![root];
    while let Some(id) = stack.pop() {
        if std::mem::replace(&mut seen[id as usize], true) {
            continue;
        }
        if let Node::Parameter(i, _) = graph.node(id) {
            used.push(*i);
        }
        stack.extend(graph.node(id).operands().into_iter().flatten().rev());
    }
    used
}

fn tape(
    graph: &Graph,
    root: Id,
    given: &HashMap<u32, Value>,
    precision: usize,
) -> Result<Tape, Fault> {
    let prelude = Prelude::new(graph, root, given, precision)?;
    lower(graph, root, &prelude)
}

/// The value that is given for a parameter.
fn read_value(name: &str, value: &str, precision: usize) -> Result<Value, ParameterError> {
    let role = format!("the value `{}` of `{name}`", shortened(value));
    let mut context = Context::new();
    let parsed = Chunk::new(value, Some(&role))
        .and_then(|chunk| Parser::new(&mut context, chunk, Place::Constant).value());
    let id = parsed.map_err(|ParseError { message, help, .. }| ParameterError {
        message: match help {
            Some(help) => format!("{message} ({help})"),
            None => message,
        },
    })?;
    let id = context.graph.expand(id);
    match Prelude::new(&context.graph, id, &HashMap::new(), precision) {
        Ok(prelude) => Ok(prelude.value(id).clone()),
        Err(fault) => {
            let message = explain(&context.graph, &[], &fault);
            Err(ParameterError { message: format!("{role}: {message}") })
        }
    }
}

/// What is wrong with a constant.
fn explain(graph: &Graph, parameters: &[Parameter], fault: &Fault) -> String {
    format!("`{}` {}", shortened(&graph.print(fault.id, parameters)), fault.message)
}

fn shortened(text: &str) -> String {
    match text.char_indices().nth(60) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.into(),
    }
}
