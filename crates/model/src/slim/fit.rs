//! The quadric of one ball.

use glam::{DAffine3, DMat3, DVec3};
use zeroset_raycast::Quadric;
use zeroset_raycast::patches::weight;
use zeroset_raycast::quadric::Graph;

use super::Ball;
use crate::neighbours::Neighbours;
use crate::points::Cloud;

/// A ball, how well its quadric fits, and the points that it covers.
pub(super) struct Fit {
    pub(super) ball: Ball,
    pub(super) covered: Vec<usize>,
}

/// Neighbours in the smallest ball.
const FEWEST: usize = 10;
/// By how much a ball grows.
const GROWTH: f64 = 1.1;
/// How often a larger ball may fail before it is the last.
const FAILURES: usize = 2;
/// Bisections between the last ball that fits and the first that does not.
const BISECTIONS: usize = 4;

/// The largest ball around a point whose quadric errs by at most `error`, in units of space, and all of whose
/// normals are on one side; the smallest one is kept whatever its error.
pub(super) fn largest(
    cloud: &Cloud,
    near: &Neighbours,
    index: usize,
    error: f64,
    cover: f64,
) -> Fit {
    let centre = cloud.points[index];
    let most = 2.0 * cloud.diagonal().max(f64::MIN_POSITIVE);
    let mut radius = near.distance(centre, FEWEST).clamp(1e-9 * most, most);
    let fit = |radius: f64| Trial::new(cloud, near, centre, radius);
    let is_good = |trial: &Trial| trial.error <= error && trial.is_one_sheet;
    let mut best = fit(radius);
    let mut bad = None;
    if is_good(&best) {
        let mut failures = 0;
        while failures < FAILURES && radius < most {
            radius *= GROWTH;
            let trial = fit(radius);
            if is_good(&trial) {
                (best, bad, failures) = (trial, None, 0);
            } else {
                bad = bad.or(Some(radius));
                // A larger ball has the other sheet, too.
                failures = if trial.is_one_sheet { failures + 1 } else { FAILURES };
            }
        }
    }
    if let Some(mut bad) = bad {
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (best.radius + bad);
            let trial = fit(middle);
            if is_good(&trial) {
                best = trial;
            } else {
                bad = middle;
            }
        }
    }
    let radius = best.radius;
    let covered = near.within(centre, cover * radius).chain([index]).collect();
    let ball = Ball { centre, radius, quadric: best.quadric, clip: None };
    Fit { ball, covered }
}

/// The quadric of a ball of some radius.
struct Trial {
    radius: f64,
    quadric: Quadric,
    /// The weighted root mean square of the distances of its points.
    error: f64,
    /// Are all normals on one side?
    is_one_sheet: bool,
}

impl Trial {
    /// In a frame along the mean normal and in units of the radius, the height h = p(u, v) of degree two that
    /// fits best by weighted least squares; f = r (h - p).
    fn new(cloud: &Cloud, near: &Neighbours, centre: DVec3, radius: f64) -> Self {
        let inside: Vec<(usize, f64)> = near
            .within(centre, radius)
            .map(|i| (i, weight((cloud.points[i] - centre).length() / radius)))
            .collect();
        let sum: DVec3 = inside.iter().map(|(i, w)| *w * cloud.normals[*i]).sum();
        let normal = sum.normalize_or(DVec3::Z);
        let (u, v) = normal.any_orthonormal_pair();
        let local = |i: usize| {
            let d = (cloud.points[i] - centre) / radius;
            [d.dot(u), d.dot(v), d.dot(normal)]
        };
        let mut equations = Equations::default();
        for (i, w) in &inside {
            let [x, y, h] = local(*i);
            equations.add([1.0, x, y, x * x, x * y, y * y], h, *w);
        }
        let [constant, x, y, xx, xy, yy] = equations.solve();
        let graph = Graph { constant, x, y, xx, xy, yy };
        let (mut total, mut squares) = (0.0, 0.0);
        for (i, w) in &inside {
            let [px, py, h] = local(*i);
            let height = constant + px * (x + xx * px + xy * py) + py * (y + yy * py);
            let slope = (x + 2.0 * xx * px + xy * py, y + xy * px + 2.0 * yy * py);
            let steepness = 1.0 + slope.0 * slope.0 + slope.1 * slope.1;
            total += w;
            squares += w * (h - height).powi(2) / steepness;
        }
        let error = if total > 0.0 { radius * (squares / total).sqrt() } else { f64::INFINITY };
        let frame = DMat3::from_cols(radius * u, radius * v, radius * normal);
        let quadric = Quadric::from(graph).mapped(DAffine3::from_mat3(frame)).scaled(radius);
        let is_one_sheet = inside.iter().all(|(i, _)| cloud.normals[*i].dot(normal) >= 0.0);
        Self { radius, quadric, error, is_one_sheet }
    }
}

/// Normal equations of six unknowns.
#[derive(Default)]
struct Equations {
    matrix: [[f64; 6]; 6],
    right: [f64; 6],
}

impl Equations {
    fn add(&mut self, row: [f64; 6], value: f64, weight: f64) {
        for i in 0..6 {
            for k in 0..=i {
                self.matrix[i][k] += weight * row[i] * row[k];
            }
            self.right[i] += weight * row[i] * value;
        }
    }

    /// By Cholesky's method; a little is added to the diagonal, so that what the points do not say becomes 0.
    fn solve(mut self) -> [f64; 6] {
        const RIDGE: f64 = 1e-9;
        let mean = (0..6).map(|i| self.matrix[i][i]).sum::<f64>() / 6.0;
        (0..6).for_each(|i| self.matrix[i][i] += RIDGE * mean + f64::MIN_POSITIVE);
        let m = &mut self.matrix;
        for i in 0..6 {
            for k in 0..=i {
                let sum = m[i][k] - (0..k).map(|j| m[i][j] * m[k][j]).sum::<f64>();
                m[i][k] = if i == k {
                    // Rounding may leave nothing.
                    sum.max(RIDGE * RIDGE * mean + f64::MIN_POSITIVE).sqrt()
                } else {
                    sum / m[k][k]
                };
            }
        }
        let mut x = self.right;
        for i in 0..6 {
            let known: f64 = (0..i).map(|k| m[i][k] * x[k]).sum();
            x[i] = (x[i] - known) / m[i][i];
        }
        for i in (0..6).rev() {
            let known: f64 = (i + 1..6).map(|k| m[k][i] * x[k]).sum();
            x[i] = (x[i] - known) / m[i][i];
        }
        if x.iter().all(|x| x.is_finite()) { x } else { [0.0; 6] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_paraboloid_is_found_again() {
        let height = |x: f64, y: f64| 0.1 + 0.2 * x - 0.3 * y + 0.5 * x * x + 0.25 * x * y - y * y;
        let (mut points, mut normals) = (Vec::new(), Vec::new());
        for i in 0..20 {
            for k in 0..20 {
                let (x, y) = (0.02 * f64::from(i) - 0.2, 0.02 * f64::from(k) - 0.2);
                points.push(DVec3::new(x, y, height(x, y)));
                normals.push(DVec3::new(-0.2 - x, 0.3 + 2.0 * y, 1.0).normalize());
            }
        }
        let near = Neighbours::new(&points);
        let cloud = Cloud { points, normals };
        let index = 10 * 20 + 10;
        let centre = cloud.points[index];
        let trial = Trial::new(&cloud, &near, centre, 0.1);
        // A height along the mean normal is no height along z, but nearly so.
        assert!(trial.error < 5e-5 && trial.is_one_sheet, "{}", trial.error);
        for p in &cloud.points {
            if (*p - centre).length() < 0.1 {
                assert!(trial.quadric.value(*p - centre).abs() < 1e-4);
            }
        }
        assert!(trial.quadric.value(0.05 * DVec3::Z) > 0.0);
    }

    #[test]
    fn what_the_points_do_not_say_is_zero() {
        let mut equations = Equations::default();
        assert_eq!(Equations::default().solve(), [0.0; 6]);
        for i in 0..9 {
            let x = f64::from(i) / 9.0;
            equations.add([1.0, x, 0.0, x * x, 0.0, 0.0], 2.0 + x, 1.0);
        }
        let solved = equations.solve();
        for (a, b) in solved.iter().zip([2.0, 1.0, 0.0, 0.0, 0.0, 0.0]) {
            assert!((a - b).abs() < 1e-5, "{solved:?}");
        }
    }
}
