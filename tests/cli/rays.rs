//! Rays go in, answers come out.

use std::fs;

use crate::{HEADER, SPHERE, done, folder, run_with};

/// The arguments that let a method answer the rays of a file.
fn trace<'a>(method: &'a str, rays: &'a str, out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["trace", SPHERE, "--method", method, "--rays", rays, "--out", out], more].concat()
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
        let precision = ["--precision", "1e-6"];
        let outcome = run_with(dir.path(), &trace(method, "-", "-", &precision), rays);
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
        let through_files = trace(method, "rays.csv", "answers.csv", &precision);
        assert_eq!(done(dir.path(), &through_files), "");
        assert_eq!(fs::read_to_string(dir.path().join("answers.csv")).unwrap(), outcome.stdout);
    }
}

#[test]
fn a_domain_given_replaces_that_of_the_catalogue() {
    let dir = folder();
    let rays = format!("{HEADER}\n0,0,-9,0,0,1\n");
    let answer = |more: &[&str]| {
        let outcome = run_with(dir.path(), &trace("kmarch", "-", "-", more), &rays);
        assert_eq!(outcome.status, 0, "{}", outcome.stderr);
        answers(&outcome.stdout).remove(0)
    };
    assert!(answer(&[]).t_lo < 8.01);
    assert!(answer(&["--domain", "-2,-2,0,2,2,2"]).t_lo > 9.99);
    assert_eq!(answer(&["--domain", "-2,-2,1.5,2,2,2"]).certificate, "proven-miss");
}
