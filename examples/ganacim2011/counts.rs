//! Tables I and II in evaluations, which do not depend on a machine.

use zeroset::beam::{Level, Refinement};
use zeroset::raycast::Progress;

use crate::published::{SURFACES, Surface};
use crate::{Failure, SIDES, SIZES, paper, surface, view};

/// What was counted on an image, summed over levels.
#[derive(Clone, Copy, Default)]
struct Count {
    intervals: u64,
    in_step: u64,
}

fn count(id: &str, refinement: Refinement, size: usize) -> Result<Count, Failure> {
    let scene = surface(id)?;
    let beams = paper(refinement).prepare_beams(&scene)?;
    let levels = beams.subdivide(&view(&scene, size), &Progress::new())?.levels;
    let add = |sum: Count, level: &Level| Count {
        intervals: sum.intervals + level.intervals,
        in_step: sum.in_step + level.in_step,
    };
    Ok(levels.iter().fold(Count::default(), add))
}

/// Evaluations a sample, uniform and adaptive; their ratio beside the paper's of frames a second; and how
/// many times as many a warp of 32 threads takes that go in step.
pub(crate) fn tables() -> Result<(), Failure> {
    let mut ratios = Vec::new();
    for (size, table) in SIZES.into_iter().zip(["I", "II"]) {
        println!("\n## Table {table} in evaluations, {size}x{size}\n");
        println!("| surface |{}", " uniform | adaptive | ratio | paper | in step |".repeat(2));
        println!("|{}", "---|".repeat(11));
        for Surface { name, id, table_1, table_2 } in &SURFACES {
            let printed = if size == SIZES[0] { table_1 } else { table_2 };
            let mut line = format!("| {name} |");
            for (k, side) in SIDES.into_iter().enumerate() {
                let samples = ((side * size) as f64).powi(2);
                let uniform = count(id, Refinement::Uniform, side * size)?;
                let adaptive = count(id, Refinement::Adaptive, side * size)?;
                let ratio = uniform.intervals as f64 / adaptive.intervals as f64;
                let waiting = |count: Count| count.in_step as f64 / count.intervals as f64;
                line += &format!(
                    " {:.2} | {:.2} | {ratio:.2} | {:.2} | {:.2}, {:.2} |",
                    uniform.intervals as f64 / samples,
                    adaptive.intervals as f64 / samples,
                    printed[2 * k + 1] / printed[2 * k],
                    waiting(uniform),
                    waiting(adaptive)
                );
                ratios.push(ratio);
            }
            println!("{line}");
        }
    }
    summary(&ratios);
    Ok(())
}

/// How the ratios, in the order of the tables, compare with the paper's claims.
pub(crate) fn summary(ratios: &[f64]) {
    let (rows, surfaces) = (ratios.len() / 2, ratios.len() / 4);
    let above = ratios.iter().filter(|r| **r > 1.0).count();
    let finer = ratios.chunks(2).filter(|pair| pair[1] > pair[0]).count();
    let (small, large) = ratios.split_at(2 * surfaces);
    let larger = small.iter().zip(large).filter(|(a, b)| b > a).count();
    let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let most = ratios.iter().copied().fold(0.0, f64::max);
    println!(
        "\nAdaptive over uniform: above 1 in {above} of {} cells, {least:.2} to {most:.2} (paper: all, 1.16 \
         to 2.85); larger with 4 samples in {finer} of {rows} rows (paper: 23 of 24); larger at 1024x1024 \
         in {larger} of {rows} (paper: 22 of 24).",
        ratios.len()
    );
}
