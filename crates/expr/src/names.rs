//! Names that equations know, and near ones for names that they do not.

use zeroset_ia::{Binary, Unary};

use crate::chebyshev::Form;

/// Something that is called with arguments.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Callable {
    /// a^2.
    Square,
    /// A function of one argument.
    Unary(Unary),
    /// A function of two arguments.
    Binary(Binary),
    /// A Chebyshev polynomial.
    Chebyshev(Form),
    /// sum(i, a, b, term).
    Sum,
}

impl Callable {
    /// What the name stands for.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        match name {
            "sqr" => Some(Self::Square),
            "sum" => Some(Self::Sum),
            _ => (Unary::from_name(name).map(Self::Unary))
                .or_else(|| Binary::from_name(name).map(Self::Binary))
                .or_else(|| Form::from_name(name).map(Self::Chebyshev)),
        }
    }

    /// An example of a call.
    pub(crate) fn example(self) -> String {
        match self {
            Self::Square => "sqr(x)".into(),
            Self::Unary(f) => format!("{f}(x)"),
            Self::Binary(f) => format!("{f}(x, y)"),
            Self::Chebyshev(form) => format!("{form}(4, x)"),
            Self::Sum => "sum(i, 1, 3, i*x^i)".into(),
        }
    }
}

/// Names that are not calls.
const PLAIN: [&str; 5] = ["x", "y", "z", "w", "pi"];

/// Can the name not be given to a parameter?
pub(crate) fn is_reserved(name: &str) -> bool {
    matches!(name, "x" | "y" | "z" | "pi" | "root") || Callable::from_name(name).is_some()
}

/// Every name that means something without a definition.
pub(crate) fn known<'a>() -> impl Iterator<Item = &'a str> {
    PLAIN
        .into_iter()
        .chain(["sqr", "sum"])
        .chain(Unary::ALL.iter().map(|f| f.name()))
        .chain(Binary::ALL.iter().map(|f| f.name()))
        .chain(Form::ALL.into_iter().map(Form::name))
        // A shorter life, so that names of an equation can join.
        .map(|name| -> &'a str { name })
}

/// What other notations call things.
const SYNONYMS: &[(&str, &str)] = &[
    ("ln", "log(x)"),
    ("lg", "log10(x)"),
    ("log1p", "logp1(x)"),
    ("sgn", "sign(x)"),
    ("signum", "sign(x)"),
    ("fabs", "abs(x)"),
    ("square", "sqr(x)"),
    ("fmod", "mod(x, y)"),
    ("arcsin", "asin(x)"),
    ("arccos", "acos(x)"),
    ("arctan", "atan(x)"),
    ("arctan2", "atan2(y, x)"),
    ("sec", "1/cos(x)"),
    ("csc", "1/sin(x)"),
    ("cot", "1/tan(x)"),
    ("clamp", "min(max(x, a), b)"),
    ("round", "floor(x + 0.5)"),
    ("e", "exp(1)"),
];

/// How to write what another notation calls by this name.
pub(crate) fn synonym(name: &str) -> Option<&'static str> {
    let lower = name.to_lowercase();
    SYNONYMS.iter().find(|(n, _)| *n == lower).map(|(_, known)| *known)
}

/// Up to three candidates that differ least, and little, from the name, as a phrase.
pub(crate) fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<String> {
    let lower = name.to_lowercase();
    let allowed = match name.len() {
        0..=1 => 0,
        2..=4 => 1,
        _ => 2,
    };
    let mut near: Vec<(usize, &str)> = candidates
        .map(|c| (strsim::damerau_levenshtein(&lower, &c.to_lowercase()), c))
        .filter(|(distance, _)| *distance <= allowed)
        .collect();
    near.sort_unstable();
    near.dedup();
    let least = near.first().map(|(distance, _)| *distance);
    near.retain(|(distance, _)| Some(*distance) == least);
    near.truncate(3);
    let quoted: Vec<String> = near.iter().map(|(_, c)| format!("`{c}`")).collect();
    match &quoted[..] {
        [] => None,
        [only] => Some(only.clone()),
        [first @ .., last] => Some(format!("{} or {last}", first.join(", "))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names() {
        assert_eq!(nearest("sqtr", known()).as_deref(), Some("`sqr` or `sqrt`"));
        assert_eq!(nearest("arctan2", known()).as_deref(), Some("`atan2`"));
        assert_eq!(nearest("SIN", known()).as_deref(), Some("`sin`"));
        assert_eq!(nearest("u", known()), None);
        assert_eq!(nearest("elephant", known()), None);
    }

    #[test]
    fn every_known_name_is_callable_or_plain() {
        for name in known() {
            assert!(PLAIN.contains(&name) || Callable::from_name(name).is_some(), "{name}");
        }
    }

    const GUIDE: &str = include_str!("../../../docs/equations.md");

    #[test]
    fn the_guide_names_all_that_an_equation_may() {
        let code = GUIDE.split('`').skip(1).step_by(2);
        let words: Vec<&str> =
            code.flat_map(|code| code.split(|c: char| !c.is_ascii_alphanumeric())).collect();
        for name in known() {
            assert!(words.contains(&name), "docs/equations.md does not mention {name}");
        }
    }

    #[test]
    fn the_examples_of_the_guide_are_equations() {
        let examples: Vec<&str> = GUIDE.split("```").nth(1).unwrap().trim().lines().collect();
        assert!(examples.len() >= 8, "{examples:?}");
        for example in examples {
            crate::Function::parse(example).unwrap_or_else(|e| panic!("{}", e.render()));
        }
    }
}
