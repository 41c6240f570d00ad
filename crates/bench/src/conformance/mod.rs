//! The suite that every method must pass.
//!
//! | rules | hold |
//! |---|---|
//! | names and knobs | ids and knobs are named; a knob's value sets it again, others are errors |
//! | support | `supports` and `prepare` agree; parameters that do not exist are errors |
//! | rays | an answer depends on its ray alone: not on order, number, kind of request, or threads |
//! | answers | brackets are ordered and in the domain; normals are unit vectors along the gradient |
//! | extremes | no rays, rays that are no rays, rays along axes and faces, long and short directions |
//! | truth | certificates hold against the reference; most crossings are found |

mod answers;
mod cases;
mod knobs;
mod normals;
mod suite;

use std::fmt;

use zeroset_raycast::{Error, Method, Scene};

use crate::{Oracle, Remembering, truth};
use suite::Suite;

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

/// Checks a method on a scene against the reference; no failure is a pass.
///
/// A method that does not support the scene passes if it says so whenever it is asked.
pub fn check(method: &dyn Method, scene: &Scene) -> Vec<Failure> {
    match truth::reference(scene) {
        Ok(oracle) => check_with(&Remembering::new(oracle), method, scene),
        Err(error) => {
            vec![Failure { rule: "the reference has the scene", detail: error.to_string() }]
        }
    }
}

/// As [`check`], but against another oracle than the reference: its own, or one that is asked the same for
/// several methods and [remembers](Remembering).
pub fn check_with(oracle: &dyn Oracle, method: &dyn Method, scene: &Scene) -> Vec<Failure> {
    let mut suite = Suite::new(oracle, method, scene);
    suite.check_names();
    suite.check_knobs();
    let prepared = match (method.supports(scene), method.prepare(scene)) {
        (Ok(()), Ok(intersector)) => Some(intersector),
        (Err(_), Err(Error::Unsupported(_))) => None,
        (supports, prepared) => {
            let prepared = prepared.map(|_| "an intersector");
            suite.fail("supports and prepare agree", format!("{supports:?}, but {prepared:?}"));
            None
        }
    };
    if let Some(mut intersector) = prepared {
        suite.check_parameters(intersector.as_mut());
        for case in suite.cases() {
            suite.check_case(intersector.as_ref(), &case);
        }
        suite.check_grouping(intersector.as_ref());
        suite.check_requests(intersector.as_ref());
        suite.check_no_rays(intersector.as_ref());
        suite.check_interruption(intersector.as_ref());
        suite.check_precisions();
    }
    suite.failures
}
