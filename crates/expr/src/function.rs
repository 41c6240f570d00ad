//! Functions: what an equation says.

use crate::{ParameterError, ParseError, Tape};

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
pub struct Function {}

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
        todo!("{text} {definitions:?}")
    }

    /// The parameters with their defaults, in the order of first use; `w` (default 0.5) is one.
    pub fn parameters(&self) -> &[Parameter] {
        todo!()
    }

    /// The total degree if this is a polynomial in x, y, z.
    pub fn degree(&self) -> Option<u32> {
        todo!()
    }

    /// The tape for the given parameter values, its constants known to `precision` bits (at least 128).
    ///
    /// # Errors
    /// An unknown name, or a value that is no finite constant.
    pub fn tape(&self, values: &Parameters, precision: usize) -> Result<Tape, ParameterError> {
        todo!("{values:?} {precision}")
    }
}
