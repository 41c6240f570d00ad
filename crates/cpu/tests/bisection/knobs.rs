//! Knobs read back, and extremes of them are answered.

use zeroset_cpu::{Arithmetic, Bisection, Finishing, Normals, Packets, Poles, Stop};
use zeroset_ia::{Isa, Register, Rounding};
use zeroset_raycast::{Certificate, KnobError, Method};

use crate::{answers, assorted, ray, scene};

#[test]
fn all_knobs_set_again_give_the_same_method() {
    let stops = [Stop::Depth(0), Stop::Depth(40), Stop::Width(1.0 / 3.0), Stop::Width(5e-324)];
    for stop in stops {
        for rounding in [Rounding::Outward, Rounding::Nudged, Rounding::Nearest] {
            // Sets that the machine lacks are refused.
            for isa in Isa::available().into_iter().map(Some).chain([None]) {
                let finish = Finishing::Accept;
                let method = Bisection {
                    stop,
                    delta: 0.125,
                    rounding,
                    finish,
                    levels: 7,
                    poles: Poles::Shown,
                    shadow: 3,
                    normals: Normals::Stencil(0.01),
                    packets: Packets::One(Register::Four),
                    arithmetic: Arithmetic::Double,
                    isa,
                    ..Bisection::kmarch()
                };
                let mut copy = Bisection::kmarch();
                // The least normal number is the least width that can be set.
                let result: Result<Vec<()>, _> =
                    method.knobs().iter().map(|knob| copy.set(knob.name, &knob.value)).collect();
                if stop == Stop::Width(5e-324) {
                    assert!(matches!(result, Err(KnobError::Value { .. })));
                } else {
                    result.unwrap();
                    assert_eq!(copy, method);
                }
            }
        }
    }
}

#[test]
fn wrong_values_change_nothing() {
    let mut method = Bisection::kmarch();
    for (knob, value) in [
        ("depth", "-1"),
        ("depth", "41"),
        ("depth", "2.5"),
        ("depth", "deep"),
        ("width", "0"),
        ("width", "-1"),
        ("width", "NaN"),
        ("width", "inf"),
        ("rounding", "up"),
        ("finish", ""),
        ("levels", "-0.5"),
        ("delta", "-1"),
        ("delta", "inf"),
        ("poles", "yes"),
        ("shadow", "41"),
        ("normals", "0"),
        ("normals", "NaN"),
        ("packet", "5"),
        ("arithmetic", "single"),
        ("isa", "sse9"),
        ("speed", "1"),
    ] {
        assert!(method.set(knob, value).is_err(), "{knob}={value}");
        assert_eq!(method, Bisection::kmarch());
    }
}

#[test]
fn coarse_and_fine_stops_are_answered() {
    let scene = scene("x^2+y^2+z^2-1", 1.25);
    let rays = assorted(&scene, 12);
    for stop in
        [Stop::Depth(0), Stop::Depth(40), Stop::Width(1e300), Stop::Width(1.0), Stop::Width(1e-300)]
    {
        for levels in [0, 40] {
            let method = Bisection { stop, levels, ..Bisection::kmarch() };
            let hits = answers(&method, &scene, &rays);
            assert!(hits.iter().any(|hit| hit.certificate.is_hit()), "{stop:?} {levels}");
        }
    }
}

#[test]
fn depth_0_asks_once() {
    let method =
        Bisection { stop: Stop::Depth(0), finish: Finishing::Accept, ..Bisection::kmarch() };
    let scene = scene("x^2+y^2+z^2-1", 1.25);
    let hit = answers(&method, &scene, &[ray([-3.0, 1.2, 1.2], [1.0, 0.0, 0.0])])[0];
    // y^2 + z^2 = 2.88: one enclosure tells.
    assert_eq!((hit.certificate, hit.work.intervals), (Certificate::PROVEN_MISS, 1));
    let hit = answers(&method, &scene, &[ray([-3.0, 0.0, 0.1], [1.0, 0.0, 0.0])])[0];
    assert_eq!((hit.certificate, hit.work.intervals), (Certificate::POSSIBLE_HIT, 1));
    assert!(hit.bracket[0] <= 1.75 && hit.bracket[1] >= 4.25, "{hit:?}");
}

#[test]
fn proven_brackets_are_as_narrow_as_asked() {
    let scene = scene("x^4+y^4+z^4-1", 1.25);
    let rays = assorted(&scene, 16);
    for width in [0.1, 1e-3, 1e-6, 1e-9] {
        let mut method = Bisection::kmarch();
        method.for_precision(width, &scene);
        let hits = answers(&method, &scene, &rays);
        let proven: Vec<_> =
            hits.iter().filter(|hit| hit.certificate == Certificate::PROVEN_HIT).collect();
        assert!(proven.len() > 50, "{width}: {}", proven.len());
        for hit in proven {
            let [lo, hi] = hit.bracket;
            assert!(hi - lo <= width.max(8.0 * f64::EPSILON * hi.abs()), "{width}: {hit:?}");
        }
    }
}
