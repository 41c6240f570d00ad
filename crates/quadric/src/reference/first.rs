//! The first of the roots of all patches.

use zeroset_cpu::Class;
use zeroset_raycast::{Patches, Ray};

use super::root::{self, Root};
use super::{Found, is_narrow};
use crate::hierarchy::Hierarchy;

pub(super) fn find(patches: &Patches, hierarchy: &Hierarchy, ray: Ray, range: [f64; 2]) -> Found {
    let (mut found, mut work, mut end) = (Vec::new(), 0, range[1]);
    hierarchy.walk(ray, range, |index| {
        let (roots, solved) = root::roots(&patches.all()[index], patches.sides(), ray, range);
        work += solved;
        for root in roots.iter().filter(|root| root.is_sure) {
            end = end.min(root.t[1]);
        }
        found.extend(roots);
        end
    });
    let (class, bracket) = first(&found, range);
    (class, bracket, work)
}

/// The first root, if it is known which.
fn first(roots: &[Root], range: [f64; 2]) -> (Class, [f64; 2]) {
    let least = |end: usize, is_sure: bool| {
        let ends = roots.iter().filter(|r| r.is_sure || !is_sure).map(|r| r.t[end]);
        ends.fold(f64::INFINITY, f64::min)
    };
    // None lies before `from`, one lies before `to`.
    let (from, to) = (least(0, false), least(1, true));
    if roots.is_empty() {
        return (Class::None, [f64::INFINITY; 2]);
    }
    if to == f64::INFINITY {
        let most = roots.iter().map(|r| r.t[1]).fold(f64::NEG_INFINITY, f64::max);
        return (Class::Undecidable, [from, most.min(range[1])]);
    }
    let is_narrow = is_narrow([from, to]);
    let is_double = roots.iter().any(|r| r.is_double && r.t[0] <= to);
    let class = match (is_narrow, is_double) {
        (false, _) => Class::Undecidable,
        (true, true) => Class::Tangential,
        (true, false) => Class::Transversal,
    };
    (class, [from, to])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root(lo: f64, hi: f64, is_sure: bool) -> Root {
        Root { t: [lo, hi], square: [0.0; 2], is_sure, is_double: false }
    }

    #[test]
    fn what_may_lie_before_makes_a_root_undecided() {
        let range = [0.0, 9.0];
        let of = |roots: &[Root]| first(roots, range);
        assert_eq!(of(&[]), (Class::None, [f64::INFINITY; 2]));
        let (near, far) = (root(1.0, 1.0 + 1e-12, true), root(2.0, 2.0, true));
        assert_eq!(of(&[far, near]), (Class::Transversal, near.t));
        let maybe = root(0.5, 0.5, false);
        assert_eq!(of(&[far, maybe, near]), (Class::Undecidable, [0.5, 1.0 + 1e-12]));
        // The same root of a neighbour, on the face that they share.
        let shared = root(1.0 - 1e-13, 1.0, false);
        assert_eq!(of(&[near, shared]), (Class::Transversal, [1.0 - 1e-13, 1.0 + 1e-12]));
        let later = root(1.5, 1.6, false);
        assert_eq!(of(&[near, later]).0, Class::Transversal);
        assert_eq!(of(&[later, maybe]), (Class::Undecidable, [0.5, 1.6]));
        let touch = Root { is_double: true, ..near };
        assert_eq!(of(&[touch, far]).0, Class::Tangential);
    }
}
