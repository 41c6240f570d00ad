//! Casting rays at quadrics, prepared for a scene.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use num_traits::Float;
use zeroset_cpu::tiles;
use zeroset_expr::{ParameterError, Parameters};
use zeroset_raycast::{
    Blending, Bound, Certificate, Error, Hit, Hits, Intersector, Patches, Progress, Projection,
    Ray, Rays, Report, Request, Sides, View, Work,
};

use crate::blend::{self, Fragment};
use crate::culling;
use crate::hierarchy::Hierarchy;
use crate::method::{Precision, Quadrics, Staging};
use crate::piece::{Crossing, Piece};

/// [`Quadrics`] compiled for a scene.
pub(crate) struct PreparedQuadrics {
    method: Quadrics,
    patches: Arc<Patches>,
    pieces: Pieces,
    hierarchy: Hierarchy,
}

enum Pieces {
    Single(Vec<Piece<f32>>),
    Double(Vec<Piece<f64>>),
}

impl PreparedQuadrics {
    pub(crate) fn new(method: &Quadrics, patches: Arc<Patches>) -> Self {
        let pieces = match method.precision {
            Precision::Single => Pieces::Single(pieces(method, &patches)),
            Precision::Double => Pieces::Double(pieces(method, &patches)),
        };
        let hierarchy = hierarchy(&patches);
        Self { method: method.clone(), patches, pieces, hierarchy }
    }

    /// Which patches are left out.
    fn hidden(&self, rays: Rays<'_>) -> Hidden {
        // Behind the eye it is the outside that is turned away.
        let has_behind = rays.range()[0] < 0.0;
        let is_brute = self.method.staging == Staging::Brute;
        if has_behind || is_brute || self.patches.sides() == Sides::Both {
            return Hidden::None;
        }
        let eye = match rays {
            Rays::View(view) if !rays.is_empty() => one_eye(view),
            _ => None,
        };
        let all = self.patches.all().iter();
        let of_one = |eye| Hidden::OfOne(all.map(|p| culling::is_hidden(p, eye)).collect());
        eye.map_or(Hidden::OfEach, of_one)
    }

    fn is_hidden(&self, hidden: &Hidden, index: usize, ray: Ray) -> bool {
        match hidden {
            Hidden::None => false,
            Hidden::OfOne(hidden) => hidden[index],
            Hidden::OfEach => culling::is_hidden(&self.patches.all()[index], ray.origin.as_dvec3()),
        }
    }

    /// The normal of a ray's hit, if it has one.
    pub(crate) fn normal(&self, ray: Ray, range: [f64; 2]) -> Vec3 {
        let request = Request::FirstWithNormal;
        match &self.pieces {
            Pieces::Single(pieces) => self.answer(pieces, &Hidden::None, request, ray, range).1,
            Pieces::Double(pieces) => self.answer(pieces, &Hidden::None, request, ray, range).1,
        }
    }

    fn answer<T: Float>(
        &self,
        pieces: &[Piece<T>],
        hidden: &Hidden,
        request: Request,
        ray: Ray,
        range: [f64; 2],
    ) -> (Hit, Vec3) {
        let mut work = Work::default();
        let mut found = Found::new(&self.patches, request, ray, range);
        self.hierarchy.walk(ray, range, |index| {
            if !self.is_hidden(hidden, index, ray) {
                work.points += 1;
                found.add(index, pieces[index].crossings(ray));
            }
            found.end()
        });
        let Some(crossing) = found.first() else {
            return (Hit::miss(Certificate::MISS, work), Vec3::ZERO);
        };
        let mut normal = Vec3::ZERO;
        if request == Request::FirstWithNormal {
            work.gradients += 1;
            normal = crossing.gradient.normalize_or_zero().as_vec3();
        }
        (Hit { bracket: [crossing.t; 2], certificate: Certificate::HIT, work }, normal)
    }
}

/// Which patches show their inside alone, and are left out.
enum Hidden {
    /// It does not matter.
    None,
    /// To the eye that all rays share.
    OfOne(Vec<bool>),
    /// It is for each ray to find out.
    OfEach,
}

/// The eye that all rays of a view start from, as they do: rounded.
pub(crate) fn one_eye(view: &View) -> Option<DVec3> {
    match view.camera().projection {
        Projection::Perspective { .. } => Some(view.ray(0, 0).origin.as_dvec3()),
        Projection::Orthographic { .. } => None,
    }
}

fn pieces<T: Float>(method: &Quadrics, patches: &Patches) -> Vec<Piece<T>> {
    patches.all().iter().map(|patch| Piece::new(patch, method.formula)).collect()
}

/// Over the boxes of the patches' bounds.
pub(crate) fn hierarchy(patches: &Patches) -> Hierarchy {
    Hierarchy::new(patches.all().iter().map(|patch| {
        let [min, max] = patch.corners();
        // Roots count a little beyond a bound.
        let margin = 1e-5 * (max - min).max_element();
        [min - margin, max + margin]
    }))
}

/// What was found on a ray so far.
struct Found<'a> {
    patches: &'a Patches,
    request: Request,
    /// Of t.
    range: [f64; 2],
    /// Per unit of t.
    speed: f64,
    nearest: Option<Crossing>,
    fragments: Vec<Fragment>,
    end: f64,
}

impl<'a> Found<'a> {
    fn new(patches: &'a Patches, request: Request, ray: Ray, range: [f64; 2]) -> Self {
        let speed = ray.direction.as_dvec3().length();
        let (nearest, fragments) = (None, Vec::new());
        Self { patches, request, range, speed, nearest, fragments, end: range[1] }
    }

    /// Where there is nothing more to find.
    fn end(&self) -> f64 {
        // A fragment at the end of its ball has no weight.
        let has_weight = |f: &Fragment| f.crossing.distance < 1.0;
        let has_found = self.nearest.is_some() || self.fragments.iter().any(has_weight);
        let is_done = self.request == Request::Any && has_found;
        if is_done { f64::NEG_INFINITY } else { self.end }
    }

    fn add(&mut self, index: usize, [enters, leaves]: [Option<Crossing>; 2]) {
        self.take(index, enters);
        if self.patches.sides() == Sides::Both {
            self.take(index, leaves);
        }
    }

    fn take(&mut self, index: usize, crossing: Option<Crossing>) {
        let [from, to] = self.range;
        let Some(crossing) = crossing.filter(|c| from <= c.t && c.t <= to) else { return };
        match (self.patches.blending(), self.patches.all()[index].bound) {
            (Blending::Weighted { offset }, Bound::Ball { radius, .. }) => {
                let reach = offset * radius / self.speed;
                self.end = self.end.min(crossing.t + reach);
                self.fragments.push(Fragment { crossing, reach });
            }
            _ if self.nearest.is_none_or(|nearest| crossing.t < nearest.t) => {
                self.end = crossing.t;
                self.nearest = Some(crossing);
            }
            _ => {}
        }
    }

    fn first(&self) -> Option<Crossing> {
        match self.patches.blending() {
            Blending::None => self.nearest,
            Blending::Weighted { .. } => blend::sheet(&self.fragments),
        }
    }
}

impl Intersector for PreparedQuadrics {
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
        let hidden = &self.hidden(rays);
        tiles::cast(rays, hits, progress, |tile| {
            let each = |&ray| match &self.pieces {
                Pieces::Single(pieces) => self.answer(pieces, hidden, request, ray, range),
                Pieces::Double(pieces) => self.answer(pieces, hidden, request, ray, range),
            };
            tile.iter().map(each).collect::<Vec<_>>()
        })
    }
}

/// Quadrics have no parameters.
///
/// # Errors
/// If there are values.
pub(crate) fn no_parameters(values: &Parameters) -> Result<(), Error> {
    match values.iter().next() {
        None => Ok(()),
        Some((name, _)) => {
            let message = format!("no parameter {name:?}; quadrics in bounds have none");
            Err(Error::Parameter(ParameterError { message }))
        }
    }
}
