//! The power diagram of spheres, cut with a box.

use std::collections::BTreeMap;

use glam::{DMat4, DVec3, DVec4};

/// A sphere by its centre and the square of its radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sphere {
    pub(super) centre: DVec3,
    pub(super) weight: f64,
}

/// A point of equal and least power to the spheres among `sides`. Sides come in order: spheres by their
/// index, then the box's six walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    pub(super) place: DVec3,
    pub(super) sides: [usize; 4],
}

/// The vertices of a power diagram in which each belongs to four sides.
///
/// With h = pi(p) - |p|^2 each sphere says h <= |z|^2 - w - 2 z.p, and each wall bounds p: half-spaces in
/// four dimensions. The diagram is the upper boundary of what they have in common.
#[derive(Clone, Debug)]
pub(super) struct Diagram {
    pub(super) vertices: Vec<Vertex>,
    spheres: usize,
}

/// n'(p, h) <= d in four dimensions.
#[derive(Clone, Copy)]
struct Side {
    normal: DVec4,
    offset: f64,
}

/// How far weights are changed at first, in units of the greatest.
const CHANGE: f64 = 1.0 / (1u64 << 30) as f64;
/// How often changes are tried, each four times as great: to 2^-16. What is ambiguous to a small change are
/// spheres that are in a plane but for about as much, since that much is divided by.
const TRIES: i32 = 8;
/// How far a point may be from the sides that it is on, in units of its size: far more than rounding leaves
/// where there is a point.
const RESIDUE: f64 = 1e-9;

impl Diagram {
    /// The diagram in a box around 0 with the given upper corner. The weights are changed as it needs;
    /// nothing if no change is enough.
    pub(super) fn new(spheres: &mut [Sphere], walls: DVec3) -> Option<Self> {
        let weights: Vec<_> = spheres.iter().map(|sphere| sphere.weight).collect();
        let greatest = weights.iter().copied().fold(0.0, f64::max);
        (0..TRIES).find_map(|attempt| {
            let change = CHANGE * 4f64.powi(attempt) * greatest;
            for (i, (sphere, weight)) in spheres.iter_mut().zip(&weights).enumerate() {
                sphere.weight = weight + change * spread(i as u64);
            }
            let vertices = vertices(&sides(spheres, walls), spheres.len());
            is_closed(&vertices, spheres.len()).then_some(Self { vertices, spheres: spheres.len() })
        })
    }

    /// The spheres of each face, and its vertices.
    pub(super) fn faces(&self) -> BTreeMap<Vec<usize>, Vec<usize>> {
        let mut faces = BTreeMap::<_, Vec<_>>::new();
        for (v, vertex) in self.vertices.iter().enumerate() {
            let spheres: Vec<_> =
                vertex.sides.into_iter().filter(|&side| side < self.spheres).collect();
            for chosen in 1..1 << spheres.len() {
                let is_chosen = |i: &usize| chosen >> i & 1 == 1;
                let sigma = (0..spheres.len()).filter(is_chosen).map(|i| spheres[i]).collect();
                faces.entry(sigma).or_default().push(v);
            }
        }
        faces
    }
}

/// A number between -1 and 1 that looks random: the bits of SplitMix64.
fn spread(index: u64) -> f64 {
    let mut bits = (index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ bits >> 31) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn sides(spheres: &[Sphere], walls: DVec3) -> Vec<Side> {
    let spheres = spheres.iter().map(|&Sphere { centre, weight }| Side {
        normal: (2.0 * centre).extend(1.0),
        offset: centre.length_squared() - weight,
    });
    let walls = DVec3::AXES.into_iter().zip(walls.to_array()).flat_map(|(axis, offset)| {
        [axis, -axis].map(|normal| Side { normal: normal.extend(0.0), offset })
    });
    spheres.chain(walls).collect()
}

/// All points on four sides and within the others; one of the four is a sphere.
fn vertices(sides: &[Side], spheres: usize) -> Vec<Vertex> {
    let count = sides.len();
    let mut vertices = Vec::new();
    for a in 0..spheres {
        for b in a + 1..count {
            for c in b + 1..count {
                for d in c + 1..count {
                    let on = [a, b, c, d];
                    let Some(point) = meet(on.map(|i| sides[i])) else { continue };
                    let is_within = |i| on.contains(&i) || within(sides[i], point);
                    if (0..count).all(is_within) {
                        vertices.push(Vertex { place: point.truncate(), sides: on });
                    }
                }
            }
        }
    }
    vertices
}

fn within(side: Side, point: DVec4) -> bool {
    side.normal.dot(point) < side.offset
}

/// The point on four sides, if there is one.
fn meet(sides: [Side; 4]) -> Option<DVec4> {
    let [a, b, c, d] = sides.map(|side| side.normal);
    let rows = DMat4::from_cols(a, b, c, d).transpose();
    let offsets = DVec4::from(sides.map(|side| side.offset));
    let inverse = rows.inverse();
    let point = inverse * offsets;
    // Once more for what rounding left over.
    let point = point + inverse * (offsets - rows * point);
    // Sides that are nearly parallel leave nothing but rounding.
    let size = 1.0 + point.abs().max_element();
    ((rows * point - offsets).abs().max_element() < RESIDUE * size).then_some(point)
}

/// Do the vertices bound something? Then each edge, three sides with a sphere, has two ends; if rounding has
/// put a vertex on the wrong side of a fifth, some have not.
fn is_closed(vertices: &[Vertex], spheres: usize) -> bool {
    let mut ends = BTreeMap::<_, usize>::new();
    for Vertex { sides: [a, b, c, d], .. } in vertices.iter().copied() {
        for edge in [[a, b, c], [a, b, d], [a, c, d], [b, c, d]] {
            if edge[0] < spheres {
                *ends.entry(edge).or_default() += 1;
            }
        }
    }
    !ends.is_empty() && ends.values().all(|&count| count == 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diagram(spheres: &[(DVec3, f64)]) -> (Diagram, Vec<Sphere>) {
        let sphere = |&(centre, weight): &(DVec3, f64)| Sphere { centre, weight };
        let mut spheres: Vec<_> = spheres.iter().map(sphere).collect();
        (Diagram::new(&mut spheres, DVec3::new(3.1, 3.2, 3.3)).unwrap(), spheres)
    }

    /// How many faces there are of 1, 2, 3 and 4 spheres.
    fn counts(diagram: &Diagram) -> [usize; 4] {
        let faces = diagram.faces();
        [1, 2, 3, 4].map(|k| faces.keys().filter(|sigma| sigma.len() == k).count())
    }

    #[test]
    fn spheres_have_faces_wherever_they_lie() {
        let at = |x: f64, y: f64, z: f64| (DVec3::new(x, y, z), 0.5);
        let one = diagram(&[at(0.3, 0.0, 0.0)]).0;
        assert_eq!((one.vertices.len(), counts(&one)), (8, [1, 0, 0, 0]));
        let line = [at(-1.0, 0.0, 0.0), at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0)];
        assert_eq!(counts(&diagram(&line).0), [3, 2, 0, 0]);
        // A square has one of its diagonals.
        let square = [at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(1.0, 1.0, 0.0), at(0.0, 1.0, 0.0)];
        assert_eq!(counts(&diagram(&square).0), [4, 5, 2, 0]);
        let solid = [at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0), at(0.0, 0.0, 1.0)];
        assert_eq!(counts(&diagram(&solid).0), [4, 6, 4, 1]);
        // One that another one holds, and one of two alike, have none.
        let hidden = [at(0.0, 0.0, 0.0), (DVec3::new(0.05, 0.0, 0.0), 0.1), at(0.0, 0.0, 0.0)];
        assert_eq!(counts(&diagram(&hidden).0), [1, 0, 0, 0]);
    }

    #[test]
    fn a_cube_is_split_like_any_polyhedron() {
        let corner = |i: u32| DVec3::from([i & 1, i >> 1 & 1, i >> 2].map(f64::from)) - 0.5;
        let spheres: Vec<_> = (0..8).map(|i| (corner(i), 1.0)).collect();
        let [v, e, f, c] = counts(&diagram(&spheres).0);
        assert_eq!(v, 8);
        assert_eq!(v + f - e - c, 1, "Euler: {v} {e} {f} {c}");
    }

    #[test]
    fn a_vertex_too_few_is_noticed() {
        let at = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|place| (place, 0.5));
        let mut vertices = diagram(&at).0.vertices;
        assert!(is_closed(&vertices, 3));
        vertices.pop();
        assert!(!is_closed(&vertices, 3) && !is_closed(&[], 3));
    }

    #[test]
    fn vertices_have_equal_and_least_power() {
        let place = |i: u64| DVec3::from([3 * i, 3 * i + 1, 3 * i + 2].map(spread));
        let given: Vec<_> = (0..12).map(|i| (place(i), 0.3 + 0.2 * spread(99 + i))).collect();
        let (diagram, spheres) = diagram(&given);
        assert!(diagram.vertices.len() > 30);
        for vertex in &diagram.vertices {
            let power = |s: &Sphere| vertex.place.distance_squared(s.centre) - s.weight;
            let least = spheres.iter().map(power).fold(f64::INFINITY, f64::min);
            for (i, sphere) in spheres.iter().enumerate() {
                let is_least = power(sphere) - least < 1e-11;
                assert_eq!(is_least, vertex.sides.contains(&i), "{vertex:?} {i}");
            }
        }
        for (sphere, (_, weight)) in spheres.iter().zip(&given) {
            assert!((sphere.weight - weight).abs() < 1e-9);
        }
    }
}
