//! `zeroset slim`: surfaces of balls from points.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use zeroset::model::points::Cloud;
use zeroset::model::slim::{self, Edges, Summary};
use zeroset::shade;

use crate::destination::has_extension;
use crate::failure::Failure;
use crate::frame::milliseconds;
use crate::numbers::{self, short};
use crate::output;
use crate::watch::{self, Bar};

const EXAMPLES: &str = "\
Examples:
  zeroset slim build bunny.ply --error 1e-4 --out bunny.slim
  zeroset compare bunny.slim";

/// Makes SLIM surfaces: balls with a quadric each, blended where they overlap.
#[derive(Args, Clone, Debug)]
pub(crate) struct SlimCommand {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand, Clone, Debug)]
enum What {
    Build(Build),
}

/// Makes a surface from points with normals.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
struct Build {
    /// Points: .ply, .obj, or lines of x y z [nx ny nz]; compressed by gzip or not. Normals are those of
    /// the file, else those of its faces, else estimated
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// The error of a ball's quadric at most, in diagonals of the points' box
    #[arg(long, value_name = "E", value_parser = numbers::positive, default_value = "1e-4")]
    error: f64,
    /// Where normals fall in two clusters, two surfaces meet at a sharp edge, each cut by a plane; else edges
    /// are rounded
    #[arg(long)]
    edges: bool,
    /// The file to write [default: the name of the points with .slim, in out/]
    #[arg(long, value_name = "FILE.slim")]
    out: Option<PathBuf>,
}

impl SlimCommand {
    /// Runs the command.
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let What::Build(build) = &self.what;
        build.run()
    }
}

impl Build {
    fn run(&self) -> Result<(), Failure> {
        let stem = self.file.file_stem().unwrap_or_default().to_string_lossy();
        let stem = stem.trim_end_matches(".ply").trim_end_matches(".obj").trim_end_matches(".xyz");
        let default = || PathBuf::from("out").join(format!("{stem}.slim"));
        let out = self.out.clone().unwrap_or_else(default);
        if !has_extension(&out, "slim") {
            let why = format!("--out {} does not end in .slim", out.display());
            return Err(Failure::usage(why));
        }
        let (cloud, dropped) = Cloud::read(&self.file).map_err(Failure::work)?;
        output::make_folder_of(&out)?;
        let progress = watch::interruptible()?;
        let edges = if self.edges { Edges::Clip } else { Edges::Ignore };
        let options = slim::Options { error: self.error, edges, ..slim::Options::default() };
        let built = Bar::new().follow("balls", cloud.points.len(), &progress, || {
            slim::build(&cloud, &options, &progress)
        });
        let (surface, summary) = built.map_err(|error| match error {
            slim::Error::Interrupted => Failure::Interrupted,
            error => Failure::work(error),
        })?;
        shade::write_atomically(&out, &surface.to_bytes()).map_err(Failure::work)?;
        let Summary { rms, max, overlap, time, .. } = summary;
        let facts = [
            format!("{} points; {dropped}", cloud.points.len()),
            format!(
                "{} balls in {} ms, {overlap:.2} at a point",
                surface.balls().len(),
                short(milliseconds(time))
            ),
            format!("distances of the points: RMS {rms:.1e}, worst {max:.1e} of the diagonal"),
            out.display().to_string(),
        ];
        output::print(format!("{}\n", facts.join("\n")).as_bytes())
    }
}
