//! Lights light, and shadows lie where geometry says.

use std::collections::BTreeSet;

use image::RgbImage;

use crate::{done, folder};

/// A ball of radius 1/2 at the origin, above the plane z = -1; seen from above.
const BALL: &str = "(z+1)*(x^2+y^2+z^2-1/4)";
const ABOVE: [&str; 4] =
    ["--camera", "eye=0,0,5,at=0,0,0,up=0,1,0,ortho=4", "--domain", "-2,-2,-2,2,2,2"];
const WIDTH: u32 = 96;
const HEIGHT: u32 = 72;

fn picture(more: &[&str]) -> (RgbImage, String) {
    let dir = folder();
    let arguments = [&["render", BALL, "--size", "96x72", "--out", "p.png"], &ABOVE[..], more];
    let printed = done(dir.path(), &arguments.concat());
    (image::open(dir.path().join("p.png")).unwrap().to_rgb8(), printed)
}

/// Is the point of the plane below a pixel in the ball's shadow? `None` for pixels that see the
/// ball or nothing, and near an edge.
fn in_shadow([column, row]: [u32; 2], [lx, ly, lz]: [f64; 3]) -> Option<bool> {
    let pixel = 4.0 / f64::from(HEIGHT);
    let x = (f64::from(column) + 0.5 - 0.5 * f64::from(WIDTH)) * pixel;
    let y = (0.5 * f64::from(HEIGHT) - f64::from(row) - 0.5) * pixel;
    // The distance of the ball's centre from the line through (x, y, -1).
    let cross = [y * lz + ly, -lx - x * lz, x * ly - y * lx];
    let square = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>();
    let distance = (square(cross) / square([lx, ly, lz])).sqrt();
    let is_clear = x.abs() < 1.95 && x.hypot(y) > 0.55 && (distance - 0.5).abs() > 0.08;
    is_clear.then_some(distance < 0.5)
}

#[test]
fn every_method_casts_the_shadow_of_a_ball_where_it_lies() {
    let accept = ["--set", "kmarch.finish=accept", "--set", "kmarch.depth=10"];
    for method in [
        &["--method", "kmarch"][..],
        &[&["--method", "kmarch"][..], &accept].concat(),
        &["--method", "amp-sign"],
        &["--method", "reference"],
    ] {
        let light = ["--light", "-2,0.5,2"];
        let (bare, printed) = picture(&[method, &light].concat());
        assert!(!printed.contains("shadow"), "{printed}");
        let (shadowed, printed) = picture(&[method, &light, &["--shadows", "on"]].concat());
        assert!(printed.contains("shadow rays in") && printed.contains("a shadow ray: "));
        let mut darker = 0;
        for (column, row, pixel) in shadowed.enumerate_pixels() {
            let is_darker = pixel != bare.get_pixel(column, row);
            if let Some(expected) = in_shadow([column, row], [-2.0, 0.5, 2.0]) {
                assert_eq!(is_darker, expected, "{method:?} at {column}, {row}");
            }
            darker += u32::from(is_darker);
        }
        assert!(darker > 150, "{method:?}: {darker}");
    }
}

#[test]
fn each_of_several_lights_has_its_shadow() {
    let two = ["--light", "1,0,1", "--light", "-1,0,1"];
    let (bare, _) = picture(&two);
    let (shadowed, printed) = picture(&[&two[..], &["--shadows", "on"]].concat());
    let (left, right) = ([1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]);
    let mut shades = BTreeSet::new();
    for (column, row, pixel) in shadowed.enumerate_pixels() {
        let at = [column, row];
        if let (Some(a), Some(b)) = (in_shadow(at, left), in_shadow(at, right)) {
            assert_eq!(pixel != bare.get_pixel(column, row), a || b, "{at:?}");
            shades.insert(pixel.0);
        }
    }
    // Lit by both lights, and by one: on a plane both are equally strong.
    assert_eq!(shades.len(), 2, "{shades:?}");
    // All of the plane faces both lights, and is 72 pixels wide and high.
    let rays: u32 = printed
        .lines()
        .find_map(|line| line.split_once(" shadow rays")?.0.parse().ok())
        .expect("the shadow rays are counted");
    assert!(rays > 9_000 && rays <= 2 * 72 * 72, "{rays}");
    // The two default lights cast shadows too.
    let [(bare, _), (shadowed, _)] = [picture(&[]), picture(&["--shadows", "on"])];
    let darker = bare.pixels().zip(shadowed.pixels()).filter(|(a, b)| a != b).count();
    assert!(darker > 100 && darker < bare.pixels().len() / 2, "{darker}");
}
