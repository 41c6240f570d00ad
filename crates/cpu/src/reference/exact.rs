//! The ray polynomial in exact rational arithmetic.

use num_bigint::BigInt;
use num_traits::{One, Zero};
use zeroset_expr::{Instruction, Op, Tape};
use zeroset_ia::{BigInterval, Constant};
use zeroset_raycast::Ray;

use super::sturm::{Point, Polynomial};

/// A polynomial function whose constants are binary fractions, and so known exactly.
#[derive(Clone, Debug)]
pub(super) struct ExactTape {
    instructions: Vec<Instruction>,
    constants: Vec<Ratio>,
    output: usize,
    registers: usize,
}

/// A polynomial in t: integer coefficients, constant first, over a common denominator above 0.
#[derive(Clone, Debug)]
struct Ratio {
    numerators: Vec<BigInt>,
    denominator: BigInt,
}

impl ExactTape {
    /// The tape, if it is a polynomial and all its constants are binary fractions.
    pub(super) fn new(tape: &Tape) -> Option<Self> {
        tape.degree()?;
        Some(Self {
            instructions: tape.instructions().to_vec(),
            constants: tape.constants().iter().map(rational).collect::<Option<_>>()?,
            output: tape.output() as usize,
            registers: tape.instructions().iter().map(|i| i.out as usize + 1).fold(3, usize::max),
        })
    }

    /// A positive multiple of F(t) with integer coefficients.
    pub(super) fn polynomial(&self, ray: Ray) -> Polynomial {
        let mut registers = vec![Ratio::integer(0); self.registers];
        for (axis, register) in registers.iter_mut().enumerate().take(3) {
            *register = Ratio::line(f64::from(ray.origin[axis]), f64::from(ray.direction[axis]));
        }
        for &Instruction { op, out } in &self.instructions {
            let get = |r: u32| &registers[r as usize];
            let constant = |c: u32| &self.constants[c as usize];
            registers[out as usize] = match op {
                Op::Load(c) => constant(c).clone(),
                Op::Add(a, b) => get(a).plus(get(b)),
                Op::Sub(a, b) => get(a).plus(&get(b).times(&Ratio::integer(-1))),
                Op::Mul(a, b) => get(a).times(get(b)),
                Op::Neg(a) => get(a).times(&Ratio::integer(-1)),
                Op::Scale(a, c) => get(a).times(constant(c)),
                Op::Offset(a, c) => get(a).plus(constant(c)),
                Op::Sqr(a) => get(a).times(get(a)),
                Op::Powi(a, n) => (0..n).fold(Ratio::integer(1), |p, _| p.times(get(a))),
                Op::Div(..) | Op::Powc(..) | Op::Unary(..) | Op::Binary(..) => {
                    unreachable!("{op:?} in a polynomial")
                }
            };
        }
        Polynomial::new(registers[self.output].numerators.clone())
    }
}

impl Ratio {
    fn integer(n: i32) -> Self {
        Self { numerators: vec![n.into()], denominator: BigInt::one() }
    }

    /// `origin + direction t`.
    fn line(origin: f64, direction: f64) -> Self {
        let [(o, o_over), (d, d_over)] = [origin, direction].map(|x| Point::new(x).parts());
        Self { numerators: vec![o * &d_over, d * &o_over], denominator: o_over * d_over }
    }

    fn plus(&self, other: &Self) -> Self {
        let length = self.numerators.len().max(other.numerators.len());
        let mut numerators = vec![BigInt::zero(); length];
        let same = self.denominator == other.denominator;
        for (x, denominator) in [(self, &other.denominator), (other, &self.denominator)] {
            for (sum, n) in numerators.iter_mut().zip(&x.numerators) {
                if same {
                    *sum += n;
                } else {
                    *sum += n * denominator;
                }
            }
        }
        let denominator =
            if same { self.denominator.clone() } else { &self.denominator * &other.denominator };
        Self { numerators, denominator }
    }

    fn times(&self, other: &Self) -> Self {
        let length = self.numerators.len() + other.numerators.len() - 1;
        let mut numerators = vec![BigInt::zero(); length];
        for (i, x) in self.numerators.iter().enumerate() {
            for (j, y) in other.numerators.iter().enumerate() {
                numerators[i + j] += x * y;
            }
        }
        Self { numerators, denominator: &self.denominator * &other.denominator }
    }
}

/// The exact value of a constant that is a binary fraction, as a sum of doubles.
fn rational(c: &Constant) -> Option<Ratio> {
    let mut rest = c.big.clone();
    let mut sum = Ratio::integer(0);
    while rest.is_point() {
        if rest.contains_zero() {
            return Some(sum);
        }
        let part = rest.nearest();
        if !part.is_finite() || part == 0.0 {
            return None;
        }
        let (n, d) = Point::new(part).parts();
        sum = sum.plus(&Ratio { numerators: vec![n], denominator: d });
        let precision = rest.precision();
        rest = rest - BigInterval::from_f64(part, precision);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_constants_are_sums_of_doubles() {
        // 2^80 + 1 + 2^-40 has 121 bits.
        let parts = [2.0_f64.powi(80), 1.0, 2.0_f64.powi(-40)];
        let big = parts
            .map(|x| BigInterval::from_f64(x, 128))
            .into_iter()
            .reduce(|a, b| a + b)
            .expect("three parts");
        let ratio = rational(&Constant::new(big)).expect("a binary fraction");
        let expected = (BigInt::one() << 120) + (BigInt::one() << 40) + 1;
        let scaled = &ratio.numerators[0] << 40_u32;
        assert_eq!(scaled, expected * &ratio.denominator);
        let third = BigInterval::from_f64(1.0, 128) / BigInterval::from_f64(3.0, 128);
        assert!(rational(&Constant::new(third)).is_none());
    }
}
