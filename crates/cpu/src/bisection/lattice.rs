//! The geometry of bisection: where rays are cut into pieces.
//!
//! A ray's place is told by q, the distance along its dominant axis from where the cutting starts.
//! Pieces are `q_i <= q <= q_{i+1}`, dyadic fractions of a length. The boundaries q are exact numbers
//! that neighbouring pieces share, so that nothing falls between two. At a boundary, a coordinate U of
//! a ray is at `u0 + q s` with `s = d_U / |d_K|`: one product and one sum, whatever the depth, so that
//! a ray's boxes do not depend on the pieces that its neighbours made the packet visit.
//!
//! [`Cut::Slabs`] cuts all rays at the same planes across K, [`Cut::Rays`] each between where it enters
//! the domain and where it leaves.

use std::marker::PhantomData;

use zeroset_expr::Evaluator;
use zeroset_ia::interval::Flavor;
use zeroset_ia::{Interval, Packet, Plain, Real, Scalar};

use super::bundle::{Few, SIZE};
use super::clock::{TINY, UNITS_8};
use super::cut::{Axis, Bounds, Cut, Cutting};

/// The two ends of `x` with an error up to `e`, as numbers of the scalar type; for a nearest type,
/// `x` twice. What is unknown is unbounded.
///
/// To single precision, rounding moves a number by 2^-24 of itself, or by 2^-150 near 0: moving it
/// twice as far before is enough.
#[inline(always)]
fn ends<S: Scalar>(x: f64, e: f64) -> [S; 2] {
    if !S::OUTWARD {
        return [S::from_f64(x), S::from_f64(x)];
    }
    let (e, limit) = if size_of::<S>() == 4 {
        (e + (x.abs() + e) * f64::from(f32::EPSILON) + TINY_SINGLE, f64::from(f32::MAX))
    } else {
        (e, f64::MAX)
    };
    let (lo, hi) = (x - e, x + e);
    // NaN becomes unbounded, and what overflows stays on the right side of infinity.
    let lo = if lo >= -limit { lo } else { f64::NEG_INFINITY };
    let hi = if hi <= limit { hi } else { f64::INFINITY };
    [
        S::from_f64(if lo <= limit { lo } else { limit }),
        S::from_f64(if hi >= -limit { hi } else { -limit }),
    ]
}

/// 2^-148.
const TINY_SINGLE: f64 = f64::from_bits((1023 - 148) << 52);

/// Boundaries for the rays of a packet, in lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice<R: Real, C> {
    cutting: PhantomData<C>,
    /// Does K increase along slabs?
    forward: bool,
    /// How far slabs go, and the last boundary: not before the end of the box.
    length: f64,
    end: R::Scalar,
    /// Where slabs start.
    start: R,
    /// How far each ray's own pieces go: not less than its part in the domain.
    lengths: R,
    /// The axes of the coordinates below; of slabs, K is the first.
    axes: [usize; 3],
    /// Coordinates at q = 0.
    origin: [[R; 2]; 3],
    /// Their slopes in q.
    slope: [[R; 2]; 3],
    /// The range of q in which roots count.
    range: [R; 2],
    /// The box along the axes.
    bounds: [[R; 2]; 3],
}

/// Where the rays of a packet cross a boundary.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boundary<R: Real> {
    /// Its distance from the start: exact.
    pub q: R,
    /// The ends of the coordinates.
    ends: [[R; 2]; 3],
}

impl<R: Packet, C: Cutting> Lattice<R, C> {
    /// The lattice of at most as many rays as there are lanes; other lanes have one, too.
    ///
    /// In units of u = 2^-53, the errors are: `t0 = (start - o_K) / d_K`, 3 t0 (for a ray's own pieces
    /// t0 is exact); `u0 = o_U + t0 d_U`, 4 t0 d_U + u0, and 1 for its ends; `s = d_U / |d_K|`, 2 s and
    /// 1; `q = (t - t0) |d_K|`, 3 t0 |d_K| + 2 q and 1. Each is less than 8 times the sum of absolute
    /// values below.
    #[inline(always)]
    pub(super) fn new(zero: R, cut: Cut, bounds: &Bounds, packet: Few<'_>) -> Self {
        let axes = match cut {
            Cut::Slabs(axis) => axis.all(),
            Cut::Rays => [0, 1, 2],
        };
        // By place, as all that follows.
        let o = axes.map(|axis| packet.lanes(|bundle| &bundle.origin[axis], R::LANES));
        let d = axes.map(|axis| packet.lanes(|bundle| &bundle.direction[axis], R::LANES));
        let t = [0, 1].map(|end| packet.lanes(|bundle| &bundle.range[end], R::LANES));
        let (start, length, first) = match cut {
            Cut::Slabs(axis) => (bounds.start(axis), bounds.length(axis), 1),
            Cut::Rays => (0.0, 0.0, 0),
        };
        // t where q = 0, the direction's component along the dominant axis, and its inverse. Loops without
        // branches, which the compiler turns into vectors.
        let [mut t0, mut along, mut pace] = [[0.0_f64; SIZE]; 3];
        match cut {
            Cut::Slabs(_) => {
                for i in 0..R::LANES {
                    let inverse = 1.0 / d[0][i];
                    t0[i] = (start - o[0][i]) * inverse;
                    along[i] = d[0][i].abs();
                    pace[i] = inverse.abs();
                }
            }
            Cut::Rays => {
                for i in 0..R::LANES {
                    t0[i] = t[0][i];
                    let [x, y, z] = [d[0][i].abs(), d[1][i].abs(), d[2][i].abs()];
                    let larger = if x < y { y } else { x };
                    along[i] = if larger < z { z } else { larger };
                    pace[i] = 1.0 / along[i];
                }
            }
        }
        let zeros = [[R::Scalar::from_f64(0.0); SIZE]; 2];
        let (mut origin, mut slope, mut range) = ([zeros; 3], [zeros; 3], zeros);
        for place in first..3 {
            let [origin_lo, origin_hi] = &mut origin[place];
            let [slope_lo, slope_hi] = &mut slope[place];
            for i in 0..R::LANES {
                let (o, d) = (o[place][i], d[place][i]);
                let shift = t0[i] * d;
                let [lo, hi] = ends(o + shift, UNITS_8 * (o.abs() + shift.abs()) + TINY);
                origin_lo[i] = lo;
                origin_hi[i] = hi;
                let s = d * pace[i];
                let [lo, hi] = ends(s, UNITS_8 * s.abs());
                slope_lo[i] = lo;
                slope_hi[i] = hi;
            }
        }
        for end in [0, 1] {
            for i in 0..R::LANES {
                let t = t[end][i];
                let error = UNITS_8 * ((t.abs() + t0[i].abs()) * along[i]) + TINY;
                range[end][i] = ends((t - t0[i]) * along[i], error)[end];
            }
        }
        let [p, q, r] = &origin;
        let origin = [both(zero, p), both(zero, q), both(zero, r)];
        let [p, q, r] = &slope;
        let slope = [both(zero, p), both(zero, q), both(zero, r)];
        let range = both(zero, &range);
        let ranges = bounds.ranges::<R::Scalar>();
        let mut bounds_in_lanes = [[zero; 2]; 3];
        for (ends, axis) in bounds_in_lanes.iter_mut().zip(axes) {
            *ends = [zero.splat(ranges[axis][0]), zero.splat(ranges[axis][1])];
        }
        Self {
            cutting: PhantomData,
            forward: matches!(cut, Cut::Slabs(Axis { forward: true, .. })),
            length,
            end: R::Scalar::enclose_range(length, length)[1],
            start: zero.splat(R::Scalar::from_f64(start)),
            lengths: range[1],
            axes,
            origin,
            slope,
            range,
            bounds: bounds_in_lanes,
        }
    }

    /// 0 in every lane.
    #[inline(always)]
    pub(super) fn zero(&self) -> R {
        self.start.splat(R::Scalar::from_f64(0.0))
    }

    /// The boundary after `index` pieces of the given depth: the same place gives the same boundary at
    /// every depth, and boundaries increase.
    #[inline(always)]
    pub(super) fn boundary(&self, index: u64, depth: u32) -> Boundary<R> {
        // The fraction is exact.
        let fraction = index as f64 * f64::from_bits(u64::from(1023 - depth) << 52);
        self.at(if C::SLABS {
            let exact = fraction * self.length;
            let q = if exact < self.length { R::Scalar::from_f64(exact) } else { self.end };
            self.start.splat(q)
        } else {
            // Rounded to nearest: any number will do, if all pieces take the same.
            self.start.splat(R::Scalar::from_f64(fraction)) * self.lengths
        })
    }

    /// Where the rays are at q. Spelled out: a closure for `array::map` would lose the instruction set.
    #[inline(always)]
    pub(super) fn at(&self, q: R) -> Boundary<R> {
        let first = if !C::SLABS {
            self.coordinate(q, 0)
        } else if self.forward {
            let down = self.start.add_down(q);
            [down, if R::OUTWARD { self.start.add_up(q) } else { down }]
        } else {
            let down = self.start.sub_down(q);
            [down, if R::OUTWARD { self.start.sub_up(q) } else { down }]
        };
        Boundary { q, ends: [first, self.coordinate(q, 1), self.coordinate(q, 2)] }
    }

    #[inline(always)]
    fn coordinate(&self, q: R, place: usize) -> [R; 2] {
        let ([lo, hi], [down, up]) = (self.origin[place], self.slope[place]);
        let low = lo.add_down(q.mul_down(down));
        // Rounded to nearest, both ends are the same.
        [low, if R::OUTWARD { hi.add_up(q.mul_up(up)) } else { low }]
    }

    /// Lets the rays of a mask start at `q`, rounded down.
    #[inline(always)]
    pub(super) fn skip(&mut self, mask: u64, q: f64) {
        let [down, _] = R::Scalar::enclose_range(q, q);
        let start = self.start.splat(down).max(self.range[0]);
        self.range[0] = start.select(mask, start, self.range[0]);
    }

    /// The rays whose range meets the slab between two boundaries.
    #[inline(always)]
    pub(super) fn meets(&self, near: &Boundary<R>, far: &Boundary<R>) -> u64 {
        self.range[0].le(far.q) & near.q.le(self.range[1])
    }

    /// The rays whose range does not end before a boundary.
    #[inline(always)]
    pub(super) fn goes_on_at(&self, boundary: &Boundary<R>) -> u64 {
        boundary.q.le(self.range[1])
    }

    /// Gives a tape the boxes of the rays between two boundaries, cut with the domain's box; where a
    /// ray does not meet the piece, the ends may be in the wrong order.
    #[inline(always)]
    pub(super) fn bind<F: Flavor>(
        &self,
        evaluator: &mut Evaluator<'_, Interval<R, F>>,
        near: &Boundary<R>,
        far: &Boundary<R>,
    ) {
        let [k, u, v] = self.axes;
        evaluator.bind(k, self.cut(near, far, 0));
        evaluator.bind(u, self.cut(near, far, 1));
        evaluator.bind(v, self.cut(near, far, 2));
    }

    /// Gives a slope's tape the directions of the rays, in q.
    #[inline(always)]
    pub(super) fn bind_direction<F: Flavor>(&self, evaluator: &mut Evaluator<'_, Interval<R, F>>) {
        for (axis, [lo, hi]) in self.axes.into_iter().zip(self.slope) {
            evaluator.bind(3 + axis, Interval::new(lo, hi));
        }
    }

    /// Gives a tape the points of the rays at a boundary, to nearest.
    #[inline(always)]
    pub(super) fn bind_point(&self, evaluator: &mut Evaluator<'_, Plain<R>>, at: &Boundary<R>) {
        let half = self.start.splat(R::Scalar::from_f64(0.5));
        for (axis, [lo, hi]) in self.axes.into_iter().zip(at.ends) {
            evaluator.bind(axis, Plain(half * (lo + hi)));
        }
    }

    /// The rays that are surely in the domain's box at a boundary.
    #[inline(always)]
    pub(super) fn is_inside(&self, at: &Boundary<R>) -> u64 {
        let mut inside = u64::MAX;
        for ([lo, hi], [min, max]) in at.ends.into_iter().zip(self.bounds) {
            inside &= min.le(lo) & hi.le(max);
        }
        inside
    }

    #[inline(always)]
    fn cut<F: Flavor>(
        &self,
        near: &Boundary<R>,
        far: &Boundary<R>,
        place: usize,
    ) -> Interval<R, F> {
        let ([near_lo, near_hi], [far_lo, far_hi]) = (near.ends[place], far.ends[place]);
        let [lo, hi] = self.bounds[place];
        Interval::new(near_lo.min(far_lo).max(lo), near_hi.max(far_hi).min(hi))
    }
}

#[inline(always)]
fn both<R: Packet>(zero: R, x: &[[R::Scalar; SIZE]; 2]) -> [R; 2] {
    [lanes(zero, &x[0]), lanes(zero, &x[1])]
}

#[inline(always)]
fn lanes<R: Packet>(zero: R, x: &[R::Scalar; SIZE]) -> R {
    zero.from_fn(
        #[inline(always)]
        |i| x[i],
    )
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use num_rational::BigRational;
    use num_traits::Signed;
    use proptest::prelude::*;
    use zeroset_raycast::{Domain, Ray};

    use super::super::bundle::Bundle;
    use super::super::clock::Clock;
    use super::super::cut::{Rays, Slabs};
    use super::super::march::Marcher;
    use super::*;

    type Q = BigRational;

    fn exact(x: f64) -> Q {
        Q::from_float(x).expect("finite")
    }

    /// Is an exact number between two ends?
    fn is_between(x: &Q, lo: f64, hi: f64) -> bool {
        let above = lo == f64::NEG_INFINITY || (lo.is_finite() && exact(lo) <= *x);
        let below = hi == f64::INFINITY || (hi.is_finite() && *x <= exact(hi));
        above && below
    }

    /// Coordinates of every size, many of them zero or powers of two.
    fn coordinate() -> impl Strategy<Value = f32> {
        let sized = (-1.0_f32..1.0, -40_i32..40).prop_map(|(m, e)| m * 2.0_f32.powi(e));
        let power = (any::<bool>(), -140_i32..100)
            .prop_map(|(minus, e)| (if minus { -1.0 } else { 1.0 }) * 2.0_f32.powi(e));
        prop_oneof![4 => -4.0_f32..4.0, 3 => sized, 1 => power, 1 => Just(0.0), 1 => Just(-0.0)]
    }

    fn ray() -> impl Strategy<Value = Ray> {
        let vector = || [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from);
        (vector(), vector())
            .prop_map(|(origin, direction)| Ray { origin, direction })
            .prop_filter("a ray", |ray| ray.is_valid())
    }

    /// The ray turned so that it meets the domain, mostly off its centre.
    fn towards(domain: &Domain, ray: Ray) -> Ray {
        let side = (domain.max - domain.min).as_vec3();
        let target = domain.centre().as_vec3() + 0.4 * side * ray.direction.normalize_or_zero();
        let turned = Ray { direction: target - ray.origin, ..ray };
        if turned.is_valid() { turned } else { ray }
    }

    fn domain() -> impl Strategy<Value = Domain> {
        (-3_i32..20, [-1.0_f64..1.0, -1.0..1.0, -1.0..1.0], [0.01_f64..2.0, 0.01..2.0, 0.01..2.0])
            .prop_map(|(e, min, size)| {
                let (min, size) = (DVec3::from(min), DVec3::from(size));
                Domain::new(min * 2.0_f64.powi(e), (min + size) * 2.0_f64.powi(e)).expect("a box")
            })
    }

    /// Every point of the ray between two boundaries, and no more than its time there, is enclosed.
    fn check<S: Packet<Scalar = S> + Scalar, C: Cutting>(
        ray: Ray,
        domain: &Domain,
        cut: Cut,
        depth: u32,
        place: f64,
    ) -> Result<(), TestCaseError> {
        let axis = Axis::of(ray);
        let bounds = Bounds::new::<S>(domain);
        let range = match cut {
            Cut::Slabs(_) => [0.0, 1e30],
            Cut::Rays => match domain.clip(ray, [0.0, f64::INFINITY]) {
                Some(clip) => clip.outer,
                None => return Ok(()),
            },
        };
        let mut bundle = Bundle::new();
        bundle.clip(&[ray], 0, domain, range);
        bundle.range = [[range[0]; SIZE], [range[1]; SIZE]];
        let packet = bundle.packets(1).next().expect("it has a ray");
        let marcher = packet.marcher(0);
        let zero = S::from_f64(0.0);
        let lattice = Lattice::<S, C>::new(zero, cut, &bounds, packet);
        let index = (place * 2.0_f64.powi(depth as i32)) as u64;
        let (near, far) = (lattice.boundary(index, depth), lattice.boundary(index + 1, depth));
        // The same boundary at the next depth.
        let again = lattice.boundary(2 * index, depth + 1);
        prop_assert_eq!(near.q.to_f64(), again.q.to_f64());
        prop_assert!(near.q.to_f64() <= far.q.to_f64());
        let clock = Clock::new(&marcher, cut, &bounds);
        let [o, d] = [ray.origin, ray.direction].map(|v| v.to_array().map(|x| exact(x.into())));
        // Where q = 0.
        let start = match cut {
            Cut::Slabs(axis) => (exact(bounds.start(axis)) - &o[axis.k]) / &d[axis.k],
            Cut::Rays => exact(range[0]),
        };
        let speed = d[axis.k].abs();
        let [lo, hi] = clock.range([near.q.to_f64(), far.q.to_f64()]);
        for boundary in [near, far] {
            let t = &start + exact(boundary.q.to_f64()) / &speed;
            prop_assert!(is_between(&t, lo, hi), "{lo} {hi}");
            for (ends, axis) in boundary.ends.iter().zip(lattice.axes) {
                let x = &o[axis] + &d[axis] * &t;
                let [lo, hi] = ends.map(Scalar::to_f64);
                prop_assert!(is_between(&x, lo, hi), "axis {axis}: {lo} {hi}");
            }
        }
        // Where the marcher's range starts and ends.
        let q = |t: f64| (exact(t) - &start) * &speed;
        prop_assert!(is_between(&q(range[0]), lattice.range[0].to_f64(), f64::INFINITY));
        prop_assert!(is_between(&q(range[1]), f64::NEG_INFINITY, lattice.range[1].to_f64()));
        if cut == Cut::Rays {
            let last = lattice.boundary(1 << depth, depth).q.to_f64();
            prop_assert!(is_between(&q(range[1]), f64::NEG_INFINITY, last));
        }
        let t = 1e3 * place;
        let told = clock.q(t);
        prop_assert!(told == f64::MIN || is_between(&q(t), told, f64::INFINITY), "{told}");
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn boxes_hold_the_ray(
            ray in ray(),
            domain in domain(),
            depth in 0_u32..30,
            place in 0.0_f64..1.0,
            aimed in any::<bool>(),
        ) {
            // Few rays from anywhere meet the domain.
            let ray = if aimed { towards(&domain, ray) } else { ray };
            let slabs = Cut::Slabs(Axis::of(ray));
            check::<f32, Slabs>(ray, &domain, slabs, depth, place)?;
            check::<f64, Slabs>(ray, &domain, slabs, depth, place)?;
            check::<f32, Rays>(ray, &domain, Cut::Rays, depth, place)?;
            check::<f64, Rays>(ray, &domain, Cut::Rays, depth, place)?;
        }
    }

    #[test]
    fn clocks_that_overflow_skip_nothing() {
        let axis = Axis { k: 0, forward: true };
        let ray = Ray::new(Vec3::ZERO, Vec3::new(1e-45, 0.0, 0.0));
        let range = [1e300, f64::MAX];
        let marcher = Marcher { ray: 0, line: ray, range };
        let far = Domain::new(DVec3::splat(1e300), DVec3::splat(2e300)).expect("a box");
        let bounds = Bounds::new::<f64>(&far);
        for cut in [Cut::Slabs(axis), Cut::Rays] {
            let clock = Clock::new(&marcher, cut, &bounds);
            assert_eq!(clock.q(f64::INFINITY), f64::MAX);
            assert!(clock.q(1.0) < 0.0);
            let [lo, hi] = clock.range([0.0, 1e300]);
            assert!(!(lo > 1e300 && hi < f64::INFINITY), "{cut:?}: {lo} {hi}");
        }
    }
}
