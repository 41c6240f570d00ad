//! `zeroset trace`: a batch of rays from a script, answered one a row.

use std::fmt::{Display, Write};
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use clap::Args;
use zeroset::bench;
use zeroset::raycast::{Hits, Ray, RayBatch, Rays, Request};
use zeroset::shade;

use crate::failure::Failure;
use crate::options::{MethodOptions, SceneOptions};
use crate::ray_file;
use crate::watch::{self, Bar};
use crate::{output, surface};

const AFTER: &str = "\
Input: CSV with a header; columns ox,oy,oz,dx,dy,dz, others are ignored. Each number is rounded to
single precision once and then exact. The point at t is origin + t * direction, with the direction
as given; roots count for t >= 0 in the closed domain.

Output: one row a ray, in order: ray,certificate,t_lo,t_hi,nx,ny,nz,points,gradients,intervals.
The certificate is proven-hit, possible-hit, root-hit, hit, proven-miss or miss; t_lo and t_hi are
inf for a miss, and its normal 0,0,0. Numbers read back exactly.

Example:
  printf 'ox,oy,oz,dx,dy,dz\\n0,0,-3,0,0,1\\n' |
    zeroset trace 'x^2+y^2+z^2=1' --method kmarch --rays - --out -";

/// Casts the rays of a CSV file and writes an answer for each.
#[derive(Args, Clone, Debug)]
#[command(after_help = AFTER)]
pub(crate) struct Trace {
    #[command(flatten)]
    scene: SceneOptions,
    /// The method; `zeroset list methods` lists them
    #[arg(long, value_name = "M")]
    method: String,
    /// The rays; `-` reads standard input
    #[arg(long, value_name = "FILE.csv")]
    rays: PathBuf,
    /// The answers; `-` writes to standard output
    #[arg(long, value_name = "FILE.csv")]
    out: PathBuf,
    #[command(flatten)]
    methods: MethodOptions,
}

impl Trace {
    /// Runs the command.
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let (_, scene) = surface::scene(&self.scene)?;
        let mut methods = [bench::method(&self.method).map_err(Failure::usage)?];
        self.methods.set(&mut methods, &scene)?;
        let rays = self.read()?;
        if !is_dash(&self.out) {
            output::make_folder_of(&self.out)?;
            self.keep_rays()?;
        }
        let progress = watch::interruptible()?;
        let batch = RayBatch::new(rays);
        let rays = Rays::Batch(&batch);
        let mut hits = Hits::new(Request::FirstWithNormal, rays.len());
        let intersector = methods[0].prepare(&scene)?;
        Bar::new().follow(&self.method, rays.len(), &progress, || {
            intersector.intersect(rays, &mut hits, &progress)
        })?;
        let text = table(&hits);
        if is_dash(&self.out) {
            output::print(text.as_bytes())
        } else {
            shade::write_atomically(&self.out, text.as_bytes()).map_err(Failure::work)
        }
    }

    fn read(&self) -> Result<Vec<Ray>, Failure> {
        if is_dash(&self.rays) {
            return ray_file::read(io::stdin().lock())
                .map_err(|why| Failure::work(format!("standard input, {why}")));
        }
        let name = self.rays.display();
        let fail = |why: &dyn Display| Failure::work(format!("cannot read the rays {name}: {why}"));
        if self.rays.is_dir() {
            return Err(fail(&"it is a folder"));
        }
        let file = File::open(&self.rays).map_err(|error| fail(&error))?;
        ray_file::read(file).map_err(|why| Failure::work(format!("{name}, {why}")))
    }

    /// Refuses to write the answers over the rays.
    fn keep_rays(&self) -> Result<(), Failure> {
        match (self.rays.canonicalize(), self.out.canonicalize()) {
            (Ok(rays), Ok(out)) if rays == out => Err(Failure::usage(format!(
                "--out {} would overwrite the rays; name another file",
                self.out.display()
            ))),
            _ => Ok(()),
        }
    }
}

fn is_dash(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// One row an answer.
fn table(hits: &Hits) -> String {
    let mut text = String::from("ray,certificate,t_lo,t_hi,nx,ny,nz,points,gradients,intervals\n");
    for ray in 0..hits.len() {
        let hit = hits.get(ray);
        let [lo, hi] = hit.bracket;
        let n = hits.normal[ray];
        let work = hit.work;
        writeln!(
            text,
            "{ray},{},{lo:?},{hi:?},{:?},{:?},{:?},{},{},{}",
            hit.certificate, n.x, n.y, n.z, work.points, work.gradients, work.intervals
        )
        .expect("a string takes all");
    }
    text
}
