//! The geometry of a march: slabs of the domain along a common axis.
//!
//! A packet of rays with the same dominant axis K and the same sign along it marches in lockstep
//! through slabs `q_i <= |K - K_start| <= q_{i+1}`, dyadic fractions of the domain's extent. The
//! boundaries q are exact numbers that neighbouring slabs and all rays share, so that nothing falls
//! between two slabs. At a boundary, another axis U of a ray is at `u0 + q s` with
//! `s = d_U / |d_K|`: one product and one sum, whatever the depth, so that a ray's boxes do not
//! depend on the slabs that its neighbours made the packet visit.

use zeroset_ia::interval::Flavor;
use zeroset_ia::{Interval, Packet, Real, Scalar, Set};
use zeroset_raycast::{Domain, Ray};

use super::march::Marcher;

/// A common axis and direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Axis {
    /// K: 0, 1 or 2.
    pub k: usize,
    /// Does K increase along the rays?
    pub forward: bool,
}

impl Axis {
    pub(super) const COUNT: usize = 6;

    /// The dominant axis of a direction and its sign.
    #[inline(always)]
    pub(super) fn of(ray: Ray) -> Self {
        let d = ray.direction.abs();
        let k = if d.x >= d.y && d.x >= d.z {
            0
        } else if d.y >= d.z {
            1
        } else {
            2
        };
        Self { k, forward: ray.direction[k] > 0.0 }
    }

    /// K, and U and V in cyclic order.
    pub(super) fn all(self) -> [usize; 3] {
        [self.k, (self.k + 1) % 3, (self.k + 2) % 3]
    }
}

/// The domain's box, rounded outward to what a march's scalar type can represent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    ends: [[f64; 2]; 3],
    /// Depths at which slabs are about as thin as coordinates are rounded, by axis.
    finest: [u32; 3],
}

impl Bounds {
    pub(super) fn new<S: Scalar>(domain: &Domain) -> Self {
        let ends = [0, 1, 2]
            .map(|axis| S::enclose_range(domain.min[axis], domain.max[axis]).map(S::to_f64));
        let largest = ends.iter().flatten().map(|x| x.abs()).fold(0.0, f64::max);
        let epsilon = if size_of::<S>() == 4 { f64::from(f32::EPSILON) } else { f64::EPSILON };
        let finest = ends.map(|[lo, hi]| ((hi - lo) / (4.0 * epsilon * largest)).log2() as u32);
        Self { ends, finest }
    }

    /// The box.
    pub(super) fn ranges<S: Scalar>(&self) -> [[S; 2]; 3] {
        self.ends.map(|ends| ends.map(S::from_f64))
    }

    /// Where a march along an axis starts.
    pub(super) fn start(&self, axis: Axis) -> f64 {
        self.ends[axis.k][if axis.forward { 0 } else { 1 }]
    }

    /// The depth beyond which slabs gain nothing.
    pub(super) fn finest(&self, k: usize) -> u32 {
        self.finest[k]
    }

    /// How far it goes.
    pub(super) fn length(&self, axis: Axis) -> f64 {
        let [lo, hi] = self.ends[axis.k];
        (Interval::<_, Set>::point(hi) - Interval::point(lo)).hi
    }
}

/// The ray parameter along a march: `t = start + q pace`, in double precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    start: f64,
    /// t a unit of q.
    pub pace: f64,
}

impl Clock {
    /// The clock of a ray whose march along K starts at `start`.
    pub(super) fn new(ray: Ray, axis: Axis, start: f64) -> Self {
        let inverse = 1.0 / f64::from(ray.direction[axis.k]);
        Self { start: (start - f64::from(ray.origin[axis.k])) * inverse, pace: inverse.abs() }
    }

    /// A q at most that of `t`: the largest number if t is infinite, the least where it overflows. Four
    /// roundings, of terms at most twice `(|t| + |start|) / pace`: less than 8 units of 2^-53.
    pub(super) fn q(&self, t: f64) -> f64 {
        if t == f64::INFINITY {
            return f64::MAX;
        }
        let inverse = 1.0 / self.pace;
        let error = UNITS_8 * ((t.abs() + self.start.abs()) * inverse) + TINY;
        let q = (t - self.start) * inverse - error;
        if q.is_nan() { f64::MIN } else { q }
    }

    /// The range of t between two boundaries, rounded outward; NaN where it overflows. `start` has
    /// three roundings, `q pace` two, the sum one and the end another: less than 8 units of 2^-53.
    pub(super) fn range(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        let at = |q: f64| {
            let error = UNITS_8 * (self.start.abs() + q * self.pace) + TINY;
            [self.start + q * self.pace - error, self.start + q * self.pace + error]
        };
        [at(from)[0], at(to)[1]]
    }
}

/// 8 units of 2^-53, the largest relative error of a rounding in double precision.
const UNITS_8: f64 = 4.0 * f64::EPSILON;
/// More than the errors of all products that underflow.
const TINY: f64 = f64::from_bits(123 << 52);

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
pub(super) struct Lattice<R: Real> {
    axis: Axis,
    /// How far the march goes, and the last boundary: not before the end of the box.
    length: f64,
    end: R::Scalar,
    start: R,
    /// U and V at q = 0.
    origin: [[R; 2]; 2],
    /// Their slopes in q.
    slope: [[R; 2]; 2],
    /// The range of q in which roots count.
    range: [R; 2],
    /// The box along K, U and V.
    bounds: [[R; 2]; 3],
}

/// Where the rays of a packet cross a boundary.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boundary<R: Real> {
    /// Its distance from the start along K: exact.
    pub q: R::Scalar,
    /// The ends of K, U and V.
    ends: [[R; 2]; 3],
}

impl<R: Packet> Lattice<R> {
    /// The lattice of at most as many rays as there are lanes; other lanes repeat the last one.
    ///
    /// In units of u = 2^-53, the errors are: `t0 = (start - o_K) / d_K`, 3 t0; `u0 = o_U + t0 d_U`,
    /// 4 t0 d_U + u0, and 1 for its ends; `s = d_U / |d_K|`, 2 s and 1; `q = (t - t0) |d_K|`, 3 t0
    /// |d_K| + 2 q and 1. Each is less than 8 times the sum of absolute values below.
    #[inline(always)]
    pub(super) fn new(zero: R, axis: Axis, bounds: &Bounds, packet: &[Marcher]) -> Self {
        let [k, u, v] = axis.all();
        let mut o = [[0.0_f64; 64]; 3];
        let mut d = [[1.0_f64; 64]; 3];
        let mut t = [[0.0_f64; 64]; 2];
        for i in 0..R::LANES {
            let Marcher { line, range, .. } = &packet[i.min(packet.len() - 1)];
            let (origin, direction) = (line.origin.to_array(), line.direction.to_array());
            for (place, axis) in [k, u, v].into_iter().enumerate() {
                o[place][i] = f64::from(origin[axis]);
                d[place][i] = f64::from(direction[axis]);
            }
            t[0][i] = range[0];
            t[1][i] = range[1];
        }
        let start = bounds.start(axis);
        let zeros = [[R::Scalar::from_f64(0.0); 64]; 2];
        let (mut origin, mut slope, mut range) = ([zeros; 2], [zeros; 2], zeros);
        for i in 0..R::LANES {
            let inverse = 1.0 / d[0][i];
            let speed = d[0][i].abs();
            let t0 = (start - o[0][i]) * inverse;
            for place in [0, 1] {
                let (o, d) = (o[place + 1][i], d[place + 1][i]);
                let shift = t0 * d;
                let [lo, hi] = ends(o + shift, UNITS_8 * (o.abs() + shift.abs()) + TINY);
                origin[place][0][i] = lo;
                origin[place][1][i] = hi;
                let s = d * inverse.abs();
                let [lo, hi] = ends(s, UNITS_8 * s.abs());
                slope[place][0][i] = lo;
                slope[place][1][i] = hi;
            }
            for end in [0, 1] {
                let t = t[end][i];
                let error = UNITS_8 * ((t.abs() + t0.abs()) * speed) + TINY;
                range[end][i] = ends((t - t0) * speed, error)[end];
            }
        }
        let [[p, q], [r, s]] = &origin;
        let origin = [[lanes(zero, p), lanes(zero, q)], [lanes(zero, r), lanes(zero, s)]];
        let [[p, q], [r, s]] = &slope;
        let slope = [[lanes(zero, p), lanes(zero, q)], [lanes(zero, r), lanes(zero, s)]];
        let range = [lanes(zero, &range[0]), lanes(zero, &range[1])];
        let ranges = bounds.ranges::<R::Scalar>();
        let mut bounds_in_lanes = [[zero; 2]; 3];
        for (ends, axis) in bounds_in_lanes.iter_mut().zip([k, u, v]) {
            *ends = [zero.splat(ranges[axis][0]), zero.splat(ranges[axis][1])];
        }
        let length = bounds.length(axis);
        Self {
            axis,
            length,
            end: R::Scalar::enclose_range(length, length)[1],
            start: zero.splat(R::Scalar::from_f64(start)),
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

    /// The width of slabs: `length / 2^depth`.
    #[inline(always)]
    pub(super) fn width(&self, depth: u32) -> f64 {
        self.length * f64::from_bits(u64::from(1023 - depth) << 52)
    }

    /// The boundary after `index` slabs of the given width, a dyadic fraction of the length: the same
    /// place gives the same boundary at every depth, and boundaries increase.
    #[inline(always)]
    pub(super) fn boundary(&self, index: u64, width: f64) -> Boundary<R> {
        let exact = index as f64 * width;
        let q = if exact < self.length { R::Scalar::from_f64(exact) } else { self.end };
        let lanes = self.start.splat(q);
        let k = if self.axis.forward {
            [self.start.add_down(lanes), self.start.add_up(lanes)]
        } else {
            [self.start.sub_down(lanes), self.start.sub_up(lanes)]
        };
        // Spelled out: a closure for `array::map` would lose the instruction set.
        let [[u_lo, u_hi], [v_lo, v_hi]] = self.origin;
        let [[r_lo, r_hi], [s_lo, s_hi]] = self.slope;
        let u = [u_lo.add_down(lanes.mul_down(r_lo)), u_hi.add_up(lanes.mul_up(r_hi))];
        let v = [v_lo.add_down(lanes.mul_down(s_lo)), v_hi.add_up(lanes.mul_up(s_hi))];
        Boundary { q, ends: [k, u, v] }
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
        let near = self.start.splat(near.q);
        self.range[0].le(self.start.splat(far.q)) & near.le(self.range[1])
    }

    /// The rays whose range does not end before a boundary.
    #[inline(always)]
    pub(super) fn goes_on_at(&self, boundary: &Boundary<R>) -> u64 {
        self.start.splat(boundary.q).le(self.range[1])
    }

    /// K, U and V of the rays between two boundaries, cut with the domain's box; where a ray does not
    /// meet the slab, the ends may be in the wrong order.
    #[inline(always)]
    pub(super) fn boxes<F: Flavor>(
        &self,
        near: &Boundary<R>,
        far: &Boundary<R>,
    ) -> [Interval<R, F>; 3] {
        [self.cut(near, far, 0), self.cut(near, far, 1), self.cut(near, far, 2)]
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
fn lanes<R: Packet>(zero: R, x: &[R::Scalar; 64]) -> R {
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

    fn domain() -> impl Strategy<Value = Domain> {
        (-3_i32..20, [-1.0_f64..1.0, -1.0..1.0, -1.0..1.0], [0.01_f64..2.0, 0.01..2.0, 0.01..2.0])
            .prop_map(|(e, min, size)| {
                let (min, size) = (DVec3::from(min), DVec3::from(size));
                Domain::new(min * 2.0_f64.powi(e), (min + size) * 2.0_f64.powi(e)).expect("a box")
            })
    }

    /// Every point of the ray between two boundaries, and no more than its time there, is enclosed.
    fn check<S: Packet<Scalar = S> + Scalar>(
        ray: Ray,
        domain: &Domain,
        depth: u32,
        place: f64,
    ) -> Result<(), TestCaseError> {
        let axis = Axis::of(ray);
        let bounds = Bounds::new::<S>(domain);
        let range = [0.0, 1e30];
        let marcher = Marcher { ray: 0, line: ray, range, depth };
        let zero = S::from_f64(0.0);
        let lattice = Lattice::<S>::new(zero, axis, &bounds, &[marcher]);
        let width = lattice.width(depth);
        let index = (place * 2.0_f64.powi(depth as i32)) as u64;
        let (near, far) = (lattice.boundary(index, width), lattice.boundary(index + 1, width));
        // The same boundary at the next depth.
        let again = lattice.boundary(2 * index, lattice.width(depth + 1));
        prop_assert_eq!(near.q.to_f64(), again.q.to_f64());
        prop_assert!(near.q.to_f64() <= far.q.to_f64());
        let clock = Clock::new(ray, axis, bounds.start(axis));
        let [o, d] = [ray.origin, ray.direction].map(|v| v.to_array().map(|x| exact(x.into())));
        let start = exact(bounds.start(axis));
        let at = |k: &Q| (k - &o[axis.k]) / &d[axis.k];
        let [lo, hi] = clock.range([near.q.to_f64(), far.q.to_f64()]);
        for boundary in [near, far] {
            let q = exact(boundary.q.to_f64());
            let t = at(&if axis.forward { &start + &q } else { &start - &q });
            prop_assert!(is_between(&t, lo, hi), "{lo} {hi}");
            for (ends, axis) in boundary.ends.iter().zip(axis.all()) {
                let x = &o[axis] + &d[axis] * &t;
                let [lo, hi] = ends.map(Scalar::to_f64);
                prop_assert!(is_between(&x, lo, hi), "axis {axis}: {lo} {hi}");
            }
        }
        // Where the marcher's range starts and ends.
        let q = |t: f64| (exact(t) - at(&start)) * d[axis.k].abs();
        prop_assert!(is_between(&q(range[0]), lattice.range[0].to_f64(), f64::INFINITY));
        prop_assert!(is_between(&q(range[1]), f64::NEG_INFINITY, lattice.range[1].to_f64()));
        let t = 1e3 * place;
        let told = clock.q(t);
        prop_assert!(told == f64::MIN || is_between(&q(t), told, f64::INFINITY), "{told}");
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn boxes_hold_the_ray(
            ray in ray(), domain in domain(), depth in 0_u32..30, place in 0.0_f64..1.0,
        ) {
            check::<f32>(ray, &domain, depth, place)?;
            check::<f64>(ray, &domain, depth, place)?;
        }
    }

    #[test]
    fn clocks_that_overflow_skip_nothing() {
        let axis = Axis { k: 0, forward: true };
        let ray = Ray::new(Vec3::ZERO, Vec3::new(1e-45, 0.0, 0.0));
        let clock = Clock::new(ray, axis, 1e300);
        assert_eq!(clock.q(f64::INFINITY), f64::MAX);
        assert!(clock.q(1.0) == f64::MIN || clock.q(1.0) == f64::NEG_INFINITY);
        let [lo, hi] = clock.range([0.0, 1.0]);
        assert!(!(lo > 0.0 && hi < f64::INFINITY));
    }
}
