//! The figures, and what they show.

use std::path::Path;

use zeroset::beam::{Beam, Enclosure, Level, Refinement, Start, Subdivision};
use zeroset::bench::{Class, Footprints, Oracle, Sample, Truth, truth};
use zeroset::raycast::{Hits, Method, Progress, Rays, Request};
use zeroset::shade::{Environment, Picture, shaded};

use crate::published::SURFACES;
use crate::{Failure, surface, view};

/// Where pictures go.
const FOLDER: &str = "out/ganacim2011";

/// Pixels along a side of pictures that are judged.
const JUDGED: usize = 128;

fn save(name: &str, picture: &Picture) -> Result<(), Failure> {
    let path = Path::new(FOLDER).join(name);
    picture.save_png(&path)?;
    println!("\n{}", path.display());
    Ok(())
}

/// Fig. 1: in which cell of the quadtree each pixel of the octdong was excluded; white shows the surface.
pub(crate) fn levels() -> Result<(), Failure> {
    println!("\n## Fig. 1: where the octdong's pixels are excluded, 512x512\n");
    let scene = surface("octdong")?;
    let view = view(&scene, 512);
    let method = Beam { start: Start::Size(1 << 16), ..Beam::adaptive() };
    let Subdivision { levels, hits, sizes } =
        method.prepare_beams(&scene)?.subdivide(&view, &Progress::new())?;
    println!("| cells' side | beams | may see the surface | evaluations a beam |");
    println!("|---|---|---|---|");
    for Level { size, cells, found, intervals, .. } in &levels {
        println!("| {size} | {cells} | {found} | {:.1} |", *intervals as f64 / *cells as f64);
    }
    // From dark blue for the largest cells to yellow for pixels.
    let colour = |size: u32| {
        let share = 1.0 - f64::from(size.ilog2()) / f64::from(levels[0].size.ilog2());
        [255.0 * share, 40.0 + 180.0 * share, 140.0 - 100.0 * share].map(|x| x as u8)
    };
    let pixels = hits
        .iter()
        .zip(&sizes)
        .map(|(hit, size)| if hit.certificate.is_hit() { [255; 3] } else { colour(*size) })
        .collect();
    save("fig-1-levels.png", &Picture::from_pixels(512, 512, pixels)?)
}

/// Pixels that are painted by mistake, by intervals and by affine forms: no ray of 16 meets the surface.
pub(crate) fn painted() -> Result<(), Failure> {
    println!("\n## Painted by mistake, {JUDGED}x{JUDGED}, outward\n");
    println!(
        "| surface | pixels of the surface |{}",
        " painted by mistake | share | lost | evaluations a pixel |".repeat(2)
    );
    println!("|{}", "---|".repeat(10));
    for surface_of in &SURFACES {
        let scene = surface(surface_of.id)?;
        let view = view(&scene, JUDGED);
        let rays = Rays::View(&view);
        let oracle = truth::reference(&scene)?;
        let sample = Sample::every(1, rays);
        let truths = Footprints(&oracle).classify(rays, &sample.indices, &Progress::new())?;
        let is_seen = |truth: &Truth| matches!(truth.class, Class::Transversal | Class::Tangential);
        let seen = truths.iter().filter(|truth| is_seen(truth)).count();
        let mut line = format!("| {} | {seen} |", surface_of.name);
        for enclosure in [Enclosure::Interval, Enclosure::Affine] {
            let method = Beam { enclosure, ..Beam::adaptive() };
            let mut hits = Hits::new(Request::First, rays.len());
            let report = method.prepare(&scene)?.intersect(rays, &mut hits, &Progress::new())?;
            let [mut mistaken, mut lost] = [0; 2];
            for (truth, certificate) in truths.iter().zip(&hits.certificate) {
                mistaken += usize::from(truth.class == Class::None && certificate.is_hit());
                lost += usize::from(is_seen(truth) && !certificate.is_hit());
            }
            line += &format!(
                " {mistaken} | {:.1} % | {lost} | {:.1} |",
                100.0 * mistaken as f64 / seen as f64,
                report.work.intervals as f64 / rays.len() as f64
            );
        }
        println!("{line}");
    }
    Ok(())
}

/// Figs. 2 to 4: the surfaces with 1 and with 4 samples a pixel, and how far both are from 64 samples.
pub(crate) fn samples() -> Result<(), Failure> {
    println!("\n## Figs. 2 to 4: samples a pixel, 256x256\n");
    println!(
        "Root mean square difference from 64 samples, of 255, and the pixels that 4 samples change.\n"
    );
    println!("| surface | 1 sample | 4 samples | 16 samples | changed by 4 | of them at edges |");
    println!("|---|---|---|---|---|---|");
    for surface_of in &SURFACES {
        let picture = |side: usize| picture(surface_of.id, 256, side);
        let [one, four, sixteen, most] = [picture(1)?, picture(2)?, picture(4)?, picture(8)?];
        let error = |a: &Picture| {
            let pairs = a.pixels().iter().flatten().zip(most.pixels().iter().flatten());
            let sum: f64 = pairs.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
            (sum / (3 * a.pixels().len()) as f64).sqrt()
        };
        let apart = |a: [u8; 3], b: [u8; 3]| {
            a.into_iter().zip(b).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
        };
        /// Of 255: what is seen.
        const SEEN: u8 = 16;
        let pixels = one.pixels();
        let changed: Vec<usize> =
            (0..pixels.len()).filter(|&i| apart(pixels[i], four.pixels()[i]) > SEEN).collect();
        let is_edge = |&&i: &&usize| {
            let (column, row) = (i as i64 % 256, i as i64 / 256);
            let near = (-1..=1).flat_map(|v| (-1..=1).map(move |u| (column + u, row + v)));
            near.filter(|(u, v)| (0..256).contains(u) && (0..256).contains(v))
                .any(|(u, v)| apart(pixels[(v * 256 + u) as usize], pixels[i]) > SEEN)
        };
        println!(
            "| {} | {:.2} | {:.2} | {:.2} | {} | {} |",
            surface_of.name,
            error(&one),
            error(&four),
            error(&sixteen),
            changed.len(),
            changed.iter().filter(is_edge).count()
        );
        for (picture, name) in [(&one, "1"), (&four, "4")] {
            picture.save_png(&Path::new(FOLDER).join(format!("{}-{name}.png", surface_of.id)))?;
        }
    }
    println!("\n{FOLDER}/SURFACE-SAMPLES.png");
    Ok(())
}

/// The surface in the light, `side` by `side` samples a pixel.
fn picture(id: &str, size: usize, side: usize) -> Result<Picture, Failure> {
    let scene = surface(id)?;
    let view = view(&scene, side * size);
    let mut hits = Hits::new(Request::FirstWithNormal, (side * size).pow(2));
    let method = Beam::new(Refinement::Adaptive);
    method.prepare(&scene)?.intersect(Rays::View(&view), &mut hits, &Progress::new())?;
    let lights = shaded::lights(&view);
    Ok(shaded::picture(&view, &hits, &lights, Environment::default())?.averaged(side)?)
}
