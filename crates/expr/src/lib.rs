//! Equation text to functions.
