//! Shadows: what a light does not reach, \[knoll2007\] Section 5.6.

use glam::Vec3;
use zeroset_raycast::{Certificate, Domain, Hits, Ray, RayBatch, View};

use crate::normals::seen;
use crate::picture::check_normals;
use crate::{Light, ShadeError};

/// Pixels of a block: rays of neighbours stay together.
const BLOCK: [usize; 2] = [8, 4];

/// The rays from what a view's rays hit to a light.
///
/// There is one for each pixel that the light would brighten: where n.l > 0, with n facing the eye.
/// It starts at p + h n, p being the middle of the bracket, and runs along l until it leaves the
/// domain; what lies outside the domain casts no shadow. The offset is
///
/// h = max(8 w, min(2 a, s / 256)), at most s / 8,
///
/// for a bracket of width w in space, a pixel's footprint a at p, and the domain's longest side s.
/// A shadow ray may be cast to a coarser depth than the ray that hit. At two bisections less its
/// slabs are 4 w long along the axis of the march, at most 4 sqrt(3) w < 8 w along the ray of a
/// cube: so the slab in which it starts does not reach back to the surface that it starts from.
///
/// At that depth the surface may be thicker than h, where intervals are wide. A hit that begins at
/// the ray's start and holds no proven root is taken for the surface itself: [`further`] starts
/// again beyond it.
///
/// [`further`]: Self::further
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowRays {
    /// The rays, neighbours together.
    pub batch: RayBatch,
    /// The pixel of each ray.
    pixels: Vec<usize>,
    /// How far from a ray's start a hit may be the surface that it comes from.
    reach: Vec<f64>,
    /// How often the rays have started again.
    again: u32,
}

/// How often a ray starts again: after h, 2 h, 4 h and 8 h.
const AGAIN: u32 = 4;

impl ShadowRays {
    /// The rays from the hits of a view to a light.
    ///
    /// # Errors
    /// If the hits are not those of the view, or have no normals.
    pub fn new(
        view: &View,
        hits: &Hits,
        domain: &Domain,
        light: &Light,
    ) -> Result<Self, ShadeError> {
        check_normals(view, hits, "shaded")?;
        let towards = light.direction.normalize_or_zero();
        let mut rays = Self::none(0);
        for pixel in blocks(view) {
            if let Some((ray, offset)) = start(view, hits, domain, pixel, towards) {
                rays.push(ray, pixel, offset);
            }
        }
        Ok(rays)
    }

    /// Marks the pixels that the light does not reach, by the answers to the rays; for
    /// [`Light::blocked`].
    ///
    /// # Errors
    /// If there is not one answer for each ray.
    ///
    /// # Panics
    /// If `blocked` is not as long as the view has pixels.
    pub fn mark(&self, answers: &Hits, blocked: &mut [bool]) -> Result<(), ShadeError> {
        self.check(answers)?;
        for (pixel, certificate) in self.pixels.iter().zip(&answers.certificate) {
            blocked[*pixel] = certificate.is_hit();
        }
        Ok(())
    }

    /// The rays that may have hit the surface that they come from, started again beyond it; what
    /// they find counts instead. There are none after four times.
    ///
    /// # Errors
    /// If there is not one answer for each ray.
    pub fn further(&self, answers: &Hits) -> Result<Self, ShadeError> {
        self.check(answers)?;
        let mut rays = Self::none(self.again + 1);
        if self.again == AGAIN {
            return Ok(rays);
        }
        for (i, ray) in self.batch.rays.iter().enumerate() {
            let (certificate, reach) = (answers.certificate[i], self.reach[i]);
            let is_sure = !certificate.is_hit() || certificate.contains(Certificate::ROOT);
            if is_sure || !(answers.bracket[i][0] <= reach) {
                continue;
            }
            let ray = Ray::new(ray.at(reach).as_vec3(), ray.direction);
            rays.push(ray, self.pixels[i], 2.0 * reach);
        }
        Ok(rays)
    }

    /// Are there no rays?
    pub fn is_empty(&self) -> bool {
        self.pixels.is_empty()
    }

    fn none(again: u32) -> Self {
        let batch = RayBatch::new(Vec::new());
        Self { batch, pixels: Vec::new(), reach: Vec::new(), again }
    }

    fn push(&mut self, ray: Ray, pixel: usize, reach: f64) {
        self.batch.rays.push(ray);
        self.pixels.push(pixel);
        self.reach.push(reach);
    }

    fn check(&self, answers: &Hits) -> Result<(), ShadeError> {
        let (rays, got) = (self.pixels.len(), answers.len());
        if got == rays { Ok(()) } else { Err(ShadeError::Answers { got, rays }) }
    }
}

/// The ray of a pixel and its offset; `None` where the light adds nothing, or nothing is known of the
/// surface.
fn start(
    view: &View,
    hits: &Hits,
    domain: &Domain,
    pixel: usize,
    towards: Vec3,
) -> Option<(Ray, f64)> {
    if !hits.certificate[pixel].is_hit() {
        return None;
    }
    let normal = seen(view, pixel, hits.normal[pixel])?.normal;
    // A normal that is NaN is turned to no light.
    if !(normal.dot(towards) > 0.0) {
        return None;
    }
    let ray = view.ray(pixel % view.width, pixel / view.width);
    let hit = hits.get(pixel);
    let length = ray.direction.as_dvec3().length();
    let width = length * (hit.bracket[1] - hit.bracket[0]);
    let side = domain.longest_side();
    let near = (2.0 * view.footprint(length * hit.t())).min(side / 256.0);
    let offset = (8.0 * width).max(near).min(side / 8.0);
    let origin = ray.at(hit.t()) + offset * normal.as_dvec3();
    let ray = Ray::new(origin.as_vec3(), towards);
    ray.is_valid().then_some((ray, offset))
}

/// The pixels of a view, block by block.
fn blocks(view: &View) -> impl Iterator<Item = usize> {
    let (width, height) = (view.width, view.height);
    let [wide, high] = BLOCK;
    (0..height).step_by(high).flat_map(move |top| {
        (0..width).step_by(wide).flat_map(move |left| {
            (top..(top + high).min(height))
                .flat_map(move |y| (left..(left + wide).min(width)).map(move |x| y * width + x))
        })
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use zeroset_raycast::Camera;

    use super::*;

    #[test]
    fn blocks_show_every_pixel_once() {
        let domain = Domain::new(DVec3::NEG_ONE, DVec3::ONE).unwrap();
        for [width, height] in [[1, 1], [8, 4], [17, 9], [3, 21]] {
            let view = View::new(Camera::facing(&domain), width, height);
            let mut pixels: Vec<_> = blocks(&view).collect();
            assert!(width < 9 || pixels[8] == width, "{pixels:?}");
            pixels.sort_unstable();
            assert!(pixels.iter().copied().eq(0..width * height), "{pixels:?}");
        }
    }
}
