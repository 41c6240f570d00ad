//! Trees over intervals of many bits: nearly exact.

use zeroset_ia::{BigInterval, Binary, Number, Unary};

use super::Arithmetic;

/// Bits of the significand.
const PRECISION: usize = 256;

/// A narrow interval around the exact value.
#[derive(Clone, Debug)]
pub(crate) struct Nearly {
    value: BigInterval,
    /// Is each operation defined for all that its operands may be?
    is_defined: bool,
}

impl Nearly {
    pub(crate) fn exact(x: f64) -> Self {
        Self { value: BigInterval::from_f64(x, PRECISION), is_defined: true }
    }

    /// Doubles around the value; none if it may be undefined.
    pub(crate) fn bounds(&self) -> Option<[f64; 2]> {
        self.is_defined.then(|| self.value.to_f64())
    }

    /// An operation on this and maybe another number, defined as said and if the result is bounded.
    fn then(self, other: bool, is_defined: bool, value: BigInterval) -> Self {
        let is_defined = self.is_defined && other && is_defined && value.is_bounded();
        Self { value, is_defined }
    }
}

impl Arithmetic for Nearly {
    fn number(&self, decimal: &str) -> Self {
        let decimal = if decimal.starts_with('.') { format!("0{decimal}") } else { decimal.into() };
        let value = BigInterval::parse_decimal(&decimal, PRECISION).expect("it is a decimal");
        Self { value, is_defined: true }
    }
    fn pi(&self) -> Self {
        Self { value: BigInterval::pi(PRECISION), is_defined: true }
    }
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
    fn add(self, o: Self) -> Self {
        let value = self.value.clone() + o.value;
        self.then(o.is_defined, true, value)
    }
    fn sub(self, o: Self) -> Self {
        self.add(o.neg())
    }
    fn mul(self, o: Self) -> Self {
        let value = self.value.clone() * o.value;
        self.then(o.is_defined, true, value)
    }
    fn div(self, o: Self) -> Self {
        let is_defined = !o.value.contains_zero();
        let value = self.value.clone() / o.value;
        self.then(o.is_defined, is_defined, value)
    }
    fn power(self, n: i32) -> Self {
        let is_defined = n >= 0 || !self.value.contains_zero();
        let value = self.value.clone().powi(n);
        self.then(true, is_defined, value)
    }
    fn call1(self, f: &str) -> Self {
        let Some(f) = Unary::from_name(f) else {
            let value = self.value.clone().sqr();
            return self.then(true, true, value);
        };
        // Domains are intervals.
        let ends = [self.value.lower(), self.value.upper()];
        let is_defined = ends.into_iter().all(|end| !end.unary(f).is_empty());
        let value = self.value.clone().unary(f);
        self.then(true, is_defined, value)
    }
    fn call2(self, f: &str, o: Self) -> Self {
        let f = Binary::from_name(f).expect("it is a function");
        let is_defined = match f {
            Binary::Min | Binary::Max | Binary::Hypot => true,
            Binary::Mod => !o.value.contains_zero(),
            Binary::Atan2 => !(self.value.contains_zero() && o.value.contains_zero()),
            Binary::Pow => self.value.is_positive(),
        };
        let value = self.value.clone().binary(f, o.value);
        self.then(o.is_defined, is_defined, value)
    }
}
