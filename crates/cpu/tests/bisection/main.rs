//! `kmarch`, `tbisect` and `mitchell` are the same on every instruction set and in every grouping, and
//! prove only what is so.

mod certificates;
mod exact;
mod knobs;
#[path = "../reference/rational.rs"]
mod rational;
mod same;
mod settings;

use glam::{DVec3, Vec3};
use zeroset_cpu::{Algorithm, Bisection};
use zeroset_expr::Function;
use zeroset_raycast::{
    Camera, Domain, Hit, Hits, Method, Progress, Ray, RayBatch, Rays, Request, Scene, View,
};

fn cube(half: f64) -> Domain {
    Domain::new(DVec3::splat(-half), DVec3::splat(half)).unwrap()
}

fn scene(equation: &str, half: f64) -> Scene {
    Scene::new("test", Function::parse(equation).unwrap(), cube(half))
}

fn cast(method: &Bisection, scene: &Scene, rays: Rays<'_>) -> Hits {
    let mut hits = Hits::new(Request::First, rays.len());
    let intersector = method.prepare(scene).unwrap();
    intersector.intersect(rays, &mut hits, &Progress::new()).unwrap();
    hits
}

fn answers(method: &Bisection, scene: &Scene, rays: &[Ray]) -> Vec<Hit> {
    let hits = cast(method, scene, Rays::Batch(&RayBatch::new(rays.to_vec())));
    (0..rays.len()).map(|i| hits.get(i)).collect()
}

fn ray(origin: [f32; 3], direction: [f32; 3]) -> Ray {
    Ray::new(Vec3::from(origin), Vec3::from(direction))
}

/// The default view of a scene.
fn view(scene: &Scene, width: usize, height: usize) -> View {
    View::new(Camera::facing(&scene.domain), width, height)
}

/// The rays of the default view, and as many from anywhere to anywhere: along axes, backwards, from
/// inside.
fn assorted(scene: &Scene, side: usize) -> Vec<Ray> {
    let view = view(scene, side, side);
    let half = scene.domain.max.x as f32;
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 23) as f32 - 1.0
    };
    let mut rays: Vec<Ray> = (0..side * side).map(|i| view.ray(i % side, i / side)).collect();
    for i in 0..side * side {
        let reach = if i % 3 == 0 { half } else { 3.0 * half };
        let origin = Vec3::new(random(), random(), random()) * reach;
        let mut direction = Vec3::new(random(), random(), random()) * 1.25 * half - origin;
        match i % 7 {
            0 => direction = Vec3::ZERO.with_x(direction.x),
            1 => direction.y = -0.0,
            2 => direction *= -1e-3,
            _ => {}
        }
        if direction != Vec3::ZERO {
            rays.push(Ray::new(origin, direction));
        }
    }
    rays
}

const ALGORITHMS: [Algorithm; 3] = [Algorithm::Kmarch, Algorithm::Tbisect, Algorithm::Mitchell];

/// Equations of every kind, with half the side of their domain.
const EQUATIONS: [(&str, f64); 9] = [
    ("x^2+y^2+z^2-1", 1.25),
    ("x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8", 2.5),
    ("4*(p^2*x^2-y^2)*(p^2*y^2-z^2)*(p^2*z^2-x^2)-(1+2*p)*(x^2+y^2+z^2-1)^2; p=(1+sqrt(5))/2", 2.0),
    ("sin(3*x)+cos(3*y)+sin(3*z)-0.2", 2.0),
    ("exp(-x^2-y^2)-0.3*z", 1.5),
    ("x/(y-0.25)+z", 1.0),
    ("sqrt(x+0.5)-y*z-0.3", 1.0),
    ("floor(2*x)+y+z-0.25", 1.0),
    ("abs(x)^0.75+abs(y)^0.75+abs(z)^0.75-1", 1.5),
];
