//! Quadrics: the zero sets of polynomials of degree two.

use glam::{DAffine3, DMat3, DMat4, DVec3, DVec4};

/// A quadric f(x) = x'A x + 2 b'x + c, with A symmetric: \[stoll2006\] Eq. 2. The outside is where f > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadric {
    /// A: the second derivatives, halved.
    pub a: DMat3,
    /// b: the first derivatives at the origin, halved.
    pub b: DVec3,
    /// c: the value at the origin.
    pub c: f64,
}

/// The ten coefficients of a quadric, each with its monomial's name.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "the names say it")]
pub struct Coefficients {
    pub constant: f64,
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub xy: f64,
    pub yz: f64,
    pub zx: f64,
    pub xx: f64,
    pub yy: f64,
    pub zz: f64,
}

/// A height z = f(x, y) of degree two: the coefficients of \[stoll2006\] Section 4.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "the names say it")]
pub struct Graph {
    pub constant: f64,
    pub x: f64,
    pub y: f64,
    pub xx: f64,
    pub xy: f64,
    pub yy: f64,
}

impl Quadric {
    /// f(x), rounded.
    pub fn value(&self, x: DVec3) -> f64 {
        x.dot(self.a * x + 2.0 * self.b) + self.c
    }

    /// Half the gradient: A x + b, Eq. 11.
    pub fn half_gradient(&self, x: DVec3) -> DVec3 {
        self.a * x + self.b
    }

    /// Are all numbers finite?
    pub fn is_finite(&self) -> bool {
        self.a.is_finite() && self.b.is_finite() && self.c.is_finite()
    }

    /// The same zeros with inside and outside swapped.
    #[must_use]
    pub fn inverted(&self) -> Self {
        self.scaled(-1.0)
    }

    /// s f.
    #[must_use]
    pub fn scaled(&self, s: f64) -> Self {
        Self { a: s * self.a, b: s * self.b, c: s * self.c }
    }

    /// The same surface in coordinates y = x - origin: Eq. 9.
    #[must_use]
    pub fn about(&self, origin: DVec3) -> Self {
        let Self { a, b, c } = *self;
        let ao = a * origin;
        Self { a, b: b + ao, c: c + origin.dot(ao + 2.0 * b) }
    }

    /// The surface mapped by p = M p' + t, which must have an inverse: Eq. 23 to 25.
    #[must_use]
    pub fn mapped(&self, map: DAffine3) -> Self {
        let inverse = map.matrix3.inverse();
        let transposed = inverse.transpose();
        let moved =
            Self { a: symmetric(transposed * self.a * inverse), b: transposed * self.b, c: self.c };
        moved.about(-map.translation)
    }
}

/// The symmetric part: rounding makes products of matrices lose their symmetry.
fn symmetric(m: DMat3) -> DMat3 {
    0.5 * (m + m.transpose())
}

impl From<Coefficients> for Quadric {
    /// Eq. 3, where k_200 has lost an x.
    fn from(k: Coefficients) -> Self {
        Self {
            a: DMat3::from_cols(
                DVec3::new(k.xx, 0.5 * k.xy, 0.5 * k.zx),
                DVec3::new(0.5 * k.xy, k.yy, 0.5 * k.yz),
                DVec3::new(0.5 * k.zx, 0.5 * k.yz, k.zz),
            ),
            b: 0.5 * DVec3::new(k.x, k.y, k.z),
            c: k.constant,
        }
    }
}

impl From<Quadric> for Coefficients {
    fn from(q: Quadric) -> Self {
        let [x, y, z] = [q.a.x_axis, q.a.y_axis, q.a.z_axis];
        Self {
            constant: q.c,
            x: 2.0 * q.b.x,
            y: 2.0 * q.b.y,
            z: 2.0 * q.b.z,
            xy: 2.0 * x.y,
            yz: 2.0 * y.z,
            zx: 2.0 * z.x,
            xx: x.x,
            yy: y.y,
            zz: z.z,
        }
    }
}

impl From<DMat4> for Quadric {
    /// From the symmetric matrix Q of x'Q x with x = (x, y, z, 1): Eq. 4.
    fn from(q: DMat4) -> Self {
        Self { a: DMat3::from_mat4(q), b: q.w_axis.truncate(), c: q.w_axis.w }
    }
}

impl From<Quadric> for DMat4 {
    fn from(q: Quadric) -> Self {
        let column = |axis: DVec3, b: f64| axis.extend(b);
        Self::from_cols(
            column(q.a.x_axis, q.b.x),
            column(q.a.y_axis, q.b.y),
            column(q.a.z_axis, q.b.z),
            DVec4::new(q.b.x, q.b.y, q.b.z, q.c),
        )
    }
}

impl From<Graph> for Quadric {
    /// z - f(x, y): the outside is above.
    fn from(g: Graph) -> Self {
        Coefficients {
            constant: -g.constant,
            x: -g.x,
            y: -g.y,
            z: 1.0,
            xx: -g.xx,
            xy: -g.xy,
            yy: -g.yy,
            ..Coefficients::default()
        }
        .into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const K: Coefficients = Coefficients {
        constant: 3.0,
        x: -2.0,
        y: 5.0,
        z: 0.5,
        xy: 7.0,
        yz: -1.0,
        zx: 4.0,
        xx: 1.0,
        yy: -6.0,
        zz: 2.0,
    };

    fn points() -> impl Iterator<Item = DVec3> {
        let ends = [-1.5, 0.0, 0.75, 2.0];
        ends.into_iter().flat_map(move |x| {
            ends.into_iter().flat_map(move |y| ends.into_iter().map(move |z| DVec3::new(x, y, z)))
        })
    }

    #[test]
    fn the_three_notations_are_one_polynomial() {
        let quadric = Quadric::from(K);
        assert_eq!(Coefficients::from(quadric), K);
        assert_eq!(Quadric::from(DMat4::from(quadric)), quadric);
        for p in points() {
            let DVec3 { x, y, z } = p;
            let value = K.constant
                + K.x * x
                + K.y * y
                + K.z * z
                + K.xy * x * y
                + K.yz * y * z
                + K.zx * z * x
                + K.xx * x * x
                + K.yy * y * y
                + K.zz * z * z;
            assert_eq!(quadric.value(p), value, "{p}");
            let homogeneous = p.extend(1.0);
            assert_eq!(homogeneous.dot(DMat4::from(quadric) * homogeneous), value, "{p}");
            let step = 0.25;
            let slope = DVec3::from(DVec3::AXES.map(|axis| {
                let ends = [p + step * axis, p - step * axis].map(|p| quadric.value(p));
                (ends[0] - ends[1]) / (4.0 * step)
            }));
            assert_eq!(quadric.half_gradient(p), slope, "{p}");
        }
    }

    #[test]
    fn a_graph_is_its_height() {
        let g = Graph { constant: 1.0, x: -2.0, y: 0.5, xx: 3.0, xy: -1.0, yy: 0.25 };
        let quadric = Quadric::from(g);
        for p in points() {
            let DVec3 { x, y, z } = p;
            let height =
                g.constant + g.x * x + g.y * y + g.xx * x * x + g.xy * x * y + g.yy * y * y;
            assert_eq!(quadric.value(p), z - height, "{p}");
        }
    }

    #[test]
    fn moved_surfaces_have_their_values_where_they_moved() {
        let quadric = Quadric::from(K);
        let origin = DVec3::new(1.0, -2.0, 0.5);
        let map = DAffine3::from_mat3_translation(
            DMat3::from_cols(
                DVec3::new(2.0, 0.0, 1.0),
                DVec3::new(0.0, 1.0, -1.0),
                DVec3::new(0.0, 0.0, 4.0),
            ),
            origin,
        );
        let (about, mapped) = (quadric.about(origin), quadric.mapped(map));
        for p in points() {
            assert_eq!(about.value(p - origin), quadric.value(p), "{p}");
            let there = map.transform_point3(p);
            assert!((mapped.value(there) - quadric.value(p)).abs() < 1e-12, "{p}");
            assert_eq!(quadric.inverted().value(p), -quadric.value(p));
        }
        assert_eq!(mapped.a, mapped.a.transpose());
    }
}
