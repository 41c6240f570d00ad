//! Fig. 4, 5, 6 and 9: settings, what they cost and what they lose.

use zeroset::bench::{Class, Sample, Tolerance, Truths, Verdict, judge, truth};
use zeroset::cpu::Implicit;
use zeroset::cpu::amp::{Adaptation, Amp, RootTest, Settings};
use zeroset::raycast::{Camera, Hits, Method, Progress, Rays, Request, Scene, View};

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
        let scene = surface(id)?;
        let view = View::new(Camera::facing(&scene.domain), size, size);
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
    println!(
        "\nThe maps themselves: `zeroset render barth-decic --method amp-sign --view steps`, and the same \
         with `--set amp-sign.silhouette_adaptation=off`."
    );
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
