//! What a function prints reads as an equal function.

mod expressions;

use expressions::{Functions, expression, expression_with};
use proptest::prelude::*;
use zeroset_expr::{Function, Parameters};

fn parse(text: &str) -> Function {
    Function::parse(text).unwrap_or_else(|e| panic!("{}", e.render()))
}

/// Reads, prints, reads again; random trees that are constant or undefined are passed over.
fn check(text: &str) -> Result<(), TestCaseError> {
    let function = Function::parse(text);
    prop_assume!(function.is_ok());
    let function = function.expect("just looked");
    let printed = function.to_string();
    let again = match Function::parse(&printed) {
        Ok(again) => again,
        Err(error) => return Err(TestCaseError::fail(format!("{text}: {}", error.render()))),
    };
    prop_assert_eq!(&again, &function, "{} prints as {}", text, printed);
    prop_assert_eq!(&again.to_string(), &printed);
    let tape = |f: &Function| f.tape(&Parameters::default(), 128).expect("it has a tape");
    let [a, b] = [&again, &function].map(|f| tape(f).instructions().to_vec());
    prop_assert_eq!(a, b, "{} has another tape than {}", printed, text);
    Ok(())
}

/// Constants of every kind.
const DEFINITIONS: &str = "; a = 0.3; b = root:7*u^3 + 7*u + 1; c = (a + sqrt(5))/-2; d = -1/3; \
                           t = [1, -2.5, 1/7, pi, a]";
const NAMES: &[&str] = &[
    "a",
    "b",
    "c",
    "d",
    "w",
    "t[2]",
    "t[3]",
    "t[4]",
    "t[5]",
    "T(3, x)",
    "Tpow(2, y - a)",
    "Tcos(5, z/2)",
    "x^a",
    "2^-x",
    "c^y",
    "sum(i, -1, 2, x^i*t[2+i])",
];

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        max_global_rejects: 20_000,
        ..ProptestConfig::with_cases(10_000)
    })]

    #[test]
    fn functions_read_back(e in expression(Functions::All)) {
        check(&e.text())?;
    }

    #[test]
    fn functions_with_parameters_read_back(e in expression_with(NAMES)) {
        check(&format!("{}{DEFINITIONS}", e.text()))?;
    }
}

#[test]
fn functions_print_as_people_write_them() {
    for (text, printed) in [
        ("x^2+y^2=r^2; r=1.50", "x^2 + y^2 - r^2; r = 1.5"),
        ("-(x*y)", "-(x*y)"),
        ("1 - (2 - x)", "x - 1"),
        ("x*2*3 - -4*y", "6*x + 4*y"),
        ("x/4 + y/3", "0.25*x + 1/3*y"),
        ("(x+y)*(x-y)/z", "(x + y)*(x - y)/z"),
        ("x/(y*z)", "x/(y*z)"),
        ("(x^2)^3 + (-x)^3 + x^-1", "(x^2)^3 - x^3 + x^-1"),
        ("x*x", "x^2"),
        ("x - w", "x - w"),
        ("x - w; w = 1/2", "x - w"),
        ("x - w; w = 1", "x - w; w = 1"),
        ("x + a; b = 3; a = root:t^3 + t - 3", "x + a; a = root:x^3 + x - 3"),
        ("x + t[2]; t = [5, pi]", "x + pi"),
        ("atan2( y,x )-T(4,z)", "atan2(y, x) - T(4, z)"),
        ("sum(i, 1, 3, i*x^i)", "x + 2*x^2 + 3*x^3"),
    ] {
        assert_eq!(parse(text).to_string(), printed, "{text}");
        check(text).unwrap();
    }
}

#[test]
fn equal_functions_have_equal_expressions_and_parameters() {
    let f = parse("x + a; a = 1");
    assert_eq!(f, parse("a + x; b = 2; a = 1.0"));
    assert_ne!(f, parse("x + a; a = 2"));
    assert_ne!(f, parse("x + b; b = 1"));
    assert_ne!(f, parse("x + 1"));
    assert_eq!(f.text(), "x + a; a = 1");
}
