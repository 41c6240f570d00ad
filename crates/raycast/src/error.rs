//! What can go wrong between a request and its answer.

use zeroset_expr::ParameterError;

/// A scene that a method cannot handle.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unsupported(pub String);

/// Why a request has no answer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The method cannot handle the scene or the rays.
    #[error(transparent)]
    Unsupported(#[from] Unsupported),
    /// A parameter of the equation cannot be set.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The domain is empty, inverted or not finite.
    #[error("{0}")]
    Domain(String),
    /// Patches that are none.
    #[error("{0}")]
    Patches(String),
    /// The answer would take longer than the caller allows.
    #[error("{0}")]
    TooSlow(String),
    /// A device that a method runs on failed.
    #[error("{0}")]
    Device(String),
    /// The caller asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// A knob that cannot be set.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum KnobError {
    /// No such knob.
    #[error("method {method} has no knob {knob:?}; it has {known}")]
    Unknown {
        /// The method's id.
        method: String,
        /// What was asked for.
        knob: String,
        /// The knobs that exist.
        known: String,
    },
    /// A value that the knob does not take.
    #[error("knob {knob} cannot be {value:?}: it takes {expected}")]
    Value {
        /// The knob.
        knob: String,
        /// What was given.
        value: String,
        /// What it takes.
        expected: String,
    },
}
