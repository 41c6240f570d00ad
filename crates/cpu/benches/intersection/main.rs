//! Frame times of the methods: the Barth sextic at 512x512 on one thread.
//!
//! After criterion's groups, which are measured one after another, the contenders run in turns, and the
//! least time of each is printed with its ratio to the handwritten loop and to `kmarch-nearest`: ratios
//! on a machine whose speed wanders.

mod handwritten;

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group};
use glam::DVec3;
use zeroset_cpu::{Amp, Bisection, Finishing, Stop};
use zeroset_expr::Function;
use zeroset_ia::{Isa, Rounding};
use zeroset_raycast::{
    Camera, Domain, Hits, Method, Progress, Ray, RayBatch, Rays, Request, Scene, View,
};

const SIZE: usize = 512;

/// The methods, with the name of the measurement.
fn contenders(scene: &Scene) -> Vec<(String, Box<dyn Method>)> {
    let accept = |rounding, isa| -> Box<dyn Method> {
        let finish = Finishing::Accept;
        Box::new(Bisection { stop: Stop::Depth(10), rounding, finish, isa, ..Bisection::kmarch() })
    };
    let mut certified = Bisection::kmarch();
    certified.for_precision(1e-4 * scene.domain.longest_side(), scene);
    let mut list: Vec<(String, Box<dyn Method>)> = vec![
        ("kmarch-nearest".into(), accept(Rounding::Nearest, None)),
        ("kmarch-outward".into(), accept(Rounding::Outward, None)),
        ("kmarch-nudged".into(), accept(Rounding::Nudged, None)),
    ];
    // The widest is measured above.
    for isa in Isa::available().into_iter().filter(|isa| *isa != Isa::best()) {
        let name = format!("kmarch-nearest-{}", isa.name());
        list.push((name, accept(Rounding::Nearest, Some(isa))));
    }
    list.push(("kmarch-certified".into(), Box::new(certified)));
    list.push(("amp-sign".into(), Box::new(Amp::default())));
    list
}

fn barth_sextic() -> Scene {
    let equation = "4*(p^2*x^2-y^2)*(p^2*y^2-z^2)*(p^2*z^2-x^2)-(1+2*p)*(x^2+y^2+z^2-1)^2; \
                    p=(1+sqrt(5))/2";
    // The handwritten loop knows no ball.
    let domain = Domain::new(DVec3::splat(-2.0), DVec3::splat(2.0)).expect("a domain");
    let function = Function::parse(equation).expect("an equation");
    let mut scene = Scene::new("barth-sextic", function, domain);
    scene.published_step = Some(0.02);
    scene
}

/// The view's rays in blocks of 4x4 pixels.
fn blocks(view: &View) -> Vec<[Ray; 16]> {
    let corners =
        (0..view.height).step_by(4).flat_map(|y| (0..view.width).step_by(4).map(move |x| (x, y)));
    corners.map(|(x, y)| std::array::from_fn(|i| view.ray(x + i % 4, y + i / 4))).collect()
}

/// The same as the handwritten loop wants them: origin and direction, ray by ray.
fn packet(block: &[Ray; 16]) -> [[f32; 16]; 6] {
    std::array::from_fn(|part| block.map(|ray| [ray.origin, ray.direction][part / 3][part % 3]))
}

/// A contender, and what makes one frame of it.
type Frame<'a> = (String, Box<dyn FnMut() + Send + 'a>);

fn frames<'a>(
    scene: &Scene,
    view: &'a View,
    batch: &'a RayBatch,
    packets: &'a [[[f32; 16]; 6]],
) -> Vec<Frame<'a>> {
    let by_hand = move || {
        black_box(handwritten::count_hits(black_box(packets), 2.0, 11));
    };
    let mut frames: Vec<Frame<'_>> = vec![("handwritten".into(), Box::new(by_hand))];
    let mut add = |name: String, method: &dyn Method, rays: Rays<'a>| {
        let intersector = method.prepare(scene).expect("a scene for every method");
        let mut hits = Hits::new(Request::First, rays.len());
        let frame = move || {
            let progress = Progress::new();
            intersector.intersect(black_box(rays), &mut hits, &progress).expect("answers");
        };
        frames.push((name, Box::new(frame)));
    };
    // Like the handwritten loop, from rays that are there already.
    let (name, nearest) = contenders(scene).swap_remove(0);
    add(format!("{name}-batch"), nearest.as_ref(), Rays::Batch(batch));
    for (name, method) in contenders(scene) {
        add(name, method.as_ref(), Rays::View(view));
    }
    frames
}

/// Shows the contenders, on a pool of one thread.
fn with_frames(see: impl FnOnce(Vec<Frame<'_>>, &rayon::ThreadPool)) {
    let scene = barth_sextic();
    let view = View::new(Camera::facing(&scene.domain), SIZE, SIZE);
    let blocks = blocks(&view);
    let batch = RayBatch::new(blocks.iter().flatten().copied().collect());
    let packets: Vec<_> = blocks.iter().map(packet).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    see(frames(&scene, &view, &batch, &packets), &pool);
}

fn intersection(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("intersection");
    group.sample_size(10);
    with_frames(|frames, pool| {
        for (name, mut frame) in frames {
            group.bench_function(name, |bencher| bencher.iter(|| pool.install(&mut frame)));
        }
    });
    group.finish();
}

/// Measures the contenders in turns and prints the least time of each, and ratios.
fn print_ratios() {
    const ROUNDS: usize = 25;
    with_frames(|mut frames, pool| {
        let mut least = vec![Duration::MAX; frames.len()];
        for _ in 0..ROUNDS {
            for ((_, frame), least) in frames.iter_mut().zip(&mut least) {
                let start = Instant::now();
                pool.install(frame);
                *least = (*least).min(start.elapsed());
            }
        }
        let ratio = |i: usize, name: &str| {
            let base = frames.iter().position(|(n, _)| n == name).expect("a contender");
            least[i].as_secs_f64() / least[base].as_secs_f64()
        };
        println!("least of {ROUNDS} frames, ms; ratio to handwritten; to kmarch-nearest");
        for (i, (name, _)) in frames.iter().enumerate() {
            let ms = least[i].as_secs_f64() * 1e3;
            let [hand, nearest] = ["handwritten", "kmarch-nearest"].map(|base| ratio(i, base));
            println!("{name:24} {ms:8.2} {hand:6.2} {nearest:6.2}");
        }
    });
}

criterion_group!(benches, intersection);

fn main() {
    benches();
    // `cargo test --benches` only sees that the benchmarks run.
    if std::env::args().any(|argument| argument == "--bench") {
        print_ratios();
    }
    Criterion::default().configure_from_args().final_summary();
}
