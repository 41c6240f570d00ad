//! Maps of space that leave a surface as it is.

use std::fmt::{self, Display};
use std::num::NonZeroU32;
use std::ops::Neg;
use std::str::FromStr;

use serde::Deserialize;

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

/// Plus or minus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sign {
    /// +1.
    Plus,
    /// -1.
    Minus,
}

impl Sign {
    /// The number with this sign put before it.
    pub fn apply<T: Neg<Output = T>>(self, x: T) -> T {
        match self {
            Self::Plus => x,
            Self::Minus => -x,
        }
    }

    fn prefix(self) -> &'static str {
        match self {
            Self::Plus => "",
            Self::Minus => "-",
        }
    }
}

/// A signed permutation m of the coordinates such that f(m(p)) is f(p) everywhere, or -f(p).
///
/// As text `(y, x, -z)`; with a minus sign before it if f changes sign: `-(-x, -y, -z)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(try_from = "String")]
pub struct Symmetry {
    /// The coordinates that take the places of x, y and z, with their signs.
    pub map: [(Sign, Axis); 3],
    /// The factor that f takes.
    pub sign: Sign,
}

impl Symmetry {
    /// The image of a point.
    pub fn apply<T: Clone + Neg<Output = T>>(&self, point: &[T; 3]) -> [T; 3] {
        self.map.map(|(sign, axis)| sign.apply(point[axis as usize].clone()))
    }
}

impl Display for Symmetry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.map.map(|(sign, axis)| {
            let name = ["x", "y", "z"][axis as usize];
            format!("{}{name}", sign.prefix())
        });
        write!(f, "{}({x}, {y}, {z})", self.sign.prefix())
    }
}

/// A text that is no symmetry.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{0:?} is no symmetry: write a permutation with signs, as \"(y, -x, z)\", and a minus sign \
         before it if f changes sign"
)]
pub struct SymmetryError(String);

impl FromStr for Symmetry {
    type Err = SymmetryError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let signed = |text: &str| match text.trim().strip_prefix('-') {
            Some(rest) => (Sign::Minus, rest.trim().to_owned()),
            None => (Sign::Plus, text.trim().to_owned()),
        };
        let read = || {
            let (sign, map) = signed(text);
            let coordinates = map.strip_prefix('(')?.strip_suffix(')')?.split(',');
            let mut map = Vec::with_capacity(3);
            for coordinate in coordinates {
                let (sign, name) = signed(coordinate);
                let axis = match name.as_str() {
                    "x" => Axis::X,
                    "y" => Axis::Y,
                    "z" => Axis::Z,
                    _ => return None,
                };
                if map.iter().any(|(_, taken)| *taken == axis) {
                    return None;
                }
                map.push((sign, axis));
            }
            Some(Self { map: map.try_into().ok()?, sign })
        };
        read().ok_or_else(|| SymmetryError(text.into()))
    }
}

impl TryFrom<String> for Symmetry {
    type Error = SymmetryError;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        text.parse()
    }
}

/// A turn about a coordinate axis that leaves f as it is everywhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// What it turns about.
    pub axis: Axis,
    /// It turns by 2 pi/order; by any angle if there is none.
    pub order: Option<NonZeroU32>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symmetries_read_back() {
        for text in ["(x, y, z)", "(y, -x, z)", "-(-x, -y, -z)", "(z, x, -y)"] {
            assert_eq!(text.parse::<Symmetry>().unwrap().to_string(), text);
        }
        assert_eq!("- ( - x,y ,z)".parse::<Symmetry>().unwrap().to_string(), "-(-x, y, z)");
    }

    #[test]
    fn symmetries_map_points() {
        let turn: Symmetry = "(y, -x, z)".parse().unwrap();
        assert_eq!(turn.apply(&[1, 2, 3]), [2, -1, 3]);
    }

    #[test]
    fn nonsense_is_no_symmetry() {
        for text in
            ["", "(x, y)", "(x, x, z)", "(x, y, z, x)", "x, y, z", "(x, y, w)", "--(x, y, z)"]
        {
            assert!(text.parse::<Symmetry>().is_err(), "{text}");
        }
    }
}
