//! Domains found from functions.

use glam::DVec3;
use zeroset_expr::{Evaluator, Function, Parameters, Tape};
use zeroset_ia::{Interval, Set};

use crate::Domain;

/// An enclosure of f.
type Enclosure = Interval<f64, Set>;

/// Half sides of the cubes that are tried.
const HALF_SIDES: [f64; 6] = [2.0, 4.0, 8.0, 16.0, 32.0, 64.0];
/// How often a cube is halved, at most.
const HALVINGS: u32 = 6;
/// Operations that a cube may cost, about.
const OPERATIONS: usize = 1 << 20;
/// Points along the side of a face that are tried.
const SAMPLES: u32 = 9;

/// What is known of the surface in a cube.
enum Content {
    /// There is nothing.
    Nothing,
    /// All of it is between two corners, inside.
    Within(DVec3, DVec3),
    /// It meets the faces, or may.
    Cut,
}

/// A box for a surface whose domain nobody gave.
///
/// Of the cubes [-2, 2]^3, [-4, 4]^3 .. [-64, 64]^3, the first whose faces the surface is proven to
/// stay off and in which there may be some of it, shrunk to what interval subdivision leaves of it
/// with a margin of 1/32 of the half side. If the surface meets the faces of each: the first cube
/// that is not proven to be empty. If there is none, or a parameter is wrong: [-2, 2]^3.
///
/// The same function gives the same box. Cost: some milliseconds.
pub fn find(function: &Function, parameters: &Parameters) -> Domain {
    let standard = cube(HALF_SIDES[0]);
    let Ok(tape) = function.tape(parameters, 128) else {
        return standard;
    };
    let cost = tape.instructions().len().max(1);
    if 8 * cost > OPERATIONS {
        return standard;
    }
    let mut fallback = None;
    for half in HALF_SIDES {
        match content(&tape, half, OPERATIONS / cost) {
            Content::Nothing => {}
            Content::Cut => fallback = fallback.or(Some(cube(half))),
            Content::Within(min, max) => {
                let margin = DVec3::splat(half / 32.0);
                return Domain { min: min - margin, max: max + margin, ball: None };
            }
        }
    }
    fallback.unwrap_or(standard)
}

fn cube(half: f64) -> Domain {
    Domain { min: DVec3::splat(-half), max: DVec3::splat(half), ball: None }
}

fn content(tape: &Tape, half: f64, evaluations: usize) -> Content {
    let mut f = tape.evaluator(&Enclosure::point(0.0));
    if crosses_faces(&mut f, half) {
        return Content::Cut;
    }
    // Cells by their place on a grid of 2^level cells a side.
    let mut cells = vec![[0_u32; 3]];
    let mut level = 0;
    let mut left = evaluations;
    while level < HALVINGS && !cells.is_empty() && 8 * cells.len() <= left {
        level += 1;
        left -= 8 * cells.len();
        let side = 2.0 * half / f64::from(1_u32 << level);
        let range = |i: u32| {
            let lo = f64::from(i) * side - half;
            Enclosure::new(lo, lo + side)
        };
        let mut kept = Vec::new();
        for cell in &cells {
            for part in 0..8_u32 {
                let part: [u32; 3] =
                    std::array::from_fn(|axis| 2 * cell[axis] + (part >> axis & 1));
                if f.evaluate(part.map(range)).contains_zero() {
                    kept.push(part);
                }
            }
        }
        cells = kept;
    }
    if cells.is_empty() {
        return Content::Nothing;
    }
    let count = 1_u32 << level;
    let first: [u32; 3] = std::array::from_fn(|i| cells.iter().map(|c| c[i]).min().unwrap_or(0));
    let last: [u32; 3] = std::array::from_fn(|i| cells.iter().map(|c| c[i]).max().unwrap_or(0));
    if first.contains(&0) || last.contains(&(count - 1)) {
        return Content::Cut;
    }
    let side = 2.0 * half / f64::from(count);
    let corner = |i: u32| f64::from(i) * side - half;
    Content::Within(
        DVec3::from_array(first.map(corner)),
        DVec3::from_array(last.map(|i| corner(i + 1))),
    )
}

/// Does f take both signs on a grid of points on the faces?
fn crosses_faces(f: &mut Evaluator<'_, Enclosure>, half: f64) -> bool {
    let at = |i: u32| 2.0 * half * f64::from(i) / f64::from(SAMPLES - 1) - half;
    let (mut negative, mut positive) = (false, false);
    for axis in 0..3 {
        for end in [-half, half] {
            for i in 0..SAMPLES * SAMPLES {
                let mut point = [end; 3];
                point[(axis + 1) % 3] = at(i / SAMPLES);
                point[(axis + 2) % 3] = at(i % SAMPLES);
                let value = f.evaluate(point.map(Enclosure::point));
                negative |= value.hi < 0.0;
                positive |= value.lo > 0.0;
                if negative && positive {
                    return true;
                }
            }
        }
    }
    false
}
