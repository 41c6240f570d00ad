//! Molecules, and a few that are built in.

use glam::{DMat3, DVec3};

use super::{Atom, Element};

/// A molecule.
#[derive(Clone, Debug, PartialEq)]
pub struct Molecule {
    /// What it is.
    pub name: String,
    /// Its atoms: what they are and where, in angstrom.
    pub places: Vec<(Element, DVec3)>,
}

impl Molecule {
    /// Its atoms with van der Waals radii, in angstrom.
    pub fn atoms(&self) -> Vec<Atom> {
        let atom =
            |&(element, centre): &(Element, DVec3)| Atom { centre, radius: element.radius() };
        self.places.iter().map(atom).collect()
    }
}

/// The place at `length` from `c` whose angle with `b` and dihedral angle with `a`, in degrees, are given.
fn bonded([a, b, c]: [DVec3; 3], length: f64, angle: f64, dihedral: f64) -> DVec3 {
    let along = (c - b).normalize();
    let normal = (b - a).cross(along).normalize();
    let frame = DMat3::from_cols(along, normal.cross(along), normal);
    let (sin, cos) = angle.to_radians().sin_cos();
    let (up, out) = dihedral.to_radians().sin_cos();
    c + length * (frame * DVec3::new(-cos, sin * out, sin * up))
}

/// Water: O-H 0.9584 A, H-O-H 104.45 degrees.
pub fn water() -> Molecule {
    let (sin, cos) = (0.5 * 104.45_f64).to_radians().sin_cos();
    let hydrogen = |side: f64| (Element::H, 0.9584 * DVec3::new(side * sin, 0.0, -cos));
    let places = vec![(Element::O, DVec3::ZERO), hydrogen(-1.0), hydrogen(1.0)];
    Molecule { name: "water".into(), places }
}

/// Ethanol, H-O-C-C in a plane: C-C 1.512, C-O 1.431, O-H 0.971, C-H 1.09 A; C-C-O 107.8, C-O-H 105.4, others
/// 109.5 or 110.5 degrees.
pub fn ethanol() -> Molecule {
    use Element::{C, H, O};
    let methyl = DVec3::ZERO;
    let methylene = DVec3::new(1.512, 0.0, 0.0);
    let oxygen = bonded([DVec3::Y, methyl, methylene], 1.431, 107.8, 180.0);
    let hydroxyl = bonded([methyl, methylene, oxygen], 0.971, 105.4, 180.0);
    let mut places = vec![(C, methyl), (C, methylene), (O, oxygen), (H, hydroxyl)];
    for dihedral in [180.0, 60.0, -60.0] {
        places.push((H, bonded([oxygen, methylene, methyl], 1.09, 110.5, dihedral)));
    }
    for dihedral in [60.0, -60.0] {
        places.push((H, bonded([hydroxyl, oxygen, methylene], 1.09, 109.5, dihedral)));
    }
    Molecule { name: "ethanol".into(), places }
}

/// Benzene, a regular hexagon in z = 0: C-C 1.397, C-H 1.084 A.
pub fn benzene() -> Molecule {
    let places = (0..6).flat_map(|i| {
        let (sin, cos) = (60.0 * f64::from(i)).to_radians().sin_cos();
        let at = move |radius: f64| radius * DVec3::new(cos, sin, 0.0);
        [(Element::C, at(1.397)), (Element::H, at(1.397 + 1.084))]
    });
    Molecule { name: "benzene".into(), places: places.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Element::{C, H, O};

    fn angle(molecule: &Molecule, [i, k, l]: [usize; 3]) -> f64 {
        let [a, b, c] = [i, k, l].map(|i| molecule.places[i].1);
        (a - b).angle_between(c - b).to_degrees()
    }

    /// Pairs of atoms that are near enough for a bond, sorted.
    fn bonds(molecule: &Molecule) -> Vec<(Element, Element, f64)> {
        let mut found = Vec::new();
        for (i, &(first, a)) in molecule.places.iter().enumerate() {
            let near =
                molecule.places[i + 1..].iter().map(|&(second, b)| (first, second, a.distance(b)));
            found.extend(near.filter(|&(a, b, length)| length < 1.52 && (a, b) != (H, H)));
        }
        found
    }

    #[test]
    fn bonds_have_their_lengths_and_angles() {
        assert!((angle(&water(), [1, 0, 2]) - 104.45).abs() < 1e-9);
        let ethanol = ethanol();
        assert!((angle(&ethanol, [0, 1, 2]) - 107.8).abs() < 1e-9);
        assert!((angle(&ethanol, [1, 2, 3]) - 105.4).abs() < 1e-9);
        assert!((angle(&ethanol, [4, 0, 1]) - 110.5).abs() < 1e-9);
        for hydrogens in [[4, 0, 5], [5, 0, 6], [6, 0, 4]] {
            assert!((angle(&ethanol, hydrogens) - 108.42).abs() < 0.01);
        }
        // The two hydrogens of CH2 are away from each other and from the methyl group.
        assert!((angle(&ethanol, [7, 1, 8]) - 109.0).abs() < 1.0);
        assert!((angle(&ethanol, [7, 1, 0]) - 110.0).abs() < 1.0);
        for (molecule, expected) in [
            (water(), vec![(O, H, 0.9584, 2)]),
            (ethanol, vec![(C, C, 1.512, 1), (C, O, 1.431, 1), (O, H, 0.971, 1), (C, H, 1.09, 5)]),
            (benzene(), vec![(C, C, 1.397, 6), (C, H, 1.084, 6)]),
        ] {
            let found = bonds(&molecule);
            assert_eq!(found.len(), expected.iter().map(|e| e.3).sum::<usize>(), "{found:?}");
            for (a, b, length, count) in expected {
                let is_it = |f: &&(Element, Element, f64)| {
                    (f.0, f.1) == (a, b) && (f.2 - length).abs() < 1e-12
                };
                assert_eq!(found.iter().filter(is_it).count(), count, "{a}-{b}: {found:?}");
            }
        }
    }
}
