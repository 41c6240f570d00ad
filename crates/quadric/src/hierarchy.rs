//! Which boxes a ray may meet.

use glam::{DVec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use zeroset_raycast::Ray;

/// A bounding volume hierarchy over boxes.
///
/// It is built by a library. It is walked here, in double precision with room for every rounding: a box that
/// the ray meets is never left out.
pub(crate) struct Hierarchy {
    bvh: Bvh2,
    /// What its numbers are times, a power of two: the library's areas are in single precision.
    unit: f64,
}

/// 8 units of 2^-53: a quotient of a difference has three roundings, and the ends one more.
const SLACK: f64 = 8.0 * 0.5 * f64::EPSILON;

impl Hierarchy {
    /// Over boxes, each a least and a greatest corner.
    pub(crate) fn new(boxes: impl Iterator<Item = [DVec3; 2]>) -> Self {
        let boxes: Vec<[DVec3; 2]> = boxes.collect();
        let reach = |[min, max]: &[DVec3; 2]| min.abs().max(max.abs()).max_element();
        let largest = boxes.iter().map(reach).fold(f64::MIN_POSITIVE, f64::max);
        let unit = largest.log2().round().clamp(-900.0, 1000.0).exp2();
        let boxes: Vec<Aabb> = boxes
            .iter()
            .map(|[min, max]| Aabb { min: below(*min / unit), max: above(*max / unit) })
            .collect();
        let mut time = std::time::Duration::ZERO;
        Self { unit, bvh: build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut time) }
    }

    /// Shows the index of every box that the ray may meet at some t in the closed range [from, to], those in
    /// nearer parts of space first. What `see` gives is the new `to`.
    pub(crate) fn walk(
        &self,
        ray: Ray,
        [from, mut to]: [f64; 2],
        mut see: impl FnMut(usize) -> f64,
    ) {
        let line = Line::new(ray, self.unit);
        let nodes = &self.bvh.nodes;
        let enter =
            |node: usize| line.enter(&nodes[node].aabb().min, &nodes[node].aabb().max, from);
        let Some(root) = (!nodes.is_empty()).then(|| enter(0)).flatten() else { return };
        let mut stack = vec![(root, 0_usize)];
        while let Some((near, index)) = stack.pop() {
            if near > to {
                continue;
            }
            let node = &nodes[index];
            if node.is_leaf() {
                for slot in node.first_index..node.first_index + node.prim_count {
                    to = see(self.bvh.primitive_indices[slot as usize] as usize);
                }
                continue;
            }
            let first = node.first_index as usize;
            let [a, b] = [first, first + 1].map(|child| enter(child).map(|near| (near, child)));
            // The nearer one is taken first.
            let ordered = match (a, b) {
                (Some(a), Some(b)) if a.0 <= b.0 => [Some(b), Some(a)],
                other => [other.0, other.1],
            };
            stack.extend(ordered.into_iter().flatten().filter(|(near, _)| *near <= to));
        }
    }
}

/// The greatest vector of single precision that is nowhere above.
fn below(v: DVec3) -> Vec3A {
    Vec3A::from_array(v.to_array().map(|x| {
        let near = x as f32;
        if f64::from(near) > x { near.next_down() } else { near }
    }))
}

/// The least vector of single precision that is nowhere below.
fn above(v: DVec3) -> Vec3A {
    -below(-v)
}

/// A ray, as boxes are cut with it.
struct Line {
    origin: DVec3,
    direction: DVec3,
    inverse: DVec3,
}

impl Line {
    /// In a unit of length that is a power of two, and so changes no digit.
    fn new(ray: Ray, unit: f64) -> Self {
        let (origin, direction) = (ray.origin.as_dvec3() / unit, ray.direction.as_dvec3() / unit);
        Self { origin, direction, inverse: direction.recip() }
    }

    /// A bound from below of the t from which on the line may be in the box, not before `from`; none if it is
    /// never there.
    fn enter(&self, min: &Vec3A, max: &Vec3A, from: f64) -> Option<f64> {
        let (mut near, mut far) = (from, f64::INFINITY);
        for axis in 0..3 {
            let (o, min, max) = (self.origin[axis], f64::from(min[axis]), f64::from(max[axis]));
            if self.direction[axis] == 0.0 {
                if o < min || max < o {
                    return None;
                }
                continue;
            }
            let ends = [min, max].map(|end| (end - o) * self.inverse[axis]);
            let [a, b] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            near = near.max(a - a.abs() * SLACK - f64::MIN_POSITIVE);
            far = far.min(b + b.abs() * SLACK + f64::MIN_POSITIVE);
        }
        (near <= far).then_some(near)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use proptest::prelude::*;

    fn boxes() -> Vec<[DVec3; 2]> {
        let place = |i: u32| {
            let k = f64::from(i);
            5.0 * DVec3::new((1.7 * k).sin(), (2.3 * k).sin(), (3.1 * k).sin())
        };
        (0..300)
            .map(|i| (place(i), 0.05 + 0.3 * f64::from(i % 7)))
            .map(|(centre, half)| [centre - half, centre + half])
            .collect()
    }

    proptest! {
        #[test]
        fn every_box_that_holds_a_point_of_the_ray_is_seen(
            origin in proptest::array::uniform3(-20.0..20.0_f32),
            direction in proptest::array::uniform3(prop_oneof![Just(0.0), -1.0..1.0_f32]),
            far in 0.0..50.0,
        ) {
            let ray = Ray::new(Vec3::from(origin), Vec3::from(direction));
            prop_assume!(ray.is_valid());
            let boxes = boxes();
            let mut seen = Vec::new();
            Hierarchy::new(boxes.iter().copied()).walk(ray, [0.0, far], |i| {
                seen.push(i);
                far
            });
            for (i, [min, max]) in boxes.iter().enumerate() {
                let inside = (0..2000).any(|k| {
                    let p = ray.at(far * f64::from(k) / 2000.0);
                    p.cmpge(*min).all() && p.cmple(*max).all()
                });
                prop_assert!(!inside || seen.contains(&i), "{i}");
            }
            let count = seen.len();
            seen.sort_unstable();
            seen.dedup();
            prop_assert_eq!(seen.len(), count);
        }
    }

    #[test]
    fn what_lies_beyond_is_not_seen() {
        let at = |x: f64| [DVec3::new(x, -1.0, -1.0), DVec3::new(x + 1.0, 1.0, 1.0)];
        let hierarchy = Hierarchy::new((0..100).map(|i| at(2.0 * f64::from(i))));
        let ray = Ray::new(Vec3::new(-5.0, 0.0, 0.0), Vec3::X);
        let mut seen = Vec::new();
        hierarchy.walk(ray, [0.0, f64::INFINITY], |i| {
            seen.push(i);
            // Nothing beyond the box that was seen.
            6.0 + 2.0 * i as f64
        });
        // A leaf holds a few.
        assert!(seen.contains(&0) && seen.iter().all(|i| *i < 8), "{seen:?}");
        let away = Ray::new(Vec3::new(-5.0, 0.0, 0.0), Vec3::NEG_X);
        hierarchy.walk(away, [0.0, f64::INFINITY], |i| panic!("{i}"));
        Hierarchy::new(std::iter::empty()).walk(ray, [0.0, 1.0], |i| panic!("{i}"));
    }
}
