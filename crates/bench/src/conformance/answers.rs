//! Answers: their form, their truth, and what they may depend on.

use rayon::ThreadPoolBuilder;
use zeroset_raycast::{
    Certificate, Error, Hit, Hits, Intersector, Progress, Ray, RayBatch, Rays, Request, Sampling,
};

use super::cases::Case;
use super::suite::Suite;
use crate::{Class, Truth, judge::lie, truth};

impl Suite<'_> {
    /// The form and the truth of the answers to one set of rays.
    pub(super) fn check_case(&mut self, intersector: &dyn Intersector, case: &Case) {
        let rays = case.rays();
        let Some(hits) = self.ask(intersector, rays, Request::First) else { return };
        self.check_form(&case.name, rays, &hits);
        self.check_truth(&case.name, rays, &hits);
    }

    /// Brackets are ordered and in the domain, misses have none; what is no ray is counted.
    fn check_form(&mut self, place: &str, rays: Rays<'_>, hits: &Hits) {
        let (mut form, mut range, mut invalid) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..rays.len() {
            let (ray, hit) = (rays.get(i), hits.get(i));
            let [lo, hi] = hit.bracket;
            let told = || format!("{ray:?}: {} {:?}", hit.certificate, hit.bracket);
            let is_formed = if hit.certificate.is_hit() {
                lo <= hi && lo.is_finite() && hi.is_finite()
            } else {
                hit.bracket == [f64::INFINITY; 2]
            };
            if !is_formed || !Certificate::ALL.contains(&hit.certificate) {
                form.push(told());
            }
            if !ray.is_valid() {
                if hit.certificate != Certificate::MISS || hit.work.nonfinite == 0 {
                    invalid.push(format!("{}, {:?}", told(), hit.work));
                }
            } else if hit.certificate.is_hit() && self.method.sampling() == Sampling::Ray {
                let clip = self.scene.domain.clip(ray, rays.range());
                if !clip.is_some_and(|clip| clip.outer[0] <= lo && hi <= clip.outer[1]) {
                    range.push(format!("{}, clip {:?}", told(), clip.map(|c| c.outer)));
                }
            }
        }
        self.fail_any("brackets are ordered and finite, misses have none", place, &form);
        self.fail_any("brackets are in the domain and the range", place, &range);
        self.fail_any("what is no ray is counted and missed", place, &invalid);
    }

    /// No certificate lies; most crossings are found.
    fn check_truth(&mut self, place: &str, rays: Rays<'_>, hits: &Hits) {
        let indices = valid(rays);
        let Some(truths) = self.truths(place, rays, &indices) else { return };
        let mut lies = Vec::new();
        let (mut crossings, mut found) = (0, 0);
        for (&i, &truth) in indices.iter().zip(&truths) {
            let hit = hits.get(i);
            if let Some(lie) = lie(hit, truth) {
                let (certificate, bracket) = (hit.certificate, hit.bracket);
                let ray = rays.get(i);
                lies.push(format!("{lie}: {ray:?}: {certificate} {bracket:?}, but {truth:?}"));
            }
            if truth.class == Class::Transversal {
                crossings += 1;
                found += usize::from(hit.certificate.is_hit());
            }
        }
        self.fail_any("certificates are true", place, &lies);
        if matches!(rays, Rays::View(_)) && 2 * found < crossings {
            let detail = format!("{place}: {found} of {crossings}");
            self.fail("most crossings are found", detail);
        }
    }

    /// The truth about the rays of these indices, all that are valid, or about their pixels.
    fn truths(&mut self, place: &str, rays: Rays<'_>, indices: &[usize]) -> Option<Vec<Truth>> {
        let sampling = self.method.sampling();
        match truth::classify(self.oracle, sampling, rays, indices, &Progress::new()) {
            Ok(truths) => Some(truths),
            Err(error) => {
                self.fail("the reference classifies the rays", format!("{place}: {error}"));
                None
            }
        }
    }

    /// An answer depends on its ray alone.
    pub(super) fn check_grouping(&mut self, intersector: &dyn Intersector) {
        let view = self.view();
        let rays = Rays::View(&view);
        let Some(hits) = self.ask(intersector, rays, Request::First) else { return };
        self.expect_same("equal requests have equal answers", intersector, &hits);

        // A permutation without pattern: indices ordered by scrambled bits.
        let mut shuffled: Vec<usize> = (0..rays.len()).collect();
        shuffled.sort_by_key(|i| (*i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 20);
        let sparse: Vec<usize> = (0..rays.len()).step_by(13).collect();
        let groups: [(&str, &[usize]); 4] = [
            ("a shuffled batch", &shuffled),
            ("every 13th ray", &sparse),
            ("three rays", &shuffled[..3]),
            ("one ray", &shuffled[3..4]),
        ];
        for (place, indices) in groups {
            let some: Vec<Ray> = indices.iter().map(|i| rays.get(*i)).collect();
            let batch = RayBatch { rays: some, range: rays.range() };
            let asked = self.ask(intersector, Rays::Batch(&batch), Request::First);
            let Some(answers) = asked else { return };
            let different: Vec<_> = indices
                .iter()
                .enumerate()
                .filter_map(|(k, &i)| difference(&hits, i, &answers, k, rays.get(i)))
                .collect();
            self.fail_any("an answer depends on its ray alone", place, &different);
        }

        for threads in [1, 2] {
            let Ok(pool) = ThreadPoolBuilder::new().num_threads(threads).build() else { continue };
            let asked = pool.install(|| self.ask(intersector, rays, Request::First));
            if let Some(again) = asked {
                let place = format!("threads: {threads}");
                let different = differences(&hits, &again, rays);
                self.fail_any("answers do not depend on threads", &place, &different);
            }
        }
    }

    /// Fails if the view's answers are not `before`.
    pub(super) fn expect_same(
        &mut self,
        rule: &'static str,
        intersector: &dyn Intersector,
        before: &Hits,
    ) {
        let view = self.view();
        let rays = Rays::View(&view);
        if let Some(after) = self.ask(intersector, rays, Request::First) {
            self.fail_any(rule, "a view", &differences(before, &after, rays));
        }
    }

    /// Normals are right, and any root agrees with the first.
    pub(super) fn check_requests(&mut self, intersector: &dyn Intersector) {
        let view = self.view();
        let rays = Rays::View(&view);
        let Some(first) = self.ask(intersector, rays, Request::First) else { return };
        self.check_normals(intersector, &first);
        if let Some(any) = self.ask(intersector, rays, Request::Any) {
            self.check_any(rays, &first, &any);
        }
    }

    /// Where it is proven whether there is a root, both requests and the truth agree.
    fn check_any(&mut self, rays: Rays<'_>, first: &Hits, any: &Hits) {
        let indices = valid(rays);
        let Some(truths) = self.truths("any root", rays, &indices) else { return };
        let proven = |c: Certificate| match (c.is_hit(), c.contains(Certificate::ROOT)) {
            (true, true) => Some(true),
            (false, _) if c == Certificate::PROVEN_MISS => Some(false),
            _ => None,
        };
        let known = |truth: Truth| match truth.class {
            Class::Transversal | Class::Tangential => Some(true),
            Class::None => Some(false),
            Class::Undecidable => None,
        };
        let contradicts = |a: Option<bool>, b: Option<bool>| a.is_some() && b.is_some() && a != b;
        let bad: Vec<_> = indices
            .iter()
            .zip(&truths)
            .filter(|&(&i, truth)| {
                let claim = proven(any.certificate[i]);
                contradicts(claim, proven(first.certificate[i]))
                    || contradicts(claim, known(*truth))
            })
            .map(|(&i, truth)| {
                let (any, first) = (any.certificate[i], first.certificate[i]);
                format!("{:?}: any {any}, first {first}, {truth:?}", rays.get(i))
            })
            .collect();
        self.fail_any("any root agrees with the first where proven", "a view", &bad);
    }

    /// No rays are answered without any work.
    pub(super) fn check_no_rays(&mut self, intersector: &dyn Intersector) {
        let batch = RayBatch::new(Vec::new());
        for request in [Request::First, Request::FirstWithNormal, Request::Any] {
            self.ask(intersector, Rays::Batch(&batch), request);
        }
    }

    /// Work that was asked to stop does, and says so.
    pub(super) fn check_interruption(&mut self, intersector: &dyn Intersector) {
        let view = self.view();
        let progress = Progress::new();
        progress.stop();
        let mut hits = Hits::new(Request::First, view.width * view.height);
        match intersector.intersect(Rays::View(&view), &mut hits, &progress) {
            Err(Error::Interrupted) => {}
            other => self.fail("work that is asked to stop does", format!("{other:?}")),
        }
    }

    /// Certificates are true at any precision.
    pub(super) fn check_precisions(&mut self) {
        let view = self.view();
        let rays = Rays::View(&view);
        for share in [0.1, 1e-3, 1e-6] {
            let width = share * self.scene.domain.longest_side();
            let mut method = self.method.boxed();
            method.for_precision(width, self.scene);
            let place = format!("brackets of {width:e}");
            match method.prepare(self.scene) {
                Ok(intersector) => {
                    if let Some(hits) = self.ask(intersector.as_ref(), rays, Request::First) {
                        self.check_form(&place, rays, &hits);
                        self.check_truth(&place, rays, &hits);
                    }
                }
                Err(error) => self.fail("any precision is prepared", format!("{place}: {error}")),
            }
        }
    }
}

/// The indices of what are rays.
fn valid(rays: Rays<'_>) -> Vec<usize> {
    (0..rays.len()).filter(|&i| rays.get(i).is_valid()).collect()
}

pub(super) fn differences(a: &Hits, b: &Hits, rays: Rays<'_>) -> Vec<String> {
    (0..rays.len()).filter_map(|i| difference(a, i, b, i, rays.get(i))).collect()
}

fn difference(a: &Hits, i: usize, b: &Hits, k: usize, ray: Ray) -> Option<String> {
    let (a, b) = (a.get(i), b.get(k));
    // Bits, so that NaN equals itself.
    let bits = |bracket: [f64; 2]| bracket.map(f64::to_bits);
    (bits(a.bracket) != bits(b.bracket) || a.certificate != b.certificate).then(|| {
        let of = |hit: Hit| format!("{} {:?}", hit.certificate, hit.bracket);
        format!("{ray:?}: {} and {}", of(a), of(b))
    })
}
