//! SLIM surfaces of files of points: `cargo run --release -p zeroset-model --example slim -- FILE..`.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use zeroset_model::points;
use zeroset_model::slim::{Options, Slim, Summary};
use zeroset_raycast::Progress;

fn main() -> Result<(), Box<dyn Error>> {
    println!("| file | points | left out | balls | seconds | RMS | worst | balls at a point |");
    println!("|---|---|---|---|---|---|---|---|");
    for file in std::env::args().skip(1) {
        let path = Path::new(&file);
        let (cloud, dropped) = points::read(path)?;
        let start = Instant::now();
        let slim = Slim::build(&cloud, &Options::default(), &Progress::new())?;
        let seconds = start.elapsed().as_secs_f64();
        let Summary { rms, worst, overlap } = slim.summary(&cloud);
        let name = path.file_name().unwrap_or_default().display();
        let left_out = dropped.not_finite + dropped.no_normal + dropped.repeated;
        println!(
            "| {name} | {} | {left_out} | {} | {seconds:.1} | {rms:.1e} | {worst:.1e} | {overlap:.2} |",
            cloud.points.len(),
            slim.balls.len()
        );
    }
    Ok(())
}
