//! Certificates against the exact roots of ray polynomials.

use zeroset_cpu::{Algorithm, Arithmetic, Bisection, Finishing, Stop};
use zeroset_ia::Rounding;
use zeroset_raycast::{Certificate, Hit, Method, Ray};

use crate::rational::{Poly, Q, Roots, clip, exact, fraction};
use crate::{ALGORITHMS, answers, assorted, scene};

/// How many proven hits, proven misses, and roots in all.
#[derive(Debug, Default)]
struct Tally {
    hits: usize,
    misses: usize,
    crossed: usize,
    clear: usize,
}

/// Holds every bit of every certificate against the roots in the closed domain.
fn check(equation: &str, half: f64, method: &Bisection, f: impl Fn([Poly; 3]) -> Poly) -> Tally {
    let scene = scene(equation, half);
    let rays = assorted(&scene, 16);
    let mut tally = Tally::default();
    for (ray, hit) in rays.iter().zip(answers(method, &scene, &rays)) {
        let polynomial = f(Poly::ray(*ray));
        let part = clip(&scene.domain, *ray, [0.0, f64::INFINITY]);
        let Some(part) = part else {
            assert!(!hit.certificate.is_hit(), "{equation}: {ray:?} misses the domain");
            continue;
        };
        if polynomial.0.is_empty() {
            assert!(!hit.certificate.contains(Certificate::PROVEN_HIT), "{equation}: {ray:?}");
            continue;
        }
        judge(equation, *ray, hit, &Roots::new(&polynomial), &part, &mut tally);
    }
    tally
}

fn judge(
    equation: &str,
    ray: Ray,
    hit: Hit,
    roots: &Roots,
    [from, to]: &[Q; 2],
    tally: &mut Tally,
) {
    let any = roots.within(from, to) > 0;
    tally.crossed += usize::from(any && roots.multiple_within(from, to) == 0);
    tally.clear += usize::from(!any);
    if !hit.certificate.is_hit() {
        let proven = hit.certificate == Certificate::PROVEN_MISS;
        assert!(!(proven && any), "{equation}: {ray:?} {hit:?} is no miss");
        tally.misses += usize::from(proven);
        return;
    }
    let [lo, hi] = hit.bracket.map(exact);
    assert!(lo <= hi);
    if hit.certificate.contains(Certificate::FIRST) {
        // A root at `lo` itself is in the bracket.
        let is_first = lo <= *from || roots.within(from, &lo) == roots.within(&lo, &lo);
        assert!(is_first, "{equation}: {ray:?} {hit:?} is not the first");
    }
    if hit.certificate.contains(Certificate::ROOT) {
        let (lo, hi) = (lo.max(from.clone()), hi.min(to.clone()));
        assert!(roots.within(&lo, &hi) > 0, "{equation}: {ray:?} {hit:?} is no root");
    }
    tally.hits += usize::from(hit.certificate == Certificate::PROVEN_HIT);
}

/// Settings of an algorithm; with the first two, most is proved.
fn settings(algorithm: Algorithm) -> [Bisection; 7] {
    let default = Bisection::new(algorithm);
    [
        default.clone(),
        Bisection { stop: Stop::Width(1e-5), ..default.clone() },
        Bisection { rounding: Rounding::Nudged, stop: Stop::Depth(3), ..default.clone() },
        Bisection { finish: Finishing::Accept, ..default.clone() },
        Bisection { finish: Finishing::Accept, stop: Stop::Depth(18), ..default.clone() },
        Bisection { rounding: Rounding::Nearest, ..default.clone() },
        Bisection { arithmetic: Arithmetic::Double, finish: Finishing::Accept, ..default },
    ]
}

fn methods() -> Vec<(usize, Bisection)> {
    ALGORITHMS.into_iter().flat_map(|a| settings(a).into_iter().enumerate()).collect()
}

fn check_all(equation: &str, half: f64, f: impl Fn([Poly; 3]) -> Poly) {
    for (i, method) in methods() {
        let tally = check(equation, half, &method, &f);
        println!("{equation} {} {i}: {tally:?}", method.id());
        assert!(tally.crossed > 80 && tally.clear > 80, "{equation}: {tally:?}");
        if i < 2 {
            // Where the certifying finish has all it needs, most is proved.
            assert!(100 * tally.hits >= 95 * tally.crossed, "{equation}: {tally:?}");
            assert!(100 * tally.misses >= 95 * tally.clear, "{equation}: {tally:?}");
        }
    }
}

fn sum([x, y, z]: [Poly; 3]) -> Poly {
    &(&x + &y) + &z
}

#[test]
fn sphere() {
    check_all("x^2+y^2+z^2-1", 1.25, |p| &sum(p.map(|v| v.pow(2))) - &Poly::integer(1));
}

#[test]
fn tangle() {
    check_all("x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8", 2.5, |p| {
        let terms = p.map(|v| &v.pow(4) - &v.pow(2).times(5));
        &sum(terms) + &Poly::number(fraction(118, 10))
    });
}

#[test]
fn cubic() {
    check_all("x^3+y^3+z^3+1-(x+y+z+1)^3", 2.0, |p| {
        let one = Poly::integer(1);
        let cubes = &sum(p.clone().map(|v| v.pow(3))) + &one;
        &cubes - &(&sum(p) + &one).pow(3)
    });
}

#[test]
fn double_sheets_are_never_proven_wrongly() {
    // A double plane beside a simple one: roots without a change of sign.
    for (_, method) in methods() {
        let tally = check("(x-0.25)^2*(y+0.5)", 1.0, &method, |[x, y, _]| {
            let square = (&x - &Poly::number(fraction(1, 4))).pow(2);
            &square * &(&y + &Poly::number(fraction(1, 2)))
        });
        assert!(tally.clear > 50, "{tally:?}");
    }
}

/// Far narrower brackets than single precision resolves: the finish examines many parts of a slab, and
/// what it leaves of it must not be forgotten.
#[test]
fn fine_widths_lose_no_root() {
    let one = || Poly::integer(1);
    let squared = |p: Poly| p.pow(2);
    for algorithm in ALGORITHMS {
        for width in [1e-9, 1e-12, 1e-14] {
            let method = Bisection { stop: Stop::Width(width), ..Bisection::new(algorithm) };
            check("(x^2+y^2+z^2-1)^2", 1.25, &method, |p| {
                squared(&sum(p.map(|v| v.pow(2))) - &one())
            });
            check("(3*x-1)^2*(y+3)", 1.0, &method, |[x, y, _]| {
                &squared(&x.times(3) - &one()) * &(&y + &Poly::integer(3))
            });
            check("(x^3-y-1/8)^2*(z+3)", 1.0, &method, |[x, y, z]| {
                let cubic = &(&x.pow(3) - &y) - &Poly::number(fraction(1, 8));
                &squared(cubic) * &(&z + &Poly::integer(3))
            });
        }
    }
}

#[test]
fn large_values_are_cast_in_double_precision() {
    // 1e60 is beyond single precision.
    let factor = Q::new(num_bigint::BigInt::from(10).pow(60), 1.into());
    let method = Bisection::kmarch();
    let tally = check("1e60*(x^2+y^2+z^2-1)", 1.25, &method, |p| {
        let sphere = &sum(p.map(|v| v.pow(2))) - &Poly::integer(1);
        &sphere * &Poly::number(factor.clone())
    });
    assert!(100 * tally.hits >= 95 * tally.crossed && tally.crossed > 80, "{tally:?}");
}
