//! A patch as rays are cast at it, in single or in double precision.

use glam::{DMat3, DVec3};
use num_traits::Float;
use zeroset_raycast::{Bound, HalfSpace, Patch, Quadric, Ray};

use crate::equation::{Equation, Roots};

/// The formulas for where a ray meets a quadric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Formula {
    /// About the point of the ray that is nearest to the patch, and roots without cancellation.
    Local,
    /// \[stoll2006\] Eq. 7 about the eye, with a case for small alpha.
    Quotient,
    /// \[stoll2006\] Eq. 15 about the eye.
    Reciprocal,
}

/// A vector.
type V<T> = [T; 3];

/// A root of a patch in its bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    pub(crate) t: f64,
    /// The gradient, of any length.
    pub(crate) gradient: DVec3,
    /// The distance from the ball's centre in radii; 0 in a tetrahedron.
    pub(crate) distance: f64,
}

/// A patch in numbers of one precision, about its own origin, or about the world's for the paper's formulas.
#[derive(Clone, Debug)]
pub(crate) struct Piece<T> {
    origin: DVec3,
    /// A point that is near all of it.
    centre: DVec3,
    a: [V<T>; 3],
    b: V<T>,
    c: T,
    cuts: Vec<Cut<T>>,
    ball: Option<Ball<T>>,
    formula: Formula,
}

/// n'x <= d.
#[derive(Clone, Copy, Debug)]
struct Cut<T> {
    normal: V<T>,
    offset: T,
}

#[derive(Clone, Copy, Debug)]
struct Ball<T> {
    centre: V<T>,
    radius: T,
}

/// How far beyond a plane a root still counts, in units of rounding of the patch's size and of its distance
/// from the eye: neighbours that share a face overlap by that, so that no ray falls between.
const MARGIN: f64 = 64.0;

fn number<T: Float>(x: f64) -> T {
    T::from(x).expect("every float has it")
}

fn vector<T: Float>(v: DVec3) -> V<T> {
    v.to_array().map(number)
}

fn dot<T: Float>(a: V<T>, b: V<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// x + s y.
fn along<T: Float>(x: V<T>, s: T, y: V<T>) -> V<T> {
    [0, 1, 2].map(|i| x[i] + s * y[i])
}

impl<T: Float> Piece<T> {
    pub(crate) fn new(patch: &Patch, formula: Formula) -> Self {
        let (middle, size) = patch.bound.ball();
        // The paper's formulas take all numbers in space.
        let (origin, shift) = match formula {
            Formula::Local => (patch.origin, DVec3::ZERO),
            Formula::Quotient | Formula::Reciprocal => (DVec3::ZERO, patch.origin),
        };
        let quadric = match formula {
            Formula::Local => balanced(&patch.quadric, size),
            Formula::Quotient | Formula::Reciprocal => patch.quadric.about(-shift),
        };
        let margin = MARGIN * T::epsilon().to_f64().unwrap_or(0.0) * (size + shift.length());
        let cut = |plane: HalfSpace| {
            let length = plane.normal.length();
            let normal = plane.normal / length;
            Cut {
                normal: vector(normal),
                offset: number(plane.offset / length + normal.dot(shift) + margin),
            }
        };
        let (cuts, ball) = match patch.bound {
            Bound::Ball { centre, radius } => {
                (Vec::new(), Some(Ball { centre: vector(centre + shift), radius: number(radius) }))
            }
            Bound::Tetrahedron(corners) => (faces(corners).map(cut).to_vec(), None),
        };
        let columns = DMat3::to_cols_array_2d(&quadric.a);
        Self {
            origin,
            centre: middle + patch.origin - origin,
            a: columns.map(|column| column.map(number)),
            b: vector(quadric.b),
            c: number(quadric.c),
            cuts: cuts.into_iter().chain(patch.clip.map(cut)).collect(),
            ball,
            formula,
        }
    }

    /// Where a ray enters the inside within the bound, and where it leaves it.
    pub(crate) fn crossings(&self, ray: Ray) -> [Option<Crossing>; 2] {
        // Along a unit direction squares neither overflow nor vanish.
        let speed = ray.direction.as_dvec3().length();
        let direction = ray.direction.as_dvec3() / speed;
        let eye = ray.origin.as_dvec3() - self.origin;
        // t of the point that the equation is about.
        let start = match self.formula {
            Formula::Local => (self.centre - eye).dot(direction) / direction.length_squared(),
            Formula::Quotient | Formula::Reciprocal => 0.0,
        };
        let (point, d) = (vector::<T>(eye + start * direction), vector::<T>(direction));
        let [along_d, along_point] = [d, point].map(|v| self.times(v));
        let equation = Equation {
            alpha: dot(d, along_d),
            beta: dot(d, along(along_point, T::one(), self.b)),
            gamma: dot(point, along(along_point, number(2.0), self.b)) + self.c,
        };
        let roots: Roots<T> = match self.formula {
            Formula::Local => equation.roots(),
            Formula::Quotient => equation.roots_by_quotient(),
            Formula::Reciprocal => equation.roots_by_reciprocal(),
        };
        roots.map(|root| {
            let t = root?;
            let x = along(point, t, d);
            let distance = self.place(x)?;
            let half = along(along(along_point, T::one(), self.b), t, along_d);
            let gradient = DVec3::from(half.map(|g| g.to_f64().unwrap_or(f64::NAN)));
            Some(Crossing {
                t: (start + t.to_f64()?) / speed,
                gradient,
                distance: distance.to_f64()?,
            })
        })
    }

    /// Half the gradient of x'A x.
    fn times(&self, x: V<T>) -> V<T> {
        self.a.map(|row| dot(row, x))
    }

    /// The distance from the ball's centre in radii; none outside the bound.
    fn place(&self, x: V<T>) -> Option<T> {
        if !self.cuts.iter().all(|cut| dot(cut.normal, x) <= cut.offset) {
            return None;
        }
        let Some(Ball { centre, radius }) = self.ball else { return Some(T::zero()) };
        // In radii: squares of lengths may be out of range.
        let away = along(x, -T::one(), centre).map(|x| x / radius);
        let distance = dot(away, away).sqrt();
        (distance <= T::one()).then_some(distance)
    }
}

/// The quadric times a power of two, so that its terms in a bound of that size are about as large as the size:
/// f and 1000 f have the same zeros in single precision, too.
pub(crate) fn balanced(quadric: &Quadric, size: f64) -> Quadric {
    let of = |m: DMat3| m.to_cols_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let Quadric { a, b, c } = quadric;
    let largest = (of(*a) * size).max(b.abs().max_element()).max(c.abs() / size);
    // A power of two changes no digit.
    let scale = largest.log2().round().clamp(-900.0, 900.0).exp2().recip();
    if largest > 0.0 { quadric.scaled(scale) } else { *quadric }
}

/// The half-spaces whose common part is the tetrahedron.
pub(crate) fn faces(corners: [DVec3; 4]) -> [HalfSpace; 4] {
    [0, 1, 2, 3].map(|i| {
        let [p, q, r] = [1, 2, 3].map(|k| corners[(i + k) % 4]);
        let normal = (q - p).cross(r - p);
        // The corner across is inside.
        let outward = if normal.dot(corners[i] - p) > 0.0 { -normal } else { normal };
        HalfSpace { normal: outward, offset: outward.dot(p) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use zeroset_raycast::quadric::Coefficients;

    fn sphere(origin: DVec3, bound: Bound) -> Patch {
        let quadric: Quadric =
            Coefficients { constant: -1.0, xx: 1.0, yy: 1.0, zz: 1.0, ..Default::default() }.into();
        Patch { origin, quadric, bound, clip: None }
    }

    const FORMULAS: [Formula; 3] = [Formula::Local, Formula::Quotient, Formula::Reciprocal];

    #[test]
    fn a_sphere_is_entered_and_left() {
        let ball = Bound::Ball { centre: DVec3::ZERO, radius: 2.0 };
        let patch = sphere(DVec3::new(5.0, 0.0, 0.0), ball);
        let ray = Ray::new(Vec3::ZERO, Vec3::new(0.5, 0.0, 0.0));
        for formula in FORMULAS {
            let [enters, leaves] = Piece::<f64>::new(&patch, formula).crossings(ray);
            let (enters, leaves) = (enters.unwrap(), leaves.unwrap());
            for (crossing, t, normal) in [(enters, 8.0, DVec3::NEG_X), (leaves, 12.0, DVec3::X)] {
                assert!((crossing.t - t).abs() < 1e-13, "{formula:?}: {crossing:?}");
                assert!(
                    (crossing.gradient.normalize() - normal).length() < 1e-13,
                    "{formula:?}: {crossing:?}"
                );
                assert!((crossing.distance - 0.5).abs() < 1e-13, "{formula:?}: {crossing:?}");
            }
            let away = Ray::new(Vec3::Y * 4.0, Vec3::X);
            assert_eq!(Piece::<f32>::new(&patch, formula).crossings(away), [None; 2]);
        }
    }

    #[test]
    fn bounds_and_clips_cut() {
        let tetrahedron = Bound::Tetrahedron([
            DVec3::new(-3.0, -3.0, -3.0),
            DVec3::new(3.0, -3.0, -3.0),
            DVec3::new(0.0, 3.0, -3.0),
            DVec3::new(0.0, 0.0, 0.5),
        ]);
        let small = Bound::Ball { centre: DVec3::new(-1.0, 0.0, 0.0), radius: 0.5 };
        let ball = Bound::Ball { centre: DVec3::ZERO, radius: 2.0 };
        let origin = DVec3::new(0.0, 0.0, 7.0);
        let half = HalfSpace { normal: DVec3::new(2.0, 0.0, 0.0), offset: 1.0 };
        let clipped = Patch { clip: Some(half), ..sphere(origin, ball) };
        let along_x = Ray::new(Vec3::new(-4.0, 0.0, 7.0), Vec3::X);
        let up = Ray::new(Vec3::new(0.0, 0.0, 3.0), Vec3::Z);
        for formula in FORMULAS {
            let found = |patch: &Patch, ray| {
                let [a, b] = Piece::<f64>::new(patch, formula).crossings(ray);
                [a.is_some(), b.is_some()]
            };
            assert_eq!(found(&sphere(origin, tetrahedron), up), [true, false], "{formula:?}");
            assert_eq!(found(&sphere(origin, small), along_x), [true, false], "{formula:?}");
            assert_eq!(found(&clipped, along_x), [true, false], "{formula:?}");
            assert_eq!(found(&sphere(origin, ball), along_x), [true, true], "{formula:?}");
        }
    }

    #[test]
    fn f_times_any_factor_has_the_same_zeros() {
        let ball = Bound::Ball { centre: DVec3::ZERO, radius: 2.0 };
        let patch = sphere(DVec3::ZERO, ball);
        let ray = Ray::new(Vec3::new(0.25, 0.5, -3.0), Vec3::new(0.0, 0.1, 0.9));
        let of = |factor: f64| {
            let patch = Patch { quadric: patch.quadric.scaled(factor), ..patch };
            Piece::<f32>::new(&patch, Formula::Local).crossings(ray).map(|c| c.map(|c| c.t))
        };
        for power in [-40, -20, 1, 20, 40] {
            assert_eq!(of(4.0_f64.powi(power)), of(1.0), "{power}");
        }
        let slow = Ray::new(ray.origin, 1e-30 * ray.direction);
        let [Some(enters), _] = Piece::<f32>::new(&patch, Formula::Local).crossings(slow) else {
            panic!("it is hit")
        };
        let t = of(1.0)[0].unwrap();
        assert!((1e-30 * enters.t - t).abs() < 1e-5, "{} {t}", enters.t);
    }

    #[test]
    fn a_tetrahedron_is_between_its_faces() {
        for corners in [
            [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
            [DVec3::X, DVec3::ZERO, DVec3::Y, DVec3::Z],
        ] {
            let inside = |p: DVec3| faces(corners).iter().all(|f| f.normal.dot(p) <= f.offset);
            assert!(inside(DVec3::splat(0.2)) && inside(DVec3::ZERO) && inside(DVec3::X));
            for outside in [DVec3::splat(0.4), DVec3::NEG_X * 0.1, DVec3::new(0.2, 0.2, -0.01)] {
                assert!(!inside(outside), "{outside}");
            }
        }
    }
}
