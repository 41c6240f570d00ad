//! The grammar: what texts mean.

use std::f64::consts::PI;

use zeroset_expr::{Definitions, Function, Parameter, Parameters};
use zeroset_ia::Plain;

fn parse(text: &str) -> Function {
    Function::parse(text).unwrap_or_else(|e| panic!("{}", e.render()))
}

fn at(function: &Function, [x, y, z]: [f64; 3]) -> f64 {
    let tape = function.tape(&Parameters::default(), 128).expect("defaults are values");
    tape.evaluator(&Plain(x)).evaluate([Plain(x), Plain(y), Plain(z)]).0
}

#[test]
fn texts_that_are_the_same_function() {
    for (text, same) in [
        // Signs and powers.
        ("-x^2", "-(x^2)"),
        ("(-x)^2", "x^2"),
        ("-x^3", "(-x)^3"),
        ("2^-x", "2^(-x)"),
        ("2^-x^2", "2^(-(x^2))"),
        ("2^-x*y", "(2^(-x))*y"),
        ("x^2^3", "x^8"),
        ("2^3^2*x", "512*x"),
        ("x^y^z", "x^(y^z)"),
        ("--x", "x"),
        ("---x", "-x"),
        ("-x*y", "-(x*y)"),
        ("x*-y", "-(x*y)"),
        ("x*-y^2", "-(x*y^2)"),
        ("x/-y", "-(x/y)"),
        ("x - -y", "x + y"),
        // Grouping.
        ("x-y-z", "(x-y)-z"),
        ("x-y+z", "(x-y)+z"),
        ("x/y/z", "(x/y)/z"),
        ("x/y*z", "(x/y)*z"),
        ("x+y*z^2", "x+(y*(z^2))"),
        ("x*y+z", "(x*y)+z"),
        ("x/2/4", "x/8"),
        ("((((x))))", "x"),
        (" x\n+\ty\r\n", "x+y"),
        // Two sides.
        ("x^2 = y", "x^2 - y"),
        ("x = y - z", "x - (y - z)"),
        ("1 = x", "1 - x"),
        ("-x + 1", "1 - x"),
        // One function in two orders.
        ("x*y + y*x", "x*y + x*y"),
        ("min(x, y) + min(y, x)", "min(x, y) + min(x, y)"),
        ("hypot(x, y)*hypot(y, x)", "hypot(x, y)^2"),
        // Numbers.
        ("1e3*x", "1000*x"),
        ("1E3*x", "1000*x"),
        ("1.5e-3*x", "0.0015*x"),
        ("2e+1*x", "20*x"),
        (".5*x", "x/2"),
        ("5.*x", "5*x"),
        ("0.25*x", "x/4"),
        ("0.1*x", "x/10"),
        ("007*x", "7*x"),
        // Names.
        ("sqr(x)", "x^2"),
        ("pow(x, 3)", "x^3"),
        ("pow(x, y)", "x^y"),
        ("min(x, y, z)", "min(min(x, y), z)"),
        ("max(x, y, z, 1)", "max(max(max(x, y), z), 1)"),
        // Definitions.
        ("x + r; r = 2; s = 3", "x + r; r = 2"),
        ("x + r;; r = 2;", "x + r; r = 2"),
        ("x + a; b = 2; a = b + 1", "x + a; a = b + 1; b = 2"),
        ("x = t[2]; t = [1, 2, 3]", "x - 2"),
        ("x*[5, 6, 7][3]", "7*x"),
        ("x + t[3-1]; t = [1, s, pi]; s = 4", "x + s; s = 4"),
        // Sums.
        ("sum(i, 1, 3, x^i)", "x + x^2 + x^3"),
        ("sum(i, -1, 2, i*x)", "-x + 0 + x + 2*x"),
        ("sum(i, 2, 2, x^i)", "x^2"),
        ("sum(i, 1, 1+1, x*y^i)*z", "(x*y + x*y^2)*z"),
        ("sum(i, 1, 2, sum(j, i, 2, x^i*y^j))", "x*y + x*y^2 + x^2*y^2"),
        ("sum(k, 1, 2, t[k]*x^k); t = [3, 4]", "3*x + 4*x^2"),
        ("sum(i, 1, 2, x) - y", "x + x - y"),
    ] {
        assert_eq!(parse(text), parse(same), "{text} is {}, not {same}", parse(text));
    }
}

#[test]
fn texts_that_are_different_functions() {
    for (text, other) in [
        ("-x^2", "(-x)^2"),
        ("x-y-z", "x-(y-z)"),
        ("x/y/z", "x/(y/z)"),
        ("x^2^3", "(x^2)^3"),
        ("2^-x^2", "(2^-x)^2"),
        ("x/y*z", "x/(y*z)"),
        ("x = y", "y = x"),
        ("mod(x, y)", "mod(y, x)"),
        ("atan2(x, y)", "atan2(y, x)"),
        // What may be undefined stays.
        ("x/x - y", "1 - y"),
        ("x + log(y)^0", "x + 1"),
        ("x + 0*log(y)", "x"),
        ("x + 0/y", "x"),
        ("x + 0*(1/y)", "x"),
        ("x + 0*y^-1", "x"),
        ("x + 0*y^0.5", "x"),
        ("x + mod(y, z)^0", "x + 1"),
        ("x + 0*atan2(y, z)", "x"),
        ("x + 0*pow(y, z)", "x"),
        ("mod(x, y) + mod(y, x)", "mod(x, y) + mod(x, y)"),
        ("atan2(x, y) + atan2(y, x)", "atan2(x, y) + atan2(x, y)"),
        ("x + (sqrt(y) - sqrt(y))", "x"),
        ("x + sqrt(y)^2", "x + y"),
        ("(x^0.5)^2", "x"),
        ("x + (tan(y) - tan(y))", "x"),
    ] {
        assert_ne!(parse(text), parse(other), "{text} and {other}");
    }
    for (text, folded) in [("x + y^0", "x + 1"), ("x + 0*exp(y)", "x"), ("x + (y - y)", "x")] {
        assert_eq!(parse(text), parse(folded));
    }
}

#[test]
fn functions_have_their_values() {
    for (text, x, y) in [
        ("sqr(x)", 3.0, 9.0),
        ("sqrt(x)", 2.25, 1.5),
        ("cbrt(x)", -27.0, -3.0),
        ("abs(x)", -2.5, 2.5),
        ("sign(x)", -7.0, -1.0),
        ("sign(x)", 0.0, 0.0),
        ("floor(x)", -1.5, -2.0),
        ("ceil(x)", -1.5, -1.0),
        ("min(x, 2)", 3.0, 2.0),
        ("max(x, 2, 5)", 3.0, 5.0),
        // The remainder takes the divisor's sign.
        ("mod(x, 3)", 5.0, 2.0),
        ("mod(x, 3)", -5.0, 1.0),
        ("mod(x, -3)", 5.0, -1.0),
        ("mod(x, -3)", -5.0, -2.0),
        ("exp(x)", 1.0, std::f64::consts::E),
        ("exp2(x)", 5.0, 32.0),
        ("exp10(x)", 3.0, 1000.0),
        ("expm1(x)", 1e-10, 1.000_000_000_05e-10),
        ("log(x)", std::f64::consts::E, 1.0),
        ("log2(x)", 32.0, 5.0),
        ("log10(x)", 1000.0, 3.0),
        ("logp1(x)", 1e-10, 9.999_999_999_5e-11),
        ("pow(x, 0.5)", 6.25, 2.5),
        ("pow(2, x)", -1.0, 0.5),
        ("x^1.5", 4.0, 8.0),
        ("x^-2", 4.0, 0.0625),
        ("hypot(x, 4)", 3.0, 5.0),
        ("sin(x)", PI / 6.0, 0.5),
        ("cos(x)", PI / 3.0, 0.5),
        ("tan(x)", PI / 4.0, 1.0),
        ("asin(x)", 0.5, PI / 6.0),
        ("acos(x)", 0.5, PI / 3.0),
        ("atan(x)", -1.0, -PI / 4.0),
        ("atan2(x, -1)", 1.0, 3.0 * PI / 4.0),
        ("atan2(-1, x)", -1.0, -3.0 * PI / 4.0),
        ("sinh(x)", 1.0, 1.175_201_193_643_801_4),
        ("cosh(x)", 1.0, 1.543_080_634_815_243_7),
        ("tanh(x)", 1.0, 0.761_594_155_955_764_9),
        ("asinh(x)", 1.175_201_193_643_801_4, 1.0),
        ("acosh(x)", 1.543_080_634_815_243_7, 1.0),
        ("atanh(x)", 0.761_594_155_955_764_9, 1.0),
        ("x - pi", PI, 0.0),
        ("x + w", 1.0, 1.5),
        ("x + w; w = 2", 1.0, 3.0),
    ] {
        let found = at(&parse(text), [x, 0.0, 0.0]);
        assert!((found - y).abs() <= 4e-15 * y.abs(), "{text} at {x} is {found}, not {y}");
    }
}

#[test]
fn chebyshev_polynomials_agree_in_every_form() {
    for n in 0..=20_u32 {
        for i in -30..=30 {
            let x = f64::from(i) / 20.0;
            let k = f64::from(n);
            let sign = if x < 0.0 { k.rem_euclid(2.0).mul_add(-2.0, 1.0) } else { 1.0 };
            let expected = if x.abs() <= 1.0 {
                (k * x.acos()).cos()
            } else {
                sign * (k * x.abs().acosh()).cosh()
            };
            for (form, tolerance) in [("T", 1e-11), ("Tpow", 1e-9), ("Tcos", 1e-11)] {
                let found = at(&parse(&format!("{form}({n}, x) + 0.5*y")), [x, 2.0, 0.0]) - 1.0;
                let near = (found - expected).abs() <= tolerance * expected.abs().max(1.0);
                assert!(near, "{form}({n}, {x}) = {found}, not {expected}");
            }
        }
    }
    // Of constants they are constants, the same in every form.
    for form in ["T", "Tpow", "Tcos"] {
        assert_eq!(at(&parse(&format!("x + {form}(5, -0.3)")), [0.0; 3]), -0.998_88);
        assert_eq!(at(&parse(&format!("x + {form}(4, 3/2)")), [0.0; 3]), 23.5);
        let irrational = at(&parse(&format!("x + {form}(3, cos(0.2))")), [0.0; 3]);
        assert!((irrational - 0.6_f64.cos()).abs() < 1e-15);
    }
}

#[test]
fn definitions_of_the_equation_replace_those_given() {
    let definitions = Definitions {
        parameters: vec![
            Parameter { name: "r".into(), default: "3".into() },
            Parameter { name: "phi".into(), default: "(1+sqrt(5))/2".into() },
        ],
        tables: vec![("t".into(), vec!["1".into(), "r + 1".into(), "1/3".into()])],
    };
    let value = |text: &str| {
        let function = Function::parse_with(text, &definitions);
        at(&function.unwrap_or_else(|e| panic!("{}", e.render())), [0.0; 3])
    };
    assert_eq!(value("x + r"), 3.0);
    assert_eq!(value("x + r; r = 5"), 5.0);
    assert_eq!(value("x + t[2]; r = 5"), 6.0);
    assert_eq!(value("x + t[1]; t = [8]"), 8.0);
    assert_eq!(value("x + t; t = 9"), 9.0);
    assert_eq!(value("x + sum(i, 1, 2, t[i])"), 5.0);
    assert!((value("x + phi^2 - phi") - 1.0).abs() < 1e-15);
    let unused = Function::parse_with("x + r", &definitions).expect("it is an equation");
    assert_eq!(unused.parameters(), &definitions.parameters[..1]);
}

#[test]
fn parameters_are_listed_in_the_order_of_first_use() {
    let function = parse("x*b + w*a + c; a = 1/3; c = a + 1; b = c/2; d = 1");
    let listed: Vec<_> =
        function.parameters().iter().map(|p| (p.name.as_str(), p.default.as_str())).collect();
    assert_eq!(listed, [("b", "c/2"), ("c", "a + 1"), ("a", "1/3"), ("w", "0.5")]);
}
