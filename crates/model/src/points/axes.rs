//! Axes of a symmetric matrix.

use glam::DMat3;
use glam::DVec3;

/// The eigenvector of a symmetric matrix for its least eigenvalue, of length 1, by Jacobi's rotations: they
/// give axes at right angles even where eigenvalues coincide, as for points on a line.
pub(super) fn least_axis(m: DMat3) -> DVec3 {
    let size = m.to_cols_array().into_iter().fold(0.0, |size: f64, x| size.max(x.abs()));
    if !(size > 0.0 && size.is_finite()) {
        return DVec3::Z;
    }
    let mut a = (m * (1.0 / size)).to_cols_array_2d();
    let mut axes = DMat3::IDENTITY.to_cols_array_2d();
    // Off-diagonals fall quadratically; a few sweeps reach the rounding.
    for _ in 0..12 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let c = 1.0 / t.hypot(1.0);
            let s = t * c;
            let turn = |x: &mut [[f64; 3]; 3], i: usize| {
                let [xp, xq] = [x[p][i], x[q][i]];
                x[p][i] = c * xp - s * xq;
                x[q][i] = s * xp + c * xq;
            };
            (0..3).for_each(|i| turn(&mut a, i));
            for row in &mut a {
                let [xp, xq] = [row[p], row[q]];
                row[p] = c * xp - s * xq;
                row[q] = s * xp + c * xq;
            }
            (0..3).for_each(|i| turn(&mut axes, i));
        }
    }
    let least = (0..3).min_by(|&i, &j| a[i][i].total_cmp(&a[j][j])).unwrap_or(2);
    DVec3::from(axes[least]).normalize_or(DVec3::Z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_axis_is_an_eigenvector() {
        let rotation = DMat3::from_rotation_y(0.7) * DMat3::from_rotation_x(1.9);
        for values in [[3.0, 1.0, 2.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [5e-90, 1e-90, 1e-80]] {
            let m = rotation * DMat3::from_diagonal(values.into()) * rotation.transpose();
            let axis = least_axis(m);
            let least = values.into_iter().fold(f64::INFINITY, f64::min);
            let size = values.into_iter().fold(0.0, f64::max);
            assert!((m * axis - least * axis).length() < 1e-14 * size, "{values:?}");
            assert!((axis.length() - 1.0).abs() < 1e-14);
        }
        assert_eq!(least_axis(DMat3::ZERO).length(), 1.0);
        assert_eq!(least_axis(DMat3::from_diagonal(DVec3::NAN)).length(), 1.0);
    }
}
