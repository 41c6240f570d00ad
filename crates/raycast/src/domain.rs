//! Domains: where roots count.

use glam::DVec3;
use zeroset_ia::{Interval, Number, Set, Unary};

use crate::{Error, Ray};

/// A closed box, cut with a closed ball around its centre if `ball` is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// The box's least corner.
    pub min: DVec3,
    /// The box's greatest corner.
    pub max: DVec3,
    /// The ball's radius.
    pub ball: Option<f64>,
}

type I = Interval<f64, Set>;

/// 8, 16 and 32 units of 2^-53, the largest relative error of one rounding.
const UNITS_8: f64 = 8.0 * 0.5 * f64::EPSILON;
const UNITS_16: f64 = 2.0 * UNITS_8;
const UNITS_32: f64 = 4.0 * UNITS_8;

/// Where a line enters a convex set and where it leaves it: ranges of t, never NaN. The line is outside
/// before `enter[0]` and after `leave[1]`, and inside between `enter[1]` and `leave[0]`.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    enter: [f64; 2],
    leave: [f64; 2],
}

impl Crossing {
    const NONE: Self = Self { enter: [f64::INFINITY; 2], leave: [f64::NEG_INFINITY; 2] };

    /// The crossing of `min <= o + t d <= max`. Without branches, so that a loop over lines becomes
    /// vectors.
    ///
    /// `(bound - o) (1/d)` has three roundings, and the ends of its range one more: less than 8 units of
    /// 2^-53, or the smallest normal number where the product underflows.
    #[inline(always)]
    fn new(o: f64, d: f64, min: f64, max: f64) -> Self {
        let inverse = 1.0 / d;
        let (a, b) = ((min - o) * inverse, (max - o) * inverse);
        let (near, far) = (smaller(a, b), larger(a, b));
        let error = |t: f64| t.abs() * UNITS_8 + f64::MIN_POSITIVE;
        let is_known = a.abs() + b.abs() < f64::INFINITY;
        // Where the line runs along the slab, it is inside for ever or never.
        let is_along = d == 0.0;
        let entered = if (min <= o) & (o <= max) { f64::NEG_INFINITY } else { f64::INFINITY };
        let end = |known: f64, unknown: f64, along: f64| {
            let across = if is_known { known } else { unknown };
            if is_along { along } else { across }
        };
        Self {
            enter: [
                end(near - error(near), f64::NEG_INFINITY, entered),
                end(near + error(near), f64::INFINITY, entered),
            ],
            leave: [
                end(far - error(far), f64::NEG_INFINITY, -entered),
                end(far + error(far), f64::INFINITY, -entered),
            ],
        }
    }

    /// Cuts the set with another.
    #[inline(always)]
    fn cut(&mut self, other: Self) {
        let ([from, surely_from], [surely_to, to]) = (self.enter, self.leave);
        self.enter = [larger(from, other.enter[0]), larger(surely_from, other.enter[1])];
        self.leave = [smaller(surely_to, other.leave[0]), smaller(to, other.leave[1])];
    }
}

/// The part of a ray in a domain, enclosed from outside and from inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip {
    /// Contains every t in the domain.
    pub outer: [f64; 2],
    /// Contains only t in the domain; `None` if no such t is certain.
    pub inner: Option<[f64; 2]>,
}

/// The larger of two numbers that are not NaN: one instruction, where `f64::max` takes three.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The smaller of two numbers that are not NaN.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

impl Domain {
    /// The box between two corners.
    ///
    /// # Errors
    /// If it is empty, inverted or not finite.
    pub fn new(min: DVec3, max: DVec3) -> Result<Self, Error> {
        let domain = Self { min, max, ball: None };
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let (lo, hi) = (min[axis], max[axis]);
            if !(lo < hi && lo.is_finite() && hi.is_finite()) {
                return Err(Error::Domain(format!(
                    "the domain's {name} range [{lo}, {hi}] is empty or not finite; \
                     give x0,y0,z0,x1,y1,z1 with x0 < x1, y0 < y1, z0 < z1"
                )));
            }
        }
        Ok(domain)
    }

    /// The domain cut with a ball of that radius around the box's centre.
    ///
    /// # Errors
    /// If the radius is not above 0, or not finite.
    pub fn with_ball(self, radius: f64) -> Result<Self, Error> {
        if radius > 0.0 && radius.is_finite() {
            return Ok(Self { ball: Some(radius), ..self });
        }
        Err(Error::Domain(format!("the domain's ball has radius {radius}; give one above 0")))
    }

    /// The middle of the box.
    pub fn centre(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// The radius of the bounding sphere: half the box's diagonal, or the ball's.
    pub fn radius(&self) -> f64 {
        let half = 0.5 * (self.max - self.min).length();
        self.ball.map_or(half, |r| r.min(half))
    }

    /// The longest side of the box.
    pub fn longest_side(&self) -> f64 {
        (self.max - self.min).max_element()
    }

    /// The part of a valid ray within `range` that lies in the domain; `None` if there is surely none,
    /// as in a range with an end that is NaN.
    #[inline(always)]
    pub fn clip(&self, ray: Ray, range: [f64; 2]) -> Option<Clip> {
        if !(range[0] <= range[1]) {
            return None;
        }
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let mut part = Crossing { enter: [range[0]; 2], leave: [range[1]; 2] };
        part.cut(Crossing::new(o.x, d.x, self.min.x, self.max.x));
        part.cut(Crossing::new(o.y, d.y, self.min.y, self.max.y));
        part.cut(Crossing::new(o.z, d.z, self.min.z, self.max.z));
        if let Some(radius) = self.ball {
            part.cut(self.chord(ray, radius));
        }
        let Crossing { enter: [from, surely_from], leave: [surely_to, to] } = part;
        let inner = [surely_from, surely_to];
        (from <= to)
            .then(|| Clip { outer: [from, to], inner: (inner[0] <= inner[1]).then_some(inner) })
    }

    /// [`Clip::outer`] of each ray, the first end above the last where there is none: as
    /// [`clip`](Self::clip) has it, but in loops that become vectors. Rays are given by the components of
    /// their origins and directions, which are numbers of single precision.
    #[inline(always)]
    pub fn outer<const N: usize>(
        &self,
        origin: &[[f64; N]; 3],
        direction: &[[f64; N]; 3],
        range: [f64; 2],
    ) -> [[f64; N]; 2] {
        let is_range = range[0] <= range[1];
        let [from, to] = if is_range { range } else { [f64::INFINITY, f64::NEG_INFINITY] };
        let (mut from, mut to) = ([from; N], [to; N]);
        for axis in 0..3 {
            let (o, d, min, max) =
                (&origin[axis], &direction[axis], self.min[axis], self.max[axis]);
            for i in 0..N {
                let Crossing { enter, leave } = Crossing::new(o[i], d[i], min, max);
                from[i] = larger(from[i], enter[0]);
                to[i] = smaller(to[i], leave[1]);
            }
        }
        if let Some(radius) = self.ball {
            for i in 0..N {
                let [o, d] = [origin, direction].map(|v| DVec3::new(v[0][i], v[1][i], v[2][i]));
                debug_assert!(o.as_vec3().as_dvec3() == o && d.as_vec3().as_dvec3() == d);
                let Crossing { enter, leave } =
                    self.chord(Ray::new(o.as_vec3(), d.as_vec3()), radius);
                from[i] = larger(from[i], enter[0]);
                to[i] = smaller(to[i], leave[1]);
            }
        }
        [from, to]
    }

    /// Where a ray crosses the ball.
    #[inline(always)]
    fn chord(&self, ray: Ray, radius: f64) -> Crossing {
        self.chord_by_floats(ray, radius).unwrap_or_else(|| self.chord_by_intervals(ray, radius))
    }

    /// The roots of `|m + t d|^2 = r^2`, with m from the centre to the origin, in plain arithmetic
    /// with bounds for its errors; `None` where something may overflow or underflow.
    ///
    /// With u = 2^-53, w = |o| + (|min| + |max|)/2 >= |m|, p = sum w |d| and q = a (w^2 + r^2): m is
    /// off by 2.1 u w, so `b = m d` by 5.1 u p and `|m|^2 - r^2` by 8.2 u (w^2 + r^2). As `b^2 <= p^2
    /// <= q`, the discriminant `b^2 - a (|m|^2 - r^2)` is off by at most 25 u q. For the quotients by
    /// a the errors add up to less than 12 u (p + root) / a.
    #[inline(always)]
    fn chord_by_floats(&self, ray: Ray, radius: f64) -> Option<Crossing> {
        let [mut a, mut b, mut p, mut mm, mut ww] = [0.0_f64; 5];
        for axis in 0..3 {
            let (o, d) = (f64::from(ray.origin[axis]), f64::from(ray.direction[axis]));
            let (min, max) = (self.min[axis], self.max[axis]);
            let m = o - 0.5 * (min + max);
            let w = o.abs() + 0.5 * (min.abs() + max.abs());
            a += d * d;
            b += m * d;
            p += w * d.abs();
            mm += m * m;
            ww += w * w;
        }
        let scale = ww + radius * radius;
        if !(1e-200 < scale && scale < 1e200) {
            return None;
        }
        let discriminant = b * b - a * (mm - radius * radius);
        let error = UNITS_32 * (a * scale);
        if discriminant < -error {
            return Some(Crossing::NONE);
        }
        let most = (discriminant + error).max(0.0).sqrt();
        let slack = UNITS_16 * (p + most) / a;
        let (from, to) = ((-b - most) / a - slack, (-b + most) / a + slack);
        let surely = if discriminant < error {
            [f64::INFINITY, f64::NEG_INFINITY]
        } else {
            let least = (discriminant - error).sqrt();
            [(-b - least) / a + slack, (-b + least) / a - slack]
        };
        Some(Crossing { enter: [from, surely[0]], leave: [surely[1], to] })
    }

    /// The same by intervals: slow, but without any condition.
    #[cold]
    fn chord_by_intervals(&self, ray: Ray, radius: f64) -> Crossing {
        let mut squares = [I::point(0.0); 3];
        for axis in 0..3 {
            let centre = (I::point(self.min[axis]) + I::point(self.max[axis])) / I::point(2.0);
            let m = I::point(f64::from(ray.origin[axis])) - centre;
            let d = I::point(f64::from(ray.direction[axis]));
            squares[0] = squares[0] + d.sqr();
            squares[1] = squares[1] + m * d;
            squares[2] = squares[2] + m.sqr();
        }
        let [a, b, mm] = squares;
        let discriminant = b.sqr() - a * (mm - I::point(radius).sqr());
        if discriminant.hi < 0.0 {
            return Crossing::NONE;
        }
        let root = I::new(discriminant.lo.max(0.0), discriminant.hi).unary(Unary::Sqrt);
        let (enter, leave) = ((-b - root) / a, (-b + root) / a);
        let surely = if discriminant.lo >= 0.0 {
            [enter.hi, leave.lo]
        } else {
            [f64::INFINITY, f64::NEG_INFINITY]
        };
        // What overflowed tells nothing.
        let known = |x: f64, unknown: f64| if x.is_nan() { unknown } else { x };
        Crossing {
            enter: [known(enter.lo, f64::NEG_INFINITY), known(surely[0], f64::INFINITY)],
            leave: [known(surely[1], f64::NEG_INFINITY), known(leave.hi, f64::INFINITY)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_domain_is_refused() {
        let (low, high) = (DVec3::new(-1.0, -2.0, -3.0), DVec3::new(1.0, 2.0, 3.0));
        let domain = Domain::new(low, high).unwrap();
        for bad in [-2.0, -3.0, f64::NAN, f64::INFINITY] {
            let error = Domain::new(low, DVec3 { y: bad, ..high }).unwrap_err().to_string();
            assert!(error.contains(&format!("y range [-2, {bad}]")), "{error}");
        }
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(domain.with_ball(bad).unwrap_err().to_string().contains(&bad.to_string()));
        }
    }

    #[test]
    fn sizes() {
        let domain = Domain::new(DVec3::new(-1.0, 0.0, 1.0), DVec3::new(1.0, 1.0, 3.0)).unwrap();
        assert_eq!(domain.centre(), DVec3::new(0.0, 0.5, 2.0));
        assert_eq!(domain.radius(), 1.5);
        assert_eq!(domain.longest_side(), 2.0);
        assert_eq!(domain.with_ball(1.0).unwrap().radius(), 1.0);
        assert_eq!(domain.with_ball(2.0).unwrap().radius(), 1.5);
    }
}
