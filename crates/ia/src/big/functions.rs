//! Elementary functions and their ranges.

use std::cell::RefCell;

use astro_float::{BigFloat, Consts, RoundingMode, Sign};

use super::convert::from_double;
use super::{BigInterval, EXPONENT_LIMIT, Toward, integer, power_of_two, whole_words};
use crate::{Binary, Constant, Number, Unary};

thread_local! {
    /// Digits of pi, e and logarithms found so far.
    static CONSTANTS: RefCell<Consts> =
        RefCell::new(Consts::new().expect("memory for four constants"));
}

/// The exponent from which an exponential leaves the range of exponents.
const EXPONENTIAL_LIMIT: i32 = 26;
/// The exponent from which sine, cosine and tangent are taken to have any value.
const TURN_LIMIT: i32 = 4096;

/// More bits than asked for: half of them are trusted, half cover the errors of the library.
const GUARD: usize = 64;

/// Rounds a value that carries an error of at most `2^-(precision + GUARD / 2)`, relatively.
fn round(x: BigFloat, precision: usize, toward: Toward) -> BigFloat {
    let Some(exponent) = x.exponent().filter(|_| !x.is_zero()) else {
        return toward.settle(x);
    };
    let sign = if toward == Toward::Up { Sign::Pos } else { Sign::Neg };
    let error = power_of_two(sign, exponent - (precision + GUARD / 2) as i32 + 1);
    toward.settle(x.add(&error, precision, toward.mode()))
}

/// The value at an argument where it is known exactly, limits at infinity included.
fn exact(f: Unary, x: &BigFloat) -> Option<BigFloat> {
    let infinite = x.is_inf();
    let above = x.is_positive();
    Some(match f {
        Unary::Exp | Unary::Exp2 | Unary::Exp10 if infinite => {
            if above {
                x.clone()
            } else {
                integer(0)
            }
        }
        Unary::Exp | Unary::Exp2 | Unary::Exp10 if x.is_zero() => integer(1),
        Unary::Expm1 if infinite && !above => integer(-1),
        Unary::Tanh if infinite => integer(if above { 1 } else { -1 }),
        Unary::Cosh if infinite => astro_float::INF_POS,
        Unary::Cosh | Unary::Cos if x.is_zero() => integer(1),
        Unary::Log | Unary::Log2 | Unary::Log10 if x.is_zero() => astro_float::INF_NEG,
        Unary::Log | Unary::Log2 | Unary::Log10 | Unary::Acosh | Unary::Acos
            if *x == integer(1) =>
        {
            integer(0)
        }
        Unary::Logp1 | Unary::Atanh if *x == integer(-1) => astro_float::INF_NEG,
        Unary::Atanh if *x == integer(1) => astro_float::INF_POS,
        Unary::Expm1
        | Unary::Log
        | Unary::Log2
        | Unary::Log10
        | Unary::Logp1
        | Unary::Cbrt
        | Unary::Sqrt
        | Unary::Sinh
        | Unary::Asinh
        | Unary::Acosh
            if infinite =>
        {
            x.clone()
        }
        Unary::Cbrt
        | Unary::Sqrt
        | Unary::Expm1
        | Unary::Logp1
        | Unary::Sin
        | Unary::Tan
        | Unary::Asin
        | Unary::Atan
        | Unary::Sinh
        | Unary::Tanh
        | Unary::Asinh
        | Unary::Atanh
            if x.is_zero() =>
        {
            integer(0)
        }
        Unary::Exp2 if x.is_int() && x.exponent().is_some_and(|e| e < 20) => {
            let n = BigInterval::point(x.clone(), 64).to_f64()[0] as i32;
            power_of_two(Sign::Pos, n + 1)
        }
        _ => return None,
    })
}

/// `f(x)` for one number, rounded outward.
fn elementary(f: Unary, x: &BigFloat, precision: usize, toward: Toward) -> BigFloat {
    if let Some(y) = exact(f, x) {
        return toward.settle(y);
    }
    let huge = x.exponent().is_some_and(|e| e > EXPONENTIAL_LIMIT);
    let unit = integer(if x.is_positive() { 1 } else { -1 });
    let y = match f {
        Unary::Sqrt | Unary::Cbrt => return root(f, x, precision, toward),
        Unary::Expm1 => return expm1(x, precision, toward),
        Unary::Logp1 => return logp1(x, precision, toward),
        Unary::Exp | Unary::Exp2 | Unary::Exp10 if huge && x.is_negative() => least(),
        Unary::Exp | Unary::Exp2 | Unary::Exp10 | Unary::Cosh if huge => astro_float::INF_POS,
        Unary::Sinh if huge => astro_float::INF_POS.mul(&unit, 64, RoundingMode::None),
        Unary::Tanh if huge => unit,
        _ => library(f, x, precision),
    };
    round(y, precision, toward)
}

/// A positive number below every end.
fn least() -> BigFloat {
    power_of_two(Sign::Pos, -2 * EXPONENT_LIMIT)
}

/// `f(x)` as the library has it, with the guard bits.
///
/// The library's own rounding is not asked for: it never ends where a result is exact.
fn library(f: Unary, x: &BigFloat, precision: usize) -> BigFloat {
    let (p, mode) = (precision + GUARD, RoundingMode::None);
    CONSTANTS.with_borrow_mut(|cc| match f {
        Unary::Exp => x.exp(p, mode, cc),
        Unary::Exp2 => integer(2).pow(x, p, mode, cc),
        Unary::Exp10 => integer(10).pow(x, p, mode, cc),
        Unary::Log => x.ln(p, mode, cc),
        Unary::Log2 => x.log2(p, mode, cc),
        Unary::Log10 => x.log10(p, mode, cc),
        Unary::Sin => x.sin(p, mode, cc),
        Unary::Cos => x.cos(p, mode, cc),
        Unary::Tan => x.tan(p, mode, cc),
        Unary::Asin => x.asin(p, mode, cc),
        Unary::Acos => x.acos(p, mode, cc),
        Unary::Atan => x.atan(p, mode, cc),
        Unary::Sinh => x.sinh(p, mode, cc),
        Unary::Cosh => x.cosh(p, mode, cc),
        Unary::Tanh => x.tanh(p, mode, cc),
        Unary::Asinh => x.asinh(p, mode, cc),
        Unary::Acosh => x.acosh(p, mode, cc),
        Unary::Atanh => x.atanh(p, mode, cc),
        Unary::Sqrt => x.sqrt(p, mode),
        Unary::Cbrt => x.cbrt(p, mode),
        Unary::Floor => x.floor(),
        Unary::Ceil => x.ceil(),
        Unary::Abs => x.abs(),
        Unary::Sign if x.is_zero() => integer(0),
        Unary::Sign => integer(if x.is_positive() { 1 } else { -1 }),
        Unary::Expm1 | Unary::Logp1 => astro_float::NAN,
    })
}

/// The square or cube root, exact where it can be.
fn root(f: Unary, x: &BigFloat, precision: usize, toward: Toward) -> BigFloat {
    let mut root = library(f, x, precision);
    let square = root.mul_full_prec(&root);
    let power = if f == Unary::Cbrt { square.mul_full_prec(&root) } else { square };
    if power == *x && root.set_precision(precision, toward.mode()).is_ok() {
        return root;
    }
    round(root, precision, toward)
}

/// `e^x - 1`, with the bits that the difference cancels.
fn expm1(x: &BigFloat, precision: usize, toward: Toward) -> BigFloat {
    let cancelled = -x.exponent().unwrap_or(0).min(0);
    let working = precision + 64 + cancelled as usize;
    let y = if cancelled as usize > precision {
        // x < e^x - 1 < x + x^2
        match toward {
            Toward::Down => x.clone(),
            Toward::Up => {
                x.add(&x.mul(x, precision, RoundingMode::Up), precision, RoundingMode::Up)
            }
        }
    } else {
        let exponential = elementary(Unary::Exp, x, whole_words(working), toward);
        exponential.sub(&integer(1), precision, toward.mode())
    };
    toward.settle(y)
}

/// `log(1 + x)`, with the bits that the sum needs.
fn logp1(x: &BigFloat, precision: usize, toward: Toward) -> BigFloat {
    let y = if x.exponent().is_some_and(|e| i64::from(e) < -(precision as i64)) {
        // x - x^2 < log(1 + x) < x
        match toward {
            Toward::Down => {
                x.sub(&x.mul(x, precision, RoundingMode::Up), precision, RoundingMode::Down)
            }
            Toward::Up => x.clone(),
        }
    } else {
        let sum = x.add(&integer(1), 2 * precision + 64, toward.mode());
        if sum.is_zero() {
            return toward.settle(astro_float::INF_NEG);
        }
        return elementary(Unary::Log, &sum, precision, toward);
    };
    toward.settle(y)
}

impl BigInterval {
    /// An enclosure of pi.
    pub fn pi(precision: usize) -> Self {
        let precision = whole_words(precision);
        let pi = |toward: Toward| {
            let pi = CONSTANTS.with_borrow_mut(|cc| cc.pi(precision + GUARD, RoundingMode::None));
            round(pi, precision, toward)
        };
        Self::new(pi(Toward::Down), pi(Toward::Up), precision)
    }

    /// The range of an increasing function that has the exact value `fixed[1]` at `fixed[0]`.
    fn increasing(&self, f: Unary, fixed: [f64; 2]) -> Self {
        let range = Self::new(
            elementary(f, &self.lo, self.precision, Toward::Down),
            elementary(f, &self.hi, self.precision, Toward::Up),
            self.precision,
        );
        let at = from_double(fixed[0]);
        let least = if self.lo >= at { fixed[1] } else { f64::NEG_INFINITY };
        let most = if self.hi <= at { fixed[1] } else { f64::INFINITY };
        range.clip(least, most)
    }

    /// The common members with `[lo, hi]`.
    fn clip(&self, lo: f64, hi: f64) -> Self {
        self.intersect(&Self::from_bounds(lo, hi, self.precision))
    }

    /// The part above `lo`, with `lo` itself as a limit; empty if only `lo` is left.
    fn above(&self, lo: f64) -> Self {
        let part = self.clip(lo, f64::INFINITY);
        if part.hi > from_double(lo) { part } else { Self::empty(self.precision) }
    }

    /// The argument in quarter turns, if it is not too large to tell.
    fn quarter_turns(&self) -> Option<Self> {
        let size = |x: &BigFloat| x.exponent().unwrap_or(i32::MAX);
        let exponent = size(&self.lo).max(size(&self.hi));
        if exponent > TURN_LIMIT {
            return None;
        }
        let working = self.precision + 64 + exponent.max(0) as usize;
        let two = Self::from_f64(2.0, working);
        Some(self.clone() * two / Self::pi(working))
    }

    /// Does it contain `first + k period` for an integer k?
    fn passes(&self, first: f64, period: f64) -> bool {
        let point = |x| Self::from_f64(x, self.precision);
        let steps = (self.clone() - point(first)) / point(period);
        steps.hi.floor() >= steps.lo.ceil()
    }

    /// The range of sine or cosine, whose crests lie at `crest + 4 k` quarter turns.
    fn wave(&self, f: Unary, crest: f64) -> Self {
        let Some(turns) = self.quarter_turns() else {
            return Self::from_bounds(-1.0, 1.0, self.precision);
        };
        let value = |x, toward| elementary(f, x, self.precision, toward);
        let extreme =
            |toward: Toward| toward.outer(value(&self.lo, toward), value(&self.hi, toward));
        let lo = if turns.passes(crest + 2.0, 4.0) { integer(-1) } else { extreme(Toward::Down) };
        let hi = if turns.passes(crest, 4.0) { integer(1) } else { extreme(Toward::Up) };
        Self::new(lo, hi, self.precision).clip(-1.0, 1.0)
    }

    /// The range of `f` over a set that is not empty.
    fn range(&self, f: Unary) -> Self {
        match f {
            Unary::Abs => {
                let [least, most] = self.magnitudes();
                Self::new(least, most, self.precision)
            }
            Unary::Floor | Unary::Ceil | Unary::Sign => {
                let end = |x| library(f, x, self.precision);
                Self::new(
                    Toward::Down.settle(end(&self.lo)),
                    Toward::Up.settle(end(&self.hi)),
                    self.precision,
                )
            }
            Unary::Sqrt => self.clip(0.0, f64::INFINITY).map(|x| x.increasing(f, [0.0, 0.0])),
            Unary::Log | Unary::Log2 | Unary::Log10 => {
                self.above(0.0).map(|x| x.increasing(f, [1.0, 0.0]))
            }
            Unary::Logp1 => self.above(-1.0).map(|x| x.increasing(f, [0.0, 0.0])),
            Unary::Asin => self.clip(-1.0, 1.0).map(|x| x.increasing(f, [0.0, 0.0])),
            Unary::Acos => self.clip(-1.0, 1.0).map(|x| {
                let acos = Self::new(
                    elementary(f, &x.hi, x.precision, Toward::Down),
                    elementary(f, &x.lo, x.precision, Toward::Up),
                    x.precision,
                );
                acos.clip(0.0, f64::INFINITY)
            }),
            Unary::Acosh => self.clip(1.0, f64::INFINITY).map(|x| x.increasing(f, [1.0, 0.0])),
            Unary::Atanh => (-(-self.above(-1.0)).above(-1.0)).map(|x| x.increasing(f, [0.0, 0.0])),
            Unary::Sin => self.wave(f, 1.0),
            Unary::Cos => self.wave(f, 0.0),
            Unary::Tan => match self.quarter_turns() {
                Some(turns) if !turns.passes(1.0, 2.0) => Self::new(
                    elementary(f, &self.lo, self.precision, Toward::Down),
                    elementary(f, &self.hi, self.precision, Toward::Up),
                    self.precision,
                ),
                _ => Self::entire(self.precision),
            },
            Unary::Cosh => {
                let [least, most] = self.magnitudes();
                Self::new(least, most, self.precision).increasing(f, [0.0, 1.0])
            }
            Unary::Tanh => self.increasing(f, [0.0, 0.0]).clip(-1.0, 1.0),
            Unary::Expm1 => self.increasing(f, [0.0, 0.0]).clip(-1.0, f64::INFINITY),
            Unary::Exp | Unary::Exp2 | Unary::Exp10 => {
                self.increasing(f, [0.0, 1.0]).clip(0.0, f64::INFINITY)
            }
            Unary::Cbrt | Unary::Atan | Unary::Sinh | Unary::Asinh => {
                self.increasing(f, [0.0, 0.0])
            }
        }
    }

    /// `f` of what a domain left, if anything.
    fn map(self, f: impl Fn(&Self) -> Self) -> Self {
        if self.is_empty() { self } else { f(&self) }
    }

    /// `x - y floor(x/y)`, over `y != 0`.
    fn modulo(&self, y: &Self) -> Self {
        let zero = integer(0);
        if y.lo < zero && y.hi > zero {
            return y.clone();
        }
        if y.lo < zero {
            return -(-self.clone()).modulo(&-y.clone());
        }
        let range = Self::new(zero, y.hi.clone(), y.precision);
        let steps = (self.clone() / y.clone()).unary(Unary::Floor);
        // However large y, a negative quotient is not yet 0.
        let steps = if self.is_negative() { steps.clip(f64::NEG_INFINITY, -1.0) } else { steps };
        if steps.is_empty() {
            steps
        } else if steps.is_point() {
            (self.clone() - y.clone() * steps).intersect(&range)
        } else {
            range
        }
    }

    /// The angle of a corner `(x, y)`, not the origin and not infinite twice, or its limit.
    fn angle(y: &BigFloat, x: &BigFloat, precision: usize) -> Self {
        let point = |x: &BigFloat| Self::point(x.clone(), precision);
        let half_turn = Self::pi(precision);
        let quarter = half_turn.clone() / Self::from_f64(2.0, precision);
        if x.is_inf() {
            // Far to the right, or far to the left above or below the cut.
            let left = if y.is_negative() { -half_turn } else { half_turn };
            return if x.is_positive() { point(&integer(0)) } else { left };
        }
        let zero = integer(0);
        if *x > zero && !y.is_inf() {
            (point(y) / point(x)).unary(Unary::Atan)
        } else if *y > zero {
            quarter - (point(x) / point(y)).unary(Unary::Atan)
        } else if *y < zero {
            -quarter - (point(x) / point(y)).unary(Unary::Atan)
        } else {
            half_turn
        }
    }

    /// The angles of the points with ordinate in `self` and abscissa in `x`, without the origin.
    fn angles(&self, x: &Self) -> Self {
        let precision = self.precision.max(x.precision);
        let zero = integer(0);
        if self.lo < zero && self.hi >= zero && x.lo < zero {
            let pi = Self::pi(precision);
            return (-pi.clone()).hull(&pi);
        }
        let mut range = Self::empty(precision);
        for y in [&self.lo, &self.hi] {
            for x in [&x.lo, &x.hi] {
                let origin = y.is_zero() && x.is_zero();
                if !(origin || y.is_inf() && x.is_inf()) {
                    range = range.hull(&Self::angle(y, x, precision));
                }
            }
        }
        range
    }

    /// `x^y`, over `x > 0`, and over `x = 0` where `y > 0`.
    fn pow(&self, y: &Self) -> Self {
        let precision = self.precision.max(y.precision);
        let zero = integer(0);
        let x = self.clip(0.0, f64::INFINITY);
        if x.is_empty() || x.hi.is_zero() && y.hi <= zero {
            return Self::empty(precision);
        }
        if x.hi.is_zero() {
            return Self::from_f64(0.0, precision);
        }
        let extreme = |toward: Toward| {
            let corner = |x, y| corner_power(x, y, precision, toward);
            let first = toward.outer(corner(&x.lo, &y.lo), corner(&x.lo, &y.hi));
            let second = toward.outer(corner(&x.hi, &y.lo), corner(&x.hi, &y.hi));
            toward.outer(first, second)
        };
        let range = Self::new(extreme(Toward::Down), extreme(Toward::Up), precision);
        range.clip(0.0, f64::INFINITY)
    }
}

/// `x^y` for `x >= 0`, with its limits at 0 and infinity.
fn corner_power(x: &BigFloat, y: &BigFloat, precision: usize, toward: Toward) -> BigFloat {
    let one = integer(1);
    if y.is_zero() || *x == one {
        return one;
    }
    if x.is_zero() || x.is_inf() || y.is_inf() {
        let grows = (*x > one) == y.is_positive();
        return toward.settle(if grows { astro_float::INF_POS } else { integer(0) });
    }
    let power = CONSTANTS.with_borrow_mut(|cc| x.pow(y, precision + GUARD, RoundingMode::None, cc));
    round(if power.is_zero() { least() } else { power }, precision, toward)
}

impl Number for BigInterval {
    fn constant(&self, c: &Constant) -> Self {
        c.big.with_precision(self.precision)
    }
    fn scale(self, c: &Constant) -> Self {
        let c = self.constant(c);
        self * c
    }
    fn offset(self, c: &Constant) -> Self {
        let c = self.constant(c);
        self + c
    }
    fn sqr(self) -> Self {
        self.power(2)
    }
    fn powi(self, n: i32) -> Self {
        let one = Self::from_f64(1.0, self.precision);
        match n {
            0 if self.is_empty() => self,
            0 => one,
            1.. => self.power(n.unsigned_abs()),
            _ => one / self.power(n.unsigned_abs()),
        }
    }
    fn powc(self, c: &Constant) -> Self {
        let c = self.constant(c);
        self.binary(Binary::Pow, c)
    }
    fn unary(self, f: Unary) -> Self {
        if self.is_empty() { self } else { self.range(f) }
    }
    fn binary(self, f: Binary, other: Self) -> Self {
        let precision = self.precision.max(other.precision);
        if self.is_empty() || other.is_empty() {
            return Self::empty(precision);
        }
        let smaller = |x, y| Toward::Down.outer(x, y);
        let larger = |x, y| Toward::Up.outer(x, y);
        match f {
            Binary::Min => {
                Self::new(smaller(self.lo, other.lo), smaller(self.hi, other.hi), precision)
            }
            Binary::Max => {
                Self::new(larger(self.lo, other.lo), larger(self.hi, other.hi), precision)
            }
            Binary::Mod => self.modulo(&other),
            Binary::Atan2 => self.angles(&other),
            Binary::Hypot => (self.sqr() + other.sqr()).unary(Unary::Sqrt),
            Binary::Pow => self.pow(&other),
        }
    }
}
