//! To and from doubles and decimal text.

use astro_float::{BigFloat, Sign};

use super::{BigInterval, Toward, integer, whole_words};
use crate::Number;

impl BigInterval {
    /// The exact value of a finite double; empty for NaN and infinities, which are no numbers.
    pub fn from_f64(x: f64, precision: usize) -> Self {
        Self::from_bounds(x, x, precision)
    }

    /// The numbers between two doubles, of which the ends may be infinite; empty if there are none.
    pub fn from_bounds(lo: f64, hi: f64, precision: usize) -> Self {
        let precision = whole_words(precision);
        if !(lo <= hi) || lo == f64::INFINITY || hi == f64::NEG_INFINITY {
            return Self::empty(precision);
        }
        Self::new(from_double(lo), from_double(hi), precision)
    }

    /// An enclosure of a decimal number such as `3`, `0.1`, `1e-3` or `-2.5E+10`, a point if the
    /// precision can hold it; none if the text is not of that form.
    pub fn parse_decimal(text: &str, precision: usize) -> Option<Self> {
        let precision = whole_words(precision);
        let (negative, text) = match text.as_bytes().first()? {
            b'-' => (true, &text[1..]),
            b'+' => (false, &text[1..]),
            _ => (false, text),
        };
        let (mantissa, exponent) = match text.find(['e', 'E']) {
            Some(at) => (&text[..at], parse_exponent(&text[at + 1..])?),
            None => (text, 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        if whole.is_empty() && fraction.is_empty()
            || !(whole.bytes().chain(fraction.bytes())).all(|b| b.is_ascii_digit())
        {
            return None;
        }
        let digits = format!("{whole}{fraction}");
        let significant = digits.trim_end_matches('0');
        if significant.is_empty() {
            return Some(Self::from_f64(0.0, precision));
        }
        let scale = (digits.len() - significant.len()) as i64 - fraction.len() as i64;
        let tens = exponent.saturating_add(scale);

        // Exact in four bits a digit, as is the power of ten wherever the quotient is.
        let working = whole_words(precision.max(4 * digits.len()) + 64);
        let mut value = Self::from_f64(0.0, working);
        for chunk in significant.trim_start_matches('0').as_bytes().chunks(15) {
            let chunk_value = chunk.iter().fold(0, |n, b| 10 * n + i64::from(b - b'0'));
            let shift = Self::point(integer(10_i64.pow(chunk.len() as u32)), working);
            value = value * shift + Self::point(integer(chunk_value), working);
        }
        // Beyond the limit the power overflows, which stays an enclosure.
        const MOST_TENS: i64 = 100_000_000;
        let ten = Self::point(integer(10), working);
        let power = ten.powi(tens.unsigned_abs().min(MOST_TENS as u64) as i32);
        let value = if tens < 0 { value / power } else { value * power };
        let value = if negative { -value } else { value };
        Some(value.with_precision(precision))
    }

    /// The tightest enclosure by doubles; NaN if empty.
    pub fn to_f64(&self) -> [f64; 2] {
        if self.is_empty() {
            return [f64::NAN; 2];
        }
        [to_double(&self.lo, Toward::Down), to_double(&self.hi, Toward::Up)]
    }

    /// The double nearest to the midpoint, ties to even; NaN if empty.
    pub fn nearest(&self) -> f64 {
        let midpoint = self.midpoint();
        let [lo, hi] = midpoint.to_f64();
        if !(lo < hi) {
            return lo;
        }
        // Halfway, exactly; beyond the largest double as if there were one more binade.
        let end = |x: f64| {
            if x.is_finite() {
                Self::from_f64(x, 64)
            } else {
                Self::from_f64(x.signum(), 64).scale_exponent(1024)
            }
        };
        let halfway = (end(lo) + end(hi)).scale_exponent(-1);
        if midpoint.is_below(&halfway) {
            lo
        } else if halfway.is_below(&midpoint) || hi.to_bits().is_multiple_of(2) {
            hi
        } else {
            lo
        }
    }

    /// A product with a power of 2, exactly.
    fn scale_exponent(mut self, power: i32) -> Self {
        for x in [&mut self.lo, &mut self.hi] {
            if let (false, Some(e)) = (x.is_zero(), x.exponent()) {
                x.set_exponent(e + power);
            }
        }
        self
    }
}

/// The exponent of a decimal number; one of too many digits saturates.
fn parse_exponent(text: &str) -> Option<i64> {
    let (negative, digits) = match text.as_bytes().first()? {
        b'-' => (true, &text[1..]),
        b'+' => (false, &text[1..]),
        _ => (false, text),
    };
    if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    let magnitude = digits.parse().unwrap_or(i64::MAX);
    Some(if negative { -magnitude } else { magnitude })
}

/// The exact value of a double that is not NaN.
pub(super) fn from_double(x: f64) -> BigFloat {
    // The library halves subnormal numbers.
    const SCALE: i32 = 64;
    if x == 0.0 || x.abs() >= f64::MIN_POSITIVE {
        return BigFloat::from_f64(x, 64);
    }
    let mut y = BigFloat::from_f64(x * power_of_two(SCALE), 64);
    let exponent = y.exponent().expect("a finite number");
    y.set_exponent(exponent - SCALE);
    y
}

/// The nearest double on that side.
fn to_double(x: &BigFloat, toward: Toward) -> f64 {
    let Some((words, _, sign, exponent, _)) = x.as_raw_parts() else {
        return if x.is_positive() { f64::INFINITY } else { f64::NEG_INFINITY };
    };
    if x.is_zero() {
        return 0.0;
    }
    // |x| = 0.significand * 2^exponent, of which the leading word has the top bit set.
    let (&top, rest) = words.split_last().expect("a number has a word");
    let kept = 53.min(exponent.saturating_add(1074));
    let (truncated, inexact) = if exponent > 1024 {
        (f64::MAX, true)
    } else if kept <= 0 {
        (0.0, true)
    } else {
        let significand = (top >> (64 - kept)) as f64;
        let inexact = top << kept != 0 || rest.iter().any(|&word| word != 0);
        (significand * power_of_two(exponent - kept), inexact)
    };
    let magnitude = if inexact && toward.grows(sign) { truncated.next_up() } else { truncated };
    if sign == Sign::Pos { magnitude } else { -magnitude }
}

/// `2^n` for `-1074 <= n <= 1023`.
fn power_of_two(n: i32) -> f64 {
    if n < -1022 {
        f64::from_bits(1 << (n + 1074))
    } else {
        f64::from_bits(((n + 1023) as u64) << 52)
    }
}
