//! Two surfaces that meet in a sharp edge (\[stoll2006\] Fig. 8).

use glam::DVec3;
use zeroset_raycast::HalfSpace;

use super::quadratic::Quadratic;
use super::samples::Sample;

/// Normals whose product is less are those of two sides.
const SHARP: f64 = 0.9;
/// Two sides whose normals are further apart than this are two sheets.
const FOLDED: f64 = -0.9;
/// Normals of a side whose product with its mean is less are those of a third, as at the corner of a cube.
const SPREAD: f64 = 0.5;
/// Points that a side needs.
const LEAST: usize = 3;

/// Two surfaces, each on its side of a plane through the ball, in radii about the ball's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crease {
    sides: [Quadratic; 2],
    /// A point of the plane.
    at: DVec3,
    /// The plane's normal; it points to the first side.
    normal: DVec3,
}

impl Crease {
    /// The two sides of samples whose normals fall in two clusters, with the plane through the line in which
    /// they meet. It contains that line and the mean of the normals: its normal is n1 - n2, or n2 - n1 where
    /// the edge is concave. `None` if there are no two sides, or they do not meet in the ball.
    pub(super) fn fitted(samples: &[Sample]) -> Option<Self> {
        let clusters = clusters(samples)?;
        let fit = |all: &[Sample]| {
            let side = if all.len() < LEAST { None } else { Quadratic::fitted(all) };
            side.filter(|side| all.iter().all(|s| s.n.dot(side.normal()) >= SPREAD))
        };
        let sides = [fit(&clusters[0])?, fit(&clusters[1])?];
        let at = common(&sides)?;
        let normals = [0, 1].map(|i| sides[i].value_and_gradient(at).1.normalize_or_zero());
        let across = (normals[0] - normals[1]).try_normalize()?;
        let mean = |all: &[Sample]| all.iter().map(|s| s.x).sum::<DVec3>() / all.len() as f64;
        let first = across.dot(mean(&clusters[0]) - mean(&clusters[1]));
        Some(Self { sides, at, normal: if first < 0.0 { -across } else { across } })
    }

    /// Taubin's distance of a point from the surface of its side, in radii.
    pub(super) fn distance(&self, x: DVec3) -> f64 {
        let first = self.normal.dot(x - self.at) >= 0.0;
        self.sides[usize::from(!first)].distance(x)
    }

    /// The sides, each with the half-space in which it counts, for a ball of this radius.
    pub(super) fn clipped(&self, radius: f64) -> [(Quadratic, HalfSpace); 2] {
        let offset = radius * self.normal.dot(self.at);
        let [first, second] = self.sides;
        [
            (first, HalfSpace { normal: -self.normal, offset: -offset }),
            (second, HalfSpace { normal: self.normal, offset }),
        ]
    }
}

/// The samples of two sides by their normals, if they have two: by means, from the normal that is furthest
/// from the mean of all and the one that is furthest from that.
fn clusters(samples: &[Sample]) -> Option<[Vec<Sample>; 2]> {
    let furthest = |from: DVec3| {
        let product = |s: &&Sample| s.n.dot(from);
        samples.iter().min_by(|a, b| product(a).total_cmp(&product(b))).map(|s| s.n)
    };
    let all: DVec3 = samples.iter().map(|s| s.n).sum();
    let first = furthest(all)?;
    let mut means = [first, furthest(first)?];
    if means[0].dot(means[1]) >= SHARP {
        return None;
    }
    let mut parts = [Vec::new(), Vec::new()];
    for _ in 0..4 {
        parts = [Vec::new(), Vec::new()];
        for s in samples {
            parts[usize::from(s.n.dot(means[1]) > s.n.dot(means[0]))].push(*s);
        }
        for (mean, part) in means.iter_mut().zip(&parts) {
            *mean = part.iter().map(|s| s.n).sum::<DVec3>().try_normalize()?;
        }
    }
    (FOLDED..SHARP).contains(&means[0].dot(means[1])).then_some(parts)
}

/// The point near the centre that lies on both, by Newton's steps of least length.
fn common(sides: &[Quadratic; 2]) -> Option<DVec3> {
    let mut x = DVec3::ZERO;
    for _ in 0..8 {
        let [(f, g), (f2, g2)] = [0, 1].map(|i| sides[i].value_and_gradient(x));
        let [a, b, d] = [g.dot(g), g.dot(g2), g2.dot(g2)];
        let determinant = a * d - b * b;
        // The step is -(s g + t g2) with both equations met.
        let [s, t] = [(d * f - b * f2) / determinant, (a * f2 - b * f) / determinant];
        x -= s * g + t * g2;
        if !(x.length_squared() <= 4.0) {
            return None;
        }
    }
    let miss = sides.iter().map(|side| side.distance(x)).fold(0.0, f64::max);
    (miss < 1e-6 && x.length_squared() <= 1.0).then_some(x)
}
