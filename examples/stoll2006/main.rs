//! The measurements of [stoll2006]: `cargo run --release --example stoll2006 -- accuracy --rays 1000000`.
//!
//! `throughput`, `models FILE..` and `volumes [FILE ISOVALUE]..` make its tables 1, 2 and 3. The numbers in
//! `docs/stoll2006.md` were printed by this program.

mod accuracy;
mod frames;

use clap::{Parser, Subcommand};

type Failure = Box<dyn std::error::Error>;

/// Measures what the paper claims.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Formulas on single quadrics, at all distances and curvatures
    Accuracy {
        /// Rays a case
        #[arg(long, default_value = "100000")]
        rays: usize,
    },
    /// Table 1: fragments and quadrics a second
    Throughput,
    /// Table 2: surfaces of files of points
    Models {
        /// Points with normals or faces, such as the Stanford scans
        files: Vec<String>,
    },
    /// Table 3: isosurfaces of generated volumes, and of files
    Volumes {
        /// A volume and its isovalue, again and again
        files: Vec<String>,
    },
}

fn main() -> Result<(), Failure> {
    match Arguments::parse().what {
        What::Accuracy { rays } => accuracy::print(rays)?,
        What::Throughput => frames::throughput()?,
        What::Models { files } => frames::models(&files)?,
        What::Volumes { files } => frames::volumes(&files)?,
    }
    Ok(())
}
