//! A height over a plane, fitted to points.

use glam::{DMat3, DVec3};
use zeroset_raycast::Quadric;

use super::samples::Sample;

/// Monomials of a height of degree two: 1, u, v, u^2, u v, v^2.
const TERMS: usize = 6;

/// What is added to the diagonal of the normal equations, in means of that diagonal. It keeps points on a line
/// or in too small a number from leaving a coefficient open.
const RIDGE: f64 = 1e-9;

/// The surface h = p(u, v) over a plane through a ball's centre, in radii. The outside is where h > p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Quadratic {
    /// The axes of u, v and h.
    axes: DMat3,
    /// The coefficients of p.
    k: [f64; TERMS],
}

impl Quadratic {
    /// The least squares of w (h - p)^2 over the plane of the mean normal; a flat one through the mean height
    /// where there are too few points for more. Where normals cancel out, that of the heaviest point counts.
    /// `None` if no point has a weight.
    pub(super) fn fitted(samples: &[Sample]) -> Option<Self> {
        let heaviest = samples.iter().max_by(|a, b| a.w.total_cmp(&b.w))?;
        let mean = samples.iter().map(|s| s.w * s.n).sum::<DVec3>();
        let normal = mean.try_normalize().unwrap_or(heaviest.n);
        let (u, v) = normal.any_orthonormal_pair();
        let axes = DMat3::from_cols(u, v, normal);
        let mut upper = [[0.0; TERMS]; TERMS];
        let mut right = [0.0; TERMS];
        for s in samples {
            let DVec3 { x: u, y: v, z: h } = axes.transpose() * s.x;
            let terms = [1.0, u, v, u * u, u * v, v * v];
            for i in 0..TERMS {
                let weighted = s.w * terms[i];
                right[i] += weighted * h;
                for j in i..TERMS {
                    upper[i][j] += weighted * terms[j];
                }
            }
        }
        let flat = [right[0] / upper[0][0], 0.0, 0.0, 0.0, 0.0, 0.0];
        let curved = if samples.len() < TERMS { None } else { solved(upper, right) };
        let k = curved.unwrap_or(flat);
        k.iter().all(|k| k.is_finite()).then_some(Self { axes, k })
    }

    /// The normal of the plane.
    pub(super) fn normal(&self) -> DVec3 {
        self.axes.z_axis
    }

    /// h - p and its gradient at a point in radii about the centre.
    pub(super) fn value_and_gradient(&self, x: DVec3) -> (f64, DVec3) {
        let DVec3 { x: u, y: v, z: h } = self.axes.transpose() * x;
        let [k00, k10, k01, k20, k11, k02] = self.k;
        let value = h - (k00 + u * (k10 + u * k20 + v * k11) + v * (k01 + v * k02));
        let slope =
            DVec3::new(-(k10 + 2.0 * u * k20 + v * k11), -(k01 + 2.0 * v * k02 + u * k11), 1.0);
        (value, self.axes * slope)
    }

    /// Taubin's distance |f| / |grad f| of a point, in radii.
    pub(super) fn distance(&self, x: DVec3) -> f64 {
        let (value, gradient) = self.value_and_gradient(x);
        value.abs() / gradient.length()
    }

    /// The same surface as a quadric about the ball's centre, for a ball of this radius:
    /// f = r (h - p) with (u, v, h) = axes' x / r.
    pub(super) fn quadric(&self, radius: f64) -> Quadric {
        let [k00, k10, k01, k20, k11, k02] = self.k;
        let DMat3 { x_axis: u, y_axis: v, z_axis: n } = self.axes;
        let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
        let cross = outer(u, v) + outer(v, u);
        Quadric {
            a: (k20 * outer(u, u) + (0.5 * k11) * cross + k02 * outer(v, v)) * (-1.0 / radius),
            b: 0.5 * (n - k10 * u - k01 * v),
            c: -radius * k00,
        }
    }
}

/// The solution of the normal equations with a ridge, by Cholesky's factors; only the upper triangle is used.
fn solved(mut m: [[f64; TERMS]; TERMS], mut x: [f64; TERMS]) -> Option<[f64; TERMS]> {
    let ridge = RIDGE * (0..TERMS).map(|i| m[i][i]).sum::<f64>() / TERMS as f64;
    for (i, row) in m.iter_mut().enumerate() {
        row[i] += ridge;
    }
    // m = R'R, then R'y = x and R z = y.
    for i in 0..TERMS {
        for k in 0..i {
            let above = m[k];
            m[i].iter_mut().zip(above).for_each(|(r, a)| *r -= above[i] * a);
            x[i] -= above[i] * x[k];
        }
        let pivot = m[i][i];
        if !(pivot > 0.0) {
            return None;
        }
        let scale = 1.0 / pivot.sqrt();
        m[i][i..].iter_mut().for_each(|r| *r *= scale);
        x[i] *= scale;
    }
    for i in (0..TERMS).rev() {
        for j in i + 1..TERMS {
            x[i] -= m[i][j] * x[j];
        }
        x[i] /= m[i][i];
    }
    x.iter().all(|x| x.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples with the heights of p over a plane with some normal.
    fn samples(places: &[[f64; 2]], p: impl Fn(f64, f64) -> f64) -> (DMat3, Vec<Sample>) {
        let n = DVec3::new(0.48, -0.6, 0.64);
        let (u, v) = n.any_orthonormal_pair();
        let axes = DMat3::from_cols(u, v, n);
        let sample = |&[u, v]: &[f64; 2]| Sample {
            x: axes * DVec3::new(u, v, p(u, v)),
            n,
            w: 1.0 - 0.5 * (u * u + v * v),
        };
        (axes, places.iter().map(sample).collect())
    }

    fn grid() -> Vec<[f64; 2]> {
        (0..25).map(|i| [i % 5, i / 5].map(|i| f64::from(i) / 3.0 - 0.6)).collect()
    }

    #[test]
    fn a_quadratic_is_found_again() {
        let k = [0.1, -0.2, 0.3, 0.4, -0.5, 0.6];
        let p = |u: f64, v: f64| {
            k[0] + k[1] * u + k[2] * v + k[3] * u * u + k[4] * u * v + k[5] * v * v
        };
        let (axes, all) = samples(&grid(), p);
        let fit = Quadratic::fitted(&all).unwrap();
        assert!(fit.axes.abs_diff_eq(axes, 1e-12));
        for (found, k) in fit.k.iter().zip(k) {
            assert!((found - k).abs() < 1e-7, "{fit:?}");
        }
        let radius = 3.0;
        let quadric = fit.quadric(radius);
        for s in &all {
            assert!(fit.distance(s.x) < 1e-7);
            // Off the surface too the quadric is r (h - p), with its gradient.
            let x = s.x + 0.2 * axes.z_axis + DVec3::splat(0.05);
            let (value, gradient) = fit.value_and_gradient(x);
            assert!((quadric.value(radius * x) - radius * value).abs() < 1e-12);
            assert!((2.0 * quadric.half_gradient(radius * x) - gradient).length() < 1e-12);
        }
    }

    #[test]
    fn weights_decide_where_points_disagree() {
        let (axes, mut all) = samples(&grid(), |_, _| 0.0);
        let mut doubled = all.clone();
        for (a, b) in all.iter_mut().zip(&mut doubled) {
            (a.w, b.w) = (3.0, 1.0);
            b.x += 0.4 * axes.z_axis;
        }
        all.extend(doubled);
        let fit = Quadratic::fitted(&all).unwrap();
        assert!((fit.k[0] - 0.1).abs() < 1e-7, "{fit:?}");
    }

    #[test]
    fn poor_samples_give_finite_fits() {
        let line: Vec<[f64; 2]> = (0..12).map(|i| [f64::from(i) / 11.0, 0.0]).collect();
        for places in [&line[..], &line[..1], &line[..5], &[[0.5, 0.5]; 9]] {
            let (_, all) = samples(places, |u, _| 0.1 * u);
            let fit = Quadratic::fitted(&all).unwrap();
            assert!(fit.k.iter().all(|k| k.abs() < 1.0), "{fit:?}");
        }
        let (_, mut all) = samples(&grid(), |_, _| 0.0);
        let opposed = all.clone().into_iter().map(|s| Sample { n: -s.n, ..s });
        all.extend(opposed);
        assert!(Quadratic::fitted(&all).is_some());
        assert_eq!(Quadratic::fitted(&[]), None);
        all.iter_mut().for_each(|s| s.w = 0.0);
        assert_eq!(Quadratic::fitted(&all), None);
    }
}
