//! Which device is meant.

use std::fmt;

use zeroset_raycast::{Knob, KnobError};

/// The environment's variable that chooses a device where nothing else does.
pub const VARIABLE: &str = "ZEROSET_DEVICE";

/// Which device is meant.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub enum Choice {
    /// What the variable [`ZEROSET_DEVICE`](VARIABLE) says; without it, a discrete GPU before an
    /// integrated one before one in software.
    #[default]
    Auto,
    /// The number in the list of [`adapters`](super::adapters), or a part of the name.
    Named(String),
}

impl Choice {
    /// Reads `auto`, a number or a part of a name.
    pub fn read(text: &str) -> Self {
        match text.trim() {
            "auto" => Self::Auto,
            name => Self::Named(name.into()),
        }
    }

    /// The choice with the environment's in place of `auto`.
    pub(super) fn resolved(&self) -> Self {
        match self {
            Self::Auto => match std::env::var(VARIABLE) {
                Ok(text) if !text.trim().is_empty() => Self::read(&text),
                _ => Self::Auto,
            },
            named => named.clone(),
        }
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Named(name) => f.write_str(name),
        }
    }
}

/// The knob `device` with its value, which every method on devices has.
pub fn knob(choice: &Choice) -> Knob {
    Knob {
        name: "device",
        value: choice.to_string(),
        doc: "where it runs: a number or a part of a name in the list of `zeroset devices`, or auto: what the variable ZEROSET_DEVICE says, else the first (default auto)",
    }
}

/// Reads the knob's value.
///
/// # Errors
/// If there is no such device.
pub fn read_knob(value: &str) -> Result<Choice, KnobError> {
    let choice = Choice::read(value);
    if choice == Choice::Auto {
        return Ok(choice);
    }
    super::find(&choice).map(|_| choice).map_err(|why| KnobError::Value {
        knob: "device".into(),
        value: value.into(),
        expected: format!("auto, or a device by its number or a part of its name; {why}"),
    })
}
