//! Fig. 4 to 7 and 9: settings, what they cost and what they lose.

use std::path::Path;

use zeroset::bench::{Class, Sample, Tolerance, Truths, Verdict, judge, truth};
use zeroset::cpu::Implicit;
use zeroset::cpu::amp::{Adaptation, Amp, RootTest, Settings};
use zeroset::raycast::{Camera, Hits, Method, Progress, Projection, Rays, Request, Scene, View};
use zeroset::shade::Picture;

use crate::published::{FIG_9_STEPS, FIG_9_THRESHOLDS};
use crate::{Failure, surface};

/// A scene with what is true of every ray of its view.
struct Judged {
    scene: Scene,
    view: View,
    truths: Truths,
}

/// What a setting loses and costs.
struct Outcome {
    hits: Hits,
    lost: usize,
    false_hits: usize,
    /// Lost, where the ray only touches the surface.
    touched: usize,
}

impl Judged {
    fn new(id: &str, size: usize) -> Result<Self, Failure> {
        Self::zoomed(id, size, 1.0)
    }

    /// In the default view, narrowed around its middle.
    fn zoomed(id: &str, size: usize, zoom: f64) -> Result<Self, Failure> {
        let scene = surface(id)?;
        let facing = Camera::facing(&scene.domain);
        let projection = match facing.projection {
            Projection::Perspective { fov } => {
                let half = (0.5 * fov.to_radians()).tan() / zoom;
                Projection::Perspective { fov: 2.0 * half.atan().to_degrees() }
            }
            Projection::Orthographic { height } => {
                Projection::Orthographic { height: height / zoom }
            }
        };
        let view = View::new(Camera { projection, ..facing }, size, size);
        let rays = Rays::View(&view);
        let sample = Sample::every(1, rays);
        let oracle = truth::reference(&scene)?;
        let truths = oracle.classify(rays, &sample.indices, &Progress::new())?;
        Ok(Self { scene, view, truths: Truths { sample, truths } })
    }

    fn cast(&self, amp: &Amp) -> Result<Outcome, Failure> {
        let rays = Rays::View(&self.view);
        let mut hits = Hits::new(Request::First, rays.len());
        amp.prepare(&self.scene)?.intersect(rays, &mut hits, &Progress::new())?;
        let tally = judge(rays, &hits, &self.truths, Tolerance::Footprint).tally;
        Ok(Outcome {
            lost: tally.count(Verdict::FalseMiss) + tally.count(Verdict::WrongSheet),
            false_hits: tally.count(Verdict::FalseHit),
            touched: tally.count_in(Class::Tangential, Verdict::FalseMiss),
            hits,
        })
    }

    /// How many rays cross the surface, and how many touch it only.
    fn classes(&self) -> String {
        let [crossing, touching] = [Class::Transversal, Class::Tangential]
            .map(|class| self.truths.truths.iter().filter(|t| t.class == class).count());
        format!("{crossing} cross, {touching} touch")
    }
}

/// Samples of each ray: values, and gradients of both kinds.
fn samples(hits: &Hits) -> Vec<u64> {
    hits.work.iter().map(|work| work.points.max(work.gradients)).collect()
}

fn mean(numbers: impl Iterator<Item = u64>) -> f64 {
    let (mut sum, mut count) = (0, 0_u64);
    for n in numbers {
        sum += n;
        count += 1;
    }
    sum as f64 / count.max(1) as f64
}

/// Fig. 4 and 5: what silhouette adaptation costs and saves, and where the samples go.
pub(crate) fn fig_4_5(size: usize) -> Result<(), Failure> {
    println!("\n## Fig. 4 and 5, {size}x{size}\n");
    println!(
        "| surface | adaptation | lost | false | samples a ray | on rays that hit | on rays in the domain that miss | most |"
    );
    println!("|{}", "---|".repeat(8));
    for id in ["barth-decic", "superquadric-2p5"] {
        let judged = Judged::new(id, size)?;
        for (name, distance, silhouette) in [
            ("none: marching points", Adaptation::Off, Adaptation::Off),
            ("distance", Adaptation::On, Adaptation::Off),
            ("distance and silhouette", Adaptation::On, Adaptation::On),
        ] {
            let amp = Amp {
                distance_adaptation: distance,
                silhouette_adaptation: silhouette,
                ..Amp::default()
            };
            let Outcome { hits, lost, false_hits, .. } = judged.cast(&amp)?;
            let samples = samples(&hits);
            let by = |is_hit: bool| {
                let these = samples.iter().zip(&hits.certificate);
                mean(these.filter(|(n, c)| **n > 0 && c.is_hit() == is_hit).map(|(n, _)| *n))
            };
            println!(
                "| {id} | {name} | {lost} | {false_hits} | {:.1} | {:.1} | {:.1} | {} |",
                mean(samples.iter().copied()),
                by(true),
                by(false),
                samples.iter().max().copied().unwrap_or_default()
            );
        }
    }
    Ok(())
}

/// Where pictures are written.
const FOLDER: &str = "out/singh2010";

/// Writes a picture of grey values, a row after another from the top.
fn save(name: &str, [width, height]: [usize; 2], greys: &[f64]) -> Result<(), Failure> {
    let bytes = greys.iter().map(|grey| [(255.0 * grey.clamp(0.0, 1.0)) as u8; 3]).collect();
    let file = Path::new(FOLDER).join(name);
    Picture::from_pixels(width, height, bytes)?.save_png(&file)?;
    println!("- `{}`", file.display());
    Ok(())
}

/// The maps of Fig. 5: samples along each ray without silhouette adaptation, with it, and twice the
/// difference; darker for fewer.
pub(crate) fn fig_5_maps(size: usize) -> Result<(), Failure> {
    println!("\n## Fig. 5, {size}x{size}: maps of samples\n");
    std::fs::create_dir_all(FOLDER)?;
    let scene = surface("barth-decic")?;
    let view = View::new(Camera::facing(&scene.domain), size, size);
    let counts = |silhouette_adaptation| -> Result<Vec<f64>, Failure> {
        let amp = Amp { silhouette_adaptation, ..Amp::default() };
        let mut hits = Hits::new(Request::First, size * size);
        amp.prepare(&scene)?.intersect(Rays::View(&view), &mut hits, &Progress::new())?;
        Ok(samples(&hits).into_iter().map(|n| n as f64).collect())
    };
    let (without, with) = (counts(Adaptation::Off)?, counts(Adaptation::On)?);
    let most = with.iter().copied().fold(1.0, f64::max);
    let scaled = |counts: &[f64]| counts.iter().map(|n| n / most).collect::<Vec<_>>();
    let more: Vec<f64> = with.iter().zip(&without).map(|(a, b)| a - b).collect();
    let twice: Vec<f64> = more.iter().map(|n| 2.0 * n.abs() / most).collect();
    save("fig-5-without.png", [size; 2], &scaled(&without))?;
    save("fig-5-with.png", [size; 2], &scaled(&with))?;
    save("fig-5-difference.png", [size; 2], &twice)?;
    let changed = more.iter().filter(|n| **n != 0.0).count();
    println!(
        "\nWhite is {most} samples. With silhouette adaptation {changed} of {} rays take another number \
         of them: {:.1} more in the mean, {} at most.",
        size * size,
        more.iter().sum::<f64>() / changed.max(1) as f64,
        more.iter().copied().fold(0.0, f64::max)
    );
    Ok(())
}

/// Fig. 7: the Chmutov surface of order 50, whole and a sixteenth of the view's side, by form.
pub(crate) fn fig_7(size: usize) -> Result<(), Failure> {
    println!("\n## Fig. 7, {size}x{size}: Chmutov 50 and its zoom\n");
    println!("| form | view | rays that cross | lost | false | samples a ray |");
    println!("|---|---|---|---|---|---|");
    for id in ["chmutov-50", "chmutov-50-recurrence", "chmutov-50-cosine"] {
        for (name, zoom) in [("whole", 1.0), ("zoomed 16 times", 16.0)] {
            let judged = Judged::zoomed(id, size, zoom)?;
            let Outcome { hits, lost, false_hits, .. } = judged.cast(&Amp::default())?;
            let crossing = judged.truths.truths.iter().filter(|t| t.class == Class::Transversal);
            println!(
                "| {id} | {name} | {} | {lost} | {false_hits} | {:.1} |",
                crossing.count(),
                mean(samples(&hits).into_iter())
            );
        }
    }
    Ok(())
}

/// The size of a function, by which epsilon is scaled.
fn scale(scene: &Scene) -> Result<f64, Failure> {
    let implicit = Implicit::new("amp-sign", scene)?;
    Ok(Settings::new(&Amp::default(), &implicit, scene.published_step)?.tau1)
}

/// Fig. 6: multiple roots by the sign test, the offset surface and the Taylor test.
pub(crate) fn fig_6(size: usize) -> Result<(), Failure> {
    println!("\n## Fig. 6, {size}x{size}\n");
    println!(
        "Rays that lose a root, those among them that only touch the surface, and hits where there is no \
         root. The offset is S = 0.01 as printed.\n"
    );
    println!(
        "| surface | rays | sign: lost (touching) | false | offset: lost (touching) | false | Taylor: lost (touching) | false |"
    );
    println!("|{}", "---|".repeat(8));
    for id in ["steiner", "cross-cap", "miter", "kiss", "high-silhouette"] {
        let judged = Judged::new(id, size)?;
        let offset = 0.01 / scale(&judged.scene)?;
        let methods = [
            Amp::default(),
            Amp { epsilon: offset, ..Amp::default() },
            Amp { test: RootTest::Taylor, ..Amp::default() },
        ];
        let mut cells = Vec::new();
        for amp in &methods {
            let outcome = judged.cast(amp)?;
            cells.push(format!("{} ({}) | {}", outcome.lost, outcome.touched, outcome.false_hits));
        }
        println!("| {id} | {} | {} |", judged.classes(), cells.join(" | "));
    }
    Ok(())
}

/// Fig. 9: step sizes, thresholds, and their grid.
pub(crate) fn fig_9(size: usize) -> Result<(), Failure> {
    println!("\n## Fig. 9, {size}x{size}\n");
    println!(
        "Rates relative to the first, as printed, and evaluations relative to the first, inverted: a \
         gradient counts as two values.\n"
    );
    println!("| surface | setting | rate, paper | 1/evaluations | lost | false |");
    println!("|{}", "---|".repeat(6));
    let cost = |hits: &Hits| {
        let work = hits.total_work();
        (work.points + 2 * work.gradients) as f64
    };
    let decic = Judged::new("barth-decic", size)?;
    let mut first = None;
    for [step, rate] in FIG_9_STEPS {
        let outcome = decic.cast(&Amp { step: Some(step), ..Amp::default() })?;
        let base = *first.get_or_insert(cost(&outcome.hits));
        println!(
            "| barth-decic | step {step} | {:.2} | {:.2} | {} | {} |",
            rate / FIG_9_STEPS[0][1],
            base / cost(&outcome.hits),
            outcome.lost,
            outcome.false_hits
        );
    }
    let octic = Judged::new("chmutov-8", size)?;
    // S divided by its highest coefficient, as printed.
    let with = |tau1: f64, step: Option<f64>| Amp {
        scale: Some(128.0),
        tau1: Some(tau1),
        tau2: Some(2.0 * tau1),
        tau3: Some(0.5 * tau1),
        step,
        ..Amp::default()
    };
    let mut first = None;
    for [tau1, rate] in FIG_9_THRESHOLDS {
        let outcome = octic.cast(&with(tau1, None))?;
        let base = *first.get_or_insert(cost(&outcome.hits));
        println!(
            "| chmutov-8 | tau1 {tau1} | {:.2} | {:.2} | {} | {} |",
            rate / FIG_9_THRESHOLDS[0][1],
            base / cost(&outcome.hits),
            outcome.lost,
            outcome.false_hits
        );
    }
    println!("\nThe grid for the octic: evaluations a ray, and rays lost.\n");
    let steps = [0.01, 0.02, 0.04, 0.08];
    println!("| tau1 | {} |", steps.map(|step| format!("step {step}")).join(" | "));
    println!("|---|---|---|---|---|");
    for [tau1, _] in FIG_9_THRESHOLDS {
        let mut cells = Vec::new();
        for step in steps {
            let outcome = octic.cast(&with(tau1, Some(step)))?;
            let a_ray = cost(&outcome.hits) / outcome.hits.len() as f64;
            cells.push(format!("{a_ray:.1}, {}", outcome.lost));
        }
        println!("| {tau1} | {} |", cells.join(" | "));
    }
    Ok(())
}
