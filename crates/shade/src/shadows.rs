//! Shadows: what a light does not reach, \[knoll2007\] Section 5.6.

use glam::Vec3;
use zeroset_raycast::{Domain, Hits, Ray, RayBatch, View};

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
/// slabs are 4 w long along the axis of the march, at most 4 sqrt(3) w < 8 w along the ray: so the
/// slab in which it starts does not reach back to the surface that it starts from.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowRays {
    /// The rays, neighbours together.
    pub batch: RayBatch,
    /// The pixel of each ray.
    pixels: Vec<usize>,
    /// How many pixels there are.
    count: usize,
}

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
        let (mut rays, mut pixels) = (Vec::new(), Vec::new());
        for pixel in blocks(view) {
            if let Some(ray) = start(view, hits, domain, pixel, towards) {
                rays.push(ray);
                pixels.push(pixel);
            }
        }
        Ok(Self { batch: RayBatch::new(rays), pixels, count: hits.len() })
    }

    /// The pixels of the view that the light does not reach, by the answers to the rays; for
    /// [`Light::blocked`].
    ///
    /// # Errors
    /// If there is not one answer for each ray.
    pub fn blocked(&self, answers: &Hits) -> Result<Vec<bool>, ShadeError> {
        let (rays, got) = (self.pixels.len(), answers.len());
        if got != rays {
            return Err(ShadeError::Answers { got, rays });
        }
        let mut blocked = vec![false; self.count];
        for (pixel, certificate) in self.pixels.iter().zip(&answers.certificate) {
            blocked[*pixel] = certificate.is_hit();
        }
        Ok(blocked)
    }
}

/// The ray of a pixel; `None` where the light adds nothing, or nothing is known of the surface.
fn start(view: &View, hits: &Hits, domain: &Domain, pixel: usize, towards: Vec3) -> Option<Ray> {
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
    Some(Ray::new(origin.as_vec3(), towards)).filter(|ray| ray.is_valid())
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
