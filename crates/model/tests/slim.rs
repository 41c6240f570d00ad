//! A SLIM surface lies near its points, holds all of them, and depends on nothing but them and the options.

use glam::{DMat3, DVec3};
use zeroset_model::points::Cloud;
use zeroset_model::slim::{Ball, Edges, Error, Options, Slim, Summary, build};
use zeroset_raycast::{Blending, Bound, Progress, Sides};

/// Points of a golden spiral on the unit sphere.
fn sphere(count: u32) -> Cloud {
    let angle = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let point = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let (s, c) = (angle * f64::from(i)).sin_cos();
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * c, r * s, z)
    };
    let points: Vec<_> = (0..count).map(point).collect();
    let (cloud, dropped) = Cloud::new(points.clone(), points).unwrap();
    assert_eq!(dropped.total(), 0);
    cloud
}

/// The faces of a cube without its edges, the outer normal at each point.
fn cube(count: u32) -> Cloud {
    let mut pairs = Vec::new();
    for (axis, side) in [0, 1, 2].into_iter().flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
        let n = side * DVec3::AXES[axis];
        let [u, v] = [DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]];
        let place = |i: u32| (f64::from(i) + 0.5) / f64::from(count) * 2.0 - 1.0;
        let all = (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
        pairs.extend(all.map(|(i, j)| (n + place(i) * u + place(j) * v, n)));
    }
    let (points, normals) = pairs.into_iter().unzip();
    Cloud::new(points, normals).unwrap().0
}

fn built(cloud: &Cloud, options: &Options) -> (Slim, Summary) {
    build(cloud, options, &Progress::new()).unwrap()
}

fn is_sound(ball: &Ball) -> bool {
    let clip = ball.clip.is_none_or(|h| h.normal.is_finite() && h.offset.is_finite());
    ball.centre.is_finite() && ball.radius > 0.0 && ball.quadric.is_finite() && clip
}

#[test]
fn a_sphere_takes_about_46_balls() {
    let cloud = sphere(5000);
    let (slim, summary) = built(&cloud, &Options::default());
    assert!((38..=54).contains(&summary.balls), "{summary}");
    assert!(summary.rms < 1e-4 && summary.max < 4e-4, "{summary}");
    assert!((2.0..4.0).contains(&summary.overlap), "{summary}");
    assert_eq!((summary.failed, summary.outside, summary.points), (0, 0, 5000));
    // The outside is where f > 0, and f is near the distance.
    for ball in slim.balls() {
        assert_eq!(ball.clip, None);
        assert!((ball.centre.length() - 1.0).abs() < 1e-12);
        for step in [-0.1, 0.1] {
            let value = ball.quadric.value(step * ball.centre);
            assert!((value - step).abs() < 0.02, "{value} at {step}");
        }
    }
}

#[test]
fn smaller_errors_take_more_balls_and_keep_to_them() {
    let cloud = sphere(20000);
    let mut before = 0;
    for error in [1e-2, 1e-3, 1e-4, 1e-5] {
        let (_, summary) = built(&cloud, &Options { error, ..Options::default() });
        assert!(summary.balls > before && summary.rms < error, "{error}: {summary}");
        before = summary.balls;
    }
}

/// Errors are counted in diagonals, so that a surface and the same enlarged are fitted alike.
#[test]
fn a_surface_is_fitted_alike_wherever_it_is_and_however_large() {
    let height = |u: f64, v: f64| 0.3 * u * u - 0.2 * u * v + 0.1 * v * v;
    let turn = DMat3::from_rotation_x(1.0) * DMat3::from_rotation_z(0.4);
    let mut counts = None;
    for (scale, shift) in [(1.0, DVec3::ZERO), (1e-30, DVec3::ZERO), (1e6, DVec3::splat(3e6))] {
        let grid = (0..900).map(|i| [i % 30, i / 30].map(|i| f64::from(i) / 15.0 - 1.0));
        let (points, normals) = grid
            .map(|[u, v]| {
                let slope = DVec3::new(0.2 * v - 0.6 * u, 0.2 * u - 0.2 * v, 1.0);
                let point = DVec3::new(u, v, height(u, v));
                (scale * (turn * point) + shift, turn * slope.normalize())
            })
            .unzip();
        let (cloud, _) = Cloud::new(points, normals).unwrap();
        let (slim, summary) = built(&cloud, &Options { error: 1e-2, ..Options::default() });
        assert!(summary.balls < 12 && summary.rms < 1e-2, "{summary}");
        assert!(slim.balls().iter().all(is_sound));
        let (_, fine) = built(&cloud, &Options { error: 1e-5, ..Options::default() });
        assert!(fine.rms < 1e-5, "{fine}");
        assert_eq!(*counts.get_or_insert([summary.balls, fine.balls]), [summary.balls, fine.balls]);
    }
}

#[test]
fn the_surface_does_not_depend_on_threads() {
    let cloud = sphere(3000);
    let options = Options { error: 2e-5, ..Options::default() };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| built(&cloud, &options).0)
    };
    let one = with(1);
    assert!(one.balls().len() > 50, "{}", one.balls().len());
    assert_eq!(one, with(7));
    assert_ne!(one, built(&cloud, &Options { seed: 1, ..options }).0);
}

/// Every point but those is in the inner part of a ball, and no ball's centre is in that of one before it.
#[test]
fn balls_cover_all_points_in_order() {
    let cloud = sphere(3000);
    let cover = 0.7;
    let (slim, _) = built(&cloud, &Options { cover, error: 1e-5, ..Options::default() });
    let inside =
        |p: DVec3, ball: &Ball| (p - ball.centre).length() < cover * ball.radius * (1.0 + 1e-9);
    for p in &cloud.points {
        assert!(slim.balls().iter().any(|ball| inside(*p, ball)), "{p}");
    }
    for (i, ball) in slim.balls().iter().enumerate() {
        let rounding = 1.0 - 1e-6;
        let near = |b: &&Ball| (ball.centre - b.centre).length() < rounding * cover * b.radius;
        assert_eq!(slim.balls()[..i].iter().find(near), None, "{i}");
    }
}

#[test]
fn edges_are_kept_if_asked_for() {
    let cloud = cube(40);
    let options = Options { error: 1e-4, ..Options::default() };
    let (rounded, ignored) = built(&cloud, &options);
    assert!(rounded.balls().iter().all(|ball| ball.clip.is_none()));
    let (sharp, clipped) = built(&cloud, &Options { edges: Edges::Clip, ..options });
    assert!(3 * clipped.balls < ignored.balls, "{ignored}; {clipped}");
    assert_eq!(clipped.outside, 0);
    let halves: Vec<&Ball> = sharp.balls().iter().filter(|ball| ball.clip.is_some()).collect();
    assert!(halves.len() >= 24, "{}", halves.len());
    for pair in halves.chunks(2) {
        let [a, b] = [pair[0], pair[1]];
        let [clip, other] = [a.clip.unwrap(), b.clip.unwrap()];
        assert_eq!((a.centre, clip.normal, clip.offset), (b.centre, -other.normal, -other.offset));
        // The plane holds the edge and halves the angle: its normal is that of two faces.
        let normals = [a, b].map(|ball| 2.0 * ball.quadric.half_gradient(DVec3::ZERO));
        let across = (normals[1] - normals[0]).normalize();
        assert!((clip.normal - across).length() < 1e-3, "{clip:?} {normals:?}");
    }
    // What is left lies on the cube, inside its faces.
    for ball in &halves {
        for p in cloud.points.iter().filter(|p| ball.contains(**p - ball.centre)) {
            let value = ball.quadric.value(*p - ball.centre);
            assert!(value.abs() < 1e-6, "{value} at {p}");
        }
    }
}

/// A valley: the half-spaces are the other way round.
#[test]
fn concave_edges_are_clipped_on_their_own_sides() {
    let mut pairs = Vec::new();
    for i in 0..40 {
        for j in 0..40 {
            let [u, v] = [f64::from(i) / 20.0 + 0.01, f64::from(j) / 20.0];
            pairs.push((DVec3::new(u, v, 0.0), DVec3::Z));
            pairs.push((DVec3::new(0.0, v, u), DVec3::X));
        }
    }
    let (points, normals) = pairs.into_iter().unzip();
    let (cloud, _) = Cloud::new(points, normals).unwrap();
    let (slim, summary) = built(&cloud, &Options { edges: Edges::Clip, ..Options::default() });
    assert!(summary.rms < 1e-9 && summary.outside == 0, "{summary}");
    assert!(slim.balls().iter().any(|ball| ball.clip.is_some()));
}

/// Two sheets closer than the error, and further apart than points: no ball takes both for one.
#[test]
fn sheets_stay_apart() {
    let grid = (0..1600).map(|i| [i % 40, i / 40].map(f64::from));
    let (points, normals) = grid
        .flat_map(|[x, y]| [4.5, 0.0].map(|z| (DVec3::new(x, y, z), (z - 1.0) * DVec3::Z)))
        .unzip();
    let (cloud, _) = Cloud::new(points, normals).unwrap();
    let (slim, summary) = built(&cloud, &Options { error: 0.05, ..Options::default() });
    assert!(summary.rms < 1e-9, "{summary}");
    for ball in slim.balls() {
        let near = |p: &DVec3| ball.contains(*p - ball.centre);
        assert!(cloud.points.iter().filter(|p| near(p)).all(|p| p.z == ball.centre.z));
    }
}

#[test]
fn poor_clouds_make_sound_surfaces() {
    let line = |count: u32| (0..count).map(|i| DVec3::new(f64::from(i), 0.0, 0.0));
    let plane = (0..900).map(|i| DVec3::new(f64::from(i % 30), f64::from(i / 30), 0.0));
    let mut clouds: Vec<Vec<DVec3>> = (2..=12).map(|count| line(count).collect()).collect();
    clouds.extend((2..=12).map(|count| sphere(count).points));
    clouds.push(line(500).collect());
    clouds.push(plane.collect());
    // Two heaps far apart, and one heap within rounding of a point.
    clouds.push(line(40).chain(line(40).map(|p| 1e-12 * p + 1e3)).collect());
    clouds.push(line(40).map(|p| DVec3::ONE + f64::EPSILON * p).collect());
    for points in clouds {
        let normals = [DVec3::Z, DVec3::NEG_X, DVec3::Y];
        let mixed: Vec<_> = (0..points.len()).map(|i| normals[i % 3]).collect();
        let opposed: Vec<_> = (0..points.len()).map(|i| [DVec3::Z, -DVec3::Z][i % 2]).collect();
        let estimated = Cloud::estimated(points.clone()).unwrap().0;
        let with = |normals: Vec<DVec3>| Cloud::new(points.clone(), normals).unwrap().0;
        let same = with(vec![DVec3::Z; points.len()]);
        for cloud in [estimated, same, with(mixed), with(opposed)] {
            for edges in [Edges::Ignore, Edges::Clip] {
                let (slim, summary) = built(&cloud, &Options { edges, ..Options::default() });
                assert!(slim.balls().iter().all(is_sound), "{summary}");
                assert!(summary.rms.is_finite() && summary.outside == 0, "{summary}");
            }
        }
    }
    let (cloud, _) = Cloud::estimated(line(500).collect()).unwrap();
    assert_eq!(built(&cloud, &Options::default()).1.balls, 1);
}

#[test]
fn a_surface_is_cast_as_patches() {
    let (slim, _) = built(&sphere(500), &Options::default());
    let patches = slim.patches();
    assert_eq!(patches.sides(), Sides::Front);
    assert_eq!(patches.blending(), Blending::Weighted { offset: 0.5 });
    assert_eq!(patches.all().len(), slim.balls().len());
    for (patch, ball) in patches.all().iter().zip(slim.balls()) {
        assert_eq!((patch.origin, patch.quadric), (ball.centre, ball.quadric));
        assert_eq!(patch.bound, Bound::Ball { centre: DVec3::ZERO, radius: ball.radius });
    }
}

#[test]
fn what_makes_no_surface_is_refused() {
    let cloud = sphere(100);
    let refused = |cloud: &Cloud, options: &Options| {
        build(cloud, options, &Progress::new()).unwrap_err().to_string()
    };
    let usual = Options::default();
    for error in [0.0, -1.0, f64::NAN, 1.0] {
        assert!(refused(&cloud, &Options { error, ..usual }).contains("the error"));
    }
    for cover in [0.0, 1.1, f64::NAN] {
        assert!(refused(&cloud, &Options { cover, ..usual }).contains("the cover"));
    }
    assert!(refused(&Cloud::default(), &usual).contains("0 points"));
    let fewer = Cloud { normals: cloud.normals[1..].to_vec(), ..cloud.clone() };
    assert!(refused(&fewer, &usual).contains("99 normals"));
    let mut long = cloud.clone();
    long.normals[3] *= 2.0;
    assert!(refused(&long, &usual).contains("point 3"));
    let one = Cloud { points: vec![DVec3::ONE; 100], normals: cloud.normals.clone() };
    assert!(refused(&one, &usual).contains("diagonal"));
    assert!(Slim::new(Vec::new(), 0.5).unwrap_err().to_string().contains("without patches"));

    let progress = Progress::new();
    progress.stop();
    assert_eq!(build(&cloud, &usual, &progress).unwrap_err(), Error::Interrupted);
}

#[test]
fn progress_counts_points() {
    let progress = Progress::new();
    build(&sphere(2000), &Options::default(), &progress).unwrap();
    assert_eq!(progress.done(), 2000);
}
