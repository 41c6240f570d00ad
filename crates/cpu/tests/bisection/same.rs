//! An answer depends on its ray and the knobs alone.

use proptest::prelude::*;
use zeroset_cpu::{Algorithm, Bisection, Finishing, Packets, Stop};
use zeroset_ia::{Isa, Register, Rounding};
use zeroset_raycast::{Certificate, Hit, Ray, Rays};

use crate::{ALGORITHMS, EQUATIONS, answers, assorted, cast, scene, view};

fn method(algorithm: Algorithm, rounding: Rounding, finish: Finishing) -> Bisection {
    Bisection { rounding, finish, stop: Stop::Depth(8), ..Bisection::new(algorithm) }
}

/// Every algorithm with every finish.
fn variants() -> impl Iterator<Item = (Algorithm, Finishing)> {
    let finishes = [Finishing::Accept, Finishing::Certify];
    ALGORITHMS.into_iter().flat_map(move |a| finishes.map(|finish| (a, finish)))
}

/// The bits of answers, so that zeros differ by sign and infinities compare.
fn bits(hits: &[Hit]) -> Vec<([u64; 2], Hit)> {
    hits.iter().map(|hit| (hit.bracket.map(f64::to_bits), *hit)).collect()
}

#[test]
fn instruction_set_and_packets_change_nothing() {
    for (equation, half) in EQUATIONS {
        let scene = scene(equation, half);
        let rays = assorted(&scene, 21);
        for rounding in [Rounding::Nearest, Rounding::Nudged] {
            for (algorithm, finish) in variants() {
                let method = method(algorithm, rounding, finish);
                let cast_on = |isa, packets| {
                    let method = Bisection { isa: Some(isa), packets, ..method.clone() };
                    answers(&method, &scene, &rays)
                };
                let expected = cast_on(Isa::Portable, Packets::Two);
                assert!(expected.iter().any(|hit| hit.certificate.is_hit()), "{equation}");
                let registers = Register::available().into_iter().map(Packets::One);
                let ways = registers.map(|packets| (Isa::Portable, packets));
                for (isa, packets) in
                    Isa::available().into_iter().map(|isa| (isa, Packets::Two)).chain(ways)
                {
                    let place = format!("{equation} {method:?} {isa:?} {packets:?}");
                    assert_eq!(bits(&cast_on(isa, packets)), bits(&expected), "{place}");
                }
            }
        }
    }
}

/// By depth, the same for all rays, and by width, by which their depths differ.
const STOPS: [Stop; 2] = [Stop::Depth(8), Stop::Width(0.02)];

#[test]
fn a_view_is_its_rays_one_by_one() {
    for (equation, half) in EQUATIONS {
        let scene = scene(equation, half);
        let view = view(&scene, 37, 35);
        for (rounding, stop) in [Rounding::Outward, Rounding::Nearest].into_iter().zip(STOPS) {
            for (algorithm, finish) in variants() {
                let method = Bisection { stop, ..method(algorithm, rounding, finish) };
                let hits = cast(&method, &scene, Rays::View(&view));
                for i in (0..hits.len()).step_by(13) {
                    let alone = answers(&method, &scene, &[view.ray(i % 37, i / 37)])[0];
                    assert_eq!(alone, hits.get(i), "{equation} {method:?} ray {i}");
                }
            }
        }
    }
}

/// Rays come in bundles, which may be full or not, and are taken whole where all are alike.
#[test]
fn bundles_of_any_size_change_nothing() {
    let (equation, half) = EQUATIONS[0];
    let scene = scene(equation, half);
    let view = view(&scene, 64, 64);
    // All meet the domain, mostly along one axis.
    let rays: Vec<Ray> = (0..70).map(|i| view.ray(28 + i % 9, 28 + i / 9)).collect();
    for (algorithm, stop) in ALGORITHMS.into_iter().flat_map(|a| STOPS.map(|stop| (a, stop))) {
        let method = Bisection { stop, ..method(algorithm, Rounding::Outward, Finishing::Accept) };
        let alone: Vec<Hit> =
            rays.iter().map(|ray| answers(&method, &scene, std::slice::from_ref(ray))[0]).collect();
        for count in 1..=rays.len() {
            let together = answers(&method, &scene, &rays[..count]);
            assert_eq!(together, alone[..count], "{count} rays, {method:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn order_changes_nothing(
        which in 0..EQUATIONS.len(),
        order in Just((0..500).collect::<Vec<usize>>()).prop_shuffle(),
        algorithm in prop::sample::select(ALGORITHMS.to_vec()),
        accept in any::<bool>(),
        stop in prop::sample::select(STOPS.to_vec()),
    ) {
        let (equation, half) = EQUATIONS[which];
        let scene = scene(equation, half);
        let rays: Vec<Ray> = assorted(&scene, 17).into_iter().take(500).collect();
        let finish = if accept { Finishing::Accept } else { Finishing::Certify };
        let method = Bisection { stop, ..method(algorithm, Rounding::Outward, finish) };
        let hits = answers(&method, &scene, &rays);
        let shuffled: Vec<Ray> = order.iter().map(|&i| rays[i]).collect();
        let expected: Vec<Hit> = order.iter().map(|&i| hits[i]).collect();
        prop_assert_eq!(answers(&method, &scene, &shuffled), expected);
    }
}

#[test]
fn deeper_marches_hit_no_more_and_no_earlier() {
    for ((equation, half), algorithm) in
        EQUATIONS.into_iter().flat_map(|e| ALGORITHMS.map(|algorithm| (e, algorithm)))
    {
        let scene = scene(equation, half);
        let rays = assorted(&scene, 21);
        let at = |depth| {
            let stop = Stop::Depth(depth);
            answers(
                &Bisection { stop, ..method(algorithm, Rounding::Outward, Finishing::Accept) },
                &scene,
                &rays,
            )
        };
        let mut before = at(0);
        for depth in [1, 2, 3, 5, 8, 12] {
            let after = at(depth);
            for (i, (shallow, deep)) in before.iter().zip(&after).enumerate() {
                // A dropped slab at a pole says nothing.
                let told =
                    [shallow, deep].iter().all(|h| h.certificate.contains(Certificate::FIRST));
                assert!(
                    !told || !deep.certificate.is_hit() || shallow.certificate.is_hit(),
                    "{equation} depth {depth} ray {i}: {shallow:?} {deep:?}"
                );
                // What is refined without intervals has its bracket elsewhere.
                assert!(
                    algorithm == Algorithm::Mitchell
                        || !told
                        || shallow.bracket[0] <= deep.bracket[0],
                    "{equation} depth {depth} ray {i}: {shallow:?} {deep:?}"
                );
            }
            before = after;
        }
    }
}

#[test]
fn outward_lanes_are_at_least_as_sharp_as_nudged_ones() {
    for (equation, half) in EQUATIONS {
        let scene = scene(equation, half);
        let rays = assorted(&scene, 21);
        let hits = |rounding| {
            let method = method(Algorithm::Kmarch, rounding, Finishing::Accept);
            answers(&method, &scene, &rays)
        };
        for (sharp, nudged) in hits(Rounding::Outward).iter().zip(hits(Rounding::Nudged)) {
            assert!(nudged.certificate.is_hit() || !sharp.certificate.is_hit(), "{equation}");
        }
    }
}
