//! Answers: brackets on rays, and what was proved about them.

use std::fmt;
use std::ops::{AddAssign, BitOr};

use glam::Vec3;

/// What is known of an answer: three independent bits.
///
/// | bits | name | meaning |
/// |---|---|---|
/// | HIT, FIRST, ROOT | `proven-hit` | the bracket holds a root and nothing before it is one |
/// | HIT, FIRST | `possible-hit` | there is no root before the bracket; it may hold none |
/// | HIT, ROOT | `root-hit` | the bracket holds a root; an earlier one may have been missed |
/// | HIT | `hit` | something was found, nothing proved |
/// | FIRST | `proven-miss` | there is no root in the whole range |
/// | none | `miss` | nothing was found, nothing proved |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Certificate(u8);

impl Certificate {
    /// Something was found.
    pub const HIT: Self = Self(1);
    /// Nothing before the bracket, or nothing at all without [`HIT`](Self::HIT), is proven.
    pub const FIRST: Self = Self(2);
    /// A root in the bracket is proven.
    pub const ROOT: Self = Self(4);
    /// HIT, FIRST and ROOT.
    pub const PROVEN_HIT: Self = Self(7);
    /// HIT and FIRST.
    pub const POSSIBLE_HIT: Self = Self(3);
    /// HIT and ROOT.
    pub const ROOT_HIT: Self = Self(5);
    /// FIRST alone.
    pub const PROVEN_MISS: Self = Self(2);
    /// No bit.
    pub const MISS: Self = Self(0);

    /// The six meaningful values, strongest first.
    pub const ALL: [Self; 6] = [
        Self::PROVEN_HIT,
        Self::POSSIBLE_HIT,
        Self::ROOT_HIT,
        Self::HIT,
        Self::PROVEN_MISS,
        Self::MISS,
    ];

    /// Are all bits of `other` set?
    pub fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// What is left without the bits of `other`.
    #[must_use]
    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Was something found?
    pub fn is_hit(self) -> bool {
        self.contains(Self::HIT)
    }

    /// The name, as printed.
    pub fn name(self) -> &'static str {
        match self {
            Self::PROVEN_HIT => "proven-hit",
            Self::POSSIBLE_HIT => "possible-hit",
            Self::ROOT_HIT => "root-hit",
            Self::HIT => "hit",
            Self::PROVEN_MISS => "proven-miss",
            _ => "miss",
        }
    }

    /// The bits as a number: HIT 1, FIRST 2, ROOT 4.
    pub fn bits(self) -> u8 {
        self.0
    }
}

impl BitOr for Certificate {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl fmt::Display for Certificate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Evaluations by kind. One evaluation of a packet counts once for each active ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Function values at points.
    pub points: u64,
    /// Values with derivatives.
    pub gradients: u64,
    /// Interval enclosures.
    pub intervals: u64,
    /// Evaluations that gave NaN or infinity, and rays that are no rays.
    pub nonfinite: u64,
}

impl AddAssign for Work {
    fn add_assign(&mut self, o: Self) {
        self.points += o.points;
        self.gradients += o.gradients;
        self.intervals += o.intervals;
        self.nonfinite += o.nonfinite;
    }
}

/// The answer for one ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Closed range of t that holds what was found; `[inf, inf]` for a miss.
    pub bracket: [f64; 2],
    /// What is known of it.
    pub certificate: Certificate,
    /// What it cost.
    pub work: Work,
}

impl Hit {
    /// A miss of the given certificate.
    pub fn miss(certificate: Certificate, work: Work) -> Self {
        Self { bracket: [f64::INFINITY; 2], certificate, work }
    }

    /// The middle of the bracket.
    pub fn t(&self) -> f64 {
        let [lo, hi] = self.bracket;
        lo.midpoint(hi)
    }
}

/// What a caller wants to know; a method computes nothing else.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Request {
    /// The first root.
    #[default]
    First,
    /// The first root and the unit normal there.
    FirstWithNormal,
    /// Whether there is any root: brackets need not be the first, nor narrow. For shadow rays.
    Any,
}

impl Request {
    /// The name, as in records.
    pub fn name(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::FirstWithNormal => "first-with-normal",
            Self::Any => "any",
        }
    }
}

/// The answers for a set of rays, in the order of the rays.
#[derive(Clone, Debug)]
pub struct Hits {
    /// What was asked for.
    pub request: Request,
    /// Closed ranges of t; `[inf, inf]` for a miss.
    pub bracket: Vec<[f64; 2]>,
    /// What is known of each.
    pub certificate: Vec<Certificate>,
    /// The unit normal, along the function's gradient; zero for a miss, or where there is none.
    /// Empty unless asked for.
    pub normal: Vec<Vec3>,
    /// What each answer cost. Empty if not asked for.
    pub work: Vec<Work>,
}

impl Hits {
    /// Room for the answers to `rays` rays.
    pub fn new(request: Request, rays: usize) -> Self {
        let normals = if request == Request::FirstWithNormal { rays } else { 0 };
        Self {
            request,
            bracket: vec![[f64::INFINITY; 2]; rays],
            certificate: vec![Certificate::MISS; rays],
            normal: vec![Vec3::ZERO; normals],
            work: vec![Work::default(); rays],
        }
    }

    /// The same without room for what each answer cost: a third of the memory, where the
    /// [report](crate::Report)'s sum is enough.
    pub fn without_work(request: Request, rays: usize) -> Self {
        Self { work: Vec::new(), ..Self::new(request, rays) }
    }

    /// How many answers.
    pub fn len(&self) -> usize {
        self.bracket.len()
    }

    /// Are there none?
    pub fn is_empty(&self) -> bool {
        self.bracket.is_empty()
    }

    /// Stores an answer.
    pub fn set(&mut self, index: usize, hit: Hit) {
        self.bracket[index] = hit.bracket;
        self.certificate[index] = hit.certificate;
        if let Some(work) = self.work.get_mut(index) {
            *work = hit.work;
        }
    }

    /// An answer, without its normal. No work, if that was not asked for.
    pub fn get(&self, index: usize) -> Hit {
        Hit {
            bracket: self.bracket[index],
            certificate: self.certificate[index],
            work: self.work.get(index).copied().unwrap_or_default(),
        }
    }

    /// The work of all answers, if it was asked for.
    pub fn total_work(&self) -> Work {
        let mut total = Work::default();
        self.work.iter().for_each(|w| total += *w);
        total
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn certificates_are_three_independent_bits() {
        let names: Vec<_> = Certificate::ALL.iter().map(|c| c.name()).collect();
        let expected = ["proven-hit", "possible-hit", "root-hit", "hit", "proven-miss", "miss"];
        assert_eq!(names, expected);
        let (hit, first, root) = (Certificate::HIT, Certificate::FIRST, Certificate::ROOT);
        assert_eq!(hit | first | root, Certificate::PROVEN_HIT);
        assert_eq!(hit | first, Certificate::POSSIBLE_HIT);
        assert_eq!(hit | root, Certificate::ROOT_HIT);
        assert_eq!(first, Certificate::PROVEN_MISS);
        assert_eq!(Certificate::PROVEN_HIT.without(first), Certificate::ROOT_HIT);
        assert_eq!(Certificate::HIT.without(first), Certificate::HIT);
        for certificate in Certificate::ALL {
            assert_eq!(certificate.is_hit(), certificate.name().ends_with("hit"));
            assert_eq!(certificate | Certificate::MISS, certificate);
            assert!(Certificate::PROVEN_HIT.contains(certificate));
            // No miss claims a root.
            assert!(certificate.is_hit() || !certificate.contains(root));
        }
        assert_eq!(format!("{:>12}", Certificate::HIT), "         hit");
    }

    #[test]
    fn a_hit_is_in_the_middle_of_its_bracket() {
        let hit = |lo: f64, hi: f64| Hit {
            bracket: [lo, hi],
            certificate: Certificate::HIT,
            work: Work::default(),
        };
        for [lo, hi] in [[1.0, 1.0], [1.0, 1.0_f64.next_up()], [5e-324, 1e-323], [1e308, 1.7e308]] {
            let t = hit(lo, hi).t();
            assert!(lo <= t && t <= hi, "{t} in [{lo}, {hi}]");
        }
        assert_eq!(Hit::miss(Certificate::PROVEN_MISS, Work::default()).t(), f64::INFINITY);
    }

    #[test]
    fn answers_are_kept_in_order() {
        for (request, normals) in
            [(Request::First, 0), (Request::FirstWithNormal, 3), (Request::Any, 0)]
        {
            let mut hits = Hits::new(request, 3);
            assert_eq!((hits.len(), hits.normal.len(), hits.is_empty()), (3, normals, false));
            assert_eq!(hits.get(0), Hit::miss(Certificate::MISS, Work::default()));
            let work = Work { points: 1, gradients: 2, intervals: 3, nonfinite: 4 };
            let hit = Hit { bracket: [1.0, 2.0], certificate: Certificate::ROOT_HIT, work };
            hits.set(1, hit);
            hits.set(2, Hit { bracket: [3.0, 4.0], ..hit });
            assert_eq!(hits.get(1), hit);
            let total = Work { points: 2, gradients: 4, intervals: 6, nonfinite: 8 };
            assert_eq!(hits.total_work(), total);
        }
    }
}
