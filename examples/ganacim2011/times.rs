//! Tables I and II in time.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use zeroset::beam::{Beam, BeamGpu, Enclosure, Refinement};
use zeroset::gpu::{Choice, Device};
use zeroset::ia::Rounding;
use zeroset::raycast::{Hits, Intersector, Method, Progress, Rays, Request, View};

use crate::published::{SURFACES, Surface};
use crate::{Failure, SIDES, SIZES, counts, paper, surface, view};

/// How often a frame is taken at least.
const ROUNDS: usize = 5;
/// How long it is taken at least.
const BUSY: Duration = Duration::from_millis(100);

/// The least time of a frame: the device's if it has a clock, else the whole.
fn least(intersector: &dyn Intersector, view: &View) -> Result<Duration, Failure> {
    let rays = Rays::View(view);
    let mut hits = Hits::without_work(Request::First, rays.len());
    let (begun, mut rounds, mut least) = (Instant::now(), 0, Duration::MAX);
    while rounds < ROUNDS || begun.elapsed() < BUSY {
        let start = Instant::now();
        let report = intersector.intersect(rays, &mut hits, &Progress::new())?;
        least = least.min(report.device_time.unwrap_or_else(|| start.elapsed()));
        rounds += 1;
    }
    Ok(least)
}

/// Frames a second of both methods on both images.
fn tables(what: &str, method: &dyn Fn(Refinement) -> Box<dyn Method>) -> Result<(), Failure> {
    let mut ratios = Vec::new();
    for (size, table) in SIZES.into_iter().zip(["I", "II"]) {
        println!("\n## Table {table}, frames a second of {size}x{size} {what}\n");
        let columns = " uniform (paper) | adaptive (paper) | ratio | paper |";
        println!("| surface |{}", columns.repeat(2));
        println!("|{}", "---|".repeat(9));
        for Surface { name, id, table_1, table_2 } in &SURFACES {
            let printed = if size == SIZES[0] { table_1 } else { table_2 };
            let scene = surface(id)?;
            let both = [Refinement::Uniform, Refinement::Adaptive];
            let [uniform, adaptive] = both.map(|refinement| method(refinement).prepare(&scene));
            let prepared = [uniform?, adaptive?];
            let mut line = format!("| {name} |");
            for (k, side) in SIDES.into_iter().enumerate() {
                let view = view(&scene, side * size);
                let mut rates = [0.0; 2];
                for (rate, intersector) in rates.iter_mut().zip(&prepared) {
                    *rate = 1.0 / least(intersector.as_ref(), &view)?.as_secs_f64();
                }
                let [uniform, adaptive] = rates;
                let (ratio, paper) = (adaptive / uniform, &printed[2 * k..2 * k + 2]);
                line += &format!(
                    " {uniform:.1} ({}) | {adaptive:.1} ({}) | {ratio:.2} | {:.2} |",
                    paper[0],
                    paper[1],
                    paper[1] / paper[0]
                );
                ratios.push(ratio);
            }
            println!("{line}");
        }
    }
    counts::summary(&ratios);
    Ok(())
}

/// Whole frames on all threads.
pub(crate) fn on_the_cpu() -> Result<(), Failure> {
    let threads = rayon::current_num_threads();
    tables(&format!("on {threads} threads of the processor, to nearest"), &|refinement| {
        Box::new(paper(refinement))
    })
}

/// The device's time, which it spends on beams.
pub(crate) fn on_the_device() -> Result<(), Failure> {
    let device = match Device::open(&Choice::Auto) {
        Ok(device) => device,
        Err(why) => {
            println!("\nTables I and II on a device: {why}");
            return Ok(());
        }
    };
    let is_software = device.report().kind == "software";
    println!("\nThe device: {}, {}", device.report().name, device.report().driver);
    // A GPU with little to do lowers its clock: another thread keeps it busy, one frame at a time.
    let scene = surface("barth-sextic")?;
    let busy = BeamGpu::uniform().prepare(&scene)?;
    let stop = AtomicBool::new(is_software);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let view = view(&scene, 1024);
            while !stop.load(Ordering::Relaxed) {
                if least(busy.as_ref(), &view).is_err() {
                    break;
                }
            }
        });
        let kinds = [
            (Rounding::Nearest, Enclosure::Interval),
            (Rounding::Outward, Enclosure::Interval),
            (Rounding::Outward, Enclosure::Affine),
        ];
        let result = kinds.into_iter().try_for_each(|(rounding, enclosure)| {
            let what = format!("on the device, {rounding:?}, {enclosure:?}").to_lowercase();
            tables(&what, &|refinement| {
                let twin = Beam { rounding, enclosure, ..Beam::new(refinement) };
                Box::new(BeamGpu::auto(twin))
            })
        });
        stop.store(true, Ordering::Relaxed);
        result
    })
}
