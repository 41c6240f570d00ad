//! Tables 1 to 3: what a device draws in a second.

use std::path::Path;
use std::time::{Duration, Instant};

use glam::{DMat3, DVec3};
use zeroset::model::points::Cloud;
use zeroset::model::slim::{self, Options};
use zeroset::model::spline;
use zeroset::model::volume::Volume;
use zeroset::quadric::{Culling, Quadrics, QuadricsGpu, is_hidden};
use zeroset::raycast::{
    Blending, Bound, Camera, Hits, Intersector, Method, Patch, Patches, Progress, Projection,
    Quadric, Rays, Request, Scene, Sides, View,
};

use crate::Failure;

/// Frames of which the median counts.
const FRAMES: usize = 5;
/// The paper's screens: full, and a window.
const SIZES: [[usize; 2]; 2] = [[1280, 1024], [512, 512]];

/// The median time of a frame: on the device where there is one, else on the clock.
fn frame(method: &dyn Method, scene: &Scene, view: &View) -> Result<Duration, Failure> {
    let intersector = method.prepare(scene)?;
    let mut times = Vec::new();
    for _ in 0..=FRAMES {
        times.push(once(intersector.as_ref(), view)?);
    }
    // The first one compiles.
    times.remove(0);
    times.sort();
    Ok(times[FRAMES / 2])
}

fn once(intersector: &dyn Intersector, view: &View) -> Result<Duration, Failure> {
    let mut hits = Hits::without_work(Request::FirstWithNormal, view.width * view.height);
    let start = Instant::now();
    let report = intersector.intersect(Rays::View(view), &mut hits, &Progress::new())?;
    Ok(report.device_time.unwrap_or_else(|| start.elapsed()))
}

fn ms(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// Balls or tetrahedra one behind the other, each with a surface that fills an image.
fn layers(count: usize, is_ball: bool, blending: Blending) -> Result<Scene, Failure> {
    let quadric = Quadric { a: DMat3::IDENTITY, b: DVec3::ZERO, c: -0.81 };
    let bound = if is_ball {
        Bound::Ball { centre: DVec3::ZERO, radius: 1.0 }
    } else {
        let corners = [(8.0, 8.0), (-8.0, 8.0), (0.0, -8.0)].map(|(x, z)| DVec3::new(x, -1.0, z));
        Bound::Tetrahedron([corners[0], corners[1], corners[2], DVec3::new(0.0, 6.0, 0.0)])
    };
    let patch = |i: usize| Patch {
        origin: DVec3::new(0.0, 1e-3 * i as f64, 0.0),
        quadric,
        bound,
        clip: None,
    };
    let patches = Patches::new((0..count).map(patch).collect(), Sides::Front, blending)?;
    Ok(Scene::of_patches("layers", patches))
}

/// A view of [`layers`] that shows nothing else.
fn inner(width: usize, height: usize) -> View {
    let projection = Projection::Perspective { fov: 12.0 };
    let eye = DVec3::new(0.0, -4.0, 0.0);
    View::new(Camera { eye, at: DVec3::ZERO, up: DVec3::Z, projection }, width, height)
}

/// Table 1: fragments and quadrics a second.
pub(crate) fn throughput() -> Result<(), Failure> {
    println!("## Table 1: throughput\n");
    println!("64 layers over 512x512 pixels, 16.8 million fragments a pass.\n");
    println!("| bound | method | ms | million fragments a second |");
    println!("|---|---|---|---|");
    let view = inner(512, 512);
    let fragments = 64.0 * (view.width * view.height) as f64;
    for (bound, is_ball) in [("ball", true), ("tetrahedron", false)] {
        for method in [QuadricsGpu::brute(), QuadricsGpu::incremental()] {
            let method = QuadricsGpu { culling: Culling::Fragments, ..method };
            let time = frame(&method, &layers(64, is_ball, Blending::None)?, &view)?;
            let rate = fragments / time.as_secs_f64() / 1e6;
            println!("| {bound} | {} | {:.2} | {rate:.1} |", method.id(), ms(time));
        }
    }
    println!("\n100000 quadrics in an image of 2x2 pixels.\n");
    println!("| bound | ms | million quadrics a second |\n|---|---|---|");
    for (bound, is_ball) in [("ball", true), ("tetrahedron", false)] {
        let scene = layers(100_000, is_ball, Blending::None)?;
        let time = frame(&QuadricsGpu::incremental(), &scene, &inner(2, 2))?;
        println!("| {bound} | {:.2} | {:.2} |", ms(time), 0.1 / time.as_secs_f64());
    }
    println!();
    Ok(())
}

/// Table 2: surfaces of files of points, with and without culling.
pub(crate) fn models(files: &[String]) -> Result<(), Failure> {
    println!("## Table 2: SLIM surfaces\n");
    println!("Milliseconds a frame: on the device culled and not, and on the CPU.\n");
    println!(
        "| model | quadrics | culled | size | device | without culling | ratio | CPU | to device |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for file in files {
        let path = Path::new(file);
        let (cloud, _) = Cloud::read(path)?;
        let (slim, _) = slim::build(&cloud, &Options::default(), &Progress::new())?;
        let scene = Scene::of_patches("model", slim.patches());
        let name = path.file_name().unwrap_or_default().display().to_string();
        table_rows(&name, &scene)?;
    }
    println!();
    Ok(())
}

fn table_rows(name: &str, scene: &Scene) -> Result<(), Failure> {
    let zeroset::raycast::Geometry::Patches(patches) = &scene.geometry else { unreachable!() };
    // The scans have y up.
    let centre = scene.domain.centre();
    let facing = Camera::facing(&scene.domain);
    let distance = (facing.eye - centre).length();
    let eye = centre + distance * DVec3::new(0.2, 0.2, 1.0).normalize();
    let camera = Camera { eye, up: DVec3::Y, ..facing };
    let hidden = patches.all().iter().filter(|patch| is_hidden(patch, eye)).count();
    let count = patches.all().len();
    for [width, height] in SIZES {
        let view = View::new(camera, width, height);
        let culled = frame(&QuadricsGpu::incremental(), scene, &view)?;
        let all = QuadricsGpu { culling: Culling::Fragments, ..QuadricsGpu::incremental() };
        let all = frame(&all, scene, &view)?;
        let cpu = once(Quadrics::incremental().prepare(scene)?.as_ref(), &view)?;
        println!(
            "| {name} | {count} | {:.1} % | {width}x{height} | {:.2} | {:.2} | {:.2} | {:.1} | {:.1} |",
            100.0 * hidden as f64 / count as f64,
            ms(culled),
            ms(all),
            ms(all) / ms(culled),
            ms(cpu),
            ms(cpu) / ms(culled),
        );
    }
    Ok(())
}

/// Table 3: isosurfaces of generated volumes, and of files with their isovalues.
pub(crate) fn volumes(files: &[String]) -> Result<(), Failure> {
    println!("## Table 3: isosurfaces in tetrahedra\n");
    println!("Milliseconds a frame.\n");
    println!("| volume | tetrahedra | 1280x1024, device | 512x512, device | 1280x1024, CPU |");
    println!("|---|---|---|---|---|");
    let mut all = vec![
        ("Sphere 64^3 at 0.8".to_owned(), Volume::sphere(64)?, 0.8),
        ("Marschner-Lobb 41^3 at 0.5".to_owned(), Volume::marschner_lobb(41)?, 0.5),
    ];
    for pair in files.chunks(2) {
        let [file, iso] = pair else { return Err("each volume takes an isovalue".into()) };
        let name = Path::new(file).file_name().unwrap_or_default().display();
        all.push((format!("{name} at {iso}"), Volume::read(Path::new(file))?, iso.parse()?));
    }
    for (name, volume, iso) in all {
        let tets = spline::isosurface(&volume, iso, &Progress::new())?;
        let scene = Scene::of_patches("volume", tets.patches(Sides::Front)?);
        let camera = Camera::facing(&scene.domain);
        let views = SIZES.map(|[width, height]| View::new(camera, width, height));
        let device = QuadricsGpu::incremental();
        let [full, window] = [&views[0], &views[1]].map(|view| frame(&device, &scene, view));
        let cpu = once(Quadrics::incremental().prepare(&scene)?.as_ref(), &views[0])?;
        println!(
            "| {name} | {} | {:.2} | {:.2} | {:.1} |",
            tets.len(),
            ms(full?),
            ms(window?),
            ms(cpu)
        );
    }
    println!();
    Ok(())
}
