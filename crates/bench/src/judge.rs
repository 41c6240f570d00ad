//! Answers judged against the truth.

use std::fmt;

use zeroset_raycast::{Certificate, Hit, Hits, Rays};

use crate::{Class, Truth, Truths};

/// What an answer is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// A hit within the tolerance of the first root.
    CorrectHit,
    /// No root, no hit.
    CorrectMiss,
    /// There is a root, but the answer is a miss.
    FalseMiss,
    /// There is no root, or none so early, but the answer is a hit.
    FalseHit,
    /// A hit further from the first root than the tolerance.
    WrongSheet,
    /// The truth is not known.
    Undecided,
    /// The ray was not judged.
    NotSampled,
}

/// A certificate that the truth contradicts: the worst fault a method can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Lie {
    /// `proven-miss`, but there is a root.
    RootMissed,
    /// FIRST is set, but a root lies before the bracket.
    RootBefore,
    /// ROOT is set, but the bracket holds none.
    NoRoot,
}

/// How far from the first root a hit may lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// The width of a pixel at the root; only for views.
    Footprint,
    /// A distance in units of space.
    Distance(f64),
}

/// The verdicts on a set of answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// One a ray.
    pub verdict: Vec<Verdict>,
    /// From the first root to the middle of the bracket, along the ray, in units of space; positive
    /// where the answer lies behind the root. NaN but for [`Verdict::CorrectHit`] and
    /// [`Verdict::WrongSheet`].
    pub dt: Vec<f64>,
    /// The rays whose certificates lie, and how.
    pub lies: Vec<(usize, Lie)>,
    /// All of this counted.
    pub tally: Tally,
}

/// Verdicts counted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// How many answers were judged.
    pub judged: usize,
    /// Counts by class of truth and verdict, in the order of [`Class::ALL`] and [`Verdict::ALL`].
    pub table: [[usize; 6]; 4],
    /// How many pixels are clear misses: no root there, nor in any of the eight neighbours. `None`
    /// where only a sample was judged, and for batches.
    pub clear_misses: Option<usize>,
    /// False hits among them.
    pub clear_false_hits: Option<usize>,
    /// Lies.
    pub lies: usize,
    /// Median of |dt| over correct hits and wrong sheets.
    pub median_dt: Option<f64>,
    /// Greatest |dt| over correct hits and wrong sheets.
    pub worst_dt: Option<f64>,
}

/// The verdict on one answer, and its dt. The direction of its ray has the length `speed`; the
/// tolerance is a distance in units of space.
pub fn verdict(hit: Hit, truth: Truth, speed: f64, tolerance: f64) -> (Verdict, f64) {
    let found = hit.certificate.is_hit();
    let verdict = match truth.class {
        Class::None if found => Verdict::FalseHit,
        Class::None => Verdict::CorrectMiss,
        // Nothing before the truth's bracket is a root; more is not known.
        Class::Undecidable if found && hit.bracket[1] < truth.bracket[0] => Verdict::FalseHit,
        Class::Undecidable => Verdict::Undecided,
        Class::Transversal | Class::Tangential if !found => Verdict::FalseMiss,
        Class::Transversal | Class::Tangential => {
            let dt = (hit.t() - middle(truth.bracket)) * speed;
            // A bracket of NaN or without end is as far off as can be.
            let dt = if dt.is_nan() { f64::INFINITY } else { dt };
            let near = dt.abs() <= tolerance;
            return (if near { Verdict::CorrectHit } else { Verdict::WrongSheet }, dt);
        }
    };
    (verdict, f64::NAN)
}

/// The claim of a certificate that the truth contradicts, if any.
///
/// Only what is proven contradicts: with \[a, b\] the truth's bracket and \[lo, hi\] the answer's, a
/// first root is in \[a, b\] and none is before a. So FIRST lies if b < lo, and ROOT lies if hi < a, or for a
/// pixel if hi lies before the first root of any of its rays; a later root may well be in the answer's
/// bracket. Brackets are closed, comparisons exact.
pub fn lie(hit: Hit, truth: Truth) -> Option<Lie> {
    let claims = |bit| hit.certificate.contains(bit);
    let [lo, hi] = hit.bracket;
    let b = truth.bracket[1];
    let has_root = matches!(truth.class, Class::Transversal | Class::Tangential);
    if !hit.certificate.is_hit() {
        return (claims(Certificate::FIRST) && has_root).then_some(Lie::RootMissed);
    }
    let is_empty = !(lo <= hi);
    if claims(Certificate::ROOT) && (is_empty || truth.class == Class::None || hi < truth.latest) {
        return Some(Lie::NoRoot);
    }
    (claims(Certificate::FIRST) && has_root && b < lo).then_some(Lie::RootBefore)
}

/// Judges the answers to `rays`.
///
/// # Panics
/// If `hits` or `truths` are not for as many rays, or for [`Tolerance::Footprint`] with a batch.
pub fn judge(rays: Rays<'_>, hits: &Hits, truths: &Truths, tolerance: Tolerance) -> Judgement {
    assert_eq!(rays.len(), hits.len(), "one answer a ray");
    assert_eq!(rays.len(), truths.sample.rays, "the truths are those of other rays");
    let mut judgement = Judgement {
        verdict: vec![Verdict::NotSampled; rays.len()],
        dt: vec![f64::NAN; rays.len()],
        lies: Vec::new(),
        tally: Tally::default(),
    };
    let tally = &mut judgement.tally;
    for (&index, &truth) in truths.sample.indices.iter().zip(&truths.truths) {
        let hit = hits.get(index);
        let tolerance = match (tolerance, rays) {
            (Tolerance::Distance(distance), _) => distance,
            (Tolerance::Footprint, Rays::View(view)) => view.footprint(middle(truth.bracket)),
            (Tolerance::Footprint, Rays::Batch(_)) => panic!("the rays of a batch have no pixels"),
        };
        let speed = rays.get(index).direction.as_dvec3().length();
        let (verdict, dt) = verdict(hit, truth, speed, tolerance);
        judgement.verdict[index] = verdict;
        judgement.dt[index] = dt;
        judgement.lies.extend(lie(hit, truth).map(|lie| (index, lie)));
        tally.judged += 1;
        tally.table[truth.class as usize][verdict as usize] += 1;
    }
    tally.lies = judgement.lies.len();
    if let Some(clear) = truths.clear_misses(rays) {
        let is_false = |i: &&usize| judgement.verdict[**i] == Verdict::FalseHit;
        tally.clear_false_hits = Some(clear.iter().filter(is_false).count());
        tally.clear_misses = Some(clear.len());
    }
    let mut distances: Vec<f64> =
        judgement.dt.iter().filter(|dt| !dt.is_nan()).map(|dt| dt.abs()).collect();
    distances.sort_by(f64::total_cmp);
    let n = distances.len();
    tally.median_dt = (n > 0).then(|| middle([distances[(n - 1) / 2], distances[n / 2]]));
    tally.worst_dt = distances.last().copied();
    judgement
}

fn middle([a, b]: [f64; 2]) -> f64 {
    if a == b { a } else { 0.5 * (a + b) }
}

impl Tally {
    /// Answers of a verdict over all classes of truth.
    ///
    /// # Panics
    /// For [`Verdict::NotSampled`].
    pub fn count(&self, verdict: Verdict) -> usize {
        self.table.iter().map(|row| row[verdict as usize]).sum()
    }

    /// Answers of a verdict for a class of truth.
    ///
    /// # Panics
    /// For [`Verdict::NotSampled`].
    pub fn count_in(&self, class: Class, verdict: Verdict) -> usize {
        self.table[class as usize][verdict as usize]
    }

    /// Judged rays of a class of truth.
    pub fn class(&self, class: Class) -> usize {
        self.table[class as usize].iter().sum()
    }
}

impl Verdict {
    /// The verdicts on judged answers.
    pub const ALL: [Self; 6] = [
        Self::CorrectHit,
        Self::CorrectMiss,
        Self::FalseMiss,
        Self::FalseHit,
        Self::WrongSheet,
        Self::Undecided,
    ];

    /// The name, as printed.
    pub fn name(self) -> &'static str {
        match self {
            Self::CorrectHit => "correct-hit",
            Self::CorrectMiss => "correct-miss",
            Self::FalseMiss => "false-miss",
            Self::FalseHit => "false-hit",
            Self::WrongSheet => "wrong-sheet",
            Self::Undecided => "undecided",
            Self::NotSampled => "not-sampled",
        }
    }
}

impl Lie {
    /// What is wrong.
    pub fn name(self) -> &'static str {
        match self {
            Self::RootMissed => "proven miss, but there is a root",
            Self::RootBefore => "proven first, but a root lies before",
            Self::NoRoot => "proven root, but there is none in the bracket",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl fmt::Display for Lie {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use zeroset_raycast::{Ray, RayBatch, Request, Work};

    use crate::Sample;

    const NO_WORK: Work = Work { points: 0, gradients: 0, intervals: 0, nonfinite: 0 };
    const NONE: Truth = truth(Class::None, [f64::INFINITY; 2]);
    const ROOT: Truth = truth(Class::Transversal, [2.0, 2.5]);
    const TOUCH: Truth = truth(Class::Tangential, [2.0, 2.5]);
    const UNKNOWN: Truth = truth(Class::Undecidable, [2.0, 2.5]);

    const fn truth(class: Class, bracket: [f64; 2]) -> Truth {
        Truth::new(class, bracket, NO_WORK)
    }

    fn hit(certificate: Certificate, lo: f64, hi: f64) -> Hit {
        Hit { bracket: [lo, hi], certificate, work: Work::default() }
    }

    fn miss(certificate: Certificate) -> Hit {
        Hit::miss(certificate, Work::default())
    }

    /// The lies told with each certificate for brackets before, touching, in, around, touching from
    /// behind, and behind the truth's bracket [2, 2.5].
    fn lies(certificate: Certificate, truth: Truth) -> [Option<Lie>; 6] {
        let brackets = [[0.0, 1.9], [0.0, 2.0], [2.1, 2.2], [1.0, 3.0], [2.5, 3.0], [2.6, 3.0]];
        brackets.map(|[lo, hi]| lie(hit(certificate, lo, hi), truth))
    }

    #[test]
    fn only_contradicted_claims_are_lies_where_there_is_a_root() {
        let (before, no_root) = (Some(Lie::RootBefore), Some(Lie::NoRoot));
        for truth in [ROOT, TOUCH] {
            let proven = lies(Certificate::PROVEN_HIT, truth);
            assert_eq!(proven, [no_root, None, None, None, None, before]);
            let possible = lies(Certificate::POSSIBLE_HIT, truth);
            assert_eq!(possible, [None, None, None, None, None, before]);
            // A later root may be in the bracket: nothing denies it.
            let root = lies(Certificate::ROOT_HIT, truth);
            assert_eq!(root, [no_root, None, None, None, None, None]);
            assert_eq!(lies(Certificate::HIT, truth), [None; 6]);
            assert_eq!(lie(miss(Certificate::PROVEN_MISS), truth), Some(Lie::RootMissed));
            assert_eq!(lie(miss(Certificate::MISS), truth), None);
        }
    }

    #[test]
    fn without_a_root_every_claimed_root_is_a_lie() {
        assert_eq!(lies(Certificate::PROVEN_HIT, NONE), [Some(Lie::NoRoot); 6]);
        assert_eq!(lies(Certificate::ROOT_HIT, NONE), [Some(Lie::NoRoot); 6]);
        assert_eq!(lies(Certificate::POSSIBLE_HIT, NONE), [None; 6]);
        assert_eq!(lies(Certificate::HIT, NONE), [None; 6]);
        assert_eq!(lie(miss(Certificate::PROVEN_MISS), NONE), None);
        // Even a bracket that never ends.
        let endless = hit(Certificate::ROOT_HIT, 0.0, f64::INFINITY);
        assert_eq!(lie(endless, NONE), Some(Lie::NoRoot));
    }

    #[test]
    fn a_root_that_one_ray_of_a_pixel_lacks_is_a_lie() {
        let no_root = Some(Lie::NoRoot);
        let pixel = Truth { latest: 2.3, ..ROOT };
        let before = Some(Lie::RootBefore);
        let proven = lies(Certificate::PROVEN_HIT, pixel);
        assert_eq!(proven, [no_root, no_root, no_root, None, None, before]);
        assert_eq!(lies(Certificate::POSSIBLE_HIT, pixel), [None, None, None, None, None, before]);
        let hole = Truth { latest: f64::INFINITY, ..ROOT };
        assert_eq!(lies(Certificate::PROVEN_HIT, hole), [no_root; 6]);
        assert_eq!(lie(miss(Certificate::PROVEN_MISS), hole), Some(Lie::RootMissed));
    }

    #[test]
    fn an_undecided_truth_contradicts_only_in_its_proven_part() {
        let no_root = Some(Lie::NoRoot);
        let early = [no_root, None, None, None, None, None];
        assert_eq!(lies(Certificate::PROVEN_HIT, UNKNOWN), early);
        assert_eq!(lies(Certificate::ROOT_HIT, UNKNOWN), early);
        assert_eq!(lies(Certificate::POSSIBLE_HIT, UNKNOWN), [None; 6]);
        assert_eq!(lie(miss(Certificate::PROVEN_MISS), UNKNOWN), None);
        assert_eq!(lie(miss(Certificate::MISS), UNKNOWN), None);
    }

    #[test]
    fn an_empty_bracket_holds_no_root() {
        for [lo, hi] in [[2.4, 2.1], [f64::NAN, 2.4], [2.1, f64::NAN]] {
            assert_eq!(lie(hit(Certificate::PROVEN_HIT, lo, hi), ROOT), Some(Lie::NoRoot));
            assert_eq!(lie(hit(Certificate::HIT, lo, hi), ROOT), None);
        }
    }

    #[test]
    fn verdicts_follow_the_class_of_the_truth() {
        let at = |t: f64| hit(Certificate::HIT, t, t);
        let of = |hit, truth| verdict(hit, truth, 2.0, 0.5).0;
        let missed = miss(Certificate::MISS);
        for truth in [ROOT, TOUCH] {
            assert_eq!(of(missed, truth), Verdict::FalseMiss);
            // Twice 0.25 is within 0.5, twice 0.26 is not.
            assert_eq!(verdict(at(2.5), truth, 2.0, 0.5), (Verdict::CorrectHit, 0.5));
            assert_eq!(of(at(2.51), truth), Verdict::WrongSheet);
            let (verdict, dt) = verdict(at(1.0), truth, 2.0, 0.5);
            assert_eq!((verdict, dt), (Verdict::WrongSheet, -2.5));
            assert_eq!(of(at(f64::NAN), truth), Verdict::WrongSheet);
            assert_eq!(of(at(f64::INFINITY), truth), Verdict::WrongSheet);
        }
        assert_eq!(of(missed, NONE), Verdict::CorrectMiss);
        assert_eq!(of(at(2.2), NONE), Verdict::FalseHit);
        assert_eq!(of(missed, UNKNOWN), Verdict::Undecided);
        assert_eq!(of(at(2.0), UNKNOWN), Verdict::Undecided);
        assert_eq!(of(at(9.0), UNKNOWN), Verdict::Undecided);
        assert_eq!(of(at(1.99), UNKNOWN), Verdict::FalseHit);
    }

    #[test]
    fn a_judgement_counts_by_class_and_skips_what_was_not_sampled() {
        let ray = Ray::new(Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0));
        let batch = RayBatch::new(vec![ray; 7]);
        let rays = Rays::Batch(&batch);
        let mut hits = Hits::new(Request::First, 7);
        hits.set(0, hit(Certificate::PROVEN_HIT, 2.25, 2.25));
        hits.set(1, hit(Certificate::PROVEN_HIT, 3.25, 3.25));
        hits.set(2, miss(Certificate::PROVEN_MISS));
        hits.set(3, miss(Certificate::PROVEN_MISS));
        hits.set(4, hit(Certificate::POSSIBLE_HIT, 1.0, 1.0));
        hits.set(6, hit(Certificate::ROOT_HIT, 1.0, 1.0));
        let truths = Truths {
            sample: Sample { indices: vec![0, 1, 2, 3, 4, 5], seed: 0, step: 1, rays: 7 },
            truths: vec![ROOT, ROOT, TOUCH, NONE, NONE, UNKNOWN],
        };
        let judgement = judge(rays, &hits, &truths, Tolerance::Distance(0.1));
        use Verdict::*;
        let expected =
            [CorrectHit, WrongSheet, FalseMiss, CorrectMiss, FalseHit, Undecided, NotSampled];
        assert_eq!(judgement.verdict, expected);
        assert_eq!(judgement.lies, [(1, Lie::RootBefore), (2, Lie::RootMissed)]);
        let tally = &judgement.tally;
        assert_eq!(tally.judged, 6);
        assert_eq!(
            tally.table,
            [[1, 0, 0, 0, 1, 0], [0, 0, 1, 0, 0, 0], [0, 1, 0, 1, 0, 0], [0, 0, 0, 0, 0, 1],]
        );
        assert_eq!(Verdict::ALL.map(|v| tally.count(v)), [1, 1, 1, 1, 1, 1]);
        assert_eq!(tally.count_in(Class::Tangential, FalseMiss), 1);
        assert_eq!(Class::ALL.map(|c| tally.class(c)), [2, 1, 2, 1]);
        assert_eq!((tally.lies, tally.clear_misses), (2, None));
        // Two in t, at speed 2.
        assert_eq!((tally.median_dt, tally.worst_dt), (Some(1.0), Some(2.0)));
    }
}
