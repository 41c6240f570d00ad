//! Pictures show what the hits say, and files hold what the pictures and the hits say.

use std::collections::BTreeMap;
use std::fs;

use glam::{DVec3, Vec3};
use zeroset_raycast::{Camera, Certificate, Hit, Hits, Projection, Request, View, Work};
use zeroset_shade::{
    Agreement, Colour, Environment, Light, Picture, ShadeError, ViewKind, agreement, certificate,
    exr, picture, pictures, shaded, steps,
};

const WIDTH: usize = 33;
const HEIGHT: usize = 25;

fn camera() -> Camera {
    Camera {
        eye: DVec3::new(0.0, -4.0, 0.0),
        at: DVec3::ZERO,
        up: DVec3::Z,
        projection: Projection::Orthographic { height: 3.0 },
    }
}

fn view() -> View {
    View::new(camera(), WIDTH, HEIGHT)
}

/// The unit sphere, seen along +y, in closed form: t = 4 - sqrt(1 - x^2 - z^2).
fn sphere(view: &View) -> Hits {
    let mut hits = Hits::new(Request::FirstWithNormal, view.width * view.height);
    for i in 0..hits.len() {
        let ray = view.ray(i % view.width, i / view.width);
        let origin = ray.origin.as_dvec3();
        let square = 1.0 - origin.x * origin.x - origin.z * origin.z;
        let work = Work { points: i as u64, gradients: 2, intervals: 1, nonfinite: 9 };
        if square < 0.0 {
            hits.set(i, Hit::miss(Certificate::PROVEN_MISS, work));
        } else {
            let t = 4.0 - square.sqrt();
            let bracket = [t - 1e-12, t + 1e-12];
            hits.set(i, Hit { bracket, certificate: Certificate::PROVEN_HIT, work });
            hits.normal[i] = ray.at(t).normalize().as_vec3();
        }
    }
    hits
}

fn centre(picture: &Picture) -> [u8; 3] {
    picture.pixels()[(HEIGHT / 2) * WIDTH + WIDTH / 2]
}

#[test]
fn normals_are_those_of_the_sphere_and_face_the_eye() {
    let view = view();
    let mut hits = sphere(&view);
    let front = picture(ViewKind::Normal, &view, &hits, None).unwrap();
    // At the centre, n = (0, -1, 0).
    assert_eq!(centre(&front), [128, 0, 128]);
    let shaded_front = picture(ViewKind::Shaded, &view, &hits, None).unwrap();
    for normal in &mut hits.normal {
        *normal = -*normal;
    }
    assert_eq!(picture(ViewKind::Normal, &view, &hits, None).unwrap(), front);
    // The back is lit as the front is, in a cooler colour.
    let shaded_back = picture(ViewKind::Shaded, &view, &hits, None).unwrap();
    let ([r, _, b], [s, _, c]) = (centre(&shaded_front), centre(&shaded_back));
    assert!(r > b && s < c, "front {r} {b}, back {s} {c}");
}

#[test]
fn shading_is_lambert_and_shadows_take_the_light_away() {
    let view = view();
    let hits = sphere(&view);
    let dark = shaded::picture(&view, &hits, &[], Environment::Plain).unwrap();
    let light = |strength| Light::new(Vec3::new(0.0, -9.0, 0.0), strength);
    let level = |lights: &[Light]| {
        let lit = shaded::picture(&view, &hits, lights, Environment::Plain).unwrap();
        Colour::from_bytes(centre(&lit)).0.x - Colour::from_bytes(centre(&dark)).0.x
    };
    // In linear light, twice the strength is twice the light.
    let (once, twice) = (level(&[light(0.3)]), level(&[light(0.6)]));
    assert!(once > 0.15 && (twice / once - 2.0).abs() < 0.05, "{once} {twice}");
    let blocked = Light { blocked: vec![true; WIDTH * HEIGHT], ..light(0.6) };
    assert_eq!(
        shaded::picture(&view, &hits, &[blocked], Environment::Plain).unwrap().pixels(),
        dark.pixels()
    );
    let behind = Light::new(Vec3::Y, 1.0);
    assert_eq!(
        centre(&shaded::picture(&view, &hits, &[behind], Environment::Plain).unwrap()),
        centre(&dark)
    );
    let few = Light { blocked: vec![true; 3], ..light(0.6) };
    let error = shaded::picture(&view, &hits, &[few], Environment::Plain).unwrap_err();
    assert!(matches!(error, ShadeError::Count { got: 3, .. }), "{error}");
}

#[test]
fn a_sky_is_seen_past_a_surface_and_mirrored_by_it() {
    let view = view();
    let hits = sphere(&view);
    let in_the_sky = |lights: &[Light]| {
        let picture = shaded::picture(&view, &hits, lights, Environment::Sky).unwrap();
        let light = |pixel: &[u8; 3]| Colour::from_bytes(*pixel).0;
        picture.pixels().iter().map(light).collect::<Vec<Vec3>>()
    };
    let unlit = in_the_sky(&[]);
    // All rays are level, and so is what is seen at the centre of a ball: the horizon.
    let miss = unlit[0];
    assert!(hits.certificate.iter().zip(&unlit).all(|(c, p)| c.is_hit() || *p == miss));
    let [middle, column] = [HEIGHT / 2, WIDTH / 2];
    // Where normals rise or fall by 45 degrees, the zenith and the floor below the ball are seen.
    let slope = (0.5_f64.sqrt() * HEIGHT as f64 / 3.0).round() as usize;
    let [above, below] = [middle - slope, middle + slope].map(|row| unlit[row * WIDTH + column]);
    assert!(above.z > 1.5 * above.x && below.z < 1.1 * below.x, "{above} {below}");
    // A light behind the eye is a sun that the centre mirrors, unless it does not reach it.
    let light = Light::new(Vec3::new(0.0, -2.0, 0.0), 0.5);
    let centre = middle * WIDTH + column;
    let lit = in_the_sky(std::slice::from_ref(&light))[centre];
    let matt =
        shaded::picture(&view, &hits, std::slice::from_ref(&light), Environment::Plain).unwrap();
    let matt = Colour::from_bytes(matt.pixels()[centre]).0;
    assert!(lit.min_element() > matt.max_element() + 0.1, "{lit} {matt}");
    let blocked = Light { blocked: vec![true; WIDTH * HEIGHT], ..light };
    assert_eq!(in_the_sky(&[blocked]), unlit);
}

#[test]
fn depth_is_bright_near_and_dark_far() {
    let view = view();
    let hits = sphere(&view);
    let depth = picture(ViewKind::Depth, &view, &hits, None).unwrap();
    let row = &depth.pixels()[(HEIGHT / 2) * WIDTH..][..WIDTH];
    let light: Vec<u32> = row.iter().map(|p| p.iter().map(|b| u32::from(*b)).sum()).collect();
    let middle = WIDTH / 2;
    assert!(light[..=middle].is_sorted(), "{light:?}");
    assert!(light[middle..].is_sorted_by(|a, b| a >= b), "{light:?}");
    assert!(light[0] < light[middle] / 4, "misses are darkest: {light:?}");
}

#[test]
fn several_answers_share_a_scale() {
    let view = view();
    let near = sphere(&view);
    let mut far = near.clone();
    for (bracket, work) in far.bracket.iter_mut().zip(&mut far.work) {
        *bracket = bracket.map(|t| t + 10.0);
        work.intervals += 50_000;
    }
    for kind in [ViewKind::Depth, ViewKind::Steps] {
        let alone = [&near, &far].map(|hits| picture(kind, &view, hits, None).unwrap());
        let shared = pictures(kind, &view, &[(&near, None), (&far, None)]).unwrap();
        assert_ne!(alone[0].legend(), alone[1].legend());
        assert_eq!(shared[0].legend(), shared[1].legend());
        assert_ne!(centre(&shared[0]), centre(&shared[1]));
    }
}

#[test]
fn certificates_and_agreements_have_their_colours() {
    let view = View::new(camera(), 4, 2);
    let mut hits = Hits::new(Request::First, 8);
    for (i, certificate) in Certificate::ALL.into_iter().enumerate() {
        hits.certificate[i] = certificate;
    }
    let shown = picture(ViewKind::Certificate, &view, &hits, None).unwrap();
    for i in 0..8 {
        assert_eq!(shown.pixels()[i], certificate::colour(hits.certificate[i]));
    }

    let agreements = [
        Agreement::Correct { dt: 0.0 },
        Agreement::Correct { dt: -0.1 },
        Agreement::CorrectMiss,
        Agreement::FalseMiss,
        Agreement::FalseHit,
        Agreement::WrongSheet,
        Agreement::Undecided,
        Agreement::NotSampled,
    ];
    let shown = picture(ViewKind::Error, &view, &hits, Some(&agreements)).unwrap();
    for i in 0..8 {
        for j in 0..i {
            let [a, b] = [i, j].map(|k| shown.pixels()[k].map(i32::from));
            let difference: i32 = (0..3).map(|k| (a[k] - b[k]).abs()).sum();
            assert!(difference > 20, "{:?} looks like {:?}", agreements[i], agreements[j]);
        }
    }
    assert!(shown.description().contains("2 correct hits, 1 false miss"));
}

#[test]
fn what_is_missing_or_does_not_fit_is_an_error() {
    let view = view();
    let hits = Hits::new(Request::First, WIDTH * HEIGHT);
    for kind in ViewKind::ALL {
        let error = picture(kind, &view, &hits, None).err();
        match kind {
            _ if kind.needs_normals() => {
                assert!(matches!(error, Some(ShadeError::NoNormals(name)) if name == kind.name()));
            }
            _ if kind.needs_reference() => {
                assert!(matches!(error, Some(ShadeError::NoReference)));
            }
            _ => assert!(error.is_none(), "{error:?}"),
        }
        let few = Hits::new(Request::FirstWithNormal, 7);
        let error = picture(kind, &view, &few, Some(&[Agreement::Undecided; 7])).unwrap_err();
        assert!(matches!(error, ShadeError::Count { got: 7, width: WIDTH, .. }), "{error}");
    }
    let error = agreement::picture(&view, &[]).unwrap_err();
    assert_eq!(error.to_string(), "0 comparisons for 33 by 25 pixels; there must be one a pixel");
}

#[test]
fn pictures_without_pixels_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let none = Hits::new(Request::FirstWithNormal, 0);
    for (width, height) in [(0, 0), (0, 5), (5, 0)] {
        let view = View::new(camera(), width, height);
        for kind in ViewKind::ALL {
            let error = picture(kind, &view, &none, Some(&[])).unwrap_err();
            assert!(matches!(error, ShadeError::Empty { .. }), "{kind}: {error}");
        }
        let error = exr::save(&folder.path().join("x.exr"), &view, &none, None).unwrap_err();
        assert!(matches!(error, ShadeError::Empty { .. }), "{error}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn numbers_that_are_none_are_painted_and_saved() {
    let folder = tempfile::tempdir().unwrap();
    let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, -f64::MAX, 0.0, 1e-300, 3.0];
    let nowhere = Camera { eye: DVec3::splat(f64::NAN), ..camera() };
    for camera in [camera(), nowhere] {
        let view = View::new(camera, 8, 8);
        let mut hits = Hits::new(Request::FirstWithNormal, 64);
        for i in 0..64 {
            let [a, b] = [odd[i % 8], odd[i / 8]];
            let work = Work { points: u64::MAX, intervals: i as u64, ..Work::default() };
            hits.set(i, Hit { bracket: [a, b], certificate: Certificate::HIT, work });
            hits.normal[i] = Vec3::new(a as f32, b as f32, 1.0);
        }
        let agreements: Vec<_> = (0..64).map(|i| Agreement::Correct { dt: odd[i % 8] }).collect();
        let lights = [Light::new(Vec3::NAN, f32::NAN), Light::new(Vec3::ZERO, f32::INFINITY)];
        for environment in Environment::ALL {
            shaded::picture(&view, &hits, &lights, environment).unwrap();
        }
        for kind in ViewKind::ALL {
            let shown = picture(kind, &view, &hits, Some(&agreements)).unwrap();
            shown.with_legend().unwrap().save_png(&folder.path().join("odd.png")).unwrap();
            exr::save(&folder.path().join("odd.exr"), &view, &hits, Some(&shown)).unwrap();
        }
    }
}

#[test]
fn a_legend_is_drawn_below_the_picture() {
    let view = view();
    let shown = picture(ViewKind::Depth, &view, &sphere(&view), None).unwrap();
    let whole = shown.with_legend().unwrap();
    assert!(whole.height() > shown.height() && whole.width() >= shown.width());
    let left = (whole.width() - shown.width()) / 2;
    for row in 0..shown.height() {
        let line = &whole.pixels()[row * whole.width() + left..][..shown.width()];
        assert_eq!(line, &shown.pixels()[row * shown.width()..][..shown.width()]);
    }
    assert_eq!(whole.description(), shown.description());
}

fn channels(path: &std::path::Path) -> BTreeMap<String, Vec<f32>> {
    let image = ::exr::prelude::read_all_flat_layers_from_file(path).unwrap();
    assert_eq!(image.layer_data.len(), 1);
    let layer = &image.layer_data[0];
    assert_eq!((layer.size.x(), layer.size.y()), (WIDTH, HEIGHT));
    layer
        .channel_data
        .list
        .iter()
        .map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect()))
        .collect()
}

#[test]
fn exr_channels_hold_the_hits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a/hits.exr");
    let view = view();
    let hits = sphere(&view);
    let shown = picture(ViewKind::Shaded, &view, &hits, None).unwrap();
    exr::save(&path, &view, &hits, Some(&shown)).unwrap();

    let read = channels(&path);
    let names: Vec<&str> = read.keys().map(String::as_str).collect();
    let expected =
        ["B", "G", "N.X", "N.Y", "N.Z", "R", "certificate", "steps", "t", "t.hi", "t.lo"];
    assert_eq!(names, expected);
    for (i, [lo, hi]) in hits.bracket.iter().copied().enumerate() {
        let at = |name: &str| read[name][i];
        assert_eq!(at("t"), hits.get(i).t() as f32);
        assert!(f64::from(at("t.lo")) <= lo && hi <= f64::from(at("t.hi")));
        assert!(at("t.lo") <= at("t") && at("t") <= at("t.hi"));
        if hits.certificate[i].is_hit() {
            assert!(at("t.hi") - at("t.lo") < 1e-6);
        } else {
            assert_eq!([at("t.lo"), at("t"), at("t.hi")], [f32::INFINITY; 3]);
        }
        assert_eq!([at("N.X"), at("N.Y"), at("N.Z")], hits.normal[i].to_array());
        assert_eq!(at("steps"), steps::evaluations(&hits.work[i]) as f32);
        assert_eq!(at("certificate"), f32::from(hits.certificate[i].bits()));
        assert_eq!(Colour(Vec3::new(at("R"), at("G"), at("B"))).bytes(), shown.pixels()[i]);
    }

    // Equal hits give equal files.
    let again = folder.path().join("again.exr");
    exr::save(&again, &view, &hits, Some(&shown)).unwrap();
    assert!(fs::read(&path).unwrap() == fs::read(&again).unwrap());
}

#[test]
fn exr_has_only_the_channels_that_there_are() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hits.exr");
    let hits = Hits::new(Request::First, WIDTH * HEIGHT);
    exr::save(&path, &view(), &hits, None).unwrap();
    let read = channels(&path);
    assert!(read.keys().eq(["certificate", "steps", "t", "t.hi", "t.lo"]), "{:?}", read.keys());
    let other = Picture::filled(3, 3, [0; 3]).unwrap();
    let error = exr::save(&path, &view(), &hits, Some(&other)).unwrap_err();
    assert!(matches!(error, ShadeError::Count { got: 9, .. }), "{error}");
    assert_eq!(channels(&path), read, "the old file is still there");
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let blocker = folder.path().join("blocker");
    fs::write(&blocker, "a file").unwrap();
    let hits = sphere(&view());
    let shown = picture(ViewKind::Shaded, &view(), &hits, None).unwrap();
    let out = blocker.join("out");
    for error in [
        shown.save_png(&out.join("x.png")).unwrap_err(),
        exr::save(&out.join("x.exr"), &view(), &hits, None).unwrap_err(),
    ] {
        let message = error.to_string();
        assert!(message.contains(&format!("cannot create the folder {out:?}")), "{message}");
        assert!(message.contains("choose an output folder that can be written"), "{message}");
    }
}
