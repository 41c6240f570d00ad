//! Normals of points that have none.

use std::collections::BinaryHeap;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::neighbours::Neighbours;

/// Points that make the plane of a normal.
const NEIGHBOURS: usize = 12;

/// The normals of the planes that fit the neighbours of each point best, turned alike along a tree that joins
/// neighbours whose normals differ least, and outward at the point that is farthest along one of them.
pub(super) fn normals(points: &[DVec3]) -> Vec<DVec3> {
    let tree = Neighbours::new(points);
    let near: Vec<Vec<usize>> =
        points.par_iter().map(|p| tree.nearest(*p, NEIGHBOURS).collect()).collect();
    let mut normals: Vec<DVec3> = near.par_iter().map(|near| normal(points, near)).collect();
    turn(points, &near, &mut normals);
    normals
}

fn normal(points: &[DVec3], near: &[usize]) -> DVec3 {
    let mean = near.iter().map(|&i| points[i]).sum::<DVec3>() / near.len() as f64;
    let mut moments = DMat3::ZERO;
    for &i in near {
        let d = points[i] - mean;
        moments += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
    }
    least_axis(moments)
}

/// The axis along which a symmetric matrix is least, by Jacobi's rotations.
fn least_axis(mut m: DMat3) -> DVec3 {
    let mut axes = DMat3::IDENTITY;
    for _ in 0..12 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = m.col(q)[p];
            if off == 0.0 {
                continue;
            }
            let theta = 0.5 * (m.col(q)[q] - m.col(p)[p]) / off;
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let c = 1.0 / t.hypot(1.0);
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(p)[p] = c;
            turn.col_mut(q)[q] = c;
            turn.col_mut(q)[p] = t * c;
            turn.col_mut(p)[q] = -t * c;
            m = turn.transpose() * m * turn;
            axes *= turn;
        }
    }
    let size = [0, 1, 2].map(|i| m.col(i)[i]);
    let least = (0..3).min_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(2);
    axes.col(least).normalize_or(DVec3::Z)
}

/// A join of a point that is turned to one that is not; the surest first.
#[derive(PartialEq)]
struct Join {
    likeness: f64,
    from: usize,
    to: usize,
}

impl Eq for Join {}

impl PartialOrd for Join {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Join {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let by_place = (other.from, other.to).cmp(&(self.from, self.to));
        self.likeness.total_cmp(&other.likeness).then(by_place)
    }
}

fn turn(points: &[DVec3], near: &[Vec<usize>], normals: &mut [DVec3]) {
    // Neighbours of a point know it, too.
    let mut joined = near.to_vec();
    for (i, near) in near.iter().enumerate() {
        near.iter().for_each(|&k| joined[k].push(i));
    }
    let mean = points.iter().sum::<DVec3>() / points.len() as f64;
    let away = |i: usize| (points[i] - mean).length_squared();
    let mut order: Vec<usize> = (0..points.len()).collect();
    // Of each connected part the point farthest from the middle comes first, where out is away.
    order.sort_by(|a, b| away(*b).total_cmp(&away(*a)));
    let mut is_turned = vec![false; points.len()];
    for first in order {
        if is_turned[first] {
            continue;
        }
        if normals[first].dot(points[first] - mean) < 0.0 {
            normals[first] = -normals[first];
        }
        let mut joins = BinaryHeap::from([Join { likeness: 1.0, from: first, to: first }]);
        while let Some(Join { from, to, .. }) = joins.pop() {
            if is_turned[to] {
                continue;
            }
            is_turned[to] = true;
            if normals[from].dot(normals[to]) < 0.0 {
                normals[to] = -normals[to];
            }
            for &next in joined[to].iter().filter(|next| !is_turned[**next]) {
                let likeness = normals[to].dot(normals[next]).abs();
                joins.push(Join { likeness, from: to, to: next });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_of_a_torus_point_out() {
        let (mut points, mut expected) = (Vec::new(), Vec::new());
        for i in 0..60 {
            for k in 0..30 {
                let (su, cu) = (f64::from(i) * std::f64::consts::TAU / 60.0).sin_cos();
                let (sv, cv) = (f64::from(k) * std::f64::consts::TAU / 30.0).sin_cos();
                let normal = DVec3::new(cu * cv, su * cv, sv);
                points.push(2.0 * DVec3::new(cu, su, 0.0) + 0.7 * normal);
                expected.push(normal);
            }
        }
        for (n, e) in normals(&points).iter().zip(&expected) {
            assert!(n.dot(*e) > 0.98, "{n} {e}");
        }
    }

    #[test]
    fn flat_points_have_normals_too() {
        let points: Vec<DVec3> = (0..40).map(|i| DVec3::new(f64::from(i), 0.0, 0.0)).collect();
        assert!(normals(&points).iter().all(|n| n.is_normalized() && n.x.abs() < 1e-9));
        let same = vec![DVec3::ONE; 20];
        assert!(normals(&same).iter().all(|n| n.is_normalized()));
    }
}
