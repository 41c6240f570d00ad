//! Algebraic surfaces against exact isolation of the ray polynomial's roots.

use glam::Vec3;
use zeroset_raycast::{Ray, RayBatch};

use crate::cast::{Noise, Tally, judge, rays};
use crate::rational::{Poly, fraction};

fn check(equation: &str, half: f32, count: usize, f: impl Fn([Poly; 3]) -> Poly) -> Tally {
    let batch = RayBatch::new(rays(&mut Noise(equation.len() as u64), half, count));
    let tally = judge(equation, f64::from(half), &batch, f);
    println!("{equation}: {tally:?}");
    tally
}

fn sum(p: [Poly; 3]) -> Poly {
    let [x, y, z] = p;
    &(&x + &y) + &z
}

#[test]
fn goursat() {
    let tally =
        check("x^4+y^4+z^4-1", 1.125, 400, |p| &sum(p.map(|v| v.pow(4))) - &Poly::integer(1));
    assert_eq!(tally.undecidable, 0);
    assert!(tally.transversal > 100 && tally.none > 50, "{tally:?}");
}

#[test]
fn tangle() {
    let tally = check("x^4-5*x^2+y^4-5*y^2+z^4-5*z^2+11.8", 2.5, 400, |p| {
        let terms = p.map(|v| &v.pow(4) - &v.pow(2).times(5));
        &sum(terms) + &Poly::number(fraction(118, 10))
    });
    assert!(tally.undecidable <= 2, "{tally:?}");
    assert!(tally.transversal > 100, "{tally:?}");
}

#[test]
fn mitchell() {
    let equation = "4*(x^4+(y^2+z^2)^2)+17*x^2*(y^2+z^2)-20*(x^2+y^2+z^2)+17";
    let tally = check(equation, 2.25, 400, |[x, y, z]| {
        let (x2, r2) = (x.pow(2), &y.pow(2) + &z.pow(2));
        let quartic = &(&x2.pow(2) + &r2.pow(2)).times(4) + &(&x2 * &r2).times(17);
        &(&quartic - &(&x2 + &r2).times(20)) + &Poly::integer(17)
    });
    assert_eq!(tally.undecidable, 0);
}

#[test]
fn planes_close_together() {
    // A ray crosses them one after the other; many rays on quarters meet where two intersect.
    let equation = "(x-1/4)*(x-1/2)*(x-3/4)*(y-1/4)*(y+1/4)*(x+y-z)";
    let mut batch = RayBatch::new(rays(&mut Noise(32), 1.0, 300));
    for k in -8..9 {
        let meeting = Vec3::new(0.25, 0.25, k as f32 / 8.0);
        for d in [Vec3::new(0.5, 1.0, 0.25), Vec3::new(-1.0, 0.25, 0.0)] {
            batch.rays.push(Ray::new(meeting - 3.0 * d, d));
        }
    }
    let tally = judge(equation, 1.0, &batch, |[x, y, z]| {
        let less = |v: &Poly, n| v - &Poly::number(fraction(n, 4));
        let in_x = &(&less(&x, 1) * &less(&x, 2)) * &less(&x, 3);
        let in_y = &less(&y, 1) * &less(&y, -1);
        &(&in_x * &in_y) * &(&(&x + &y) - &z)
    });
    assert_eq!(tally.undecidable, 0);
    assert!(tally.tangential >= 3, "{tally:?}");
}

#[test]
fn double_planes() {
    // Along x = 0, 4 z^2 x^2 - (1 - z^2) y^2 and higher terms: the miter's double line.
    let equation = "4*x^2*(x^2+y^2+z^2)-y^2*(1-y^2-z^2)";
    let mut batch = RayBatch::new(rays(&mut Noise(31), 1.0, 200));
    // Rays that pass the line x = y = 0, at a height that they have to compute.
    for k in -8..9 {
        let height = k as f32 / 8.0;
        for slope in [-0.5, 0.0, 0.75] {
            let d = Vec3::new(0.5, -0.25, slope);
            batch.rays.push(Ray::new(Vec3::new(0.0, 0.0, height) - 3.0 * d, d));
        }
    }
    let tally = judge(equation, 1.0, &batch, |[x, y, z]| {
        let [x2, y2, z2] = [x, y, z].map(|v| v.pow(2));
        let first = (&x2 * &(&(&x2 + &y2) + &z2)).times(4);
        &first - &(&y2 * &(&(&Poly::integer(1) - &y2) - &z2))
    });
    assert_eq!(tally.undecidable, 0);
    assert!(tally.tangential > 10, "{tally:?}");
}

#[test]
fn squares_never_change_sign() {
    let tally = check("(x^2+y^2+z^2-1)^2", 1.5, 300, |p| {
        (&sum(p.map(|v| v.pow(2))) - &Poly::integer(1)).pow(2)
    });
    assert_eq!([tally.undecidable, tally.transversal], [0, 0], "{tally:?}");
    assert!(tally.tangential > 50, "{tally:?}");
}

#[test]
fn sheets_a_hair_apart() {
    for power in [10, 20, 30, 40, 44, 48] {
        let delta = 1_i64 << power;
        let equation = format!("(x^2+y^2+z^2-1)*(x^2+y^2+z^2-1-1/{delta})");
        let tally = check(&equation, 1.5, 120, |p| {
            let g = &sum(p.map(|v| v.pow(2))) - &Poly::integer(1);
            &g * &(&g - &Poly::number(fraction(1, delta)))
        });
        assert!(tally.undecidable == 0, "{tally:?}");
    }
}

fn chebyshev(n: u32, v: &Poly) -> Poly {
    let (mut a, mut b) = (Poly::integer(1), v.clone());
    for _ in 1..n {
        (a, b) = (b.clone(), &(v * &b).times(2) - &a);
    }
    b
}

#[test]
fn chebyshev_towers() {
    let six = "(32*x^6-48*x^4+18*x^2-1)+(32*y^6-48*y^4+18*y^2-1)+(32*z^6-48*z^4+18*z^2-1)";
    let tally = check(six, 1.0625, 100, |p| sum(p.map(|v| chebyshev(6, &v))));
    assert_eq!(tally.undecidable, 0);
    let seven =
        "(64*x^7-112*x^5+56*x^3-7*x)+(64*y^7-112*y^5+56*y^3-7*y)+(64*z^7-112*z^5+56*z^3-7*z)+1";
    let tally = check(seven, 1.125, 60, |p| &sum(p.map(|v| chebyshev(7, &v))) + &Poly::integer(1));
    assert_eq!(tally.undecidable, 0);
    let one = |v| format!("(2048*{v}^12-6144*{v}^10+6912*{v}^8-3584*{v}^6+840*{v}^4-72*{v}^2+1)");
    let twelve = format!("{}+{}+{}", one("x"), one("y"), one("z"));
    let tally = check(&twelve, 1.0625, 25, |p| sum(p.map(|v| chebyshev(12, &v))));
    assert_eq!(tally.undecidable, 0);
}

#[test]
fn rays_inside_the_surface() {
    // Each coordinate axis lies in x y z = 0, and F vanishes along it.
    let along = RayBatch::new(vec![
        Ray::new(Vec3::new(-3.0, 0.0, 0.0), Vec3::X),
        Ray::new(Vec3::new(0.5, 0.0, 0.25), Vec3::Z),
    ]);
    let tally = judge("x*y*z", 1.0, &along, |[x, y, z]| &(&x * &y) * &z);
    assert_eq!(tally, Tally { tangential: 2, ..Tally::default() });
}

#[test]
fn ranges_that_end_at_roots() {
    // From (0,0,0) along x, the sphere is at t = 1: closed ranges hold it, others do not.
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let sphere = |p: [Poly; 3]| &sum(p.map(|v| v.pow(2))) - &Poly::integer(1);
    let ends = [
        ([0.0, 1.0], 1),
        ([1.0, 4.0], 1),
        ([1.0, 1.0], 1),
        ([0.0, 1.0_f64.next_down()], 0),
        ([1.0_f64.next_up(), 4.0], 0),
        ([-1.0, 4.0], 1),
        ([-3.0, -1.0], 1),
        ([0.5, 0.5], 0),
    ];
    for (range, hits) in ends {
        let batch = RayBatch { rays: vec![ray], range };
        let tally = judge("x^2+y^2+z^2-1", 2.0, &batch, sphere);
        assert_eq!([tally.transversal, tally.none], [hits, 1 - hits], "{range:?} {tally:?}");
    }
    // The domain ends where the surface is.
    let batch = RayBatch::new(vec![ray]);
    let tally = judge("x^2+y^2+z^2-1", 1.0, &batch, sphere);
    assert_eq!(tally.transversal, 1, "{tally:?}");
}
