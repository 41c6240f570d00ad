//! A deeper bisection hits no more: with poles shown, the rays that hit at one d_stop are among those that
//! hit at every smaller one, on every surface of the catalogue, for each of the algorithms of
//! [knoll2007] (Section 6.3: the rendered contour always encloses the zero set).

use zeroset_cpu::{Algorithm, Bisection, Finishing, Poles, Stop};
use zeroset_raycast::catalogue::Catalogue;
use zeroset_raycast::{Camera, Hits, Method, Progress, Rays, Request, Scene, View};

/// Pixels along a side.
const SIZE: usize = 24;

/// Which rays hit.
fn hits(scene: &Scene, view: &View, algorithm: Algorithm, depth: u32) -> Vec<bool> {
    let method = Bisection {
        stop: Stop::Depth(depth),
        finish: Finishing::Accept,
        poles: Poles::Shown,
        ..Bisection::new(algorithm)
    };
    let rays = Rays::View(view);
    let mut hits = Hits::new(Request::First, rays.len());
    let intersector = method.prepare(scene).expect("every surface is a function");
    intersector.intersect(rays, &mut hits, &Progress::new()).expect("answers");
    hits.certificate.iter().map(|certificate| certificate.is_hit()).collect()
}

#[test]
fn deeper_hits_are_among_shallower_ones() {
    let mut fewer = 0;
    for surface in Catalogue::builtin().functions() {
        let scene = surface.scene().expect("the catalogue is well formed");
        let view = View::new(Camera::facing(&scene.domain), SIZE, SIZE);
        for algorithm in [Algorithm::Kmarch, Algorithm::Tbisect, Algorithm::Mitchell] {
            let mut shallower = hits(&scene, &view, algorithm, 4);
            for depth in 5..=14 {
                let deeper = hits(&scene, &view, algorithm, depth);
                for (i, (deep, shallow)) in deeper.iter().zip(&shallower).enumerate() {
                    let place = format!("{} {algorithm:?} depth {depth} ray {i}", surface.id);
                    assert!(*shallow || !deep, "{place}: hit, but not one depth before");
                    fewer += usize::from(*shallow && !deep);
                }
                shallower = deeper;
            }
        }
    }
    assert!(fewer > 1000, "depth makes a difference: {fewer}");
}
