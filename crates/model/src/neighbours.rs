//! Which points are near.

use glam::DVec3;
use rstar::RTree;
use rstar::primitives::GeomWithData;

/// Points by their place.
pub(crate) struct Neighbours(RTree<GeomWithData<[f64; 3], u32>>);

impl Neighbours {
    /// Of these points, each known by its index.
    pub(crate) fn new(points: &[DVec3]) -> Self {
        let indexed = points.iter().zip(0..).map(|(p, i)| GeomWithData::new(p.to_array(), i));
        Self(RTree::bulk_load(indexed.collect()))
    }

    /// The distance of the n-th nearest from a place, or of the farthest if there are not so many.
    pub(crate) fn distance(&self, place: DVec3, n: usize) -> f64 {
        let place = place.to_array();
        let square = self.0.nearest_neighbor_iter_with_distance_2(&place).take(n).last();
        square.map_or(0.0, |(_, square)| square.sqrt())
    }

    /// The n nearest to a place.
    pub(crate) fn nearest(&self, place: DVec3, n: usize) -> impl Iterator<Item = usize> {
        self.0.nearest_neighbor_iter(&place.to_array()).take(n).map(|p| p.data as usize)
    }

    /// Those within a distance of a place.
    pub(crate) fn within(&self, place: DVec3, distance: f64) -> impl Iterator<Item = usize> {
        let found = self.0.locate_within_distance(place.to_array(), distance * distance);
        found.map(|p| p.data as usize)
    }
}
