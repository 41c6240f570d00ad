//! Normals of points that have none.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::axes::least_axis;
use crate::neighbours::Neighbours;

/// Neighbours whose plane gives a normal, the point itself among them.
const PLANE: usize = 16;
/// Neighbours to which a side is handed on.
const GRAPH: usize = 9;

/// Normals by the planes of nearest neighbours, all of a component on one side: the side is handed on along
/// the spanning tree of least 1 - |n n'|. The point of a component that is furthest from its mean looks
/// outwards.
pub(super) fn estimated(points: &[DVec3]) -> Vec<DVec3> {
    let tree = Neighbours::new(points);
    let near = |i: usize, k: usize| tree.nearest(points[i], k).map(|n| n.index);
    let plane = |i: usize| {
        let all: Vec<DVec3> = near(i, PLANE).map(|j| points[j as usize] - points[i]).collect();
        let mean = all.iter().sum::<DVec3>() / all.len() as f64;
        let square = |x: DVec3| DMat3::from_cols(x * x.x, x * x.y, x * x.z);
        least_axis(all.iter().fold(DMat3::ZERO, |sum, &x| sum + square(x - mean)))
    };
    let mut normals: Vec<DVec3> = (0..points.len()).into_par_iter().map(plane).collect();

    let mut edges: Vec<(f32, u32, u32)> = (0..points.len())
        .into_par_iter()
        .flat_map_iter(|i| {
            let ends = near(i, GRAPH).filter(move |&j| j as usize != i).collect::<Vec<_>>();
            let weight = |j: u32| 1.0 - normals[i].dot(normals[j as usize]).abs() as f32;
            let edge = move |j: u32| (weight(j), (i as u32).min(j), (i as u32).max(j));
            ends.into_iter().map(edge).collect::<Vec<_>>()
        })
        .collect();
    edges.par_sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));

    let mut sides = Sides::new(points.len());
    for (_, i, j) in edges {
        let same = normals[i as usize].dot(normals[j as usize]) >= 0.0;
        sides.join(i, j, same);
    }
    let found: Vec<(u32, bool)> = (0..points.len() as u32).map(|i| sides.find(i)).collect();
    for (normal, &(_, same)) in normals.iter_mut().zip(&found) {
        *normal = if same { *normal } else { -*normal };
    }
    turn_outwards(points, &found, &mut normals);
    normals
}

/// Turns each component so that its point furthest from its mean looks away from there.
fn turn_outwards(points: &[DVec3], found: &[(u32, bool)], normals: &mut [DVec3]) {
    let mut means = vec![(DVec3::ZERO, 0.0); points.len()];
    for (p, (root, _)) in points.iter().zip(found) {
        let (sum, count) = &mut means[*root as usize];
        *sum += p;
        *count += 1.0;
    }
    let out = |i: usize| {
        let (sum, count) = means[found[i].0 as usize];
        points[i] - sum / count
    };
    let mut furthest: Vec<Option<usize>> = vec![None; points.len()];
    for (i, (root, _)) in found.iter().enumerate() {
        let best = &mut furthest[*root as usize];
        if best.is_none_or(|j| out(i).length_squared() > out(j).length_squared()) {
            *best = Some(i);
        }
    }
    let inwards: Vec<bool> =
        (furthest.iter()).map(|best| best.is_some_and(|i| normals[i].dot(out(i)) < 0.0)).collect();
    for (normal, (root, _)) in normals.iter_mut().zip(found) {
        if inwards[*root as usize] {
            *normal = -*normal;
        }
    }
}

/// Disjoint sets in which each member is on the same side as its root, or on the other.
struct Sides {
    parents: Vec<(u32, bool)>,
    sizes: Vec<u32>,
}

impl Sides {
    fn new(count: usize) -> Self {
        let parents = (0..count as u32).map(|i| (i, true)).collect();
        Self { parents, sizes: vec![1; count] }
    }

    /// The root, and whether i is on its side. Sets are joined by size, so that paths are short.
    fn find(&self, mut i: u32) -> (u32, bool) {
        let mut same = true;
        loop {
            let (parent, here) = self.parents[i as usize];
            if parent == i {
                return (i, same);
            }
            same = same == here;
            i = parent;
        }
    }

    fn join(&mut self, i: u32, j: u32, same: bool) {
        let [(a, i_same), (b, j_same)] = [self.find(i), self.find(j)];
        if a == b {
            return;
        }
        let [small, large] =
            if self.sizes[a as usize] < self.sizes[b as usize] { [a, b] } else { [b, a] };
        self.sizes[large as usize] += self.sizes[small as usize];
        self.parents[small as usize] = (large, same == (i_same == j_same));
    }
}
