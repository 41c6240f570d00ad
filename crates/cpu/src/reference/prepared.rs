//! The reference, prepared for a scene.

use rayon::prelude::*;
use zeroset_expr::{Function, Parameters, Tape};
use zeroset_ia::BigInterval;
use zeroset_raycast::{
    Domain, Error, Hit, Hits, Intersector, Method, Progress, Ray, Rays, Report, Request, Scene,
    Work,
};

use super::bisection::Bisection;
use super::curve::Curve;
use super::exact::ExactTape;
use super::isolation::Isolation;
use super::ladder::{Found, Goal, Ladder, Rung, climb};
use super::outward::Double;
use super::{Class, Reference, Truth};
use crate::implicit::Implicit;
use crate::normals::{self, Normals};
use crate::tiles;

/// The precisions above double: 128 bits, doubled up to the most that is allowed.
const FIRST_BITS: u32 = 128;
/// By how much fewer pieces are looked at in those.
const BUDGET_DIVISOR: u32 = 8;
/// Rays that share one set of evaluators.
const CHUNK: usize = 64;

/// The reference for one scene.
#[derive(Debug)]
pub struct PreparedReference {
    method: Reference,
    function: Function,
    domain: Domain,
    tapes: Tapes,
}

/// The function at each precision.
#[derive(Debug)]
struct Tapes {
    double: Tape,
    /// With the bits of each.
    finer: Vec<(u32, Tape)>,
    /// If it is a polynomial whose constants are binary fractions.
    exact: Option<ExactTape>,
}

impl Tapes {
    fn new(method: &Reference, function: &Function, values: &Parameters) -> Result<Self, Error> {
        let double = function.tape(values, FIRST_BITS as usize)?;
        let mut finer = Vec::new();
        let mut bits = FIRST_BITS;
        while bits <= method.bits {
            finer.push((bits, function.tape(values, bits as usize)?));
            bits *= 2;
        }
        let exact = ExactTape::new(&double);
        Ok(Self { double, finer, exact })
    }
}

impl PreparedReference {
    pub(super) fn new(method: Reference, scene: &Scene) -> Result<Self, Error> {
        let domain = Implicit::new(method.id(), scene)?.domain;
        let function = Implicit::function(method.id(), scene)?.clone();
        let tapes = Tapes::new(&method, &function, &scene.parameters)?;
        Ok(Self { method, function, domain, tapes })
    }

    /// The truth about the rays of the given indices, in their order.
    ///
    /// # Errors
    /// If the work was asked to stop.
    ///
    /// # Panics
    /// If there is no ray of an index.
    pub fn classify(
        &self,
        rays: Rays<'_>,
        indices: &[usize],
        progress: &Progress,
    ) -> Result<Vec<Truth>, Error> {
        let chunks: Vec<Vec<Truth>> = indices
            .par_chunks(CHUNK)
            .map(|chunk| {
                let mut ladder = self.ladder();
                let truths = chunk
                    .iter()
                    .map(|&i| self.truth(&mut ladder, rays.get(i), rays.range(), self.method.width))
                    .collect();
                progress.advance(chunk.len())?;
                Ok(truths)
            })
            .collect::<Result<_, Error>>()?;
        Ok(chunks.concat())
    }

    /// Searches in the order of their cost.
    fn ladder(&self) -> Vec<Box<dyn Rung + '_>> {
        let degree = self.tapes.double.degree();
        let budget = self.method.budget;
        let double = Curve::new(&self.tapes.double, degree, &Double::point(0.0));
        let mut ladder: Vec<Box<dyn Rung + '_>> = vec![Box::new(Bisection::new(double, budget))];
        for (bits, tape) in &self.tapes.finer {
            let zero = BigInterval::from_f64(0.0, *bits as usize);
            let curve = Curve::new(tape, degree, &zero);
            ladder.push(Box::new(Bisection::new(curve, budget.div_ceil(BUDGET_DIVISOR))));
        }
        if let Some(exact) = &self.tapes.exact {
            ladder.insert(ladder.len().min(2), Box::new(Isolation::new(exact, self.domain)));
        }
        ladder
    }

    fn truth(&self, ladder: &mut Ladder<'_>, ray: Ray, range: [f64; 2], width: f64) -> Truth {
        let nothing = [f64::INFINITY; 2];
        if !ray.is_valid() {
            let work = Work { nonfinite: 1, ..Work::default() };
            return Truth::new(Class::Undecidable, nothing, work);
        }
        let Some(clip) = self.domain.clip(ray, range) else {
            return Truth::new(Class::None, nothing, Work::default());
        };
        ladder.iter_mut().for_each(|rung| rung.aim(ray));
        let found = climb(ladder, clip.outer, &Goal { clip, resolution: self.method.width, width });
        let (class, bracket) = match found.unwrap_or(Found::Stuck(clip.outer)) {
            Found::Nothing => (Class::None, nothing),
            Found::Simple(bracket) => (Class::Transversal, bracket),
            Found::Multiple(bracket) => (Class::Tangential, bracket),
            Found::Stuck(bracket) => (Class::Undecidable, bracket),
        };
        let mut work = Work::default();
        ladder.iter().for_each(|rung| work += rung.work());
        Truth::new(class, bracket, work)
    }
}

impl Intersector for PreparedReference {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        self.tapes = Tapes::new(&self.method, &self.function, values)?;
        Ok(())
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        // Any proven bracket answers whether there is a root.
        let width = match hits.request {
            Request::Any => f64::INFINITY,
            Request::First | Request::FirstWithNormal => self.method.width,
        };
        let mut report = tiles::cast(rays, hits, progress, |tile| {
            let mut ladder = self.ladder();
            tile.iter()
                .map(|&ray| {
                    let truth = self.truth(&mut ladder, ray, rays.range(), width);
                    Hit {
                        bracket: truth.bracket,
                        certificate: truth.certificate(),
                        work: truth.work,
                    }
                })
                .collect()
        })?;
        report.work += normals::fill(&self.tapes.double, Normals::Gradient, rays, hits);
        Ok(report)
    }
}
