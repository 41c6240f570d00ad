//! Quadrics on a device, prepared for a scene.

use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec3;
use zeroset_expr::Parameters;
use zeroset_raycast::{
    Certificate, Error, Hit, Hits, Intersector, Method, Patches, Progress, Ray, Rays, Report,
    Request, Unsupported, Work,
};

use super::QuadricsGpu;
use super::buffers::Answer;
use super::painter::{Kind, Painter};
use crate::piece::Formula;
use crate::prepared::no_parameters;

/// [`QuadricsGpu`] for one scene.
pub(super) struct PreparedOnDevice {
    method: QuadricsGpu,
    patches: Arc<Patches>,
    painter: Mutex<Option<Painter>>,
}

impl PreparedOnDevice {
    pub(super) fn new(method: &QuadricsGpu, patches: Arc<Patches>) -> Self {
        Self { method: method.clone(), patches, painter: Mutex::default() }
    }

    /// The hit of a pixel's ray, and the normal.
    fn hit(&self, answer: &Answer, painter: &Painter, ray: Ray) -> (Hit, Vec3) {
        let miss = Hit::miss(Certificate::MISS, Work::default());
        if !ray.is_valid() {
            let no_ray = Work { nonfinite: 1, ..Work::default() };
            return (Hit { work: no_ray, ..miss }, Vec3::ZERO);
        }
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let point = painter.centre() + answer.position.as_dvec3();
        let t = (point - origin).dot(direction) / direction.length_squared();
        if !(answer.weight > 0.0 && t >= 0.0 && t.is_finite()) {
            return (miss, Vec3::ZERO);
        }
        let hit = Hit { bracket: [t; 2], certificate: Certificate::HIT, ..miss };
        (hit, answer.normal.normalize_or_zero())
    }
}

impl Intersector for PreparedOnDevice {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        no_parameters(values)
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        assert_eq!(rays.len(), hits.len(), "one answer a ray");
        let unsupported = |why: String| Error::Unsupported(Unsupported(why));
        let id = self.method.id();
        let Rays::View(view) = rays else {
            return Err(unsupported(format!("{id} draws views, it casts no single rays")));
        };
        progress.advance(0)?;
        if rays.is_empty() {
            return Ok(Report::default());
        }
        let kind = Kind::of(view);
        if kind == Kind::Orthographic && self.method.formula != Formula::Local {
            return Err(unsupported(format!(
                "the formulas about the eye need one: set {id}.formula=local for orthographic views"
            )));
        }
        let mut state = self.painter.lock().unwrap_or_else(PoisonError::into_inner);
        if state.as_ref().is_none_or(|painter| !painter.fits(kind)) {
            // What was there makes room first.
            *state = None;
            let device = self.method.open(&self.patches)?;
            *state = Some(Painter::new(device, &self.method, &self.patches, kind)?);
        }
        let Some(painter) = state.as_mut() else { unreachable!("it was just made") };
        let longest = painter.device.longest_side();
        if view.width.max(view.height) > longest {
            return Err(unsupported(format!(
                "an image of {} x {} pixels is too large for this device: at most {longest} a side",
                view.width, view.height
            )));
        }
        let most = painter.device.largest_binding() as usize / size_of::<Answer>();
        if rays.len() > most {
            return Err(unsupported(format!(
                "an image of {} x {} pixels is too large for this device: at most {most} pixels",
                view.width, view.height
            )));
        }
        let drawn = painter.draw(view);
        let (answers, device_time) = match drawn {
            Ok(drawn) => drawn,
            Err(error) => {
                *state = None;
                return Err(error.into());
            }
        };
        let painter = &*painter;
        let mut work = Work::default();
        for (index, answer) in answers.iter().enumerate() {
            let (mut hit, normal) = self.hit(answer, painter, rays.get(index));
            if hits.request == Request::FirstWithNormal && hit.certificate.is_hit() {
                hit.work.gradients += 1;
                hits.normal[index] = normal;
            } else if let Some(place) = hits.normal.get_mut(index) {
                *place = Vec3::ZERO;
            }
            hits.set(index, hit);
            work += hit.work;
        }
        progress.advance(rays.len())?;
        Ok(Report { work, device_time })
    }
}
