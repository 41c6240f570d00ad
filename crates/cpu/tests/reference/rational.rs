//! Polynomials over the rationals and Sturm's theorem, written apart from the method under test.

use std::ops::{Add, Mul, Sub};

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use zeroset_raycast::{Domain, Ray};

pub(crate) type Q = BigRational;

/// The exact value of a double.
pub(crate) fn exact(x: f64) -> Q {
    Q::from_float(x).expect("finite")
}

pub(crate) fn fraction(n: i64, d: i64) -> Q {
    Q::new(BigInt::from(n), BigInt::from(d))
}

/// Coefficients, constant first, without leading zeros.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Poly(pub(crate) Vec<Q>);

fn trimmed(mut c: Vec<Q>) -> Poly {
    while c.last().is_some_and(Zero::is_zero) {
        c.pop();
    }
    Poly(c)
}

impl Poly {
    pub(crate) fn number(q: Q) -> Self {
        trimmed(vec![q])
    }

    pub(crate) fn integer(n: i64) -> Self {
        Self::number(fraction(n, 1))
    }

    /// `x, y, z` along a ray.
    pub(crate) fn ray(ray: Ray) -> [Self; 3] {
        [0, 1, 2].map(|i| {
            let [o, d] = [ray.origin[i], ray.direction[i]].map(|x| exact(f64::from(x)));
            trimmed(vec![o, d])
        })
    }

    pub(crate) fn pow(&self, n: u32) -> Self {
        (0..n).fold(Self::integer(1), |p, _| &p * self)
    }

    pub(crate) fn times(&self, n: i64) -> Self {
        self * &Self::integer(n)
    }

    pub(crate) fn at(&self, t: &Q) -> Q {
        self.0.iter().rev().fold(Q::zero(), |v, c| v * t + c)
    }

    fn derivative(&self) -> Self {
        trimmed(self.0.iter().enumerate().skip(1).map(|(k, c)| c * fraction(k as i64, 1)).collect())
    }

    /// Quotient and remainder.
    fn divide(&self, d: &Self) -> (Self, Self) {
        let mut rest = self.clone();
        let mut quotient = Vec::new();
        while !rest.0.is_empty() && rest.0.len() >= d.0.len() {
            let factor = rest.0.last().expect("not 0") / d.0.last().expect("not 0");
            let shift = rest.0.len() - d.0.len();
            quotient.resize(quotient.len().max(shift + 1), Q::zero());
            let mut product = vec![Q::zero(); shift];
            product.extend(d.0.iter().map(|c| c * &factor));
            quotient[shift] = factor;
            rest = &rest - &Self(product);
        }
        (trimmed(quotient), rest)
    }

    /// Scaled to a leading coefficient of 1 or -1, so that coefficients stay short.
    fn normal(self) -> Self {
        match self.0.last() {
            None => self,
            Some(lead) => {
                let lead = lead.abs();
                Self(self.0.iter().map(|c| c / &lead).collect())
            }
        }
    }
}

impl Add for &Poly {
    type Output = Poly;
    fn add(self, o: Self) -> Poly {
        let n = self.0.len().max(o.0.len());
        let get = |p: &Poly, i: usize| p.0.get(i).cloned().unwrap_or_else(Q::zero);
        trimmed((0..n).map(|i| get(self, i) + get(o, i)).collect())
    }
}

impl Sub for &Poly {
    type Output = Poly;
    fn sub(self, o: Self) -> Poly {
        self + &o.times(-1)
    }
}

impl Mul for &Poly {
    type Output = Poly;
    fn mul(self, o: Self) -> Poly {
        if self.0.is_empty() || o.0.is_empty() {
            return Poly(vec![]);
        }
        let mut c = vec![Q::zero(); self.0.len() + o.0.len() - 1];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in o.0.iter().enumerate() {
                c[i + j] += a * b;
            }
        }
        trimmed(c)
    }
}

/// The real roots of a polynomial that is not 0, and of its part with multiple roots.
pub(crate) struct Roots {
    simple: Vec<Poly>,
    multiple: Vec<Poly>,
}

fn chain(p: &Poly) -> Vec<Poly> {
    let mut chain = vec![p.clone(), p.derivative()];
    while let [.., a, b] = &chain[..] {
        if b.0.is_empty() {
            chain.pop();
            break;
        }
        let next = a.divide(b).1.times(-1).normal();
        chain.push(next);
    }
    chain
}

/// The distinct roots in `[a, b]`.
fn count(chain: &[Poly], a: &Q, b: &Q) -> usize {
    if a > b {
        return 0;
    }
    let changes = |t: &Q| {
        let signs: Vec<_> = chain.iter().map(|p| p.at(t)).filter(|v| !v.is_zero()).collect();
        signs.windows(2).filter(|w| w[0].is_positive() != w[1].is_positive()).count()
    };
    changes(a) - changes(b) + usize::from(chain[0].at(a).is_zero())
}

impl Roots {
    pub(crate) fn new(p: &Poly) -> Self {
        let (mut g, mut h) = (p.clone().normal(), p.derivative().normal());
        while !h.0.is_empty() {
            (g, h) = (h.clone(), g.divide(&h).1.normal());
        }
        let free = p.divide(&g).0.normal();
        // Roots of g with their own multiplicity removed: what free and g share.
        let (mut a, mut b) = (free.clone(), g);
        while !b.0.is_empty() {
            (a, b) = (b.clone(), a.divide(&b).1.normal());
        }
        Self { simple: chain(&free), multiple: chain(&a) }
    }

    /// Distinct roots in `[a, b]`.
    pub(crate) fn within(&self, a: &Q, b: &Q) -> usize {
        count(&self.simple, a, b)
    }

    /// Distinct multiple roots in `[a, b]`.
    pub(crate) fn multiple_within(&self, a: &Q, b: &Q) -> usize {
        count(&self.multiple, a, b)
    }
}

/// The part of a ray in a box, exactly.
pub(crate) fn clip(domain: &Domain, ray: Ray, range: [f64; 2]) -> Option<[Q; 2]> {
    assert!(domain.ball.is_none());
    let mut lo = exact(range[0]);
    let mut hi = (range[1] < f64::INFINITY).then(|| exact(range[1]));
    for axis in 0..3 {
        let [o, d] = [ray.origin[axis], ray.direction[axis]].map(|x| exact(f64::from(x)));
        let [min, max] = [domain.min[axis], domain.max[axis]].map(exact);
        if d.is_zero() {
            if o < min || o > max {
                return None;
            }
            continue;
        }
        let (mut enter, mut leave) = ((min - &o) / &d, (max - &o) / &d);
        if enter > leave {
            (enter, leave) = (leave, enter);
        }
        lo = lo.max(enter);
        hi = Some(match hi {
            Some(h) => h.min(leave),
            None => leave,
        });
    }
    let hi = hi.expect("a ray has a direction");
    (lo <= hi).then_some([lo, hi])
}

#[test]
fn sturm_counts_what_was_multiplied() {
    // (t - 1/3)^2 (t - 1/2) (t^2 + 1)
    let root = |n, d| trimmed(vec![-fraction(n, d), Q::one()]);
    let p = &(&root(1, 3).pow(2) * &root(1, 2)) * &trimmed(vec![Q::one(), Q::zero(), Q::one()]);
    let roots = Roots::new(&p);
    let q = fraction;
    assert_eq!(roots.within(&q(-9, 1), &q(9, 1)), 2);
    assert_eq!(roots.within(&q(1, 3), &q(1, 3)), 1);
    assert_eq!(roots.within(&q(34, 100), &q(49, 100)), 0);
    assert_eq!(roots.multiple_within(&q(-9, 1), &q(9, 1)), 1);
    assert_eq!(roots.multiple_within(&q(2, 5), &q(9, 1)), 0);
}
