//! Surfaces in pieces are built, drawn and compared; what is no such file is refused.

use std::fs;

use super::{done, folder, records, run};

/// Points of the unit sphere with their normals, as lines.
fn points(count: u32) -> String {
    let line = |i: u32| {
        let z = (f64::from(i) + 0.5) / f64::from(count) * 2.0 - 1.0;
        let (sin, cos) = (2.399_963_229_728_653 * f64::from(i)).sin_cos();
        let flat = (1.0 - z * z).sqrt();
        let (x, y) = (flat * cos, flat * sin);
        format!("{x} {y} {z} {x} {y} {z}\n")
    };
    (0..count).map(line).collect()
}

#[test]
fn points_become_a_surface_that_is_cast_and_judged() {
    let folder = folder();
    fs::write(folder.path().join("ball.xyz"), points(5000)).unwrap();
    let told = done(folder.path(), &["slim", "build", "ball.xyz", "--out", "ball.slim"]);
    assert!(told.contains("5000 points") && told.contains("ball.slim"), "{told}");
    let told = done(folder.path(), &["render", "ball.slim", "--size", "40x40"]);
    assert!(told.contains("out/ball-quadric-shaded.png"), "{told}");
    assert!(folder.path().join("out/ball-quadric-shaded.png").exists());
    let compare = ["compare", "ball.slim", "--size", "32x32", "--runs", "1"];
    let table = done(folder.path(), &compare);
    assert!(table.contains("quadric-brute") && !table.contains("kmarch"), "{table}");
    for record in records(&folder.path().join("out/records.csv")) {
        assert_eq!(record.equation, "ball.slim");
        assert_eq!((record.lies, record.false_hits), (0, 0), "{}", record.method);
        assert_eq!(record.outcome, "ok", "{}", record.method);
    }
}

#[test]
fn volumes_become_tetrahedra() {
    let folder = folder();
    let build = ["volume", "build", "sphere:24", "--iso", "0.7", "--above"];
    let told = done(folder.path(), &build);
    assert!(told.contains("tetrahedra") && told.contains("out/sphere-24.tets"), "{told}");
    let told = done(folder.path(), &["render", "out/sphere-24.tets", "--size", "32x32"]);
    assert!(told.contains(" hits of 1024 rays"), "{told}");
    let told = done(folder.path(), &["render", "skin-water", "--size", "32x32"]);
    assert!(!told.starts_with("0 hits"), "{told}");
    // Both are seen from the same place.
    let domain = |id| {
        let told = done(folder.path(), &["show", id]);
        told.lines().find(|line| line.starts_with("domain")).map(String::from).expect("a domain")
    };
    assert_eq!(domain("folded-strip"), domain("folded-strip-triangles"));
    let told = done(folder.path(), &["show", "skin-water"]);
    assert!(told.contains("0 in balls, 42 in tetrahedra"), "{told}");
}

#[test]
fn what_is_no_surface_in_pieces_is_refused() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("empty.xyz", "");
    write("text.slim", "no surface");
    write("text.tets", "no surface");
    write("short.ply", "ply\nformat ascii 1.0\nelement vertex 5\n");
    for (arguments, why) in [
        (&["slim", "build", "empty.xyz"][..], "empty.xyz"),
        (&["slim", "build", "short.ply"], "short.ply"),
        (&["slim", "build", "none.ply"], "none.ply"),
        (&["slim", "build", "empty.xyz", "--out", "a.png"], "does not end in .slim"),
        (&["render", "text.slim"], "no SLIM surface"),
        (&["render", "none.slim"], "none.slim"),
        (&["render", "text.tets"], "text.tets"),
        (&["volume", "build", "text.raw", "--iso", "1"], "layout"),
        (&["volume", "build", "sphere:many", "--iso", "1"], "number of samples"),
        (&["volume", "build", "sphere:8", "--iso", "99"], "99"),
        (&["render", "skin-water", "--param", "r=1"], "--param"),
        (&["render", "skin-water", "--method", "kmarch"], "functions only"),
        (&["render", "sphere", "--method", "quadric"], "quadrics in bounds only"),
    ] {
        let outcome = run(folder.path(), arguments);
        assert!(matches!(outcome.status, 1 | 2), "{arguments:?}: {}", outcome.status);
        assert!(outcome.stderr.contains(why), "{arguments:?}: {}", outcome.stderr);
        assert_eq!(outcome.stdout, "", "{arguments:?}");
    }
}
