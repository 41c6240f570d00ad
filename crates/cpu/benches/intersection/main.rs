//! Frame times of the methods at 512x512 on one thread.
//!
//! After criterion's groups, which are measured one after another, contenders run in turns, and the least
//! time of each is printed with ratios, on a machine whose speed wanders: the methods on the Barth
//! sextic to a loop written by hand and to `kmarch-nearest`; and `kmarch`, from the same ready rays and
//! rounding as the loop by hand, to that loop on six surfaces. The methods give brackets, certificates and
//! the sum of the work, but not the work of each ray.

mod handwritten;

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group};
use glam::DVec3;
use handwritten::count_hits;
use zeroset_cpu::{Algorithm, Amp, Bisection, Finishing, Packets, Stop};
use zeroset_expr::Function;
use zeroset_ia::{Isa, Register, Rounding};
use zeroset_raycast::{
    Camera, Domain, Hits, Method, Progress, Ray, RayBatch, Rays, Request, Scene, View,
};

const SIZE: usize = 512;

/// As the paper has it: depth 10, every last piece a hit.
fn accepted(algorithm: Algorithm) -> Bisection {
    Bisection { stop: Stop::Depth(10), finish: Finishing::Accept, ..Bisection::new(algorithm) }
}

/// The methods, with the name of the measurement.
fn contenders(scene: &Scene) -> Vec<(String, Box<dyn Method>)> {
    let accept = |rounding, isa| -> Box<dyn Method> {
        Box::new(Bisection { rounding, isa, ..accepted(Algorithm::Kmarch) })
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
    for register in Register::available() {
        let packets = Packets::One(register);
        let method =
            Bisection { rounding: Rounding::Nearest, packets, ..accepted(Algorithm::Kmarch) };
        let knobs = method.knobs();
        let lanes =
            &knobs.iter().find(|knob| knob.name == "packet").expect("it has the knob").value;
        list.push((format!("kmarch-nearest-packet-{lanes}"), Box::new(method)));
    }
    for algorithm in [Algorithm::Tbisect, Algorithm::Mitchell] {
        let method = Bisection { rounding: Rounding::Nearest, ..accepted(algorithm) };
        list.push((format!("{}-nearest", method.id()), Box::new(method)));
    }
    list.push(("kmarch-certified".into(), Box::new(certified)));
    list.push(("amp-sign".into(), Box::new(Amp::default())));
    list
}

/// A surface that was also written by hand: id, equation, half of its cube, and the loop.
type ByHand = (&'static str, &'static str, f32, fn(&[[[f32; 16]; 6]], f32, usize) -> usize);

const BY_HAND: [ByHand; 6] = [
    ("sphere", "x^2+y^2+z^2-1", 1.25, count_hits::<handwritten::Sphere>),
    ("torus", "(1-sqrt(x^2+y^2))^2+z^2-0.16", 1.5, count_hits::<handwritten::Torus>),
    (
        "barth-sextic",
        "4*(p^2*x^2-y^2)*(p^2*y^2-z^2)*(p^2*z^2-x^2)-(1+2*p)*(x^2+y^2+z^2-1)^2; p=(1+sqrt(5))/2",
        2.0,
        count_hits::<handwritten::BarthSextic>,
    ),
    ("tangle", "x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8", 2.5, count_hits::<handwritten::Tangle>),
    (
        "mitchell",
        "4*(x^4+(y^2+z^2)^2)+17*x^2*(y^2+z^2)-20*(x^2+y^2+z^2)+17",
        2.0,
        count_hits::<handwritten::Mitchell>,
    ),
    (
        "klein",
        "(x^2+y^2+z^2+2*y-1)*((x^2+y^2+z^2-2*y-1)^2-8*z^2)+16*x*z*(x^2+y^2+z^2-2*y-1)",
        4.0,
        count_hits::<handwritten::Klein>,
    ),
];

/// The scene of a surface by hand: the loops know no ball.
fn scene((id, equation, half, _): ByHand) -> Scene {
    let half = DVec3::splat(half.into());
    let function = Function::parse(equation).expect("an equation");
    let mut scene = Scene::new(id, function, Domain::new(-half, half).expect("a domain"));
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
    surface: ByHand,
    contenders: &[(String, Box<dyn Method>)],
    view: &'a View,
    batch: &'a RayBatch,
    packets: &'a [[[f32; 16]; 6]],
) -> Vec<Frame<'a>> {
    let (_, _, half, count) = surface;
    let by_hand = move || {
        black_box(count(black_box(packets), half, 11));
    };
    let scene = &scene(surface);
    let mut frames: Vec<Frame<'_>> = vec![("handwritten".into(), Box::new(by_hand))];
    let mut add = |name: String, method: &dyn Method, rays: Rays<'a>| {
        let intersector = method.prepare(scene).expect("a scene for every method");
        let mut hits = Hits::without_work(Request::First, rays.len());
        let frame = move || {
            let progress = Progress::new();
            intersector.intersect(black_box(rays), &mut hits, &progress).expect("answers");
        };
        frames.push((name, Box::new(frame)));
    };
    // Like the handwritten loop, from rays that are there already.
    let (name, nearest) = &contenders[0];
    add(format!("{name}-batch"), nearest.as_ref(), Rays::Batch(batch));
    for (name, method) in contenders {
        add(name.clone(), method.as_ref(), Rays::View(view));
    }
    frames
}

/// Shows the frames of contenders on a surface, on a pool of one thread.
fn with_frames(
    surface: ByHand,
    contenders: &[(String, Box<dyn Method>)],
    see: impl FnOnce(Vec<Frame<'_>>, &rayon::ThreadPool),
) {
    let view = View::new(Camera::facing(&scene(surface).domain), SIZE, SIZE);
    let blocks = blocks(&view);
    let batch = RayBatch::new(blocks.iter().flatten().copied().collect());
    let packets: Vec<_> = blocks.iter().map(packet).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    see(frames(surface, contenders, &view, &batch, &packets), &pool);
}

/// The Barth sextic.
fn sextic() -> ByHand {
    BY_HAND[2]
}

fn intersection(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("intersection");
    group.sample_size(10);
    with_frames(sextic(), &contenders(&scene(sextic())), |frames, pool| {
        for (name, mut frame) in frames {
            group.bench_function(name, |bencher| bencher.iter(|| pool.install(&mut frame)));
        }
    });
    group.finish();
}

/// How often each contender has its turn.
const ROUNDS: usize = 25;

/// The least time of each frame, taken in turns.
fn least(frames: &mut [Frame<'_>], pool: &rayon::ThreadPool) -> Vec<f64> {
    let mut least = vec![Duration::MAX; frames.len()];
    for _ in 0..ROUNDS {
        for ((_, frame), least) in frames.iter_mut().zip(&mut least) {
            let start = Instant::now();
            pool.install(frame);
            *least = (*least).min(start.elapsed());
        }
    }
    least.iter().map(|least| 1e3 * least.as_secs_f64()).collect()
}

/// Prints the times of the contenders on the Barth sextic.
fn print_contenders() {
    with_frames(sextic(), &contenders(&scene(sextic())), |mut frames, pool| {
        let times = least(&mut frames, pool);
        let base =
            |name: &str| times[frames.iter().position(|(n, _)| n == name).expect("a contender")];
        println!("least of {ROUNDS} frames, ms; ratio to handwritten; to kmarch-nearest");
        for ((name, _), time) in frames.iter().zip(&times) {
            let [hand, nearest] = ["handwritten", "kmarch-nearest"].map(|n| time / base(n));
            println!("{name:24} {time:8.2} {hand:6.2} {nearest:6.2}");
        }
    });
}

/// Prints the times of `kmarch` beside those of the loops by hand.
fn print_by_hand() {
    println!("least of {ROUNDS} frames, ms: by hand, kmarch-nearest; ratio");
    for surface in BY_HAND {
        let nearest = contenders(&scene(surface)).swap_remove(0);
        with_frames(surface, &[nearest], |mut frames, pool| {
            frames.truncate(2);
            let times = least(&mut frames, pool);
            let ratio = times[1] / times[0];
            println!("{:24} {:8.2} {:8.2} {ratio:6.2}", surface.0, times[0], times[1]);
        });
    }
}

criterion_group!(benches, intersection);

fn main() {
    benches();
    // `cargo test --benches` only sees that the benchmarks run.
    if std::env::args().any(|argument| argument == "--bench") {
        print_contenders();
        print_by_hand();
    }
    Criterion::default().configure_from_args().final_summary();
}
