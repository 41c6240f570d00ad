//! Every method of the registry conforms, on surfaces of every kind.

use glam::DVec3;
use zeroset_bench::Registry;
use zeroset_bench::conformance::{Failure, check};
use zeroset_expr::Function;
use zeroset_raycast::{Domain, Scene};

fn scene(id: &str, equation: &str, half: f64, ball: Option<f64>) -> Scene {
    let function = Function::parse(equation).unwrap();
    let domain = Domain::new(DVec3::splat(-half), DVec3::splat(half)).unwrap();
    Scene::new(id, function, Domain { ball, ..domain })
}

/// Checks every method, and those that can certify also when they do; the failures of all are told at
/// once.
fn check_all(scene: &Scene) {
    let registry = Registry::standard();
    let certified = registry.certified();
    let methods = registry.iter().chain(certified.iter().map(AsRef::as_ref));
    let failures: Vec<(&str, Failure)> = methods
        .flat_map(|m| check(m, scene).into_iter().map(|failure| (m.id(), failure)))
        .collect();
    let told: Vec<_> = failures.iter().map(|(id, failure)| format!("{id}: {failure}")).collect();
    assert!(told.is_empty(), "{}:\n{}", scene.id, told.join("\n"));
}

#[test]
fn on_a_smooth_surface() {
    check_all(&scene("sphere", "x^2 + y^2 + z^2 = r^2; r = 1", 1.5, None));
}

#[test]
fn on_a_surface_cut_by_a_ball() {
    let equation = "5*(x^2*(y+z) + y^2*(x+z) + z^2*(x+y)) = 2*(x*y + y*z + x*z)";
    check_all(&scene("cayley", equation, 1.5, Some(1.5)));
}

#[test]
fn on_a_surface_with_a_double_curve() {
    check_all(&scene("steiner", "x^2*y^2 + y^2*z^2 + x^2*z^2 + x*y*z", 1.0, None));
}

#[test]
fn on_a_surface_that_is_touched_and_never_crossed() {
    check_all(&scene("squared", "(x^2 + y^2 + z^2 - 1)^2", 1.5, None));
}

#[test]
fn on_a_surface_with_exponentials() {
    let equation = "exp(-4*((x-0.5)^2 + y^2 + z^2)) + exp(-4*((x+0.5)^2 + y^2 + z^2)) = 0.5";
    check_all(&scene("blobs", equation, 1.5, None));
}

#[test]
fn on_a_surface_with_a_pole() {
    check_all(&scene("pole", "1/x - y - z", 2.0, None));
}

#[test]
fn on_a_surface_with_many_nodes() {
    let equation = "4*(p^2*x^2-y^2)*(p^2*y^2-z^2)*(p^2*z^2-x^2) \
                    - (1+2*p)*(x^2+y^2+z^2-1)^2; p = (1+sqrt(5))/2";
    check_all(&scene("barth-sextic", equation, 2.0, Some(2.0)));
}

#[test]
fn on_a_surface_with_jumps() {
    check_all(&scene("steps", "floor(2*x + 0.3) + y + abs(z) - 0.7", 2.0, None));
}

#[test]
fn on_functions_that_are_not_defined_everywhere() {
    check_all(&scene("root", "sqrt(x - y) + z^2 - 0.5", 1.5, None));
    check_all(&scene("log", "log(x*y + 0.2) + z", 1.5, None));
}

#[test]
fn on_waves() {
    check_all(&scene("waves", "sin(3*x) + cos(4*y) + sin(2*z*x) - 0.3", 2.0, None));
}

#[test]
fn far_from_the_origin() {
    let function = Function::parse("(x-1000)^2 + (y+2000)^2 + (z-3000)^2 - 1").unwrap();
    let centre = DVec3::new(1000.0, -2000.0, 3000.0);
    let domain = Domain::new(centre - 1.5, centre + 1.5).unwrap();
    check_all(&Scene::new("far", function, domain));
}

#[test]
fn on_tiny_and_huge_surfaces() {
    check_all(&scene("tiny", "x^2 + y^2 + z^2 - 1e-12", 1.5e-6, None));
    check_all(&scene("huge", "x^2 + y^2 + z^2 - 1e12", 1.5e6, None));
}

#[test]
fn on_nothing() {
    check_all(&scene("empty", "x^2 + y^2 + z^2 + 1", 1.0, None));
}
