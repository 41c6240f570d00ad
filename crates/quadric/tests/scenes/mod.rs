//! Scenes of patches that are known in full.
#![allow(dead_code, unreachable_pub, missing_docs, reason = "each test uses a part")]

use glam::{DMat3, DVec3};
use zeroset_raycast::{Blending, Bound, Patch, Patches, Quadric, Scene, Sides};

pub fn sphere(radius: f64) -> Quadric {
    Quadric { a: DMat3::IDENTITY, b: DVec3::ZERO, c: -radius * radius }
}

/// The unit sphere around a point, in balls around points spread over it.
pub fn balls(at: DVec3, count: u32, radius: f64, blending: Blending) -> Scene {
    let patches = (0..count)
        .map(|i| {
            let z = (f64::from(i) + 0.5) / f64::from(count) * 2.0 - 1.0;
            let (sin, cos) = (2.399_963_229_728_653 * f64::from(i)).sin_cos();
            let flat = (1.0 - z * z).sqrt();
            let place = DVec3::new(flat * cos, flat * sin, z);
            let bound = Bound::Ball { centre: DVec3::ZERO, radius };
            Patch { origin: at + place, quadric: sphere(1.0).about(place), bound, clip: None }
        })
        .collect();
    Scene::of_patches("balls", Patches::new(patches, Sides::Front, blending).unwrap())
}

/// A quadric in a cube of `n`^3 cubes around a point, each of six tetrahedra.
pub fn cubes(at: DVec3, quadric: Quadric, half: f64, n: u32, sides: Sides) -> Scene {
    let side = 2.0 * half / f64::from(n);
    let place = |i: [u32; 3]| DVec3::from(i.map(|i| -half + side * f64::from(i)));
    let mut patches = Vec::new();
    for x in 0..n {
        for y in 0..n {
            for z in 0..n {
                for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
                    let mut corner = [x, y, z];
                    let mut corners = [place(corner); 4];
                    for (k, axis) in order.into_iter().enumerate() {
                        corner[axis] += 1;
                        corners[k + 1] = place(corner);
                    }
                    let middle = place([x, y, z]) + 0.5 * side;
                    let bound = Bound::Tetrahedron(corners.map(|corner| corner - middle));
                    let quadric = quadric.about(middle);
                    patches.push(Patch { origin: at + middle, quadric, bound, clip: None });
                }
            }
        }
    }
    Scene::of_patches("cubes", Patches::new(patches, sides, Blending::None).unwrap())
}
