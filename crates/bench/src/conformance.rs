//! The suite that every method must pass.

use std::fmt;

use zeroset_raycast::{Method, Scene};

use crate::Oracle;

/// A rule that a method breaks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// The rule.
    pub rule: &'static str,
    /// Where, and how.
    pub detail: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.rule, self.detail)
    }
}

/// Checks a method on a scene against the reference; no failure is a pass. A method that does not
/// support the scene passes if it says so consistently.
pub fn check(method: &dyn Method, scene: &Scene) -> Vec<Failure> {
    todo!("{method:?} {scene:?}")
}

/// As [`check`], against another oracle than the reference.
pub fn check_with(oracle: &dyn Oracle, method: &dyn Method, scene: &Scene) -> Vec<Failure> {
    let _ = oracle;
    check(method, scene)
}
