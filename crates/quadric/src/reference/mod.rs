//! The truth about rays and patches: what the methods are judged by.
//!
//! | module | holds |
//! |---|---|
//! | `root` | enclosures of a patch's roots on a ray, in intervals of any precision |
//! | `first` | the first of the roots of all patches |
//! | `sheet` | the mean of the first sheet, where the scene blends |

mod first;
mod root;
mod sheet;

use std::sync::Arc;

use glam::Vec3;
use rayon::prelude::*;
use zeroset_cpu::{Class, Truth, tiles};
use zeroset_expr::Parameters;
use zeroset_raycast::{
    Blending, Error, GeometryKind, Hit, Hits, Intersector, Knob, KnobError, Method, Patches,
    Progress, Ray, Rays, Report, Request, Scene, Unsupported, Work, knob,
};

use crate::hierarchy::Hierarchy;
use crate::method::{Quadrics, patches};
use crate::prepared::{PreparedQuadrics, hierarchy, no_parameters};

/// Encloses the first root of patches, in outward arithmetic: the method `quadric-reference`.
///
/// The roots come in closed form, from intervals of double precision and, where these decide nothing, of ever
/// more bits. Where patches are blended, the truth is the mean t of the first sheet, enclosed; a ray on which
/// it is not known which hits belong to the sheet, to more than a narrow bracket, is undecidable.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct QuadricReference;

/// [`QuadricReference`] for one scene.
pub struct PreparedQuadricReference {
    patches: Arc<Patches>,
    hierarchy: Hierarchy,
    normals: PreparedQuadrics,
}

/// The widest bracket of a decided ray, to its t.
const WIDEST: f64 = 1e-9;

/// Is a bracket narrow enough to decide a ray?
fn is_narrow([from, to]: [f64; 2]) -> bool {
    from.is_finite() && to - from <= WIDEST * (from.abs() + to.abs())
}

impl QuadricReference {
    /// Prepares for a scene; also [`PreparedQuadricReference::classify`] is then at hand.
    ///
    /// # Errors
    /// If the scene has no patches.
    pub fn prepare_reference(&self, scene: &Scene) -> Result<PreparedQuadricReference, Error> {
        let patches = Arc::clone(patches(self.id(), scene)?);
        let normals = PreparedQuadrics::new(&Quadrics::incremental(), Arc::clone(&patches));
        Ok(PreparedQuadricReference { hierarchy: hierarchy(&patches), patches, normals })
    }
}

impl Method for QuadricReference {
    fn id(&self) -> &'static str {
        "quadric-reference"
    }

    fn summary(&self) -> &'static str {
        "proven first roots of quadrics in bounds, with more bits where needed"
    }

    fn geometry(&self) -> GeometryKind {
        GeometryKind::Patches
    }

    fn supports(&self, scene: &Scene) -> Result<(), Unsupported> {
        patches(self.id(), scene).map(|_| ())
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Intersector>, Error> {
        Ok(Box::new(self.prepare_reference(scene)?))
    }

    fn knobs(&self) -> Vec<Knob> {
        Vec::new()
    }

    fn set(&mut self, name: &str, _: &str) -> Result<(), KnobError> {
        Err(knob::unknown(self.id(), name, &[]))
    }

    /// Roots come in closed form.
    fn for_precision(&mut self, _: f64, _: &Scene) {}

    fn boxed(&self) -> Box<dyn Method> {
        Box::new(self.clone())
    }
}

impl PreparedQuadricReference {
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
            .par_chunks(64)
            .map(|chunk| {
                progress.advance(chunk.len())?;
                Ok(chunk.iter().map(|&i| self.truth(rays.get(i), rays.range())).collect())
            })
            .collect::<Result<_, Error>>()?;
        Ok(chunks.concat())
    }

    fn truth(&self, ray: Ray, range: [f64; 2]) -> Truth {
        let nothing = [f64::INFINITY; 2];
        if !ray.is_valid() {
            let work = Work { nonfinite: 1, ..Work::default() };
            return Truth::new(Class::Undecidable, nothing, work);
        }
        if !(range[0] <= range[1]) {
            return Truth::new(Class::None, nothing, Work::default());
        }
        let (class, bracket, intervals) = match self.patches.blending() {
            Blending::None => first::find(&self.patches, &self.hierarchy, ray, range),
            Blending::Weighted { offset } => {
                sheet::find(&self.patches, &self.hierarchy, ray, range, offset)
            }
        };
        Truth::new(class, bracket, Work { intervals, ..Work::default() })
    }
}

/// What became of a ray: the class, the bracket, and the enclosures that it cost.
type Found = (Class, [f64; 2], u64);

impl Intersector for PreparedQuadricReference {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        no_parameters(values)
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        let (request, range) = (hits.request, rays.range());
        tiles::cast(rays, hits, progress, |tile| {
            tile.iter()
                .map(|&ray| {
                    let truth = self.truth(ray, range);
                    let (bracket, certificate) = (truth.bracket, truth.certificate());
                    let normal = match request {
                        Request::FirstWithNormal if certificate.is_hit() => {
                            self.normals.normal(ray, range)
                        }
                        _ => Vec3::ZERO,
                    };
                    (Hit { bracket, certificate, work: truth.work }, normal)
                })
                .collect::<Vec<_>>()
        })
    }
}
