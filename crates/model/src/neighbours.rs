//! Neighbours of a place among points.

use glam::DVec3;
use rstar::RTree;
use rstar::primitives::GeomWithData;

/// Points in a tree. It holds any finite points: coincident ones, and ones equal in a coordinate, too.
#[derive(Debug)]
pub(crate) struct Neighbours(RTree<GeomWithData<[f64; 3], u32>>);

/// A point near a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Neighbour {
    /// Which point.
    pub(crate) index: u32,
    /// The square of its distance.
    pub(crate) square: f64,
}

impl Neighbours {
    /// A tree of finite points, fewer than 2^32.
    pub(crate) fn new(points: &[DVec3]) -> Self {
        let leaf = |(i, p): (usize, &DVec3)| GeomWithData::new(p.to_array(), i as u32);
        Self(RTree::bulk_load(points.iter().enumerate().map(leaf).collect()))
    }

    /// Sets `found` to the points no further than `radius`, in an order that is the tree's own.
    pub(crate) fn within(&self, place: DVec3, radius: f64, found: &mut Vec<Neighbour>) {
        found.clear();
        let near = self.0.locate_within_distance(place.to_array(), radius * radius);
        found.extend(near.map(|leaf| Neighbour {
            index: leaf.data,
            square: (DVec3::from(*leaf.geom()) - place).length_squared(),
        }));
    }

    /// The `k` nearest points, nearest first, or all of them if there are fewer.
    pub(crate) fn nearest(&self, place: DVec3, k: usize) -> impl Iterator<Item = Neighbour> {
        let near = self.0.nearest_neighbor_iter_with_distance_2(place.to_array());
        near.take(k).map(|(leaf, square)| Neighbour { index: leaf.data, square })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a grid, each thrice, with whole planes equal in a coordinate.
    fn grid() -> Vec<DVec3> {
        let cells = (0..5000).map(|i| i % 1667);
        cells.map(|i| DVec3::new(f64::from(i % 40), f64::from(i / 40), 0.0)).collect()
    }

    #[test]
    fn neighbours_are_those_of_a_search_through_all() {
        let points = grid();
        let tree = Neighbours::new(&points);
        let mut found = Vec::new();
        for place in [DVec3::ZERO, DVec3::new(20.0, 20.5, 0.25), DVec3::new(-3.0, 50.0, 1.0)] {
            let square = |p: &DVec3| (p - place).length_squared();
            tree.within(place, 12.5, &mut found);
            let expected = points.iter().filter(|p| square(p) <= 12.5 * 12.5).count();
            assert_eq!(found.len(), expected, "{place}");
            assert!(found.iter().all(|n| square(&points[n.index as usize]) == n.square));
            let mut squares: Vec<f64> = points.iter().map(square).collect();
            squares.sort_by(f64::total_cmp);
            let nearest: Vec<f64> = tree.nearest(place, 100).map(|n| n.square).collect();
            assert_eq!(nearest, squares[..100], "{place}");
        }
    }

    #[test]
    fn coincident_points_are_all_found() {
        let tree = Neighbours::new(&[DVec3::ONE; 300]);
        assert_eq!(tree.nearest(DVec3::ZERO, 1000).count(), 300);
        let mut found = Vec::new();
        tree.within(DVec3::ONE, 0.0, &mut found);
        assert_eq!(found.len(), 300);
    }
}
