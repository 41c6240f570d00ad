//! Functions: what an equation says.

use crate::definitions::{Chunk, Context};
use crate::graph::{Graph, Id};
use crate::parser::{Parser, Place};
use crate::{ParameterError, ParseError, Tape, lower};

/// A named parameter of a function.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in the equation.
    pub name: String,
    /// Its default value: an exact constant expression such as `0.3`, `(1+sqrt(5))/2` or
    /// `root:7*a^3+7*a+1` (the only real root of a polynomial).
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
#[derive(Clone, Debug)]
pub struct Function {
    text: String,
    graph: Graph,
    root: Id,
    parameters: Vec<Parameter>,
}

impl Function {
    /// Reads an equation such as `x^2 + y^2 = r^2; r = 1`.
    ///
    /// # Errors
    /// With the place, what was expected, and near names.
    pub fn parse(text: &str) -> Result<Self, ParseError> {
        Self::parse_with(text, &Definitions::default())
    }

    /// Reads an equation that may use the given definitions.
    ///
    /// # Errors
    /// As [`parse`](Self::parse).
    pub fn parse_with(text: &str, definitions: &Definitions) -> Result<Self, ParseError> {
        let mut context = Context::new();
        context.define(definitions)?;
        let all = Chunk::new(text, None)?;
        let equation = context.split(&all)?;
        let span = equation.span();
        let root = Parser::new(&mut context, equation, Place::Equation).equation()?;
        context.check_unused()?;
        if context.graph.is_constant(root) {
            return Err(ParseError::new(text, span, "the equation has no x, y or z")
                .help("a surface is written for example as `x^2 + y^2 + z^2 = 1`"));
        }
        let Context { graph, parameters, .. } = context;
        Ok(Self { text: text.into(), graph, root, parameters })
    }

    /// The text that was read.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The parameters with their defaults, in the order of first use; `w` (default 0.5) is one.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// The tape for the given parameter values, its constants known to `precision` bits (at least 128).
    ///
    /// # Errors
    /// An unknown name, or a value that is no finite constant.
    pub fn tape(&self, values: &Parameters, precision: usize) -> Result<Tape, ParameterError> {
        let mut given = vec![None; self.parameters.len()];
        for (name, value) in values.iter() {
            let index = self.parameters.iter().position(|p| p.name == name);
            let index = index.ok_or_else(|| self.unknown(name))?;
            given[index] = Some(read_value(name, value)?);
        }
        let (graph, root) = lower::specialise(&self.graph, self.root, &given);
        lower::lower(&graph, root, precision)
    }

    fn unknown(&self, name: &str) -> ParameterError {
        let known: Vec<&str> = self.parameters.iter().map(|p| p.name.as_str()).collect();
        let message = if known.is_empty() {
            format!("the equation has no parameter `{name}`: it has none")
        } else {
            format!("the equation has no parameter `{name}`: it has {}", known.join(", "))
        };
        ParameterError { message }
    }
}

/// Reads a parameter's value: a constant of its own graph.
fn read_value(name: &str, value: &str) -> Result<(Graph, Id), ParameterError> {
    let mut context = Context::new();
    let read = Chunk::new(value, None)
        .and_then(|chunk| Parser::new(&mut context, chunk, Place::Constant).value());
    match read {
        Ok(id) if context.graph.is_constant(id) => Ok((context.graph, id)),
        Ok(_) => Err(ParameterError { message: format!("`{name} = {value}` is no constant") }),
        Err(error) => Err(ParameterError { message: format!("`{name} = {value}`: {error}") }),
    }
}
