//! Prints how exact splines are and how many tetrahedra isosurfaces have.
//!
//! `spline [FILE ISOVALUE]...`: without arguments, of known functions only.

#[path = "../tests/errors/mod.rs"]
mod errors;

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use errors::Errors;
use zeroset_model::spline::{Filter, Outside, Spline};
use zeroset_model::volume::Volume;
use zeroset_raycast::{Progress, Sides};

/// Samples along each axis in the table of errors.
const SIZES: [usize; 5] = [41, 81, 161, 164, 321];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (pairs, rest) = arguments.as_chunks::<2>();
    if !rest.is_empty() {
        return Err("each file takes an isovalue: spline [FILE ISOVALUE]...".into());
    }
    println!("| n | value, none | gradient, none | value, filtered | gradient, filtered |");
    println!("|---|---|---|---|---|");
    for n in SIZES {
        println!("{}", errors_of(n)?);
    }
    println!();
    println!("| volume | size | isovalue | tetrahedra | cubes | search s | patches s | file MB |");
    println!("|---|---|---|---|---|---|---|---|");
    println!("{}", counts("Marschner-Lobb", &Volume::marschner_lobb(41)?, 0.5, Outside::Below)?);
    println!("{}", counts("sphere", &Volume::sphere(64)?, 0.8, Outside::Above)?);
    for [file, isovalue] in pairs {
        let path = Path::new(file);
        let isovalue =
            isovalue.parse().map_err(|_| format!("the isovalue {isovalue:?} is no number"))?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        println!("{}", counts(&name, &Volume::read(path)?, isovalue, Outside::Below)?);
    }
    Ok(())
}

/// A row of the table of errors.
fn errors_of(n: usize) -> Result<String, Box<dyn Error>> {
    let volume = Volume::marschner_lobb(n)?;
    let mut row = format!("| {n} |");
    for (filter, border) in [(Filter::None, 1), (Filter::Laplacian, 3)] {
        let Errors { value, gradient } = Errors::of(&Spline::new(&volume, filter)?, n, border);
        row += &format!(" {value:.2e} | {gradient:.2e} |");
    }
    Ok(row)
}

/// A row of the table of counts.
fn counts(
    name: &str,
    volume: &Volume,
    isovalue: f64,
    outside: Outside,
) -> Result<String, Box<dyn Error>> {
    let start = Instant::now();
    let tets =
        Spline::new(volume, Filter::None)?.isosurface(isovalue, outside, &Progress::new())?;
    let search_s = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let patches = tets.patches(Sides::Front)?;
    let patches_s = start.elapsed().as_secs_f64();
    let [x, y, z] = volume.size();
    Ok(format!(
        "| {name} | {x} x {y} x {z} | {isovalue} | {} | {} | {search_s:.3} | {patches_s:.3} | {:.1} |",
        patches.all().len(),
        tets.cubes(),
        tets.to_bytes().len() as f64 * 1e-6
    ))
}
