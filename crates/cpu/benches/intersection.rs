//! Frame times of the methods: the Barth sextic at 512x512 on one thread.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use zeroset_cpu::Amp;
use zeroset_expr::Function;
use zeroset_raycast::{Camera, Domain, Hits, Method, Progress, Rays, Request, Scene, View};

/// The methods, with the name of the measurement.
fn contenders() -> Vec<(&'static str, Box<dyn Method>)> {
    vec![("amp-sign", Box::new(Amp::default()))]
}

fn barth_sextic() -> Scene {
    let equation = "4*(p^2*x^2-y^2)*(p^2*y^2-z^2)*(p^2*z^2-x^2)-(1+2*p)*(x^2+y^2+z^2-1)^2; \
                    p=(1+sqrt(5))/2";
    let mut domain = Domain::new(DVec3::splat(-2.0), DVec3::splat(2.0)).expect("a domain");
    domain.ball = Some(2.0);
    let function = Function::parse(equation).expect("an equation");
    let mut scene = Scene::new("barth-sextic", function, domain);
    scene.published_step = Some(0.02);
    scene
}

fn intersection(criterion: &mut Criterion) {
    let scene = barth_sextic();
    let view = View::new(Camera::facing(&scene.domain), 512, 512);
    let rays = Rays::View(&view);
    let thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let mut group = criterion.benchmark_group("intersection");
    group.sample_size(10);
    for (name, method) in contenders() {
        let intersector = method.prepare(&scene).expect("a scene for every method");
        let mut hits = Hits::new(Request::First, rays.len());
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let progress = Progress::new();
                thread.install(|| {
                    intersector.intersect(black_box(rays), &mut hits, &progress).expect("answers")
                })
            });
        });
    }
    group.finish();
}

criterion_group!(benches, intersection);
criterion_main!(benches);
