//! Devices are listed, chosen and refused, and frames that stay on one look like those that do not.

use image::RgbImage;

use crate::{done, folder, run};

/// Is there a device? Says so if not; with `REQUIRE_GPU` there must be one.
fn has_device() -> bool {
    let there = !zeroset::gpu::adapters().is_empty();
    assert!(there || std::env::var_os("REQUIRE_GPU").is_none(), "there is no device");
    if !there {
        eprintln!("skipped: there is no device");
    }
    there
}

#[test]
fn devices_are_listed() {
    let dir = folder();
    let text = done(dir.path(), &["devices"]);
    let json: serde_json::Value =
        serde_json::from_str(&done(dir.path(), &["devices", "--json"])).unwrap();
    let list = json.as_array().unwrap();
    if !has_device() {
        assert!(list.is_empty() && text.contains("install a Vulkan driver"), "{text}");
        return;
    }
    for device in list {
        assert!(text.contains(device["name"].as_str().unwrap()), "{text}");
        assert!(device["largest_binding"].as_u64().unwrap() >= 1 << 20);
    }
}

#[test]
fn devices_that_are_not_there_are_refused() {
    let dir = folder();
    let outcome = run(
        dir.path(),
        &["render", "sphere", "--method", "amp-sign-gpu", "--device", "no such device"],
    );
    assert_eq!(outcome.status, 2, "{}", outcome.stderr);
    let says = if has_device() { "numbers and names are 0: " } else { "no GPU was found" };
    assert!(outcome.stderr.contains(says), "{}", outcome.stderr);
}

fn open(path: std::path::PathBuf) -> RgbImage {
    image::open(path).unwrap().to_rgb8()
}

/// The share of pixels whose bytes are more than a little apart.
fn differing(a: &RgbImage, b: &RgbImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let apart =
        a.pixels().zip(b.pixels()).filter(|(a, b)| (0..3).any(|c| a.0[c].abs_diff(b.0[c]) > 4));
    apart.count() as f64 / f64::from(a.width() * a.height())
}

#[test]
fn resident_frames_look_like_others() {
    if !has_device() {
        return;
    }
    let dir = folder();
    let base = ["render", "--size", "96x80", "--light", "1,-1,2"];
    for (more, limit) in [
        (&["klein"][..], 0.005),
        // Its gradient is nowhere finite.
        (&["chmutov-14-cosine"], 0.02),
        // The edge of a shadow moves with the bracket's width.
        (&["klein", "--shadows", "on"], 0.03),
        (&["klein", "--camera", "ortho=7"], 0.005),
        (&["klein", "--environment", "sky"], 0.005),
        (&["klein", "--environment", "sky", "--shadows", "on"], 0.03),
    ] {
        let pictures =
            [("amp-sign", &[][..]), ("amp-sign-gpu", &["--resident"])].map(|(id, own)| {
                let arguments =
                    [&base[..], more, &["--method", id, "--out", "p.png"], own].concat();
                done(dir.path(), &arguments);
                open(dir.path().join("p.png"))
            });
        let share = differing(&pictures[0], &pictures[1]);
        assert!(share < limit, "{more:?}: {share}");
    }
}

#[test]
fn resident_animations_move() {
    if !has_device() {
        return;
    }
    let dir = folder();
    let printed = done(
        dir.path(),
        &[
            "render",
            "x^2+y^2+z^2=r^2; r=1",
            "--domain",
            "-2,-2,-2,2,2,2",
            "--method",
            "amp-taylor-gpu",
            "--resident",
            "--size",
            "32x32",
            "--animate",
            "r=0.5:1.5:3",
            "--out",
            "frames/",
            "--apng",
            "all.png",
        ],
    );
    assert!(printed.contains("3 frames") && printed.contains("on the device"), "{printed}");
    let covered: Vec<usize> = (0..3)
        .map(|i| {
            let picture = open(dir.path().join(format!("frames/frame-000{i}.png")));
            picture.pixels().filter(|p| p.0[0].abs_diff(p.0[2]) > 12).count()
        })
        .collect();
    assert!(covered[0] < covered[1] && covered[1] < covered[2], "{covered:?}");
    assert!(dir.path().join("all.png").is_file());
}

#[test]
fn what_does_not_stay_on_a_device_is_refused() {
    let dir = folder();
    for (more, says) in [
        (&["--method", "kmarch"][..], "--resident is for --method amp-sign-gpu or amp-taylor-gpu"),
        (&["--method", "amp-sign-gpu", "--view", "depth"], "--resident is for --view shaded"),
        (&["--method", "amp-sign-gpu", "--legend"], "--legend"),
        (&["--method", "amp-sign-gpu", "--out", "p.exr"], ".png"),
    ] {
        if more.contains(&"amp-sign-gpu") && !has_device() {
            continue;
        }
        let arguments = [&["render", "sphere", "--resident", "--size", "16x16"], more].concat();
        let outcome = run(dir.path(), &arguments);
        assert_eq!(outcome.status, 2, "{more:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(says), "{more:?}: {}", outcome.stderr);
    }
}

#[test]
fn constants_are_tuned() {
    let dir = folder();
    let printed =
        done(dir.path(), &["tune", "barth-sextic", "--size", "32x32", "--miss-rate", "0.02"]);
    assert!(printed.contains("--set amp-sign.step=") && printed.contains('*'), "{printed}");
    let outcome = run(dir.path(), &["tune", "sphere", "--method", "kmarch", "--size", "16x16"]);
    assert_eq!(outcome.status, 2);
    assert!(outcome.stderr.contains("kmarch has no step"), "{}", outcome.stderr);
}
