//! Knobs: a method's named settings as text.

use crate::KnobError;

/// A setting of a method.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Knob {
    /// Its name, as in the paper.
    pub name: &'static str,
    /// Its value as text that sets it again.
    pub value: String,
    /// What it does, with unit and default.
    pub doc: &'static str,
}

/// Reads a finite number in `[min, max]`.
///
/// # Errors
/// [`KnobError::Value`] names the limits.
pub fn number(knob: &str, value: &str, [min, max]: [f64; 2]) -> Result<f64, KnobError> {
    match value.trim().parse::<f64>() {
        Ok(x) if x >= min && x <= max && x.is_finite() => Ok(x),
        _ => Err(KnobError::Value {
            knob: knob.into(),
            value: value.into(),
            expected: format!("a number from {min} to {max}"),
        }),
    }
}

/// Reads one of several names.
///
/// # Errors
/// [`KnobError::Value`] lists them.
pub fn choice<T: Copy>(knob: &str, value: &str, choices: &[(&str, T)]) -> Result<T, KnobError> {
    choices.iter().find(|(name, _)| *name == value.trim()).map(|(_, v)| *v).ok_or_else(|| {
        KnobError::Value {
            knob: knob.into(),
            value: value.into(),
            expected: choices.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(" or "),
        }
    })
}

/// The error for a knob that `method` does not have.
pub fn unknown(method: &str, knob: &str, known: &[Knob]) -> KnobError {
    let known: Vec<_> = known.iter().map(|k| k.name).collect();
    KnobError::Unknown { method: method.into(), knob: knob.into(), known: known.join(", ") }
}
