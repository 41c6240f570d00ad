//! The points that a fit sees.

use glam::DVec3;

use zeroset_raycast::patches::weight;

use crate::neighbours::{Neighbour, Neighbours};
use crate::points::Cloud;

/// Points about the middle of their box, in units of its diagonal, with their neighbours. Every length below
/// is in this unit, so that a surface and the same surface enlarged are fitted alike.
#[derive(Debug)]
pub(super) struct Samples {
    pub(super) points: Vec<DVec3>,
    pub(super) normals: Vec<DVec3>,
    pub(super) tree: Neighbours,
    /// The unit, in that of the cloud.
    pub(super) unit: f64,
}

/// A point in a ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// The place about the ball's centre, in radii.
    pub(super) x: DVec3,
    /// The normal.
    pub(super) n: DVec3,
    /// The weight.
    pub(super) w: f64,
}

impl Samples {
    pub(super) fn new(cloud: &Cloud) -> Self {
        let [least, most] = cloud.corners();
        let unit = (most - least).length();
        let middle = 0.5 * (least + most);
        let points: Vec<DVec3> = cloud.points.iter().map(|p| (p - middle) / unit).collect();
        let tree = Neighbours::new(&points);
        Self { points, normals: cloud.normals.clone(), tree, unit }
    }

    /// Sets `samples` to what lies in a ball about a point.
    pub(super) fn within(
        &self,
        centre: u32,
        radius: f64,
        found: &mut Vec<Neighbour>,
        samples: &mut Vec<Sample>,
    ) {
        let c = self.points[centre as usize];
        self.tree.within(c, radius, found);
        samples.clear();
        samples.extend(found.iter().map(|near| {
            let i = near.index as usize;
            let w = weight(near.square.sqrt() / radius);
            Sample { x: (self.points[i] - c) / radius, n: self.normals[i], w }
        }));
    }
}
