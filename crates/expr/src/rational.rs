//! Exact rational numbers: literals, arithmetic that folds, and their enclosures.

use num_bigint::{BigInt, Sign};
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};
use zeroset_ia::{BigInterval, Binary, Unary};

use crate::graph::Node;

pub(crate) type Rational = BigRational;

/// Numerators and denominators longer than this are not folded.
const MAX_BITS: u64 = 2048;

/// The largest absolute value of an integer exponent.
pub(crate) const MAX_EXPONENT: u32 = 1024;

/// An integer as a rational.
pub(crate) fn integer(n: impl Into<BigInt>) -> Rational {
    Rational::from_integer(n.into())
}

/// The number, unless it is too long.
fn limited(r: Rational) -> Option<Rational> {
    (r.numer().bits().max(r.denom().bits()) <= MAX_BITS).then_some(r)
}

/// The value of a decimal such as `12`, `0.5`, `.5` or `1.5e-3`; none if it is too long.
pub(crate) fn decimal(text: &str) -> Option<Rational> {
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let exponent: i64 = exponent.parse().ok()?;
    let scale = exponent.checked_sub(i64::try_from(fraction.len()).ok()?)?;
    if whole.len() + fraction.len() > 2000 || scale.abs() > 2000 {
        return None;
    }
    let digits: BigInt = format!("0{whole}{fraction}").parse().ok()?;
    let power = BigInt::from(10).pow(u32::try_from(scale.abs()).ok()?);
    limited(if scale < 0 {
        Rational::new(digits, power)
    } else {
        Rational::from_integer(digits * power)
    })
}

/// Text that reads as the number: an integer, a short decimal, or a quotient.
pub(crate) fn text(r: &Rational) -> String {
    let (mut rest, mut twos, mut fives) = (r.denom().clone(), 0, 0);
    for (factor, count) in [(2_u8, &mut twos), (5, &mut fives)] {
        while *count <= 20 && (&rest % BigInt::from(factor)).is_zero() {
            rest /= factor;
            *count += 1;
        }
    }
    let places: usize = twos.max(fives);
    if !rest.is_one() || places > 20 {
        return format!("{}/{}", r.numer(), r.denom());
    }
    let scaled = (r * integer(BigInt::from(10).pow(places as u32))).to_integer();
    let digits = format!("{:0>width$}", scaled.abs().to_string(), width = places + 1);
    let (whole, fraction) = digits.split_at(digits.len() - places);
    let sign = if r.is_negative() { "-" } else { "" };
    let point = if places > 0 { "." } else { "" };
    format!("{sign}{whole}{point}{fraction}")
}

/// The integer, if it is one that fits.
pub(crate) fn to_integer(r: &Rational) -> Option<i64> {
    r.is_integer().then(|| r.numer().to_i64()).flatten()
}

/// `r^n`, unless it is undefined or too long.
pub(crate) fn power(r: &Rational, n: i64) -> Option<Rational> {
    let n = i32::try_from(n).ok()?;
    if n < 0 && r.is_zero() {
        return None;
    }
    let bits = r.numer().bits().max(r.denom().bits()).saturating_sub(1);
    let fits = bits.saturating_mul(n.unsigned_abs().into()) <= MAX_BITS;
    fits.then(|| r.pow(n)).and_then(limited)
}

/// The exact value of an operation on rational operands, if it is rational for sure and short.
pub(crate) fn evaluate(node: &Node, operands: [Option<&Rational>; 2]) -> Option<Rational> {
    let a = operands[0]?;
    let result = match (node, operands[1]) {
        (Node::Neg(_), _) => -a,
        (Node::Unary(f, _), _) => match f {
            Unary::Abs => a.abs(),
            Unary::Sign => a.signum(),
            Unary::Floor => a.floor(),
            Unary::Ceil => a.ceil(),
            _ => return None,
        },
        (Node::Add(..), Some(b)) => a + b,
        (Node::Sub(..), Some(b)) => a - b,
        (Node::Mul(..), Some(b)) => a * b,
        (Node::Div(..), Some(b)) if !b.is_zero() => a / b,
        (Node::Power(..), Some(b)) => power(a, to_integer(b)?)?,
        (Node::Binary(Binary::Min, ..), Some(b)) => a.min(b).clone(),
        (Node::Binary(Binary::Max, ..), Some(b)) => a.max(b).clone(),
        (Node::Binary(Binary::Mod, ..), Some(b)) if !b.is_zero() => a - b * (a / b).floor(),
        _ => return None,
    };
    limited(result)
}

/// The tightest interval around the number, with a significand of so many bits.
pub(crate) fn enclose(r: &Rational, precision: usize) -> BigInterval {
    let whole = |n: &BigInt| {
        let exact = precision.max(n.bits() as usize);
        let digit = |d: u32| BigInterval::from_f64(d.into(), exact);
        let base = BigInterval::from_f64(4_294_967_296.0, exact);
        let (sign, digits) = n.to_u32_digits();
        let sum = digits.into_iter().rev().fold(digit(0), |sum, d| sum * base.clone() + digit(d));
        (if sign == Sign::Minus { -sum } else { sum }).with_precision(precision)
    };
    if r.is_integer() { whole(r.numer()) } else { whole(r.numer()) / whole(r.denom()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_read_back() {
        for (written, read) in [
            ("12", "12"),
            ("0.50", "0.5"),
            (".125", "0.125"),
            ("5.", "5"),
            ("1.5e-3", "0.0015"),
            ("1E3", "1000"),
            ("0", "0"),
        ] {
            let r = decimal(written).unwrap();
            assert_eq!(text(&r), read);
            assert_eq!(decimal(read).unwrap(), r);
        }
        assert_eq!(text(&-decimal("0.05").unwrap()), "-0.05");
        assert_eq!(text(&Rational::new(2.into(), (-6).into())), "-1/3");
        assert_eq!(text(&decimal("1e-30").unwrap()), format!("1/1{}", "0".repeat(30)));
    }

    #[test]
    fn long_numbers_are_refused() {
        assert_eq!(decimal("1e99999999999999999999"), None);
        assert_eq!(decimal(&"9".repeat(3000)), None);
        assert_eq!(power(&integer(3), 1 << 40), None);
        assert_eq!(power(&integer(0), -1), None);
        assert_eq!(power(&integer(-1), 1_000_001), Some(integer(-1)));
    }
}
