//! No text makes the reader panic, overflow its stack or take long.

mod expressions;

use std::time::{Duration, Instant};

use expressions::{Functions, expression};
use proptest::prelude::*;
use zeroset_expr::{Function, Parameters};
use zeroset_ia::{Interval, Plain, Set};

/// Does with a text what can be done: the point is that nothing panics.
fn exercise(text: &str) {
    match Function::parse(text) {
        Ok(function) => {
            assert!(Function::parse(&function.to_string()).as_ref() == Ok(&function), "{text}");
            let tape = function.tape(&Parameters::default(), 128).expect("defaults are values");
            tape.evaluator(&Plain(0.5)).evaluate([0.5, -1.5, 0.0].map(Plain));
            let side = Interval::<f32, Set>::new(-1.0, 2.0);
            tape.evaluator(&side).evaluate([side; 3]);
        }
        Err(error) => {
            assert!(error.span.start <= error.span.end && error.span.end <= error.text.len());
            assert!(error.text.get(error.span.clone()).is_some(), "{text}: not at characters");
            assert!(!error.message.is_empty() && error.render().lines().count() >= 4);
        }
    }
    // As a value of a parameter.
    let mut values = Parameters::default();
    values.set("a", text);
    let parameter = Function::parse("x + a; a = 1").expect("it is an equation");
    if let Err(error) = parameter.tape(&values, 128) {
        assert!(!error.message.is_empty());
    }
}

/// Pieces that equations consist of.
const PIECES: &[&str] = &[
    "x",
    "y",
    "z",
    "w",
    "pi",
    "a",
    "i",
    "t",
    "0",
    "1",
    "2",
    "3",
    "0.5",
    "1e9",
    "1e-3",
    "1025",
    "+",
    "-",
    "*",
    "/",
    "^",
    "(",
    ")",
    "[",
    "]",
    ",",
    "=",
    ";",
    ":",
    "root:",
    "sum(i,1,3,",
    "T(3,",
    "Tcos(2,",
    "t[2]",
    "; a = ",
    "; t = [1, 2]",
    "; t = [",
    "sin(",
    "sqrt(",
    "log(",
    "mod(",
    "min(",
    "atan2(",
    "pow(",
    "hypot(",
    "floor(",
    "-x",
    "x^2",
    "a^3",
    " ",
    "\n",
    "e",
    "inf",
    "é",
    "²",
    "$",
];

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(10_000) })]

    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..60)) {
        exercise(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn random_characters_never_panic(text in "[ -~é²−\n\t]{0,40}|\\PC{0,40}") {
        exercise(&text);
    }

    #[test]
    fn random_pieces_never_panic(
        pieces in prop::collection::vec(prop::sample::select(PIECES), 0..25)
    ) {
        exercise(&pieces.concat());
    }

    #[test]
    fn damaged_equations_never_panic(
        e in expression(Functions::All), at in any::<prop::sample::Index>(),
        piece in prop::sample::select(PIECES), removed in 0..3_usize
    ) {
        let mut text = e.text();
        let start = at.index(text.len());
        let end = (start + removed).min(text.len());
        text.replace_range(start..end, piece);
        exercise(&text);
    }
}

/// The longest that reading one of the texts below may take: several times what it does take.
const LIMIT: Duration = Duration::from_secs(2);

/// Reads a text against the clock.
fn parse(name: &str, text: &str) -> Result<Function, String> {
    let start = Instant::now();
    let result = Function::parse(text).map_err(|error| error.message);
    let elapsed = start.elapsed();
    assert!(elapsed < LIMIT, "{name} takes {elapsed:?}");
    result
}

fn refused(name: &str, text: &str, reason: &str) {
    match parse(name, text) {
        Ok(_) => panic!("{name} is accepted"),
        Err(message) => assert!(message.contains(reason), "{name}: {message}"),
    }
}

#[test]
fn nesting_is_limited() {
    for depth in [90, 210, 10_000, 300_000] {
        for (open, close) in [("(", ")"), ("-", ""), ("sin(", ")"), ("x^", ""), ("2-(", ")")] {
            let text = format!("{}x{}", open.repeat(depth), close.repeat(depth));
            match parse(open, &text) {
                Ok(_) => assert!(depth < 200),
                Err(message) if depth * open.len() < 1 << 19 => {
                    assert!(depth > 200 && message.contains("nested too deeply"), "{message}");
                }
                Err(message) => assert!(message.contains("at most"), "{message}"),
            }
        }
    }
    let chain: String = (0..300).map(|i| format!("; a{i} = a{}", i + 1)).collect();
    refused("a chain of definitions", &format!("x + a0{chain}; a300 = 1"), "nested too deeply");
    let tables: String = (0..300).map(|i| format!("; t{i} = [t{}[1]]", i + 1)).collect();
    refused("a chain of tables", &format!("x + t0[1]{tables}; t300 = [1]"), "nested too deeply");
    refused("brackets", &"[".repeat(100_000), "nested too deeply");
}

#[test]
fn long_chains_are_read_printed_and_evaluated() {
    let terms = 100_000;
    for (operator, value) in [("+", 5e4), ("-", -49_999.0), ("*", 0.0), ("/", f64::INFINITY)] {
        let function = parse(operator, &vec!["x"; terms].join(operator)).expect("long, not deep");
        let start = Instant::now();
        let printed = function.to_string();
        let tape = function.tape(&Parameters::default(), 128).expect("defaults are values");
        let found = tape.evaluator(&Plain(0.5)).evaluate([0.5; 3].map(Plain)).0;
        assert!(start.elapsed() < LIMIT);
        assert_eq!(found, value, "{operator}");
        assert!(tape.registers() <= 4);
        assert_eq!(parse(operator, &printed).as_ref(), Ok(&function));
    }
    refused("one term more", &vec!["x"; terms + 1].join("+"), "at most 100000 operands");
    let sum = parse("a written sum", "sum(i, 1, 49000, x*i)").expect("as large");
    assert!(sum.tape(&Parameters::default(), 128).is_ok());
}

#[test]
fn what_is_large_when_written_out_is_refused() {
    for (name, text, reason) in [
        ("a sum", "sum(i, 1, 10^12, x)", "at most 100000 operands"),
        ("sums of sums", "sum(i, 1, 1000, sum(j, 1, 1000, x))", "at most 100000 operands"),
        ("Chebyshev polynomials", "sum(i, 1, 2000, T(512, x + i))", "at most 100000 operands"),
        ("their powers", "sum(i, 1, 2000, Tpow(512, x + i))", "at most 100000 operands"),
        ("a huge number", "x + 10^1000^1000", "no finite value"),
        ("a power of powers", "x^((2^1000)^1000)", "beyond the range of doubles"),
        ("a large root", "x + a; a = root:(u + 1)^1000*(u + 2)^1000", "too large a polynomial"),
        ("a dense root", "x + a; a = root:sum(i, 0, 900, u^i)", "too large a polynomial"),
    ] {
        refused(name, text, reason);
    }
    refused("a megabyte", &" ".repeat((1 << 20) + 1), "bytes: at most 1048576 are read");
    refused("digits", &format!("x + {}", "9".repeat(1 << 19)), "too long");
}

#[test]
fn what_is_just_allowed_takes_no_longer() {
    let parameters = || (0..30_000).map(|i| (format!(" + a{i}"), format!("; a{i} = {i}/7")));
    let (used, defined): (String, String) = parameters().unzip();
    let digits = "7".repeat(500);
    for (name, text) in [
        ("parameters", format!("x{used}{defined}")),
        ("many polynomials", "sum(i, 1, 150, T(512, x + i))".into()),
        ("their powers", "sum(i, 1, 150, Tpow(512, x + i))".into()),
        ("long fractions", format!("x + sum(i, 1, 3000, t[1]*i); t = [1/{digits}]")),
        ("a harmonic number", "x + sum(i, 1, 2000, 1/i)".into()),
        ("a root of large coefficients", "x + a; a = root:u^3 - 10^500".into()),
        ("a dense root", "x + a; a = root:sum(i, 0, 151, u^i)".into()),
        ("a root of high degree", "x + a; a = root:u^151 - 2".into()),
    ] {
        let function = parse(name, &text).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(function.tape(&Parameters::default(), 128).is_ok(), "{name}");
    }
}
