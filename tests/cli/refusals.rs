//! Bad input is refused with a message and a status, and nothing is written.

use std::fs;

use crate::{HEADER, SPHERE, done, files, folder, run, run_with};

#[test]
fn bad_input_is_refused_with_place_and_remedy() {
    let dir = folder();
    fn render<'a>(more: &[&'a str]) -> Vec<&'a str> {
        [&["render", SPHERE, "--size", "8x8"], more].concat()
    }
    fn animate<'a>(more: &[&'a str]) -> Vec<&'a str> {
        [&["render", "morph-hyperboloid-torus", "--size", "8x8"], more].concat()
    }
    fn compare<'a>(more: &[&'a str]) -> Vec<&'a str> {
        [&["compare", SPHERE, "--size", "8x8"], more].concat()
    }
    let cases: Vec<(Vec<&str>, &str)> = vec![
        (vec![], "Usage"),
        (vec!["paint"], "paint"),
        (vec!["render"], "SURFACE"),
        (vec!["render", "barth-sextik"], "barth-sextic"),
        (vec!["show", "x^2+"], "x^2+"),
        (vec!["render", "x^2+*y"], "*"),
        (vec!["render", "x^2+q(y)"], "q"),
        (vec!["render", ""], ""),
        (vec!["list", "methds"], "methods"),
        (render(&["--method", "kmarsh"]), "kmarch"),
        (render(&["--view", "normals"]), "normal"),
        (render(&["--param", "b=1"]), "b"),
        (render(&["--param", "b"]), "NAME=VALUE"),
        (render(&["--set", "kmarch.dpth=1"]), "depth"),
        (render(&["--set", "kmarch.depth=deep"]), "depth"),
        (render(&["--set", "kmrch.depth=1"]), "kmarch"),
        (render(&["--set", "depth=1"]), "METHOD.KNOB=VALUE"),
        (render(&["--set", "amp-sign.step=0.1"]), "kmarch"),
        (render(&["--precision", "0"]), "above 0"),
        (render(&["--precision", "-1"]), "above 0"),
        (render(&["--precision", "NaN"]), "finite"),
        (render(&["--precision", "inf"]), "finite"),
        (render(&["--precision", "fine"]), "number"),
        (render(&["--domain", "1,1,1,1,1,1"]), "empty"),
        (render(&["--domain", "1,1,1,-1,-1,-1"]), "empty"),
        (render(&["--domain", "-1,-1,-1,1,1"]), "six"),
        (render(&["--domain", "-1,-1,-1,1,1,nan"]), "finite"),
        (render(&["--camera", "eye=0,0,0"]), "eye"),
        (render(&["--camera", "eye=1,2"]), "three"),
        (render(&["--camera", "fov=200"]), "180"),
        (render(&["--camera", "zoom=2"]), "zoom"),
        (render(&["--out", "picture.jpg"]), ".png"),
        (render(&["--domain", "0,0,0,1e300,1e300,1e300"]), "too large"),
        (render(&["--domain", "0,0,0,1e-300,1e-300,1e-300"]), "too small"),
        (render(&["--camera", "ortho=1e300"]), "ortho smaller"),
        (render(&["--out", "hits.exr", "--legend"]), "--legend"),
        (render(&["--samples", "3"]), "square"),
        (render(&["--samples", "0"]), "square"),
        (render(&["--samples", "4", "--out", "hits.exr"]), "--samples"),
        (render(&["--method", "amp-sign-gpu", "--samples", "4", "--resident"]), "--samples"),
        (render(&["--set", "kmarch.depth=2.5"]), "whole number"),
        (render(&["--set", "kmarch.width=0"]), "e308"),
        (render(&["--seed", "1"]), "--seed"),
        (render(&["--out", "folder"]), ".png or .exr"),
        (render(&["--out", "folder/"]), ".png or .exr"),
        (render(&["--light", "0,0,0"]), "no direction"),
        (render(&["--light", "1,2"]), "three"),
        (render(&["--light", "1,nan,2"]), "finite"),
        (render(&["--shadows", "soft"]), "soft"),
        (render(&["--shadows", "on", "--view", "depth"]), "--view shaded"),
        (render(&["--light", "1,2,3", "--view", "normal"]), "--view shaded"),
        (render(&["--environment", "sky", "--view", "steps"]), "--view shaded"),
        (render(&["--environment", "forest"]), "plain, sky"),
        (render(&["--resume"]), "--animate"),
        (render(&["--apng", "a.png"]), "--animate"),
        (animate(&["--animate", "w=0:1:0"]), "from 1 to"),
        (animate(&["--animate", "w=0:1"]), "FROM:TO:FRAMES"),
        (animate(&["--animate", "w=nan:1:3"]), "nan"),
        (animate(&["--animate", "w=0:inf:3"]), "inf"),
        (animate(&["--animate", "w=0:1/0:3"]), "1/0"),
        (animate(&["--animate", "w=root:u^3-2:1:3"]), "FROM:TO:FRAMES"),
        (animate(&["--animate", "v=0:1:3"]), "`v`"),
        (animate(&["--animate", "azimuth=0:x:3"]), "\"x\""),
        (animate(&["--animate", "w=0:1:3", "--animate", "r=0:1:4"]), "r=0:1:4 has 4"),
        (animate(&["--animate", "w=0:1:3", "--animate", "r=0:1:4"]), "w=0:1:3 has 3"),
        (animate(&["--animate", "w=0:1:3", "--animate", "w=1:0:3"]), "both move w"),
        (animate(&["--animate", "w=0:1:3", "--param", "w=1"]), "both set w"),
        (animate(&["--animate", "w=0:1:3", "--out", "f.gif"]), ".png"),
        (animate(&["--animate", "w=0:1:3", "--apng", "a.gif"]), ".png"),
        (animate(&["--animate", "w=0:1:3", "--fps", "9"]), "--apng"),
        (animate(&["--animate", "w=0:1:3", "--apng", "a.png", "--fps", "0"]), "1..=1000"),
        (animate(&["--animate", "w=0:1:3", "--apng", "a.png", "--out", "f.exr"]), "--apng"),
        (animate(&["--animate", "w=0:1:3", "--out", "f.png", "--apng", "f-0001.png"]), "frame"),
        (animate(&["--animate", "w=0:1:3", "--out", "f.exr", "--legend"]), "--legend"),
        (vec!["render", "/"], "folder"),
        (render(&["--threads", "0"]), "1 to 1024"),
        (render(&["--threads", "-2"]), "1 to 1024"),
        (render(&["--colour", "red"]), "--colour"),
        (compare(&["--runs", "0"]), "from 1"),
        (compare(&["--methods", "kmarch,abc"]), "abc"),
        (compare(&["--methods", "kmarch,kmarch"]), "twice"),
        (compare(&["--methods", ""]), "method"),
        (compare(&["--methods", "all,kmarch"]), "not both"),
        (vec!["render", SPHERE, "--size", "0x0"], "16384"),
        (vec!["render", SPHERE, "--size", "100000x100000"], "16384"),
        (vec!["render", SPHERE, "--size", "512"], "512x512"),
        (vec!["compare", SPHERE, "--size", "-4x4"], "16384"),
    ];
    for (arguments, says) in cases {
        let outcome = run(dir.path(), &arguments);
        assert_eq!(outcome.status, 2, "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(says), "{arguments:?}: {}", outcome.stderr);
        assert!(!outcome.stderr.contains("panicked"), "{arguments:?}: {}", outcome.stderr);
        assert_eq!(outcome.stdout, "", "{arguments:?}");
        assert_eq!(files(dir.path()), [""; 0], "{arguments:?}");
    }
}

#[test]
fn bad_rays_are_refused_with_their_line() {
    let dir = folder();
    let out = dir.path().join("answers.csv");
    for (rows, says) in [
        ("0,0,-3,0,0,one\n", "line 2"),
        ("0,0,-3,0,0,1\n0,0,-3,0,0,NaN\n", "line 3"),
        ("0,0,-3,0,0,1\n\n0,0,inf,0,0,1\n", "line 4"),
        ("0,0,-3,0,0,0\n", "direction is zero"),
        ("0,0,-3,0,0,1e-50\n", "direction is zero"),
        ("0,0,-3,0,0,1e40\n", "beyond single precision"),
        ("0,0,-3,0,0\n", "5 fields"),
        ("0,0,-3,0,0,\n", "dz"),
    ] {
        let arguments =
            ["trace", SPHERE, "--method", "kmarch", "--rays", "-", "--out", out.to_str().unwrap()];
        let outcome = run_with(dir.path(), &arguments, &format!("{HEADER}\n{rows}"));
        assert_eq!(outcome.status, 1, "{rows}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(says), "{rows}: {}", outcome.stderr);
        assert_eq!(files(dir.path()), [""; 0], "{rows}");
    }
    for (text, says) in [("", "ox"), ("x,y,z\n1,2,3\n", "ox"), ("ox,oy,oz,dx,dy\n", "dz")] {
        fs::write(dir.path().join("rays.csv"), text).unwrap();
        let arguments =
            ["trace", SPHERE, "--method", "kmarch", "--rays", "rays.csv", "--out", "answers.csv"];
        let outcome = run(dir.path(), &arguments);
        assert_eq!(outcome.status, 1, "{text}: {}", outcome.stderr);
        assert!(outcome.stderr.contains("rays.csv") && outcome.stderr.contains(says));
        assert_eq!(files(dir.path()), ["rays.csv"], "{text}");
    }
    for (file, says) in [("none.csv", "none.csv"), (".", "folder")] {
        let arguments = ["trace", SPHERE, "--method", "kmarch", "--rays", file, "--out", "-"];
        let outcome = run(dir.path(), &arguments);
        assert_eq!(outcome.status, 1, "{file}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(says), "{file}: {}", outcome.stderr);
    }
}

#[test]
fn answers_do_not_overwrite_their_rays() {
    let dir = folder();
    let rays = format!("{HEADER}\n0,0,-3,0,0,1\n");
    fs::write(dir.path().join("rays.csv"), &rays).unwrap();
    let arguments =
        ["trace", SPHERE, "--method", "kmarch", "--rays", "rays.csv", "--out", "./rays.csv"];
    let outcome = run(dir.path(), &arguments);
    assert_eq!(outcome.status, 2, "{}", outcome.stderr);
    assert!(outcome.stderr.contains("overwrite"), "{}", outcome.stderr);
    assert_eq!(fs::read_to_string(dir.path().join("rays.csv")).unwrap(), rays);
}

#[test]
fn folders_are_made_and_unwritable_ones_named() {
    let dir = folder();
    fs::write(dir.path().join("file"), "").unwrap();
    for arguments in [
        ["render", SPHERE, "--size", "8x8", "--out", "file/picture.png"],
        ["compare", SPHERE, "--size", "8x8", "--out", "file/folder"],
        ["render", SPHERE, "--out", "file/frames/", "--animate", "azimuth=0:9:2"],
    ] {
        let outcome = run(dir.path(), &arguments);
        assert_eq!(outcome.status, 1, "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains("file"), "{}", outcome.stderr);
        assert_eq!(files(dir.path()), ["file"]);
    }
    done(dir.path(), &["render", SPHERE, "--size", "8x8", "--out", "a/b/picture.png"]);
    assert_eq!(files(&dir.path().join("a/b")), ["picture.png"]);
}

#[test]
fn a_file_that_is_not_of_records_is_left_alone() {
    let dir = folder();
    fs::write(dir.path().join("records.csv"), "a,b\n1,2\n").unwrap();
    let outcome = run(dir.path(), &["compare", SPHERE, "--size", "8x8", "--out", "."]);
    assert_eq!(outcome.status, 1);
    assert!(outcome.stderr.contains("records.csv"), "{}", outcome.stderr);
    assert_eq!(files(dir.path()), ["records.csv"]);
    assert_eq!(fs::read_to_string(dir.path().join("records.csv")).unwrap(), "a,b\n1,2\n");
}
