//! Work sharing: rays in tiles, tiles over threads.

use rayon::prelude::*;
use zeroset_raycast::{Certificate, Error, Hit, Hits, Progress, Ray, Rays, Report, Work};

/// Pixels along a tile's side.
const SIDE: usize = 32;
/// Rays in a tile of a batch.
const CHUNK: usize = SIDE * SIDE;
/// Pixels of a packet's block within a tile: neighbours stay together.
const BLOCK: [usize; 2] = [8, 4];

/// Answers all rays, a tile at a time, in parallel. `run` gets the valid rays of a tile, in blocks
/// of 8 by 4 pixels for a view, and gives one answer for each.
pub(crate) fn cast(
    rays: Rays<'_>,
    hits: &mut Hits,
    progress: &Progress,
    run: impl Fn(&[Ray]) -> Vec<Hit> + Sync,
) -> Result<Report, Error> {
    assert_eq!(rays.len(), hits.len(), "one answer a ray");
    let tiles = tiles(rays);
    // A bounded number of tiles at a time, so that answers do not pile up.
    for group in tiles.chunks(4 * rayon::current_num_threads().max(1)) {
        let answers: Vec<Vec<(usize, Hit)>> =
            group.par_iter().map(|tile| answer(rays, &tile.indices(rays), &run)).collect();
        for (index, hit) in answers.iter().flatten() {
            hits.set(*index, *hit);
        }
        progress.advance(answers.iter().map(Vec::len).sum())?;
    }
    Ok(Report { work: hits.total_work(), device_time: None })
}

/// The answers of one tile; rays that are no rays are counted and missed.
fn answer(
    rays: Rays<'_>,
    indices: &[usize],
    run: &impl Fn(&[Ray]) -> Vec<Hit>,
) -> Vec<(usize, Hit)> {
    let all: Vec<_> = indices.iter().map(|&i| (i, rays.get(i))).collect();
    let valid: Vec<Ray> = all.iter().map(|(_, r)| *r).filter(|r| r.is_valid()).collect();
    let mut answers = run(&valid).into_iter();
    let no_ray = Work { nonfinite: 1, ..Work::default() };
    all.into_iter()
        .map(|(i, ray)| {
            let hit = if ray.is_valid() { answers.next() } else { None };
            (i, hit.unwrap_or_else(|| Hit::miss(Certificate::MISS, no_ray)))
        })
        .collect()
}

/// A tile of a view by its corner, or a range of a batch.
enum Tile {
    Pixels { column: usize, row: usize },
    Range { start: usize, end: usize },
}

fn tiles(rays: Rays<'_>) -> Vec<Tile> {
    match rays {
        Rays::View(view) => (0..view.height)
            .step_by(SIDE)
            .flat_map(|row| {
                (0..view.width).step_by(SIDE).map(move |column| Tile::Pixels { column, row })
            })
            .collect(),
        Rays::Batch(batch) => (0..batch.rays.len())
            .step_by(CHUNK)
            .map(|start| Tile::Range { start, end: (start + CHUNK).min(batch.rays.len()) })
            .collect(),
    }
}

impl Tile {
    fn indices(&self, rays: Rays<'_>) -> Vec<usize> {
        match (self, rays) {
            (&Self::Range { start, end }, _) => (start..end).collect(),
            (&Self::Pixels { column, row }, Rays::View(view)) => {
                let columns = column..(column + SIDE).min(view.width);
                let rows = row..(row + SIDE).min(view.height);
                let mut indices = Vec::with_capacity(CHUNK);
                for block_row in rows.clone().step_by(BLOCK[1]) {
                    for block_column in columns.clone().step_by(BLOCK[0]) {
                        for y in block_row..(block_row + BLOCK[1]).min(rows.end) {
                            for x in block_column..(block_column + BLOCK[0]).min(columns.end) {
                                indices.push(y * view.width + x);
                            }
                        }
                    }
                }
                indices
            }
            (Self::Pixels { .. }, Rays::Batch(_)) => unreachable!("batches have ranges"),
        }
    }
}
