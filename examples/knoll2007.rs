//! The measurements of [knoll2007] on one code base: `cargo run --release --example knoll2007`.
//!
//! One thread, least time of frames taken in turns; `-- SIZE` sets the pixels along a side (512). The
//! numbers in `docs/knoll2007.md` were printed by this program.

use std::time::Instant;

use zeroset::bench::{Class, Sample, truth};
use zeroset::cpu::{Algorithm, Bisection, Finishing, Normals, Packets, Poles, Stop};
use zeroset::ia::{Isa, Register, Rounding};
use zeroset::raycast::catalogue::Catalogue;
use zeroset::raycast::{
    Camera, Hits, Intersector, Method, Progress, Rays, Request, Scene, View, Work,
};

type Failure = Box<dyn std::error::Error>;

/// The functions of Fig. 9, with the frames a second that it prints.
const FIG_9: [(&str, f64); 16] = [
    ("torus-sqrt", 22.9),
    ("sphere", 20.5),
    ("parabolic-cylinder", 34.1),
    ("hyperboloid", 19.2),
    ("steiner-knoll", 6.1),
    ("steiner2", 17.2),
    ("mitchell", 5.9),
    ("tangle", 3.8),
    ("blobby-knoll", 4.7),
    ("absolute-value", 30.8),
    ("inverse-function", 20.8),
    ("teardrop", 15.3),
    ("intersecting-planes", 33.0),
    ("klein", 6.0),
    ("linked-tori", 4.0),
    ("barth-sextic", 4.9),
];

/// How often each frame is taken.
const ROUNDS: usize = 7;

/// As the paper has it: nearest, every last piece a hit.
fn paper(algorithm: Algorithm, depth: u32) -> Bisection {
    Bisection {
        stop: Stop::Depth(depth),
        rounding: Rounding::Nearest,
        finish: Finishing::Accept,
        ..Bisection::new(algorithm)
    }
}

fn scene(id: &str) -> Result<Scene, Failure> {
    Ok(Catalogue::builtin().get(id).ok_or("it is in the catalogue")?.scene()?)
}

/// A frame's least time in ms, the share of rays that hit, and the evaluations of all rays.
struct Frame {
    ms: f64,
    hits: Hits,
    work: Work,
}

impl Frame {
    /// Evaluations a ray: intervals, gradients, points.
    fn evaluations(&self) -> [f64; 3] {
        let rays = self.hits.len() as f64;
        let Work { intervals, gradients, points, .. } = self.work;
        [intervals, gradients, points].map(|n| n as f64 / rays)
    }
}

/// Frames of some methods, taken in turns.
fn frames(
    methods: &[Bisection],
    scene: &Scene,
    size: usize,
    request: Request,
) -> Result<Vec<Frame>, Failure> {
    let view = View::new(Camera::facing(&scene.domain), size, size);
    let rays = Rays::View(&view);
    let prepared: Vec<Box<dyn Intersector>> =
        methods.iter().map(|method| method.prepare(scene)).collect::<Result<_, _>>()?;
    let frame = |_| Frame {
        ms: f64::INFINITY,
        hits: Hits::new(request, rays.len()),
        work: Work::default(),
    };
    let mut frames: Vec<Frame> = prepared.iter().map(frame).collect();
    for _ in 0..ROUNDS {
        for (intersector, frame) in prepared.iter().zip(&mut frames) {
            let start = Instant::now();
            frame.work = intersector.intersect(rays, &mut frame.hits, &Progress::new())?.work;
            frame.ms = frame.ms.min(1e3 * start.elapsed().as_secs_f64());
        }
    }
    Ok(frames)
}

/// Table 1: the three algorithms at two precisions.
fn table_1(size: usize) -> Result<(), Failure> {
    // Frames a second: K, t, Mitchell at depth 10, then at depth 22.
    let published = [
        ("trilinear-patch", [[10.6, 9.9, 1.20], [2.8, 0.31, 0.75]]),
        ("mitchell", [[5.9, 5.7, 0.61], [1.3, 1.0, 0.24]]),
    ];
    println!("## Table 1\n");
    println!("K's frames over the algorithm's, in packets of 4 and of 32 rays, and as printed.\n");
    let titles = ["function", "depth", "algorithm", "ms (4)", "ms (32)", "K/it (4)", "K/it (32)"];
    let counted = ["paper", "intervals a ray", "gradients", "points"];
    println!("| {} | {} |", titles.join(" | "), counted.join(" | "));
    println!("|{}", "---|".repeat(titles.len() + counted.len()));
    let algorithms = [Algorithm::Kmarch, Algorithm::Tbisect, Algorithm::Mitchell];
    for (id, fps) in published {
        let scene = scene(id)?;
        for (depth, fps) in [10, 22].into_iter().zip(fps) {
            let in_packets = |packets| {
                let methods = algorithms.map(|a| Bisection { packets, ..paper(a, depth) });
                frames(&methods, &scene, size, Request::First)
            };
            let four = in_packets(Packets::One(Register::Four))?;
            let wide = in_packets(Packets::Two)?;
            for (i, algorithm) in algorithms.into_iter().enumerate() {
                let [intervals, gradients, points] = wide[i].evaluations();
                let (ms, wide_ms) = (four[i].ms, wide[i].ms);
                let ratios = [ms / four[0].ms, wide_ms / wide[0].ms, fps[0] / fps[i]];
                let [ratio, wide_ratio, printed] = ratios.map(|ratio| format!("{ratio:.2}"));
                println!(
                    "| {id} | {depth} | `{}` | {ms:.1} | {wide_ms:.1} | {ratio} | {wide_ratio} | \
                     {printed} | {intervals:.1} | {gradients:.1} | {points:.1} |",
                    Bisection::new(algorithm).id(),
                );
            }
        }
    }
    Ok(())
}

/// Fig. 9: frame times and evaluations, and what outward rounding costs.
fn fig_9(size: usize) -> Result<(), Failure> {
    println!("\n## Fig. 9, depth 10\n");
    let isas: Vec<Isa> = Isa::available();
    let costs: Vec<String> = isas.iter().map(|isa| format!("outward on {}", isa.name())).collect();
    println!(
        "| function | ms | frames a second | paper | intervals a ray | {} |",
        costs.join(" | ")
    );
    println!("|---|---|---|---|---|{}", "---|".repeat(isas.len()));
    for (id, fps) in FIG_9 {
        let scene = scene(id)?;
        let on = |rounding| {
            let isas = isas.iter().map(|isa| Some(*isa));
            isas.map(move |isa| Bisection { rounding, isa, ..paper(Algorithm::Kmarch, 10) })
        };
        let methods: Vec<_> = on(Rounding::Nearest).chain(on(Rounding::Outward)).collect();
        let frames = frames(&methods, &scene, size, Request::First)?;
        let (nearest, outward) = frames.split_at(isas.len());
        let ratios: Vec<String> =
            nearest.iter().zip(outward).map(|(n, o)| format!("{:.2}", o.ms / n.ms)).collect();
        let widest = &nearest[isas.len() - 1];
        let (ms, [intervals, ..]) = (widest.ms, widest.evaluations());
        let ratios = ratios.join(" | ");
        println!("| {id} | {ms:.1} | {:.0} | {fps} | {intervals:.1} | {ratios} |", 1e3 / ms);
    }
    Ok(())
}

/// Fig. 7 and 8: rays that are hit without a root, by depth, and where the picture's topology is right.
fn depths(size: usize) -> Result<(), Failure> {
    const DEPTHS: [u32; 6] = [4, 6, 8, 10, 12, 14];
    println!("\n## Fig. 7 and 8: false hits by depth, {size}x{size}, outward\n");
    let columns: Vec<String> = DEPTHS.iter().map(ToString::to_string).collect();
    println!("| function | rays that hit | {} | topology right from |", columns.join(" | "));
    println!("|---|---|{}---|", "---|".repeat(DEPTHS.len()));
    let ids = FIG_9.iter().map(|(id, _)| *id).chain(["trilinear-patch", "heart-nordstrand"]);
    for id in ids {
        let scene = scene(id)?;
        let view = View::new(Camera::facing(&scene.domain), size, size);
        let rays = Rays::View(&view);
        let all = Sample::every(1, rays);
        let truths = truth::reference(&scene)?.classify(rays, &all.indices, &Progress::new())?;
        let truly: Vec<bool> = truths.iter().map(|truth| truth.class != Class::None).collect();
        let mut row = Vec::new();
        let mut right = None;
        for depth in DEPTHS {
            let rounding = Rounding::Outward;
            let method = Bisection { rounding, ..paper(Algorithm::Kmarch, depth) };
            let mut hits = Hits::new(Request::First, rays.len());
            method.prepare(&scene)?.intersect(rays, &mut hits, &Progress::new())?;
            let hit: Vec<bool> = hits.certificate.iter().map(|c| c.is_hit()).collect();
            let false_hits = hit.iter().zip(&truly).filter(|(hit, truth)| **hit && !**truth);
            row.push(false_hits.count().to_string());
            match regions(&hit, size) == regions(&truly, size) {
                true => right = right.or(Some(depth)),
                false => right = None,
            }
        }
        let hit = truly.iter().filter(|hit| **hit).count();
        let right = right.map_or("later".into(), |depth| depth.to_string());
        println!("| {id} | {hit} | {} | {right} |", row.join(" | "));
    }
    Ok(())
}

/// How many connected regions the hit pixels form (8 neighbours), and the others (4 neighbours).
fn regions(hit: &[bool], size: usize) -> [usize; 2] {
    let mut seen = vec![false; hit.len()];
    let mut count = [0; 2];
    for start in 0..hit.len() {
        if seen[start] {
            continue;
        }
        count[usize::from(!hit[start])] += 1;
        let mut open = vec![start];
        seen[start] = true;
        while let Some(at) = open.pop() {
            let (x, y) = (at % size, at / size);
            for (dx, dy) in (0..9).map(|i| (i % 3, i / 3)) {
                let diagonal = dx != 1 && dy != 1;
                let (x, y) = ((x + dx).wrapping_sub(1), (y + dy).wrapping_sub(1));
                if x >= size || y >= size || diagonal && !hit[at] {
                    continue;
                }
                let next = y * size + x;
                if hit[next] == hit[at] && !seen[next] {
                    seen[next] = true;
                    open.push(next);
                }
            }
        }
    }
    count
}

/// Fig. 4: a pole shown and hidden; Fig. 6: normals by gradient and by differences.
fn fig_4_and_6(size: usize) -> Result<(), Failure> {
    println!("\n## Fig. 4: `inverse-function`\n");
    println!("| poles | ms | hits | of them false |");
    println!("|---|---|---|---|");
    let pole = scene("inverse-function")?;
    let view = View::new(Camera::facing(&pole.domain), size, size);
    let rays = Rays::View(&view);
    let all = Sample::every(1, rays);
    let truths = truth::reference(&pole)?.classify(rays, &all.indices, &Progress::new())?;
    let methods = [Poles::Shown, Poles::Hidden]
        .map(|poles| Bisection { poles, ..paper(Algorithm::Kmarch, 10) });
    for (name, frame) in
        ["shown", "hidden"].into_iter().zip(frames(&methods, &pole, size, Request::First)?)
    {
        let hit = |i: &usize| frame.hits.certificate[*i].is_hit();
        let hits = (0..rays.len()).filter(hit).count();
        let is_false = |i: &usize| hit(i) && truths[*i].class == Class::None;
        let false_hits = (0..rays.len()).filter(is_false).count();
        println!("| {name} | {:.1} | {hits} | {false_hits} |", frame.ms);
    }

    println!("\n## Fig. 6: `heart-nordstrand`, depth 10\n");
    println!("| normals | ms |");
    println!("|---|---|");
    let heart = scene("heart-nordstrand")?;
    let kinds = [Normals::Gradient, Normals::Stencil(0.001), Normals::Stencil(0.01)];
    let methods = kinds.map(|normals| Bisection { normals, ..paper(Algorithm::Kmarch, 10) });
    let none = &frames(&methods[..1], &heart, size, Request::First)?[0];
    println!("| none | {:.1} |", none.ms);
    let with = frames(&methods, &heart, size, Request::FirstWithNormal)?;
    for (kind, frame) in kinds.iter().zip(with) {
        println!("| {kind:?} | {:.1} |", frame.ms);
    }
    Ok(())
}

fn main() -> Result<(), Failure> {
    let size = std::env::args().nth(1).map_or(Ok(512), |size| size.parse())?;
    if !(8..=4096).contains(&size) {
        return Err("the pixels along a side are from 8 to 4096".into());
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    pool.install(|| {
        table_1(size).map_err(|e| e.to_string())?;
        fig_9(size).map_err(|e| e.to_string())?;
        depths(size / 4).map_err(|e| e.to_string())?;
        fig_4_and_6(size).map_err(|e| e.to_string())
    })?;
    Ok(())
}
