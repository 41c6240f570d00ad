//! Frames: a view cast, lit and painted.

use std::ops::AddAssign;
use std::path::Path;
use std::time::{Duration, Instant};

use zeroset::bench::{Sample, Tolerance, Truths, judge, truth};
use zeroset::raycast::{Certificate, Hits, Intersector, Progress, Rays, Report, Request, Sampling};
use zeroset::raycast::{Scene, View, Work};
use zeroset::shade::{self, Agreement, Light, Picture, ShadowRays, ViewKind, shaded};

use crate::destination::is_exr;
use crate::failure::Failure;
use crate::lighting::{LightOptions, Shadows};
use crate::numbers::{percent, short};
use crate::pictures::agreement;
use crate::watch::Bar;

/// What is drawn, of any scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Painter<'a> {
    /// The rays.
    pub(crate) view: &'a View,
    /// What they stand for.
    pub(crate) sampling: Sampling,
    /// So many by so many of them make a pixel.
    pub(crate) side: usize,
    /// What is shown of the hits.
    pub(crate) kind: ViewKind,
    /// Is a legend drawn below?
    pub(crate) legend: bool,
    /// Lights and shadows.
    pub(crate) light: &'a LightOptions,
    /// Stops the work.
    pub(crate) progress: &'a Progress,
}

/// A view, cast, lit and painted.
pub(crate) struct Frame {
    /// The answers to the view's rays.
    pub(crate) hits: Hits,
    /// The picture of them.
    pub(crate) picture: Picture,
    /// What the view's rays cost.
    pub(crate) cast: Cost,
    /// What the shadow rays cost, if there were any to be.
    pub(crate) shadows: Option<Cost>,
    /// How often a light does not reach what faces it.
    pub(crate) blocked: usize,
}

/// What rays cost.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Cost {
    /// How many rays.
    pub(crate) rays: usize,
    /// How long they took.
    pub(crate) time: Duration,
    /// Their evaluations.
    pub(crate) work: Work,
}

impl Painter<'_> {
    /// Casts the view's rays at a scene that an intersector is prepared for, and paints the hits.
    pub(crate) fn paint(
        &self,
        what: &str,
        scene: &Scene,
        intersector: &dyn Intersector,
        bar: &Bar,
    ) -> Result<Frame, Failure> {
        let request =
            if self.kind.needs_normals() { Request::FirstWithNormal } else { Request::First };
        let rays = Rays::View(self.view);
        let mut hits = Hits::new(request, rays.len());
        let start = Instant::now();
        let report = self.cast(what, rays, &mut hits, intersector, bar)?;
        let cast = Cost { rays: rays.len(), time: start.elapsed(), work: report.work };

        let mut lights = self.light.lights(self.view);
        let mut shadows = None;
        if self.light.shadows == Shadows::On {
            let cost = shadows.get_or_insert_with(Cost::default);
            for light in &mut lights {
                *cost += self.shade(scene, &hits, light, intersector, bar)?;
            }
        }
        let blocked = lights.iter().flat_map(|l| &l.blocked).filter(|blocked| **blocked).count();

        let picture = match self.kind {
            ViewKind::Shaded => shaded::picture(self.view, &hits, &lights, self.light.environment),
            ViewKind::Error => {
                let agreement = self.against_reference(scene, &hits, bar)?;
                shade::picture(self.kind, self.view, &hits, Some(&agreement))
            }
            _ => shade::picture(self.kind, self.view, &hits, None),
        };
        let picture = picture.and_then(|picture| picture.averaged(self.side));
        let picture =
            if self.legend { picture.and_then(|picture| picture.with_legend()) } else { picture };
        let picture = picture.map_err(Failure::work)?;
        Ok(Frame { hits, picture, cast, shadows, blocked })
    }

    fn cast(
        &self,
        what: &str,
        rays: Rays<'_>,
        hits: &mut Hits,
        intersector: &dyn Intersector,
        bar: &Bar,
    ) -> Result<Report, Failure> {
        let report = bar.follow(what, rays.len(), self.progress, || {
            intersector.intersect(rays, hits, self.progress)
        })?;
        Ok(report)
    }

    /// Casts the shadow rays of a light.
    fn shade(
        &self,
        scene: &Scene,
        hits: &Hits,
        light: &mut Light,
        intersector: &dyn Intersector,
        bar: &Bar,
    ) -> Result<Cost, Failure> {
        let mut cost = Cost::default();
        light.blocked = vec![false; hits.len()];
        let start = Instant::now();
        let mut rays =
            ShadowRays::new(self.view, hits, &scene.domain, light).map_err(Failure::work)?;
        while !rays.is_empty() {
            let batch = Rays::Batch(&rays.batch);
            let mut answers = Hits::without_work(Request::Any, batch.len());
            let report = self.cast("shadows", batch, &mut answers, intersector, bar)?;
            cost += Cost { rays: batch.len(), work: report.work, ..Cost::default() };
            rays.mark(&answers, &mut light.blocked).map_err(Failure::work)?;
            rays = rays.further(&answers).map_err(Failure::work)?;
        }
        Ok(Cost { time: start.elapsed(), ..cost })
    }

    /// How each answer agrees with the reference.
    fn against_reference(
        &self,
        scene: &Scene,
        hits: &Hits,
        bar: &Bar,
    ) -> Result<Vec<Agreement>, Failure> {
        let rays = Rays::View(self.view);
        let oracle = truth::reference(scene)?;
        let sample = Sample::every(1, rays);
        let truths = bar.follow("reference", rays.len(), self.progress, || {
            truth::classify(&oracle, self.sampling, rays, &sample.indices, self.progress)
        })?;
        let truths = Truths { sample, truths };
        Ok(agreement(&judge(rays, hits, &truths, Tolerance::Footprint)))
    }
}

impl Frame {
    /// Saves the picture, or with .exr the hits as numbers too.
    pub(crate) fn save(&self, file: &Path, view: &View) -> Result<(), Failure> {
        if is_exr(file) {
            shade::exr::save(file, view, &self.hits, Some(&self.picture))
        } else {
            self.picture.save_png(file)
        }
        .map_err(Failure::work)
    }

    /// The time of all rays.
    pub(crate) fn time(&self) -> Duration {
        self.cast.time + self.shadows.map_or(Duration::ZERO, |cost| cost.time)
    }

    /// Was anything hit?
    pub(crate) fn is_empty(&self) -> bool {
        !self.hits.certificate.iter().any(|c| c.is_hit())
    }

    /// Hits, and the share of each certificate.
    pub(crate) fn summary(&self) -> String {
        let certificates = &self.hits.certificate;
        let count = |c| certificates.iter().filter(|given| **given == c).count();
        let shares: Vec<_> = Certificate::ALL
            .into_iter()
            .filter(|c| count(*c) > 0)
            .map(|c| format!("{c} {}", percent(count(c), certificates.len())))
            .collect();
        let found = certificates.iter().filter(|c| c.is_hit()).count();
        format!("{found} hits of {} rays: {}", certificates.len(), shares.join(", "))
    }

    /// What the shadow rays found and cost, in two lines.
    pub(crate) fn shadow_lines(&self) -> Option<[String; 2]> {
        let cost = self.shadows?;
        let share = 100.0 * cost.time.as_secs_f64() / self.time().as_secs_f64();
        let rays = format!(
            "{} shadow rays in {} ms, {} % of the frame; {} blocked",
            cost.rays,
            short(milliseconds(cost.time)),
            short(share),
            self.blocked
        );
        Some([rays, cost.evaluations("shadow ray")])
    }
}

impl Cost {
    /// Evaluations by kind, for each ray.
    pub(crate) fn evaluations(&self, ray: &str) -> String {
        let a_ray = |count: u64| short(count as f64 / self.rays.max(1) as f64);
        let Work { points, gradients, intervals, nonfinite } = self.work;
        let mut text = format!(
            "evaluations a {ray}: {} points, {} gradients, {} intervals",
            a_ray(points),
            a_ray(gradients),
            a_ray(intervals)
        );
        if nonfinite > 0 {
            text += &format!("; {nonfinite} gave NaN or infinity");
        }
        text
    }
}

impl AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.time += other.time;
        self.work += other.work;
    }
}

/// A time in milliseconds.
pub(crate) fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}
