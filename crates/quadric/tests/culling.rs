//! No patch that shows its outside anywhere is ever culled; most of those that do not are.

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use zeroset_quadric::{Equation, is_hidden};
use zeroset_raycast::{Bound, Patch, Quadric};

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    proptest::array::uniform3(-size..size).prop_map(DVec3::from)
}

prop_compose! {
    /// Any quadric, of any rank, whose surface passes near its origin.
    fn quadric()(
        axes in proptest::array::uniform3(prop_oneof![Just(0.0), -1.0..1.0, -1e-6..1e-6]),
        turn in vector(1.0),
        b in vector(1.0),
        c in prop_oneof![Just(0.0), -0.3..0.3],
    ) -> Quadric {
        let turn = DMat3::from_rotation_x(turn.x)
            * DMat3::from_rotation_y(turn.y)
            * DMat3::from_rotation_z(turn.z);
        let a = turn * DMat3::from_diagonal(DVec3::from(axes)) * turn.transpose();
        Quadric { a: 0.5 * (a + a.transpose()), b, c }
    }
}

prop_compose! {
    fn bound()(
        centre in vector(0.3),
        radius in 0.01..1.0,
        corners in proptest::array::uniform4(vector(1.0)),
        is_ball in any::<bool>(),
    ) -> Bound {
        if is_ball { Bound::Ball { centre, radius } } else { Bound::Tetrahedron(corners) }
    }
}

/// Points all over a bound.
fn points(bound: Bound) -> Vec<DVec3> {
    let halton = |i: u32, base: u32| {
        let (mut i, mut f, mut x) = (i, 1.0, 0.0);
        while i > 0 {
            f /= f64::from(base);
            x += f * f64::from(i % base);
            i /= base;
        }
        x
    };
    (1..400)
        .map(|i| {
            let [u, v, w] = [2, 3, 5].map(|base| halton(i, base));
            match bound {
                Bound::Ball { centre, radius } => {
                    let (z, r) = (2.0 * u - 1.0, radius * w.cbrt());
                    let (sin, cos) = (std::f64::consts::TAU * v).sin_cos();
                    let flat = (1.0 - z * z).sqrt();
                    centre + r * DVec3::new(flat * cos, flat * sin, z)
                }
                Bound::Tetrahedron(p) => {
                    let mut ends = [0.0, u, v, w, 1.0];
                    ends.sort_by(f64::total_cmp);
                    (0..4).map(|k| (ends[k + 1] - ends[k]) * p[k]).sum()
                }
            }
        })
        .collect()
}

fn is_inside(bound: Bound, x: DVec3) -> bool {
    match bound {
        Bound::Ball { centre, radius } => (x - centre).length() <= radius,
        Bound::Tetrahedron(p) => {
            let m = DMat3::from_cols(p[1] - p[0], p[2] - p[0], p[3] - p[0]);
            let s = m.inverse() * (x - p[0]);
            s.min_element() >= 0.0 && s.element_sum() <= 1.0
        }
    }
}

/// Does some ray of the eye enter the inside within the bound?
fn shows_its_outside(patch: &Patch, eye: DVec3) -> bool {
    points(patch.bound).into_iter().any(|through| {
        let d = patch.origin + through - eye;
        let q = patch.quadric.about(eye - patch.origin);
        let equation = Equation { alpha: d.dot(q.a * d), beta: d.dot(q.b), gamma: q.c };
        let enters = equation.roots()[0].filter(|t| *t > 0.0);
        enters.is_some_and(|t| is_inside(patch.bound, eye + t * d - patch.origin))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn what_shows_its_outside_is_never_culled(
        quadric in quadric(),
        bound in bound(),
        origin in vector(3.0),
        towards in vector(1.0),
        distance in prop_oneof![0.0..0.5, 0.5..5.0, 5.0..1e6],
    ) {
        prop_assume!(towards.length() > 0.1);
        let patch = Patch { origin, quadric, bound, clip: None };
        let eye = origin + distance * towards.normalize();
        prop_assert!(!(is_hidden(&patch, eye) && shows_its_outside(&patch, eye)));
    }
}

/// The unit sphere in small balls, seen from outside: nearly half of it is turned away.
#[test]
fn most_of_what_is_turned_away_is_culled() {
    let quadric = Quadric { a: DMat3::IDENTITY, b: DVec3::ZERO, c: -1.0 };
    let count = 2000;
    let (mut away, mut culled) = (0, 0);
    let eye = DVec3::new(1.0, -5.0, 2.0);
    for i in 0..count {
        let z = (f64::from(i) + 0.5) / f64::from(count) * 2.0 - 1.0;
        let (sin, cos) = (2.399_963 * f64::from(i)).sin_cos();
        let flat = (1.0 - z * z).sqrt();
        let centre = DVec3::new(flat * cos, flat * sin, z);
        let bound = Bound::Ball { centre: DVec3::ZERO, radius: 0.1 };
        let quadric = quadric.about(centre);
        let patch = Patch { origin: centre, quadric, bound, clip: None };
        let is_away = !shows_its_outside(&patch, eye);
        let hidden = is_hidden(&patch, eye);
        assert!(is_away || !hidden, "{centre}");
        away += usize::from(is_away);
        culled += usize::from(hidden);
    }
    println!("{culled} culled of {away} turned away, of {count}");
    assert!(away > 600 && 10 * culled > 9 * away, "{culled} of {away}");
}
