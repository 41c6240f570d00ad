//! Tables 1 to 3.

use std::time::Duration;

use glam::Vec3;
use zeroset::bench::{Sample, Tolerance, Truths, Verdict, judge, truth};
use zeroset::cpu::amp::RootTest;
use zeroset::cpu::{Amp, Bisection, Finishing, Stop};
use zeroset::gpu::{AmpGpu, BisectionGpu, Frames, Look, Shadows, Surroundings};
use zeroset::ia::Rounding;
use zeroset::raycast::{
    Camera, Hits, Intersector, Method, Progress, RayBatch, Rays, Request, Scene, View, Work,
};
use zeroset::shade::shaded::{self, Palette};
use zeroset::shade::{Light, ShadowRays};

use crate::published::{TABLE_1, TABLE_2, TABLE_3};
use crate::timing::Timing;
use crate::{Failure, counts, row};

/// One light, above and to the left of the eye.
fn light(view: &View) -> Light {
    shaded::lights(view).swap_remove(0)
}

/// The time and the work of a frame's rays.
struct Cast {
    time: Duration,
    work: Work,
    hits: Hits,
}

fn cast(
    timing: &Timing,
    intersector: &dyn Intersector,
    rays: Rays<'_>,
    request: Request,
) -> Result<Cast, Failure> {
    let mut hits = Hits::new(request, rays.len());
    let mut work = Work::default();
    let time = timing.least(|| {
        let report = intersector.intersect(rays, &mut hits, &Progress::new())?;
        work = report.work;
        Ok(report.device_time)
    })?;
    Ok(Cast { time, work, hits })
}

/// A frame and its shadow rays.
struct Frame {
    cast: Cast,
    shadows: Duration,
}

fn frame(method: &dyn Method, scene: &Scene, view: &View) -> Result<Frame, Failure> {
    let intersector = method.prepare(scene)?;
    let first = cast(&Timing::HERE, &*intersector, Rays::View(view), Request::First)?;
    // Normals are for the shadow rays; they are not timed.
    let mut hits = Hits::new(Request::FirstWithNormal, first.hits.len());
    intersector.intersect(Rays::View(view), &mut hits, &Progress::new())?;
    let rays = ShadowRays::new(view, &hits, &scene.domain, &light(view))?;
    let batch: &RayBatch = &rays.batch;
    let shadows = if batch.rays.is_empty() {
        Duration::ZERO
    } else {
        cast(&Timing::HERE, &*intersector, Rays::Batch(batch), Request::Any)?.time
    };
    Ok(Frame { cast: first, shadows })
}

/// Rays that lose a root, and rays that hit nothing, for each method; in a view of `side` by `side` pixels.
fn wrong(methods: &[Amp; 2], scene: &Scene, side: usize) -> Result<Vec<String>, Failure> {
    let view = View::new(Camera::facing(&scene.domain), side, side);
    let rays = Rays::View(&view);
    let sample = Sample::every(1, rays);
    let truths = truth::reference(scene)?.classify(rays, &sample.indices, &Progress::new())?;
    let truths = Truths { sample, truths };
    let judged = methods.iter().map(|method| {
        let mut hits = Hits::new(Request::First, rays.len());
        method.prepare(scene)?.intersect(rays, &mut hits, &Progress::new())?;
        let tally = judge(rays, &hits, &truths, Tolerance::Footprint).tally;
        let lost = tally.count(Verdict::FalseMiss) + tally.count(Verdict::WrongSheet);
        Ok(format!("{lost}, {}", tally.count(Verdict::FalseHit)))
    });
    judged.collect()
}

fn ms(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// Table 1: both tests, with and without shadows, on the CPU; and what is lost.
pub(crate) fn table_1(size: usize) -> Result<(), Failure> {
    let side = size.min(64);
    println!("## Table 1, {size}x{size}, on the CPU\n");
    println!(
        "T/S: rate of the Taylor test over that of the sign test; S/NS: rate with shadows over that \
         without; each as printed, then measured. Lost and false: rays of a {side}x{side} view, by the \
         sign test and by the Taylor test.\n"
    );
    println!(
        "| row | surface | step | values a ray | flop (calls) a value | sign ms | Taylor ms | T/S paper | \
         T/S | S/NS sign paper | S/NS | S/NS Taylor paper | S/NS | lost, false: sign | Taylor |"
    );
    println!("|{}", "---|".repeat(15));
    let (mut below, mut rows) = (0, 0);
    for (i, printed) in TABLE_1.iter().enumerate() {
        let scene = row(1, i + 1)?;
        let view = View::new(Camera::facing(&scene.domain), size, size);
        let methods = [RootTest::Sign, RootTest::Taylor].map(|test| Amp { test, ..Amp::default() });
        let frames = [frame(&methods[0], &scene, &view)?, frame(&methods[1], &scene, &view)?];
        let [flops, calls] = counts::operations(&counts::tape(&scene)?);
        let values = frames[0].cast.work.points as f64 / (size * size) as f64;
        let [s, t] = [0, 1].map(|i| ms(frames[i].cast.time));
        let with =
            [0, 1].map(|i| ms(frames[i].cast.time) / ms(frames[i].cast.time + frames[i].shadows));
        let wrong = wrong(&methods, &scene, side)?;
        println!(
            "| {} | {} | {} | {values:.1} | {flops} ({calls}) | {s:.2} | {t:.2} | {:.2} | {:.2} | {:.2} | \
             {:.2} | {:.2} | {:.2} | {} |",
            i + 1,
            scene.id,
            scene.published_step.unwrap_or_default(),
            printed[2] / printed[0],
            s / t,
            printed[1] / printed[0],
            with[0],
            printed[3] / printed[2],
            with[1],
            wrong.join(" | "),
        );
        rows += 1;
        below += usize::from(s < t);
    }
    println!("\nThe Taylor test is slower in {below} of {rows} rows.");
    Ok(())
}

/// The default colours under lights, without shadows.
pub(crate) fn look<'a>(lights: &'a [(Vec3, f32)], background: &'a [[u8; 3]]) -> Look<'a> {
    let Palette { front, back } = shaded::palette();
    let surroundings = Surroundings::Rows(background);
    Look { lights, shadows: Shadows::Off, front, back, surroundings }
}

/// Table 1 on the device: whole frames that stay there, by its clock.
pub(crate) fn table_1_device(timing: &Timing, size: usize) -> Result<(), Failure> {
    println!("\n## Table 1, {size}x{size}, on the device\n");
    println!(
        "Frames a second of frames that stay on the device, by its clock; without and with shadows of one \
         light; as printed for a GTX 280, then measured.\n"
    );
    println!(
        "| row | surface | sign NS paper | NS | S paper | S | Taylor NS paper | NS | S paper | S | T/S paper | T/S |"
    );
    println!("|{}", "---|".repeat(12));
    for (i, printed) in TABLE_1.iter().enumerate() {
        let scene = row(1, i + 1)?;
        let view = View::new(Camera::facing(&scene.domain), size, size);
        let light = light(&view);
        let lights = [(light.direction.normalize_or_zero(), light.strength)];
        let background = shaded::background(size);
        let mut rates = Vec::new();
        for test in [RootTest::Sign, RootTest::Taylor] {
            let method = AmpGpu::new(test);
            let mut frames = Frames::new(&method, &scene)?;
            for shadows in [Shadows::Off, Shadows::On] {
                let look = Look { shadows, ..look(&lights, &background) };
                let time = timing.least(|| Ok(frames.draw(&view, &look, &Progress::new())?))?;
                rates.push(1e3 / ms(time));
            }
        }
        println!(
            "| {} | {} | {} | {:.0} | {} | {:.0} | {} | {:.0} | {} | {:.0} | {:.2} | {:.2} |",
            i + 1,
            scene.id,
            printed[0],
            rates[0],
            printed[1],
            rates[1],
            printed[2],
            rates[2],
            printed[3],
            rates[3],
            printed[2] / printed[0],
            rates[2] / rates[0],
        );
    }
    Ok(())
}

/// Table 2: the sign test over an interval method, on the device.
pub(crate) fn table_2(timing: &Timing, size: usize) -> Result<(), Failure> {
    println!("\n## Table 2, {size}x{size}, on the device\n");
    println!(
        "Bisection along the ray with intervals rounded to nearest, to depth 10, every last piece a hit; \
         the same rounded outward; and the sign test. Times by the device's clock.\n"
    );
    println!(
        "| surface | interval ms | outward ms | sign ms | sign over interval, paper | measured | \
         outward over nearest | intervals a ray | values a ray |"
    );
    println!("|{}", "---|".repeat(9));
    for (i, [interval, sign]) in TABLE_2.iter().enumerate() {
        let scene = row(2, i + 1)?;
        let view = View::new(Camera::facing(&scene.domain), size, size);
        let bisection = |rounding| {
            BisectionGpu::auto(Bisection {
                stop: Stop::Depth(10),
                finish: Finishing::Accept,
                rounding,
                ..Bisection::tbisect()
            })
        };
        let on = |method: &dyn Method| {
            let intersector = method.prepare(&scene)?;
            cast(timing, &*intersector, Rays::View(&view), Request::First)
        };
        let nearest = on(&bisection(Rounding::Nearest))?;
        let outward = on(&bisection(Rounding::Outward))?;
        let amp = on(&AmpGpu::default())?;
        let rays = (size * size) as f64;
        println!(
            "| {} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.1} | {:.1} |",
            scene.id,
            ms(nearest.time),
            ms(outward.time),
            ms(amp.time),
            sign / interval,
            ms(nearest.time) / ms(amp.time),
            ms(outward.time) / ms(nearest.time),
            nearest.work.intervals as f64 / rays,
            amp.work.points as f64 / rays,
        );
    }
    Ok(())
}

/// Table 3: the sign test on the CPU, with one thread and with all.
pub(crate) fn table_3(size: usize) -> Result<(), Failure> {
    println!("\n## Table 3, {size}x{size}\n");
    println!(
        "| surface | paper, CPU ms | one thread | all threads | to ding-dong, paper | one thread |"
    );
    println!("|{}", "---|".repeat(6));
    let mut first = None;
    for (i, [cpu, _]) in TABLE_3.iter().enumerate() {
        let (scene, single) = single(i, size)?;
        let view = View::new(Camera::facing(&scene.domain), size, size);
        let intersector = Amp::default().prepare(&scene)?;
        let all = ms(cast(&Timing::HERE, &*intersector, Rays::View(&view), Request::First)?.time);
        let base = *first.get_or_insert(single);
        println!(
            "| {} | {cpu} | {single:.2} | {all:.2} | {:.2} | {:.2} |",
            scene.id,
            cpu / TABLE_3[0][0],
            single / base
        );
    }
    Ok(())
}

/// The surface of a row of Table 3, counted from 0, and milliseconds of the sign test in one thread.
fn single(row_index: usize, size: usize) -> Result<(Scene, f64), Failure> {
    let scene = row(3, row_index + 1)?;
    let view = View::new(Camera::facing(&scene.domain), size, size);
    let intersector = Amp::default().prepare(&scene)?;
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let timed = || {
        let rays = Rays::View(&view);
        cast(&Timing::HERE, &*intersector, rays, Request::First).map_err(|e| e.to_string())
    };
    let time = ms(one.install(timed)?.time);
    Ok((scene, time))
}

/// Table 3: the sign test on one thread of the CPU against that on the device.
pub(crate) fn table_3_device(timing: &Timing, size: usize) -> Result<(), Failure> {
    println!("\n## Table 3, {size}x{size}, on the device\n");
    println!("| surface | one CPU thread ms | device ms | CPU over device, paper | measured |");
    println!("|{}", "---|".repeat(5));
    for (i, [cpu, gpu]) in TABLE_3.iter().enumerate() {
        let (scene, single) = single(i, size)?;
        let view = View::new(Camera::facing(&scene.domain), size, size);
        let intersector = AmpGpu::default().prepare(&scene)?;
        let device = ms(cast(timing, &*intersector, Rays::View(&view), Request::First)?.time);
        println!(
            "| {} | {single:.2} | {device:.3} | {:.1} | {:.1} |",
            scene.id,
            cpu / gpu,
            single / device
        );
    }
    Ok(())
}
