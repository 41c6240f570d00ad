//! Every kind of picture of an open sphere in a torus: `gallery FOLDER`.
//!
//! The hits are found by sampling and bisection; the certificates and the errors are made up, to
//! show all colours.

use std::path::Path;

use glam::DVec3;
use zeroset_raycast::{
    Camera, Certificate, Domain, Hit, Hits, Projection, Ray, Request, View, Work,
};
use zeroset_shade::{Agreement, ShadeError, ViewKind, exr, picture, sheet};

/// Samples on a ray through the domain.
const SAMPLES: u64 = 600;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("give a folder: gallery FOLDER")?;
    let domain = Domain::new(DVec3::new(-2.0, -2.0, -1.1), DVec3::new(2.0, 2.0, 1.1))?;
    let camera = Camera {
        projection: Projection::Perspective { fov: 21.0 },
        eye: DVec3::new(5.5, -6.5, 5.5),
        ..Camera::facing(&domain)
    };
    let view = View::new(camera, 480, 360);
    let (hits, agreement) = cast(&view, &domain);
    save(Path::new(&folder), &view, &hits, &agreement)?;
    println!("pictures are in {folder}");
    Ok(())
}

fn save(
    folder: &Path,
    view: &View,
    hits: &Hits,
    agreement: &[Agreement],
) -> Result<(), ShadeError> {
    let mut tiles = Vec::new();
    for kind in ViewKind::ALL {
        let picture = picture(kind, view, hits, Some(agreement))?;
        picture.save_png(&folder.join(format!("{kind}.png")))?;
        picture.with_legend()?.save_png(&folder.join(format!("{kind}-legend.png")))?;
        tiles.push((format!("{kind}\n{}", picture.description()), picture));
    }
    let tiles: Vec<_> = tiles.iter().map(|(words, p)| sheet::Tile::new(words, &[p])).collect();
    let title = "An open sphere in a torus: every kind of picture (480 x 360)";
    sheet::sheet(title, &tiles)?.save_png(&folder.join("sheet.png"))?;
    let shaded = picture(ViewKind::Shaded, view, hits, None)?;
    exr::save(&folder.join("hits.exr"), view, hits, Some(&shaded))
}

/// Positive outside: a torus of radii 1.45 and 0.4, and a sphere of radius 0.9 below z = 0.45.
fn value(p: DVec3) -> f64 {
    let ring = DVec3::new(p.x.hypot(p.y) - 1.45, p.z, 0.0).length() - 0.4;
    let ball = p.length() - 0.9;
    if p.z < 0.45 { ring * ball } else { ring }
}

fn gradient(p: DVec3) -> DVec3 {
    let h = 1e-6;
    let along = |e: DVec3| value(p + h * e) - value(p - h * e);
    DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z)).normalize_or_zero()
}

fn cast(view: &View, domain: &Domain) -> (Hits, Vec<Agreement>) {
    let pixels = view.width * view.height;
    let distance = view.camera().eye.distance(domain.centre());
    let mut hits = Hits::new(Request::FirstWithNormal, pixels);
    let mut agreement = vec![Agreement::CorrectMiss; pixels];
    for (i, agreement) in agreement.iter_mut().enumerate() {
        let (column, row) = (i % view.width, i / view.width);
        let ray = view.ray(column, row);
        let (bracket, points) =
            search(ray, [distance - domain.radius(), distance + domain.radius()]);
        let work = Work { points, ..Work::default() };
        let Some(bracket) = bracket else {
            let certificate =
                [Certificate::PROVEN_MISS, Certificate::MISS][column * 2 / view.width];
            hits.set(i, Hit::miss(certificate, work));
            continue;
        };
        let hit =
            Hit { bracket, certificate: Certificate::ALL[(column / 16 + row / 16) % 4], work };
        let gradient = gradient(ray.at(hit.t()));
        hits.set(i, hit);
        hits.normal[i] = gradient.as_vec3();
        let grazing = gradient.dot(ray.direction.as_dvec3()).abs();
        *agreement = match (grazing, column % 97) {
            (g, _) if g < 0.06 => Agreement::FalseMiss,
            (g, _) if g < 0.10 => Agreement::WrongSheet,
            (g, _) if g < 0.13 => Agreement::FalseHit,
            (_, 0..8) => Agreement::Undecided,
            (_, 8..12) => Agreement::NotSampled,
            _ => Agreement::Correct { dt: 1e-8 / grazing.powi(8) },
        };
    }
    (hits, agreement)
}

/// The first change of sign between samples, bisected; and how many values were taken.
fn search(ray: Ray, [near, far]: [f64; 2]) -> (Option<[f64; 2]>, u64) {
    let mut count = 0;
    let mut f = |t: f64| {
        count += 1;
        value(ray.at(t))
    };
    let mut lo = near;
    let mut sign = f(lo) > 0.0;
    for i in 1..=SAMPLES {
        let mut hi = near + (far - near) * i as f64 / SAMPLES as f64;
        let next = (hi, f(hi) > 0.0);
        if next.1 != sign {
            for _ in 0..30 {
                let middle = 0.5 * (lo + hi);
                if (f(middle) > 0.0) == sign { lo = middle } else { hi = middle }
            }
            // Where the sphere ends, the sign changes without a root.
            if f(lo).abs() < 1e-6 {
                return (Some([lo, hi]), count);
            }
        }
        (lo, sign) = next;
    }
    (None, count)
}
