//! SIMD lanes, chosen at run time.
//!
//! Generic code gets an instruction set only when it is inlined into the function that enables it:
//! everything here, and every [`Kernel`], is `#[inline(always)]`.

use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::prelude::*;
use fearless_simd::{Level, f32x16, i32x16, mask32x16};

use crate::real::forward_operators;
use crate::{Nearest, Packet, Real};

/// Sixteen floats; marks step to the neighbouring float, as those of `f32` do.
#[derive(Clone, Copy)]
pub struct Lanes<S: Simd>(f32x16<S>);

impl<S: Simd> Lanes<S> {
    /// Zero in every lane.
    #[inline(always)]
    pub fn zero(token: S) -> Self {
        Self(f32x16::splat(token, 0.0))
    }
}

impl<S: Simd> fmt::Debug for Lanes<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        <[f32; 16]>::from(self.0).fmt(f)
    }
}

forward_operators!([S: Simd] Lanes<S>, |a, b| Lanes(a.0 + b.0), Lanes(a.0 - b.0), Lanes(a.0 * b.0),
    Lanes(a.0 / b.0), |c| Lanes(-c.0));

impl<S: Simd> Real for Lanes<S> {
    type Scalar = f32;
    const OUTWARD: bool = true;

    #[inline(always)]
    fn splat(self, c: f32) -> Self {
        Self(f32x16::splat(self.0.simd, c))
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
        let zero = f32x16::splat(token, 0.0);
        // Adding 0 turns -0 into +0.
        let x = self.0 + zero;
        let bits: i32x16<S> = x.bitcast();
        let one = i32x16::splat(token, 1);
        let step = x.simd_lt(zero).select(i32x16::splat(token, -1), one);
        let above: f32x16<S> = (bits + step).bitcast();
        Self(x.simd_lt(f32x16::splat(token, f32::INFINITY)).select(above, self.0))
    }
    #[inline(always)]
    fn map<const N: usize, const M: usize>(
        x: [Self; N],
        f: impl Fn([f32; N]) -> [f32; M],
    ) -> [Self; M] {
        let token = x[0].0.simd;
        let mut result = [[0.0; 16]; M];
        map_arrays(x.map(|x| x.0.into()), &mut result, f);
        result.map(|y| Self(f32x16::simd_from(token, y)))
    }
}

/// Out of line: a scalar function needs no wide instructions, and many copies of it cost build time.
#[inline(never)]
pub(crate) fn map_arrays<const N: usize, const M: usize>(
    x: [[f32; 16]; N],
    y: &mut [[f32; 16]; M],
    f: impl Fn([f32; N]) -> [f32; M],
) {
    for lane in 0..16 {
        let values = f(x.map(|x| x[lane]));
        for (y, value) in y.iter_mut().zip(values) {
            y[lane] = value;
        }
    }
}

impl<S: Simd> Packet for Lanes<S> {
    const LANES: usize = 16;

    #[inline(always)]
    fn from_fn(self, mut f: impl FnMut(usize) -> f32) -> Self {
        // A loop: `array::from_fn` would call a function for each lane.
        let mut lanes = [0.0; 16];
        for (i, lane) in lanes.iter_mut().enumerate() {
            *lane = f(i);
        }
        Self(f32x16::simd_from(self.0.simd, lanes))
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
        Self(mask32x16::from_bitmask(self.0.simd, mask & 0xffff).select(x.0, y.0))
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

/// Runs a kernel on lanes of an instruction set, which falls back to a narrower one if missing.
pub fn dispatch<K: Kernel>(isa: Isa, rounding: Rounding, kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    {
        let level = Level::new();
        if let (Isa::Avx512, Some(token)) = (isa, level.as_avx512()) {
            return match rounding {
                Rounding::Outward => token.vectorize(
                    #[inline(always)]
                    || kernel.run(embedded::EmbeddedLanes(Lanes::zero(token))),
                ),
                Rounding::Nudged => run_nudged(token, kernel),
                Rounding::Nearest => run_nearest(token, kernel),
            };
        }
        if let (Isa::Avx512 | Isa::Avx2, Some(token)) = (isa, level.as_avx2()) {
            return match rounding {
                Rounding::Outward | Rounding::Nudged => run_nudged(token, kernel),
                Rounding::Nearest => run_nearest(token, kernel),
            };
        }
        let token = level.as_sse2().expect("every x86-64 has SSE2");
        match rounding {
            Rounding::Outward | Rounding::Nudged => run_nudged(token, kernel),
            Rounding::Nearest => run_nearest(token, kernel),
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        let _ = isa;
        fearless_simd::dispatch!(Level::new(), token => match rounding {
            Rounding::Outward | Rounding::Nudged => kernel.run(Lanes::zero(token)),
            Rounding::Nearest => kernel.run(Nearest(Lanes::zero(token))),
        })
    }
}

#[cfg(target_arch = "x86_64")]
fn run_nudged<S: Simd, K: Kernel>(token: S, kernel: K) -> K::Output {
    token.vectorize(
        #[inline(always)]
        || kernel.run(Lanes::zero(token)),
    )
}

#[cfg(target_arch = "x86_64")]
fn run_nearest<S: Simd, K: Kernel>(token: S, kernel: K) -> K::Output {
    token.vectorize(
        #[inline(always)]
        || kernel.run(Nearest(Lanes::zero(token))),
    )
}
