//! Constants are exact until a number takes them, and so are the values given for parameters.

use num_bigint::BigInt;
use num_rational::BigRational;
use zeroset_expr::{Function, Op, Parameters, Tape};
use zeroset_ia::{BigInterval, Constant, Interval, Plain, Set};

fn parse(text: &str) -> Function {
    Function::parse(text).unwrap_or_else(|e| panic!("{}", e.render()))
}

fn values(pairs: &[(&str, &str)]) -> Parameters {
    let mut values = Parameters::default();
    for (name, value) in pairs {
        values.set(name, value);
    }
    values
}

/// The only constant of `x * (text)`.
fn constant(text: &str, precision: usize) -> Constant {
    let (written, definitions) = text.split_once(';').unwrap_or((text, ""));
    let function = parse(&format!("x*({written});{definitions}"));
    let tape = function.tape(&Parameters::default(), precision).expect("defaults are values");
    assert!(matches!(tape.instructions()[0].op, Op::Scale(0, 0)), "{text}");
    assert_eq!(tape.constants().len(), 1, "{text}");
    tape.constants()[0].clone()
}

#[test]
fn doubles_are_points_and_others_one_unit_wide() {
    for (text, value) in [
        ("2", 2.0),
        ("0.5", 0.5),
        ("-0.375", -0.375),
        ("1/8 + 1/4", 0.375),
        ("0.1*5", 0.5),
        ("0.1 + 0.2 - 0.3 + 2", 2.0),
        ("1/3*3 + 1", 2.0),
        ("2^-1000/2^74", f64::from_bits(1)),
        ("2^1023", 2_f64.powi(1023)),
        ("sqrt(9/4)", 1.5),
        ("t; t = 1.5", 1.5),
        ("a; a = root:3*u + 6", -2.0),
        ("a; a = root:8*u^3 + 1", -0.5),
        ("floor(pi)", 3.0),
        ("sign(-pi)*2", -2.0),
        ("T(3, 1/2)*2", -2.0),
        ("mod(-7, 4)*2", 2.0),
    ] {
        assert_eq!(constant(text, 128).f64, [value; 2], "{text}");
    }
    for (text, value) in [
        ("0.1", 0.1),
        ("1/3", 1.0 / 3.0),
        ("-0.7", -0.7),
        ("1e-3", 1e-3),
        ("1e300", 1e300),
        ("123456789.123456789", 123_456_789.123_456_79),
        ("9007199254740993", 9_007_199_254_740_992.0),
        ("pi", std::f64::consts::PI),
        ("sqrt(2)", std::f64::consts::SQRT_2),
        ("exp(1)", std::f64::consts::E),
        ("(1+sqrt(5))/2", 1.618_033_988_749_895),
        ("2^0.5", std::f64::consts::SQRT_2),
        ("a; a = root:7*u^3+7*u+1", -0.140_106_854_987_124_78),
        ("1e-400", 0.0),
    ] {
        let constant = constant(text, 128);
        let [lo, hi] = constant.f64;
        assert_eq!(hi, lo.next_up(), "{text}");
        assert_eq!(constant.nearest_f64, value, "{text}");
        let [lo, hi] = constant.f32;
        assert_eq!(hi, lo.next_up(), "{text}");
        assert!(f64::from(lo) <= value && value <= f64::from(hi), "{text}");
    }
}

/// Intervals take a constant as it is: 0.1 x is no wider than it has to be.
#[test]
fn intervals_take_the_tightest_constants() {
    let at_one = |text: &str| {
        let tape = parse(text).tape(&Parameters::default(), 128).expect("defaults are values");
        let one = Interval::<f64, Set>::point(1.0);
        tape.evaluator(&one).evaluate([one; 3]).bounds()
    };
    let [lo, hi] = at_one("x*0.1");
    assert!(lo < hi && hi <= lo.next_up().next_up().next_up() && lo <= 0.1 && 0.1 <= hi);
    let [lo, hi] = at_one("x/10 + 9/10");
    assert!(lo <= 1.0 && 1.0 <= hi && hi - lo < 1e-15);
}

/// phi from its continued fraction by integers alone: F(n+1)/F(n) alternates around it.
#[test]
fn the_golden_ratio_is_tight_at_256_bits() {
    let (mut a, mut b) = (BigInt::from(1), BigInt::from(1));
    let mut ends = Vec::new();
    for n in 0..402 {
        (a, b) = (b.clone(), a + b);
        if n >= 400 {
            ends.push(BigRational::new(b.clone(), a.clone()));
        }
    }
    let phi = constant("(1 + sqrt(5))/2", 256).big;
    assert!(phi.precision() >= 256 && phi.width() > 0.0 && phi.width() < 1e-75);
    ends.sort();
    let [low, high] = [0, 1].map(|i| enclose(&ends[i], 640));
    assert!(low.is_below(&high) && phi.contains(&low) && phi.contains(&high));
    // More bits give a narrower interval inside.
    let finer = constant("(1 + sqrt(5))/2", 512).big;
    assert!(phi.contains(&finer) && finer.width() < 1e-150);
    assert!(finer.contains(&low) && finer.contains(&high));
}

fn enclose(r: &BigRational, precision: usize) -> BigInterval {
    let whole = |n: &BigInt| BigInterval::parse_decimal(&n.to_string(), precision).expect("digits");
    whole(r.numer()) / whole(r.denom())
}

#[test]
fn roots_of_polynomials_are_bracketed() {
    let root = constant("a; a = root:7*u^3 + 7*u + 1", 256).big;
    assert!(root.width() > 0.0 && root.width() < 1e-76);
    let seven = BigInterval::from_f64(7.0, 512);
    let value = |a: BigInterval| {
        let a = a.with_precision(512);
        seven.clone() * a.clone() * a.clone() * a.clone()
            + seven.clone() * a
            + BigInterval::from_f64(1.0, 512)
    };
    // The polynomial increases.
    assert!(value(root.lower()).is_negative() && value(root.upper()).is_positive());

    for (text, value) in [
        ("root:u^3 - 2e30", 2e30_f64.cbrt()),
        ("root:u^3 + 1e-30", -1e-10),
        ("root:(3*u - 1)^2", 1.0 / 3.0),
        ("root:(u - 1/7)^3*(u^2 + 1)", 1.0 / 7.0),
        ("root:T(3, u) - 99", 3.0),
        ("root:u^5 - u + b", -1.167_303_978_261_418_7),
    ] {
        let found = constant(&format!("a; a = {text}; b = 1"), 192);
        let error = (found.nearest_f64 - value).abs();
        assert!(error <= 2e-16 * value.abs(), "{text}: {found:?}");
        assert!(found.big.width() < 1e-45 * value.abs(), "{text}: {found:?}");
    }
}

fn value(tape: &Tape) -> f64 {
    tape.evaluator(&Plain(0.0)).evaluate([0.0, 0.0, 0.0].map(Plain)).0
}

#[test]
fn given_values_replace_defaults() {
    let function = parse("x + a + 10*b; a = 2; b = a^2");
    let tape = |pairs: &[_]| function.tape(&values(pairs), 128).map(|tape| value(&tape));
    assert_eq!(tape(&[]), Ok(42.0));
    assert_eq!(tape(&[("a", "3")]), Ok(93.0));
    assert_eq!(tape(&[("b", "1/4")]), Ok(4.5));
    assert_eq!(tape(&[("a", "sqrt(2)^2*0"), ("b", "2*pi/pi")]), Ok(20.0));
    assert_eq!(tape(&[("a", "root:u^3 + 8")]), Ok(38.0));
    assert_eq!(tape(&[("a", "root:T(3, u) - 26")]), Ok(42.0));
    // A value is taken exactly.
    let tape = function.tape(&values(&[("a", "0.1"), ("b", "0")]), 128).expect("values");
    let [lo, hi] = tape.constants()[0].f64;
    assert!(lo <= 0.1 && hi == lo.next_up());
    // Exponents are as exact.
    let power = parse("x^n; n = 2");
    let op = |n: &str| power.tape(&values(&[("n", n)]), 128).expect("values").instructions()[0].op;
    assert_eq!(op("2"), Op::Sqr(0));
    assert_eq!(op("6/2"), Op::Powi(0, 3));
    assert_eq!(op("sqrt(25)"), Op::Powi(0, 5));
    assert_eq!(op("-1"), Op::Powi(0, -1));
    assert_eq!(op("1/3"), Op::Powc(0, 0));
    assert!(power.tape(&values(&[("n", "1")]), 128).expect("values").instructions().is_empty());
    assert_eq!(power.degree(), Some(2));
}

#[test]
fn values_that_are_set_can_be_read() {
    let mut set = values(&[("a", "1"), ("b", "2"), ("a", "3")]);
    assert_eq!(set.iter().collect::<Vec<_>>(), [("b", "2"), ("a", "3")]);
    assert_eq!((set.get("a"), set.get("c")), (Some("3"), None));
    set.set("c", "4");
    assert_eq!(set.get("c"), Some("4"));
}

#[test]
fn values_that_cannot_be_given() {
    let function = parse("x/radius + log(height) + x^n; radius = 2; height = 1; n = 2");
    for (name, given, message) in [
        (
            "radis",
            "1",
            "this equation has no parameter `radis`: it has radius, height, n; did you \
            mean `radius`?",
        ),
        ("q", "1", "this equation has no parameter `q`: it has radius, height, n"),
        ("radius", "", "the value `` of `radius`: there is nothing to read"),
        ("radius", "inf", "the value `inf` of `radius`: `inf` is no number"),
        ("radius", "nan", "`nan` is no number"),
        ("radius", "-infinity", "`infinity` is no number"),
        ("radius", "1/0", "the value `1/0` of `radius`: division by zero"),
        ("radius", "log(0)", "the value `log(0)` of `radius`: `log(0)` is undefined"),
        ("radius", "x", "the value `x` of `radius`: `x` varies, but a constant is expected"),
        ("radius", "height", "unknown name `height`"),
        ("radius", "2x", "no operator between `2` and `x` (write `2*x`)"),
        ("radius", "1 = 2", "unexpected `=` in a constant"),
        ("radius", "root:u^2 - 2", "has 2 real roots, not one"),
        ("radius", "0", "is undefined for radius = 0"),
        ("height", "-1", "`log(height)` is undefined for height = -1"),
        ("radius", "1e-400", "beyond the range of doubles for radius = 1e-400"),
        ("n", "5000", "has the exponent 5000: integers are limited to 1024 for n = 5000"),
    ] {
        let error = function.tape(&values(&[(name, given)]), 128).expect_err(message);
        assert!(error.message.contains(message), "{name} = {given}: {error}");
    }
    let error = parse("x").tape(&values(&[("a", "1")]), 128).expect_err("no parameter");
    assert_eq!(error.to_string(), "this equation has no parameter `a`: it has none");
}
