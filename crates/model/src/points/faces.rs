//! Polygons between points.

use glam::DVec3;

/// Polygons, one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Faces {
    corners: Vec<u32>,
    ends: Vec<usize>,
}

impl Faces {
    pub(super) fn add_corner(&mut self, corner: u32) {
        self.corners.push(corner);
    }

    /// Ends the polygon that corners were added to.
    pub(super) fn close(&mut self) {
        self.ends.push(self.corners.len());
    }

    pub(super) fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// The corners of all polygons.
    pub(super) fn corners(&self) -> &[u32] {
        &self.corners
    }

    fn all(&self) -> impl Iterator<Item = &[u32]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.corners[start..end])
    }

    /// For each point the sum of its polygons' vector areas, doubled: sum of (p_i - p_0) x (p_i+1 - p_0).
    /// Polygons that are not finite count for nothing.
    pub(super) fn normals(&self, points: &[DVec3]) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; points.len()];
        for face in self.all() {
            let Some(&first) = face.first() else { continue };
            let side = |i: u32| points[i as usize] - points[first as usize];
            let area: DVec3 = face.windows(2).map(|ends| side(ends[0]).cross(side(ends[1]))).sum();
            if area.is_finite() {
                for &corner in face {
                    sums[corner as usize] += area;
                }
            }
        }
        sums
    }

    /// The same polygons between other names of the points.
    pub(super) fn renamed(mut self, names: &[u32]) -> Self {
        for corner in &mut self.corners {
            *corner = names[*corner as usize];
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_weighted_by_area() {
        let mut faces = Faces::default();
        // A triangle of area 1/2 seen from +z, and one of area 2 seen from +x.
        for corner in [0, 1, 2] {
            faces.add_corner(corner);
        }
        faces.close();
        for corner in [0, 3, 4] {
            faces.add_corner(corner);
        }
        faces.close();
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
        let points = [DVec3::ZERO, x, y, 2.0 * y, 2.0 * z, DVec3::ONE];
        let normals = faces.normals(&points);
        assert_eq!(normals, [DVec3::new(4.0, 0.0, 1.0), z, z, 4.0 * x, 4.0 * x, DVec3::ZERO]);
    }
}
