//! Truncated Taylor series over any enclosing number.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::constant::{HALF, LN_2, LN_10, MINUS_ONE, ONE, THREE, TWO, ZERO};
use crate::{BigInterval, Binary, Constant, Interval, Number, Scalar, Set, Unary};

/// A number that encloses, and can tell what it encloses.
pub trait Enclosure: Number {
    /// All numbers.
    fn entire(&self) -> Self;
    /// Has it members, each above 0?
    fn is_positive(&self) -> bool;
    /// Has it members, each below 0?
    fn is_negative(&self) -> bool;
    /// Does it contain one number only?
    fn is_point(&self) -> bool;
}

impl<S: Scalar> Enclosure for Interval<S, Set> {
    fn entire(&self) -> Self {
        Self::new(-S::INFINITY, S::INFINITY)
    }
    fn is_positive(&self) -> bool {
        self.lo > S::from_f64(0.0)
    }
    fn is_negative(&self) -> bool {
        self.hi < S::from_f64(0.0)
    }
    fn is_point(&self) -> bool {
        self.lo == self.hi
    }
}

impl Enclosure for BigInterval {
    fn entire(&self) -> Self {
        Self::entire(self.precision())
    }
    fn is_positive(&self) -> bool {
        self.is_positive()
    }
    fn is_negative(&self) -> bool {
        self.is_negative()
    }
    fn is_point(&self) -> bool {
        self.is_point()
    }
}

/// The Taylor coefficients `F^(k)(t) / k!` of a function of one variable, up to an order.
///
/// Evaluated over an interval T of the variable, the k-th coefficient encloses `F^(k)(t) / k!` for
/// every t in T. Where a derivative may not exist (at a kink, a jump, the end of a domain) the
/// coefficients from the first on are everything, so that Taylor's theorem never claims too much.
/// Operands of different order give the lower one.
#[derive(Clone, Debug)]
pub struct Jet<N> {
    /// At least one, the value.
    coefficients: Vec<N>,
}

impl<N: Enclosure> Jet<N> {
    /// A function that does not depend on the variable.
    pub fn constant_value(value: N, order: usize) -> Self {
        let zero = value.constant(&ZERO);
        let mut coefficients = vec![zero; order + 1];
        coefficients[0] = value;
        Self { coefficients }
    }

    /// A function with a constant slope: the variable itself has slope 1.
    pub fn variable(value: N, slope: N, order: usize) -> Self {
        let mut jet = Self::constant_value(value, order);
        if let Some(first) = jet.coefficients.get_mut(1) {
            *first = slope;
        }
        jet
    }

    /// The highest derivative.
    pub fn order(&self) -> usize {
        self.coefficients.len() - 1
    }

    /// The value.
    pub fn value(&self) -> &N {
        &self.coefficients[0]
    }

    /// `F^(k)(t) / k!`, for every k up to the order.
    pub fn coefficients(&self) -> &[N] {
        &self.coefficients
    }

    /// A function of which no more than the value is known.
    fn unknown(value: N, order: usize) -> Self {
        let mut coefficients = vec![value.entire(); order + 1];
        coefficients[0] = value;
        Self { coefficients }
    }

    /// The function with this value and this derivative.
    fn integral(value: N, derivative: Vec<N>) -> Self {
        let mut coefficients = vec![value];
        let terms = derivative.into_iter().enumerate();
        coefficients.extend(terms.map(|(k, term)| over_integer(term, k + 1)));
        Self { coefficients }
    }

    /// The function with this value and the derivative `rate / g`, unless g may vanish.
    fn integral_of_quotient(value: N, rate: &[N], g: &Self) -> Self {
        if has_sign(g.value()) {
            Self::integral(value, quotient(rate, &g.coefficients))
        } else {
            Self::unknown(value, rate.len())
        }
    }

    /// The coefficients of the derivative.
    fn derivative(&self) -> Vec<N> {
        let terms = self.coefficients.iter().enumerate().skip(1);
        terms.map(|(k, term)| term.clone().scale(&integer(k as i32))).collect()
    }

    fn with_value(mut self, value: N) -> Self {
        self.coefficients[0] = value;
        self
    }

    fn map(self, f: impl FnMut(N) -> N) -> Self {
        Self { coefficients: self.coefficients.into_iter().map(f).collect() }
    }
}

fn has_sign<N: Enclosure>(x: &N) -> bool {
    x.is_positive() || x.is_negative()
}

fn integer(n: i32) -> std::borrow::Cow<'static, Constant> {
    Constant::shared_integer(n)
}

fn over_integer<N: Number>(x: N, n: usize) -> N {
    if n == 1 {
        return x;
    }
    let n = x.constant(&integer(n as i32));
    x / n
}

/// The k-th coefficient of a product.
fn convolution<N: Number>(x: &[N], y: &[N], k: usize) -> N {
    let term = |i: usize| x[i].clone() * y[k - i].clone();
    (1..=k).fold(term(0), |sum, i| sum + term(i))
}

/// The k-th coefficient of a square: each mixed product once.
fn square_coefficient<N: Number>(x: &[N], k: usize) -> N {
    let mixed = (0..k.div_ceil(2)).map(|i| x[i].clone() * x[k - i].clone());
    let mixed = mixed.reduce(|sum, term| sum + term).map(|sum| sum.scale(&TWO));
    let middle = k.is_multiple_of(2).then(|| x[k / 2].clone().sqr());
    match (mixed, middle) {
        (Some(mixed), Some(middle)) => mixed + middle,
        (mixed, middle) => mixed.or(middle).expect("one of the two"),
    }
}

fn product<N: Number>(x: &[N], y: &[N]) -> Vec<N> {
    (0..x.len().min(y.len())).map(|k| convolution(x, y, k)).collect()
}

fn square<N: Number>(x: &[N]) -> Vec<N> {
    (0..x.len()).map(|k| square_coefficient(x, k)).collect()
}

/// `x / y` by `q_k = (x_k - sum_{j>0} y_j q_{k-j}) / y_0`.
fn quotient<N: Enclosure>(x: &[N], y: &[N]) -> Vec<N> {
    let mut q: Vec<N> = Vec::new();
    for k in 0..x.len().min(y.len()) {
        q.push(if k > 0 && !has_sign(&y[0]) {
            x[0].entire()
        } else {
            let rest = (1..=k).fold(x[k].clone(), |sum, j| sum - y[j].clone() * q[k - j].clone());
            rest / y[0].clone()
        });
    }
    q
}

/// `x^c` with a given value, by `k x_0 y_k = sum_{j>0} (c j - (k - j)) x_j y_{k-j}`.
fn power<N: Enclosure>(x: &[N], value: N, c: &N) -> Vec<N> {
    let mut y = vec![value];
    for k in 1..x.len() {
        if !has_sign(&x[0]) {
            y.push(x[0].entire());
            continue;
        }
        let term = |j: usize| {
            let weight = c.clone().scale(&integer(j as i32)).offset(&integer(j as i32 - k as i32));
            weight * x[j].clone() * y[k - j].clone()
        };
        let sum = (2..=k).fold(term(1), |sum, j| sum + term(j));
        y.push(over_integer(sum / x[0].clone(), k));
    }
    y
}

/// The function with `y' = rate y` and a given value.
fn exponential<N: Number>(value: N, rate: &[N]) -> Vec<N> {
    let mut y = vec![value];
    for k in 1..=rate.len() {
        y.push(over_integer(convolution(rate, &y, k - 1), k));
    }
    y
}

/// The pair with `s' = rate c` and `c' = sign rate s`: (hyperbolic) sine and cosine.
fn sine_and_cosine<N: Number>(s: N, c: N, rate: &[N], sign: &Constant) -> [Vec<N>; 2] {
    let (mut sine, mut cosine) = (vec![s], vec![c]);
    for k in 1..=rate.len() {
        let s = over_integer(convolution(rate, &cosine, k - 1), k);
        let c = over_integer(convolution(rate, &sine, k - 1), k).scale(sign);
        sine.push(s);
        cosine.push(c);
    }
    [sine, cosine]
}

/// The function with `y' = rate (1 + sign y^2)`: (hyperbolic) tangent.
fn tangent<N: Number>(value: N, rate: &[N], sign: &Constant) -> Vec<N> {
    let mut y = vec![value];
    let mut slope: Vec<N> = Vec::new();
    for k in 1..=rate.len() {
        let square = square_coefficient(&y, k - 1).scale(sign);
        slope.push(if k == 1 { square.offset(&ONE) } else { square });
        y.push(over_integer(convolution(rate, &slope, k - 1), k));
    }
    y
}

impl<N: Enclosure> Add for Jet<N> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let pairs = self.coefficients.into_iter().zip(o.coefficients);
        Self { coefficients: pairs.map(|(x, y)| x + y).collect() }
    }
}

impl<N: Enclosure> Sub for Jet<N> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        let pairs = self.coefficients.into_iter().zip(o.coefficients);
        Self { coefficients: pairs.map(|(x, y)| x - y).collect() }
    }
}

impl<N: Enclosure> Mul for Jet<N> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self { coefficients: product(&self.coefficients, &o.coefficients) }
    }
}

impl<N: Enclosure> Div for Jet<N> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        Self { coefficients: quotient(&self.coefficients, &o.coefficients) }
    }
}

impl<N: Enclosure> Neg for Jet<N> {
    type Output = Self;
    fn neg(self) -> Self {
        self.map(|x| -x)
    }
}

impl<N: Enclosure> Number for Jet<N> {
    fn constant(&self, c: &Constant) -> Self {
        Self::constant_value(self.value().constant(c), self.order())
    }

    fn scale(self, c: &Constant) -> Self {
        self.map(|x| x.scale(c))
    }

    fn offset(mut self, c: &Constant) -> Self {
        self.coefficients[0] = self.value().clone().offset(c);
        self
    }

    fn sqr(self) -> Self {
        Self { coefficients: square(&self.coefficients) }
    }

    fn powi(self, n: i32) -> Self {
        let value = self.value().clone().powi(n);
        let magnitude = n.unsigned_abs();
        if magnitude == 0 {
            return Self::constant_value(value, self.order());
        }
        // From the leading bit down.
        let mut power = self.clone();
        for bit in (0..magnitude.ilog2()).rev() {
            power = power.sqr();
            if magnitude >> bit & 1 == 1 {
                power = power * self.clone();
            }
        }
        let power = if n < 0 { self.constant(&ONE) / power } else { power };
        power.with_value(value)
    }

    fn powc(self, c: &Constant) -> Self {
        let value = self.value().clone().powc(c);
        if !self.value().is_positive() {
            return Self::unknown(value, self.order());
        }
        let c = value.constant(c);
        Self { coefficients: power(&self.coefficients, value, &c) }
    }

    fn unary(self, f: Unary) -> Self {
        let x = self.value().clone();
        let y = x.clone().unary(f);
        let rate = self.derivative();
        let coefficients = &self.coefficients;
        let scaled = |c: &Constant| rate.iter().map(|r| r.clone().scale(c)).collect::<Vec<_>>();
        let one = self.constant(&ONE);
        // The integral of `rate / g`, and of `rate / sqrt(g)`.
        let over = |g: Self| Self::integral_of_quotient(y.clone(), &rate, &g);
        let over_root = |g: Self| over(g.unary(Unary::Sqrt));
        let coefficients = match f {
            Unary::Abs if x.is_positive() => return self,
            Unary::Abs if x.is_negative() => return -self,
            Unary::Abs => return Self::unknown(y, self.order()),
            // Constant within a step.
            Unary::Sign | Unary::Floor | Unary::Ceil if y.is_point() => {
                return Self::constant_value(y, self.order());
            }
            Unary::Sign | Unary::Floor | Unary::Ceil => return Self::unknown(y, self.order()),
            Unary::Sqrt => power(coefficients, y, &x.constant(&HALF)),
            Unary::Cbrt => {
                let third = x.constant(&ONE) / x.constant(&THREE);
                power(coefficients, y, &third)
            }
            Unary::Exp => exponential(y, &rate),
            Unary::Exp2 => exponential(y, &scaled(&LN_2)),
            Unary::Exp10 => exponential(y, &scaled(&LN_10)),
            Unary::Expm1 => {
                let exp = exponential(x.unary(Unary::Exp), &rate);
                return Self { coefficients: exp }.with_value(y);
            }
            Unary::Log => return over(self.clone()),
            Unary::Log2 => return over(self.clone().scale(&LN_2)),
            Unary::Log10 => return over(self.clone().scale(&LN_10)),
            Unary::Logp1 => return over(self.clone().offset(&ONE)),
            Unary::Sin => {
                let [sine, _] = sine_and_cosine(y, x.unary(Unary::Cos), &rate, &MINUS_ONE);
                sine
            }
            Unary::Cos => {
                let [_, cosine] = sine_and_cosine(x.unary(Unary::Sin), y, &rate, &MINUS_ONE);
                cosine
            }
            Unary::Sinh => {
                let [sine, _] = sine_and_cosine(y, x.unary(Unary::Cosh), &rate, &ONE);
                sine
            }
            Unary::Cosh => {
                let [_, cosine] = sine_and_cosine(x.unary(Unary::Sinh), y, &rate, &ONE);
                cosine
            }
            // There is a pole where the cosine vanishes.
            Unary::Tan if has_sign(&x.unary(Unary::Cos)) => tangent(y, &rate, &ONE),
            Unary::Tan => return Self::unknown(y, self.order()),
            Unary::Tanh => tangent(y, &rate, &MINUS_ONE),
            Unary::Asin => return over_root(one - self.clone().sqr()),
            Unary::Acos => return -over_root(one - self.clone().sqr()).with_value(-y.clone()),
            Unary::Atan => return over(self.clone().sqr().offset(&ONE)),
            Unary::Asinh => return over_root(self.clone().sqr().offset(&ONE)),
            Unary::Acosh => return over_root(self.clone().sqr().offset(&MINUS_ONE)),
            Unary::Atanh => return over(one - self.clone().sqr()),
        };
        Self { coefficients }
    }

    fn binary(mut self, f: Binary, mut o: Self) -> Self {
        let (x, y) = (self.value().clone(), o.value().clone());
        let order = self.order().min(o.order());
        self.coefficients.truncate(order + 1);
        o.coefficients.truncate(order + 1);
        let value = x.clone().binary(f, y.clone());
        match f {
            Binary::Min | Binary::Max => {
                let difference = if f == Binary::Min { y - x } else { x - y };
                if difference.is_positive() {
                    self
                } else if difference.is_negative() {
                    o
                } else {
                    Self::unknown(value, order)
                }
            }
            Binary::Mod => {
                let steps = (x / y).unary(Unary::Floor);
                if steps.is_point() {
                    let steps = Self::constant_value(steps, order);
                    (self - o * steps).with_value(value)
                } else {
                    Self::unknown(value, order)
                }
            }
            // Away from the cut, `(x y' - y x') / (x^2 + y^2)`.
            Binary::Atan2 if has_sign(&x) || y.is_positive() => {
                let first = product(&o.coefficients, &self.derivative());
                let second = product(&self.coefficients, &o.derivative());
                let rate: Vec<N> = first.into_iter().zip(second).map(|(x, y)| x - y).collect();
                Self::integral_of_quotient(value, &rate, &(self.sqr() + o.sqr()))
            }
            Binary::Atan2 => Self::unknown(value, order),
            Binary::Hypot => {
                let half = x.constant(&HALF);
                let norm = self.sqr() + o.sqr();
                Self { coefficients: power(&norm.coefficients, value, &half) }
            }
            Binary::Pow if x.is_positive() => {
                let exponent = o * self.unary(Unary::Log);
                Self { coefficients: exponential(value, &exponent.derivative()) }
            }
            Binary::Pow => Self::unknown(value, order),
        }
    }
}
