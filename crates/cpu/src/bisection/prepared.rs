//! Bisection compiled for a scene.

use zeroset_expr::{Parameters, Tape};
use zeroset_ia::{Isa, Kernel, Nearest, Rounding, dispatch, dispatch_register, widest};
use zeroset_raycast::{Error, Hit, Hits, Intersector, Method, Progress, Ray, Rays, Report, Scene};

use super::answers::Answers;
use super::bundle::{self, Bundle};
use super::cut::{Axis, Cut};
use super::form::Form;
use super::march::{FIRST, MAX_DEPTH, March, RawPairs, RawVectors, SetVectors};
use super::method::{Algorithm, Bisection, Finishing, Packets, Stop};
use super::monotone::Refining;
use super::settler::{Goal, bisections};
use crate::implicit::Implicit;
use crate::numbers::Numbers;
use crate::{normals, tiles};

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
    fn groups(&self, rays: &[Ray], goal: &Goal) -> Vec<(Cut, Vec<Bundle>)> {
        let mut groups = Groups::default();
        let mut bundle = Bundle::new();
        for (block, lines) in rays.chunks(bundle::SIZE).enumerate() {
            bundle.clip(lines, block * bundle::SIZE, &self.implicit.domain, goal.range);
            let axes = Axis::of_all(&bundle.direction);
            let [from, to] = &bundle.range;
            // Neighbours mostly meet the domain together, and share their axis. The places behind the
            // last repeat it.
            let (mut all, mut same) = (true, true);
            for i in 0..bundle::SIZE {
                all &= from[i] <= to[i];
                same &= axes[i] == axes[0];
            }
            if all && (same || self.method.algorithm != Algorithm::Kmarch) {
                groups.add(self.cut(axes[0]), &bundle);
            } else {
                for i in (0..lines.len()).filter(|i| from[*i] <= to[*i]) {
                    groups.push(self.cut(axes[i]), &bundle, i);
                }
            }
        }
        let mut groups = groups.finished();
        for (cut, bundles) in &mut groups {
            for bundle in bundles {
                self.deepen(*cut, bundle, goal);
            }
        }
        groups
    }

    /// What a ray with this dominant axis is cut by.
    #[inline(always)]
    fn cut(&self, axis: Axis) -> Cut {
        match self.method.algorithm {
            Algorithm::Kmarch => Cut::Slabs(axis),
            Algorithm::Tbisect | Algorithm::Mitchell => Cut::Rays,
        }
    }

    /// Sets how often the pieces of each ray are bisected: to the goal, but no deeper than coordinates are
    /// rounded.
    #[inline(always)]
    fn deepen(&self, cut: Cut, bundle: &mut Bundle, goal: &Goal) {
        let Self { method, form: Form { bounds, .. }, .. } = self;
        let least = first(goal.stop);
        let limited = |depth: u32, finest: u32| depth.min(finest).min(MAX_DEPTH).max(least);
        if let (Cut::Slabs(axis), Stop::Depth(_)) = (cut, goal.stop) {
            // The same for all rays.
            let depth = goal.depth(method, bounds.length(axis), 1.0);
            bundle.depth = [limited(depth, bounds.finest(axis.k)); bundle::SIZE];
            return;
        }
        for i in 0..bundle.len() {
            let [x, y, z] = [0, 1, 2].map(|axis| bundle.direction[axis][i].abs());
            let speed = x.max(y).max(z);
            bundle.depth[i] = match cut {
                Cut::Slabs(axis) => {
                    let depth = goal.depth(method, bounds.length(axis), speed);
                    limited(depth, bounds.finest(axis.k))
                }
                Cut::Rays => {
                    let length = (bundle.range[1][i] - bundle.range[0][i]) * speed;
                    let depth = goal.depth(method, length, speed);
                    limited(depth, bisections(length, bounds.resolution()))
                }
            };
        }
    }
}

/// Bundles by what their rays are cut by.
#[derive(Default)]
struct Groups(Vec<Group>);

struct Group {
    cut: Cut,
    done: Vec<Bundle>,
    /// There is room in it.
    open: Bundle,
}

impl Groups {
    #[inline(always)]
    fn of(&mut self, cut: Cut) -> &mut Group {
        let known = self.0.iter().position(|group| group.cut == cut);
        let place = known.unwrap_or_else(|| {
            self.0.push(Group { cut, done: Vec::new(), open: Bundle::new() });
            self.0.len() - 1
        });
        &mut self.0[place]
    }

    /// Adds a whole bundle.
    #[inline(always)]
    fn add(&mut self, cut: Cut, bundle: &Bundle) {
        self.of(cut).done.push(bundle.clone());
    }

    /// Adds a ray of a bundle.
    #[inline(always)]
    fn push(&mut self, cut: Cut, bundle: &Bundle, i: usize) {
        let group = self.of(cut);
        group.open.push(bundle, i);
        if group.open.len() == bundle::SIZE {
            group.done.push(std::mem::replace(&mut group.open, Bundle::new()));
        }
    }

    fn finished(self) -> Vec<(Cut, Vec<Bundle>)> {
        let finish = |Group { cut, mut done, mut open }: Group| {
            if open.len() > 0 {
                open.fill();
                done.push(open);
            }
            (cut, done)
        };
        self.0.into_iter().map(finish).collect()
    }
}

/// The depth of the pieces with which marches start.
fn first(stop: Stop) -> u32 {
    match stop {
        Stop::Depth(depth) => depth.min(FIRST),
        Stop::Width(_) => FIRST,
    }
}
