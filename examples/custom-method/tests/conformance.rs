//! The suite that the standard methods pass, passed by a method from outside.

use custom_method::Uniform;
use glam::DVec3;
use zeroset_bench::{Failure, check};
use zeroset_expr::Function;
use zeroset_raycast::{Domain, Scene};

fn failures(equation: &str) -> Vec<Failure> {
    let function = Function::parse(equation).unwrap();
    let domain = Domain::new(DVec3::splat(-2.0), DVec3::splat(2.0)).unwrap();
    check(&Uniform::default(), &Scene::new("test", function, domain))
}

#[test]
fn polynomials_conform() {
    assert_eq!(failures("x^2 + y^2 + z^2 = 1"), []);
    assert_eq!(failures("(x^2 + y^2 + z^2 + 0.75)^2 = 4*(x^2 + y^2)"), []);
}

#[test]
fn undefined_values_are_survived() {
    assert_eq!(failures("sqrt(x) + y = z"), []);
    assert_eq!(failures("1/(x - y^2) = z"), []);
}
