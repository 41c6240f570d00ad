//! Ranges of functions over intervals of scalars, set-based as in IEEE 1788.
//!
//! Ends are rounded outward by [`Scalar::elementary_down`] and [`Scalar::elementary_up`], and cut
//! with what is known without rounding: exponentials are not negative, sines lie in `[-1, 1]`. Every
//! step increases with its argument, so a smaller interval never has a larger range.

use std::f64::consts::{FRAC_2_PI, PI};

use crate::single::floor;
use crate::{Binary, Scalar, Unary};

/// Do the ends of a domain belong to it?
#[derive(Clone, Copy, PartialEq)]
enum Ends {
    Closed,
    Open,
}

/// Where a function of one argument is defined and, but for jumps, continuous.
#[derive(Clone, Copy)]
pub(crate) struct Domain {
    lo: f64,
    hi: f64,
    ends: Ends,
}

impl Domain {
    pub(crate) fn of(f: Unary) -> Self {
        let (lo, hi, ends) = match f {
            Unary::Sqrt => (0.0, f64::INFINITY, Ends::Closed),
            Unary::Log | Unary::Log2 | Unary::Log10 => (0.0, f64::INFINITY, Ends::Open),
            Unary::Logp1 => (-1.0, f64::INFINITY, Ends::Open),
            Unary::Asin | Unary::Acos => (-1.0, 1.0, Ends::Closed),
            Unary::Acosh => (1.0, f64::INFINITY, Ends::Closed),
            Unary::Atanh => (-1.0, 1.0, Ends::Open),
            _ => (f64::NEG_INFINITY, f64::INFINITY, Ends::Closed),
        };
        Self { lo, hi, ends }
    }

    /// Is each member of `x` in the domain?
    pub(crate) fn covers<S: Scalar>(self, x: [S; 2]) -> bool {
        let [lo, hi] = x.map(S::to_f64);
        match self.ends {
            Ends::Closed => self.lo <= lo && hi <= self.hi,
            Ends::Open => self.lo < lo && (hi < self.hi || self.hi == f64::INFINITY),
        }
    }

    /// The closed hull of the part of `x` in the domain.
    fn clip<S: Scalar>(self, x: [S; 2]) -> Option<[S; 2]> {
        let [lo, hi] = x.map(S::to_f64);
        let meets = match self.ends {
            Ends::Closed => self.lo <= hi && lo <= self.hi,
            Ends::Open => self.lo < hi && lo < self.hi,
        };
        meets.then(|| [x[0].max(S::from_f64(self.lo)), x[1].min(S::from_f64(self.hi))])
    }
}

fn empty<S: Scalar>() -> [S; 2] {
    [S::NAN; 2]
}

fn entire<S: Scalar>() -> [S; 2] {
    [-S::INFINITY, S::INFINITY]
}

fn is_empty<S: Scalar>(x: [S; 2]) -> bool {
    x[0].is_nan() || x[1].is_nan()
}

fn zero<S: Scalar>() -> S {
    S::from_f64(0.0)
}

/// Smallest and largest absolute value.
fn magnitudes<S: Scalar>(x: [S; 2]) -> [S; 2] {
    [x[0].max(-x[1]).max(zero()), (-x[0]).max(x[1])]
}

fn clamp<S: Scalar>(y: [S; 2], lo: f64, hi: f64) -> [S; 2] {
    [y[0].max(S::from_f64(lo)), y[1].min(S::from_f64(hi))]
}

/// The range of an increasing function that has the exact value `fixed[1]` at `fixed[0]`.
fn increasing<S: Scalar>(f: Unary, x: [S; 2], fixed: [f64; 2]) -> [S; 2] {
    let [at, value] = fixed.map(S::from_f64);
    let lo = x[0].elementary(f).elementary_down();
    let hi = x[1].elementary(f).elementary_up();
    [if x[0] < at { lo } else { lo.max(value) }, if x[1] > at { hi } else { hi.min(value) }]
}

/// The argument in quarter turns, rounded outward by far more than the error of the product.
fn quarter_turns<S: Scalar>(x: [S; 2]) -> [f64; 2] {
    const MARGIN: f64 = 1.0 / (1u64 << 50) as f64;
    let [lo, hi] = x.map(|x| x.to_f64() * FRAC_2_PI);
    let (outward, inward) = (1.0 + MARGIN, 1.0 - MARGIN);
    [lo * if lo < 0.0 { outward } else { inward }, hi * if hi < 0.0 { inward } else { outward }]
}

/// Does the interval contain `first + k period` for an integer k?
fn passes(x: [f64; 2], first: f64, period: f64) -> bool {
    floor((x[1] - first) / period) >= -floor((first - x[0]) / period)
}

/// The range of sine or cosine, whose crests lie at `crest + 4 k` quarter turns.
fn wave<S: Scalar>(f: Unary, x: [S; 2], crest: f64) -> [S; 2] {
    let turns = quarter_turns(x);
    let [trough_inside, crest_inside] =
        [passes(turns, crest + 2.0, 4.0), passes(turns, crest, 4.0)];
    if trough_inside && crest_inside {
        return [-1.0, 1.0].map(S::from_f64);
    }
    let (a, b) = (x[0].elementary(f), x[1].elementary(f));
    let lo = if trough_inside { S::from_f64(-1.0) } else { a.min(b).elementary_down() };
    let hi = if crest_inside { S::from_f64(1.0) } else { a.max(b).elementary_up() };
    clamp([lo, hi], -1.0, 1.0)
}

/// Is `b - a` certainly below pi?
fn is_narrower_than_pi(a: f64, b: f64) -> bool {
    let width = b - a;
    // What the subtraction lost; the double nearest to pi lies below it.
    let part = width - b;
    let lost = (b - (width - part)) - (a + part);
    width < PI || width == PI && lost <= 0.0
}

/// Does the tangent have a pole in `x`, as far as can be told?
///
/// A pole between two numbers less than pi apart makes the second tangent the smaller one; and no float
/// is a pole.
pub(crate) fn has_pole<S: Scalar>(x: [S; 2]) -> bool {
    let increases = || {
        let [a, b] = x.map(|x| x.elementary(Unary::Tan));
        x[0] == x[1] || a.elementary_up() < b.elementary_down()
    };
    let is_narrow = is_narrower_than_pi(x[0].to_f64(), x[1].to_f64());
    passes(quarter_turns(x), 1.0, 2.0) && !(is_narrow && increases())
}

/// The range of `f` over `x`.
pub(crate) fn unary<S: Scalar>(f: Unary, x: [S; 2]) -> [S; 2] {
    if is_empty(x) {
        return empty();
    }
    let Some(x) = Domain::of(f).clip(x) else {
        return empty();
    };
    match f {
        Unary::Sqrt => [x[0].sqrt_down().max(zero()), x[1].sqrt_up()],
        Unary::Abs => magnitudes(x),
        Unary::Sign | Unary::Floor | Unary::Ceil => x.map(|x| x.elementary(f)),
        Unary::Exp | Unary::Exp2 | Unary::Exp10 => {
            clamp(increasing(f, x, [0.0, 1.0]), 0.0, f64::INFINITY)
        }
        Unary::Expm1 => clamp(increasing(f, x, [0.0, 0.0]), -1.0, f64::INFINITY),
        Unary::Tanh => clamp(increasing(f, x, [0.0, 0.0]), -1.0, 1.0),
        Unary::Log | Unary::Log2 | Unary::Log10 | Unary::Acosh => increasing(f, x, [1.0, 0.0]),
        Unary::Cosh => increasing(f, magnitudes(x), [0.0, 1.0]),
        Unary::Acos => {
            let lo = x[1].elementary(f).elementary_down();
            clamp([lo, x[0].elementary(f).elementary_up()], 0.0, f64::INFINITY)
        }
        Unary::Sin => wave(f, x, 1.0),
        Unary::Cos => wave(f, x, 0.0),
        Unary::Tan if has_pole(x) => entire(),
        Unary::Tan => [x[0].elementary(f).elementary_down(), x[1].elementary(f).elementary_up()],
        Unary::Cbrt
        | Unary::Logp1
        | Unary::Asin
        | Unary::Atan
        | Unary::Sinh
        | Unary::Asinh
        | Unary::Atanh => increasing(f, x, [0.0, 0.0]),
    }
}

/// The range of `f` over `x` times `y`.
pub(crate) fn binary<S: Scalar>(f: Binary, x: [S; 2], y: [S; 2]) -> [S; 2] {
    if is_empty(x) || is_empty(y) {
        return empty();
    }
    match f {
        Binary::Min => [x[0].min(y[0]), x[1].min(y[1])],
        Binary::Max => [x[0].max(y[0]), x[1].max(y[1])],
        Binary::Mod => modulo(x, y),
        Binary::Atan2 => angle(x, y),
        Binary::Hypot => {
            let ([a, b], [c, d]) = (magnitudes(x), magnitudes(y));
            let lo = a.elementary2(f, c).elementary_down().max(zero());
            [lo, b.elementary2(f, d).elementary_up()]
        }
        Binary::Pow => power(x, y),
    }
}

/// `x^y`, over `x > 0`, and over `x = 0` where `y > 0`.
pub(crate) fn power<S: Scalar>(x: [S; 2], y: [S; 2]) -> [S; 2] {
    let zero = zero();
    if is_empty(x) || is_empty(y) || x[1] < zero || x[1] <= zero && y[1] <= zero {
        return empty();
    }
    if x[1] <= zero {
        return [zero, zero];
    }
    // log x^y = y log x takes its extremes at the corners.
    let x = [x[0].max(zero), x[1]];
    let [a, b] = [y[0], y[1]].map(|y| x[0].elementary2(Binary::Pow, y));
    let [c, d] = [y[0], y[1]].map(|y| x[1].elementary2(Binary::Pow, y));
    let lo = a.min(b).min(c.min(d)).elementary_down();
    [lo.max(zero), a.max(b).max(c.max(d)).elementary_up()]
}

/// `x^n` for `n != 0`, over `x != 0` if `n < 0`.
pub(crate) fn integer_power<S: Scalar>(x: [S; 2], n: i32) -> [S; 2] {
    let (zero, one) = (zero(), S::from_f64(1.0));
    if is_empty(x) || n < 0 && x[0] >= zero && x[1] <= zero {
        return empty();
    }
    if n % 2 == 0 {
        let [least, most] = magnitudes(x);
        return positive_power(if n < 0 { [most, least] } else { [least, most] }, n);
    }
    // Odd powers have the sign of x.
    if x[0] >= zero {
        return positive_power(if n < 0 { [x[1], x[0]] } else { x }, n);
    }
    if x[1] <= zero {
        let [lo, hi] = integer_power([-x[1], -x[0]], n);
        return [-hi, -lo];
    }
    if n < 0 {
        return entire();
    }
    let [least, most] = [-x[0], x[1]].map(|x| positive_power([one, x], n)[1]);
    [-least, most]
}

/// From `x[0]^n` rounded down to `x[1]^n` rounded up, for `x >= 0`, on the same side of 1 as exactly.
fn positive_power<S: Scalar>(x: [S; 2], n: i32) -> [S; 2] {
    let (zero, one) = (zero(), S::from_f64(1.0));
    // The limits at 0 and infinity, too; adding 0 turns -0 into +0.
    let [lo, hi] = x.map(|x| (x + zero).power(n));
    let is_at_least_one = if n > 0 { x[0] >= one } else { x[0] <= one };
    let is_at_most_one = if n > 0 { x[1] <= one } else { x[1] >= one };
    let lo = lo.elementary_down().max(if is_at_least_one { one } else { zero });
    let is_limit = x[1] == zero || x[1] == S::INFINITY;
    let hi = if is_limit { hi } else { hi.elementary_up() };
    [lo, if is_at_most_one { hi.min(one) } else { hi }]
}

/// `floor(x/y)` for `y > 0`, or its limit, if it is small enough to be known.
fn floor_quotient(x: f64, y: f64) -> Option<f64> {
    const LARGEST: f64 = (1u64 << 52) as f64;
    let floor = (x / y).floor();
    if !(floor.abs() < LARGEST) {
        return None;
    }
    // x/y may have been rounded up to an integer; the remainder's sign is exact.
    let beyond = if y < f64::INFINITY { (-floor).mul_add(y, x) < 0.0 } else { x < 0.0 };
    Some(if beyond { floor - 1.0 } else { floor })
}

/// `floor(x/y)`, if it has one value over `x` times `y`.
pub(crate) fn constant_quotient<S: Scalar>(x: [S; 2], y: [S; 2]) -> Option<f64> {
    let ([a, b], [c, d]) = (x.map(S::to_f64), y.map(S::to_f64));
    if d < 0.0 {
        return constant_quotient([-x[1], -x[0]], [-y[1], -y[0]]);
    }
    if !(c > 0.0) {
        return None;
    }
    let lo = floor_quotient(a, if a < 0.0 { c } else { d })?;
    let hi = floor_quotient(b, if b < 0.0 { d } else { c })?;
    (lo == hi).then_some(lo)
}

/// `x - y floor(x/y)`, over `y != 0`.
fn modulo<S: Scalar>(x: [S; 2], y: [S; 2]) -> [S; 2] {
    let zero = zero();
    if y[0] < zero && zero < y[1] {
        return y;
    }
    if y[0] < zero {
        let [lo, hi] = modulo([-x[1], -x[0]], [-y[1], -y[0]]);
        return [-hi, -lo];
    }
    if y[1] <= zero {
        return empty();
    }
    let known = constant_quotient(x, y).filter(|&q| S::from_f64(q).to_f64() == q);
    let [lo, hi] = match known.map(S::from_f64) {
        None => [zero, y[1]],
        Some(q) if q == zero => x,
        Some(q) => {
            let [least, most] = if q > zero { y } else { [y[1], y[0]] };
            [x[0].sub_down(q.mul_up(most)), x[1].sub_up(q.mul_down(least))]
        }
    };
    [lo.max(zero), hi.min(y[1])]
}

/// The angle of the points `(x, y)`, without the origin.
fn angle<S: Scalar>(y: [S; 2], x: [S; 2]) -> [S; 2] {
    let zero = zero();
    if crosses_cut(y, x) {
        let pi = S::from_f64(PI).elementary_up();
        return [-pi, pi];
    }
    // Without the cut the extremes are at corners; adding 0 removes negative zeros.
    let mut range: Option<[S; 2]> = None;
    for (y, x) in [(y[0], x[0]), (y[0], x[1]), (y[1], x[0]), (y[1], x[1])] {
        if y == zero && x == zero {
            continue;
        }
        let angle = (y + zero).elementary2(Binary::Atan2, x + zero);
        range = Some(range.map_or([angle; 2], |[lo, hi]| [lo.min(angle), hi.max(angle)]));
    }
    let Some([lo, hi]) = range else {
        return empty();
    };
    let (lo, hi) = (lo.elementary_down(), hi.elementary_up());
    [if y[0] < zero { lo } else { lo.max(zero) }, hi]
}

/// Does the box reach both sides of the negative x axis, where the angle jumps by 2 pi?
pub(crate) fn crosses_cut<S: Scalar>(y: [S; 2], x: [S; 2]) -> bool {
    let zero = zero();
    y[0] < zero && zero <= y[1] && x[0] < zero
}
