//! The command line does what it says, and refuses what it cannot do with a message and a status.

mod animation;
mod devices;
mod pictures;
mod pieces;
mod rays;
mod refusals;
mod shadows;
mod surfaces;

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

    // A row says how to repeat it.
    assert_eq!(kmarch.request, "first-with-normal");
    let equation = "x^2+y^2+z^2=1";
    let camera = "eye=3.0,-2.0,1.0,at=0.0,0.0,0.1,up=0.0,0.0,1.0,ortho=2.5";
    let domain = "-1.0,-1.0,-1.0,1.0,1.0,0.5";
    let view = ["--camera", camera, "--domain", domain, "--view", "certificate"];
    let small = ["compare", equation, "--methods", "kmarch", "--size", "8x8", "--out", "p"];
    let seed = ["--seed", "7"];
    done(dir.path(), &[&small[..], &view, &seed].concat());
    let row = records(&dir.path().join("p/records.csv")).remove(0);
    assert_eq!((row.camera.as_str(), row.domain.as_str(), row.seed), (camera, domain, 7));
    assert_eq!((row.equation.as_str(), row.request.as_str()), (equation, "first"));

    // A second run adds its rows, and prints them.
    let json = done(dir.path(), &[&arguments[..], &["--json", "--methods", "amp-sign"]].concat());
    let printed: Vec<zeroset::bench::Record> = serde_json::from_str(&json).unwrap();
    let both = records(&out.join("records.csv"));
    assert_eq!((printed.len(), both.len()), (1, first.len() + 1));
    assert_eq!(both.last(), printed.last());
    assert_eq!(&both[..first.len()], &first[..]);
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
