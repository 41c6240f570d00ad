//! Rays that find faults in a method: random ones, and those that a surface makes hard.

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use zeroset_bench::{Class, Truths};
use zeroset_expr::{Function, Parameters, Tape};
use zeroset_ia::{Dual, Plain};
use zeroset_raycast::catalogue::Surface;
use zeroset_raycast::{Domain, Ray, Rays, Scene};

/// The finite nodes of surfaces, one for all that symmetries map it to.
const NODES: &str = include_str!("../../crates/raycast/catalogue/nodes.csv");

/// A place in the box: the centre is 0, the faces are at -1 and 1.
fn place(domain: &Domain, p: DVec3) -> DVec3 {
    domain.centre() + 0.5 * (domain.max - domain.min) * p
}

fn cube() -> impl Strategy<Value = DVec3> {
    [-1.0..1.0, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array)
}

/// Directions of which components are often zeros of either sign, or nearly so.
fn direction() -> impl Strategy<Value = Vec3> {
    let part = || {
        let odd = prop::sample::select(&[0.0, -0.0, 1e-40, -1e-7, 1.0][..]);
        prop_oneof![2 => -1.0..1.0_f32, 1 => odd]
    };
    let vector = [part(), part(), part()].prop_map(Vec3::from_array);
    vector.prop_filter("it is a direction", |d| *d != Vec3::ZERO)
}

/// Draws a value.
fn draw<S: Strategy>(runner: &mut TestRunner, strategy: S) -> S::Value {
    strategy.new_tree(runner).expect("values are not rare").current()
}

/// Rays in general position, from inside and outside, with zero components, and along axes.
fn anywhere(domain: &Domain, runner: &mut TestRunner) -> Vec<Ray> {
    let mut rays = Vec::new();
    for _ in 0..24 {
        let (from, to, d) = draw(runner, (cube(), cube(), direction()));
        let (outside, inside) = (place(domain, 2.5 * from), place(domain, to));
        rays.push(Ray::new(outside.as_vec3(), (inside - outside).as_vec3()));
        rays.push(Ray::new(inside.as_vec3(), d));
        rays.push(Ray::new(place(domain, 1.5 * from).as_vec3(), d));
        for k in 0..3 {
            let mut origin = inside;
            origin[k] = place(domain, DVec3::splat(-3.0))[k];
            rays.push(Ray::new(origin.as_vec3(), Vec3::AXES[k]));
            origin[k] = place(domain, DVec3::splat(3.0))[k];
            // The other components are -0.
            rays.push(Ray::new(origin.as_vec3(), -Vec3::AXES[k]));
        }
    }
    rays
}

/// The value of an exact constant.
fn constant(text: &str) -> f64 {
    let function = Function::parse(&format!("x + ({text})")).expect("it is a constant");
    let tape = function.tape(&Parameters::default(), 128).expect("defaults are values");
    tape.evaluator(&Plain(0.0)).evaluate([Plain(0.0); 3]).0
}

/// Points on the surface, as near as can be: those that the catalogue knows, its nodes, and some of
/// the view's first roots.
fn points(surface: &Surface, rays: Rays<'_>, truths: &Truths) -> Vec<DVec3> {
    let known = surface.points.iter().map(|p| {
        let [x, y, z] = [0, 1, 2].map(|k| constant(&p[k]));
        DVec3::new(x, y, z)
    });
    let nodes = NODES.lines().filter_map(|line| {
        let mut fields = line.split(',');
        let [x, y, z] = (fields.next() == Some(&surface.id)).then(|| {
            [0, 1, 2].map(|_| fields.next().and_then(|x| x.parse().ok()).expect("a coordinate"))
        })?;
        Some(DVec3::new(x, y, z))
    });
    let found = truths.sample.indices.iter().zip(&truths.truths);
    let found = found.filter(|(_, truth)| truth.class == Class::Transversal);
    let found: Vec<_> = found.map(|(&i, truth)| rays.get(i).at(truth.bracket[0])).collect();
    let some = found.iter().step_by(found.len().div_ceil(6).max(1));
    known.take(6).chain(nodes.take(6)).chain(some.copied()).collect()
}

/// Rays from and through points of the surface: across it, along it and anyhow.
fn touching(points: &[DVec3], scene: &Scene, tape: &Tape, runner: &mut TestRunner) -> Vec<Ray> {
    let mut rays = Vec::new();
    for &p in points {
        let [x, y, z] = [0, 1, 2].map(|axis| Dual::<_, 3>::variable(Plain(p[axis]), axis));
        let slopes = tape.evaluator(&x).evaluate([x, y, z]).tangent;
        let normal = DVec3::from_array(slopes.map(|slope| slope.0)).normalize_or(DVec3::Z);
        let along = normal.any_orthonormal_vector();
        let other = normal.cross(along) + 1e-5 * normal;
        let any = draw(runner, direction()).as_dvec3().normalize();
        for d in [normal, -normal, along, other, any] {
            rays.push(Ray::new(p.as_vec3(), d.as_vec3()));
            rays.push(Ray::new((p - scene.domain.radius() * d).as_vec3(), d.as_vec3()));
        }
    }
    rays
}

/// The rays backwards, from behind the domain.
fn backwards(rays: Rays<'_>, domain: &Domain) -> Vec<Ray> {
    let turn = |ray: Ray| {
        let behind = ray.at(2.0 * (ray.origin.as_dvec3() - domain.centre()).length());
        Ray::new(behind.as_vec3(), -ray.direction)
    };
    (0..rays.len()).step_by(5).map(|i| turn(rays.get(i))).collect()
}

/// All of these for a surface, of which a view has been cast.
pub(crate) fn adversaries(
    surface: &Surface,
    scene: &Scene,
    tape: &Tape,
    rays: Rays<'_>,
    truths: &Truths,
) -> Vec<Ray> {
    let mut runner = TestRunner::default();
    let points = points(surface, rays, truths);
    let mut all = anywhere(&scene.domain, &mut runner);
    all.extend(touching(&points, scene, tape, &mut runner));
    all.extend(backwards(rays, &scene.domain));
    all.retain(|ray| ray.is_valid());
    all
}
