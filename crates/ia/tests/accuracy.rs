//! The example `accuracy` on a sample of floats and on a few hard points: no bound is broken, and one that
//! is would be seen.

#[path = "../examples/accuracy/adversarial.rs"]
mod adversarial;
#[path = "../examples/accuracy/exact.rs"]
mod exact;
#[path = "../examples/accuracy/exhaust.rs"]
mod exhaust;
#[path = "../examples/accuracy/points.rs"]
mod points;
#[path = "../examples/accuracy/request.rs"]
mod request;

use exact::{Settled, settle};
use request::Request;
use zeroset_ia::{BigInterval, Number, Unary};

fn request(arguments: &[&str]) -> Result<Request, String> {
    Request::read(arguments.iter().map(ToString::to_string))
}

#[test]
fn a_sample_of_single_floats_is_within_the_bounds() {
    // A prime stride, so that mantissas differ from binade to binade.
    assert_eq!(
        exhaust::run(&request(&["--stride", "400009", "--threads", "2"]).unwrap()),
        Ok(true)
    );
}

#[test]
fn hard_points_are_within_the_bounds() {
    assert_eq!(
        adversarial::run(&request(&["--points", "400", "--threads", "2"]).unwrap()),
        Ok(true)
    );
}

#[test]
fn functions_and_options_are_checked() {
    for fault in [
        exhaust::run(&request(&["sine"]).unwrap()).unwrap_err(),
        adversarial::run(&request(&["floor"]).unwrap()).unwrap_err(),
        request(&["--stride", "0"]).err().unwrap(),
        request(&["--points"]).err().unwrap(),
        request(&["--fast"]).err().unwrap(),
    ] {
        assert!(fault.len() > 10, "{fault}");
    }
}

#[test]
fn errors_are_measured_towards_the_exact_value() {
    let exactly = |x: f64| move |precision| BigInterval::from_f64(x, precision);
    let gap = f64::EPSILON;
    // Below 1 the gaps are half as wide.
    assert_eq!(settle(1.0_f64, 0.5, exactly(1.0 - gap / 2.0)), Settled::Beyond(1.0));
    assert_eq!(settle(1.0_f64, 1.0, exactly(1.0 - gap / 2.0)), Settled::Within(1.0));
    assert_eq!(settle(1.0_f64, 0.5, exactly(1.0 + 2.0 * gap)), Settled::Beyond(2.0));
    assert_eq!(settle(1.0_f32, 0.5, exactly(1.0 + 2.0_f64.powi(-24))), Settled::Within(0.5));
    assert_eq!(settle(0.0_f64, 0.5, exactly(0.0)), Settled::Within(0.0));
    // Infinity is right from half a gap beyond the largest float.
    let largest = f64::from(f32::MAX);
    let half = 2.0_f64.powi(103);
    assert_eq!(settle(f32::INFINITY, 0.5, exactly(largest + half)), Settled::Within(0.5));
    assert_eq!(settle(f32::INFINITY, 0.5, exactly(2.0_f64.powi(200))), Settled::Within(0.0));
    assert_eq!(settle(f32::INFINITY, 0.75, exactly(largest)), Settled::Beyond(1.0));
    assert_eq!(settle(f32::MAX, 0.75, exactly(2.0 * half + largest)), Settled::Beyond(1.0));
    // Outside the domain.
    let root = |precision| BigInterval::from_f64(-1.0, precision).unary(Unary::Sqrt);
    assert_eq!(settle(f64::NAN, 0.5, root), Settled::Within(0.0));
    assert_eq!(settle(1.0, 0.5, root), Settled::Beyond(f64::INFINITY));
    assert_eq!(settle(f64::NAN, 0.5, exactly(1.0)), Settled::Beyond(f64::INFINITY));
}
