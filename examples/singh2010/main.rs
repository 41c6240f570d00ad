//! The measurements of [singh2010] on one code base: `cargo run --release --example singh2010`.
//!
//! `-- SIZE PART` sets the pixels along a side (512; pictures that are judged have at most 128) and whether
//! the `cpu` or the `device` is measured (both). The numbers in `docs/singh2010.md` and `docs/singh2010-gpu.md` were printed by this
//! program. Without a device the part that needs one says so.

mod counts;
mod figures;
mod peak;
mod published;
mod tables;
mod timing;

use timing::Timing;
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

/// On the processor: all that is judged or counted, and times.
fn on_the_cpu(size: usize) -> Result<(), Failure> {
    let judged = size.min(128);
    tables::table_1(size)?;
    tables::table_3(size)?;
    figures::fig_4_5(judged)?;
    figures::fig_5_maps(size)?;
    figures::fig_6(judged)?;
    // The reference takes 10 ms a ray and more.
    figures::fig_7(judged.min(24))?;
    figures::fig_9(judged)?;
    counts::section_3_1()?;
    counts::chebyshev(size.min(32))
}

/// On the device: times.
fn on_the_device(size: usize) -> Result<(), Failure> {
    match Device::open(&Choice::Auto) {
        Ok(device) => {
            println!("\nThe device: {}, {}", device.report().name, device.report().driver);
            let timing = Timing::on(&device)?;
            peak::section_4_3(&timing, &device, size)?;
            tables::table_1_device(&timing, size)?;
            tables::table_2(&timing, size)?;
            // The CPU takes long for more.
            tables::table_3_device(&timing, size.min(512))
        }
        Err(why) => {
            println!("\nTables 1 to 3 and Section 4.3 on a device: {why}");
            Ok(())
        }
    }
}

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1);
    let size = arguments.next().map_or(Ok(512), |text| text.parse())?;
    match arguments.next().as_deref() {
        None => on_the_cpu(size).and_then(|()| on_the_device(size)),
        Some("cpu") => on_the_cpu(size),
        Some("device") => on_the_device(size),
        Some(other) => Err(format!("{other:?} is neither `cpu` nor `device`").into()),
    }
}
