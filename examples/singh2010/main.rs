//! The measurements of [singh2010] on one code base: `cargo run --release --example singh2010`.
//!
//! `-- SIZE` sets the pixels along a side (512); pictures that are judged have at most 128. The numbers
//! in `docs/singh2010.md` were printed by this program. Without a device the parts that need one say so.

mod counts;
mod figures;
mod peak;
mod published;
mod tables;

use zeroset::gpu::{Choice, Device};
use zeroset::raycast::Scene;
use zeroset::raycast::catalogue::Catalogue;

type Failure = Box<dyn std::error::Error>;

/// A surface of the catalogue.
fn surface(id: &str) -> Result<Scene, Failure> {
    let surface = Catalogue::builtin().get(id).ok_or_else(|| format!("no surface {id}"))?;
    Ok(surface.scene()?)
}

/// The surface of a table's row, counted from 1.
fn row(table: usize, row: usize) -> Result<Scene, Failure> {
    let name = format!("singh2010 Table {table} row {row}");
    let surface = Catalogue::builtin().iter().find(|s| s.papers.contains(&name));
    Ok(surface.ok_or_else(|| format!("no surface is {name}"))?.scene()?)
}

fn main() -> Result<(), Failure> {
    let size: usize = std::env::args().nth(1).map_or(Ok(512), |text| text.parse())?;
    let judged = size.min(128);
    tables::table_1(size)?;
    tables::table_3(size)?;
    figures::fig_4_5(judged)?;
    figures::fig_6(judged)?;
    figures::fig_9(judged)?;
    counts::section_3_1()?;
    counts::chebyshev(size.min(32))?;
    match Device::open(&Choice::Auto) {
        Ok(device) => {
            println!("\nThe device: {}, {}", device.report().name, device.report().driver);
            tables::table_1_device(size)?;
            tables::table_2(size)?;
        }
        Err(why) => println!("\nTables 1 and 2 on a device: {why}"),
    }
    tables::section_4_3(size)
}
