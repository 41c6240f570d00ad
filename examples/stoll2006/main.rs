//! The measurements of [stoll2006]: `cargo run --release --example stoll2006 -- accuracy --rays 1000000`.

mod accuracy;

use std::error::Error;

use clap::{Parser, Subcommand};

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
}

fn main() -> Result<(), Box<dyn Error>> {
    match Arguments::parse().what {
        What::Accuracy { rays } => accuracy::print(rays)?,
    }
    Ok(())
}
