//! The roots of a t^2 + 2 b t + c on a ray, in rational arithmetic: nothing is rounded.

use std::cmp::Ordering::{self, Equal, Greater, Less};

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use zeroset_bench::{Class, Truth};
use zeroset_raycast::{Certificate, Domain, Hit, Ray};

pub(crate) type Q = BigRational;

/// The exact value of a float.
pub(crate) fn exact(x: f64) -> Q {
    Q::from_float(x).expect("a finite number")
}

/// `10^n`.
pub(crate) fn power_of_ten(n: i32) -> Q {
    Q::from_integer(BigInt::from(10)).pow(n)
}

fn components(v: glam::Vec3) -> [Q; 3] {
    v.to_array().map(|x| exact(x.into()))
}

/// A surface with a closed form.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// |p - centre| = radius.
    Sphere { centre: [Q; 3], radius: Q },
    /// normal . p = offset.
    Plane { normal: [Q; 3], offset: Q },
}

/// a t^2 + 2 b t + c, not constant, and the part of the ray where roots count.
pub(crate) struct Roots {
    a: Q,
    b: Q,
    c: Q,
    /// Closed; the end may be open to infinity.
    range: (Q, Option<Q>),
}

impl Shape {
    /// The roots on a valid ray for t >= 0 in the domain's box; none if all or no t are roots, or no t
    /// is in the box.
    pub(crate) fn roots(&self, ray: Ray, domain: &Domain) -> Option<Roots> {
        let (o, d) = (components(ray.origin), components(ray.direction));
        let dot = |x: &[Q; 3], y: &[Q; 3]| -> Q { x.iter().zip(y).map(|(x, y)| x * y).sum() };
        let (a, b, c) = match self {
            Self::Sphere { centre, radius } => {
                let m: Vec<Q> = o.iter().zip(centre).map(|(o, c)| o - c).collect();
                let m: [Q; 3] = m.try_into().expect("three of them");
                (dot(&d, &d), dot(&m, &d), dot(&m, &m) - radius * radius)
            }
            Self::Plane { normal, offset } => {
                let half = dot(normal, &d) / exact(2.0);
                (Q::zero(), half, dot(normal, &o) - offset)
            }
        };
        if a.is_zero() && b.is_zero() {
            return None;
        }
        let mut range = (Q::zero(), None);
        for k in 0..3 {
            let (min, max) = (exact(domain.min[k]), exact(domain.max[k]));
            if d[k].is_zero() {
                if o[k] < min || max < o[k] {
                    return None;
                }
                continue;
            }
            let (near, far) = ((min - &o[k]) / &d[k], (max - &o[k]) / &d[k]);
            let (near, far) = if near < far { (near, far) } else { (far, near) };
            range.0 = range.0.max(near);
            range.1 = Some(range.1.map_or(far.clone(), |end: Q| end.min(far)));
        }
        Some(Roots { a, b, c, range })
    }
}

impl Roots {
    /// Where the first or second root (0 or 1) lies with respect to s; none if there is no such root.
    fn compare(&self, root: usize, s: &Q) -> Option<Ordering> {
        let Self { a, b, c, .. } = self;
        if a.is_zero() {
            return (root == 0).then(|| (-c / (exact(2.0) * b)).cmp(s));
        }
        if b * b < a * c {
            return None;
        }
        let (value, vertex) = ((a * s + exact(2.0) * b) * s + c, -b / a);
        Some(match (root, s.cmp(&vertex)) {
            // Between the roots.
            _ if value.is_negative() => [Less, Greater][root],
            (_, Equal) if value.is_zero() => Equal,
            (0, Less) | (1, Greater) if value.is_zero() => Equal,
            (_, Less) => Greater,
            (_, _) => Less,
        })
    }

    /// Is there a root that counts in the closed range from `lo` to `hi`, or before `hi` if that is open?
    fn has(&self, lo: Option<&Q>, hi: Option<&Q>, is_open: bool) -> bool {
        let (from, to) = (&self.range.0, self.range.1.as_ref());
        (0..2).any(|root| {
            let after = |s: &Q| self.compare(root, s).is_some_and(|o| o != Less);
            let before = |s: &Q| self.compare(root, s).is_some_and(|o| o != Greater);
            let is_there = self.compare(root, from).is_some();
            is_there
                && after(from)
                && to.is_none_or(before)
                && lo.is_none_or(after)
                && hi.is_none_or(|hi| before(hi) && !(is_open && after(hi)))
        })
    }

    /// Is there any root that counts?
    pub(crate) fn exist(&self) -> bool {
        self.has(None, None, false)
    }

    /// What an answer claims and is not so, if anything.
    pub(crate) fn contradiction(&self, hit: Hit) -> Option<&'static str> {
        let claims = |bit| hit.certificate.contains(bit);
        if !hit.certificate.is_hit() {
            return (claims(Certificate::FIRST) && self.exist()).then_some("there is a root");
        }
        let [lo, hi] = hit.bracket.map(exact);
        if claims(Certificate::ROOT) && !self.has(Some(&lo), Some(&hi), false) {
            return Some("there is no root in the bracket");
        }
        let is_late = claims(Certificate::FIRST) && self.has(None, Some(&lo), true);
        is_late.then_some("there is a root before the bracket")
    }

    /// What a truth of the reference claims and is not so, if anything.
    pub(crate) fn contradicts(&self, truth: Truth) -> Option<&'static str> {
        let hit = |certificate| Hit { bracket: truth.bracket, certificate, work: truth.work };
        match truth.class {
            Class::None => self.exist().then_some("there is a root"),
            // Without a bracket nothing is claimed.
            Class::Undecidable if truth.bracket[0] == f64::INFINITY => None,
            _ => self.contradiction(hit(truth.certificate())),
        }
    }
}
