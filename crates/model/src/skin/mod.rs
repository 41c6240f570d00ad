//! Skin surfaces of molecules, \[edelsbrunner1999\], as quadrics in tetrahedra.
//!
//! # Convention
//!
//! The skin is given by spheres and a shrink factor s between 0 and 1. Edelsbrunner shrinks each sphere by
//! sqrt(s). Here radii are those that are seen: an atom of radius r has the weight w = r^2/s and, alone, the
//! skin |x - z| = r. As s goes to 1 the skin becomes the union of the balls; the smaller s, the wider the
//! necks between atoms.
//!
//! # Derivation
//!
//! Let pi_i(x) = |x - z_i|^2 - w_i be the power of x to sphere i. A mean of such functions, with weights l_i
//! that sum to 1, is the power to another sphere, with the centre y = sum l_i z_i and the weight
//! W = |y|^2 - sum l_i (|z_i|^2 - w_i). The greatest W for a given y is |y|^2 - L(y), where L is the greatest
//! convex function with L(z_i) <= |z_i|^2 - w_i: linear on each cell of the regular triangulation, and
//! infinite beyond all centres. All these spheres, shrunk, bound the set where
//!
//! ```text
//! f(x) = min over y of |x - y|^2 - s W(y) = |x|^2 - max over y of (2 x.y - (1-s) |y|^2 - s L(y))
//! ```
//!
//! is not above 0, and the skin is f = 0. What is subtracted from |x|^2 is strictly concave in y, with a
//! modulus that does not depend on y: so one y is the best, and f has a Lipschitz gradient, 2 (x - y).
//!
//! Let y be inside a simplex sigma of the triangulation. The slopes of L there are 2 p for the points p with
//! equal power to sigma's spheres, and no less to others: the face nu of the power diagram that is dual to
//! sigma. So y is the best for x = (1-s) y + s p: the points of the **mixed cell** s nu + (1-s) sigma. The
//! affine hulls of nu and sigma are at right angles and meet in the focus z. Spheres with centres in the
//! hull of sigma have W = |y - z|^2 + R^2, where -R^2 = |z - z_i|^2 - w_i is the power of z. With x - z = a +
//! b, a along sigma and b along nu, the best y is z + a/(1-s), and in the mixed cell
//!
//! ```text
//! f(x) = |b|^2 - s/(1-s) |a|^2 - s R^2
//! ```
//!
//! | sigma | R^2 > 0 | R^2 < 0 |
//! |---|---|---|
//! | a centre | a sphere | - |
//! | an edge | a hyperboloid of one sheet | of two sheets |
//! | a triangle | of two sheets | of one sheet |
//! | a tetrahedron | no surface: inside | a sphere, seen from its inside |
//!
//! # In numbers
//!
//! The power diagram is cut with a box, wide enough that its mixed cells hold the whole skin; then all of its
//! faces are bounded, whether atoms span space or lie in a plane, on a line or alone. Weights are changed by
//! up to 2^-30 of the greatest, always alike, so that no five spheres have a common power anywhere, and each
//! vertex belongs to four; where rounding leaves that in doubt, by more, up to 2^-16.
//!
//! A mixed cell is a product of a face and a simplex, its corners are pairs of a vertex and an atom, and it
//! is split by pulling its least pair: neighbours then split their common faces alike. Corners lie on a
//! lattice of 2^-26 of the molecule's size, so that sums with the origins of patches are exact. That moves
//! faces, but not the skin: f has one value and one gradient on both sides of a face, so beside it the two
//! quadrics differ by the square of the distance, 2^-52.

mod cell;
mod diagram;
mod element;
mod error;
mod lattice;
mod molecule;
mod simplex;
mod split;
mod xyz;

pub use cell::{Kind, MixedCell};
pub use element::Element;
pub use error::MoleculeError;
pub use molecule::{Molecule, benzene, ethanol, water};

use glam::DVec3;
use zeroset_raycast::{Blending, Error, Patches, Sides};

use cell::Recipe;
use diagram::{Diagram, Sphere};
use lattice::Lattice;

/// An atom, alone in space a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Atom {
    /// The centre.
    pub centre: DVec3,
    /// The radius, in the units of the centre.
    pub radius: f64,
}

/// A skin surface, but for its atoms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skin {
    /// The shrink factor s, between 0 and 1.
    pub shrink: f64,
}

impl Default for Skin {
    /// Half: necks are hyperboloids whose asymptotes are at right angles.
    fn default() -> Self {
        Self { shrink: 0.5 }
    }
}

/// How many atoms a skin may have: the work grows with their fourth power.
const MOST: usize = 100;

impl Skin {
    /// The mixed complex around the skin: its cells cover the box of all atoms.
    ///
    /// # Errors
    /// If there are no atoms or more than 100, a number is not finite, a radius is not above 0, or the shrink
    /// factor is not between 0 and 1; or if the power diagram stays in doubt, which takes many atoms that
    /// are on a grid but for a millionth.
    pub fn cells(&self, atoms: &[Atom]) -> Result<Vec<MixedCell>, Error> {
        Ok(self.complex(atoms)?.0)
    }

    /// The skin in patches: those tetrahedra of mixed cells that it may pass, seen from outside.
    ///
    /// # Errors
    /// As [`cells`](Self::cells).
    pub fn patches(&self, atoms: &[Atom]) -> Result<Patches, Error> {
        let (cells, lattice) = self.complex(atoms)?;
        let patches = cells.iter().flat_map(|cell| {
            cell.crossed().map(|corners| cell.patch(corners, lattice.middle(corners)))
        });
        Patches::new(patches.collect(), Sides::Front, Blending::None)
    }

    fn complex(&self, atoms: &[Atom]) -> Result<(Vec<MixedCell>, Lattice), Error> {
        self.check(atoms)?;
        let s = self.shrink;
        let lattice = Lattice::around(atoms);
        let mut spheres: Vec<_> = atoms
            .iter()
            .map(|atom| {
                let radius = lattice.length(atom.radius);
                Sphere { centre: lattice.local(atom.centre), weight: radius * radius / s }
            })
            .collect();
        let walls = walls(&spheres, s);
        let diagram = Diagram::new(&mut spheres, walls).ok_or_else(|| {
            Error::Patches("atoms so nearly on a sphere or in a plane that rounding decides".into())
        })?;
        let recipe = Recipe { shrink: s, spheres: &spheres, diagram: &diagram, lattice: &lattice };
        let cells = diagram.faces().into_iter().map(|(sigma, nu)| recipe.make(sigma, &nu));
        Ok((cells.collect(), lattice))
    }

    fn check(&self, atoms: &[Atom]) -> Result<(), Error> {
        let refused = |why: String| Err(Error::Patches(why));
        if !(self.shrink > 0.0 && self.shrink < 1.0) {
            return refused(format!("a shrink factor of {}, not between 0 and 1", self.shrink));
        }
        if !(1..=MOST).contains(&atoms.len()) {
            return refused(format!("{} atoms, not 1 to {MOST}", atoms.len()));
        }
        for (i, Atom { centre, radius }) in atoms.iter().enumerate() {
            if !(centre.is_finite() && *radius > 0.0 && radius.is_finite()) {
                return refused(format!("atom {i} with radius {radius} at {centre}"));
            }
        }
        Ok(())
    }
}

/// The upper corner of a box around 0 whose mixed cells hold the skin.
///
/// No shrunk sphere is larger than the largest atom, so |x_k| <= e_k + r with e the extent of the centres.
/// Then p = (x - (1-s) y)/s, with y among the centres. The box is a little larger, by a different factor in each
/// direction so that its edges avoid the planes of symmetric molecules.
fn walls(spheres: &[Sphere], s: f64) -> DVec3 {
    let extent = spheres.iter().map(|sphere| sphere.centre.abs()).fold(DVec3::ZERO, DVec3::max);
    let radius = (s * spheres.iter().map(|sphere| sphere.weight).fold(0.0, f64::max)).sqrt();
    (extent + radius + (1.0 - s) * extent) / s * DVec3::new(1.013, 1.029, 1.017)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_skin_is_refused() {
        let atom = Atom { centre: DVec3::ZERO, radius: 1.0 };
        let refused = |shrink, atoms: &[Atom]| {
            let skin = Skin { shrink };
            let said = skin.cells(atoms).unwrap_err();
            assert_eq!(said, skin.patches(atoms).unwrap_err());
            said.to_string()
        };
        for shrink in [0.0, 1.0, -1.0, f64::NAN] {
            assert!(refused(shrink, &[atom]).contains("shrink factor"));
        }
        assert!(refused(0.5, &[]).contains("0 atoms"));
        assert!(refused(0.5, &[atom; 101]).contains("101 atoms"));
        for bad in [
            Atom { radius: 0.0, ..atom },
            Atom { radius: f64::INFINITY, ..atom },
            Atom { centre: DVec3::NAN, ..atom },
        ] {
            assert!(refused(0.5, &[atom, bad]).contains("atom 1"));
        }
    }
}
