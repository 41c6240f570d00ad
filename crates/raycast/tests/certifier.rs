//! A certifier proves roots, and nothing else.

use glam::{DVec3, Vec3};
use zeroset_expr::{Function, Parameters, Tape};
use zeroset_raycast::{Certificate, Certification, Certifier, Clip, Domain, Hit, Ray, Work};

fn tape(equation: &str) -> Tape {
    Function::parse(equation).unwrap().tape(&Parameters::default(), 128).unwrap()
}

/// x = t - 3.
fn along() -> Ray {
    Ray::new(Vec3::new(-3.0, 0.25, 0.5), Vec3::X)
}

fn clip(range: [f64; 2]) -> Clip {
    let domain = Domain::new(DVec3::splat(-1.0), DVec3::splat(1.0)).unwrap();
    domain.clip(along(), range).unwrap()
}

/// A plain hit, and what becomes of it.
fn certified(equation: &str, bracket: [f64; 2], slack: f64, clip: Clip) -> Hit {
    let mut hit = Hit { bracket, certificate: Certificate::HIT, work: Work::default() };
    Certifier::new(&tape(equation)).certify(along(), clip, slack, &mut hit);
    hit
}

const ALL: [f64; 2] = [0.0, f64::INFINITY];

#[test]
fn a_change_of_sign_is_a_root_where_the_function_is_continuous() {
    for (equation, is_root) in [
        ("x-0.1", true),
        ("(x-0.1)^3", true),
        ("(x-0.1)*1e-300", true),
        ("sqrt(x)-sqrt(0.1)", true),
        ("1/(x+2)-1/2.1", true),
        ("1/(x-0.1)", false),
        ("1/(x-0.1)^3", false),
        ("tan(pi*(x+0.4))", false),
        ("sign(x-0.1)", false),
        ("floor(x-0.1)+0.5", false),
        ("mod(x-0.1,1)-0.5", false),
        ("(x-0.1)^2", false),
        ("log(x-0.1)", false),
        ("x-0.2", false),
    ] {
        let bracket = [3.09, 3.11];
        let hit = certified(equation, bracket, 0.0, clip(ALL));
        let expected = if is_root { Certificate::ROOT_HIT } else { Certificate::HIT };
        assert_eq!((hit.certificate, hit.bracket), (expected, bracket), "{equation}");
        assert!(hit.work.intervals >= 2);
    }
}

#[test]
fn brackets_are_widened_only_for_a_proof() {
    // The root of x - 1/8 is at 3.125.
    for (bracket, slack, expected) in [
        ([3.125, 3.125], 1e-9, Some([3.125 - 1e-9, 3.125 + 1e-9])),
        ([3.125 + 1e-10, 3.13], 1e-9, Some([3.125 + 1e-10 - 1e-9, 3.13 + 1e-9])),
        ([3.125, 3.125], 0.0, None),
        ([3.125 + 2e-9, 3.13], 1e-9, None),
        ([3.0, 3.2], 1e-9, Some([3.0, 3.2])),
    ] {
        let hit = certified("x-1/8", bracket, slack, clip(ALL));
        assert_eq!(hit.bracket, expected.unwrap_or(bracket), "{bracket:?}");
        assert_eq!(hit.certificate.contains(Certificate::ROOT), expected.is_some());
    }
}

#[test]
fn only_roots_that_count_are_proven() {
    let [from, to] = [3.0, 3.5];
    let prove = |bracket, range| certified("x-1/8", bracket, 0.25, clip(range)).bracket;
    // Cut with the range, if the root is in it.
    assert_eq!(prove([2.9, 3.2], [from, to]), [from, 3.2]);
    assert_eq!(prove([3.126, 3.4], [from, to]), [from, to]);
    assert_eq!(prove([2.9, 3.2], [3.126, to]), [2.9, 3.2]);
    assert_eq!(prove([2.9, 3.2], [from, 3.124]), [2.9, 3.2]);
    // A range of one point, and none that is surely in the domain.
    assert_eq!(prove([2.9, 3.2], [3.125, 3.125]), [2.9, 3.2]);
    let nowhere = Clip { inner: None, ..clip(ALL) };
    assert_eq!(certified("x-1/8", [2.9, 3.2], 0.25, nowhere).certificate, Certificate::HIT);
}

#[test]
fn only_plain_hits_are_looked_at() {
    let tape = tape("x-1/8");
    for certificate in Certificate::ALL.into_iter().filter(|c| *c != Certificate::HIT) {
        let before = Hit { bracket: [3.0, 3.2], certificate, work: Work::default() };
        let mut hit = before;
        Certifier::new(&tape).certify(along(), clip(ALL), 0.0, &mut hit);
        assert_eq!(hit, before);
    }
}

#[test]
fn the_knob_reads_back() {
    for (certification, value) in [(Certification::On, "on"), (Certification::Off, "off")] {
        assert_eq!(certification.knob().value, value);
        assert_eq!(Certification::read(value), Ok(certification));
    }
    assert!(Certification::read("yes").is_err());
    assert_eq!(Certification::default(), Certification::Off);
}
