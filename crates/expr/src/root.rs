//! The only real root of a polynomial.
//!
//! Sturm's theorem counts the real roots exactly; bisection in exact arithmetic then brackets the
//! root to any precision. Coefficients are rational.

use std::collections::HashMap;

use num_bigint::{BigInt, Sign};
use num_traits::{One, Signed, Zero};

use crate::graph::{Graph, Id, Node};
use crate::prelude::Value;
use crate::rational::{self, Rational};

/// Bits of the longest coefficient times the square of the number of coefficients: the time that
/// counting the roots takes grows with its square.
const MAX_SIZE: u64 = 100_000;

/// Coefficients from the constant upward, the last of them not 0.
type Polynomial = Vec<Rational>;

/// The real root of the polynomial at `id`, whose unknown is x.
///
/// # Errors
/// If it is no polynomial with rational coefficients, too large, or has none or many real roots.
pub(crate) fn only_root(
    graph: &Graph,
    id: Id,
    constants: &HashMap<Id, Value>,
    precision: usize,
) -> Result<Value, String> {
    let p = expand(graph, id, constants)?;
    if p.len() < 2 {
        return Err("does not depend on its unknown".into());
    }
    if let [c, slope] = &p[..] {
        return Ok(Value::Exact(-c / slope));
    }
    let sturm = sturm(&p);
    let changes = |at: Sign| {
        let signs = sturm.iter().map(|q| {
            let leading = q[q.len() - 1].is_negative();
            leading ^ (at == Sign::Minus && q.len().is_multiple_of(2))
        });
        let signs: Vec<bool> = signs.collect();
        signs.windows(2).filter(|s| s[0] != s[1]).count()
    };
    let count = changes(Sign::Minus) - changes(Sign::Plus);
    if count != 1 {
        return Err(format!("has {count} real roots, not one"));
    }
    // Without its multiple factors the polynomial changes its sign at the root.
    let simple = divide(&p, &sturm[sturm.len() - 1]).0;
    Ok(bisect(&integers(&simple), precision))
}

/// The coefficients of a polynomial expression in x.
fn expand(graph: &Graph, root: Id, constants: &HashMap<Id, Value>) -> Result<Polynomial, String> {
    let mut known: HashMap<Id, Polynomial> = HashMap::new();
    for id in graph.postorder(root, |id| match graph.is_constant(id) {
        true => [None, None],
        false => graph.node(id).operands(),
    }) {
        let no_polynomial = || String::from("is no polynomial");
        let p = if graph.is_constant(id) {
            match &constants[&id] {
                Value::Exact(r) => trimmed(vec![r.clone()]),
                Value::Enclosed(_) => {
                    return Err("has a coefficient that may not be rational".into());
                }
            }
        } else {
            match *graph.node(id) {
                Node::Variable(_) => vec![Rational::zero(), Rational::one()],
                Node::Add(a, b) => add(&known[&a], &known[&b]),
                Node::Sub(a, b) => add(&known[&a], &scale(&known[&b], &-Rational::one())),
                Node::Neg(a) => scale(&known[&a], &-Rational::one()),
                Node::Mul(a, b) => multiply(&known[&a], &known[&b])?,
                Node::Power(a, b) => {
                    let n = graph.number(b).and_then(rational::to_integer);
                    let n = n.filter(|n| *n >= 0).ok_or_else(no_polynomial)?;
                    let mut power = vec![Rational::one()];
                    for _ in 0..n {
                        power = multiply(&power, &known[&a])?;
                    }
                    power
                }
                _ => return Err(no_polynomial()),
            }
        };
        check_size(&p)?;
        known.insert(id, p);
    }
    Ok(known.remove(&root).expect("the root is visited last"))
}

fn check_size(p: &Polynomial) -> Result<(), String> {
    let bits = p.iter().map(|c| c.numer().bits().max(c.denom().bits())).max().unwrap_or(0);
    let length = p.len() as u64;
    if bits * length * length > MAX_SIZE {
        return Err(format!(
            "is too large a polynomial: (degree + 1)^2 times the bits of its longest coefficient \
             may be at most {MAX_SIZE}"
        ));
    }
    Ok(())
}

fn trimmed(mut p: Polynomial) -> Polynomial {
    while p.last().is_some_and(Zero::is_zero) {
        p.pop();
    }
    p
}

fn add(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let mut sum = vec![Rational::zero(); a.len().max(b.len())];
    for p in [a, b] {
        for (s, c) in sum.iter_mut().zip(p) {
            *s += c;
        }
    }
    trimmed(sum)
}

fn scale(p: &Polynomial, factor: &Rational) -> Polynomial {
    p.iter().map(|c| c * factor).collect()
}

fn multiply(a: &Polynomial, b: &Polynomial) -> Result<Polynomial, String> {
    let mut product = vec![Rational::zero(); (a.len() + b.len()).saturating_sub(1)];
    for (i, x) in a.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
        for (j, y) in b.iter().enumerate() {
            product[i + j] += x * y;
        }
    }
    let product = trimmed(product);
    check_size(&product)?;
    Ok(product)
}

/// Quotient and remainder.
fn divide(a: &Polynomial, b: &Polynomial) -> (Polynomial, Polynomial) {
    let mut rest = a.clone();
    let mut quotient = vec![Rational::zero(); (a.len() + 1).saturating_sub(b.len())];
    while rest.len() >= b.len() {
        let shift = rest.len() - b.len();
        let factor = &rest[rest.len() - 1] / &b[b.len() - 1];
        for (r, c) in rest[shift..].iter_mut().zip(b) {
            *r -= c * &factor;
        }
        quotient[shift] = factor;
        rest = trimmed(rest);
    }
    (quotient, rest)
}

/// The chain p, p', and the negated remainders, each up to a positive factor.
fn sturm(p: &Polynomial) -> Vec<Polynomial> {
    let slope = p.iter().enumerate().skip(1).map(|(k, c)| c * rational::integer(k)).collect();
    let mut chain = vec![p.clone(), slope];
    loop {
        let [.., a, b] = &chain[..] else { unreachable!("the chain starts with two") };
        let rest = divide(a, b).1;
        if rest.is_empty() {
            return chain;
        }
        let factor = -rest[rest.len() - 1].abs().recip();
        chain.push(scale(&rest, &factor));
    }
}

/// The polynomial times the positive number that makes its coefficients integers.
fn integers(p: &Polynomial) -> Vec<BigInt> {
    let denominator = p.iter().fold(BigInt::one(), |multiple, c| {
        Rational::new(multiple, c.denom().clone()).numer() * c.denom()
    });
    p.iter().map(|c| (c * &denominator).to_integer()).collect()
}

/// The sign at m / 2^k.
fn sign(p: &[BigInt], m: &BigInt, k: u64) -> Sign {
    let terms = p.iter().rev().zip(0_u64..);
    terms.fold(BigInt::ZERO, |sum, (c, i)| sum * m + (c << (k * i))).sign()
}

/// The place where the polynomial changes its sign, between dyadic numbers or exactly.
fn bisect(p: &[BigInt], precision: usize) -> Value {
    let leading = p.last().expect("not zero").bits();
    let longest = p.iter().map(BigInt::bits).max().expect("not empty");
    // Cauchy: a root is below 1 + max |c_i| / |c_n|.
    let mut lo = -(BigInt::one() << (longest + 2 - leading));
    let mut hi = -lo.clone();
    let mut k = 0;
    let below = sign(p, &lo, k);
    loop {
        // The bracket is [lo, hi] / 2^k; its width in units stays the same.
        let middle: BigInt = &lo + &hi;
        (lo, hi, k) = (lo << 1, hi << 1, k + 1);
        match sign(p, &middle, k) {
            Sign::NoSign => return Value::Exact(Rational::new(middle, BigInt::one() << k)),
            s if s == below => lo = middle,
            _ => hi = middle,
        }
        // Far below the last place that is kept, so that the hull is as tight as it can be.
        let width = (&hi - &lo).bits();
        if lo.abs().min(hi.abs()).bits() > width + precision as u64 + 64 {
            let ends = [lo, hi]
                .map(|m| rational::enclose(&Rational::new(m, BigInt::one() << k), precision));
            return Value::Enclosed(ends[0].hull(&ends[1]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root(coefficients: &[i64]) -> Result<Value, String> {
        let mut graph = Graph::new();
        let mut sum = graph.constant(rational::integer(0));
        let mut constants = HashMap::new();
        for (k, &c) in coefficients.iter().enumerate() {
            let [c, k] = [c, k as i64].map(|n| graph.constant(rational::integer(n)));
            let power = graph.power(0, k);
            let term = graph.mul(c, power);
            sum = graph.add(sum, term);
        }
        for id in 0..graph.len() as Id {
            if let Some(r) = graph.number(id) {
                constants.insert(id, Value::Exact(r.clone()));
            }
        }
        only_root(&graph, sum, &constants, 256)
    }

    #[test]
    fn roots_are_bracketed_tightly() {
        let Ok(Value::Enclosed(cube)) = root(&[-2, 0, 0, 1]) else { panic!("irrational") };
        let [lo, hi] = cube.to_f64();
        assert!(lo < hi && hi == lo.next_up() && lo <= 2_f64.cbrt() && 2_f64.cbrt() <= hi);
        assert!(cube.width() < 1e-76);
    }

    #[test]
    fn rational_roots_are_exact() {
        for (coefficients, n, d) in
            [(&[-1, 3][..], 1, 3), (&[-1, 2, -1, 2], 1, 2), (&[1, 2, 1], -1, 1), (&[0, 0, 1], 0, 1)]
        {
            let exact = Rational::new(n.into(), d.into());
            assert_eq!(root(coefficients).unwrap().exact(), Some(&exact));
        }
    }

    #[test]
    fn other_polynomials_are_refused() {
        for coefficients in [&[1, 0, 1][..], &[-2, 0, 1], &[5], &[0, -1, 0, 1]] {
            assert!(root(coefficients).is_err());
        }
    }
}
