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
            expected: format!("a number from {} to {}", text(min), text(max)),
        }),
    }
}

/// Reads a whole number in `[min, max]`.
///
/// # Errors
/// [`KnobError::Value`] names the limits.
pub fn whole(knob: &str, value: &str, [min, max]: [u32; 2]) -> Result<u32, KnobError> {
    match value.trim().parse() {
        Ok(n) if (min..=max).contains(&n) => Ok(n),
        _ => Err(KnobError::Value {
            knob: knob.into(),
            value: value.into(),
            expected: format!("a whole number from {min} to {max}"),
        }),
    }
}

/// A number as text that [`number`] reads back exactly, and that is never long: 0.05, 10, 1e-12.
pub fn text(x: f64) -> String {
    let exact = format!("{x:?}");
    exact.strip_suffix(".0").map(String::from).unwrap_or(exact)
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

/// The name of one of several values: what [`choice`] reads back.
///
/// # Panics
/// If the value is not among the choices.
pub fn name<T: PartialEq>(choices: &[(&str, T)], value: &T) -> String {
    let (name, _) = choices.iter().find(|(_, v)| v == value).expect("every value has a name");
    (*name).into()
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
    fn whole_numbers_have_no_fraction() {
        assert_eq!(whole("bits", " 53 ", [53, 4096]), Ok(53));
        for text in ["", "52", "4097", "53.5", "1e2", "-1", "nan"] {
            let error = whole("bits", text, [53, 4096]).unwrap_err().to_string();
            let expected =
                format!("knob bits cannot be {text:?}: it takes a whole number from 53 to 4096");
            assert_eq!(error, expected);
        }
    }

    #[test]
    fn numbers_are_short_and_read_back() {
        let cases = [(0.0, "0"), (10.0, "10"), (0.05, "0.05"), (1e-12, "1e-12"), (1e30, "1e30")];
        for (x, expected) in cases {
            assert_eq!(text(x), expected);
        }
        for x in [1.0 / 3.0, f64::MIN_POSITIVE, f64::MAX, 123_456_789.125] {
            assert_eq!(number("step", &text(x), [0.0, f64::MAX]), Ok(x));
        }
    }

    #[test]
    fn choices_are_listed() {
        let choices = [("outward", 1), ("nearest", 2)];
        assert_eq!(choice("rounding", " nearest", &choices), Ok(2));
        let error = choice("rounding", "Nearest", &choices).unwrap_err().to_string();
        assert_eq!(error, "knob rounding cannot be \"Nearest\": it takes outward or nearest");
        assert_eq!(name(&choices, &2), "nearest");
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
