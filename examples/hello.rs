//! One surface, two rays: `cargo run --example hello`.

use glam::{DVec3, Vec3};
use zeroset::cpu::Bisection;
use zeroset::expr::Function;
use zeroset::raycast::{Domain, Hits, Method, Progress, Ray, RayBatch, Rays, Request, Scene};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // What is cast at: a surface, and the box in which its roots count.
    let function = Function::parse("x^2 + y^2 + z^2 = 1")?;
    let domain = Domain::new(DVec3::splat(-2.0), DVec3::splat(2.0))?;
    let scene = Scene::new("sphere", function, domain);

    // What is cast: a ray that hits the sphere, and one that passes by.
    let from = Vec3::new(0.0, 0.0, -3.0);
    let batch = RayBatch::new(vec![Ray::new(from, Vec3::Z), Ray::new(from, Vec3::X)]);

    // A method with its knobs, prepared for the scene, answers.
    let mut method = Bisection::kmarch();
    method.for_precision(1e-6, &scene);
    let mut hits = Hits::new(Request::FirstWithNormal, batch.rays.len());
    method.prepare(&scene)?.intersect(Rays::Batch(&batch), &mut hits, &Progress::new())?;

    for i in 0..hits.len() {
        println!("{}: t in {:?}, normal {}", hits.certificate[i], hits.bracket[i], hits.normal[i]);
    }
    Ok(())
}
