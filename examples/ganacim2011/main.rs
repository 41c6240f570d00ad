//! The measurements of [ganacim2011] on one code base: `cargo run --release --example ganacim2011`.
//!
//! `-- PART..` chooses among `counts`, `cpu`, `device`, `levels`, `painted` and `samples` (all). The numbers in
//! `docs/ganacim2011.md` were printed by this program; pictures go to `out/ganacim2011`.

mod counts;
mod figures;
mod published;
mod times;

use zeroset::beam::{Beam, Refinement};
use zeroset::ia::Rounding;
use zeroset::raycast::catalogue::Catalogue;
use zeroset::raycast::{Camera, Scene, View};

type Failure = Box<dyn std::error::Error>;

/// A part of the measurements, by its name.
type Part = (&'static str, fn() -> Result<(), Failure>);

/// Images of the tables: pixels along a side.
const SIZES: [usize; 2] = [512, 1024];
/// Samples along the side of a pixel: 1 and 4 samples a pixel.
const SIDES: [usize; 2] = [1, 2];

/// A surface of the catalogue.
fn surface(id: &str) -> Result<Scene, Failure> {
    let surface = Catalogue::builtin().get(id).ok_or_else(|| format!("no surface {id}"))?;
    Ok(surface.scene()?)
}

/// The default view of a scene, which fills it: the paper's cameras are not published.
fn view(scene: &Scene, size: usize) -> View {
    View::new(Camera::facing(&scene.domain), size, size)
}

/// As the paper has it: rounded to nearest.
fn paper(refinement: Refinement) -> Beam {
    Beam { rounding: Rounding::Nearest, ..Beam::new(refinement) }
}

fn main() -> Result<(), Failure> {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let parts: [Part; 6] = [
        ("counts", counts::tables),
        ("cpu", times::on_the_cpu),
        ("device", times::on_the_device),
        ("levels", figures::levels),
        ("painted", figures::painted),
        ("samples", figures::samples),
    ];
    if let Some(unknown) = asked.iter().find(|name| parts.iter().all(|(n, _)| n != *name)) {
        let names = parts.map(|(name, _)| name).join(", ");
        return Err(format!("{unknown:?} is none of {names}").into());
    }
    for (name, part) in parts {
        if asked.is_empty() || asked.iter().any(|n| n == name) {
            part()?;
        }
    }
    Ok(())
}
