//! Isosurfaces have as many tetrahedra as published, and the spline's errors fall as they should.

mod errors;

use errors::Errors;
use glam::DVec3;
use zeroset_model::spline::{Filter, Outside, Spline, Tets, isosurface};
use zeroset_model::volume::Volume;
use zeroset_raycast::{Bound, Error, Progress, Sides};

fn tets(volume: &Volume, isovalue: f64) -> Tets {
    isosurface(volume, isovalue, &Progress::new()).unwrap()
}

#[test]
fn counts_are_those_of_the_paper() {
    // [stoll2006] Table 3: Marschner-Lobb and Sphere.
    let signal = Volume::marschner_lobb(41).unwrap();
    assert_eq!(tets(&signal, 0.5).len(), 65844);
    let sphere = tets(&Volume::sphere(64).unwrap(), 0.8);
    assert_eq!(sphere.len(), 137_232);
    assert_eq!(sphere.all().count(), sphere.len());
    assert_eq!(sphere.patches(Sides::Both).unwrap().all().len(), sphere.len());
}

#[test]
fn the_answer_is_that_of_one_thread() {
    let volume = Volume::marschner_lobb(41).unwrap();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| tets(&volume, 0.5))
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(7));
    let mut before = 0;
    for tet in one.all() {
        let [i, j, k] = tet.cell;
        let number = 24 * (i + 41 * (j + 41 * k)) + usize::from(tet.sector.number());
        assert!(number > before, "{tet:?}");
        before = number;
        let least = tet.ordinates.into_iter().fold(f64::INFINITY, f64::min);
        let most = tet.ordinates.into_iter().fold(f64::NEG_INFINITY, f64::max);
        assert!(least < 0.5 && 0.5 < most, "{tet:?}");
    }
}

#[test]
fn progress_counts_cubes_and_stops() {
    let volume = Volume::sphere(20).unwrap();
    let progress = Progress::new();
    isosurface(&volume, 0.8, &progress).unwrap();
    assert_eq!(progress.done(), 18 * 18 * 18);
    progress.stop();
    assert_eq!(isosurface(&volume, 0.8, &progress), Err(Error::Interrupted));
    assert!(progress.done() < 2 * 18 * 18 * 18);
}

#[test]
fn errors_fall_with_the_square_of_the_spacing() {
    // The greatest error of values and the root mean square of that of gradients; then, of values, with the
    // filter: of all cubes, and of those that do not depend on the border.
    let expected = [
        (41, [8.8e-2, 2.4], [1.2e-1, 7.9e-2]),
        (81, [2.6e-2, 0.81], [1.3e-2, 9.0e-3]),
        (161, [6.8e-3, 0.22], [1.0e-3, 6.9e-4]),
    ];
    let near = |measured: f64, expected: f64| (measured / expected - 1.0).abs() < 0.05;
    for (n, [value, gradient], filtered) in expected {
        let volume = Volume::marschner_lobb(n).unwrap();
        let plain = Errors::of(&Spline::new(&volume, Filter::None).unwrap(), n, 1);
        assert!(near(plain.value, value) && near(plain.gradient, gradient), "{n} {plain:?}");
        let spline = Spline::new(&volume, Filter::Laplacian).unwrap();
        for (border, value) in [(1, filtered[0]), (3, filtered[1])] {
            let sharp = Errors::of(&spline, n, border);
            assert!(near(sharp.value, value), "{n} {border} {sharp:?}");
            assert!(sharp.gradient < plain.gradient, "{n} {border} {sharp:?}");
        }
    }
}

#[test]
fn an_isosurface_that_is_not_there_is_an_error() {
    let said = |volume: &Volume, isovalue| {
        isosurface(volume, isovalue, &Progress::new()).unwrap_err().to_string()
    };
    let sphere = Volume::sphere(8).unwrap();
    assert!(said(&sphere, 2.0).contains("samples lie between 0.24"), "{}", said(&sphere, 2.0));
    assert!(said(&sphere, f64::NAN).contains("not finite"));
    let flat = Volume::new([3, 9, 2], DVec3::ONE, DVec3::ZERO, vec![0.0; 54]).unwrap();
    assert!(said(&flat, 0.0).contains("3 x 9 x 2"));
    // Strictly between: a constant is nowhere.
    let constant = Volume::new([4; 3], DVec3::ONE, DVec3::ZERO, vec![1.0; 64]).unwrap();
    assert!(said(&constant, 1.0).contains("between 1 and 1"));
    let holes = Volume::new([4; 3], DVec3::ONE, DVec3::ZERO, vec![f32::NAN; 64]).unwrap();
    assert!(said(&holes, 1.0).contains("each of the 8 cubes"));
}

#[test]
fn cubes_near_holes_are_dropped_and_counted() {
    let whole = Volume::sphere(12).unwrap();
    let all = tets(&whole, 0.8);
    for hole in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut values = whole.values().to_vec();
        // One inside, which 27 cubes see, and one in a corner, which one cube sees.
        let at = 2 + 12 * (6 + 12 * 6);
        (values[at], values[0]) = (hole, hole);
        let holed = Volume::new(whole.size(), whole.spacing(), whole.origin(), values).unwrap();
        let rest = tets(&holed, 0.8);
        assert_eq!((all.dropped(), rest.dropped()), (0, 28));
        let is_far = |cell: [usize; 3]| {
            let near = cell.iter().zip([2, 6, 6]).all(|(c, hole)| c.abs_diff(hole) <= 1);
            !near && cell != [1; 3]
        };
        let expected: Vec<_> = all.all().filter(|tet| is_far(tet.cell)).collect();
        assert!(expected.len() < all.len());
        assert_eq!(rest.all().collect::<Vec<_>>(), expected);
    }
}

#[test]
fn the_outside_is_where_it_is_said_to_be() {
    let volume = Volume::sphere(12).unwrap();
    let spline = Spline::new(&volume, Filter::None).unwrap();
    for (outside, sign) in [(Outside::Below, -1.0), (Outside::Above, 1.0)] {
        let tets = spline.isosurface(0.8, outside, &Progress::new()).unwrap();
        assert_eq!((tets.outside(), tets.isovalue()), (outside, 0.8));
        let patches = tets.patches(Sides::Front).unwrap();
        assert_eq!(patches.sides(), Sides::Front);
        for patch in patches.all() {
            let Bound::Tetrahedron(corners) = patch.bound else { panic!("{patch:?}") };
            let middle = 0.25 * corners.into_iter().sum::<DVec3>();
            let value = spline.value(patch.origin + middle).unwrap();
            let f = sign * (value - 0.8);
            assert!((patch.quadric.value(middle) - f).abs() < 1e-14, "{patch:?}");
        }
    }
}
