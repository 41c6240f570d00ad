//! Tetrahedra that meet share corners and ordinates bit by bit: no ray slips between them.

use std::collections::HashMap;

use glam::DVec3;
use zeroset_model::spline::{Filter, Outside, Spline, Tets};
use zeroset_model::volume::Volume;
use zeroset_raycast::{Bound, Patches, Progress, Sides};

/// Grids whose steps no float has.
fn grids() -> [(DVec3, DVec3); 5] {
    let thirds = DVec3::new(1.0 / 3.0, 0.1, 0.7 / 3.0);
    [
        (DVec3::splat(2.0 / 63.0), DVec3::NEG_ONE),
        (thirds, DVec3::new(-1.0 / 3.0, -0.7, 0.9)),
        (thirds, DVec3::new(12345.678, -3e4, 1e-7)),
        // Places at the border are next to 0, with bits of their own.
        (thirds, -thirds * DVec3::new(0.31, 0.33, 0.34)),
        (1e-9 * thirds, DVec3::new(1e-4 / 3.0, 0.0, -1e-12 / 7.0)),
    ]
}

/// An isosurface in samples of twelve decades, whose sums are rounded.
fn isosurface([spacing, origin]: [DVec3; 2]) -> (Tets, Patches) {
    let mut state = 1_u64;
    let values = (0..14 * 13 * 12).map(|_| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let uniform = (state >> 40) as f32 / (1 << 24) as f32;
        (uniform - 0.5) * 10_f32.powi((state >> 33 & 15) as i32 - 8)
    });
    let volume = Volume::new([14, 13, 12], spacing, origin, values.collect()).unwrap();
    let spline = Spline::new(&volume, Filter::None).unwrap();
    let tets = spline.isosurface(1e-3, Outside::Below, &Progress::new()).unwrap();
    let patches = tets.patches(Sides::Both).unwrap();
    assert!(tets.len() > 10_000);
    (tets, patches)
}

/// Notes what was found at a place; all finds at it must be the same bits.
fn note<K: std::hash::Hash + Eq + Copy + std::fmt::Debug>(
    finds: &mut HashMap<K, ([u64; 3], usize)>,
    place: K,
    found: DVec3,
) {
    let bits = found.to_array().map(f64::to_bits);
    let (before, times) = finds.entry(place).or_insert((bits, 0));
    assert_eq!(*before, bits, "{place:?}");
    *times += 1;
}

/// What is lost when a + b is rounded (Knuth).
fn rounding(a: DVec3, b: DVec3) -> DVec3 {
    let sum = a + b;
    let rest = sum - a;
    (a - (sum - rest)) + (b - rest)
}

#[test]
fn corners_are_the_same_from_all_sides() {
    for (spacing, origin) in grids() {
        let (tets, patches) = isosurface([spacing, origin]);
        let (mut corners, mut places) = (HashMap::new(), HashMap::new());
        for (tet, patch) in tets.all().zip(patches.all()) {
            let Bound::Tetrahedron(bound) = patch.bound else { panic!("{patch:?}") };
            for (corner, half_steps) in bound.into_iter().zip(tet.sector.corners()) {
                let place = [0, 1, 2].map(|a| 2 * tet.cell[a] as i64 + i64::from(half_steps[a]));
                let found = patch.origin + corner;
                assert_eq!(rounding(patch.origin, corner), DVec3::ZERO, "{place:?}");
                note(&mut corners, place, found);
                // Other corners are other points.
                let expected = *places.entry(found.to_array().map(f64::to_bits)).or_insert(place);
                assert_eq!(place, expected);
                let ideal = origin + 0.5 * DVec3::from(place.map(|n| n as f64)) * spacing;
                let off = ((found - ideal) / spacing).abs().max_element();
                assert!(off < 1e-8, "{off} steps");
            }
        }
        assert!(corners.values().filter(|(_, times)| *times > 12).count() > 1000);
    }
}

#[test]
fn ordinates_are_the_same_from_all_sides() {
    let (spacing, origin) = grids()[0];
    let (tets, _) = isosurface([spacing, origin]);
    const PAIRS: [[usize; 2]; 10] =
        [[0, 0], [1, 1], [2, 2], [3, 3], [0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    let mut ordinates = HashMap::new();
    for tet in tets.all() {
        let corners = tet.sector.corners();
        for ([p, q], ordinate) in PAIRS.into_iter().zip(tet.ordinates) {
            let sum = |a: usize| i64::from(corners[p][a]) + i64::from(corners[q][a]);
            let place = [0, 1, 2].map(|a| 4 * tet.cell[a] as i64 + sum(a));
            note(&mut ordinates, place, DVec3::new(ordinate, 0.0, 0.0));
        }
    }
    assert!(ordinates.values().filter(|(_, times)| *times > 8).count() > 1000);
}

#[test]
fn surfaces_meet_at_faces() {
    for (spacing, origin) in grids() {
        // Places are rounded more where they are far away.
        let far = (origin / spacing).abs().max_element();
        let tolerance = 1e-13 * far.max(10.0);
        let (tets, patches) = isosurface([spacing, origin]);
        let mut faces: HashMap<[[u64; 3]; 3], (f64, f64)> = HashMap::new();
        let mut met = 0;
        for (tet, patch) in tets.all().zip(patches.all()) {
            let Bound::Tetrahedron(bound) = patch.bound else { panic!("{patch:?}") };
            let scale = tet.ordinates.into_iter().fold(0.0, |most: f64, b| most.max(b.abs()));
            for left_out in 0..4 {
                let corners = (0..4).filter(|i| *i != left_out).map(|i| patch.origin + bound[i]);
                let mut corners: Vec<DVec3> = corners.collect();
                let key = |p: &DVec3| p.to_array().map(f64::to_bits);
                corners.sort_by_key(key);
                let face = [0, 1, 2].map(|i| key(&corners[i]));
                let at = 0.5 * corners[0] + 0.3 * corners[1] + 0.2 * corners[2];
                let value = patch.quadric.value(at - patch.origin);
                if let Some((other, other_scale)) = faces.insert(face, (value, scale)) {
                    met += 1;
                    let off = (value - other).abs() / scale.max(other_scale);
                    assert!(off < tolerance, "{off} {tolerance}");
                }
            }
        }
        // Of four faces nearly all have a neighbour.
        assert!(f64::from(met) > 1.5 * patches.all().len() as f64, "{met}");
    }
}
