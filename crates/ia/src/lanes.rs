//! SIMD lanes, chosen at run time.
//!
//! Generic code gets an instruction set only when it is inlined into the function that enables it:
//! everything here, and every [`Kernel`], is `#[inline(always)]`.

use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::prelude::*;
use fearless_simd::{
    Level, f32x4, f32x8, f32x16, i32x4, i32x8, i32x16, mask32x4, mask32x8, mask32x16,
};

use crate::real::forward_operators;
use crate::{Nearest, Packet, Real};

macro_rules! lanes {
    ($(#[$doc:meta])* $name:ident: $count:literal of $float:ident, $int:ident, $mask:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub struct $name<S: Simd>($float<S>);

        impl<S: Simd> $name<S> {
            /// Zero in every lane.
            #[inline(always)]
            pub fn zero(token: S) -> Self {
                Self($float::splat(token, 0.0))
            }
        }

        impl<S: Simd> fmt::Debug for $name<S> {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                <[f32; $count]>::from(self.0).fmt(f)
            }
        }

        forward_operators!([S: Simd] $name<S>, |a, b| $name(a.0 + b.0), $name(a.0 - b.0),
            $name(a.0 * b.0), $name(a.0 / b.0), |c| $name(-c.0));

        impl<S: Simd> Real for $name<S> {
            type Scalar = f32;
            const OUTWARD: bool = true;

            #[inline(always)]
            fn splat(self, c: f32) -> Self {
                Self($float::splat(self.0.simd, c))
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(self.0.sqrt())
            }
            #[inline(always)]
            fn abs(self) -> Self {
                Self(self.0.abs())
            }
            #[inline(always)]
            fn floor(self) -> Self {
                Self(self.0.floor())
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                Self(self.0.min(other.0))
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                Self(self.0.max(other.0))
            }
            #[inline(always)]
            fn select_lt(self, other: Self, x: Self, y: Self) -> Self {
                Self(self.0.simd_lt(other.0).select(x.0, y.0))
            }
            #[inline(always)]
            fn down(self) -> Self {
                -(-self).up()
            }
            /// The float above, in integer arithmetic: the bits of a positive float increase with it.
            #[inline(always)]
            fn up(self) -> Self {
                let token = self.0.simd;
                let zero = $float::splat(token, 0.0);
                // Adding 0 turns -0 into +0.
                let x = self.0 + zero;
                let bits: $int<S> = x.bitcast();
                let one = $int::splat(token, 1);
                let step = x.simd_lt(zero).select($int::splat(token, -1), one);
                let above: $float<S> = (bits + step).bitcast();
                Self(x.simd_lt($float::splat(token, f32::INFINITY)).select(above, self.0))
            }
            #[inline(always)]
            fn map<const N: usize, const M: usize>(
                x: [Self; N],
                f: impl Fn([f32; N]) -> [f32; M],
            ) -> [Self; M] {
                let token = x[0].0.simd;
                let mut result = [[0.0; $count]; M];
                map_arrays(x.map(|x| x.0.into()), &mut result, f);
                result.map(|y| Self($float::simd_from(token, y)))
            }
        }

        impl<S: Simd> Packet for $name<S> {
            const LANES: usize = $count;

            #[inline(always)]
            fn from_fn(self, mut f: impl FnMut(usize) -> f32) -> Self {
                // A loop: `array::from_fn` would call a function for each lane.
                let mut lanes = [0.0; $count];
                for (i, lane) in lanes.iter_mut().enumerate() {
                    *lane = f(i);
                }
                Self($float::simd_from(self.0.simd, lanes))
            }
            #[inline(always)]
            fn lane(self, i: usize) -> f32 {
                self.0[i]
            }
            #[inline(always)]
            fn lt(self, other: Self) -> u64 {
                self.0.simd_lt(other.0).to_bitmask()
            }
            #[inline(always)]
            fn le(self, other: Self) -> u64 {
                self.0.simd_le(other.0).to_bitmask()
            }
            #[inline(always)]
            fn select(self, mask: u64, x: Self, y: Self) -> Self {
                const ALL: u64 = (1 << $count) - 1;
                Self($mask::from_bitmask(self.0.simd, mask & ALL).select(x.0, y.0))
            }
            #[inline(always)]
            fn region<T>(self, work: impl FnOnce() -> T) -> T {
                self.0.simd.vectorize(work)
            }
        }
    };
}

lanes!(
    /// Sixteen floats; marks step to the neighbouring float, as those of `f32` do.
    Lanes: 16 of f32x16, i32x16, mask32x16
);
lanes!(
    /// Eight floats, otherwise as [`Lanes`].
    Lanes8: 8 of f32x8, i32x8, mask32x8
);
lanes!(
    /// Four floats, otherwise as [`Lanes`].
    Lanes4: 4 of f32x4, i32x4, mask32x4
);

/// Out of line: a scalar function needs no wide instructions, and many copies of it cost build time.
#[inline(never)]
pub(crate) fn map_arrays<const N: usize, const M: usize, const LANES: usize>(
    x: [[f32; LANES]; N],
    y: &mut [[f32; LANES]; M],
    f: impl Fn([f32; N]) -> [f32; M],
) {
    for lane in 0..LANES {
        let values = f(x.map(|x| x[lane]));
        for (y, value) in y.iter_mut().zip(values) {
            y[lane] = value;
        }
    }
}

/// Sixteen floats with the rounding embedded in each instruction (AVX-512): the tightest bounds.
#[cfg(target_arch = "x86_64")]
pub mod embedded {
    use std::arch::x86_64::*;
    use std::fmt;
    use std::ops::{Add, Div, Mul, Neg, Sub};

    use fearless_simd::prelude::*;
    use fearless_simd::x86::Avx512;

    use super::Lanes;
    use crate::real::{forward, forward_operators};
    use crate::{Packet, Real};

    const DOWN: i32 = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
    const UP: i32 = _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC;

    /// [`Lanes`] whose fused forms round in hardware; the unfused marks still step to the neighbour.
    #[derive(Clone, Copy)]
    pub struct EmbeddedLanes(pub(super) Lanes<Avx512>);

    impl fmt::Debug for EmbeddedLanes {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            self.0.fmt(f)
        }
    }

    forward_operators!([] EmbeddedLanes, |a, b| EmbeddedLanes(a.0 + b.0), EmbeddedLanes(a.0 - b.0),
        EmbeddedLanes(a.0 * b.0), EmbeddedLanes(a.0 / b.0), |c| EmbeddedLanes(-c.0));

    macro_rules! rounded {
        ($($name:ident = $intrinsic:ident::<$mode:ident>($($o:ident),*);)*) => {$(
            #[inline(always)]
            fn $name(self, $($o: Self),*) -> Self {
                fearless_simd::kernel!(
                    #[inline(always)]
                    fn kernel(token: Avx512, a: __m512 $(, $o: __m512)*) -> __m512 {
                        let _ = token;
                        $intrinsic::<$mode>(a $(, $o)*)
                    }
                );
                let token = self.0.0.simd;
                let rounded = kernel(token, self.0.0.into() $(, $o.0.0.into())*);
                Self(Lanes(rounded.simd_into(token)))
            }
        )*};
    }

    impl Real for EmbeddedLanes {
        type Scalar = f32;
        const OUTWARD: bool = true;

        rounded! {
            add_down = _mm512_add_round_ps::<DOWN>(o);
            add_up = _mm512_add_round_ps::<UP>(o);
            sub_down = _mm512_sub_round_ps::<DOWN>(o);
            sub_up = _mm512_sub_round_ps::<UP>(o);
            mul_down = _mm512_mul_round_ps::<DOWN>(o);
            mul_up = _mm512_mul_round_ps::<UP>(o);
            div_down = _mm512_div_round_ps::<DOWN>(o);
            div_up = _mm512_div_round_ps::<UP>(o);
            sqrt_down = _mm512_sqrt_round_ps::<DOWN>();
            sqrt_up = _mm512_sqrt_round_ps::<UP>();
        }
        #[inline(always)]
        fn splat(self, c: f32) -> Self {
            Self(self.0.splat(c))
        }
        forward! { sqrt(); abs(); floor(); min(o); max(o); select_lt(o, x, y); down(); up(); }
        #[inline(always)]
        fn map<const N: usize, const M: usize>(
            x: [Self; N],
            f: impl Fn([f32; N]) -> [f32; M],
        ) -> [Self; M] {
            Lanes::map(x.map(|x| x.0), f).map(Self)
        }
        /// Each of the four products is rounded down and up: cheaper than to step afterwards.
        #[inline(always)]
        fn mul_bounds(a: [Self; 2], b: [Self; 2]) -> [Self; 2] {
            let lo = a[0].mul_down(b[0]).min(a[0].mul_down(b[1]));
            let lo = lo.min(a[1].mul_down(b[0]).min(a[1].mul_down(b[1])));
            let hi = a[0].mul_up(b[0]).max(a[0].mul_up(b[1]));
            [lo, hi.max(a[1].mul_up(b[0]).max(a[1].mul_up(b[1])))]
        }
        #[inline(always)]
        fn mul_bounds_unbounded(a: [Self; 2], b: [Self; 2]) -> [Self; 2] {
            let p = a[0].mul_down(b[0]).zero_where_nan();
            let q = a[0].mul_down(b[1]).zero_where_nan();
            let r = a[1].mul_down(b[0]).zero_where_nan();
            let s = a[1].mul_down(b[1]).zero_where_nan();
            let lo = p.min(q).min(r.min(s));
            let p = a[0].mul_up(b[0]).zero_where_nan();
            let q = a[0].mul_up(b[1]).zero_where_nan();
            let r = a[1].mul_up(b[0]).zero_where_nan();
            let s = a[1].mul_up(b[1]).zero_where_nan();
            [lo, p.max(q).max(r.max(s))]
        }
    }

    impl Packet for EmbeddedLanes {
        const LANES: usize = 16;

        #[inline(always)]
        fn from_fn(self, f: impl FnMut(usize) -> f32) -> Self {
            Self(self.0.from_fn(f))
        }
        #[inline(always)]
        fn lane(self, i: usize) -> f32 {
            self.0.lane(i)
        }
        #[inline(always)]
        fn lt(self, other: Self) -> u64 {
            self.0.lt(other.0)
        }
        #[inline(always)]
        fn le(self, other: Self) -> u64 {
            self.0.le(other.0)
        }
        #[inline(always)]
        fn select(self, mask: u64, x: Self, y: Self) -> Self {
            Self(self.0.select(mask, x.0, y.0))
        }
        #[inline(always)]
        fn region<T>(self, work: impl FnOnce() -> T) -> T {
            self.0.region(work)
        }
    }
}

/// An instruction set that lanes can use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Isa {
    /// What every machine of this architecture has: SSE2, NEON or plain floats.
    Portable,
    /// x86-64 with AVX2.
    Avx2,
    /// x86-64 with AVX-512.
    Avx512,
}

impl Isa {
    /// Those that this machine has, the widest last.
    pub fn available() -> Vec<Self> {
        let mut isas = vec![Self::Portable];
        #[cfg(target_arch = "x86_64")]
        {
            let level = Level::new();
            isas.extend(level.as_avx2().map(|_| Self::Avx2));
            isas.extend(level.as_avx512().map(|_| Self::Avx512));
        }
        isas
    }

    /// The widest that this machine has.
    pub fn best() -> Self {
        *Self::available().last().expect("the portable set is always there")
    }

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Portable => "portable",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }
}

/// How lanes round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rounding {
    /// Outward, in the tightest way that the instruction set has.
    Outward,
    /// Outward by stepping to the neighbouring float: the same bits on every instruction set.
    Nudged,
    /// To nearest: proves nothing.
    Nearest,
}

/// Work that is generic over the lanes; `run` must be `#[inline(always)]`.
pub trait Kernel {
    /// What it gives.
    type Output;
    /// Does the work; `zero` gives the context for constants.
    fn run<R: Packet>(self, zero: R) -> Self::Output;
}

/// Does plain work in code for the widest instruction set that this machine has. The closure, and what
/// it calls, must be `#[inline(always)]` to be part of that code.
pub fn widest<T>(work: impl FnOnce() -> T) -> T {
    fearless_simd::dispatch!(Level::new(), token => {
        let _ = token;
        work()
    })
}

/// Runs a kernel on sixteen lanes of an instruction set, which falls back to a narrower one if missing.
pub fn dispatch<K: Kernel>(isa: Isa, rounding: Rounding, kernel: K) -> K::Output {
    let level = Level::new();
    #[cfg(target_arch = "x86_64")]
    {
        if let (Isa::Avx512, Some(token)) = (isa, level.as_avx512()) {
            return match rounding {
                Rounding::Outward => token.vectorize(
                    #[inline(always)]
                    || kernel.run(embedded::EmbeddedLanes(Lanes::zero(token))),
                ),
                _ => run_on(token, Lanes::zero(token), rounding, kernel),
            };
        }
        if let (Isa::Avx512 | Isa::Avx2, Some(token)) = (isa, level.as_avx2()) {
            return run_on(token, Lanes::zero(token), rounding, kernel);
        }
        let token = level.as_sse2().expect("every x86-64 has SSE2");
        run_on(token, Lanes::zero(token), rounding, kernel)
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        let _ = isa;
        fearless_simd::dispatch!(level, token => run_on(token, Lanes::zero(token), rounding, kernel))
    }
}

/// One register of the instruction set that has registers of that size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Register {
    /// Four floats: SSE2, or what every machine of the architecture has.
    Four,
    /// Eight floats: AVX2.
    Eight,
    /// Sixteen floats: AVX-512.
    Sixteen,
}

impl Register {
    /// Those that this machine has, the widest last.
    pub fn available() -> Vec<Self> {
        let of = |isa| match isa {
            Isa::Portable => Self::Four,
            Isa::Avx2 => Self::Eight,
            Isa::Avx512 => Self::Sixteen,
        };
        Isa::available().into_iter().map(of).collect()
    }
}

/// Runs a kernel on packets of one register, or on a smaller one if this machine lacks it.
pub fn dispatch_register<K: Kernel>(
    register: Register,
    rounding: Rounding,
    kernel: K,
) -> K::Output {
    let level = Level::new();
    #[cfg(target_arch = "x86_64")]
    {
        if register == Register::Sixteen && level.as_avx512().is_some() {
            return dispatch(Isa::Avx512, rounding, kernel);
        }
        if let (Register::Eight | Register::Sixteen, Some(token)) = (register, level.as_avx2()) {
            return run_on(token, Lanes8::zero(token), rounding, kernel);
        }
        let token = level.as_sse2().expect("every x86-64 has SSE2");
        run_on(token, Lanes4::zero(token), rounding, kernel)
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        let _ = register;
        fearless_simd::dispatch!(level, token => run_on(token, Lanes4::zero(token), rounding, kernel))
    }
}

/// Runs a kernel on lanes without embedded rounding, in code for the token's instruction set.
#[inline(always)]
fn run_on<S: Simd, R: Packet<Scalar = f32>, K: Kernel>(
    token: S,
    zero: R,
    rounding: Rounding,
    kernel: K,
) -> K::Output {
    match rounding {
        Rounding::Outward | Rounding::Nudged => token.vectorize(
            #[inline(always)]
            || kernel.run(zero),
        ),
        Rounding::Nearest => token.vectorize(
            #[inline(always)]
            || kernel.run(Nearest(zero)),
        ),
    }
}
