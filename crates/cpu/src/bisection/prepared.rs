//! Bisection compiled for a scene.

use zeroset_expr::{Parameters, Tape};
use zeroset_ia::{Isa, Kernel, Nearest, Rounding, dispatch, dispatch_register, widest};
use zeroset_raycast::{Error, Hit, Hits, Intersector, Method, Progress, Ray, Rays, Report, Scene};

use super::answers::Answers;
use super::cut::{Axis, Cut};
use super::form::{Form, Numbers};
use super::march::{FIRST, MAX_DEPTH, March, Marcher, RawPairs, RawVectors, SetVectors};
use super::method::{Algorithm, Bisection, Finishing, Packets, Stop};
use super::monotone::Refining;
use super::settler::{Goal, bisections};
use crate::implicit::Implicit;
use crate::{normals, tiles};

/// How many rays are clipped to the domain at once.
const CLIPPED: usize = 32;

pub(super) struct Prepared {
    method: Bisection,
    implicit: Implicit,
    /// For Mitchell's algorithm only.
    slope: Option<Tape>,
    form: Form,
}

impl Prepared {
    /// # Errors
    /// If the scene is unsupported, or its domain or parameters are invalid.
    pub(super) fn new(method: &Bisection, scene: &Scene) -> Result<Self, Error> {
        let implicit = Implicit::new(method.id(), scene)?;
        let (slope, form) = Self::compile(method, &implicit)?;
        Ok(Self { method: method.clone(), implicit, slope, form })
    }

    fn compile(method: &Bisection, implicit: &Implicit) -> Result<(Option<Tape>, Form), Error> {
        let slope = (method.algorithm == Algorithm::Mitchell).then(|| implicit.tape.slope());
        let form = Form::of(method, &implicit.tape, slope.as_ref(), &implicit.domain)?;
        Ok((slope, form))
    }
}

impl Intersector for Prepared {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        self.implicit.set_parameters(values)?;
        (self.slope, self.form) = Self::compile(&self.method, &self.implicit)?;
        Ok(())
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        let goal = Goal::new(&self.method, hits.request, rays.range());
        let mut report = tiles::cast(rays, hits, progress, |tile| self.cast(tile, &goal))?;
        report.work += normals::fill(&self.implicit.tape, self.method.normals, rays, hits);
        Ok(report)
    }
}

impl Prepared {
    /// Answers the rays of a tile.
    fn cast(&self, rays: &[Ray], goal: &Goal) -> Vec<Hit> {
        let groups = widest(
            #[inline(always)]
            || self.groups(rays, goal),
        );
        let Self { method, implicit, slope, form } = self;
        let refining = match method.finish {
            Finishing::Accept => Refining::Here,
            Finishing::Certify => Refining::Later,
        };
        let mut answers = Answers::new(method, implicit, &form.bounds, goal, rays.len());
        let march = March {
            tape: &implicit.tape,
            slope: slope.as_ref().map(|slope| (slope, refining)),
            bounds: &form.bounds,
            first: first(goal.stop),
            delta: method.delta,
            poles: method.poles,
            groups: &groups,
            judge: &mut answers,
        };
        let (isa, rounding) = (method.isa.unwrap_or_else(Isa::best), method.rounding);
        match (form.numbers, method.packets) {
            (Numbers::Raw, Packets::Two) => dispatch(isa, rounding, RawPairs(march)),
            (Numbers::Raw, Packets::One(register)) => {
                dispatch_register(register, rounding, RawVectors(march));
            }
            (Numbers::Set, _) => dispatch(isa, rounding, SetVectors(march)),
            (Numbers::Double, _) if rounding == Rounding::Nearest => {
                SetVectors(march).run(Nearest(0.0_f64));
            }
            (Numbers::Double, _) => SetVectors(march).run(0.0_f64),
        }
        answers.hits
    }

    /// The rays that meet the domain, by what they are cut by.
    #[inline(always)]
    fn groups(&self, rays: &[Ray], goal: &Goal) -> Vec<(Cut, Vec<Marcher>)> {
        let mut groups: Vec<(Cut, Vec<Marcher>)> = Vec::with_capacity(Axis::COUNT);
        let mut last = 0;
        for (block, lines) in rays.chunks(CLIPPED).enumerate() {
            let [from, to] = self.implicit.domain.outer::<CLIPPED>(lines, goal.range);
            for (i, line) in lines.iter().enumerate() {
                let range = [from[i], to[i]];
                if range[0] > range[1] {
                    continue;
                }
                let axis = Axis::of(*line);
                let cut = match self.method.algorithm {
                    Algorithm::Kmarch => Cut::Slabs(axis),
                    Algorithm::Tbisect | Algorithm::Mitchell => Cut::Rays,
                };
                // Neighbours mostly share their axis.
                if groups.get(last).is_none_or(|(a, _)| *a != cut) {
                    last = groups.iter().position(|(a, _)| *a == cut).unwrap_or_else(|| {
                        groups.push((cut, Vec::with_capacity(rays.len())));
                        groups.len() - 1
                    });
                }
                let depth = self.depth(*line, axis, cut, range, goal);
                let ray = CLIPPED * block + i;
                groups[last].1.push(Marcher { ray, line: *line, range, depth });
            }
        }
        groups
    }

    /// How often the pieces of a ray are bisected.
    #[inline(always)]
    fn depth(&self, line: Ray, axis: Axis, cut: Cut, range: [f64; 2], goal: &Goal) -> u32 {
        let bounds = &self.form.bounds;
        let speed = f64::from(line.direction[axis.k]).abs();
        // What is bisected, in q.
        let length = match cut {
            Cut::Slabs(axis) => bounds.length(axis),
            Cut::Rays => (range[1] - range[0]) * speed,
        };
        let least = first(goal.stop);
        let depth = goal.depth(&self.method, length, speed);
        // Pieces finer than the rounding of coordinates gain nothing.
        let finest = match cut {
            Cut::Slabs(axis) => bounds.finest(axis.k),
            Cut::Rays => bisections(length, bounds.resolution()),
        };
        depth.min(finest).min(MAX_DEPTH).max(least)
    }
}

/// The depth of the pieces with which marches start.
fn first(stop: Stop) -> u32 {
    match stop {
        Stop::Depth(depth) => depth.min(FIRST),
        Stop::Width(_) => FIRST,
    }
}
