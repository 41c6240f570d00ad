//! The command line does what it says, and refuses what it cannot do with a message and a status.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use tempfile::TempDir;

/// What the program did.
struct Outcome {
    status: i32,
    stdout: String,
    stderr: String,
}

/// Starts the program in a folder.
fn start(folder: &Path, arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_zeroset"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Runs the program in a folder, with text on standard input.
fn run_with(folder: &Path, arguments: &[&str], input: &str) -> Outcome {
    let mut child = start(folder, arguments);
    // The program may refuse its arguments without reading.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    end(child)
}

/// Waits for the program to end.
fn end(child: Child) -> Outcome {
    let output = child.wait_with_output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    Outcome {
        status: output.status.code().expect("the program was not killed"),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    }
}

fn run(folder: &Path, arguments: &[&str]) -> Outcome {
    run_with(folder, arguments, "")
}

/// Runs the program, which must succeed, and gives what it printed.
fn done(folder: &Path, arguments: &[&str]) -> String {
    let outcome = run(folder, arguments);
    assert_eq!(outcome.status, 0, "{arguments:?}: {}", outcome.stderr);
    outcome.stdout
}

/// Files in a folder, sorted.
fn files(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut names: Vec<_> =
        entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

const SPHERE: &str = "x^2+y^2+z^2=1";
const HEADER: &str = "ox,oy,oz,dx,dy,dz";

#[test]
fn bad_input_is_refused_with_place_and_remedy() {
    let dir = folder();
    fn render<'a>(more: &[&'a str]) -> Vec<&'a str> {
        [&["render", SPHERE, "--size", "8x8"], more].concat()
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
        (render(&["--threads", "0"]), "1 to 1024"),
        (render(&["--threads", "-2"]), "1 to 1024"),
        (render(&["--colour", "red"]), "--colour"),
        (compare(&["--runs", "0"]), "from 1"),
        (compare(&["--methods", "kmarch,abc"]), "abc"),
        (compare(&["--methods", "kmarch,kmarch"]), "twice"),
        (compare(&["--methods", ""]), "method"),
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
    let outcome = run(
        dir.path(),
        &["trace", SPHERE, "--method", "kmarch", "--rays", "none.csv", "--out", "-"],
    );
    assert_eq!((outcome.status, outcome.stderr.contains("none.csv")), (1, true));
}

#[test]
fn folders_are_made_and_unwritable_ones_named() {
    let dir = folder();
    fs::write(dir.path().join("file"), "").unwrap();
    for arguments in [
        ["render", SPHERE, "--size", "8x8", "--out", "file/picture.png"],
        ["compare", SPHERE, "--size", "8x8", "--out", "file/folder"],
    ] {
        let outcome = run(dir.path(), &arguments);
        assert_eq!(outcome.status, 1, "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains("file"), "{}", outcome.stderr);
        assert_eq!(files(dir.path()), ["file"]);
    }
    done(dir.path(), &["render", SPHERE, "--size", "8x8", "--out", "a/b/picture.png"]);
    assert_eq!(files(&dir.path().join("a/b")), ["picture.png"]);
}

/// A row of answers.
#[derive(Debug, serde::Deserialize)]
struct Answer {
    ray: usize,
    certificate: String,
    t_lo: f64,
    t_hi: f64,
    nx: f32,
    ny: f32,
    nz: f32,
    points: u64,
    gradients: u64,
    intervals: u64,
}

fn answers(text: &str) -> Vec<Answer> {
    csv::Reader::from_reader(text.as_bytes()).deserialize().map(Result::unwrap).collect()
}

#[test]
fn rays_go_in_and_answers_come_out_in_order() {
    let dir = folder();
    // Extra columns and another order are fine; the direction is counted as given.
    let rays = "note,dx,dy,dz,ox,oy,oz\nhit,0,0,2,0,0,-3\nmiss,1,0,0,0,0,-3\ninside,0,0,-1,0,0,0\n";
    for method in ["amp-sign", "kmarch", "reference"] {
        let arguments = [
            "trace",
            SPHERE,
            "--method",
            method,
            "--rays",
            "-",
            "--out",
            "-",
            "--precision",
            "1e-6",
        ];
        let outcome = run_with(dir.path(), &arguments, rays);
        assert_eq!(outcome.status, 0, "{}", outcome.stderr);
        let header = "ray,certificate,t_lo,t_hi,nx,ny,nz,points,gradients,intervals\n";
        assert!(outcome.stdout.starts_with(header), "{}", outcome.stdout);
        let answers = answers(&outcome.stdout);
        assert_eq!(answers.iter().map(|a| a.ray).collect::<Vec<_>>(), [0, 1, 2]);
        for (i, t, nz) in [(0, 1.0, -1.0), (2, 1.0, -1.0)] {
            let a = &answers[i];
            assert!(a.t_lo <= t + 1e-5 && t - 1e-5 <= a.t_hi, "{method}: {a:?}");
            assert!((a.nz - nz).abs() < 1e-4 && a.nx.abs() + a.ny.abs() < 1e-4, "{method}: {a:?}");
            assert!(a.points + a.gradients + a.intervals > 0, "{method}: {a:?}");
            if method != "amp-sign" {
                assert_eq!(a.certificate, "proven-hit", "{method}: {a:?}");
                assert!(a.t_lo <= t && t <= a.t_hi, "{method}: {a:?}");
            }
        }
        let miss = &answers[1];
        assert!(miss.certificate.ends_with("miss"), "{miss:?}");
        assert_eq!((miss.t_lo, miss.t_hi), (f64::INFINITY, f64::INFINITY));
        assert_eq!((miss.nx, miss.ny, miss.nz), (0.0, 0.0, 0.0));

        // The same through files.
        fs::write(dir.path().join("rays.csv"), rays).unwrap();
        let arguments = [
            "trace",
            SPHERE,
            "--method",
            method,
            "--rays",
            "rays.csv",
            "--out",
            "answers.csv",
            "--precision",
            "1e-6",
        ];
        assert_eq!(done(dir.path(), &arguments), "");
        assert_eq!(fs::read_to_string(dir.path().join("answers.csv")).unwrap(), outcome.stdout);
    }
}

#[test]
fn a_domain_given_replaces_that_of_the_catalogue() {
    let dir = folder();
    let rays = format!("{HEADER}\n0,0,-9,0,0,1\n");
    let trace = |more: &[&str]| {
        let arguments =
            ["trace", SPHERE, "--method", "kmarch", "--rays", "-", "--out", "-"].as_slice();
        let outcome = run_with(dir.path(), &[arguments, more].concat(), &rays);
        assert_eq!(outcome.status, 0, "{}", outcome.stderr);
        answers(&outcome.stdout).remove(0)
    };
    assert!(trace(&[]).t_lo < 8.01);
    assert!(trace(&["--domain", "-2,-2,0,2,2,2"]).t_lo > 9.99);
    assert_eq!(trace(&["--domain", "-2,-2,1.5,2,2,2"]).certificate, "proven-miss");
}

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

fn records(file: &Path) -> Vec<zeroset::bench::Record> {
    csv::Reader::from_path(file).unwrap().deserialize().map(Result::unwrap).collect()
}

#[test]
fn compare_prints_a_table_and_writes_pictures_and_records() {
    let dir = folder();
    let arguments = ["compare", "barth-sextic", "--size", "24x16", "--runs", "2", "--out", "o"];
    let printed = done(dir.path(), &arguments);
    for word in ["amp-sign", "kmarch", "frame ms", "Mrays/s", "proven-hit", "false misses", "|dt|"]
    {
        assert!(printed.contains(word), "{word} in {printed}");
    }
    assert!(printed.lines().all(|l| l.chars().count() <= 120), "{printed}");
    let out = dir.path().join("o");
    let names = files(&out);
    for method in ["amp-sign", "kmarch"] {
        for suffix in [".png", "-error.png", ".exr"] {
            assert!(names.contains(&format!("barth-sextic-{method}{suffix}")), "{names:?}");
        }
    }
    assert!(names.contains(&"barth-sextic-sheet.png".into()), "{names:?}");
    assert!(names.iter().all(|n| !n.starts_with('.')), "{names:?}");
    let picture = image::open(out.join("barth-sextic-kmarch.png")).unwrap();
    assert_eq!((picture.width(), picture.height()), (24, 16));

    let first = records(&out.join("records.csv"));
    let kmarch = first.iter().find(|r| r.method == "kmarch").unwrap();
    assert_eq!((kmarch.scene.as_str(), kmarch.width, kmarch.height), ("barth-sextic", 24, 16));
    assert_eq!((kmarch.outcome.as_str(), kmarch.runs, kmarch.lies), ("ok", 2, 0));
    assert!(kmarch.camera.contains("40") && kmarch.knobs.contains("depth="), "{kmarch:?}");
    assert!(kmarch.threads > 0 && !kmarch.revision.is_empty() && !kmarch.cpu.is_empty());
    assert_eq!(kmarch.judged, 24 * 16);

    // A second run adds its rows, and prints them.
    let json = done(dir.path(), &[&arguments[..], &["--json", "--methods", "amp-sign"]].concat());
    let printed: Vec<zeroset::bench::Record> = serde_json::from_str(&json).unwrap();
    let both = records(&out.join("records.csv"));
    assert_eq!((printed.len(), both.len()), (1, first.len() + 1));
    assert_eq!(both.last(), printed.last());
    assert_eq!(&both[..first.len()], &first[..]);
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

#[test]
fn every_command_explains_itself() {
    let dir = folder();
    for command in ["list", "show", "render", "compare", "trace"] {
        let help = done(dir.path(), &[command, "--help"]);
        assert!(help.contains("Usage") && help.contains("default"), "{help}");
    }
    assert!(done(dir.path(), &["--version"]).starts_with("zeroset "));
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

#[cfg(unix)]
#[test]
fn an_interruption_keeps_what_is_finished_whole() {
    // How long the first method takes until it is timed depends on the machine.
    for wait in [2, 4, 8, 16, 32] {
        let dir = folder();
        let arguments = ["compare", SPHERE, "--methods", "amp-sign,kmarch", "--size", "16x16"];
        let child = start(dir.path(), &[&arguments[..], &["--runs", "1000000"]].concat());
        std::thread::sleep(Duration::from_secs(wait));
        let pid = child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
        let outcome = end(child);
        assert_eq!(outcome.status, 130, "{}", outcome.stderr);
        assert!(outcome.stderr.contains("interrupted"), "{}", outcome.stderr);
        let out = dir.path().join("out");
        assert!(files(&out).iter().all(|f| !f.starts_with('.')), "{:?}", files(&out));
        if !out.join("records.csv").exists() {
            assert_eq!(files(&out), [""; 0]);
            continue;
        }
        let records = records(&out.join("records.csv"));
        assert_eq!(records.iter().map(|r| r.method.as_str()).collect::<Vec<_>>(), ["amp-sign"]);
        assert_eq!(records[0].outcome, "ok");
        assert!(outcome.stdout.contains("amp-sign"), "{}", outcome.stdout);
        assert!(files(&out).iter().any(|f| f.ends_with("-amp-sign.png")), "{:?}", files(&out));
        return;
    }
    panic!("nothing was finished in 32 s");
}

#[cfg(unix)]
#[test]
fn an_interrupted_picture_is_not_written() {
    let dir = folder();
    let arguments = ["render", "barth-decic", "--size", "4096x2048", "--precision", "1e-9"];
    let child = start(dir.path(), &arguments);
    std::thread::sleep(Duration::from_secs(2));
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    let outcome = end(child);
    assert_eq!((outcome.status, outcome.stdout.as_str()), (130, ""), "{}", outcome.stderr);
    assert_eq!(files(&dir.path().join("out")), [""; 0]);
}

#[test]
fn a_reader_that_has_seen_enough_is_no_failure() {
    let dir = folder();
    let mut child = start(dir.path(), &["list", "--json"]);
    drop(child.stdout.take());
    let outcome = end(child);
    assert_eq!((outcome.status, outcome.stderr.as_str()), (0, ""));
}
