//! What all rules share: the method, the scene, the failures so far.

use zeroset_raycast::{
    Camera, Error, Hits, Intersector, Method, Progress, Rays, Request, Scene, View, Work,
};

use super::Failure;
use crate::Oracle;

/// A check in progress.
pub(super) struct Suite<'a> {
    pub(super) oracle: &'a dyn Oracle,
    pub(super) method: &'a dyn Method,
    pub(super) scene: &'a Scene,
    pub(super) failures: Vec<Failure>,
}

impl<'a> Suite<'a> {
    pub(super) fn new(oracle: &'a dyn Oracle, method: &'a dyn Method, scene: &'a Scene) -> Self {
        Self { oracle, method, scene, failures: Vec::new() }
    }

    pub(super) fn fail(&mut self, rule: &'static str, detail: impl Into<String>) {
        self.failures.push(Failure { rule, detail: detail.into() });
    }

    /// Fails with the first of the offenders and their number, if there are any.
    pub(super) fn fail_any(&mut self, rule: &'static str, place: &str, offenders: &[String]) {
        if let Some(first) = offenders.first() {
            self.fail(rule, format!("{place}: {first} ({} in all)", offenders.len()));
        }
    }

    /// A view whose size is no multiple of any tile or packet.
    pub(super) fn view(&self) -> View {
        View::new(Camera::facing(&self.scene.domain), 37, 29)
    }

    /// The same answers and the same sum of work without room for the work of each ray.
    fn ask_without_work(
        &mut self,
        intersector: &dyn Intersector,
        rays: Rays<'_>,
        expected: &Hits,
        work: Work,
    ) {
        let mut hits = Hits::without_work(expected.request, rays.len());
        let Ok(report) = intersector.intersect(rays, &mut hits, &Progress::new()) else { return };
        let same = hits.bracket == expected.bracket && hits.certificate == expected.certificate;
        if !same || report.work != work {
            let detail = format!("{:?}, not {work:?}; the same answers: {same}", report.work);
            self.fail("answers do not depend on whether work is kept by ray", detail);
        }
    }

    /// The answers; an error is a failure.
    pub(super) fn ask(
        &mut self,
        intersector: &dyn Intersector,
        rays: Rays<'_>,
        request: Request,
    ) -> Option<Hits> {
        let mut hits = Hits::new(request, rays.len());
        match intersector.intersect(rays, &mut hits, &Progress::new()) {
            Ok(report) => {
                if report.work != hits.total_work() {
                    let detail = format!("{:?}, but {:?}", report.work, hits.total_work());
                    self.fail("the report holds the work of all answers", detail);
                }
                // Once is enough: it takes as long as the answers.
                if matches!(rays, Rays::View(_)) && request == Request::First {
                    self.ask_without_work(intersector, rays, &hits, report.work);
                }
                Some(hits)
            }
            // Methods may be for views alone, if they say so.
            Err(Error::Unsupported(_)) if matches!(rays, Rays::Batch(_)) => None,
            Err(error) => {
                self.fail("supported rays are answered", error.to_string());
                None
            }
        }
    }
}
