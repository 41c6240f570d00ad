//! Work sharing: rays in tiles, tiles over threads.

use std::borrow::Cow;
use std::sync::{Mutex, PoisonError};

use glam::Vec3;
use rayon::prelude::*;
use zeroset_ia::widest;
use zeroset_raycast::{
    Certificate, Error, Hit, Hits, Progress, Ray, RayBatch, Rays, Report, View, Work,
};

/// Pixels along a tile's side.
const SIDE: usize = 32;
/// Rays in a tile of a batch.
const CHUNK: usize = SIDE * SIDE;
/// Pixels of a packet's block within a tile: neighbours stay together.
const BLOCK: [usize; 2] = [8, 4];

/// Column and row of the i-th pixel of a block, along a Z: the bits of i are those of x, y, x, y, x. Then
/// 4 pixels are a block of 2 by 2, 8 of 4 by 2, and 16 of 4 by 4.
#[inline(always)]
fn place(i: usize) -> (usize, usize) {
    (i & 1 | i >> 1 & 2 | i >> 2 & 4, i >> 1 & 1 | i >> 2 & 2)
}

/// What is found out about a ray: a hit, alone or with its normal.
pub trait Answer: Send {
    /// The answer for a ray that is none.
    fn of_no_ray(miss: Hit) -> Self;
    /// The hit.
    fn hit(&self) -> Hit;
    /// The normal there, unless others fill it in.
    fn normal(&self) -> Option<Vec3> {
        None
    }
}

impl Answer for Hit {
    fn of_no_ray(miss: Hit) -> Self {
        miss
    }
    fn hit(&self) -> Hit {
        *self
    }
}

impl Answer for (Hit, Vec3) {
    fn of_no_ray(miss: Hit) -> Self {
        (miss, Vec3::ZERO)
    }
    fn hit(&self) -> Hit {
        self.0
    }
    fn normal(&self) -> Option<Vec3> {
        Some(self.1)
    }
}

/// Answers all rays, a tile at a time, in parallel. `run` gets the valid rays of a tile, in blocks
/// of 8 by 4 pixels for a view, and gives one answer for each.
///
/// # Errors
/// If the work was asked to stop.
///
/// # Panics
/// If `hits` has not as many entries as there are rays.
pub fn cast<A: Answer>(
    rays: Rays<'_>,
    hits: &mut Hits,
    progress: &Progress,
    run: impl Fn(&[Ray]) -> Vec<A> + Sync,
) -> Result<Report, Error> {
    assert_eq!(rays.len(), hits.len(), "one answer a ray");
    let collected = Mutex::new((hits, Work::default()));
    tiles(rays).into_par_iter().try_for_each(|tile| {
        let answers = Answers::of(tile, &run);
        answers.store(&mut collected.lock().unwrap_or_else(PoisonError::into_inner));
        progress.advance(answers.indices.len())
    })?;
    let (_, work) = collected.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok(Report { work, device_time: None })
}

/// The answers of a tile, and the indices of their rays.
struct Answers<A> {
    indices: Vec<usize>,
    answers: Vec<A>,
}

impl<A: Answer> Answers<A> {
    /// Rays that are no rays are counted and missed.
    fn of(tile: Tile<'_>, run: &impl Fn(&[Ray]) -> Vec<A>) -> Self {
        let (mut indices, mut rays) = tile.rays();
        let mut invalid = Vec::new();
        if !are_valid(&rays) {
            let all = indices.into_iter().zip(rays.iter().copied());
            let (valid, others): (Vec<_>, Vec<_>) = all.partition(|(_, ray)| ray.is_valid());
            let (places, lines) = valid.into_iter().unzip();
            (indices, rays) = (places, Cow::Owned(lines));
            invalid = others.into_iter().map(|(index, _)| index).collect();
        }
        let mut answers = run(&rays);
        assert_eq!(answers.len(), rays.len(), "one answer a ray");
        let no_ray = Hit::miss(Certificate::MISS, Work { nonfinite: 1, ..Work::default() });
        answers.extend(invalid.iter().map(|_| A::of_no_ray(no_ray)));
        indices.extend(invalid);
        Self { indices, answers }
    }

    /// Puts them where they belong, and adds up their work.
    fn store(&self, (hits, work): &mut (&mut Hits, Work)) {
        for (index, answer) in self.indices.iter().zip(&self.answers) {
            let hit = answer.hit();
            hits.set(*index, hit);
            *work += hit.work;
            if let (Some(place), Some(normal)) = (hits.normal.get_mut(*index), answer.normal()) {
                *place = normal;
            }
        }
    }
}

/// A tile of a view by its corner, or a range of a batch.
#[derive(Clone, Copy)]
pub struct Tile<'a>(Part<'a>);

#[derive(Clone, Copy)]
enum Part<'a> {
    Pixels { view: &'a View, column: usize, row: usize },
    Range { batch: &'a RayBatch, start: usize, end: usize },
}

/// All rays in tiles of at most 1024.
pub fn tiles(rays: Rays<'_>) -> Vec<Tile<'_>> {
    match rays {
        Rays::View(view) => (0..view.height)
            .step_by(SIDE)
            .flat_map(|row| {
                (0..view.width)
                    .step_by(SIDE)
                    .map(move |column| Tile(Part::Pixels { view, column, row }))
            })
            .collect(),
        Rays::Batch(batch) => (0..batch.rays.len())
            .step_by(CHUNK)
            .map(|start| {
                let end = (start + CHUNK).min(batch.rays.len());
                Tile(Part::Range { batch, start, end })
            })
            .collect(),
    }
}

impl<'a> Tile<'a> {
    /// The indices of its rays and the rays, neighbours together.
    pub fn rays(self) -> (Vec<usize>, Cow<'a, [Ray]>) {
        match self.0 {
            Part::Range { batch, start, end } => {
                ((start..end).collect(), Cow::Borrowed(&batch.rays[start..end]))
            }
            Part::Pixels { view, column, row } => widest(
                #[inline(always)]
                || pixels(view, column, row),
            ),
        }
    }
}

/// The rays of a tile's pixels, block by block.
#[inline(always)]
fn pixels(view: &View, column: usize, row: usize) -> (Vec<usize>, Cow<'static, [Ray]>) {
    let (mut indices, mut rays) = (Vec::with_capacity(CHUNK), Vec::with_capacity(CHUNK));
    let columns = column..(column + SIDE).min(view.width);
    let rows = row..(row + SIDE).min(view.height);
    for block_row in rows.clone().step_by(BLOCK[1]) {
        for block_column in columns.clone().step_by(BLOCK[0]) {
            for i in 0..BLOCK[0] * BLOCK[1] {
                let (x, y) = (block_column + place(i).0, block_row + place(i).1);
                if x < columns.end && y < rows.end {
                    indices.push(y * view.width + x);
                    rays.push(view.ray(x, y));
                }
            }
        }
    }
    (indices, Cow::Owned(rays))
}

/// Are all of them rays?
fn are_valid(rays: &[Ray]) -> bool {
    widest(
        #[inline(always)]
        || {
            rays.iter().fold(
                true,
                #[inline(always)]
                |valid, ray| valid & ray.is_valid(),
            )
        },
    )
}
