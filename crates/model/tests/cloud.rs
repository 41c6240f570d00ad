//! Files of points give clouds or messages that name the place: each format and its variants.

mod octahedron;

use std::path::Path;

use glam::DVec3;
use octahedron::{Coding, Normals, OCTAHEDRON, gzipped, obj, ply};
use zeroset_model::points::{Cloud, Dropped, Error, Place};

fn corners() -> Vec<DVec3> {
    OCTAHEDRON.iter().map(|c| DVec3::from(c.map(f64::from))).collect()
}

fn parse(name: &str, bytes: &[u8]) -> Result<(Cloud, Dropped), Error> {
    Cloud::parse(name, bytes.to_vec())
}

fn refused(name: &str, bytes: &[u8]) -> Error {
    let error = parse(name, bytes).unwrap_err();
    assert!(error.to_string().starts_with(name), "{error}");
    error
}

/// The octahedron's normals are its corners.
fn check_octahedron(name: &str, bytes: &[u8]) {
    let compressed = gzipped(bytes);
    for (name, bytes) in [(name.to_string(), bytes), (format!("{name}.gz"), &compressed[..])] {
        let (cloud, dropped) = parse(&name, bytes).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(dropped.total(), 0, "{name}: {dropped}");
        assert_eq!(cloud.points, corners(), "{name}");
        for (p, n) in cloud.points.iter().zip(&cloud.normals) {
            assert!((*p - *n).length() < 1e-12, "{name}: {p} {n}");
        }
    }
}

#[test]
fn all_formats_say_the_same() {
    for coding in [Coding::Ascii, Coding::Little, Coding::Big] {
        check_octahedron("a.ply", &ply(coding, Normals::Given));
        check_octahedron("a.PLY", &ply(coding, Normals::Absent));
    }
    let text = String::from_utf8(ply(Coding::Ascii, Normals::Absent)).unwrap();
    check_octahedron("a.ply", text.replace('\n', "\r\n").as_bytes());
    check_octahedron("a.ply", text.replace("indices", "index").as_bytes());
    check_octahedron("a.obj", obj(Normals::Absent, |i| format!("{}", i + 1)).as_bytes());
    check_octahedron("a.obj", obj(Normals::Absent, |i| format!("{}/1", i + 1)).as_bytes());
    check_octahedron("a.obj", obj(Normals::Absent, |i| format!("{}", i as i32 - 6)).as_bytes());
    check_octahedron("a.obj", obj(Normals::Given, |i| format!("{0}//{0}", i + 1)).as_bytes());
    check_octahedron(
        "a.obj",
        obj(Normals::Given, |i| format!("{0}/-1/{0}", i as i32 - 6)).as_bytes(),
    );
    let one_to_one = obj(Normals::Given, |i| format!("{}", i + 1));
    check_octahedron("a.obj", one_to_one.split("f ").next().unwrap().as_bytes());
    check_octahedron("a.obj", one_to_one.replace('\n', "\r\n").as_bytes());
    let rows =
        OCTAHEDRON.map(|[x, y, z]| format!("{x} {y} {z}  {x}e1 {y}e1\t{z}e1 # a corner\r\n"));
    check_octahedron("a.xyz", format!("# six\n\n{}", rows.concat()).as_bytes());
}

#[test]
fn normals_through_faces_are_means() {
    let text =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nvn 0 0 2\nvn 1 0 0\nf 1//1 2//1 3//1\nf 1//2 2 3\n";
    let (cloud, dropped) = parse("a.obj", text.as_bytes()).unwrap();
    assert_eq!(dropped, Dropped { without_normal: 1, ..Dropped::default() });
    let half = 0.5f64.sqrt();
    assert!((cloud.normals[0] - DVec3::new(half, 0.0, half)).length() < 1e-15);
    assert_eq!(cloud.normals[1..], [DVec3::Z; 2]);
}

#[test]
fn what_cannot_be_used_is_dropped_and_counted() {
    let text =
        "0 0 0 0 0 1\nnan 0 0 0 0 1\n1 0 0 0 0 0\n-0 0 0 1 0 0\n1 1 0 0 inf 0\n2 0 0 0 1e-300 0\n";
    let (cloud, dropped) = parse("a.xyz", text.as_bytes()).unwrap();
    assert_eq!(dropped, Dropped { not_finite: 2, duplicates: 1, without_normal: 1 });
    assert_eq!(
        dropped.to_string(),
        "4 points dropped: 2 not finite, 1 duplicates, 1 without a normal"
    );
    assert_eq!(cloud.points, [DVec3::ZERO, 2.0 * DVec3::X]);
    assert_eq!(cloud.normals, [DVec3::Z, DVec3::Y]);
}

/// A face at a duplicate counts for the first of its points, so that seams leave no mark.
#[test]
fn faces_at_duplicates_are_joined() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 4 5 6\n";
    let (cloud, dropped) = parse("a.obj", text.as_bytes()).unwrap();
    assert_eq!(dropped.duplicates, 2);
    let half = 0.5f64.sqrt();
    assert_eq!(cloud.points.len(), 4);
    assert!((cloud.normals[0] - DVec3::new(half, 0.0, half)).length() < 1e-15);
}

#[test]
fn faces_of_bad_points_count_for_nothing() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 1\nf 1 2 3\nf 1 2 4\n";
    let (cloud, dropped) = parse("a.obj", text.as_bytes()).unwrap();
    assert_eq!(dropped, Dropped { not_finite: 1, ..Dropped::default() });
    assert_eq!(cloud.normals, [DVec3::Z; 3]);
}

#[test]
fn messages_name_the_place() {
    let says = |name: &str, text: &str, place: Place, what: &str| {
        let error = refused(name, text.as_bytes());
        assert_eq!(error.place, place, "{error}");
        assert!(error.what.contains(what), "{error}");
    };
    use Place::{Byte, Line, Whole};
    says("a.stl", "", Whole, "no known format");
    says("a.xyz", "", Whole, "of 0 points none");
    says("a.xyz", "1 2 3 0 0 1", Whole, "of 1 points only one");
    says("a.xyz", "1 2 3\n1 2 3\n", Whole, "only one can be used (1 point dropped: 1 duplicates)");
    says("a.xyz", "\n1 2 x\n", Line(2), "\"x\" is not a number");
    says("a.xyz", "1 2 3\n1 2 3 4\n", Line(2), "4 words");
    says("a.xyz", "1 2 3\n1 2 3 0 0 1\n", Line(2), "6 numbers where lines before have 3");
    says("a.xyz", "1e200 0 0\n0 0 0\n", Whole, "diagonal inf");
    says("a.xyz", "1e-200 0 0\n0 0 0\n", Whole, "diagonal");
    says("a.xyz.gz", "1 2 3", Byte(0), "does not start as gzip");
    says("a.obj", "v 1 2\n", Line(1), "fewer than three");
    says("a.obj", "v 1 2 3\nv 0 0 0\nf 1 2 9\n", Line(3), "vertex 9 of 2");
    says("a.obj", "v 1 2 3\nf 1//7 1 1\n", Line(2), "normal 7 of 0");
    says("a.obj", "v 1 2 3\nf 0 1 1\n", Line(2), "index 0");
    says("a.obj", "v 1 2 3\nf -2 1 1\n", Line(2), "index -2, and 1 lie before");
    says("a.obj", "v 1 2 3\nf 1 b/2 1\n", Line(2), "\"b/2\"");

    let text = String::from_utf8(ply(Coding::Ascii, Normals::Absent)).unwrap();
    let start = text.find("end_header").unwrap() + 11;
    says("a.ply", "plx\n", Line(1), "magic");
    says("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", Line(4), "header");
    says("a.ply", &text.replace("float x", "float X"), Byte(start), "no element vertex");
    let huge = text.replace("vertex 6", "vertex 6000000000000");
    says("a.ply", &huge, Byte(start + 12), "6000000000000 elements vertex in");
    let bare = text.replace("end_header", "element void 12345678901\nend_header");
    says("a.ply", &bare, Byte(start + 25), "have no properties");
    says("a.ply", &text.replace("vertex 6", "vertex 5"), Line(28), "11 bytes follow");
    says("a.ply", &text.replace("vertex 6", "vertex 7"), Line(28), "\"2 0.5 0.25\"");
    says("a.ply", &text.replace("3 0 2 4", "3 0 2 7"), Byte(start), "names vertex 7");
    says("a.ply", &text.replace("3 0 2 4", "3 0 -2 4"), Line(20), "\"3 0 -2 4\"");
    says("a.ply", &text.replace("-1 200", "-1 y"), Line(15), "\"-1 y 0 0\"");
    let binary = ply(Coding::Big, Normals::Absent);
    let error = refused("a.ply", &binary[..binary.len() - 60]);
    assert_eq!(error.place, Byte(binary.len() - 60), "{error}");
    assert!(error.to_string().contains("cut short"), "{error}");

    let compressed = gzipped(text.as_bytes());
    let error = refused("a.ply.gz", &compressed[..compressed.len() - 9]);
    assert!(matches!(error.place, Byte(_)) && error.what.contains("gzip"), "{error}");
    let error = refused("a.xyz", &gzipped(&vec![b'0'; 1 << 25]));
    assert!(error.what.contains("more than 16777216 bytes in"), "{error}");
    let error = Cloud::read(Path::new("nowhere/a.ply")).unwrap_err();
    assert!(error.to_string().contains("nowhere/a.ply: cannot be read"), "{error}");
    assert!(Cloud::new(corners(), Vec::new()).unwrap_err().what.contains("0 normals"));
}

/// Points of a golden spiral on the unit sphere.
fn sphere(count: u32) -> impl Iterator<Item = DVec3> {
    let angle = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..count).map(move |i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let (s, c) = (angle * f64::from(i)).sin_cos();
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * c, r * s, z)
    })
}

/// Two spheres apart and a torus: the side is decided for each, and is the outside.
#[test]
fn estimated_normals_point_outwards() {
    let centres = [DVec3::ZERO, DVec3::new(5.0, 1.0, 0.0)];
    let spheres = centres.iter().flat_map(|c| sphere(500).map(move |p| (c + p, p)));
    let torus = (0..60).flat_map(|i| {
        let (s, c) = (f64::from(i) * std::f64::consts::TAU / 60.0).sin_cos();
        (0..24).map(move |j| {
            let (sj, cj) = (f64::from(j) * std::f64::consts::TAU / 24.0).sin_cos();
            let n = DVec3::new(c * cj, s * cj, sj);
            (DVec3::new(0.0, 9.0, 0.0) + 2.0 * DVec3::new(c, s, 0.0) + 0.7 * n, n)
        })
    });
    let (points, normals): (Vec<_>, Vec<_>) = spheres.chain(torus).unzip();
    let (cloud, _) = Cloud::estimated(points.clone()).unwrap();
    assert_eq!(cloud.points, points);
    for ((p, n), truth) in points.iter().zip(&cloud.normals).zip(&normals) {
        assert!((n.length() - 1.0).abs() < 1e-12);
        assert!(n.dot(*truth) > 0.98, "{p}: {n} {truth}");
    }
}

#[test]
fn estimated_normals_are_unit_wherever_points_lie() {
    let all: [Vec<DVec3>; 4] = [
        vec![DVec3::ZERO, DVec3::X],
        (0..50).map(|i| DVec3::new(f64::from(i), 0.0, 0.0)).collect(),
        (0..400).map(|i| DVec3::new(f64::from(i % 20), f64::from(i / 20), 2.0)).collect(),
        sphere(9).map(|p| 1e-50 * p + 1e-48).collect(),
    ];
    for points in all {
        let (cloud, _) = Cloud::estimated(points).unwrap();
        assert!(cloud.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-12), "{cloud:?}");
    }
}
