//! Surfaces in pieces: quadrics, each in a bound of its own.

use glam::{DMat3, DVec3};

use crate::{Domain, Error, Quadric};

/// The convex set in which a patch's surface counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// A closed ball.
    Ball {
        /// Its centre.
        centre: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// The closed tetrahedron between four points.
    Tetrahedron([DVec3; 4]),
}

/// A closed half-space: n'x <= d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// n; it points out.
    pub normal: DVec3,
    /// d.
    pub offset: f64,
}

/// A quadric in a bound, cut by a plane where a surface has an edge (\[stoll2006\] Fig. 8).
///
/// All of it is given about `origin`, which should lie near: numbers then stay small wherever the patch is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// The origin of all that follows, in space.
    pub origin: DVec3,
    /// The surface.
    pub quadric: Quadric,
    /// Where it counts.
    pub bound: Bound,
    /// Where it counts too, if the surface has an edge here.
    pub clip: Option<HalfSpace>,
}

/// Which sides of a surface are seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// The outside: roots where f falls along the ray, or stays.
    Front,
    /// Both.
    Both,
}

/// How the hits of patches become one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Blending {
    /// The first counts.
    None,
    /// Those that belong to the first sheet count by their weights, \[stoll2006\] Section 5.1.1. A hit
    /// belongs to it if it lies no further along the ray, in units of space, than any hit of the ray plus
    /// `offset` radii of that hit's ball. The answer is at the mean of t by the weights [`weight`].
    Weighted {
        /// In radii.
        offset: f64,
    },
}

/// A surface in pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Patches {
    patches: Vec<Patch>,
    sides: Sides,
    blending: Blending,
}

/// The weight of a hit at distance d from its ball's centre, in radii: exp(-4 d^2) for d < 1/2, then
/// (4/e) (1 - d)^2, and 0 from 1 on. It and its slope are continuous; \[stoll2006\] asks for a Gaussian, then
/// a quadratic, from 1 to 0, which leaves no other choice with a slope of 0 at the end.
pub fn weight(d: f64) -> f64 {
    if d < 0.5 {
        (-4.0 * d * d).exp()
    } else if d < 1.0 {
        4.0 / std::f64::consts::E * (1.0 - d).powi(2)
    } else {
        0.0
    }
}

impl Bound {
    /// The least and the greatest corner of its box.
    pub fn corners(&self) -> [DVec3; 2] {
        match *self {
            Self::Ball { centre, radius } => [centre - radius, centre + radius],
            Self::Tetrahedron(p) => {
                let least = p.into_iter().fold(DVec3::INFINITY, DVec3::min);
                [least, p.into_iter().fold(DVec3::NEG_INFINITY, DVec3::max)]
            }
        }
    }

    /// A ball around it: centre and radius.
    pub fn ball(&self) -> (DVec3, f64) {
        match *self {
            Self::Ball { centre, radius } => (centre, radius),
            Self::Tetrahedron(p) => {
                let centre = 0.25 * (p[0] + p[1] + p[2] + p[3]);
                let square = p.into_iter().map(|p| (p - centre).length_squared());
                (centre, square.fold(0.0, f64::max).sqrt())
            }
        }
    }

    fn fault(&self) -> Option<&'static str> {
        match *self {
            Self::Ball { centre, radius } => match radius {
                r if !(centre.is_finite() && r.is_finite()) => Some("a ball that is not finite"),
                r if !(r > 0.0) => Some("a ball whose radius is not above 0"),
                _ => None,
            },
            Self::Tetrahedron(p) => {
                if !p.iter().all(|p| p.is_finite()) {
                    return Some("a tetrahedron that is not finite");
                }
                let sides = DMat3::from_cols(p[1] - p[0], p[2] - p[0], p[3] - p[0]);
                (sides.determinant() == 0.0).then_some("a tetrahedron without volume")
            }
        }
    }
}

impl Patch {
    fn fault(&self) -> Option<&'static str> {
        let [min, max] = self.corners();
        if !(self.origin.is_finite() && self.quadric.is_finite()) {
            return Some("a number that is not finite");
        }
        if !self.clip.is_none_or(|h| h.normal.length().is_normal() && h.offset.is_finite()) {
            return Some("a clipping plane without a direction");
        }
        let fault = self.bound.fault();
        fault.or((!(min.is_finite() && max.is_finite())).then_some("a bound out of range"))
    }

    /// The least and the greatest corner of a box in space that holds the bound, however sums were rounded.
    pub fn corners(&self) -> [DVec3; 2] {
        let [min, max] = self.bound.corners();
        let size = match self.bound {
            Bound::Ball { centre, radius } => centre.abs() + radius,
            Bound::Tetrahedron(_) => min.abs().max(max.abs()),
        };
        let margin = 4.0 * f64::EPSILON * (size + self.origin.abs());
        [self.origin + min - margin, self.origin + max + margin]
    }
}

impl Patches {
    /// Patches that are seen and blended as asked. Of each A the symmetric part counts, which is all that f
    /// depends on.
    ///
    /// # Errors
    /// If there are none, one has numbers that are not finite, a bound that is empty or a clipping plane
    /// without a direction, or tetrahedra are to be blended.
    pub fn new(mut patches: Vec<Patch>, sides: Sides, blending: Blending) -> Result<Self, Error> {
        for DMat3 { x_axis: x, y_axis: y, z_axis: z } in
            patches.iter_mut().map(|p| &mut p.quadric.a)
        {
            for (a, b) in [(&mut x.y, &mut y.x), (&mut y.z, &mut z.y), (&mut z.x, &mut x.z)] {
                let mean = a.midpoint(*b);
                (*a, *b) = (mean, mean);
            }
        }
        if patches.is_empty() {
            return Err(Error::Patches("a surface without patches".into()));
        }
        for (i, patch) in patches.iter().enumerate() {
            let is_ball = matches!(patch.bound, Bound::Ball { .. });
            let fault = patch.fault();
            let why = match blending {
                Blending::Weighted { .. } if !is_ball => fault.or(Some("no ball, but is blended")),
                _ => fault,
            };
            if let Some(why) = why {
                return Err(Error::Patches(format!("patch {i} has {why}")));
            }
        }
        if let Blending::Weighted { offset } = blending
            && !(offset >= 0.0 && offset.is_finite())
        {
            return Err(Error::Patches(format!(
                "the offset {offset} of blending is below 0, or not finite"
            )));
        }
        Ok(Self { patches, sides, blending })
    }

    /// The patches.
    pub fn all(&self) -> &[Patch] {
        &self.patches
    }

    /// Which sides are seen.
    pub fn sides(&self) -> Sides {
        self.sides
    }

    /// How hits become one.
    pub fn blending(&self) -> Blending {
        self.blending
    }

    /// The least box of all bounds, a little larger: no root of a patch lies outside.
    pub fn domain(&self) -> Domain {
        let mut corners = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for patch in &self.patches {
            let [least, most] = patch.corners();
            corners = [corners[0].min(least), corners[1].max(most)];
        }
        let margin = 1e-6 * (corners[1] - corners[0]).max_element() + f64::MIN_POSITIVE;
        Domain { min: corners[0] - margin, max: corners[1] + margin, ball: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadric::Coefficients;

    fn unit_sphere() -> Quadric {
        Coefficients { constant: -1.0, xx: 1.0, yy: 1.0, zz: 1.0, ..Default::default() }.into()
    }

    fn patch(bound: Bound) -> Patch {
        Patch { origin: DVec3::new(10.0, 0.0, -5.0), quadric: unit_sphere(), bound, clip: None }
    }

    #[test]
    fn weights_are_smooth_and_end() {
        let expected = [(0.0, 1.0), (0.25, 0.778_800_8), (0.5, 0.367_879_4), (0.75, 0.091_969_9)];
        for (d, w) in expected {
            assert!((weight(d) - w).abs() < 5e-8, "{d}");
        }
        assert_eq!([1.0, 1.5, f64::NAN].map(weight), [0.0; 3]);
        let slope = |d: f64| (weight(d + 1e-7) - weight(d - 1e-7)) / 2e-7;
        for d in [0.5, 1.0] {
            let [before, after] = [slope(d - 1e-6), slope(d + 1e-6)];
            assert!((before - after).abs() < 1e-4, "{d}: {before} {after}");
        }
    }

    #[test]
    fn the_domain_holds_all_bounds() {
        let ball = Bound::Ball { centre: DVec3::X, radius: 2.0 };
        let tetrahedron =
            Bound::Tetrahedron([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.0, 0.0, -7.0)]);
        let all = vec![patch(ball), patch(tetrahedron)];
        let patches = Patches::new(all, Sides::Both, Blending::None).unwrap();
        let Domain { min, max, ball: None } = patches.domain() else { panic!("a ball") };
        assert!((min - DVec3::new(9.0, -2.0, -12.0)).abs().max_element() < 1e-4);
        assert!((max - DVec3::new(13.0, 2.0, -3.0)).abs().max_element() < 1e-4);
        assert!(min.x < 9.0 && max.x > 13.0);
        for bound in [ball, tetrahedron] {
            let (centre, radius) = bound.ball();
            let [least, most] = bound.corners();
            assert!((least - centre).abs().max_element() <= radius + 1e-12);
            assert!((most - centre).abs().max_element() <= radius + 1e-12);
        }
    }

    #[test]
    fn boxes_hold_bounds_whose_places_cancel() {
        let bound = Bound::Ball { centre: DVec3::new(-1e12, 0.0, 0.0), radius: 1e-5 };
        let patch = Patch { origin: DVec3::new(1e12, 0.0, 0.0), ..patch(bound) };
        let [min, max] = patch.corners();
        assert!(min.x < -1e-5 && max.x > 1e-5, "{min} {max}");
        let Domain { min, max, .. } =
            Patches::new(vec![patch], Sides::Both, Blending::None).unwrap().domain();
        assert!(min.x < -1e-5 && max.x > 1e-5, "{min} {max}");
    }

    #[test]
    fn the_symmetric_part_counts() {
        let ball = Bound::Ball { centre: DVec3::ZERO, radius: 1.0 };
        let mut skewed = patch(ball);
        skewed.quadric.a.y_axis.x = 2.0;
        let patches = Patches::new(vec![skewed], Sides::Both, Blending::None).unwrap();
        let quadric = patches.all()[0].quadric;
        assert_eq!(quadric.a, quadric.a.transpose());
        let p = DVec3::new(0.3, -0.7, 0.2);
        assert!((quadric.value(p) - skewed.quadric.value(p)).abs() < 1e-15);
    }

    #[test]
    fn what_is_no_patch_is_refused() {
        let ball = |radius: f64| Bound::Ball { centre: DVec3::ZERO, radius };
        let refused = |patches: Vec<Patch>, blending| {
            Patches::new(patches, Sides::Front, blending).unwrap_err().to_string()
        };
        let flat = Bound::Tetrahedron([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y]);
        for (bound, why) in [
            (ball(0.0), "radius is not above 0"),
            (ball(f64::NAN), "not finite"),
            (Bound::Tetrahedron([DVec3::NAN; 4]), "not finite"),
            (flat, "without volume"),
        ] {
            let said = refused(vec![patch(ball(1.0)), patch(bound)], Blending::None);
            assert!(said.contains("patch 1") && said.contains(why), "{said}");
        }
        assert!(refused(Vec::new(), Blending::None).contains("without patches"));
        let infinite = Patch { quadric: unit_sphere().scaled(f64::INFINITY), ..patch(ball(1.0)) };
        assert!(refused(vec![infinite], Blending::None).contains("not finite"));
        let cut = |normal| {
            let clip = Some(HalfSpace { normal, offset: 1.0 });
            refused(vec![Patch { clip, ..patch(ball(1.0)) }], Blending::None)
        };
        for normal in [DVec3::ZERO, 1e-200 * DVec3::X, 1e200 * DVec3::X, DVec3::NAN] {
            assert!(cut(normal).contains("without a direction"), "{normal}");
        }
        let far = Patch { origin: DVec3::splat(f64::MAX), ..patch(ball(f64::MAX)) };
        assert!(refused(vec![far], Blending::None).contains("out of range"));
        let blended = Blending::Weighted { offset: 0.5 };
        let solid = Bound::Tetrahedron([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]);
        assert!(refused(vec![patch(solid)], blended).contains("blended"));
        let backwards = Blending::Weighted { offset: -1.0 };
        assert!(refused(vec![patch(ball(1.0))], backwards).contains("offset"));
    }
}
