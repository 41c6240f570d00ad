//! Normals where the gradient has none.

use glam::DVec3;
use zeroset_cpu::Amp;
use zeroset_expr::Function;
use zeroset_raycast::{Camera, Domain, Hits, Method, Progress, Rays, Request, Scene, View};

fn cast(equation: &str) -> Hits {
    let domain = Domain::new(DVec3::splat(-1.0625), DVec3::splat(1.0625)).unwrap();
    let scene = Scene::new(equation, Function::parse(equation).unwrap(), domain);
    let view = View::new(Camera::facing(&domain), 48, 48);
    let mut hits = Hits::new(Request::FirstWithNormal, 48 * 48);
    let intersector = Amp::default().prepare(&scene).unwrap();
    intersector.intersect(Rays::View(&view), &mut hits, &Progress::new()).unwrap();
    hits
}

/// By cosines, infinite derivatives of clamped arguments are multiplied by 0.
#[test]
fn cosine_forms_have_the_normals_of_polynomials() {
    let [expected, found] =
        ["T", "Tcos"].map(|form| cast(&format!("{form}(6,x)+{form}(6,y)+{form}(6,z)")));
    let (mut hits, mut along) = (0, 0);
    for i in 0..found.len() {
        let apart = (found.get(i).t() - expected.get(i).t()).abs();
        if found.certificate[i].is_hit() && apart < 1e-3 {
            hits += 1;
            along += usize::from(found.normal[i].dot(expected.normal[i]) > 0.99);
        }
    }
    assert!(hits > 500 && along * 100 > hits * 98, "{along} of {hits}");
}
