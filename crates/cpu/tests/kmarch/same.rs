//! An answer depends on its ray and the knobs alone.

use proptest::prelude::*;
use zeroset_cpu::{Finishing, Kmarch, Stop};
use zeroset_ia::{Isa, Rounding};
use zeroset_raycast::{Certificate, Hit, Ray, Rays};

use crate::{EQUATIONS, answers, assorted, cast, scene, view};

fn method(rounding: Rounding, finish: Finishing) -> Kmarch {
    Kmarch { rounding, finish, stop: Stop::Depth(8), ..Kmarch::default() }
}

/// The bits of answers, so that zeros differ by sign and infinities compare.
fn bits(hits: &[Hit]) -> Vec<([u64; 2], Hit)> {
    hits.iter().map(|hit| (hit.bracket.map(f64::to_bits), *hit)).collect()
}

#[test]
fn the_instruction_set_changes_nothing() {
    for (equation, half) in EQUATIONS {
        let scene = scene(equation, half);
        let rays = assorted(&scene, 21);
        for rounding in [Rounding::Nearest, Rounding::Nudged] {
            for finish in [Finishing::Accept, Finishing::Certify] {
                let cast_on = |isa| {
                    let method = Kmarch { isa: Some(isa), ..method(rounding, finish) };
                    answers(&method, &scene, &rays)
                };
                let expected = cast_on(Isa::Portable);
                assert!(expected.iter().any(|hit| hit.certificate.is_hit()), "{equation}");
                for isa in Isa::available() {
                    let hits = cast_on(isa);
                    assert_eq!(bits(&hits), bits(&expected), "{equation} {rounding:?} {isa:?}");
                }
            }
        }
    }
}

#[test]
fn a_view_is_its_rays_one_by_one() {
    for (equation, half) in EQUATIONS {
        let scene = scene(equation, half);
        let view = view(&scene, 37, 35);
        for rounding in [Rounding::Outward, Rounding::Nearest] {
            for finish in [Finishing::Accept, Finishing::Certify] {
                let method = method(rounding, finish);
                let hits = cast(&method, &scene, Rays::View(&view));
                for i in (0..hits.len()).step_by(13) {
                    let alone = answers(&method, &scene, &[view.ray(i % 37, i / 37)])[0];
                    assert_eq!(alone, hits.get(i), "{equation} {rounding:?} {finish:?} ray {i}");
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn order_changes_nothing(
        which in 0..EQUATIONS.len(),
        order in Just((0..500).collect::<Vec<usize>>()).prop_shuffle(),
        accept in any::<bool>(),
    ) {
        let (equation, half) = EQUATIONS[which];
        let scene = scene(equation, half);
        let rays: Vec<Ray> = assorted(&scene, 17).into_iter().take(500).collect();
        let finish = if accept { Finishing::Accept } else { Finishing::Certify };
        let method = method(Rounding::Outward, finish);
        let hits = answers(&method, &scene, &rays);
        let shuffled: Vec<Ray> = order.iter().map(|&i| rays[i]).collect();
        let expected: Vec<Hit> = order.iter().map(|&i| hits[i]).collect();
        prop_assert_eq!(answers(&method, &scene, &shuffled), expected);
    }
}

#[test]
fn deeper_marches_hit_no_more_and_no_earlier() {
    for (equation, half) in EQUATIONS {
        let scene = scene(equation, half);
        let rays = assorted(&scene, 21);
        let at = |depth| {
            let stop = Stop::Depth(depth);
            answers(&Kmarch { stop, ..method(Rounding::Outward, Finishing::Accept) }, &scene, &rays)
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
                assert!(
                    !told || shallow.bracket[0] <= deep.bracket[0],
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
        let hits = |rounding| answers(&method(rounding, Finishing::Accept), &scene, &rays);
        for (sharp, nudged) in hits(Rounding::Outward).iter().zip(hits(Rounding::Nudged)) {
            assert!(nudged.certificate.is_hit() || !sharp.certificate.is_hit(), "{equation}");
        }
    }
}
