//! Bounds for devices hold: on the mirror, and on a device that errs as far as a shading language allows.

use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

use proptest::prelude::*;
use zeroset_ia::portable::{self, DIVISION_STEPS, ROOT_STEPS};
use zeroset_ia::{BigInterval, Binary, Interval, Mirror, Number, Portable, Raw, Real, Unary};

type I<R> = Interval<R, Raw>;

thread_local! {
    static STATE: Cell<u64> = const { Cell::new(1) };
}

/// A few random bits.
fn random(limit: u64) -> u64 {
    STATE.with(|state| {
        let x = state.get().wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        state.set(x);
        (x >> 33) % limit
    })
}

/// A device that errs: sums and products are either neighbour of the exact value, quotients and roots
/// are wrong by 2 and 4 units more, and subnormal numbers vanish now and then.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rogue(f32);

/// A float at or beside `x`, not beyond `exact`'s other neighbour, and so many more away.
fn near(x: f32, exact: f64, more: u64) -> Rogue {
    let mut y = x;
    let up = random(2) == 1;
    if f64::from(y) != exact && exact.is_finite() {
        // The other neighbour, half of the time.
        if random(2) == 1 {
            y = if f64::from(y) < exact { y.next_up() } else { y.next_down() };
        }
        for _ in 0..random(more + 1) {
            y = if up { y.next_up() } else { y.next_down() };
        }
    }
    Rogue(if y.is_subnormal() && random(2) == 1 { 0.0 } else { y })
}

impl Add for Rogue {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        near(self.0 + o.0, f64::from(self.0) + f64::from(o.0), 0)
    }
}
impl Sub for Rogue {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}
impl Mul for Rogue {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        near(self.0 * o.0, f64::from(self.0) * f64::from(o.0), 0)
    }
}
impl Div for Rogue {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        near(self.0 / o.0, f64::from(self.0) / f64::from(o.0), 2)
    }
}
impl Neg for Rogue {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Real for Rogue {
    type Scalar = f32;
    const OUTWARD: bool = true;
    fn splat(self, c: f32) -> Self {
        Self(c)
    }
    fn sqrt(self) -> Self {
        near(self.0.sqrt(), f64::from(self.0).sqrt(), 4)
    }
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn floor(self) -> Self {
        Self(self.0.floor())
    }
    fn min(self, o: Self) -> Self {
        Self(self.0.min(o.0))
    }
    fn max(self, o: Self) -> Self {
        Self(self.0.max(o.0))
    }
    fn select_lt(self, o: Self, x: Self, y: Self) -> Self {
        if self.0 < o.0 { x } else { y }
    }
    fn down(self) -> Self {
        Self(Mirror(self.0).down().0)
    }
    fn up(self) -> Self {
        Self(Mirror(self.0).up().0)
    }
    fn div_down(self, o: Self) -> Self {
        Self(portable::step_down((self / o).0, DIVISION_STEPS))
    }
    fn div_up(self, o: Self) -> Self {
        Self(-portable::step_down(-(self / o).0, DIVISION_STEPS))
    }
    fn sqrt_down(self) -> Self {
        Self(portable::step_down(self.sqrt().0, ROOT_STEPS))
    }
    fn sqrt_up(self) -> Self {
        Self(-portable::step_down(-self.sqrt().0, ROOT_STEPS))
    }
    fn map<const N: usize, const M: usize>(
        _: [Self; N],
        _: impl Fn([f32; N]) -> [f32; M],
    ) -> [Self; M] {
        panic!("a device does not look into lanes")
    }
    fn unary_range(f: Unary, x: [Self; 2]) -> [Self; 2] {
        portable::unary_range(f, x)
    }
    fn binary_range(f: Binary, x: [Self; 2], y: [Self; 2]) -> [Self; 2] {
        portable::binary_range(f, x, y)
    }
}

impl Portable for Rogue {
    fn exp2_integer(self) -> Self {
        Self(Mirror(self.0).exp2_integer().0)
    }
    fn exponent(self) -> Self {
        Self(Mirror(self.0).exponent().0)
    }
}

/// The exact value's enclosure.
fn exact(f: Unary, x: f32) -> [f64; 2] {
    BigInterval::from_f64(x.into(), 192).unary(f).to_f64()
}

/// The part of the domain in which results are bounded.
fn domain(f: Unary) -> [f32; 2] {
    match f {
        Unary::Sqrt => [0.0, 1e30],
        Unary::Exp | Unary::Expm1 => [-1e3, 69.0],
        Unary::Sinh | Unary::Cosh => [-69.0, 69.0],
        Unary::Exp2 => [-1e3, 99.0],
        Unary::Exp10 => [-1e3, 30.0],
        Unary::Log | Unary::Log2 | Unary::Log10 => [1e-37, 1e30],
        Unary::Logp1 => [-0.999, 1e30],
        Unary::Sin | Unary::Cos => [-2e4, 2e4],
        _ => [-1e30, 1e30],
    }
}

/// Numbers of a range: anywhere, of any size, near multiples of pi/2, near 0 and 1.
fn number([lo, hi]: [f32; 2]) -> impl Strategy<Value = f32> {
    let size = (-37.0_f64..37.0, any::<bool>())
        .prop_map(|(e, negative)| (10.0_f64.powf(e) * if negative { -1.0 } else { 1.0 }) as f32);
    let turns = (-10_000..10_000_i32, -2..3_i32).prop_map(|(n, ulps)| {
        let x = (f64::from(n) * std::f64::consts::FRAC_PI_2) as f32;
        f32::from_bits((x.to_bits() as i32 + ulps).max(0) as u32)
    });
    let special = prop_oneof![Just(0.0_f32), Just(1.0), Just(-1.0), Just(1.0_f32.next_down())];
    let ordinary = -100.0_f32..100.0;
    prop_oneof![ordinary, size, turns, special].prop_map(move |x| {
        let x = x.clamp(lo, hi);
        if x.is_subnormal() { 0.0_f32.clamp(lo, hi) } else { x }
    })
}

fn functions() -> Vec<Unary> {
    Unary::ALL.iter().copied().filter(|f| portable::has_unary(*f)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn ranges_hold_every_value(
        (f, a, b, at) in prop::sample::select(functions()).prop_flat_map(|f| {
            (Just(f), number(domain(f)), number(domain(f)), 0.0_f64..=1.0)
        }),
        seed in any::<u64>(),
    ) {
        STATE.set(seed);
        let (lo, hi) = (a.min(b), a.max(b));
        let inside = ((f64::from(lo) + at * (f64::from(hi) - f64::from(lo))) as f32).clamp(lo, hi);
        let mirror = I::new(Mirror(lo), Mirror(hi)).unary(f);
        let rogue = I::new(Rogue(lo), Rogue(hi)).unary(f);
        for x in [lo, hi, inside] {
            // Flushed, it is another number.
            if x.is_subnormal() { continue; }
            let [least, most] = exact(f, x);
            for (name, [from, to]) in [
                ("mirror", mirror.bounds().map(|x| x.0)),
                ("rogue", rogue.bounds().map(|x| x.0)),
            ] {
                prop_assert!(
                    f64::from(from) <= least && most <= f64::from(to),
                    "{name}: {f}([{lo:e}, {hi:e}]) = [{from:e}, {to:e}], but {f}({x:e}) = {least:e}"
                );
            }
        }
    }

    #[test]
    fn powers_hold_every_value(
        a in number([0.0, 1e9]), b in number([0.0, 1e9]), y in -3.0_f32..3.0, at in 0.0_f64..=1.0,
        seed in any::<u64>(),
    ) {
        STATE.set(seed);
        let (lo, hi) = (a.min(b), a.max(b));
        let y = if lo > 1e-9 { y } else { y.abs() };
        prop_assume!(!y.is_subnormal());
        let x = ((f64::from(lo) + at * (f64::from(hi) - f64::from(lo))) as f32).clamp(lo, hi);
        prop_assume!(!x.is_subnormal());
        let power = I::new(Rogue(lo), Rogue(hi)).binary(Binary::Pow, I::point(Rogue(y)));
        let [big_x, big_y] = [x, y].map(|x| BigInterval::from_f64(x.into(), 192));
        let [least, most] = big_x.binary(Binary::Pow, big_y).to_f64();
        let [from, to] = power.bounds().map(|x| f64::from(x.0));
        prop_assert!(from <= least && most <= to, "[{lo:e}, {hi:e}]^{y} = [{from:e}, {to:e}]; {x:e}");
    }

    #[test]
    fn arithmetic_holds_every_value(
        a in number([-1e15, 1e15]), b in number([-1e15, 1e15]), c in number([-1e15, 1e15]),
        d in number([-1e15, 1e15]), n in prop_oneof![2..9_i32, -3..0], seed in any::<u64>(),
    ) {
        STATE.set(seed);
        let (x, y) = (I::new(Rogue(a.min(b)), Rogue(a.max(b))), I::new(Rogue(c.min(d)), Rogue(c.max(d))));
        let within = |z: I<Rogue>, exact: BigInterval| {
            let [least, most] = exact.to_f64();
            let [lo, hi] = z.bounds().map(|x| f64::from(x.0));
            lo <= least && most <= hi
        };
        let big = |x: f32| BigInterval::from_f64(x.into(), 256);
        prop_assert!(within(x + y, big(a) + big(c)));
        prop_assert!(within(x - y, big(a) - big(c)));
        prop_assert!(within(x * y, big(a) * big(c)));
        prop_assert!(within(x.sqr(), big(a).sqr()));
        if y.lo.0 > 1e-15 || y.hi.0 < -1e-15 {
            prop_assert!(within(x / y, big(a) / big(c)));
        }
        let small = a.abs().max(b.abs()) < 1e4 && (n > 0 || x.lo.0 > 1e-4 || x.hi.0 < -1e-4);
        if small {
            prop_assert!(within(x.powi(n), big(a).powi(n)), "{a}^{n}");
        }
    }
}

#[test]
fn bounds_are_not_loose() {
    // In units of the last place at the value, over points of moderate size.
    for (f, limit) in [
        (Unary::Exp, 60.0),
        (Unary::Log, 40.0),
        (Unary::Sin, 40.0),
        (Unary::Cos, 40.0),
        (Unary::Sqrt, 20.0),
    ] {
        for i in 1..200 {
            let x = 0.07 * i as f32 + if f == Unary::Log { 2.0 } else { 0.0 };
            let [lo, hi] = I::point(Mirror(x)).unary(f).bounds().map(|x| x.0);
            // Sine and cosine: of their largest value.
            let size =
                if matches!(f, Unary::Sin | Unary::Cos) { 1.0 } else { lo.abs().max(hi.abs()) };
            let width = (hi - lo) / (size * f32::EPSILON);
            assert!(width <= limit, "{f}({x}) = [{lo}, {hi}]: {width} units");
        }
    }
}
