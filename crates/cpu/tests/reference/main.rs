//! The reference is doubted: its answers are held against closed forms, against exact isolation of
//! the roots of ray polynomials, and against dense samples of functions that are no polynomials.

mod algebraic;
mod cast;
mod closed;
mod contract;
mod rational;
mod transcendental;
