//! Integer powers of single floats.

/// The largest exponent of a chain of products; beyond, a power is a pow.
const LONGEST: u32 = 1024;

/// `x^n` for `n >= 1` by squares, over any product.
#[inline(always)]
fn chain<T: Copy>(x: T, n: u32, product: impl Fn(T, T) -> T) -> T {
    let mut square = x;
    for _ in 0..n.trailing_zeros() {
        square = product(square, square);
    }
    let mut power = square;
    let mut rest = n >> n.trailing_zeros() >> 1;
    while rest > 0 {
        square = product(square, square);
        if rest & 1 == 1 {
            power = product(power, square);
        }
        rest >>= 1;
    }
    power
}

/// `x^n` in single precision, within 0.51 units in the last place.
///
/// In double precision, at most 1024 roundings of 2^-53 each; where that overflows, or loses digits to
/// underflow, the float does all the more.
#[inline]
pub(crate) fn power_f32(x: f32, n: i32) -> f32 {
    let x = f64::from(x);
    if n.unsigned_abs() > LONGEST {
        return metallic::pow(x, f64::from(n)) as f32;
    }
    let power = if n == 0 { 1.0 } else { chain(x, n.unsigned_abs(), |a, b| a * b) };
    (if n < 0 { 1.0 / power } else { power }) as f32
}

/// A double-double: the unevaluated sum of a double and a much smaller one.
type Sum = [f64; 2];

/// `x^n` in double precision, within one unit in the last place.
///
/// As a double-double, each product of which errs by less than 2^-100 of its value, if neither the
/// power nor any rounding error of a product leaves the normal range.
#[inline]
pub(crate) fn power_f64(x: f64, n: i32) -> f64 {
    // 2^-900 leaves room for the errors of products, 2^-106 of them; 2^1000 for one more product.
    const SAFE: std::ops::Range<f64> = f64::from_bits(123 << 52)..f64::from_bits(2023 << 52);
    let is_safe = |x: f64| SAFE.contains(&x.abs());
    if n != 0 && n.unsigned_abs() <= LONGEST && is_safe(x) {
        let power = chain([x, 0.0], n.unsigned_abs(), product);
        if is_safe(power[0]) {
            return if n < 0 { reciprocal(power) } else { power[0] };
        }
    }
    metallic::pow(x, f64::from(n))
}

/// The product of two double-doubles; the first part is its nearest double.
#[inline(always)]
fn product(a: Sum, b: Sum) -> Sum {
    let high = a[0] * b[0];
    let error = a[0].mul_add(b[0], -high);
    let low = error + (a[0] * b[1] + a[1] * b[0]);
    let sum = high + low;
    [sum, low - (sum - high)]
}

/// The double nearest to the reciprocal of a double-double, but for 2^-100 of it.
#[inline(always)]
fn reciprocal(a: Sum) -> f64 {
    let quotient = 1.0 / a[0];
    let rest = (-quotient).mul_add(a[0], 1.0) - quotient * a[1];
    quotient + quotient * rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BigInterval, Number};

    const EXPONENTS: [i32; 16] = [1, 2, 3, 4, 5, 7, 8, 13, 100, 1023, 1025, -1, -2, -3, -9, -1024];

    /// The distance of y from x^n in gaps between floats near y.
    fn error(x: f64, n: i32, y: f64, gap: f64) -> f64 {
        let exact = BigInterval::from_f64(x, 256).powi(n);
        let [lo, hi] = (exact - BigInterval::from_f64(y, 256)).to_f64();
        lo.abs().max(hi.abs()) / gap
    }

    /// Numbers of many sizes, and those just beside 1.
    fn numbers() -> impl Iterator<Item = f64> {
        let sizes = (-75..75).map(|i| {
            let i = 4.0 * f64::from(i);
            (i * 0.37).exp2() * (1.0 + (i * 0.618).fract().abs())
        });
        let beside_one = (1..60).map(|i| 1.0 + f64::from(i * i * 9 - 9000) * 2.0_f64.powi(-24));
        sizes.chain(beside_one).flat_map(|x| [x, -x])
    }

    #[test]
    fn single_powers_are_within_their_bound() {
        let mut seen = 0;
        for x in numbers().map(|x| x as f32) {
            for n in EXPONENTS {
                let y = power_f32(x, n);
                if y.abs() >= f32::MIN_POSITIVE && y.abs() < f32::MAX {
                    let gap = f64::from(y.abs() - y.abs().next_down());
                    let e = error(f64::from(x), n, f64::from(y), gap);
                    assert!(e < 1.02, "{x:e}^{n} = {y:e}, wrong by {e} of the smaller gap");
                    seen += 1;
                }
            }
        }
        assert!(seen > 1000, "{seen}");
    }

    #[test]
    fn double_powers_are_within_their_bound() {
        let mut seen = 0;
        for x in numbers() {
            for n in EXPONENTS {
                let y = power_f64(x, n);
                if y.abs() >= f64::MIN_POSITIVE && y.abs() < f64::MAX {
                    let e = error(x, n, y, y.abs().next_up() - y.abs());
                    assert!(e < 0.500001, "{x:e}^{n} = {y:e}, wrong by {e} units");
                    seen += 1;
                }
            }
        }
        assert!(seen > 2500, "{seen}");
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!([power_f32(3.0, 0), power_f32(-2.0, 3), power_f32(-2.0, -2)], [1.0, -8.0, 0.25]);
        assert_eq!([power_f64(3.0, 0), power_f64(-2.0, 3), power_f64(-2.0, -2)], [1.0, -8.0, 0.25]);
        assert_eq!([power_f32(f32::MAX, 2), power_f32(f32::MAX, -2)], [f32::INFINITY, 0.0]);
        assert_eq!([power_f64(f64::MAX, 3), power_f64(-f64::MAX, -3)], [f64::INFINITY, 0.0]);
        assert_eq!([power_f64(1e-200, 2), power_f64(1e-200, -2)], [0.0, f64::INFINITY]);
        assert_eq!(power_f64(2.0, -1074), 5e-324);
        assert_eq!(power_f32(-1.0, i32::MIN), 1.0);
        assert_eq!(power_f64(-1.0, i32::MAX), -1.0);
        assert!(power_f32(f32::NAN, 3).is_nan() && power_f64(f64::NAN, 3).is_nan());
    }
}
