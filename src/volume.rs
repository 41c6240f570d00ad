//! `zeroset volume`: isosurfaces of volumes in tetrahedra.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, Subcommand};
use zeroset::model::spline::{Filter, Outside, Spline};
use zeroset::model::volume::Volume;
use zeroset::shade;

use crate::destination::has_extension;
use crate::failure::Failure;
use crate::frame::milliseconds;
use crate::numbers::short;
use crate::output;
use crate::watch::{self, Bar};

const EXAMPLES: &str = "\
Examples:
  zeroset volume build marschner-lobb:41 --iso 0.5 --out signal.tets
  zeroset volume build fuel_64x64x64_uint8.raw --iso 20
  zeroset render signal.tets";

/// Makes isosurfaces of volumes: quadratic splines in tetrahedra.
#[derive(Args, Clone, Debug)]
pub(crate) struct VolumeCommand {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand, Clone, Debug)]
enum What {
    Build(Build),
}

/// Makes the tetrahedra of an isosurface.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
struct Build {
    /// A volume: .mhd, .mha, .nrrd, .nhdr, .nii, .den or .inr; or .raw with its size and type in the name, as
    /// fuel_64x64x64_uint8.raw; or a formula on N^3 samples: sphere:N (the distance from the middle) or
    /// marschner-lobb:N, both over [-1, 1]^3
    #[arg(value_name = "FILE")]
    volume: String,
    /// The isovalue
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    iso: f64,
    /// The outside is where values are above the isovalue, not below
    #[arg(long)]
    above: bool,
    /// Sharpens the samples first, so that quadratic functions are found as they are
    #[arg(long)]
    sharpen: bool,
    /// The file to write [default: the name of the volume with .tets, in out/]
    #[arg(long, value_name = "FILE.tets")]
    out: Option<PathBuf>,
}

impl VolumeCommand {
    /// Runs the command.
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let What::Build(build) = &self.what;
        build.run()
    }
}

impl Build {
    fn run(&self) -> Result<(), Failure> {
        let name = self.volume.replace(':', "-");
        let stem = Path::new(&name).file_stem().unwrap_or_default().to_string_lossy();
        let default = || Path::new("out").join(format!("{stem}.tets"));
        let out = self.out.clone().unwrap_or_else(default);
        if !has_extension(&out, "tets") {
            let why = format!("--out {} does not end in .tets", out.display());
            return Err(Failure::usage(why));
        }
        let volume = self.read()?;
        output::make_folder_of(&out)?;
        let progress = watch::interruptible()?;
        let start = Instant::now();
        let filter = if self.sharpen { Filter::Laplacian } else { Filter::None };
        let outside = if self.above { Outside::Above } else { Outside::Below };
        let spline = Spline::new(&volume, filter)?;
        let cubes = volume.values().len();
        let tets = Bar::new().follow("tetrahedra", cubes, &progress, || {
            spline.isosurface(self.iso, outside, &progress)
        })?;
        let time = milliseconds(start.elapsed());
        shade::write_atomically(&out, &tets.to_bytes()).map_err(Failure::work)?;
        let [x, y, z] = volume.size();
        let facts = [
            format!("{x} x {y} x {z} samples"),
            format!("{} tetrahedra in {} ms", tets.len(), short(time)),
            format!("{} cubes left out for samples that are not finite", tets.dropped()),
            out.display().to_string(),
        ];
        output::print(format!("{}\n", facts.join("\n")).as_bytes())
    }

    fn read(&self) -> Result<Volume, Failure> {
        let formula = |name: &str| {
            let size = self.volume.strip_prefix(name)?.strip_prefix(':')?;
            Some(size.parse::<usize>().map_err(|_| {
                Failure::usage(format!("{name}:N takes a number of samples, not {size:?}"))
            }))
        };
        if let Some(size) = formula("sphere") {
            return Volume::sphere(size?).map_err(Failure::usage);
        }
        if let Some(size) = formula("marschner-lobb") {
            return Volume::marschner_lobb(size?).map_err(Failure::usage);
        }
        Volume::read(Path::new(&self.volume)).map_err(Failure::work)
    }
}
