//! Reals of devices that promise little, and functions from their marked operations alone.
//!
//! A shading language lets `+ - *` give either neighbour of the exact value, division and square root
//! a few units in the last place more, lets subnormal numbers vanish at any time, and its exp and sin
//! are wrong by hundreds of units. A [`Portable`] real is such a machine: its marks step as far as the
//! language allows an error to be, never to a subnormal number, and functions are computed here, from
//! series whose rest is enclosed. So the bounds hold on every device. The [`Mirror`] does on the CPU
//! what a device does that rounds to nearest, bit for bit.
//!
//! Preconditions of all bounds: those of [`Raw`](crate::Raw) intervals, sub-values within 2^100, and no
//! subnormal operand.

use std::array;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::real::{forward, forward_operators};
use crate::{Binary, Constant, Interval, Number, Packet, Real, Scalar, Unary};

/// By how many units in the last place a device's division may be wrong: 2.5 by the language.
pub const DIVISION_STEPS: u32 = 4;
/// The same for square roots: those of `1 / inverseSqrt(x)`, 2 and 2.5 units.
pub const ROOT_STEPS: u32 = 8;

/// A real of single precision on which functions can be computed without looking into lanes.
pub trait Portable: Real<Scalar = f32> {
    /// 2^k for an integer k in [-126, 126]: exact.
    fn exp2_integer(self) -> Self;
    /// The integer e with 2^e <= self < 2^(e+1), for a normal positive `self`: exact.
    fn exponent(self) -> Self;
}

/// Is there a function of this name for [`Portable`] reals, besides those of every real?
pub fn has_unary(f: Unary) -> bool {
    use Unary::*;
    !matches!(f, Tan | Asin | Acos | Atan | Asinh | Acosh | Atanh)
}

/// Is there a function of this name for [`Portable`] reals?
pub fn has_binary(f: Binary) -> bool {
    matches!(f, Binary::Min | Binary::Max | Binary::Hypot | Binary::Pow)
}

type I<R> = Interval<R>;

/// 2^100: no sub-value is larger.
const LARGEST: f32 = f32::from_bits((127 + 100) << 23);
/// e^x is at most e^-80 below this; its lower bound is 0.
const LEAST_EXPONENT: f32 = -80.0;
/// Angles up to here are reduced; beyond, sine and cosine are anything in [-1, 1].
const LARGEST_ANGLE: f32 = 8192.0;

/// A literal.
#[inline(always)]
fn lit<R: Portable>(x: R, c: f64) -> R {
    x.splat(c as f32)
}

/// The enclosure of a number that is known to double precision.
#[inline(always)]
fn near<R: Portable>(x: R, c: f64) -> I<R> {
    let [lo, hi] = f32::enclose_range(c.next_down(), c.next_up());
    I::new(x.splat(lo), x.splat(hi))
}

/// The enclosure of an interval of literals.
#[inline(always)]
fn between<R: Portable>(x: R, lo: f64, hi: f64) -> I<R> {
    // 0 is exact, and no literal is subnormal.
    let lo = if lo == 0.0 { lo } else { lo.next_down() };
    let hi = if hi == 0.0 { hi } else { hi.next_up() };
    let [lo, hi] = f32::enclose_range(lo, hi);
    I::new(x.splat(lo), x.splat(hi))
}

/// c_0 + u (c_1 + u (... + u last)).
#[inline(always)]
fn horner<R: Portable, const N: usize>(u: I<R>, c: [f64; N], last: I<R>) -> I<R> {
    let mut sum = last;
    for c in c.into_iter().rev() {
        sum = sum * u + near(u.lo, c);
    }
    sum
}

/// e^x at a point, x in [-80, 80].
///
/// x = k log 2 + r with |r| <= 0.35, whatever k is exactly. The series of e^r to r^8; the rest after r^7
/// is r^8/8! e^s with s between 0 and r.
#[inline(always)]
fn exp_at<R: Portable>(x: R) -> I<R> {
    const TERMS: [f64; 8] =
        [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0, 1.0 / 5040.0];
    let k = (x * lit(x, std::f64::consts::LOG2_E) + lit(x, 0.5)).floor();
    // The first part has 12 bits and k has 7: their product is exact.
    const HIGH: f64 = 0.693_115_234_375;
    const LOW: f64 = 3.194_618_494_530_942e-5;
    let r = I::point(x) - I::point(k * lit(x, HIGH));
    let r = r - I::point(k) * near(x, LOW);
    let series = horner(r, TERMS, between(x, 0.69 / 40320.0, 1.45 / 40320.0));
    series * I::point(k.exp2_integer())
}

/// e^x.
#[inline(always)]
fn exp<R: Portable>(x: I<R>) -> I<R> {
    let least = lit(x.lo, LEAST_EXPONENT.into());
    let most = -least;
    let lo = exp_at(x.lo.max(least).min(most)).lo;
    let hi = exp_at(x.hi.max(least).min(most)).hi;
    I::new(x.lo.select_lt(least, lit(x.lo, 0.0), lo.max(lit(x.lo, 0.0))), hi)
}

/// log x at a point, for a normal x.
///
/// x = 2^e m with m in [0.7, 1.42]; log m = 2 s (1 + s^2/3 + s^4/5 + ...) with s = (m - 1) / (m + 1),
/// |s| <= 0.172: the rest after s^10/11 is below 1.04 s^12/13.
#[inline(always)]
fn log_at<R: Portable>(x: R) -> I<R> {
    const TERMS: [f64; 6] = [1.0, 1.0 / 3.0, 1.0 / 5.0, 1.0 / 7.0, 1.0 / 9.0, 1.0 / 11.0];
    let one = lit(x, 1.0);
    let e = x.exponent();
    let m = x * (-e).exp2_integer();
    let split = lit(x, std::f64::consts::SQRT_2);
    let e = m.select_lt(split, e, e + one);
    let m = m.select_lt(split, m, m * lit(x, 0.5));
    // Exact: m is within a factor of 2 of 1.
    let s = I::point(m - one) / (I::point(m) + I::point(one));
    let series = horner(s.sqr(), TERMS, between(x, 1.0 / 13.0, 1.04 / 13.0));
    I::point(e) * near(x, std::f64::consts::LN_2) + s * series * I::point(lit(x, 2.0))
}

/// log x, x above 0. Below the least normal number, where it is not known, down to -2^100.
#[inline(always)]
fn log<R: Portable>(x: I<R>) -> I<R> {
    let least = lit(x.lo, f32::MIN_POSITIVE.into());
    let lo = log_at(x.lo.max(least)).lo;
    let hi = log_at(x.hi.max(least)).hi;
    I::new(x.lo.select_lt(least, lit(x.lo, (-LARGEST).into()), lo), hi)
}

/// x^y over x >= 0: 0 at 0.
#[inline(always)]
fn power<R: Portable>(x: I<R>, y: I<R>) -> I<R> {
    let zero = lit(x.lo, 0.0);
    let least = lit(x.lo, f32::MIN_POSITIVE.into());
    let normal = I::new(x.lo.max(least), x.hi.max(least));
    let logarithm = I::new(log_at(normal.lo).lo, log_at(normal.hi).hi);
    let power = exp(y * logarithm);
    // Below the least normal number the power lies beyond that number's: towards 0, or upward where the
    // exponent may be negative.
    let beyond = y.lo.select_lt(zero, lit(x.lo, LARGEST.into()), power.hi);
    I::new(x.lo.select_lt(least, zero, power.lo), x.lo.select_lt(least, beyond, power.hi))
}

/// Sine and cosine at a point, |x| <= 8192.
///
/// x = k pi/2 + r with |r| <= 0.79, whatever k is exactly; the series of both, whose rests lie between 0
/// and the first term left out.
#[inline(always)]
fn sine_cosine_at<R: Portable>(x: R) -> [I<R>; 2] {
    const SINE: [f64; 5] = [1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0];
    const COSINE: [f64; 6] =
        [1.0, -0.5, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40320.0, -1.0 / 3_628_800.0];
    // pi/2 in parts of 11 bits, whose products with k (13 bits) are exact, and the rest.
    const PARTS: [f64; 2] = [1.570_312_5, 4.837_512_969_970_703e-4];
    const REST: f64 = 7.549_789_954_891_882e-8;
    let k = (x * lit(x, std::f64::consts::FRAC_2_PI) + lit(x, 0.5)).floor();
    let r = I::point(x) - I::point(k * lit(x, PARTS[0])) - I::point(k * lit(x, PARTS[1]));
    let r = r - I::point(k) * near(x, REST);
    let u = r.sqr();
    let sine = r * horner(u, SINE, between(x, -1.0 / 39_916_800.0, 0.0));
    let cosine = horner(u, COSINE, between(x, 0.0, 1.0 / 479_001_600.0));
    // The quadrant, 0 to 3: exact.
    let four = lit(x, 4.0);
    let quadrant = k - four * (k * lit(x, 0.25)).floor();
    [turned(quadrant, sine, cosine), turned(quadrant, cosine, -sine)]
}

/// The first of two waves that are a quarter turn apart, after that many quarter turns.
#[inline(always)]
fn turned<R: Portable>(quadrant: R, wave: I<R>, next: I<R>) -> I<R> {
    let pick = |limit: f64, x: I<R>, y: I<R>| {
        let limit = lit(quadrant, limit);
        I::new(quadrant.select_lt(limit, x.lo, y.lo), quadrant.select_lt(limit, x.hi, y.hi))
    };
    pick(0.5, wave, pick(1.5, next, pick(2.5, -wave, -next)))
}

/// The range of a wave with crests at `crest + 4 k` quarter turns, from its enclosures at the ends.
#[inline(always)]
fn wave<R: Portable>(x: I<R>, a: I<R>, b: I<R>, crest: f64) -> I<R> {
    let (zero, one) = (lit(x.lo, 0.0), lit(x.lo, 1.0));
    let turns = x * near(x.lo, std::f64::consts::FRAC_2_PI);
    // Is an integer multiple of 4 quarter turns, and `place` more, within?
    let passes = |place: f64, yes: R, no: R| {
        let quarter = I::point(lit(x.lo, 0.25));
        let from_here = (turns - I::point(lit(x.lo, place))) * quarter;
        let [first, last] = [from_here.lo.ceil(), from_here.hi.floor()];
        last.select_lt(first, no, yes)
    };
    let lo = passes(crest + 2.0, -one, a.lo.min(b.lo).max(-one));
    let hi = passes(crest, one, a.hi.max(b.hi).min(one));
    // Too large an angle, at either end.
    let limit = lit(x.lo, LARGEST_ANGLE.into());
    let size = (-x.lo).max(x.hi).max(zero);
    I::new(size.select_lt(limit, lo, -one), size.select_lt(limit, hi, one))
}

#[inline(always)]
fn angle<R: Portable>(x: R) -> R {
    let limit = lit(x, LARGEST_ANGLE.into());
    x.max(-limit).min(limit)
}

#[inline(always)]
fn sine<R: Portable>(x: I<R>) -> I<R> {
    let [a, b] = [x.lo, x.hi].map(|x| sine_cosine_at(angle(x))[0]);
    wave(x, a, b, 1.0)
}

#[inline(always)]
fn cosine<R: Portable>(x: I<R>) -> I<R> {
    let [a, b] = [x.lo, x.hi].map(|x| sine_cosine_at(angle(x))[1]);
    wave(x, a, b, 0.0)
}

/// Of an increasing function: from its enclosures at the ends.
#[inline(always)]
fn increasing<R: Portable>(x: I<R>, f: impl Fn(I<R>) -> I<R>) -> I<R> {
    I::new(f(I::point(x.lo)).lo, f(I::point(x.hi)).hi)
}

#[inline(always)]
fn sign<R: Portable>(x: R) -> R {
    let (zero, one) = (lit(x, 0.0), lit(x, 1.0));
    x.select_lt(zero, -one, zero.select_lt(x, one, zero))
}

/// The range of a function of one argument, with preconditions as the module has them; sqrt, abs, floor
/// and ceil are the interval's own.
///
/// # Panics
/// If [`has_unary`] says that there is none.
pub fn unary_range<R: Portable>(f: Unary, [lo, hi]: [R; 2]) -> [R; 2] {
    let x = I::new(lo, hi);
    let one = I::point(lit(lo, 1.0));
    let two = I::point(lit(lo, 2.0));
    let half = I::point(lit(lo, 0.5));
    let y = match f {
        Unary::Sqrt | Unary::Abs | Unary::Floor | Unary::Ceil => x.unary(f),
        Unary::Sign => I::new(sign(lo), sign(hi)),
        Unary::Exp => exp(x),
        Unary::Exp2 => exp(x * near(lo, std::f64::consts::LN_2)),
        Unary::Exp10 => exp(x * near(lo, std::f64::consts::LN_10)),
        Unary::Expm1 => exp(x) - one,
        Unary::Log => log(x),
        Unary::Log2 => log(x) * near(lo, std::f64::consts::LOG2_E),
        Unary::Log10 => log(x) * near(lo, std::f64::consts::LOG10_E),
        Unary::Logp1 => log(x + one),
        Unary::Sin => sine(x),
        Unary::Cos => cosine(x),
        Unary::Sinh => increasing(x, |x| (exp(x) - exp(-x)) * half),
        Unary::Cosh => {
            let size = x.unary(Unary::Abs);
            increasing(size, |x| (exp(x) + exp(-x)) * half)
        }
        Unary::Tanh => increasing(x, |x| one - two / (exp(x * two) + one)),
        Unary::Cbrt => increasing(x, |x| {
            let third = near(lo, 1.0 / 3.0);
            let root = power(x.unary(Unary::Abs), third);
            I::new(lit(lo, 0.0), lit(lo, 0.0)) + root * I::point(sign(x.lo))
        }),
        Unary::Tan
        | Unary::Asin
        | Unary::Acos
        | Unary::Atan
        | Unary::Asinh
        | Unary::Acosh
        | Unary::Atanh => panic!("{f} has no portable form"),
    };
    y.bounds()
}

/// The range of a function of two arguments.
///
/// # Panics
/// If [`has_binary`] says that there is none.
pub fn binary_range<R: Portable>(f: Binary, x: [R; 2], y: [R; 2]) -> [R; 2] {
    let (x, y) = (I::new(x[0], x[1]), I::new(y[0], y[1]));
    let z = match f {
        Binary::Min | Binary::Max => x.binary(f, y),
        Binary::Hypot => (x.sqr() + y.sqr()).unary(Unary::Sqrt),
        Binary::Pow => power(x, y),
        Binary::Mod | Binary::Atan2 => panic!("{f} has no portable form"),
    };
    z.bounds()
}

/// The enclosure of a constant without subnormal ends.
pub fn enclosure(c: &Constant) -> [f32; 2] {
    let [lo, hi] = c.f32;
    let least = f32::MIN_POSITIVE;
    let lo = if lo == 0.0 || lo.is_normal() {
        lo
    } else if lo > 0.0 {
        0.0
    } else {
        -least
    };
    let hi = if hi == 0.0 || hi.is_normal() {
        hi
    } else if hi < 0.0 {
        0.0
    } else {
        least
    };
    [lo, hi]
}

/// The least normal number's bits.
const LEAST: u32 = 0x0080_0000;

/// At least `steps` floats below `x`, whatever a subnormal `x` was flushed from.
#[inline(always)]
pub fn step_down(x: f32, steps: u32) -> f32 {
    let bits = x.to_bits();
    let (magnitude, negative) = (bits & 0x7fff_ffff, bits >> 31);
    if magnitude < LEAST + if negative == 1 { 0 } else { steps } {
        -f32::from_bits(LEAST + steps)
    } else if negative == 1 {
        f32::from_bits(bits + steps)
    } else {
        f32::from_bits(bits - steps)
    }
}

/// A device's `f32`, on the CPU.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror(pub f32);

forward_operators!([] Mirror, |a, b| Mirror(a.0 + b.0), Mirror(a.0 - b.0), Mirror(a.0 * b.0),
    Mirror(a.0 / b.0), |c| Mirror(-c.0));

impl Real for Mirror {
    type Scalar = f32;
    const OUTWARD: bool = true;

    fn splat(self, c: f32) -> Self {
        Self(c)
    }
    forward! { sqrt(); abs(); floor(); min(o); max(o); }
    fn select_lt(self, other: Self, x: Self, y: Self) -> Self {
        if self.0 < other.0 { x } else { y }
    }
    fn down(self) -> Self {
        Self(step_down(self.0, 1))
    }
    fn up(self) -> Self {
        -(-self).down()
    }
    fn div_down(self, o: Self) -> Self {
        Self(step_down(self.0 / o.0, DIVISION_STEPS))
    }
    fn div_up(self, o: Self) -> Self {
        -(-self).div_down(o)
    }
    fn sqrt_down(self) -> Self {
        Self(step_down(self.0.sqrt(), ROOT_STEPS))
    }
    fn sqrt_up(self) -> Self {
        Self(-step_down(-self.0.sqrt(), ROOT_STEPS))
    }
    fn map<const N: usize, const M: usize>(
        x: [Self; N],
        f: impl Fn([f32; N]) -> [f32; M],
    ) -> [Self; M] {
        let y = f(x.map(|x| x.0));
        array::from_fn(|i| Self(y[i]))
    }
    fn unary_range(f: Unary, x: [Self; 2]) -> [Self; 2] {
        unary_range(f, x)
    }
    fn binary_range(f: Binary, x: [Self; 2], y: [Self; 2]) -> [Self; 2] {
        binary_range(f, x, y)
    }
    fn power_range(x: [Self; 2], c: &Constant) -> [Self; 2] {
        binary_range(Binary::Pow, x, enclosure(c).map(Self))
    }
}

impl Packet for Mirror {
    const LANES: usize = 1;

    fn from_fn(self, mut f: impl FnMut(usize) -> f32) -> Self {
        Self(f(0))
    }
    fn lane(self, _: usize) -> f32 {
        self.0
    }
    fn lt(self, other: Self) -> u64 {
        u64::from(self.0 < other.0)
    }
    fn le(self, other: Self) -> u64 {
        u64::from(self.0 <= other.0)
    }
    fn select(self, mask: u64, x: Self, y: Self) -> Self {
        if mask & 1 == 1 { x } else { y }
    }
    fn region<T>(self, work: impl FnOnce() -> T) -> T {
        work()
    }
}

impl Portable for Mirror {
    fn exp2_integer(self) -> Self {
        Self(f32::from_bits(((self.0 as i32 + 127) as u32) << 23))
    }
    fn exponent(self) -> Self {
        Self(((self.0.to_bits() >> 23) as i32 - 127) as f32)
    }
}
