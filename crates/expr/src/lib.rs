//! Equation text to functions.
//!
//! ```text
//! "x^2 + y^2 - r^2; r = 1"  --parse-->  Function (hash-consed, folded)  --values-->  Tape
//! ```
//!
//! A [`Function`] is what an equation says: an expression in x, y and z, with named parameters whose
//! values stay exact. With values for the parameters it becomes a [`Tape`]: a straight line of
//! [`Number`](zeroset_ia::Number) operations, evaluated over any number by an [`Evaluator`].

mod algebra;
mod calls;
mod chebyshev;
mod definitions;
pub mod error;
pub mod evaluator;
pub mod function;
mod graph;
mod lexer;
mod lower;
mod names;
mod parser;
mod plan;
mod prelude;
mod print;
mod rational;
mod root;
mod slope;
pub mod tape;

pub use error::{ParameterError, ParseError};
pub use evaluator::Evaluator;
pub use function::{Definitions, Function, Parameter, Parameters};
pub use tape::{Instruction, Op, Register, Tape};
