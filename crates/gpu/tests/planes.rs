//! The ray's own arithmetic on a device loses no root.
//!
//! At the finest depth a piece of the ray is a unit in the last place long. Without outward rounding of
//! the piece's ends, of the product and of the sum that make a point, many of them miss the plane.

mod adapter;

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use zeroset_cpu::{Bisection, Finishing, Stop};
use zeroset_expr::Function;
use zeroset_gpu::BisectionGpu;
use zeroset_raycast::{
    Certificate, Domain, Hits, Method, Progress, Ray, RayBatch, Rays, Request, Scene,
};

/// A ray through the unit cube towards larger x.
fn ray() -> impl Strategy<Value = Ray> {
    let far = prop_oneof![Just(1.0_f32), Just(30.0), Just(1e4)];
    let side = -0.5_f32..0.5;
    (side.clone(), side.clone(), side, -0.3_f32..0.3, -0.3_f32..0.3, far, 0.2_f32..5.0).prop_map(
        |(x, y, z, u, v, far, speed)| {
            let direction = Vec3::new(1.0, u, v);
            Ray::new(Vec3::new(x, y, z) - (1.0 + far) * direction, speed * direction)
        },
    )
}

#[test]
fn planes_are_not_lost_between_pieces() {
    if adapter::device().is_none() {
        return;
    }
    let mut runner = TestRunner::deterministic();
    let mut hit = 0;
    // The first constant is a float, the others are not.
    for (equation, place) in [("x = 0.25", 0.25), ("x = 0.3", 0.3), ("x = -1/7", -1.0 / 7.0)] {
        let domain = Domain::new(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap();
        let scene = Scene::new("plane", Function::parse(equation).unwrap(), domain);
        let method = BisectionGpu::auto(Bisection {
            stop: Stop::Depth(40),
            finish: Finishing::Accept,
            ..Bisection::tbisect()
        });
        let rays: Vec<Ray> =
            (0..4096).map(|_| ray().new_tree(&mut runner).unwrap().current()).collect();
        let batch = RayBatch::new(rays);
        let mut hits = Hits::new(Request::First, batch.rays.len());
        let intersector = method.prepare(&scene).unwrap();
        intersector.intersect(Rays::Batch(&batch), &mut hits, &Progress::new()).unwrap();
        for (i, ray) in batch.rays.iter().enumerate() {
            // In double precision: the error is far below a unit of single precision.
            let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
            let t = (place - o.x) / d.x;
            let p = o + t * d;
            if p.abs().max_element() > 0.999 {
                continue;
            }
            let answer = hits.get(i);
            assert_eq!(answer.certificate, Certificate::POSSIBLE_HIT, "{ray:?}: {answer:?}");
            assert!(answer.bracket[0] <= t * (1.0 + 1e-14), "{ray:?}: {answer:?}, {t}");
            // And it is near: pieces are fine.
            let near = 1e-5 / d.x.abs() + 1e-5 * t.abs();
            assert!(t - answer.bracket[1] <= near, "{ray:?}: {answer:?}, {t}");
            hit += 1;
        }
    }
    assert!(hit > 6000, "{hit}");
}
