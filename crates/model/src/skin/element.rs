//! Chemical elements and their radii.

use std::fmt::{self, Display};

/// An element whose van der Waals radius is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "their symbols")]
pub enum Element {
    H,
    He,
    C,
    N,
    O,
    F,
    Ne,
    Si,
    P,
    S,
    Cl,
    Ar,
    As,
    Se,
    Br,
    Kr,
    Te,
    I,
    Xe,
}

impl Element {
    /// All of them.
    pub const ALL: [Self; 19] = [
        Self::H,
        Self::He,
        Self::C,
        Self::N,
        Self::O,
        Self::F,
        Self::Ne,
        Self::Si,
        Self::P,
        Self::S,
        Self::Cl,
        Self::Ar,
        Self::As,
        Self::Se,
        Self::Br,
        Self::Kr,
        Self::Te,
        Self::I,
        Self::Xe,
    ];

    /// The element with this symbol, in letters of any case.
    pub fn with_symbol(symbol: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|element| element.to_string().eq_ignore_ascii_case(symbol))
    }

    /// The van der Waals radius in angstrom: A. Bondi, "van der Waals Volumes and Radii", J. Phys. Chem. 68
    /// (1964).
    pub fn radius(self) -> f64 {
        match self {
            Self::H => 1.20,
            Self::He => 1.40,
            Self::C => 1.70,
            Self::N => 1.55,
            Self::O => 1.52,
            Self::F => 1.47,
            Self::Ne => 1.54,
            Self::Si => 2.10,
            Self::P | Self::S => 1.80,
            Self::Cl => 1.75,
            Self::Ar => 1.88,
            Self::As | Self::Br => 1.85,
            Self::Se => 1.90,
            Self::Kr => 2.02,
            Self::Te => 2.06,
            Self::I => 1.98,
            Self::Xe => 2.16,
        }
    }
}

impl Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self, f)
    }
}
