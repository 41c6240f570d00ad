//! The geometry of a march: slabs of the domain along a common axis.
//!
//! A packet of rays with the same dominant axis K and the same sign along it marches in lockstep
//! through slabs `q_i <= |K - K_start| <= q_{i+1}`, dyadic fractions of the domain's extent. The
//! boundaries q are exact numbers that neighbouring slabs and all rays share, so that nothing falls
//! between two slabs. At a boundary, another axis U of a ray is at `u0 + q s` with
//! `s = d_U / |d_K|`: one product and one sum, whatever the depth, so that a ray's boxes do not
//! depend on the slabs that its neighbours made the packet visit.

use zeroset_ia::{Interval, Packet, Real, Scalar, Set};
use zeroset_raycast::{Domain, Ray};

type I = Interval<f64, Set>;

/// A common axis and direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Axis {
    /// K: 0, 1 or 2.
    pub k: usize,
    /// Does K increase along the rays?
    pub forward: bool,
}

impl Axis {
    /// The dominant axis of a direction and its sign.
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

    /// The two other axes.
    pub(super) fn others(self) -> [usize; 2] {
        [(self.k + 1) % 3, (self.k + 2) % 3]
    }
}

/// The domain's box in the scalar type of a march, rounded outward.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds<S>(pub [[S; 2]; 3]);

impl<S: Scalar> Bounds<S> {
    pub(super) fn new(domain: &Domain) -> Self {
        Self([0, 1, 2].map(|axis| S::enclose_range(domain.min[axis], domain.max[axis])))
    }

    /// How far a march along the axis goes.
    pub(super) fn length(&self, axis: Axis) -> f64 {
        self.extent(axis)[1]
    }

    /// Four units in the last place of the largest coordinate.
    pub(super) fn resolution(&self) -> f64 {
        let largest = self.0.iter().flatten().map(|x| x.to_f64().abs()).fold(0.0, f64::max);
        let epsilon = if size_of::<S>() == 4 { f64::from(f32::EPSILON) } else { f64::EPSILON };
        4.0 * epsilon * largest
    }

    /// Where the march starts along K, and how far it goes.
    fn extent(&self, axis: Axis) -> [f64; 2] {
        let [lo, hi] = self.0[axis.k].map(S::to_f64);
        let start = if axis.forward { lo } else { hi };
        [start, (I::point(hi) - I::point(lo)).hi]
    }
}

/// One ray's march, in double precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Track {
    /// U and V at q = 0.
    pub origin: [[f64; 2]; 2],
    /// Their slopes in q.
    pub slope: [[f64; 2]; 2],
    /// The range of q in which roots count.
    pub range: [f64; 2],
    /// t at q = 0.
    start: I,
    /// t a unit of q.
    pub pace: [f64; 2],
}

impl Track {
    /// The march of a ray whose roots count for t in `range`.
    pub(super) fn new<S: Scalar>(
        ray: Ray,
        range: [f64; 2],
        axis: Axis,
        bounds: &Bounds<S>,
    ) -> Self {
        let point = |x: f64| I::point(x);
        let [start, _] = bounds.extent(axis);
        let o = ray.origin.as_dvec3();
        let d = ray.direction.as_dvec3();
        let speed = point(d[axis.k].abs());
        // t = (K - o_K) / d_K at the start.
        let t0 = (point(start) - point(o[axis.k])) / point(d[axis.k]);
        let others = axis.others();
        let origin = others.map(|u| (point(o[u]) + t0 * point(d[u])).bounds());
        let slope = others.map(|u| (point(d[u]) / speed).bounds());
        let q = |t: f64| (point(t) - t0) * speed;
        let range = [q(range[0]).lo, q(range[1]).hi];
        let pace = (point(1.0) / speed).bounds();
        Self { origin, slope, range, start: t0, pace }
    }

    /// The q at t, rounded down.
    pub(super) fn q(&self, t: f64) -> f64 {
        ((I::point(t) - self.start) / I::new(self.pace[0], self.pace[1])).lo
    }

    /// The range of t between two boundaries, rounded outward.
    pub(super) fn t(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        let pace = I::new(self.pace[0], self.pace[1]);
        let at = |q: f64| self.start + I::point(q) * pace;
        [at(from).lo, at(to).hi]
    }
}

/// Boundaries for the rays of a packet, in lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice<R: Real> {
    axis: Axis,
    bounds: Bounds<R::Scalar>,
    length: f64,
    start: R::Scalar,
    origin: [[R; 2]; 2],
    slope: [[R; 2]; 2],
    /// The range of q in each lane.
    range: [R; 2],
}

/// Where the rays of a packet cross a boundary.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boundary<R: Real> {
    /// Its distance from the start along K: exact.
    pub q: R::Scalar,
    k: [R::Scalar; 2],
    u: [[R; 2]; 2],
}

impl<R: Packet> Lattice<R> {
    #[inline(always)]
    pub(super) fn new(
        zero: R,
        axis: Axis,
        bounds: Bounds<R::Scalar>,
        track: impl Fn(usize) -> Track,
    ) -> Self {
        let lanes = |f: &dyn Fn(&Track) -> [f64; 2]| {
            [0, 1].map(|end| {
                zero.from_fn(|i| {
                    let [lo, hi] = f(&track(i));
                    R::Scalar::enclose_range(lo, hi)[end]
                })
            })
        };
        let [start, length] = bounds.extent(axis);
        Self {
            axis,
            bounds,
            length,
            start: R::Scalar::from_f64(start),
            origin: [lanes(&|t| t.origin[0]), lanes(&|t| t.origin[1])],
            slope: [lanes(&|t| t.slope[0]), lanes(&|t| t.slope[1])],
            range: lanes(&|t| t.range),
        }
    }

    /// The boundary after `index` of the `2^depth` slabs. The same fraction gives the same boundary
    /// at every depth, and boundaries increase.
    #[inline(always)]
    pub(super) fn boundary(&self, index: u64, depth: u32) -> Boundary<R> {
        let fraction = index as f64 / (1_u64 << depth) as f64;
        // The far end is rounded up so that the slabs reach the end of the box.
        let [near, far] = R::Scalar::enclose_range(self.length * fraction, self.length);
        let q = if fraction < 1.0 { near } else { far };
        let k = if self.axis.forward {
            [self.start.add_down(q), self.start.add_up(q)]
        } else {
            [self.start.sub_down(q), self.start.sub_up(q)]
        };
        let lanes = self.range[0].splat(q);
        Boundary {
            q,
            k,
            u: [0, 1].map(
                #[inline(always)]
                |i| {
                    let [o, s] = [self.origin[i], self.slope[i]];
                    [o[0].add_down(lanes.mul_down(s[0])), o[1].add_up(lanes.mul_up(s[1]))]
                },
            ),
        }
    }

    /// Lets the rays of a mask start at `q`, rounded down.
    #[inline(always)]
    pub(super) fn skip(&mut self, mask: u64, q: f64) {
        let [down, _] = R::Scalar::enclose_range(q, q);
        let start = self.range[0].splat(down).max(self.range[0]);
        self.range[0] = self.range[0].select(mask, start, self.range[0]);
    }

    /// The rays whose range meets the slab between two boundaries.
    #[inline(always)]
    pub(super) fn meets(&self, near: &Boundary<R>, far: &Boundary<R>) -> u64 {
        let near = self.range[0].splat(near.q);
        let far = self.range[0].splat(far.q);
        self.range[0].le(far) & near.le(self.range[1])
    }

    /// X, Y and Z of the rays between two boundaries, cut with the domain's box; where a ray does not
    /// meet the slab, the ends may be in the wrong order.
    #[inline(always)]
    pub(super) fn boxes(&self, near: &Boundary<R>, far: &Boundary<R>) -> [[R; 2]; 3] {
        let [k_lo, k_hi] = self.bounds.0[self.axis.k];
        let lo = near.k[0].min(far.k[0]).max(k_lo);
        let hi = near.k[1].max(far.k[1]).min(k_hi);
        let zero = self.range[0];
        let mut boxes = [[zero.splat(lo), zero.splat(hi)]; 3];
        for (i, axis) in self.axis.others().into_iter().enumerate() {
            let [u_lo, u_hi] = self.bounds.0[axis];
            let lo = near.u[i][0].min(far.u[i][0]).max(zero.splat(u_lo));
            let hi = near.u[i][1].max(far.u[i][1]).min(zero.splat(u_hi));
            boxes[axis] = [lo, hi];
        }
        boxes
    }
}
