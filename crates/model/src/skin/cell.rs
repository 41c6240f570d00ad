//! Mixed cells: where the skin is one quadric.

use glam::{DMat3, DVec3};
use zeroset_raycast::{Bound, Patch, Quadric};

use super::diagram::{Diagram, Sphere};
use super::lattice::Lattice;
use super::simplex::Focus;
use super::split::{self, Corner};

/// What the quadric of a mixed cell is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A sphere, of an atom.
    Sphere,
    /// A hyperboloid of one sheet, or a cone: a neck between two atoms, or the inside of a ring of three.
    OneSheet,
    /// A hyperboloid of two sheets: between two atoms that are apart, or above and below three that are not.
    TwoSheets,
    /// A sphere that is seen from its inside: a pocket between four atoms.
    Pocket,
    /// No surface at all: between four atoms that overlap.
    Inside,
}

/// A cell of the mixed complex.
#[derive(Clone, Debug, PartialEq)]
pub struct MixedCell {
    /// The indices of its one to four atoms.
    pub atoms: Vec<usize>,
    /// What its quadric is.
    pub kind: Kind,
    /// The focus.
    pub focus: DVec3,
    /// The quadric about the focus, in units of space squared; f > 0 outside.
    pub quadric: Quadric,
    /// The tetrahedra that fill it.
    pub tetrahedra: Vec<[DVec3; 4]>,
}

/// What all cells of a skin share.
pub(super) struct Recipe<'a> {
    pub(super) shrink: f64,
    pub(super) spheres: &'a [Sphere],
    pub(super) diagram: &'a Diagram,
    pub(super) lattice: &'a Lattice,
}

/// The thickness of a tetrahedron, in units of its longest edge, up to which it is a matter of rounding.
const FLAT: f64 = 16.0 * f64::EPSILON;
/// How far f may be off, in units of its greatest value in a tetrahedron.
const ROUNDING: f64 = 1.0 / (1u64 << 40) as f64;

impl Recipe<'_> {
    /// The cell of atoms and the vertices of their face of the power diagram.
    pub(super) fn make(&self, atoms: Vec<usize>, dual: &[usize]) -> MixedCell {
        let simplex: Vec<_> = atoms.iter().map(|&i| self.spheres[i]).collect();
        let places = dual.iter().map(|&v| self.diagram.vertices[v].place);
        let focus = Focus::new(&simplex, places.sum::<DVec3>() / dual.len() as f64);
        let place = |(v, i): Corner| {
            let [p, y] = [self.diagram.vertices[v].place, self.spheres[i].centre];
            self.lattice.nearest(self.lattice.space(self.shrink * p + (1.0 - self.shrink) * y))
        };
        let split = split::tetrahedra(&self.facets(&atoms, dual));
        let tetrahedra = split.into_iter().map(|corners| corners.map(place));
        let local = focus.quadric(self.shrink);
        MixedCell {
            kind: kind(atoms.len(), focus.square),
            focus: self.lattice.space(focus.place),
            quadric: Quadric { c: self.lattice.square() * local.c, ..local },
            tetrahedra: tetrahedra.filter(|&corners| has_volume(corners)).collect(),
            atoms,
        }
    }

    /// The facets of the product of face and simplex: a facet of one and all of the other.
    fn facets(&self, atoms: &[usize], dual: &[usize]) -> Vec<Vec<Corner>> {
        let sides = |v: usize| self.diagram.vertices[v].sides;
        let mut others: Vec<_> = dual.iter().flat_map(|&v| sides(v)).collect();
        others.retain(|side| !atoms.contains(side));
        others.sort_unstable();
        others.dedup();
        let of_face = others.iter().map(|side| {
            let on = dual.iter().filter(|&&v| sides(v).contains(side));
            on.flat_map(|&v| atoms.iter().map(move |&i| (v, i))).collect()
        });
        let without = |left: usize| {
            let rest = move |&i: &usize| (i != left).then_some(i);
            dual.iter().flat_map(|&v| atoms.iter().filter_map(rest).map(move |i| (v, i))).collect()
        };
        let of_simplex = atoms.iter().filter(|_| atoms.len() > 1).map(|&left| without(left));
        of_face.chain(of_simplex).collect()
    }
}

fn kind(atoms: usize, square: f64) -> Kind {
    match (atoms, square >= 0.0) {
        (1, _) => Kind::Sphere,
        (2, true) | (3, false) => Kind::OneSheet,
        (2, false) | (3, true) => Kind::TwoSheets,
        (_, true) => Kind::Inside,
        (_, false) => Kind::Pocket,
    }
}

fn has_volume([p, q, r, s]: [DVec3; 4]) -> bool {
    let sides = DMat3::from_cols(q - p, r - p, s - p);
    let faces = [(q - p, r - p), (r - p, s - p), (s - p, q - p), (r - q, s - q)];
    let area = faces.map(|(a, b)| a.cross(b).length()).into_iter().fold(0.0, f64::max);
    let edges = [q - p, r - p, s - p, r - q, s - r, q - s];
    let length = edges.map(DVec3::length).into_iter().fold(0.0, f64::max);
    sides.determinant().abs() > FLAT * area * length
}

impl MixedCell {
    /// f at a point of space.
    pub fn value(&self, x: DVec3) -> f64 {
        self.quadric.value(x - self.focus)
    }

    /// Its tetrahedra that the skin may pass: f is between the least and the greatest of its ten Bernstein
    /// ordinates.
    pub fn crossed(&self) -> impl Iterator<Item = [DVec3; 4]> {
        self.tetrahedra.iter().copied().filter(|&corners| {
            let ordinates = ordinates(&self.quadric, corners.map(|p| p - self.focus));
            let least = ordinates.into_iter().fold(f64::INFINITY, f64::min);
            let most = ordinates.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let error = ROUNDING * most.abs().max(least.abs());
            least <= error && most >= -error
        })
    }

    /// A tetrahedron of it as a patch about a point that all corners have exact differences with.
    pub(super) fn patch(&self, corners: [DVec3; 4], origin: DVec3) -> Patch {
        let bound = Bound::Tetrahedron(corners.map(|p| p - origin));
        Patch { origin, quadric: self.quadric.about(origin - self.focus), bound, clip: None }
    }
}

/// The Bernstein ordinates of a quadric in a tetrahedron: its blossom at pairs of corners. f is a mean of them
/// at each point.
fn ordinates(quadric: &Quadric, corners: [DVec3; 4]) -> [f64; 10] {
    let blossom = |p: DVec3, q: DVec3| p.dot(quadric.a * q) + quadric.b.dot(p + q) + quadric.c;
    let pairs = [(0, 0), (0, 1), (0, 2), (0, 3), (1, 1), (1, 2), (1, 3), (2, 2), (2, 3), (3, 3)];
    pairs.map(|(i, k)| blossom(corners[i], corners[k]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skin::{Atom, benzene, ethanol, water};

    #[test]
    fn ordinates_bound_the_values_between_corners() {
        let a = DMat3::from_cols_array(&[1.0, 0.5, 0.0, 0.5, -2.0, 0.25, 0.0, 0.25, 0.75]);
        let quadric = Quadric { a, b: DVec3::new(0.5, -0.25, 1.0), c: -0.125 };
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(0.5, 2.0, 0.0), DVec3::new(0.0, 0.5, 1.5)];
        let b = ordinates(&quadric, corners);
        let l = [0.125, 0.25, 0.5, 0.125];
        let x: DVec3 = corners.into_iter().zip(l).map(|(p, l)| l * p).sum();
        let mut mean = 0.0;
        let mut next = b.into_iter();
        for i in 0..4 {
            for k in i..4 {
                let weight = l[i] * l[k] * if i == k { 1.0 } else { 2.0 };
                mean += weight * next.next().unwrap();
            }
        }
        assert!((mean - quadric.value(x)).abs() < 1e-15);
    }

    /// On s p + (1-s) y, with p in the face that is dual to tau and y in sigma, a part of tau.
    #[test]
    fn the_two_quadrics_of_a_face_have_one_value_and_one_gradient_there() {
        for (molecule, shrink) in
            [(ethanol(), 0.5), (benzene(), 0.5), (benzene(), 0.8), (water(), 0.2)]
        {
            let sphere = |atom: Atom| Sphere {
                centre: 0.125 * atom.centre,
                weight: (0.125 * atom.radius).powi(2) / shrink,
            };
            let mut spheres: Vec<_> = molecule.atoms().into_iter().map(sphere).collect();
            let diagram = Diagram::new(&mut spheres, DVec3::new(2.1, 2.2, 2.3)).unwrap();
            let faces = diagram.faces();
            let focus = |sigma: &[usize], dual: &[usize]| {
                let simplex: Vec<_> = sigma.iter().map(|&i| spheres[i]).collect();
                let places = dual.iter().map(|&v| diagram.vertices[v].place);
                Focus::new(&simplex, places.sum::<DVec3>() / dual.len() as f64)
            };
            let mut count = 0;
            for (tau, dual_of_tau) in &faces {
                for (sigma, dual) in
                    faces.iter().filter(|(sigma, _)| sigma.iter().all(|i| tau.contains(i)))
                {
                    let [of_tau, of_sigma] = [focus(tau, dual_of_tau), focus(sigma, dual)];
                    for (n, &v) in dual_of_tau.iter().enumerate() {
                        let w = dual_of_tau[(n + 1) % dual_of_tau.len()];
                        let [v, w] = [v, w].map(|v| diagram.vertices[v].place);
                        let [y, z] = [sigma[0], sigma[sigma.len() - 1]].map(|i| spheres[i].centre);
                        let x = shrink * v.lerp(w, 0.3) + (1.0 - shrink) * y.lerp(z, 0.6);
                        let [here, there] = [&of_tau, &of_sigma].map(|focus| {
                            let quadric = focus.quadric(shrink);
                            (quadric.value(x - focus.place), quadric.half_gradient(x - focus.place))
                        });
                        assert!((here.0 - there.0).abs() < 1e-12, "{tau:?} {sigma:?}");
                        assert!((here.1 - there.1).length() < 1e-12, "{tau:?} {sigma:?}");
                        count += 1;
                    }
                }
            }
            assert!(count > 70, "{count}");
        }
    }

    #[test]
    fn flat_tetrahedra_have_no_volume() {
        let solid = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.2, 0.3, 1e-8)];
        assert!(has_volume(solid));
        let mut flat = solid;
        flat[3].z = 1e-16;
        assert!(!has_volume(flat));
        assert!(!has_volume([DVec3::ONE; 4]));
    }
}
