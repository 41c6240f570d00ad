//! Surfaces by name, file and equation.

use std::fs;

use crate::{done, files, folder, run, run_with};

#[test]
fn equations_files_and_values_may_begin_with_a_minus() {
    let dir = folder();
    let inverted = "-x^2-y^2-z^2+1";
    let printed = done(dir.path(), &["render", inverted, "--size", "8x8", "--out", "a.png"]);
    assert!(printed.contains("proven-hit") && printed.contains("a.png"), "{printed}");
    done(dir.path(), &["render", "--size", "8x8", "--out", "a.png", inverted]);
    let help = done(dir.path(), &["render", inverted, "--help"]);
    assert!(help.contains("Usage"), "{help}");
    fs::write(dir.path().join("surface.txt"), "x^2 + y^2 + z^2 = 1\n").unwrap();
    done(dir.path(), &["render", "surface.txt", "--size", "8x8", "--out", "b.png"]);
    let parameter =
        ["render", "x^2+y^2+z^2+a; a = 0", "--param", "a=-1", "--size", "8x8", "--out", "c.png"];
    assert!(done(dir.path(), &parameter).contains("proven-hit"));
    assert_eq!(files(dir.path()), ["a.png", "b.png", "c.png", "surface.txt"]);
    let [a, c] = ["a.png", "c.png"].map(|f| fs::read(dir.path().join(f)).unwrap());
    assert!(a.len() > 100 && c.len() > 100);
}

#[test]
fn files_hold_equations_and_catalogues() {
    let dir = folder();
    let write = |name: &str, text: &str| fs::write(dir.path().join(name), text).unwrap();
    write("own.txt", "\u{feff}# a ball\nx^2 + y^2 + z^2 = r^2;\nr = 2\n");
    let show = done(dir.path(), &["show", "own.txt"]);
    // Every line has its key, or goes on below the value.
    let keys = ["f ", "parameter ", "degree ", "domain ", "     "];
    assert!(show.lines().all(|l| keys.iter().any(|k| l.starts_with(k))), "{show}");
    let egg = "[[surface]]\nid = \"egg\"\nequation = \"x^2+y^2+2*z^2-1\"\n";
    write("one.toml", egg);
    write("two.toml", &format!("{egg}{}", egg.replace("egg", "leg")));
    assert!(done(dir.path(), &["show", "one.toml"]).contains("2*z^2"));
    assert!(done(dir.path(), &["show", "two.toml#leg"]).contains("2*z^2"));
    write("bad.txt", "x^2 +\n* y");
    write("bad.toml", &egg.replace("2*z", "2z"));
    for (surface, says) in [
        ("two.toml", &["egg, leg"][..]),
        ("two.toml#arm", &["arm", "egg, leg"]),
        ("bad.txt", &["in bad.txt", "2 | * y"]),
        ("bad.toml", &["bad.toml:3", "egg"]),
        ("none.toml", &["no file"]),
    ] {
        let outcome = run(dir.path(), &["show", surface]);
        assert_eq!((outcome.status, outcome.stdout.as_str()), (2, ""), "{surface}");
        for word in says {
            assert!(outcome.stderr.contains(word), "{surface}: {}", outcome.stderr);
        }
    }
}

#[cfg(unix)]
#[test]
fn an_equation_may_come_through_a_pipe() {
    let dir = folder();
    let outcome = run_with(dir.path(), &["show", "/dev/stdin"], "x^2 + y^2 = 3*z\n");
    assert_eq!(outcome.status, 0, "{}", outcome.stderr);
    assert!(outcome.stdout.contains("= 3*z"), "{}", outcome.stdout);
}

#[test]
fn what_there_is_is_listed_and_shown() {
    let dir = folder();
    let surfaces = done(dir.path(), &["list", "surfaces"]);
    assert!(surfaces.contains("barth-sextic") && surfaces.contains("klein"), "{surfaces}");
    let methods = done(dir.path(), &["list", "methods"]);
    for word in ["amp-sign", "kmarch", "reference", "depth"] {
        assert!(methods.contains(word), "{word} in {methods}");
    }
    let json: serde_json::Value =
        serde_json::from_str(&done(dir.path(), &["list", "--json"])).unwrap();
    assert!(json["surfaces"].as_array().unwrap().len() > 60);
    assert!(json["methods"].as_array().unwrap().iter().any(|m| m["id"] == "kmarch"));
    let show = done(dir.path(), &["show", "barth-sextic"]);
    assert!(show.contains("x^2") && show.contains("65") && show.contains("singh2010"), "{show}");
}
