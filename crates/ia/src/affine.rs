//! Affine forms: a function as a linear part and an error, beside its interval.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::{Binary, Constant, Dual, Interval, Number, Real, Scalar, Unary};

/// `centre + sum slopes_i e_i + d`, with noise symbols e_i in [-1, 1] that a whole computation shares and
/// `|d| <= error`; and the same number in an interval, whichever is narrower.
///
/// Linear parts cancel where intervals add up: `x - x` is 0, and over small boxes the width of a smooth
/// function shrinks to its linear part with the square of the box's size. What rounding, products of symbols and
/// curvature add is in the error. Functions that are not smooth on their argument's range keep only the
/// interval.
///
/// Preconditions are those of [`Raw`](crate::Raw) intervals.
#[derive(Clone, Copy, Debug)]
pub struct Affine<R, const K: usize> {
    /// The value where all symbols are 0, but for the error.
    pub centre: R,
    /// What each symbol adds.
    pub slopes: [R; K],
    /// Of either sign.
    pub error: R,
    /// Holds the number too.
    pub range: Interval<R>,
}

/// 2^60: a larger linear part is dropped, so that products of two do not overflow.
const LIMIT: f64 = (1_u64 << 60) as f64;

/// The lower end, and how far the upper one is from it.
#[inline(always)]
fn split<R: Real>(x: Interval<R>) -> [R; 2] {
    [x.lo, x.hi.sub_up(x.lo)]
}

/// The product of two numbers.
#[inline(always)]
fn product<R: Real>(a: R, b: R) -> Interval<R> {
    Interval::new(a.mul_down(b), a.mul_up(b))
}

#[inline(always)]
fn real<R: Real>(context: R, x: f64) -> R {
    context.splat(R::Scalar::from_f64(x))
}

impl<R: Real, const K: usize> Affine<R, K> {
    /// A number in an interval, of which no more is known.
    #[inline(always)]
    pub fn between(range: Interval<R>) -> Self {
        let [centre, error] = middle(range);
        Self { centre, slopes: [real(centre, 0.0); K], error, range }
    }

    /// The number that runs from one end of an interval to the other with the symbol of this index.
    #[inline(always)]
    pub fn variable(range: Interval<R>, symbol: usize) -> Self {
        let [centre, radius] = middle(range);
        let zero = real(centre, 0.0);
        let mut slopes = [zero; K];
        slopes[symbol] = radius;
        Self { centre, slopes, error: zero, range }
    }

    /// The number with an error up to `slack` more.
    #[inline(always)]
    pub fn widened(self, slack: R) -> Self {
        let range = Interval::new(self.range.lo.sub_down(slack), self.range.hi.add_up(slack));
        Self { error: self.error.add_up(slack), range, ..self }
    }

    /// The number, known to be in an interval.
    #[inline(always)]
    pub fn within(self, range: Interval<R>) -> Self {
        Self { range: self.range.intersection(range), ..self }
    }

    /// The product with a number in an interval; `range` holds it.
    #[inline(always)]
    pub fn scaled(self, factor: Interval<R>, range: Interval<R>) -> Self {
        let centre = Interval::point(self.centre) * factor;
        let mut slopes = [centre; K];
        for (slope, own) in slopes.iter_mut().zip(self.slopes) {
            *slope = Interval::point(own) * factor;
        }
        let size = factor.hi.max(-factor.lo);
        Self::new(centre, slopes, self.error.mul_up(size), range)
    }

    /// The sum with a number in an interval; `range` holds it.
    #[inline(always)]
    pub fn shifted(self, shift: Interval<R>, range: Interval<R>) -> Self {
        let [shift, rounding] = split(shift);
        let centre = Interval::point(self.centre) + Interval::point(shift);
        let mut slopes = [centre; K];
        for (slope, own) in slopes.iter_mut().zip(self.slopes) {
            *slope = Interval::point(own);
        }
        Self::new(centre, slopes, self.error.add_up(rounding), range)
    }

    /// The sum of the slopes' absolute values, rounded up.
    #[inline(always)]
    fn spread(&self) -> R {
        let mut sum = real(self.centre, 0.0);
        for slope in self.slopes {
            sum = sum.add_up(slope.abs());
        }
        sum
    }

    /// From parts; the interval is cut with what they say.
    #[inline(always)]
    fn new(centre: Interval<R>, slopes: [Interval<R>; K], error: R, range: Interval<R>) -> Self {
        let [centre, mut error] = {
            let [centre, rounding] = split(centre);
            [centre, error.add_up(rounding)]
        };
        let mut result = Self { centre, slopes: [centre; K], error, range };
        for (slope, given) in result.slopes.iter_mut().zip(slopes) {
            let [value, rounding] = split(given);
            *slope = value;
            error = error.add_up(rounding);
        }
        result.error = error;
        let radius = result.spread().add_up(error);
        let linear = Interval::new(centre.sub_down(radius), centre.add_up(radius));
        result.range = range.intersection(linear);
        // What is no number is not below the limit either.
        let limit = real(centre, LIMIT);
        Self::select_lt(centre.abs().add_up(radius), limit, result, Self::between(range))
    }

    /// `x` where `a < b`, else `y`.
    #[inline(always)]
    fn select_lt(a: R, b: R, x: Self, y: Self) -> Self {
        let mut slopes = x.slopes;
        for (slope, other) in slopes.iter_mut().zip(y.slopes) {
            *slope = a.select_lt(b, *slope, other);
        }
        Self {
            centre: a.select_lt(b, x.centre, y.centre),
            slopes,
            error: a.select_lt(b, x.error, y.error),
            range: Interval::new(
                a.select_lt(b, x.range.lo, y.range.lo),
                a.select_lt(b, x.range.hi, y.range.hi),
            ),
        }
    }

    /// A function by its value at a point m of the range, and the slopes it has there: `f(x) = f(m) +
    /// s (x - m)` with s in `slope`; `range` is that of f.
    #[inline(always)]
    fn by_slope(
        self,
        range: Interval<R>,
        slope: Interval<R>,
        f: impl Fn(Interval<R>) -> Interval<R>,
    ) -> Self {
        let m = self.centre.max(self.range.lo).min(self.range.hi);
        let [s, spread] = middle(slope);
        // f(m) + s (x0 - m), s x_i, |s| e and the spread of slopes over the range.
        let shift = Interval::new(self.centre.sub_down(m), self.centre.sub_up(m));
        let centre = f(Interval::point(m)) + shift * Interval::point(s);
        let mut slopes = [centre; K];
        for (slope, own) in slopes.iter_mut().zip(self.slopes) {
            *slope = product(s, own);
        }
        let reach = self.range.hi.sub_up(m).max(m.sub_up(self.range.lo));
        let error = s.abs().mul_up(self.error).add_up(spread.mul_up(reach));
        Self::new(centre, slopes, error, range)
    }
}

/// A number in an interval, about its middle, and how far the ends are from it, rounded up.
#[inline(always)]
fn middle<R: Real>(range: Interval<R>) -> [R; 2] {
    let half = real(range.lo, 0.5);
    let centre = range.lo.mul_down(half).add_down(range.hi.mul_down(half));
    let centre = centre.max(range.lo).min(range.hi);
    [centre, range.hi.sub_up(centre).max(centre.sub_up(range.lo))]
}

impl<R: Real, const K: usize> Add for Affine<R, K> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        let centre = Interval::point(self.centre) + Interval::point(o.centre);
        let mut slopes = [centre; K];
        for (i, slope) in slopes.iter_mut().enumerate() {
            *slope = Interval::point(self.slopes[i]) + Interval::point(o.slopes[i]);
        }
        Self::new(centre, slopes, self.error.add_up(o.error), self.range + o.range)
    }
}

impl<R: Real, const K: usize> Sub for Affine<R, K> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        let centre = Interval::point(self.centre) - Interval::point(o.centre);
        let mut slopes = [centre; K];
        for (i, slope) in slopes.iter_mut().enumerate() {
            *slope = Interval::point(self.slopes[i]) - Interval::point(o.slopes[i]);
        }
        Self::new(centre, slopes, self.error.add_up(o.error), self.range - o.range)
    }
}

impl<R: Real, const K: usize> Neg for Affine<R, K> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for slope in &mut self.slopes {
            *slope = -*slope;
        }
        Self { centre: -self.centre, range: -self.range, ..self }
    }
}

impl<R: Real, const K: usize> Mul for Affine<R, K> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.times(o, self.range * o.range)
    }
}

impl<R: Real, const K: usize> Affine<R, K> {
    /// The product, which is known to be in a range.
    ///
    /// With p the spread of x's slopes and q of y's: `x_i y_i e_i^2` lies in `x_i y_i / 2 +- |x_i y_i| / 2`, and
    /// all other products of symbols add at most `p q - sum |x_i y_i|`.
    #[inline(always)]
    fn times(self, o: Self, range: Interval<R>) -> Self {
        let half = real(self.centre, 0.5);
        let mut squares = Interval::point(real(self.centre, 0.0));
        let mut least = real(self.centre, 0.0);
        for i in 0..K {
            let square = product(self.slopes[i], o.slopes[i]);
            squares = squares + square;
            // |x_i y_i| is not below either of these.
            least = least.add_down(square.lo.max(-square.hi));
        }
        let halved = Interval::new(squares.lo.mul_down(half), squares.hi.mul_up(half));
        let centre = product(self.centre, o.centre) + halved;
        let mut slopes = [centre; K];
        for (i, slope) in slopes.iter_mut().enumerate() {
            *slope = product(self.centre, o.slopes[i]) + product(self.slopes[i], o.centre);
        }
        let (p, q) = (self.spread(), o.spread());
        let symbols = p.mul_up(q).sub_up(least.mul_down(half));
        let own = self.centre.abs().add_up(p).mul_up(o.error);
        let other = o.centre.abs().add_up(q).add_up(o.error).mul_up(self.error);
        let error = symbols.add_up(own).add_up(other);
        Self::new(centre, slopes, error, range)
    }
}

impl<R: Real, const K: usize> Div for Affine<R, K> {
    type Output = Self;
    #[inline(always)]
    #[allow(clippy::suspicious_arithmetic_impl)]
    fn div(self, o: Self) -> Self {
        let one = Interval::point(real(self.centre, 1.0));
        let reciprocal = one / o.range;
        let inverse = o.by_slope(
            reciprocal,
            -reciprocal.sqr(),
            #[inline(always)]
            |y| one / y,
        );
        // A reciprocal may overflow where the quotient does not: its own range is not multiplied.
        self.times(inverse, self.range / o.range)
    }
}

impl<R: Real, const K: usize> Number for Affine<R, K> {
    #[inline(always)]
    fn constant(&self, c: &Constant) -> Self {
        Self::between(self.range.constant(c))
    }

    #[inline(always)]
    fn scale(self, c: &Constant) -> Self {
        self.scaled(self.range.constant(c), self.range.scale(c))
    }

    #[inline(always)]
    fn offset(self, c: &Constant) -> Self {
        self.shifted(self.range.constant(c), self.range.offset(c))
    }

    /// With p the spread of the slopes, `(sum x_i e_i)^2` lies in `p^2 / 2 +- p^2 / 2`.
    #[inline(always)]
    fn sqr(self) -> Self {
        let (half, two) = (real(self.centre, 0.5), real(self.centre, 2.0));
        let p = self.spread();
        let most = p.mul_up(p).mul_up(half);
        let centre = product(self.centre, self.centre) + Interval::point(most);
        let double = two.mul_down(self.centre);
        let rest = two.mul_up(self.centre).sub_up(double);
        let mut slopes = [centre; K];
        for (i, slope) in slopes.iter_mut().enumerate() {
            *slope = product(double, self.slopes[i]);
        }
        let reach = self.centre.abs().add_up(p).mul_up(two).add_up(self.error);
        let error = most.add_up(reach.mul_up(self.error)).add_up(rest.mul_up(p));
        Self::new(centre, slopes, error, self.range.sqr())
    }

    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        let range = self.range.powi(n);
        if n < 2 {
            return match n {
                0 => Self::between(range),
                1 => self,
                _ => {
                    let one = Self::between(Interval::point(real(self.centre, 1.0)));
                    (one / self.powi(n.saturating_neg())).within(range)
                }
            };
        }
        // By squares and products, from the highest bit on.
        let mut power = self;
        for bit in (0..n.ilog2()).rev() {
            power = power.sqr();
            if n >> bit & 1 == 1 {
                power = power * self;
            }
        }
        power.within(range)
    }

    #[inline(always)]
    fn powc(self, c: &Constant) -> Self {
        Self::between(self.range.powc(c))
    }

    #[inline(always)]
    fn unary(self, f: Unary) -> Self {
        let range = self.range.unary(f);
        let zero = real(self.centre, 0.0);
        match f {
            Unary::Abs => {
                let [lo, hi] = self.range.bounds();
                let mixed = Self::select_lt(hi, zero, -self, Self::between(range));
                Self::select_lt(lo, zero, mixed, self)
            }
            // Smooth wherever they are defined.
            Unary::Exp
            | Unary::Exp2
            | Unary::Exp10
            | Unary::Expm1
            | Unary::Log
            | Unary::Log2
            | Unary::Log10
            | Unary::Logp1
            | Unary::Sin
            | Unary::Cos
            | Unary::Atan
            | Unary::Sinh
            | Unary::Cosh
            | Unary::Tanh
            | Unary::Asinh => {
                let Dual { tangent: [slope], .. } = Dual::<_, 1>::variable(self.range, 0).unary(f);
                self.by_slope(
                    range,
                    slope,
                    #[inline(always)]
                    |x| x.unary(f),
                )
            }
            Unary::Sqrt => self.root(range),
            _ => Self::between(range),
        }
    }

    #[inline(always)]
    fn binary(self, f: Binary, o: Self) -> Self {
        let range = self.range.binary(f, o.range);
        let mixed = Self::between(range);
        match f {
            Binary::Min => {
                let other = Self::select_lt(o.range.hi, self.range.lo, o, mixed);
                Self::select_lt(self.range.hi, o.range.lo, self, other)
            }
            Binary::Max => {
                let other = Self::select_lt(o.range.hi, self.range.lo, self, mixed);
                Self::select_lt(self.range.hi, o.range.lo, o, other)
            }
            _ => mixed,
        }
    }
}

impl<R: Real, const K: usize> Affine<R, K> {
    /// The square root: with s the slope at the upper end b, or less, `sqrt x - s x` increases from the lower
    /// end a to b.
    #[inline(always)]
    fn root(self, range: Interval<R>) -> Self {
        let (half, one) = (real(self.centre, 0.5), real(self.centre, 1.0));
        let zero = real(self.centre, 0.0);
        let [a, b] = self.range.bounds();
        let (a, b) = (a.max(zero), b.max(zero));
        // 2^-40: what is that small gains nothing from a linear part.
        let root = range.hi.max(real(self.centre, 1.0 / (1_u64 << 40) as f64));
        let s = half.mul_down(one.div_down(root)).max(zero);
        let rest = |x: R| {
            let point = Interval::<R>::point(x);
            point.unary(Unary::Sqrt) - product(s, x)
        };
        let [low, high] = [rest(a).lo, rest(b).hi];
        let [centre, error] = middle(Interval::new(low, high.max(low)));
        let centre = Interval::point(centre) + product(s, self.centre);
        let mut slopes = [centre; K];
        for (slope, own) in slopes.iter_mut().zip(self.slopes) {
            *slope = product(s, own);
        }
        Self::new(centre, slopes, s.mul_up(self.error).add_up(error), range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reciprocal_that_overflows_takes_nothing_from_its_quotient() {
        // x^2 / y with x around 0 and 1/y infinite at its end.
        let x = Affine::<f32, 2>::variable(Interval::new(-1.0, 1.0), 0);
        let y = Affine::<f32, 2>::variable(Interval::new(1e-39, 3e-39), 1);
        let small = Affine::between(Interval::point(1e-10));
        let quotient = small * x.sqr() / y;
        assert!(quotient.range.lo <= 0.0, "{quotient:?}");
        assert!(quotient.range.hi >= 1e29, "{quotient:?}");
    }

    #[test]
    fn linear_parts_cancel() {
        let x = Affine::<f64, 1>::variable(Interval::new(1.0, 3.0), 0);
        let Interval { lo, hi, .. } = (x - x).range;
        assert!(lo <= 0.0 && 0.0 <= hi && hi - lo < 1e-15, "{lo} {hi}");
        // x^2 - 4 x + 4 = (x - 2)^2 lies in [0, 1]; intervals have [-7, 9].
        let four = Affine::between(Interval::point(4.0));
        let Interval { lo, hi, .. } = (x.sqr() - four * x + four).range;
        assert!(lo <= 0.0 && 1.0 <= hi && lo > -0.01 && hi < 1.01, "{lo} {hi}");
    }
}
