//! Intervals of any precision: conversions, exact cases, and each function against twice the
//! precision.

use proptest::prelude::*;
use zeroset_ia::{BigInterval, Binary, Constant, Number, Unary};

const P: usize = 128;

fn big(x: f64) -> BigInterval {
    BigInterval::from_f64(x, P)
}

fn decimal(text: &str) -> BigInterval {
    BigInterval::parse_decimal(text, P).unwrap_or_else(|| panic!("{text} is decimal"))
}

/// Doubles of every size that functions see, with special ones among them.
fn double() -> impl Strategy<Value = f64> {
    let special = vec![
        0.0,
        1.0,
        -1.0,
        0.5,
        2.0,
        3.0,
        -4.0,
        100.0,
        1e-300,
        -1e-300,
        5e-324,
        1.0 + f64::EPSILON,
        1.0 - f64::EPSILON / 2.0,
        std::f64::consts::PI,
        std::f64::consts::FRAC_PI_2,
        1e22,
        // The double nearest to a multiple of pi/2.
        6_381_956_970_095_103.0 * 2f64.powi(797),
    ];
    prop_oneof![
        2 => prop::sample::select(special),
        6 => (-1.0..1.0f64, -40..40i32).prop_map(|(m, e)| m * 2f64.powi(e)),
        1 => (-1.0..1.0f64, -1000..1000i32).prop_map(|(m, e)| m * 2f64.powi(e)),
        2 => -10.0..10.0f64,
    ]
}

/// The width relative to the size.
fn slack(x: &BigInterval) -> f64 {
    let size = x.clone().unary(Unary::Abs);
    if size.is_bounded() && size.is_positive() {
        ((x.upper() - x.lower()) / size).to_f64()[1]
    } else {
        x.width()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(3000) })]

    #[test]
    fn functions_contain_their_value_at_twice_the_precision(
        x in double(), f in prop::sample::select(Unary::ALL)
    ) {
        let coarse = big(x).unary(f);
        let fine = BigInterval::from_f64(x, 2 * P).unary(f);
        prop_assert!(coarse.contains(&fine), "{f}({x:e}): {:?} {:?}", coarse, fine);
        prop_assert_eq!(coarse.is_empty(), fine.is_empty());
        if fine.is_bounded() {
            prop_assert!(slack(&coarse) < 1e-37, "{f}({x:e}): {:e}", slack(&coarse));
        }
    }

    #[test]
    fn functions_of_two_arguments_contain_their_value_at_twice_the_precision(
        x in double(), y in double(), f in prop::sample::select(Binary::ALL)
    ) {
        let coarse = big(x).binary(f, big(y));
        let fine = BigInterval::from_f64(x, 2 * P).binary(f, BigInterval::from_f64(y, 2 * P));
        prop_assert!(coarse.contains(&fine), "{f}({x:e}, {y:e}): {:?} {:?}", coarse, fine);
        prop_assert_eq!(coarse.is_empty(), fine.is_empty());
    }

    #[test]
    fn identities_hold(x in double()) {
        let wide = |x: f64| BigInterval::from_f64(x, 2 * P);
        let meet = |x: BigInterval, y: BigInterval| !x.intersect(&y).is_empty();
        let sine = big(x).unary(Unary::Sin).sqr() + big(x).unary(Unary::Cos).sqr();
        prop_assert!(sine.contains_f64(1.0));
        if x > 0.0 {
            prop_assert!(big(x).unary(Unary::Log).unary(Unary::Exp).contains_f64(x));
            prop_assert!(big(x).unary(Unary::Sqrt).sqr().contains_f64(x));
            // acosh x = log(x + sqrt(x^2 - 1)), asinh likewise.
            let one = BigInterval::from_f64(1.0, 2 * P);
            let root = (wide(x).sqr() + one.clone()).unary(Unary::Sqrt);
            prop_assert!(meet((wide(x) + root).unary(Unary::Log), big(x).unary(Unary::Asinh)));
            if x >= 1.0 {
                let root = (wide(x).sqr() - one).unary(Unary::Sqrt);
                prop_assert!(meet((wide(x) + root).unary(Unary::Log), big(x).unary(Unary::Acosh)));
            }
        }
        prop_assert!(big(x).unary(Unary::Cbrt).powi(3).contains_f64(x));
        let tangent = big(x).unary(Unary::Atan).unary(Unary::Tan);
        prop_assert!(tangent.contains_f64(x), "{x:e} {:?}", tangent.to_f64());
        let quotient = big(x).unary(Unary::Sin) / big(x).unary(Unary::Cos);
        prop_assert!(meet(quotient, big(x).unary(Unary::Tan)));
        if x.abs() < 1000.0 {
            let sum = big(x).unary(Unary::Exp) + (-big(x)).unary(Unary::Exp);
            prop_assert!(meet(sum, big(x).unary(Unary::Cosh).scale(&Constant::integer(2))));
            let ratio = big(x).unary(Unary::Sinh) / big(x).unary(Unary::Cosh);
            prop_assert!(meet(ratio, big(x).unary(Unary::Tanh)));
        }
        if x.abs() <= 1.0 {
            prop_assert!(big(x).unary(Unary::Asin).unary(Unary::Sin).contains_f64(x));
            prop_assert!(big(x).unary(Unary::Acos).unary(Unary::Cos).contains_f64(x));
        }
    }

    #[test]
    fn doubles_survive_the_round_trip(bits in any::<u64>()) {
        let x = f64::from_bits(bits);
        if x.is_finite() {
            prop_assert_eq!(big(x).to_f64(), [x; 2]);
            prop_assert_eq!(big(x).nearest(), x);
        }
    }

    #[test]
    fn enclosures_by_doubles_are_the_tightest(x in double(), y in double()) {
        for z in [big(x) * big(y), big(x) / big(y)] {
            let [lo, hi] = z.to_f64();
            let inside = |x: f64| BigInterval::from_bounds(x, x, P);
            if z.is_bounded() && lo.is_finite() && hi.is_finite() {
                prop_assert!(BigInterval::from_bounds(lo, hi, P).contains(&z));
                prop_assert!(!inside(lo.next_up()).is_below(&z) && !z.is_below(&inside(hi.next_down())));
            }
        }
        // The hardware rounds to nearest as well.
        if (x * y).abs() < f64::MAX {
            prop_assert_eq!((big(x) * big(y)).nearest(), x * y);
        }
    }

    #[test]
    fn decimals_are_read_as_the_standard_library_reads_them(
        whole in "[0-9]{0,25}", fraction in "[0-9]{1,25}", exponent in -330..330i32
    ) {
        let text = format!("{whole}.{fraction}e{exponent}");
        let expected: f64 = text.parse().unwrap();
        prop_assert_eq!(decimal(&text).nearest(), expected, "{}", text);
        prop_assert_eq!(decimal(&format!("-{text}")).nearest(), -expected);
    }
}

#[test]
fn decimals_that_fit_are_points() {
    for (text, value) in [
        ("0.5", 0.5),
        ("2", 2.0),
        ("2.", 2.0),
        (".25", 0.25),
        ("-2.5E+10", -2.5e10),
        ("1e22", 1e22),
        ("000.000", 0.0),
        ("+0.03125000000000000000000000000000000000000000000000000000000", 0.031_25),
        ("12500e-2", 125.0),
    ] {
        assert!(decimal(text).is_point(), "{text}");
        assert_eq!(decimal(text).to_f64(), [value; 2], "{text}");
    }
    for text in ["0.1", "1e-3", "1e400", "1e-400", "1e999999999999999999999", "1e-999999999999"] {
        let x = decimal(text);
        assert!(!x.is_point() && x.is_positive() || text.len() > 6, "{text} {x:?}");
    }
    assert_eq!(decimal("1e999999999999999999999").to_f64(), [f64::MAX, f64::INFINITY]);
    assert_eq!(decimal("1e-999999999999").to_f64(), [0.0, 5e-324]);
    for text in ["", "-", ".", "e5", "1e", "1e+", "0x10", "1.2.3", "nan", "inf", "1 ", "1e5.0", "é"]
    {
        assert!(BigInterval::parse_decimal(text, P).is_none(), "{text}");
    }
}

#[test]
fn a_decimal_contains_itself_at_any_precision() {
    let coarse = BigInterval::parse_decimal("0.1", 64).expect("decimal");
    let fine = BigInterval::parse_decimal("0.1", 512).expect("decimal");
    assert!(coarse.contains(&fine) && !coarse.is_point());
    assert!(coarse.clone().scale(&Constant::integer(10)).contains_f64(1.0));
    assert_eq!(fine.with_precision(64).to_f64(), coarse.to_f64());
}

#[test]
fn division_by_zero_is_set_based() {
    let interval = |lo, hi| BigInterval::from_bounds(lo, hi, P);
    let infinity = f64::INFINITY;
    let bounds = |x: BigInterval| x.to_f64();
    assert_eq!(bounds(interval(1.0, 2.0) / interval(0.0, 1.0)), [1.0, infinity]);
    assert_eq!(bounds(interval(1.0, 2.0) / interval(-1.0, 0.0)), [-infinity, -1.0]);
    assert_eq!(bounds(interval(1.0, 2.0) / interval(-1.0, 1.0)), [-infinity, infinity]);
    assert_eq!(bounds(interval(0.0, 0.0) / interval(-1.0, 1.0)), [0.0, 0.0]);
    assert!((interval(1.0, 2.0) / interval(0.0, 0.0)).is_empty());
    assert!(interval(2.0, 1.0).is_empty() && big(f64::NAN).is_empty() && big(infinity).is_empty());
}

#[test]
fn exponents_beyond_the_limit_stay_sound() {
    let huge = big(f64::MAX).powi(i32::MAX);
    assert_eq!(huge.to_f64(), [f64::MAX, f64::INFINITY]);
    assert_eq!(big(5e-324).powi(i32::MAX).to_f64(), [0.0, 5e-324]);
    assert_eq!(big(2.0).powi(i32::MIN).to_f64(), [0.0, 5e-324]);
    assert_eq!((-huge.clone()).unary(Unary::Exp).to_f64(), [0.0, 5e-324]);
    assert_eq!(huge.clone().unary(Unary::Sin).to_f64(), [-1.0, 1.0]);
    assert_eq!(huge.unary(Unary::Tanh).to_f64(), [1.0f64.next_down(), 1.0]);
    assert_eq!(big(1e300).unary(Unary::Exp).to_f64(), [f64::MAX, f64::INFINITY]);
}

#[test]
fn pi_and_the_midpoint_are_where_they_should_be() {
    let pi = BigInterval::pi(P);
    assert_eq!(pi.nearest(), std::f64::consts::PI);
    assert!(pi.contains(&BigInterval::pi(4 * P)) && slack(&pi) < 1e-37);
    let x = BigInterval::from_bounds(1.0, 4.0, P);
    assert_eq!(x.midpoint().to_f64(), [2.5, 2.5]);
    assert_eq!(x.width(), 3.0);
    assert_eq!(BigInterval::entire(P).midpoint().to_f64(), [0.0, 0.0]);
    assert_eq!(x.hull(&big(5.0)).to_f64(), [1.0, 5.0]);
    assert_eq!(x.intersect(&BigInterval::from_bounds(3.0, 9.0, P)).to_f64(), [3.0, 4.0]);
    assert!(x.intersect(&big(5.0)).is_empty() && x.is_below(&big(5.0)));
}

#[test]
fn a_constant_has_its_tightest_enclosures() {
    let tenth = Constant::new(decimal("0.1"));
    assert_eq!(tenth.nearest_f64, 0.1);
    assert_eq!(tenth.nearest_f32, 0.1f32);
    assert_eq!(tenth.f64, [0.1f64.next_down(), 0.1]);
    assert_eq!(tenth.f32, [0.1f32.next_down(), 0.1]);
    // Just above halfway between two floats, and nearer to halfway than to the next double.
    let above = Constant::new(decimal("1.00000005960464477539062500000001"));
    assert_eq!(above.nearest_f32, 1.0 + f32::EPSILON);
    assert_eq!(Constant::integer(-7).f32, [-7.0; 2]);
    assert_eq!(Constant::integer(i32::MIN).f64, [f64::from(i32::MIN); 2]);
    assert_eq!(Constant::from_f64(1e300).f32, [f32::MAX, f32::INFINITY]);
}
