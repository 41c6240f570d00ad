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

/// The part of a ray in a domain, enclosed from outside and from inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip {
    /// Contains every t in the domain.
    pub outer: [f64; 2],
    /// Contains only t in the domain; `None` if no such t is certain.
    pub inner: Option<[f64; 2]>,
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
    pub fn clip(&self, ray: Ray, range: [f64; 2]) -> Option<Clip> {
        type I = Interval<f64, Set>;
        if !(range[0] <= range[1]) {
            return None;
        }
        let mut outer = range;
        let mut inner = range;
        let mut cut = |enter: I, leave: I| {
            outer = [outer[0].max(enter.lo), outer[1].min(leave.hi)];
            inner = [inner[0].max(enter.hi), inner[1].min(leave.lo)];
        };
        for axis in 0..3 {
            let o = I::point(f64::from(ray.origin[axis]));
            let d = f64::from(ray.direction[axis]);
            let (min, max) = (self.min[axis], self.max[axis]);
            if d == 0.0 {
                if !(min <= o.lo && o.lo <= max) {
                    return None;
                }
                continue;
            }
            let at = |bound: f64| (I::point(bound) - o) / I::point(d);
            if d > 0.0 { cut(at(min), at(max)) } else { cut(at(max), at(min)) }
        }
        if let Some(radius) = self.ball {
            // |m + t d|^2 = r^2 with m from the centre to the origin.
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
                return None;
            }
            let certain = discriminant.lo >= 0.0;
            let root = I::new(discriminant.lo.max(0.0), discriminant.hi).unary(Unary::Sqrt);
            cut((-b - root) / a, (-b + root) / a);
            if !certain {
                inner = [1.0, 0.0];
            }
        }
        if !(outer[0] <= outer[1]) {
            return None;
        }
        Some(Clip { outer, inner: (inner[0] <= inner[1]).then_some(inner) })
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
