//! Pictures are drawn as asked.

use std::fs;

use crate::{done, files, folder};

#[test]
fn equations_do_not_share_files() {
    let dir = folder();
    for equation in ["x^2+y^2+z^2-1", "x^2+y^2-z^2-1", "-x^2-y^2-z^2+1"] {
        done(dir.path(), &["render", equation, "--size", "8x8"]);
    }
    let names = files(&dir.path().join("out"));
    assert_eq!(names.len(), 3, "{names:?}");
    assert!(names.iter().all(|n| n.starts_with("x-2-y-2")), "{names:?}");
}

#[test]
fn a_legend_is_drawn_below_any_picture() {
    let dir = folder();
    for view in ["normal", "shaded", "depth", "steps", "certificate", "error"] {
        let arguments = ["render", "torus", "--size", "240x16", "--view", view, "--out", "p.png"];
        done(dir.path(), &arguments);
        let plain = image::open(dir.path().join("p.png")).unwrap().to_rgb8();
        done(dir.path(), &[&arguments[..], &["--legend"]].concat());
        let whole = image::open(dir.path().join("p.png")).unwrap().to_rgb8();
        assert_eq!((whole.width(), plain.dimensions()), (240, (240, 16)), "{view}");
        assert!(whole.height() > 16 + 20, "{view}");
        assert!(plain.enumerate_pixels().all(|(x, y, p)| whole.get_pixel(x, y) == p), "{view}");
    }
}

#[test]
fn samples_soften_edges() {
    let dir = folder();
    let colours = |samples: &str| {
        let arguments = ["render", "x^2+y^2+z^2-1", "--method", "beam-adaptive", "--size", "40x30"];
        let rest = ["--view", "certificate", "--samples", samples, "--out", "s.png"];
        done(dir.path(), &[&arguments[..], &rest].concat());
        let picture = image::open(dir.path().join("s.png")).unwrap().to_rgb8();
        assert_eq!(picture.dimensions(), (40, 30));
        let mut colours: Vec<_> = picture.pixels().map(|p| p.0).collect();
        colours.sort_unstable();
        colours.dedup();
        colours.len()
    };
    // Possible hits and proven misses; then mixtures of a quarter, a half and three.
    assert_eq!(colours("1"), 2);
    assert_eq!(colours("4"), 5);
}

#[test]
fn right_is_right_and_up_is_up() {
    let dir = folder();
    // From the front (y < 0), with z up: a ball to the right, and a smaller one above the centre.
    let balls = "((x-1)^2+y^2+z^2-0.09)*(x^2+y^2+(z-1)^2-0.01)";
    for camera in ["eye=0,-6,0,fov=30", "eye=0,-6,0,ortho=3"] {
        let arguments =
            ["render", balls, "--size", "90x90", "--view", "certificate", "--camera", camera];
        done(
            dir.path(),
            &[&arguments[..], &["--domain", "-2,-2,-2,2,2,2", "--out", "b.png"]].concat(),
        );
        let picture = image::open(dir.path().join("b.png")).unwrap().to_rgb8();
        let is_hit = |x: u32, y: u32| picture.get_pixel(x, y) != picture.get_pixel(0, 0);
        assert!(is_hit(74, 45) && !is_hit(15, 45), "{camera}: right");
        assert!(is_hit(45, 15) && !is_hit(45, 74), "{camera}: up");
    }
}

#[test]
fn every_view_is_drawn_and_hits_are_written_as_numbers() {
    let dir = folder();
    for view in ["normal", "shaded", "depth", "steps", "certificate", "error"] {
        done(dir.path(), &["render", "torus", "--size", "16x12", "--view", view]);
        let file = dir.path().join(format!("out/torus-kmarch-{view}.png"));
        let picture = image::open(file).unwrap();
        assert_eq!((picture.width(), picture.height()), (16, 12), "{view}");
    }
    done(dir.path(), &["render", "torus", "--size", "16x12", "--out", "torus.exr"]);
    let image = exr::prelude::read_all_data_from_file(dir.path().join("torus.exr")).unwrap();
    let layer = &image.layer_data[0];
    let names: Vec<_> = layer.channel_data.list.iter().map(|c| c.name.to_string()).collect();
    assert_eq!((layer.size.0, layer.size.1), (16, 12));
    for name in ["t", "t.lo", "t.hi", "N.X", "certificate", "steps"] {
        assert!(names.contains(&name.into()), "{names:?}");
    }
}

#[test]
fn answers_do_not_depend_on_threads() {
    let dir = folder();
    let mut pictures = Vec::new();
    for threads in ["1", "2", "3"] {
        let arguments =
            ["render", "klein", "--size", "40x33", "--threads", threads, "--out", "k.exr"];
        done(dir.path(), &arguments);
        pictures.push(fs::read(dir.path().join("k.exr")).unwrap());
    }
    assert!(pictures.windows(2).all(|p| p[0] == p[1]));
}

#[test]
fn an_environment_is_seen_and_mirrored() {
    let dir = folder();
    let picture = |arguments: &[&str]| {
        let all = ["render", "sphere", "--size", "48x48", "--out", "e.png"];
        done(dir.path(), &[&all[..], arguments].concat());
        image::open(dir.path().join("e.png")).unwrap().to_rgb8()
    };
    let plain = picture(&[]);
    assert_eq!(plain, picture(&["--environment", "plain"]));
    let sky = picture(&["--environment", "sky"]);
    assert_eq!(sky, picture(&["--environment", "sky"]));
    // Both what is hit and what is not look otherwise.
    for [x, y] in [[24, 24], [1, 1], [46, 46]] {
        assert_ne!(plain.get_pixel(x, y), sky.get_pixel(x, y), "{x} {y}");
    }
}
