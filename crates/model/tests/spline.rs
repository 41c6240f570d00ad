//! The spline is continuous, smooth where it should be, and keeps polynomials.

use std::collections::BTreeSet;

use glam::DVec3;
use proptest::prelude::*;
use zeroset_model::spline::{Filter, Sector, Spline};
use zeroset_model::volume::Volume;
use zeroset_raycast::Quadric;

/// Samples of a function of whole numbers, at distances of 1 from the origin.
fn volume(size: [usize; 3], f: impl Fn(f64, f64, f64) -> f64) -> Volume {
    let last = DVec3::from(size.map(|n| (n - 1) as f64));
    Volume::sampled(size, [DVec3::ZERO, last], |p| f(p.x, p.y, p.z)).unwrap()
}

/// 4 x 4 x 4 samples on a grid that is not cubic: cubes 1 and 2 along each axis have neighbours.
fn random() -> impl Strategy<Value = Volume> {
    let values = prop::collection::vec(-1.0_f32..1.0, 64);
    let spacing = prop::array::uniform3(0.1_f64..3.0).prop_map(DVec3::from);
    let origin = prop::array::uniform3(-20.0_f64..20.0).prop_map(DVec3::from);
    (values, spacing, origin)
        .prop_map(|(values, spacing, origin)| Volume::new([4; 3], spacing, origin, values).unwrap())
}

/// A tetrahedron in a whole grid: its polynomial, and its corners in half steps from the first sample.
struct Piece {
    quadric: Quadric,
    centre: [i64; 3],
    corners: [[i64; 3]; 4],
}

impl Piece {
    /// All of a volume.
    fn all(volume: &Volume) -> Vec<Self> {
        let spline = Spline::new(volume, Filter::None).unwrap();
        let mut pieces = Vec::new();
        let [nx, ny, nz] = volume.size().map(|n| 1..n - 1);
        for k in nz {
            for j in ny.clone() {
                for i in nx.clone() {
                    let centre = [i, j, k].map(|n| 2 * n as i64);
                    for sector in Sector::all() {
                        let corners = sector.corners().map(|corner| {
                            [0, 1, 2].map(|axis| centre[axis] + i64::from(corner[axis]))
                        });
                        let quadric = spline.quadric([i, j, k], sector);
                        pieces.push(Self { quadric, centre, corners });
                    }
                }
            }
        }
        pieces
    }

    /// The corners that two tetrahedra share, in the order of the first: its own numbers.
    fn shared(&self, other: &Self) -> Vec<usize> {
        let theirs: BTreeSet<_> = other.corners.into_iter().collect();
        (0..4).filter(|i| theirs.contains(&self.corners[*i])).collect()
    }

    /// A point given in half steps, relative to the cube's centre.
    fn local(&self, point: DVec3, spacing: DVec3) -> DVec3 {
        0.5 * (point - DVec3::from(self.centre.map(|n| n as f64))) * spacing
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn neighbours_agree_where_they_meet(volume in random(), weights in prop::array::uniform3(0.01_f64..1.0)) {
        let pieces = Piece::all(&volume);
        let spacing = volume.spacing();
        let sample = |[i, j, k]: [i64; 3]| f64::from(volume.values()[(i + 4 * (j + 4 * k)) as usize]);
        let mut faces = [0; 3];
        for (n, one) in pieces.iter().enumerate() {
            for other in &pieces[..n] {
                let shared = one.shared(other);
                if shared.len() != 3 {
                    continue;
                }
                let sum: f64 = weights.iter().sum();
                let corner = |i: usize| DVec3::from(one.corners[i].map(|n| n as f64));
                let point = (0..3).map(|i| weights[i] / sum * corner(shared[i])).sum::<DVec3>();
                let [p, q] = [one, other].map(|piece| (piece, piece.local(point, spacing)));
                let [a, b] = [p, q].map(|(piece, at)| piece.quadric.value(at));
                prop_assert!((a - b).abs() < 1e-13, "{a} {b} at {point}");
                let slope = |point: DVec3| {
                    let [a, b] = [one, other].map(|piece| {
                        2.0 * piece.quadric.half_gradient(piece.local(point, spacing)) * spacing
                    });
                    (a - b).length()
                };
                match shared[..] {
                    // Faces of cubes, and faces between tetrahedra at the same face of a cube.
                    [1, 2, 3] | [0, 1, 2 | 3] => {
                        prop_assert!(slope(point) < 1e-12, "{} at {point}", slope(point));
                        faces[usize::from(shared[0] == 0)] += 1;
                    }
                    // Between faces of a cube: smooth at the centre, and at the corners up to a part of the
                    // mixed difference of the eight samples there.
                    [0, 2, 3] => {
                        prop_assert!(slope(corner(0)) < 1e-12);
                        for end in [2, 3] {
                            let mut mixed = 0.0;
                            for eighth in 0..8 {
                                let side = [0, 1, 2].map(|axis| i64::from(eighth >> axis & 1));
                                let at = [0, 1, 2].map(|a| (one.corners[end][a] - 1) / 2 + side[a]);
                                let sign = if side.iter().sum::<i64>() % 2 == 0 { -1.0 } else { 1.0 };
                                mixed += sign * sample(at);
                            }
                            // b(p, v1') + b(p, v1) - b(p, v0) - (b(p, v2) + b(p, v3))/2 is half of the jump
                            // of the slope times the distance of v1' from the face, sqrt(1/2)/2.
                            let defect = slope(corner(end)) * 0.5_f64.sqrt() / 2.0 / 2.0;
                            prop_assert!(
                                (defect - mixed.abs() / 16.0).abs() < 1e-12,
                                "{defect} {mixed} at {end}"
                            );
                        }
                        faces[2] += 1;
                    }
                    _ => prop_assert!(false, "{shared:?}"),
                }
            }
        }
        // 12 faces between 8 cubes of 4 triangles; in each cube 24 within pyramids and 12 between.
        prop_assert_eq!(faces, [48, 8 * 24, 8 * 12]);
    }

    #[test]
    fn values_lie_between_samples(volume in random(), at in prop::array::uniform3(0.5_f64..2.5)) {
        let spline = Spline::new(&volume, Filter::None).unwrap();
        let p = volume.origin() + DVec3::from(at) * volume.spacing();
        let [least, most] = volume.range().unwrap().map(f64::from);
        let value = spline.value(p).unwrap();
        prop_assert!(least - 1e-12 <= value && value <= most + 1e-12);
    }

    #[test]
    fn quadratic_functions_are_found_up_to_a_constant(
        k in prop::array::uniform10(-4_i8..=4),
        at in prop::array::uniform3(0.51_f64..2.49),
        spacing in prop::array::uniform3(prop::sample::select(vec![0.25, 0.5, 1.0, 2.0])),
    ) {
        let k = k.map(f64::from);
        let f = |p: DVec3| {
            let DVec3 { x, y, z } = p;
            let linear = k[0] + k[1] * x + k[2] * y + k[3] * z;
            linear + k[4] * x * x + k[5] * y * y + k[6] * z * z + k[7] * x * y + k[8] * y * z + k[9] * z * x
        };
        let gradient = |p: DVec3| {
            let DVec3 { x, y, z } = p;
            DVec3::new(
                k[1] + 2.0 * k[4] * x + k[7] * y + k[9] * z,
                k[2] + 2.0 * k[5] * y + k[7] * x + k[8] * z,
                k[3] + 2.0 * k[6] * z + k[8] * y + k[9] * x,
            )
        };
        let spacing = DVec3::from(spacing);
        let volume = Volume::sampled([4; 3], [DVec3::ZERO, 3.0 * spacing], f).unwrap();
        let p = DVec3::from(at) * spacing;
        let off = 0.25 * spacing.powf(2.0).dot(DVec3::new(k[4], k[5], k[6]));
        for (filter, off) in [(Filter::None, off), (Filter::Laplacian, 0.0)] {
            let spline = Spline::new(&volume, filter).unwrap();
            let (value, slope) = (spline.value(p).unwrap(), spline.gradient(p).unwrap());
            prop_assert!((value - f(p) - off).abs() < 1e-11, "{filter:?} {value} {} {off}", f(p));
            prop_assert!((slope - gradient(p)).abs().max_element() < 1e-11, "{filter:?}");
        }
    }
}

#[test]
fn linear_functions_are_kept_and_points_outside_have_no_value() {
    let linear = |x: f64, y: f64, z: f64| 3.0 * x - 2.0 * y + 0.5 * z + 7.0;
    let volume = volume([5, 4, 3], linear);
    let spline = Spline::new(&volume, Filter::None).unwrap();
    for (p, is_inside) in [
        (DVec3::new(0.5, 0.5, 0.5), true),
        (DVec3::new(3.5, 2.5, 1.5), true),
        (DVec3::new(2.3, 1.1, 0.9), true),
        (DVec3::new(0.49, 1.0, 1.0), false),
        (DVec3::new(1.0, 2.51, 1.0), false),
        (DVec3::new(1.0, 1.0, f64::NAN), false),
    ] {
        assert_eq!(spline.value(p).is_some(), is_inside, "{p}");
        assert_eq!(spline.gradient(p).is_some(), is_inside, "{p}");
        if let (Some(value), Some(gradient)) = (spline.value(p), spline.gradient(p)) {
            assert!((value - linear(p.x, p.y, p.z)).abs() < 1e-13, "{p}");
            assert!((gradient - DVec3::new(3.0, -2.0, 0.5)).length() < 1e-13, "{p}");
        }
    }
}

#[test]
fn a_tetrahedron_worked_by_hand() {
    let volume = volume([3; 3], |i, j, k| {
        (3.0 * i + 5.0 * j * j + 7.0 * k + 2.0 * i * k + i * j * k) % 11.0
    });
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 1], [1, -1, 1]];
    let sector = Sector::all().find(|sector| sector.corners() == corners).unwrap();
    let spline = Spline::new(&volume, Filter::None).unwrap();
    assert_eq!(
        spline.ordinates([1; 3], sector),
        [4.125, 4.375, 3.75, 5.25, 4.25, 4.0, 4.0, 4.625, 4.375, 4.75]
    );
    let quadric = spline.quadric([1; 3], sector);
    assert_eq!(
        quadric.a.to_cols_array_2d(),
        [[0.0, 0.5, 1.5], [0.5, -0.5, -2.0], [1.5, -2.0, 0.0]]
    );
    assert_eq!((quadric.b, quadric.c), (DVec3::new(0.25, 0.0, -0.5), 4.125));
    let at = DVec3::new(0.3, 0.1, 0.2);
    assert_eq!(Sector::holding(at), sector);
    assert!((spline.value(1.0 + at).unwrap() - 4.2).abs() < 1e-14);
}

#[test]
#[should_panic(expected = "has no cube")]
fn samples_at_the_border_have_no_cube() {
    let volume = Volume::sphere(3).unwrap();
    let spline = Spline::new(&volume, Filter::None).unwrap();
    spline.quadric([0, 1, 1], Sector::all().next().unwrap());
}
