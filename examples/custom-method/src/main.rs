//! The method beside the standard ones: `cargo run --release` in this folder.

use custom_method::Uniform;
use zeroset_bench::{Options, Registry, Verdict, compare};
use zeroset_raycast::catalogue;
use zeroset_raycast::{Camera, Method, Progress, Rays, View};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = catalogue::resolve("barth-sextic", None)?.scene()?;
    let view = View::new(Camera::facing(&scene.domain), 128, 128);
    let registry = Registry::standard().with(Box::new(Uniform::default()));
    let methods: Vec<_> = registry.iter().map(Method::boxed).collect();

    let comparison = compare(
        &scene,
        Rays::View(&view),
        &methods,
        &Options::default(),
        &Progress::new(),
        &mut |_, _| {},
    );
    println!(
        "{:12} {:>9} {:>8} {:>12} {:>11}",
        "method", "frame ms", "hits", "false misses", "false hits"
    );
    for run in &comparison.runs {
        match &run.outcome {
            Ok(outcome) => println!(
                "{:12} {:>9.2} {:>8} {:>12} {:>11}",
                run.method,
                outcome.times.map_or(f64::NAN, |t| 1e3 * t.median.as_secs_f64()),
                outcome.hit_count(),
                outcome.judgement.as_ref().map_or(0, |j| j.tally.count(Verdict::FalseMiss)),
                outcome.judgement.as_ref().map_or(0, |j| j.tally.count(Verdict::FalseHit)),
            ),
            Err(error) => println!("{:12} {error}", run.method),
        }
    }
    Ok(())
}
