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
    let names: Vec<_> = known.iter().map(|k| k.name).collect();
    let known = if names.is_empty() { "none".into() } else { names.join(", ") };
    KnobError::Unknown { method: method.into(), knob: knob.into(), known }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_within_limits_are_read() {
        let limits = [0.0, 2.0];
        for (text, value) in [("0", 0.0), ("2", 2.0), (" 1e-3 ", 1e-3), ("-0", 0.0)] {
            assert_eq!(number("step", text, limits), Ok(value), "{text:?}");
        }
        for text in ["", "nan", "inf", "-1e-300", "2.0000001", "1e999", "1,5", "0x1"] {
            let error = number("step", text, limits).unwrap_err().to_string();
            let expected = format!("knob step cannot be {text:?}: it takes a number from 0 to 2");
            assert_eq!(error, expected);
        }
        assert!(number("step", "inf", [0.0, f64::INFINITY]).is_err());
    }

    #[test]
    fn choices_are_listed() {
        let choices = [("outward", 1), ("nearest", 2)];
        assert_eq!(choice("rounding", " nearest", &choices), Ok(2));
        let error = choice("rounding", "Nearest", &choices).unwrap_err().to_string();
        assert_eq!(error, "knob rounding cannot be \"Nearest\": it takes outward or nearest");
    }

    #[test]
    fn unknown_knobs_are_answered_with_the_known_ones() {
        let knob = |name| Knob { name, value: String::new(), doc: "" };
        let error = unknown("amp-sign", "stepp", &[knob("step"), knob("bisections")]);
        assert_eq!(
            error.to_string(),
            "method amp-sign has no knob \"stepp\"; it has step, bisections"
        );
        let error = unknown("reference", "step", &[]).to_string();
        assert!(error.ends_with("it has none"), "{error}");
    }
}
