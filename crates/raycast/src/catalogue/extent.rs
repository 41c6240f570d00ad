//! Domains found from functions.

use glam::DVec3;
use zeroset_expr::{Evaluator, Function, Instruction, Op, Parameters, Tape};
use zeroset_ia::{Interval, Set};

use crate::Domain;

/// An enclosure of f.
type Enclosure = Interval<f64, Set>;

/// Half sides of the cubes that are tried.
const HALF_SIDES: [f64; 6] = [2.0, 4.0, 8.0, 16.0, 32.0, 64.0];
/// How often a box or a face is halved, at most.
const HALVINGS: u32 = 6;
/// How often the box that is left is divided anew.
const ROUNDS: usize = 3;
/// Operations that a division may cost, about.
const OPERATIONS: usize = 1 << 20;
/// What a function of one or two arguments costs, in operations.
const FUNCTION: usize = 8;
/// Points along the side of a face that are tried.
const SAMPLES: u32 = 9;

/// A box for a surface whose domain nobody gave.
///
/// Of the cubes [-2, 2]^3, [-4, 4]^3 .. [-64, 64]^3, the first whose faces the surface is proven to
/// stay off and in which there may be some of it, shrunk to what interval subdivision leaves of it
/// with a margin of 1/64 of its longest side. If no cube is proven to be so: the first that is not
/// proven to be empty. If there is none, or a parameter is wrong: [-2, 2]^3.
///
/// The same function gives the same box. Cost: some milliseconds.
pub fn find(function: &Function, parameters: &Parameters) -> Domain {
    let standard = cube(HALF_SIDES[0]);
    let Ok(tape) = function.tape(parameters, 128) else {
        return standard;
    };
    let evaluations = OPERATIONS / cost(&tape);
    let samples = 6 * SAMPLES * SAMPLES;
    if evaluations < samples as usize {
        return standard;
    }
    let mut f = tape.evaluator(&Enclosure::point(0.0));
    let mut first = None;
    for tried in HALF_SIDES.map(cube) {
        if crosses_faces(&mut f, &tried) {
            first = first.or(Some(tried));
            continue;
        }
        let Some(mut part) = shrink(&mut f, &tried, evaluations) else {
            continue;
        };
        if misses_faces(&mut f, &tried, evaluations) {
            for _ in 1..ROUNDS {
                part = shrink(&mut f, &part, evaluations).unwrap_or(part);
            }
            let margin = DVec3::splat(part.longest_side() / 64.0);
            let (min, max) = (part.min - margin, part.max + margin);
            return Domain { min: min.max(tried.min), max: max.min(tried.max), ball: None };
        }
        first = first.or(Some(tried));
    }
    first.unwrap_or(standard)
}

/// Operations of an evaluation, about.
fn cost(tape: &Tape) -> usize {
    let cost = |i: &Instruction| match i.op {
        Op::Unary(..) | Op::Binary(..) | Op::Powc(..) => FUNCTION,
        _ => 1,
    };
    tape.instructions().iter().map(cost).sum::<usize>().max(1)
}

fn cube(half: f64) -> Domain {
    Domain { min: DVec3::splat(-half), max: DVec3::splat(half), ball: None }
}

/// The box around all cells of a grid in the domain that may hold some of the surface; `None` if
/// there is none.
fn shrink(f: &mut Evaluator<'_, Enclosure>, domain: &Domain, evaluations: usize) -> Option<Domain> {
    // Cells by their place on a grid of 2^level cells a side.
    let mut cells = vec![[0_u32; 3]];
    let mut level = 0;
    let mut left = evaluations;
    let edge = |level: u32, axis: usize, i: u32| {
        let side = (domain.max[axis] - domain.min[axis]) / f64::from(1_u32 << level);
        domain.min[axis] + f64::from(i) * side
    };
    while level < HALVINGS && !cells.is_empty() && 8 * cells.len() <= left {
        level += 1;
        left -= 8 * cells.len();
        let mut kept = Vec::new();
        for cell in &cells {
            for part in 0..8_u32 {
                let part: [u32; 3] =
                    std::array::from_fn(|axis| 2 * cell[axis] + (part >> axis & 1));
                let range = |axis| {
                    let i = part[axis];
                    Enclosure::new(edge(level, axis, i), edge(level, axis, i + 1))
                };
                if f.evaluate(std::array::from_fn(range)).contains_zero() {
                    kept.push(part);
                }
            }
        }
        cells = kept;
    }
    let corner = |i: u32, pick: fn(u32, u32) -> u32| {
        let corner = |axis| {
            let place = cells.iter().map(|cell: &[u32; 3]| cell[axis]).reduce(pick)?;
            Some(edge(level, axis, place + i))
        };
        Some(DVec3::new(corner(0)?, corner(1)?, corner(2)?))
    };
    Some(Domain { min: corner(0, u32::min)?, max: corner(1, u32::max)?, ball: None })
}

/// Is it proven that f has no zero on the faces?
fn misses_faces(f: &mut Evaluator<'_, Enclosure>, cube: &Domain, evaluations: usize) -> bool {
    let (min, side) = (cube.min.x, cube.longest_side());
    let edge = |level: u32, i: u32| min + side * f64::from(i) / f64::from(1_u32 << level);
    let mut left = evaluations;
    // Squares by their face and their place on a grid of 2^level squares a side.
    let mut squares: Vec<(usize, f64, [u32; 2])> =
        (0..3).flat_map(|axis| [min, min + side].map(|end| (axis, end, [0; 2]))).collect();
    for level in 1..=HALVINGS {
        if 4 * squares.len() > left {
            return false;
        }
        left -= 4 * squares.len();
        let mut kept = Vec::new();
        for &(axis, end, [u, v]) in &squares {
            for [u, v] in [[0, 0], [0, 1], [1, 0], [1, 1]].map(|[i, j]| [2 * u + i, 2 * v + j]) {
                let range = |i| Enclosure::new(edge(level, i), edge(level, i + 1));
                let mut part = [Enclosure::point(end); 3];
                part[(axis + 1) % 3] = range(u);
                part[(axis + 2) % 3] = range(v);
                if f.evaluate(part).contains_zero() {
                    kept.push((axis, end, [u, v]));
                }
            }
        }
        if kept.is_empty() {
            return true;
        }
        squares = kept;
    }
    false
}

/// Does f take both signs on a grid of points on the faces?
fn crosses_faces(f: &mut Evaluator<'_, Enclosure>, cube: &Domain) -> bool {
    let (min, side) = (cube.min.x, cube.longest_side());
    let at = |i: u32| min + side * f64::from(i) / f64::from(SAMPLES - 1);
    let (mut negative, mut positive) = (false, false);
    for axis in 0..3 {
        for end in [min, min + side] {
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
