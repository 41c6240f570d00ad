//! Tapes are short, use few registers, and know what kind of function they compute.

use zeroset_expr::{Function, Instruction, Op, Parameters, Tape};
use zeroset_ia::{Constant, Plain};

fn tape(text: &str) -> Tape {
    let function = Function::parse(text).unwrap_or_else(|e| panic!("{}", e.render()));
    function.tape(&Parameters::default(), 128).expect("defaults are values")
}

fn ops(text: &str) -> Vec<Op> {
    tape(text).instructions().iter().map(|i| i.op).collect()
}

const BARTH_SEXTIC: &str = "4*(phi^2*x^2-y^2)*(phi^2*y^2-z^2)*(phi^2*z^2-x^2)\
                            -(1+2*phi)*(x^2+y^2+z^2-1)^2; phi = (1+sqrt(5))/2";
const KLEIN_BOTTLE: &str = "(x^2+y^2+z^2+2*y-1)*((x^2+y^2+z^2-2*y-1)^2-8*z^2)\
                            +16*x*z*(x^2+y^2+z^2-2*y-1)";

#[test]
fn common_parts_are_computed_once() {
    for (text, instructions, registers) in [
        ("x", 0, 3),
        ("x + y", 1, 3),
        ("x^2 + y^2 + z^2 - 1", 6, 3),
        ("(x+y)^2 + sin(x+y) - (y+x)", 5, 3),
        // Three squares, each of the one before.
        ("x^8 + x^4 - x^2", 5, 3),
        // Three squares; their scaled forms, differences and product; the sum, offset and squared.
        (BARTH_SEXTIC, 18, 5),
        (KLEIN_BOTTLE, 18, 6),
    ] {
        let tape = tape(text);
        let found = (tape.instructions().len(), tape.registers());
        assert_eq!(found, (instructions, registers), "{text}: {:#?}", tape.instructions());
    }
}

#[test]
fn registers_are_used_again() {
    // One sum at a time, however many terms.
    let terms: Vec<String> = (1..200).map(|i| format!("sin({i}*x)*cos({i}*y)")).collect();
    let chain = tape(&terms.join(" + "));
    assert!(chain.instructions().len() >= 199 * 6 - 3);
    assert!(chain.registers() <= 6, "{}", chain.registers());
    // The operand that needs more registers comes first, on whichever side it is.
    let mut right = String::from("z");
    for i in 0..60 {
        right = format!("sin(x + {i})/({right})");
    }
    assert!(tape(&right).registers() <= 5, "{}", tape(&right).registers());
}

#[test]
fn constants_are_operands_of_the_cheapest_operation() {
    for (text, expected) in [
        ("3*x", vec![Op::Scale(0, 0)]),
        ("x*3", vec![Op::Scale(0, 0)]),
        ("x/3", vec![Op::Scale(0, 0)]),
        ("x/a; a = 3", vec![Op::Scale(0, 0)]),
        ("2*(3*x)*a; a = 5", vec![Op::Scale(0, 0)]),
        ("x + 3", vec![Op::Offset(0, 0)]),
        ("x - 3", vec![Op::Offset(0, 0)]),
        ("1 + x - pi + 2", vec![Op::Offset(0, 0)]),
        ("x^2", vec![Op::Sqr(0)]),
        ("x*x", vec![Op::Sqr(0)]),
        ("x^4", vec![Op::Sqr(0), Op::Sqr(0)]),
        ("x^5", vec![Op::Powi(0, 5)]),
        ("x^-1", vec![Op::Powi(0, -1)]),
        ("x^0.5", vec![Op::Unary(zeroset_ia::Unary::Sqrt, 0)]),
        ("x^0.3", vec![Op::Powc(0, 0)]),
        ("-x", vec![Op::Neg(0)]),
        ("x - y", vec![Op::Sub(0, 1)]),
        ("x + -y", vec![Op::Sub(0, 1)]),
        ("x - -2*y", vec![Op::Scale(1, 0), Op::Add(0, 1)]),
        ("2/x", vec![Op::Load(0), Op::Div(1, 0)]),
    ] {
        assert_eq!(ops(text), expected, "{text}");
    }
}

#[test]
fn polynomials_have_degrees() {
    for (text, degree) in [
        (BARTH_SEXTIC, Some(6)),
        (KLEIN_BOTTLE, Some(6)),
        ("x", Some(1)),
        ("x*y*z + x^2", Some(3)),
        ("(x^2 + y)^3*z - 1", Some(7)),
        ("x/2 + y/pi", Some(1)),
        ("T(7, x) + Tpow(4, y)", Some(7)),
        ("x^n; n = 4", Some(4)),
        // Terms that cancel are counted.
        ("x^4 + y - x^4", Some(4)),
        ("Tcos(7, x)", None),
        ("x^-1", None),
        ("x^0.5", None),
        ("1/x", None),
        ("x/y*y", None),
        ("abs(x)", None),
        ("sin(x) + y", None),
        ("min(x, y)", None),
        ("((((x^1024)^1024)^1024)^1024)^1024", Some(u32::MAX)),
    ] {
        let function = Function::parse(text).expect("it is an equation");
        assert_eq!(function.degree(), degree, "{text}");
        assert_eq!(tape(text).degree(), degree, "{text}");
    }
}

#[test]
fn continuity_is_claimed_for_total_operations_alone() {
    for text in [
        BARTH_SEXTIC,
        "abs(x) + min(x, y) + max(y, z) + hypot(x, y)",
        "cbrt(x)",
        "exp(x) - exp2(y)",
        "exp10(x) + expm1(y)",
        "sin(x)*cos(y) + atan(z)",
        "sinh(x) + cosh(y) + tanh(z) + asinh(x)",
        "x/3",
        "T(9, x)",
        "x^0 + y",
        "x + 1/3 + log(2)",
    ] {
        assert!(tape(text).is_continuous(), "{text}");
    }
    for text in [
        "1/x",
        "x/y",
        "x^-2",
        "x^0.5",
        "x^0.3",
        "x^y",
        "sqrt(x)",
        "log(x)",
        "log2(x)",
        "log10(x)",
        "logp1(x)",
        "tan(x)",
        "asin(x)",
        "acos(x)",
        "acosh(x)",
        "atanh(x)",
        "sign(x)",
        "floor(x)",
        "ceil(x)",
        "mod(x, 2)",
        "atan2(y, x)",
        "pow(2, x)",
        "x + 0*log(y)",
    ] {
        assert!(!tape(text).is_continuous(), "{text}");
    }
}

#[test]
fn every_sub_value_is_shown() {
    let tape = tape("(x + y)*z - 1");
    let mut seen = Vec::new();
    let point = [1.0, 2.0, 3.0].map(Plain);
    let result = tape.evaluator(&point[0]).visit(point, |value| seen.push(value.0));
    assert_eq!((result.0, &seen[..]), (8.0, &[3.0, 9.0, 8.0][..]));
}

#[test]
fn an_evaluator_can_be_used_again() {
    let tape = tape("x^2 + 3*y - z");
    let mut evaluator = tape.evaluator(&Plain(0.0));
    for i in 0..10 {
        let [x, y, z] = [0, 1, 2].map(|k| f64::from(i * (k + 1)));
        assert_eq!(evaluator.evaluate([x, y, z].map(Plain)).0, x * x + 3.0 * y - z);
    }
}

#[test]
fn tapes_can_be_written_by_hand() {
    let instructions = vec![
        Instruction { op: Op::Scale(0, 0), out: 3 },
        Instruction { op: Op::Add(3, 1), out: 3 },
    ];
    let tape = Tape::new(instructions, vec![Constant::from_f64(2.0)], 3);
    assert_eq!(tape.evaluator(&Plain(0.0)).evaluate([3.0, 4.0, 5.0].map(Plain)).0, 10.0);
    assert_eq!((tape.registers(), tape.output(), tape.degree()), (4, 3, Some(1)));
}

#[test]
#[should_panic(expected = "register 4 is read before it is set")]
fn unset_registers_are_refused() {
    let op = Op::Add(0, 4);
    Tape::new(vec![Instruction { op, out: 4 }], Vec::new(), 4);
}

#[test]
#[should_panic(expected = "no constant 0")]
fn missing_constants_are_refused() {
    let op = Op::Load(0);
    Tape::new(vec![Instruction { op, out: 3 }], Vec::new(), 3);
}
