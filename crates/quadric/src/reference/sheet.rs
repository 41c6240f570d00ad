//! The mean of the first sheet, enclosed.

use zeroset_cpu::Class;
use zeroset_ia::{Interval, Number, Set, Unary};
use zeroset_raycast::{Bound, Patches, Ray};

use super::root::{self, Root};
use super::{Found, is_narrow};
use crate::hierarchy::Hierarchy;

type I = Interval<f64, Set>;

/// A root of a ball, and how much further along t the same sheet may lie.
#[derive(Clone, Copy, Debug)]
struct Part {
    root: Root,
    reach: I,
}

pub(super) fn find(
    patches: &Patches,
    hierarchy: &Hierarchy,
    ray: Ray,
    range: [f64; 2],
    offset: f64,
) -> Found {
    let (mut parts, mut work, mut end) = (Vec::new(), 0, range[1]);
    let [x, y, z] = ray.direction.as_dvec3().to_array().map(|x| I::point(x).sqr());
    let speed = (x + y + z).unary(Unary::Sqrt);
    hierarchy.walk(ray, range, |index| {
        let patch = &patches.all()[index];
        let (roots, solved) = root::roots(patch, patches.sides(), ray, range);
        work += solved;
        if let Bound::Ball { radius, .. } = patch.bound {
            let reach = I::point(offset) * I::point(radius) / speed;
            for root in roots {
                if root.is_sure {
                    end = end.min((I::point(root.t[1]) + reach).hi);
                }
                parts.push(Part { root, reach });
            }
        }
        end
    });
    let (class, bracket) = mean(&parts);
    (class, bracket, work)
}

fn mean(parts: &[Part]) -> (Class, [f64; 2]) {
    if parts.is_empty() {
        return (Class::None, [f64::INFINITY; 2]);
    }
    // Where the sheet ends: between the ends by all roots and by those that surely are.
    let ends = |part: &Part| I::new(part.root.t[0], part.root.t[1]) + part.reach;
    let earliest = parts.iter().map(|p| ends(p).lo).fold(f64::INFINITY, f64::min);
    let sure = parts.iter().filter(|p| p.root.is_sure);
    let latest = sure.map(|p| ends(p).hi).fold(f64::INFINITY, f64::min);
    let belonging: Vec<&Part> = parts.iter().filter(|p| p.root.t[0] <= latest).collect();
    let start = belonging.iter().map(|p| p.root.t[0]).fold(f64::INFINITY, f64::min);
    let most = belonging.iter().map(|p| p.root.t[1]).fold(f64::NEG_INFINITY, f64::max);
    let (mut total, mut moment) = (I::point(0.0), I::point(0.0));
    for part in &belonging {
        let Root { t, square, is_sure, .. } = part.root;
        let mut w = weight(square);
        if !is_sure || t[1] > earliest {
            // It may not belong.
            w = I::new(0.0, w.hi);
        }
        total = total + w;
        moment = moment + w * (I::new(t[0], t[1]) - I::point(start));
    }
    // A mean lies among what it is made of.
    let hull = [start, most];
    if !(total.lo > 0.0) {
        return (Class::Undecidable, hull);
    }
    let t = I::point(start) + moment / total;
    let bracket = [t.lo.max(hull[0]), t.hi.min(hull[1])];
    let is_narrow = is_narrow(bracket);
    let is_double = belonging.iter().any(|p| p.root.is_double);
    let class = match (is_narrow, is_double) {
        (false, _) => Class::Undecidable,
        (true, true) => Class::Tangential,
        (true, false) => Class::Transversal,
    };
    (class, bracket)
}

/// Encloses [`weight`](zeroset_raycast::patches::weight), which falls, over a range of the squared distance.
fn weight([near, far]: [f64; 2]) -> I {
    let at = |square: f64| {
        let square = I::point(square.clamp(0.0, 1.0));
        let inner = (I::point(-4.0) * square).unary(Unary::Exp);
        let distance = square.unary(Unary::Sqrt);
        let four = I::point(4.0) / I::point(1.0).unary(Unary::Exp);
        let outer = four * (I::point(1.0) - distance).sqr();
        match square {
            square if square.hi < 0.25 => inner,
            square if square.lo > 0.25 => outer,
            _ => I::new(inner.lo.min(outer.lo), inner.hi.max(outer.hi)),
        }
    };
    I::new(at(far).lo.max(0.0), at(near).hi)
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_raycast::patches;

    fn part(t: f64, square: f64, reach: f64, is_sure: bool) -> Part {
        let root = Root { t: [t, t], square: [square; 2], is_sure, is_double: false };
        Part { root, reach: I::point(reach) }
    }

    #[test]
    fn weights_are_enclosed() {
        for i in 0..=1000 {
            let d = f64::from(i) / 1000.0;
            let (square, w) = (d * d, patches::weight(d));
            let enclosed = weight([square * (1.0 - 1e-15), square * (1.0 + 1e-15)]);
            assert!(enclosed.lo <= w && w <= enclosed.hi, "{d}: {w} {enclosed:?}");
            assert!(enclosed.hi - enclosed.lo < 1e-13, "{d}: {enclosed:?}");
        }
    }

    #[test]
    fn what_may_belong_widens_the_mean() {
        let (a, b) = (part(10.0, 0.0, 0.5, true), part(10.25, 0.25, 0.5, true));
        let (class, [lo, hi]) = mean(&[a, b]);
        let w = (-1.0_f64).exp();
        let t = 10.0 + 0.25 * w / (1.0 + w);
        assert_eq!(class, Class::Transversal);
        assert!(lo <= t && t <= hi && hi - lo < 1e-12, "{lo} {t} {hi}");
        let (class, [lo, hi]) = mean(&[a, part(10.25, 0.25, 0.5, false)]);
        assert_eq!((class, lo), (Class::Undecidable, 10.0));
        assert!(hi >= t && hi < 10.25);
        // Exactly at the end it may be rounded either way; well behind it does not count.
        assert_eq!(mean(&[a, part(10.5 + 1e-9, 0.0, 0.5, false)]).0, Class::Transversal);
        // At the edge of a ball the weight is next to nothing.
        assert_eq!(mean(&[a, part(10.25, 1.0, 0.5, false)]).0, Class::Transversal);
        assert_eq!(mean(&[part(10.0, 0.5, 0.5, false)]), (Class::Undecidable, [10.0; 2]));
        assert_eq!(mean(&[]).0, Class::None);
    }
}
