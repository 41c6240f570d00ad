//! Rays cast at patches in the plainest way: all roots of all quadrics, each held against its tetrahedron.
#![allow(dead_code, unreachable_pub, reason = "each test uses a part")]

use glam::DVec3;
use zeroset_raycast::{Bound, Patch, Patches};

/// A root of a patch in its bound.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    pub t: f64,
    /// Half the derivative of f along the ray: below 0 where it enters the inside.
    pub slope: f64,
    pub patch: usize,
}

/// All crossings on a line, by t.
pub fn crossings(patches: &Patches, origin: DVec3, direction: DVec3) -> Vec<Crossing> {
    let mut all = Vec::new();
    for (index, patch) in patches.all().iter().enumerate() {
        all.extend(roots(patch, origin - patch.origin, direction).into_iter().filter_map(|t| {
            let x = origin - patch.origin + t * direction;
            let slope = patch.quadric.half_gradient(x).dot(direction);
            is_inside(&patch.bound, x).then_some(Crossing { t, slope, patch: index })
        }));
    }
    all.sort_by(|a, b| a.t.total_cmp(&b.t));
    all
}

fn roots(patch: &Patch, origin: DVec3, direction: DVec3) -> [f64; 2] {
    // About the point that is nearest to the middle of the bound.
    let (centre, _) = patch.bound.ball();
    let start = (centre - origin).dot(direction) / direction.length_squared();
    let x = origin + start * direction;
    let alpha = direction.dot(patch.quadric.a * direction);
    let beta = direction.dot(patch.quadric.half_gradient(x));
    let gamma = patch.quadric.value(x);
    let q = -(beta + (beta * beta - alpha * gamma).sqrt().copysign(beta));
    [gamma / q, q / alpha].map(|t| start + t)
}

/// Is the point in the tetrahedron, but for 64 roundings of its size?
fn is_inside(bound: &Bound, x: DVec3) -> bool {
    let Bound::Tetrahedron(corners) = *bound else { panic!("a ball") };
    let margin = 64.0 * f64::EPSILON * bound.ball().1;
    (0..4).all(|i| {
        let [a, b, c, across] = [1, 2, 3, 4].map(|k| corners[(i + k) % 4]);
        let normal = (b - a).cross(c - a).normalize();
        let side = normal.dot(across - a).signum();
        side * normal.dot(x - a) >= -margin
    })
}
