//! Hostile numbers, intervals and operations, shared by the property tests.

#![allow(dead_code, unreachable_pub, missing_docs)]

use proptest::prelude::*;
use zeroset_ia::{BigInterval, Binary, Constant, Interval, Number, Scalar, Set, Unary};

/// Bits of the oracle.
pub const ORACLE: usize = 256;

/// Single or double precision, with what the tests need of it.
pub trait Float: Scalar {
    const TINY: f64;
    const HUGE: f64;
    fn above(self) -> Self;
    fn below(self) -> Self;
}

macro_rules! float {
    ($float:ident) => {
        impl Float for $float {
            const TINY: f64 = $float::MIN_POSITIVE as f64;
            const HUGE: f64 = $float::MAX as f64;
            fn above(self) -> Self {
                self.next_up()
            }
            fn below(self) -> Self {
                self.next_down()
            }
        }
    };
}
float!(f32);
float!(f64);

/// A finite number: special ones, six decades either way, and any size at all.
pub fn finite<S: Float>() -> impl Strategy<Value = S> {
    let special = vec![
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        2.0,
        3.0,
        -7.0,
        std::f64::consts::PI,
        -std::f64::consts::FRAC_PI_2,
        88.0,
        -103.0,
        16_777_217.0,
    ];
    let edges = prop::sample::select(vec![S::TINY, S::TINY / 8.0, S::HUGE, S::HUGE / 4.0]);
    let decades = (-1.0..1.0f64, -20..20i32).prop_map(|(m, e)| m * 2f64.powi(e));
    let any_size = (-1.0..1.0f64, -140..127i32).prop_map(|(m, e)| m * 2f64.powi(e));
    prop_oneof![
        3 => prop::sample::select(special),
        1 => (edges, any::<bool>()).prop_map(|(x, negative)| if negative { -x } else { x }),
        6 => decades,
        1 => any_size,
        4 => -2.0..2.0f64,
    ]
    .prop_map(S::from_f64)
    .prop_flat_map(|x| (0..3u8).prop_map(move |side| [x, x.above(), x.below()][usize::from(side)]))
    .prop_filter("finite", |x| x.to_f64().is_finite())
}

/// A bounded interval: a point, two neighbours, narrow or wide.
pub fn bounded<S: Float>() -> impl Strategy<Value = Interval<S, Set>> {
    let ends = prop_oneof![
        2 => finite::<S>().prop_map(|x| (x, x)),
        2 => finite::<S>().prop_map(|x| (x, x.above())),
        3 => (finite::<S>(), 0.0..1e-3f64).prop_map(|(x, w)| {
            (x, S::from_f64(x.to_f64() + w * x.to_f64().abs()))
        }),
        4 => (finite::<S>(), finite::<S>()),
    ];
    ends.prop_map(|(x, y)| if x <= y { Interval::new(x, y) } else { Interval::new(y, x) })
        .prop_filter("bounded", |x| x.is_bounded_by(f64::MAX))
}

/// Any interval, empty and unbounded ones among them.
pub fn interval<S: Float>() -> impl Strategy<Value = Interval<S, Set>> {
    let infinity = S::INFINITY;
    prop_oneof![
        20 => bounded::<S>(),
        1 => finite::<S>().prop_map(move |x| Interval::new(x, infinity)),
        1 => finite::<S>().prop_map(move |x| Interval::new(-infinity, x)),
        1 => Just(Interval::new(-infinity, infinity)),
        1 => Just(Interval::new(S::NAN, S::NAN)),
    ]
}

/// An interval and a part of it.
pub fn nested<S: Float>() -> impl Strategy<Value = [Interval<S, Set>; 2]> {
    (interval::<S>(), 0.0..1.0f64, 0.0..1.0f64, 0..4u8).prop_map(|(x, a, b, ends)| {
        let [lo, hi] = x.bounds();
        let inside = |t: f64| {
            let (lo, hi) = (lo.to_f64().max(-S::HUGE), hi.to_f64().min(S::HUGE));
            S::from_f64(lo * (1.0 - t) + hi * t).max(x.lo).min(x.hi)
        };
        let (a, b) = (inside(a.min(b)), inside(a.max(b)));
        let part = match ends {
            0 => Interval::new(a, if a < b { b } else { a }),
            1 => Interval::new(lo, b),
            2 => Interval::new(a, hi),
            _ => Interval::new(b, b),
        };
        [if x.is_empty() { x } else { part }, x]
    })
}

/// The oracle's view of an interval.
pub fn exactly<S: Scalar>(x: Interval<S, Set>) -> BigInterval {
    BigInterval::from_bounds(x.lo.to_f64(), x.hi.to_f64(), ORACLE)
}

/// An operation that any number has.
#[derive(Clone, Debug)]
pub enum Operation {
    Add,
    Sub,
    Mul,
    Div,
    Neg,
    Sqr,
    Power(i32),
    RealPower(f64),
    Scale(f64),
    Offset(f64),
    Unary(Unary),
    Binary(Binary),
}

impl Operation {
    #[inline(always)]
    pub fn apply<N: Number>(&self, x: N, y: N) -> N {
        match *self {
            Self::Add => x + y,
            Self::Sub => x - y,
            Self::Mul => x * y,
            Self::Div => x / y,
            Self::Neg => -x,
            Self::Sqr => x.sqr(),
            Self::Power(n) => x.powi(n),
            Self::RealPower(c) => x.powc(&Constant::from_f64(c)),
            Self::Scale(c) => x.scale(&Constant::from_f64(c)),
            Self::Offset(c) => x.offset(&Constant::from_f64(c)),
            Self::Unary(f) => x.unary(f),
            Self::Binary(f) => x.binary(f, y),
        }
    }
}

/// Each operation, the elementary functions most often.
pub fn operation() -> impl Strategy<Value = Operation> {
    let constant = || prop_oneof![Just(0.0), Just(0.1), Just(-2.0), -9.0..9.0f64];
    prop_oneof![
        4 => prop::sample::select(vec![
            Operation::Add, Operation::Sub, Operation::Mul, Operation::Div, Operation::Neg,
            Operation::Sqr,
        ]),
        // 14 and 15 have three binary digits to multiply.
        2 => (-15..16i32).prop_map(Operation::Power),
        1 => constant().prop_map(Operation::RealPower),
        1 => constant().prop_map(Operation::Scale),
        1 => constant().prop_map(Operation::Offset),
        10 => prop::sample::select(Unary::ALL).prop_map(Operation::Unary),
        4 => prop::sample::select(Binary::ALL).prop_map(Operation::Binary),
    ]
}
