//! Trees over doubles of the standard library, each with a bound of its rounding errors.

use super::Arithmetic;

/// A double near the exact value; the error is NaN where nothing is known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rounded {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

/// More than the relative error of any function of the standard library.
const UNIT: f64 = 8.0 * f64::EPSILON;

impl Rounded {
    pub(crate) fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    fn unknown() -> Self {
        Self { value: f64::NAN, error: f64::NAN }
    }

    /// A computed value whose operands alone would let it err by so much.
    fn new(value: f64, inherited: f64) -> Self {
        if !value.is_finite() || !inherited.is_finite() {
            return Self::unknown();
        }
        Self { value, error: inherited + UNIT * value.abs() + f64::MIN_POSITIVE }
    }

    /// Is enough known to compare with?
    pub(crate) fn is_known(self) -> bool {
        self.error <= 1e-6 * self.value.abs().max(1e-3)
    }

    /// Could that be the same value, computed in another order?
    pub(crate) fn agrees_with(self, other: f64) -> bool {
        (self.value - other).abs() <= 8.0 * self.error
    }

    fn ends(self) -> [f64; 2] {
        [self.value - self.error, self.value + self.error]
    }

    /// A function that is monotonous near the value.
    fn monotonous(self, f: impl Fn(f64) -> f64) -> Self {
        let y = f(self.value);
        let inherited = self.ends().map(|x| (f(x) - y).abs());
        // The sum is NaN if an end is outside of the domain.
        Self::new(y, inherited[0] + inherited[1])
    }

    /// A function that is constant between its jumps.
    fn step(self, f: impl Fn(f64) -> f64) -> Self {
        let [lo, hi] = self.ends().map(&f);
        if lo == hi { Self::exact(lo) } else { Self::unknown() }
    }
}

impl Arithmetic for Rounded {
    fn number(&self, decimal: &str) -> Self {
        Self::new(decimal.parse().expect("it is a decimal"), 0.0)
    }
    fn pi(&self) -> Self {
        Self::new(std::f64::consts::PI, 0.0)
    }
    fn neg(self) -> Self {
        Self { value: -self.value, error: self.error }
    }
    fn add(self, o: Self) -> Self {
        // The operands' own rounding counts again: sums are regrouped when they are folded.
        let regrouped = UNIT * (self.value.abs() + o.value.abs());
        Self::new(self.value + o.value, self.error + o.error + regrouped)
    }
    fn sub(self, o: Self) -> Self {
        self.add(o.neg())
    }
    fn mul(self, o: Self) -> Self {
        let inherited =
            self.error * (o.value.abs() + o.error) + o.error * (self.value.abs() + self.error);
        Self::new(self.value * o.value, inherited)
    }
    fn div(self, o: Self) -> Self {
        if o.value.abs() <= 2.0 * o.error {
            return Self::unknown();
        }
        let quotient = self.value / o.value;
        let divisor = o.value.abs() - o.error;
        Self::new(quotient, (self.error + quotient.abs() * o.error) / divisor)
    }
    fn power(self, n: i32) -> Self {
        if n < 0 {
            return Self::exact(1.0).div(self.power(-n));
        }
        let one = Self { error: self.error * 0.0, ..Self::exact(1.0) };
        (0..n).fold(one, |product, _| product.mul(self))
    }
    fn call1(self, f: &str) -> Self {
        match f {
            "sqr" => self.mul(self),
            "sqrt" => self.monotonous(f64::sqrt),
            "cbrt" => self.monotonous(f64::cbrt),
            "abs" => Self::new(self.value.abs(), self.error),
            "sign" => self.step(|x| if x == 0.0 { 0.0 } else { x.signum() }),
            "floor" => self.step(f64::floor),
            "ceil" => self.step(f64::ceil),
            "exp" => self.monotonous(f64::exp),
            "exp2" => self.monotonous(f64::exp2),
            "exp10" => self.monotonous(|x| 10_f64.powf(x)),
            "expm1" => self.monotonous(f64::exp_m1),
            "log" => self.monotonous(f64::ln),
            "log2" => self.monotonous(f64::log2),
            "log10" => self.monotonous(f64::log10),
            "logp1" => self.monotonous(f64::ln_1p),
            "sin" => Self::new(self.value.sin(), self.error),
            "cos" => Self::new(self.value.cos(), self.error),
            "tan" => self.call1("sin").div(self.call1("cos")),
            "asin" => self.monotonous(f64::asin),
            "acos" => self.monotonous(f64::acos),
            "atan" => self.monotonous(f64::atan),
            "sinh" => self.monotonous(f64::sinh),
            "cosh" => self.monotonous(f64::cosh),
            "tanh" => self.monotonous(f64::tanh),
            // Odd; the standard library's formula is inexact for small arguments.
            "asinh" if self.value.abs() > 1e-3 => self.monotonous(f64::asinh),
            "acosh" => self.monotonous(f64::acosh),
            "atanh" if self.value.abs() > 1e-3 => self.monotonous(f64::atanh),
            "asinh" | "atanh" => Self::unknown(),
            _ => panic!("unknown function `{f}`"),
        }
    }
    fn call2(self, f: &str, o: Self) -> Self {
        let (a, b) = (self, o);
        match f {
            "min" => Self::new(a.value.min(b.value), a.error + b.error),
            "max" => Self::new(a.value.max(b.value), a.error + b.error),
            "mod" => {
                let steps = a.div(b).call1("floor");
                a.sub(steps.mul(b))
            }
            "hypot" => Self::new(a.value.hypot(b.value), a.error + b.error),
            "atan2" => {
                let distance = a.value.hypot(b.value) - a.error - b.error;
                let is_near_cut = b.value <= b.error && a.value.abs() <= a.error;
                if is_near_cut || !(distance > 0.0) {
                    return Self::unknown();
                }
                Self::new(a.value.atan2(b.value), (a.error + b.error) / distance)
            }
            "pow" if a.value > a.error => b.mul(a.call1("log")).call1("exp"),
            "pow" => Self::unknown(),
            _ => panic!("unknown function `{f}`"),
        }
    }
}
