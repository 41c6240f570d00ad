//! What may not be proved: poles, jumps, gaps, and anything rounded to nearest.

use zeroset_cpu::{Algorithm, Bisection, Finishing};
use zeroset_ia::Rounding;
use zeroset_raycast::{Certificate, Hit, Ray};

use crate::{ALGORITHMS, EQUATIONS, answers, assorted, ray, scene};

/// What every algorithm says of a ray; the finish makes that the same certificate.
fn one(equation: &str, ray: Ray) -> Hit {
    let [hit, others @ ..] = ALGORITHMS
        .map(|algorithm| answers(&Bisection::new(algorithm), &scene(equation, 1.0), &[ray])[0]);
    for other in others {
        assert_eq!(other.certificate, hit.certificate, "{equation}: {other:?} {hit:?}");
    }
    hit
}

#[test]
fn rounding_to_nearest_proves_no_first_hit_and_no_miss() {
    for (equation, half) in EQUATIONS {
        let scene = scene(equation, half);
        for (algorithm, finish) in ALGORITHMS
            .into_iter()
            .flat_map(|a| [Finishing::Accept, Finishing::Certify].map(|finish| (a, finish)))
        {
            let rounding = Rounding::Nearest;
            let method = Bisection { rounding, finish, ..Bisection::new(algorithm) };
            for hit in answers(&method, &scene, &assorted(&scene, 16)) {
                assert!(!hit.certificate.contains(Certificate::FIRST), "{equation}: {hit:?}");
            }
        }
    }
}

#[test]
fn accepted_slabs_are_no_roots() {
    for (equation, half) in EQUATIONS {
        let scene = scene(equation, half);
        for algorithm in [Algorithm::Kmarch, Algorithm::Tbisect] {
            let method = Bisection { finish: Finishing::Accept, ..Bisection::new(algorithm) };
            for hit in answers(&method, &scene, &assorted(&scene, 16)) {
                assert!(!hit.certificate.contains(Certificate::ROOT), "{equation}: {hit:?}");
            }
        }
    }
}

#[test]
fn a_pole_is_no_root_and_costs_the_first_bit_only_where_it_is_touched() {
    let across = ray([-3.0, 0.1, 0.2], [1.0, 0.0, 0.0]);
    let beside = ray([0.5, -3.0, 0.2], [0.0, 1.0, 0.0]);
    // The sign changes at x = 0.3, without a root.
    assert_eq!(one("1/(x-0.3)", across).certificate, Certificate::MISS);
    assert_eq!(one("1/(x-0.3)", beside).certificate, Certificate::PROVEN_MISS);
    // Roots behind the pole, at x = 0.1, and before it, at x = -0.5.
    let behind = one("1/(x+0.3)-1/(0.1+0.3)", across);
    assert_eq!(behind.certificate, Certificate::ROOT_HIT);
    assert!(behind.bracket[0] <= 3.1 && 3.1 <= behind.bracket[1], "{behind:?}");
    let before = one("1/(x-0.3)+1/0.8", across);
    assert_eq!(before.certificate, Certificate::PROVEN_HIT);
    assert!(before.bracket[0] <= 2.5 && 2.5 <= before.bracket[1], "{before:?}");
    // Poles of tan at x = -0.5236 and 0.5236; roots at atan(-9) / 3 = -0.4867, and at 1/1000^(1/2).
    // log is undefined up to x = -0.3 and -inf from there: no enclosure before the root holds 0.
    for (equation, root, certificate) in [
        ("tan(3*x)+9", 2.513_347_0, Certificate::ROOT_HIT),
        ("log(x+0.3)", 3.7, Certificate::PROVEN_HIT),
        ("1/x^2-1e3", 2.968_377_2, Certificate::PROVEN_HIT),
    ] {
        let hit = one(equation, across);
        assert_eq!(hit.certificate, certificate, "{equation}: {hit:?}");
        let [lo, hi] = hit.bracket;
        assert!(lo - 1e-6 <= root && root <= hi + 1e-6 && hi - lo < 1e-2, "{equation}: {hit:?}");
    }
}

#[test]
fn jumps_are_never_proven_roots() {
    let along = [
        ray([-3.0, 0.13, 0.21], [1.0, 0.0, 0.0]),
        ray([3.0, 0.13, 0.21], [-1.0, 0.01, 0.02]),
        ray([-2.0, -2.0, 0.1], [1.0, 0.9, 0.0]),
    ];
    for equation in
        ["floor(3*x)-0.5", "ceil(3*x)+0.5", "sign(x-0.1)", "sign(x-0.1)+0.5", "mod(3*x,1)-5"]
            .into_iter()
            // With a slope: monotone, with opposite signs around a jump.
            .chain(["floor(3*x)+x/8-0.4", "sign(x-0.1)+x/8", "ceil(2*x)-x/8-0.5"])
    {
        for ray in along {
            let hit = one(equation, ray);
            assert!(!hit.certificate.contains(Certificate::ROOT), "{equation}: {hit:?}");
        }
    }
    // A root at x = 0.6, shortly after a jump over which the slope is 1.
    for ray in along {
        let hit = one("0.9*floor(2*x)+x-1.5", ray);
        let x = |t: f64| ray.at(t).x;
        let [a, b] = hit.bracket.map(x);
        assert!(a.min(b) <= 0.6 && 0.6 <= a.max(b), "{ray:?}: {hit:?}");
    }
    // The root at x = -1 + 0.25, between jumps at multiples of 1/2.
    let hit = one("mod(2*x,1)-0.5", along[0]);
    assert_eq!(hit.certificate, Certificate::PROVEN_HIT);
    assert!(hit.bracket[0] <= 2.25 && 2.25 <= hit.bracket[1], "{hit:?}");
}

/// The slope does not see a jump, within which signs change, or change back.
#[test]
fn monotone_pieces_with_jumps_prove_nothing() {
    let accepting = Bisection { finish: Finishing::Accept, ..Bisection::mitchell() };
    let equations = ["floor(3*x)+x/8-0.4", "sign(x-0.1)+x/8", "ceil(2*x)-x/8-0.5", "mod(3*x,1)-5"];
    for equation in equations {
        for start in [-3.0, -2.9, -1.7] {
            let along = ray([start, 0.13, 0.21], [1.0, 0.0, 0.0]);
            let hit = answers(&accepting, &scene(equation, 1.0), &[along])[0];
            assert!(!hit.certificate.contains(Certificate::ROOT), "{equation}: {hit:?}");
        }
    }
    // A root shortly before a jump behind which the sign is the old one.
    for (place, jump) in [(0.45, 0.5), (0.49, 0.5), (-0.06, 0.0), (-0.51, -0.5)] {
        let equation = format!("x-({place})-0.3*(floor(2*x)-2*({jump})+1)");
        let along = ray([-3.0, 0.13, 0.21], [1.0, 0.0, 0.0]);
        let hit = answers(&accepting, &scene(&equation, 1.0), &[along])[0];
        let root = 3.0 + place;
        let told = hit.certificate.contains(Certificate::FIRST);
        assert!(hit.certificate.is_hit(), "{equation}: {hit:?}");
        assert!(!told || hit.bracket[0] <= root, "{equation}: {hit:?}, the root is at {root}");
    }
}

#[test]
fn a_gap_in_the_domain_of_a_function_is_no_root() {
    // Defined for |x| >= 1/2 only, negative on the left and positive on the right.
    let equation = "sqrt(x^2-0.25)*0+x";
    for ray in [ray([-3.0, 0.1, 0.2], [1.0, 0.0, 0.0]), ray([3.0, 0.1, 0.2], [-1.0, 0.1, 0.0])] {
        let hit = one(equation, ray);
        assert!(!hit.certificate.contains(Certificate::ROOT), "{hit:?}");
    }
    // Undefined everywhere: nothing is there, and that is proved.
    let nowhere = one("sqrt(-1-x^2)", ray([-3.0, 0.1, 0.2], [1.0, 0.0, 0.0]));
    assert_eq!(nowhere.certificate, Certificate::PROVEN_MISS, "{nowhere:?}");
}

#[test]
fn roots_on_the_faces_of_the_domain_count() {
    // The domain is closed: x = 1 is in it. To prove it is optional, to deny it a lie.
    for direction in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [1.0, 0.1, 0.1]] {
        for face in ["x-1", "x+1"] {
            let start = [-3.0 * direction[0], 0.1, 0.2];
            let hit = one(face, ray(start, direction));
            assert_ne!(hit.certificate, Certificate::PROVEN_MISS, "{face} {direction:?}");
        }
    }
    // A ray within the surface.
    let hit = one("z-0.5", ray([-3.0, 0.1, 0.5], [1.0, 0.0, 0.0]));
    assert!(hit.certificate.is_hit() && hit.bracket[0] <= 2.0, "{hit:?}");
    // A ray that starts on the surface.
    let hit = one("x-0.5", ray([0.5, 0.0, 0.0], [1.0, 0.0, 0.0]));
    assert!(hit.certificate.is_hit() && hit.bracket[0] <= 0.0, "{hit:?}");
}
