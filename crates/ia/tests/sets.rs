//! Intersections and hulls, on scalars and lanes.

use zeroset_ia::{Interval, Isa, Kernel, Packet, Raw, Rounding, Scalar, Set, dispatch};

type Ends = [f32; 2];

const EMPTY: Ends = [f32::NAN; 2];
const INFINITY: f32 = f32::INFINITY;

/// Operands, their intersection and their hull.
const CASES: [[Ends; 4]; 10] = [
    [[1.0, 3.0], [2.0, 4.0], [2.0, 3.0], [1.0, 4.0]],
    [[2.0, 4.0], [1.0, 3.0], [2.0, 3.0], [1.0, 4.0]],
    [[1.0, 4.0], [2.0, 3.0], [2.0, 3.0], [1.0, 4.0]],
    [[1.0, 2.0], [2.0, 3.0], [2.0, 2.0], [1.0, 3.0]],
    [[1.0, 2.0], [3.0, 4.0], EMPTY, [1.0, 4.0]],
    [[3.0, 4.0], [1.0, 2.0], EMPTY, [1.0, 4.0]],
    [[1.0, 2.0], EMPTY, EMPTY, [1.0, 2.0]],
    [EMPTY, [1.0, 2.0], EMPTY, [1.0, 2.0]],
    [EMPTY, EMPTY, EMPTY, EMPTY],
    [[-INFINITY, 0.0], [-1.0, INFINITY], [-1.0, 0.0], [-INFINITY, INFINITY]],
];

fn same(x: Ends, y: Ends) -> bool {
    x == y || x.iter().chain(&y).all(|end| end.is_nan())
}

/// Intersections and hulls of sixteen cases at once.
struct InLanes;

impl Kernel for InLanes {
    type Output = [Vec<Ends>; 2];
    #[inline(always)]
    fn run<R: Packet>(self, zero: R) -> Self::Output {
        let load = |operand: usize| {
            let end = |i: usize, end: usize| {
                R::Scalar::from_f64(f64::from(CASES[i % CASES.len()][operand][end]))
            };
            Interval::<R, Set>::new(zero.from_fn(|i| end(i, 0)), zero.from_fn(|i| end(i, 1)))
        };
        let (x, y) = (load(0), load(1));
        [x.intersection(y), x.hull(y)].map(|result| {
            (0..R::LANES)
                .map(|i| [result.lo, result.hi].map(|end| end.lane(i).to_f64() as f32))
                .collect()
        })
    }
}

#[test]
fn of_lanes_are_those_of_sets() {
    for isa in Isa::available() {
        for rounding in [Rounding::Outward, Rounding::Nudged, Rounding::Nearest] {
            let [intersections, hulls] = dispatch(isa, rounding, InLanes);
            for (i, (intersection, hull)) in intersections.into_iter().zip(hulls).enumerate() {
                let case = CASES[i % CASES.len()];
                assert!(same(intersection, case[2]), "{isa:?} {case:?}: {intersection:?}");
                assert!(same(hull, case[3]), "{isa:?} {case:?}: {hull:?}");
            }
        }
    }
}

#[test]
fn of_scalars_are_those_of_sets() {
    for [x, y, intersection, hull] in CASES {
        let [a, b] = [x, y].map(|[lo, hi]| Interval::<f32, Set>::new(lo, hi));
        assert!(same(a.intersection(b).bounds(), intersection), "{x:?} {y:?}");
        assert!(same(a.hull(b).bounds(), hull), "{x:?} {y:?}");
        let [a, b] = [x, y].map(|x| Interval::<f64, Set>::new(x[0].into(), x[1].into()));
        assert!(same(a.intersection(b).bounds().map(|x| x as f32), intersection), "{x:?} {y:?}");
        assert!(same(a.hull(b).bounds().map(|x| x as f32), hull), "{x:?} {y:?}");
    }
}

#[test]
fn of_raw_intervals_that_meet_are_the_same() {
    for [x, y, intersection, hull] in CASES {
        if !intersection[0].is_nan() {
            let [a, b] = [x, y].map(|[lo, hi]| Interval::<f32, Raw>::new(lo, hi));
            assert_eq!(a.intersection(b).bounds(), intersection, "{x:?} {y:?}");
            assert_eq!(a.hull(b).bounds(), hull, "{x:?} {y:?}");
        }
    }
}

#[test]
fn members_are_told() {
    let x = Interval::<f64, Set>::new(-1.0, 2.0);
    for (member, is_in) in [(-1.0, true), (2.0, true), (0.5, true), (-1.5, false), (2.5, false)] {
        assert_eq!(x.contains(member), is_in, "{member}");
    }
    assert!(x.contains_zero() && !x.is_empty() && !x.contains(f64::NAN));
    assert!(!Interval::<f64, Set>::new(0.5, 2.0).contains_zero());
    assert!(!Interval::<f64, Set>::new(-2.0, -0.5).contains_zero());
    assert!(Interval::<f64, Set>::new(f64::NAN, 1.0).is_empty());
    assert!(Interval::<f64, Set>::new(1.0, f64::NAN).is_empty());
    assert!(x.is_bounded_by(2.0) && !x.is_bounded_by(1.5) && !(-x).is_bounded_by(1.5));
    assert!(!Interval::<f64, Set>::new(f64::NAN, f64::NAN).is_bounded_by(f64::INFINITY));
}
