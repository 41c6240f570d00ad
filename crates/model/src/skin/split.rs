//! Simple polyhedra split into tetrahedra.

/// A corner of a mixed cell: a vertex of the power diagram and an atom.
pub(super) type Corner = (usize, usize);

/// The tetrahedra of a polyhedron that is given by the corners of its facets, in any order. Each corner
/// belongs to three facets.
///
/// It is pulled at its least corner: cones from there to the facets that do not hold it, and these are fans
/// from their own least corners. A facet that two polyhedra share is a fan from its least corner in both.
pub(super) fn tetrahedra(facets: &[Vec<Corner>]) -> Vec<[Corner; 4]> {
    let Some(&apex) = facets.iter().flatten().min() else { return Vec::new() };
    let across = facets.iter().filter(|facet| !facet.contains(&apex));
    let cones = across
        .flat_map(|facet| fan(facet, facets).into_iter().map(move |[a, b, c]| [apex, a, b, c]));
    cones.collect()
}

/// A facet's triangles.
fn fan(facet: &[Corner], facets: &[Vec<Corner>]) -> Vec<[Corner; 3]> {
    let Some(&least) = facet.iter().min() else { return Vec::new() };
    // Facets of a simple polyhedron have an edge in common, or nothing.
    let edges = facets.iter().filter_map(|other| {
        let common: Vec<_> =
            other.iter().copied().filter(|corner| facet.contains(corner)).collect();
        <[Corner; 2]>::try_from(common).ok()
    });
    edges.filter(|edge| !edge.contains(&least)).map(|[a, b]| [least, a, b]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn volume(tetrahedra: &[[Corner; 4]], place: impl Fn(Corner) -> DVec3) -> f64 {
        let of_one = |t: &[Corner; 4]| {
            let [p, q, r, s] = t.map(&place);
            (q - p).cross(r - p).dot(s - p).abs() / 6.0
        };
        tetrahedra.iter().map(of_one).sum()
    }

    #[test]
    fn a_cube_and_a_prism_are_filled() {
        let bit = |i: usize, k: usize| (i >> k & 1) as f64;
        let cube: Vec<Vec<Corner>> = (0..6)
            .map(|f| (0..8).filter(|i| i >> (f / 2) & 1 == f % 2).map(|i| (i, 0)).collect())
            .collect();
        let split = tetrahedra(&cube);
        assert_eq!(split.len(), 6);
        let filled = volume(&split, |(i, _)| DVec3::new(bit(i, 0), bit(i, 1), bit(i, 2)));
        assert!((filled - 1.0).abs() < 1e-15);
        // A triangle's corners are atoms, a segment's are vertices.
        let mut prism: Vec<Vec<Corner>> =
            (0..2).map(|v| (0..3).map(|i| (v, i)).collect()).collect();
        prism.extend((0..3).map(|j| {
            (0..2).flat_map(|v| (0..3).filter(move |&i| i != j).map(move |i| (v, i))).collect()
        }));
        let split = tetrahedra(&prism);
        assert_eq!(split.len(), 3);
        let filled =
            volume(&split, |(v, i)| DVec3::new(f64::from(i == 1), f64::from(i == 2), v as f64));
        assert!((filled - 0.5).abs() < 1e-15);
    }
}
