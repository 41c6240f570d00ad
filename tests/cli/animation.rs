//! Frames are the pictures of their values, and none is lost.

use std::fs::{self, File};
use std::io::BufReader;
use std::time::Duration;

use image::AnimationDecoder;
use image::codecs::png::PngDecoder;

use crate::{SPHERE, done, end, files, folder, run, start};

const MORPH: &str = "morph-hyperboloid-torus";

#[test]
fn frames_are_the_pictures_of_their_values_bit_for_bit() {
    let dir = folder();
    let size = ["--size", "24x16"];
    for (more, extension) in [
        (&["--shadows", "on"][..], "png"),
        (&["--method", "amp-sign", "--light", "1,0,3", "--shadows", "on"], "png"),
        (&["--view", "depth", "--legend"], "png"),
        (&["--view", "error"], "png"),
        (&["--set", "kmarch.finish=accept", "--shadows", "on"], "exr"),
        (&["--method", "reference", "--view", "certificate"], "png"),
    ] {
        let out = format!("frames/m.{extension}");
        let moves = ["--animate", "w=0:0.3:4", "--animate", "a = 1/2 : sqrt(2) : 4"];
        let arguments = [&["render", MORPH, "--out", &out], &size[..], &moves, more].concat();
        let printed = done(dir.path(), &arguments);
        for word in ["prepared once", "median", "least", "most", "4 frames", &out[..8]] {
            assert!(printed.contains(word), "{word}: {printed}");
        }
        for (i, [w, a]) in [
            ["0", "0.5"],
            ["1/10", "1/2 + (sqrt(2) - 1/2)*1/3"],
            ["0.2", "(1/2) + ((sqrt(2)) - (1/2))*2/3"],
            ["3/10", "sqrt(2)"],
        ]
        .into_iter()
        .enumerate()
        {
            let alone = format!("alone.{extension}");
            let values = [format!("w={w}"), format!("a={a}")];
            let values = ["--param", &values[0], "--param", &values[1]];
            let arguments = [&["render", MORPH, "--out", &alone], &size[..], &values, more];
            done(dir.path(), &arguments.concat());
            let frame = dir.path().join(format!("frames/m-000{i}.{extension}"));
            let [frame, alone] =
                [frame, dir.path().join(alone)].map(|file| fs::read(file).unwrap());
            assert!(frame == alone, "{more:?}: frame {i}");
        }
    }
    let names = files(&dir.path().join("frames"));
    assert_eq!(names.len(), 8, "{names:?}");
}

#[test]
fn frames_are_joined_to_an_animated_png() {
    let dir = folder();
    let arguments =
        ["render", MORPH, "--size", "16x12", "--animate", "w=0:1:3", "--out", "f/", "--apng"];
    done(dir.path(), &[&arguments[..], &["a/morph.png", "--fps", "10"]].concat());
    assert_eq!(files(&dir.path().join("f")), [0, 1, 2].map(|i| format!("frame-000{i}.png")));
    let file = BufReader::new(File::open(dir.path().join("a/morph.png")).unwrap());
    let frames =
        PngDecoder::new(file).unwrap().apng().unwrap().into_frames().collect_frames().unwrap();
    assert_eq!(frames.len(), 3);
    for (i, frame) in frames.iter().enumerate() {
        let still = image::open(dir.path().join(format!("f/frame-000{i}.png"))).unwrap();
        assert_eq!(frame.buffer(), &still.to_rgba8());
        assert_eq!(Duration::from(frame.delay()), Duration::from_millis(100));
    }
}

#[test]
fn the_camera_turns_to_the_right() {
    let dir = folder();
    let ball = "(x-1)^2+y^2+z^2-0.09";
    let common = ["render", ball, "--size", "41x41", "--view", "certificate"];
    let common = [&common[..], &["--domain", "-2,-2,-2,2,2,2", "--camera", "eye=0,-6,0,ortho=3"]];
    let common = common.concat();
    let moves = ["--animate", "azimuth=0:180:3", "--out", "f/"];
    done(dir.path(), &[&common[..], &moves].concat());
    done(dir.path(), &[&common[..], &["--out", "still.png"]].concat());
    let read = |name: &str| image::open(dir.path().join(name)).unwrap().to_rgb8();
    assert_eq!(read("f/frame-0000.png"), read("still.png"));
    // A ball to the right of the centre, before it, and to its left.
    for (i, column) in [34, 20, 6].into_iter().enumerate() {
        let frame = read(&format!("f/frame-000{i}.png"));
        for x in [6, 20, 34] {
            let is_hit = frame.get_pixel(x, 20) != frame.get_pixel(0, 0);
            assert_eq!(is_hit, x == column, "frame {i}, column {x}");
        }
    }
}

#[test]
fn frames_that_are_there_are_overwritten_or_kept() {
    let dir = folder();
    let arguments =
        ["render", SPHERE, "--size", "8x8", "--animate", "azimuth=0:9:3", "--out", "f/"];
    done(dir.path(), &arguments);
    let middle = dir.path().join("f/frame-0001.png");
    let drawn = fs::read(&middle).unwrap();
    fs::write(&middle, "mine").unwrap();
    fs::remove_file(dir.path().join("f/frame-0002.png")).unwrap();
    let printed = done(dir.path(), &[&arguments[..], &["--resume"]].concat());
    assert!(printed.contains("3 frames, 2 of them as they were"), "{printed}");
    assert_eq!(fs::read(&middle).unwrap(), b"mine");
    assert_eq!(files(&dir.path().join("f")).len(), 3);

    // What is no picture is not joined to others.
    let outcome = run(dir.path(), &[&arguments[..], &["--resume", "--apng", "a.png"]].concat());
    assert_eq!(outcome.status, 1, "{}", outcome.stderr);
    assert!(outcome.stderr.contains("frame-0001.png"), "{}", outcome.stderr);
    assert_eq!(files(dir.path()), ["f"]);

    done(dir.path(), &arguments);
    assert_eq!(fs::read(&middle).unwrap(), drawn);
}

#[test]
fn a_frame_without_a_function_or_a_value_loses_no_other() {
    let dir = folder();
    // 1/w has no value in the middle.
    let ball = "x^2+y^2+z^2-1-1/(9*w); w = 1";
    let arguments = ["render", ball, "--size", "8x8", "--out", "f/", "--apng", "a.png"];
    let outcome = run(dir.path(), &[&arguments[..], &["--animate", "w=-1:1:5"]].concat());
    assert_eq!(outcome.status, 1, "{}", outcome.stderr);
    let message = &outcome.stderr;
    assert!(message.contains("1 of 5 frames") && message.contains("frame-0002.png"), "{message}");
    assert!(outcome.stdout.contains("4 frames"), "{}", outcome.stdout);
    let names = files(&dir.path().join("f"));
    assert_eq!(names, [0, 1, 3, 4].map(|i| format!("frame-000{i}.png")));
    assert!(dir.path().join("a.png").is_file());

    // Nowhere defined in the last frame: nothing is hit.
    let cap = "sqrt(w-x^2-y^2)-z-1/2";
    let arguments = ["render", cap, "--size", "8x8", "--out", "g/", "--animate", "w=1:-1:3"];
    let outcome = run(dir.path(), &arguments);
    assert_eq!(outcome.status, 0, "{}", outcome.stderr);
    assert!(outcome.stderr.contains("nothing was hit in"), "{}", outcome.stderr);
    assert_eq!(files(&dir.path().join("g")).len(), 3);
}

#[cfg(unix)]
#[test]
fn an_interruption_keeps_finished_frames() {
    let dir = folder();
    let moves = ["--animate", "azimuth=0:1:90000", "--out", "f/", "--apng", "a.png"];
    let child = start(dir.path(), &[&["render", SPHERE, "--size", "64x64"], &moves[..]].concat());
    let out = dir.path().join("f");
    for _ in 0..600 {
        if files(&out).iter().filter(|name| !name.starts_with('.')).count() > 1 {
            break;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    let pid = child.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
    let outcome = end(child);
    assert_eq!((outcome.status, outcome.stdout.as_str()), (130, ""), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("--resume"), "{}", outcome.stderr);
    let names = files(&out);
    assert!(names.len() > 1 && names.iter().all(|n| n.starts_with("frame-")), "{names:?}");
    assert!(names.iter().all(|name| image::open(out.join(name)).is_ok()));
    assert_eq!(files(dir.path()), ["f"]);
}

#[test]
fn surfaces_that_are_made_to_move_move() {
    let dir = folder();
    for (surface, moves) in
        [("superquadric-twisting", "twist=-1:2:2"), ("blinn-blobby-moving", "u=0:pi:2")]
    {
        let out = format!("{surface}/");
        let arguments =
            ["render", surface, "--size", "24x24", "--animate", moves, "--out", &out[..]];
        done(dir.path(), &arguments);
        let frame = |i: usize| {
            image::open(dir.path().join(format!("{surface}/frame-000{i}.png"))).unwrap().to_rgb8()
        };
        assert_ne!(frame(0), frame(1), "{surface}");
    }
}
