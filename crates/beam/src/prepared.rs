//! Beam casting compiled for a scene, on the CPU.

use rayon::prelude::*;
use zeroset_cpu::{Implicit, Numbers, normals};
use zeroset_expr::Parameters;
use zeroset_ia::{Interval, Isa, Mirror, Nearest, Rounding, Set, dispatch};
use zeroset_raycast::{
    Certificate, Error, Hit, Hits, Intersector, Method, Progress, Rays, Report, Scene, Unsupported,
    View, Work,
};

use crate::cast::{AffineVectors, Cast, LEAST, RawPairs, SetVectors, Sight};
use crate::form::AffineBeam;
use crate::gpu;
use crate::method::{Arithmetic, Beam, Enclosure, FILLING, Refinement, Start};
use crate::optics::Optics;
use crate::quadtree::{self, Level, Subdivision};

/// [`Beam`] compiled for a scene.
pub struct PreparedBeams {
    method: Beam,
    implicit: Implicit,
    numbers: Numbers,
}

/// Cells that are cast together by a thread.
const CHUNK: usize = 1024;

impl PreparedBeams {
    pub(crate) fn new(method: &Beam, scene: &Scene) -> Result<Self, Error> {
        let implicit = Implicit::new(method.id(), scene)?;
        let numbers = numbers(method, &implicit)?;
        Ok(Self { method: method.clone(), implicit, numbers })
    }

    /// The subdivision of a view's image.
    ///
    /// # Errors
    /// If the view is unsupported, or the work was asked to stop.
    pub fn subdivide(&self, view: &View, progress: &Progress) -> Result<Subdivision, Error> {
        let pixels = view.width * view.height;
        let Some(optics) = Optics::new(view, &self.implicit.domain)? else {
            let no_ray = Work { nonfinite: 1, ..Work::default() };
            let miss = Hit::miss(Certificate::MISS, no_ray);
            progress.advance(pixels)?;
            let (hits, sizes) = (vec![miss; pixels], vec![1; pixels]);
            return Ok(Subdivision { levels: Vec::new(), hits, sizes });
        };
        let image = [view.width, view.height];
        let mut levels = Vec::new();
        let (mut hits, mut sizes) = (vec![self.miss(); pixels], vec![1; pixels]);
        let mut size = self.method.first(image);
        let mut cells = quadtree::cells(image, size, optics.range[0].into());
        loop {
            let cast = Cast {
                tape: &self.implicit.tape,
                optics: &optics,
                domain: &self.implicit.domain,
                stop: self.method.stop,
                size,
                image,
                tolerance: self.method.tolerance(view, &optics, size),
                cells: &[],
            };
            let sights = cells
                .par_chunks(CHUNK)
                .map(|cells| {
                    let sights = self.sights(Cast { cells, ..cast });
                    let done = |sight: &Sight| size == 1 || sight.piece.is_none();
                    let pixels = (size as usize).pow(2);
                    let done = sights.iter().filter(|sight| done(sight)).count();
                    progress.advance((done * pixels).min(image[0] * image[1])).map(|()| sights)
                })
                .collect::<Result<Vec<_>, _>>()?
                .concat();
            levels.push(level(size, &sights));
            let mut next = Vec::new();
            let quarters = quadtree::extent(image, (size / 2).max(1));
            for (&cell, sight) in cells.iter().zip(&sights) {
                let [column, row] = [cell.column, cell.row].map(|i| (i * size) as usize);
                let (first, side) = (row * image[0] + column, size as usize);
                // The work of a cell counts at its first pixel.
                hits[first].work.intervals += u64::from(sight.intervals);
                match sight.piece {
                    None => {
                        for row in row..(row + side).min(image[1]) {
                            let columns = column..(column + side).min(image[0]);
                            sizes[row * image[0]..][columns].fill(size);
                        }
                    }
                    Some(piece) if size == 1 => {
                        hits[first].bracket = piece;
                        hits[first].certificate = self.method.found(sight.is_proven);
                    }
                    Some([start, _]) => next.extend(cell.quarters(quarters, start)),
                }
            }
            if size == 1 {
                return Ok(Subdivision { levels, hits, sizes });
            }
            (cells, size) = (next, size / 2);
        }
    }

    /// The answer for a pixel of which every piece was excluded.
    fn miss(&self) -> Hit {
        Hit::miss(self.method.excluded(), Work::default())
    }

    fn sights(&self, cast: Cast<'_>) -> Vec<Sight> {
        let Beam { arithmetic, enclosure, rounding, isa, .. } = self.method;
        let isa = isa.unwrap_or_else(Isa::best);
        let nearest = Nearest(0.0_f32);
        match (arithmetic, rounding, enclosure, self.numbers) {
            (Arithmetic::Device, Rounding::Nearest, Enclosure::Interval, _) => {
                cast.run::<_, Interval<_>>(nearest)
            }
            (Arithmetic::Device, Rounding::Nearest, Enclosure::Affine, _) => {
                cast.run::<_, AffineBeam<_>>(nearest)
            }
            (Arithmetic::Device, _, Enclosure::Interval, _) => {
                cast.run::<_, Interval<_>>(Mirror(0.0))
            }
            (Arithmetic::Device, _, Enclosure::Affine, _) => {
                cast.run::<_, AffineBeam<_>>(Mirror(0.0))
            }
            (_, Rounding::Nearest, _, Numbers::Double) => {
                cast.run::<_, Interval<_, Set>>(Nearest(0.0_f64))
            }
            (_, _, _, Numbers::Double) => cast.run::<_, Interval<_, Set>>(0.0_f64),
            (_, _, Enclosure::Interval, Numbers::Raw) => dispatch(isa, rounding, RawPairs(cast)),
            (_, _, Enclosure::Affine, Numbers::Raw) => dispatch(isa, rounding, AffineVectors(cast)),
            (_, _, _, Numbers::Set) => dispatch(isa, rounding, SetVectors(cast)),
        }
    }
}

/// What the method needs on a scene.
fn numbers(method: &Beam, implicit: &Implicit) -> Result<Numbers, Error> {
    Ok(match method.arithmetic {
        Arithmetic::Double => Numbers::Double,
        Arithmetic::Auto => Numbers::of(&implicit.tape, None, &implicit.domain),
        Arithmetic::Device => {
            gpu::check(method, implicit)?;
            Numbers::Raw
        }
    })
}

impl Beam {
    /// The side of the first cells for an image, in pixels.
    pub(crate) fn first(&self, image: [usize; 2]) -> u32 {
        let whole = quadtree::whole(image);
        match (self.refinement, self.start) {
            (Refinement::Uniform, _) => 1,
            (Refinement::Adaptive, Start::Size(size)) => size.min(whole),
            (Refinement::Adaptive, Start::Auto) => {
                let count = |size: u32| quadtree::extent(image, size).map(|n| n as usize);
                let mut size = whole;
                while size > 1 && count(size).into_iter().product::<usize>() < FILLING {
                    size /= 2;
                }
                size
            }
        }
    }

    /// The width in t of the last pieces of cells of a size.
    pub(crate) fn tolerance(&self, view: &View, optics: &Optics, size: u32) -> f64 {
        let [near, far] = optics.range.map(f64::from);
        let pixel = self.tolerance.unwrap_or_else(|| view.footprint(0.5 * (near + far)));
        (pixel * f64::from(size)).clamp(LEAST, f64::from(f32::MAX))
    }

    /// The certificate of a pixel in which a piece was found.
    pub(crate) fn found(&self, is_proven: bool) -> Certificate {
        match (self.rounding, is_proven) {
            (Rounding::Nearest, _) => Certificate::HIT,
            (_, true) => Certificate::PROVEN_HIT,
            (_, false) => Certificate::POSSIBLE_HIT,
        }
    }

    /// The certificate of a pixel of which every piece was excluded.
    pub(crate) fn excluded(&self) -> Certificate {
        match self.rounding {
            Rounding::Nearest => Certificate::MISS,
            _ => Certificate::PROVEN_MISS,
        }
    }
}

/// Counts what was done on a level.
fn level(size: u32, sights: &[Sight]) -> Level {
    /// Threads that share their instructions.
    const WARP: usize = 32;
    let in_step = |warp: &[Sight]| {
        WARP as u64 * u64::from(warp.iter().map(|sight| sight.intervals).max().unwrap_or(0))
    };
    Level {
        size,
        cells: sights.len() as u64,
        found: sights.iter().filter(|sight| sight.piece.is_some()).count() as u64,
        intervals: sights.iter().map(|sight| u64::from(sight.intervals)).sum(),
        in_step: sights.chunks(WARP).map(in_step).sum(),
    }
}

/// The view of a request.
///
/// # Errors
/// If it is a batch.
pub(crate) fn view<'a>(method: &str, rays: Rays<'a>) -> Result<&'a View, Error> {
    match rays {
        Rays::View(view) => Ok(view),
        Rays::Batch(_) => Err(Error::Unsupported(Unsupported(format!(
            "{method} casts the beams of a view's pixels, not single rays"
        )))),
    }
}

impl Intersector for PreparedBeams {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        let mut implicit = self.implicit.clone();
        implicit.set_parameters(values)?;
        self.numbers = numbers(&self.method, &implicit)?;
        self.implicit = implicit;
        Ok(())
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        assert_eq!(rays.len(), hits.len(), "one answer a ray");
        let view = view(self.method.id(), rays)?;
        progress.advance(0)?;
        if rays.is_empty() {
            return Ok(Report::default());
        }
        let mut work = Work::default();
        for (index, hit) in self.subdivide(view, progress)?.hits.into_iter().enumerate() {
            hits.set(index, hit);
            work += hit.work;
        }
        work += normals::fill(&self.implicit.tape, self.method.normals, rays, hits);
        Ok(Report { work, device_time: None })
    }
}
