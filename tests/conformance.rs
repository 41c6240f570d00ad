//! Every method of the registry conforms: on surfaces of the catalogue of every kind, and on equations
//! as they are typed; and on quadrics in bounds.

#[path = "../crates/quadric/tests/scenes/mod.rs"]
mod scenes;

use glam::DVec3;
use zeroset_bench::conformance::check_with;
use zeroset_bench::{Registry, Remembering, truth};
use zeroset_model::bilinear;
use zeroset_model::skin::{self, Skin};
use zeroset_raycast::catalogue::resolve;
use zeroset_raycast::{Blending, Domain, Scene, Sides};

/// Checks every method on a surface.
fn conforms(text: &str) {
    let surface = resolve(text, None).unwrap_or_else(|error| panic!("{text}: {error}"));
    conforms_on(&surface.scene().unwrap_or_else(|error| panic!("{text}: {error:?}")));
}

/// Checks every method on a scene, and those that can certify also when they do; the failures of all
/// are told at once.
fn conforms_on(scene: &Scene) {
    let registry = Registry::standard();
    let certified = registry.certified();
    let oracle = truth::reference(scene).unwrap_or_else(|error| panic!("{}: {error}", scene.id));
    let oracle = Remembering::new(oracle);
    let mut told = Vec::new();
    for method in registry.iter().chain(certified.iter().map(AsRef::as_ref)) {
        let failures = check_with(&oracle, method, scene);
        told.extend(failures.iter().map(|failure| format!("{}: {failure}", method.id())));
    }
    assert!(told.is_empty(), "{}:\n{}", scene.id, told.join("\n"));
}

#[test]
fn on_polynomials() {
    conforms("torus");
    conforms("tangle");
}

#[test]
fn on_chebyshev_polynomials_in_every_form() {
    for form in ["Tpow", "T"] {
        conforms(&format!("{form}(4, x) + {form}(4, y) + {form}(4, z)"));
    }
    // One is enough: the reference needs many digits where the arc cosine ends.
    conforms("Tcos(4, x) + y^2 = z");
}

#[test]
fn on_surfaces_with_many_nodes() {
    conforms("labs-septic");
    conforms("endrass-octic");
}

#[test]
fn on_double_curves_and_crossing_sheets() {
    conforms("steiner");
    conforms("intersecting-planes");
}

#[test]
fn on_poles() {
    conforms("inverse-function");
    conforms("blobby-knoll");
    conforms("x/y + y/z - z/x = 1/2");
}

#[test]
fn on_jumps() {
    conforms("mod(x, 1/2) + floor(y + 0.3) - sign(z)*abs(z) + 0.2");
    conforms("ceil(3*x) - sign(y - z) + mod(z, -0.7)");
}

#[test]
fn on_kinks() {
    conforms("absolute-value");
    conforms("max(abs(x), abs(y), abs(z)) = 1");
}

#[test]
fn on_waves_and_exponentials() {
    conforms("scherk");
    conforms("blobby");
    conforms("atan2(y, x) = sin(4*z)");
}

#[test]
fn on_real_powers() {
    conforms("superquadric-0p75");
    conforms("superquadric-2p5");
    conforms("x^pi + y^0.3 = z");
}

#[test]
fn on_sums_of_blobs() {
    conforms("blinn-blob-ganacim");
    conforms("sum(i, 1, 4, exp(-5*((x-cos(i))^2 + (y-sin(i))^2 + z^2))) = 0.4");
}

#[test]
fn on_a_surface_that_w_moves() {
    conforms("morph-hyperboloid-torus");
    conforms("superquadric-twisting");
    conforms("(1-w)*(x^2+y^2-1) + w*(y^2+z^2-1)");
}

#[test]
fn on_domains_that_single_precision_does_not_hold() {
    for half in [1e-45, 1e45] {
        let sphere = resolve("sphere", None).expect("it is in the catalogue");
        let domain = Domain::new(DVec3::splat(-half), DVec3::splat(half)).expect("it is a box");
        conforms_on(&Scene { domain, ..sphere.scene().expect("it is well formed") });
    }
}

#[test]
fn on_quadrics_in_balls_and_in_tetrahedra() {
    let at = DVec3::new(0.25, -1.0, 0.5);
    conforms_on(&scenes::balls(at, 300, 0.2, Blending::None));
    conforms_on(&scenes::balls(at, 300, 0.2, Blending::Weighted { offset: 0.5 }));
    conforms_on(&scenes::cubes(at, scenes::sphere(1.0), 1.25, 4, Sides::Front));
    conforms_on(&scenes::cubes(at, scenes::sphere(1.0), 1.25, 3, Sides::Both));
    let water = Skin::default().patches(&skin::water().atoms()).expect("a molecule");
    conforms_on(&Scene::of_patches("water", water));
    let strip = bilinear::patches(&bilinear::folded_strip()).expect("quadrilaterals");
    conforms_on(&Scene::of_patches("strip", strip));
}
