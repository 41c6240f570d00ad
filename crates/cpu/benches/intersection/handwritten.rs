//! The yardstick: K-marching by hand, as a paper's author would write it.
//!
//! Packets of 16 rays (4 by 4 pixels), intervals rounded to nearest, increments by addition, the
//! equations spelled out. All is compiled for one surface at a time.

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, f32x16};

/// How many of the view's rays hit: rays as (origin, direction), 4x4 pixel blocks in order.
pub(crate) fn count_hits<F: Surface>(packets: &[[[f32; 16]; 6]], half: f32, depth: usize) -> usize {
    fearless_simd::dispatch!(Level::new(), token => count::<_, F>(token, packets, half, depth))
}

/// A surface with its equation spelled out.
pub(crate) trait Surface {
    fn value<S: Simd>(x: Interval<S>, y: Interval<S>, z: Interval<S>) -> Interval<S>;
}

#[inline(always)]
fn count<S: Simd, F: Surface>(
    token: S,
    packets: &[[[f32; 16]; 6]],
    half: f32,
    depth: usize,
) -> usize {
    let mut hits = 0;
    for packet in packets {
        hits += march::<_, F>(token, packet, half, depth).count_ones() as usize;
    }
    hits
}

#[derive(Clone, Copy)]
pub(crate) struct Interval<S: Simd> {
    lo: f32x16<S>,
    hi: f32x16<S>,
}

#[inline(always)]
fn sub<S: Simd>(a: Interval<S>, b: Interval<S>) -> Interval<S> {
    Interval { lo: a.lo - b.hi, hi: a.hi - b.lo }
}

#[inline(always)]
fn add<S: Simd>(a: Interval<S>, b: Interval<S>) -> Interval<S> {
    Interval { lo: a.lo + b.lo, hi: a.hi + b.hi }
}

#[inline(always)]
fn mul<S: Simd>(a: Interval<S>, b: Interval<S>) -> Interval<S> {
    let (p, q, r, s) = (a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi);
    Interval { lo: p.min(q).min(r.min(s)), hi: p.max(q).max(r.max(s)) }
}

#[inline(always)]
fn sqr<S: Simd>(a: Interval<S>) -> Interval<S> {
    let mig = a.lo.max(-a.hi).max(0.0);
    let mag = (-a.lo).max(a.hi);
    Interval { lo: mig * mig, hi: mag * mag }
}

/// A positive factor.
#[inline(always)]
fn scale<S: Simd>(a: Interval<S>, c: f32) -> Interval<S> {
    Interval { lo: a.lo * c, hi: a.hi * c }
}

/// A constant added.
#[inline(always)]
fn offset<S: Simd>(a: Interval<S>, c: f32) -> Interval<S> {
    Interval { lo: a.lo + c, hi: a.hi + c }
}

#[inline(always)]
fn neg<S: Simd>(a: Interval<S>) -> Interval<S> {
    Interval { lo: -a.hi, hi: -a.lo }
}

/// The root of what is not negative.
#[inline(always)]
fn sqrt<S: Simd>(a: Interval<S>) -> Interval<S> {
    Interval { lo: a.lo.sqrt(), hi: a.hi.sqrt() }
}

macro_rules! surfaces {
    ($($(#[$doc:meta])* $name:ident($x:ident, $y:ident, $z:ident) $body:block)*) => {$(
        $(#[$doc])*
        pub(crate) struct $name;
        impl Surface for $name {
            #[inline(always)]
            fn value<S: Simd>($x: Interval<S>, $y: Interval<S>, $z: Interval<S>) -> Interval<S> {
                $body
            }
        }
    )*};
}

surfaces! {
    Sphere(x, y, z) {
        offset(add(add(sqr(x), sqr(y)), sqr(z)), -1.0)
    }
    Torus(x, y, z) {
        let ring = offset(neg(sqrt(add(sqr(x), sqr(y)))), 1.0);
        offset(add(sqr(ring), sqr(z)), -0.16)
    }
    BarthSextic(x, y, z) {
        const PHI: f32 = 1.618_034;
        const PHI2: f32 = PHI * PHI;
        let (x2, y2, z2) = (sqr(x), sqr(y), sqr(z));
        let p = mul(sub(scale(x2, PHI2), y2), sub(scale(y2, PHI2), z2));
        let p = scale(mul(p, sub(scale(z2, PHI2), x2)), 4.0);
        let r = offset(add(add(x2, y2), z2), -1.0);
        sub(p, scale(sqr(r), 1.0 + 2.0 * PHI))
    }
    Tangle(x, y, z) {
        let (x2, y2, z2) = (sqr(x), sqr(y), sqr(z));
        let f = sub(sqr(x2), scale(x2, 5.0));
        let f = sub(add(f, sqr(y2)), scale(y2, 5.0));
        offset(sub(add(f, sqr(z2)), scale(z2, 5.0)), 11.8)
    }
    Mitchell(x, y, z) {
        let x2 = sqr(x);
        let yz = add(sqr(y), sqr(z));
        let f = scale(add(sqr(x2), sqr(yz)), 4.0);
        let f = add(f, scale(mul(x2, yz), 17.0));
        offset(sub(f, scale(add(x2, yz), 20.0)), 17.0)
    }
    Klein(x, y, z) {
        let r = add(add(sqr(x), sqr(y)), sqr(z));
        let a = offset(add(r, scale(y, 2.0)), -1.0);
        let b = offset(sub(r, scale(y, 2.0)), -1.0);
        let f = mul(a, sub(sqr(b), scale(sqr(z), 8.0)));
        add(f, scale(mul(mul(x, z), b), 16.0))
    }
}

#[inline(always)]
fn march<S: Simd, F: Surface>(token: S, packet: &[[f32; 16]; 6], half: f32, depth: usize) -> u64 {
    let v = |i: usize| f32x16::simd_from(token, packet[i]);
    let zero = f32x16::splat(token, 0.0);
    // K: the dominant axis of the first ray.
    let first = [packet[3][0], packet[4][0], packet[5][0]];
    let k = (0..3).max_by(|&a, &b| first[a].abs().total_cmp(&first[b].abs())).expect("three axes");
    let (u, w) = ((k + 1) % 3, (k + 2) % 3);
    let forward = first[k] > 0.0;
    let (from, to) = if forward { (-half, half) } else { (half, -half) };
    // The box test.
    let (mut enter, mut leave) = (zero, f32x16::splat(token, f32::INFINITY));
    for axis in 0..3 {
        let (a, b) = ((-v(axis) - half) / v(axis + 3), (-v(axis) + half) / v(axis + 3));
        enter = enter.max(a.min(b));
        leave = leave.min(a.max(b));
    }
    let t_from = (-v(k) + from) / v(k + 3);
    let full_t = (-v(k) + to) / v(k + 3) - t_from;
    let mut valid = enter.simd_le(leave).to_bitmask();
    let mut hits = 0;
    let mut t_step = [zero; 32];
    let mut u_step = [zero; 32];
    let mut w_step = [zero; 32];
    let mut k_step = [0.0_f32; 32];
    for d in 0..depth {
        let width = 1.0 / (1_u32 << d) as f32;
        t_step[d] = full_t * width;
        u_step[d] = t_step[d] * v(u + 3);
        w_step[d] = t_step[d] * v(w + 3);
        k_step[d] = (to - from) * width;
    }
    let mut side = [0_u32; 32];
    let mut d = 0;
    let (mut k0, mut t0) = (from, t_from);
    let (mut u0, mut w0) = (v(u) + v(u + 3) * t_from, v(w) + v(w + 3) * t_from);
    loop {
        let (k1, t1) = (k0 + k_step[d], t0 + t_step[d]);
        let (u1, w1) = (u0 + u_step[d], w0 + w_step[d]);
        let active = valid & enter.simd_le(t1).to_bitmask();
        if active != 0 {
            let mut boxes = [Interval { lo: zero, hi: zero }; 3];
            boxes[k] = Interval {
                lo: f32x16::splat(token, k0.min(k1)),
                hi: f32x16::splat(token, k0.max(k1)),
            };
            boxes[u] = Interval { lo: u0.min(u1), hi: u0.max(u1) };
            boxes[w] = Interval { lo: w0.min(w1), hi: w0.max(w1) };
            let f = F::value(boxes[0], boxes[1], boxes[2]);
            let vanishing =
                active & f.lo.simd_le(zero).to_bitmask() & zero.simd_le(f.hi).to_bitmask();
            if vanishing != 0 {
                if d + 1 == depth {
                    hits |= vanishing;
                    valid &= !vanishing;
                    if valid == 0 {
                        return hits;
                    }
                } else {
                    d += 1;
                    side[d] = 0;
                    continue;
                }
            }
        }
        valid &= t1.simd_le(leave).to_bitmask();
        if valid == 0 {
            return hits;
        }
        (k0, t0, u0, w0) = (k1, t1, u1, w1);
        loop {
            if d == 0 {
                return hits;
            }
            side[d] += 1;
            if side[d] == 1 {
                break;
            }
            d -= 1;
        }
    }
}
