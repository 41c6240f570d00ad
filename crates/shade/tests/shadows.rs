//! Shadows lie where geometry says.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use zeroset_raycast::{Camera, Certificate, Domain, Hit, Hits, Projection, Ray, Request};
use zeroset_raycast::{View, Work};
use zeroset_shade::{Environment, Light, ShadeError, ShadowRays, shaded};

/// A ball of radius 1/2 above the plane z = 0.
const CENTRE: DVec3 = DVec3::new(0.0, 0.0, 1.5);
const RADIUS: f64 = 0.5;
const WIDTH: f64 = 1e-6;

fn domain() -> Domain {
    Domain::new(DVec3::new(-4.0, -4.0, -4.0), DVec3::new(4.0, 4.0, 4.0)).unwrap()
}

/// From above, with x to the right and y up.
fn view() -> View {
    let projection = Projection::Orthographic { height: 6.0 };
    let camera = Camera { eye: 10.0 * DVec3::Z, at: DVec3::ZERO, up: DVec3::Y, projection };
    View::new(camera, 240, 180)
}

/// Where a ray enters the ball at t >= 0.
fn ball(ray: Ray) -> Option<f64> {
    let (d, away) = (ray.direction.as_dvec3(), ray.origin.as_dvec3() - CENTRE);
    let (a, b) = (d.length_squared(), away.dot(d));
    let root = (b * b - a * (away.length_squared() - RADIUS * RADIUS)).sqrt();
    Some((-b - root) / a).filter(|t| *t >= 0.0)
}

fn hits(view: &View) -> Hits {
    let mut hits = Hits::new(Request::FirstWithNormal, view.width * view.height);
    for i in 0..hits.len() {
        let ray = view.ray(i % view.width, i / view.width);
        let t = ball(ray).unwrap_or(10.0);
        let bracket = [t - 0.5 * WIDTH, t + 0.5 * WIDTH];
        hits.set(i, Hit { bracket, certificate: Certificate::PROVEN_HIT, work: Work::default() });
        let normal = if t < 10.0 { (ray.at(t) - CENTRE).normalize() } else { DVec3::Z };
        // Both signs, as functions have them.
        hits.normal[i] = if i % 3 == 0 { -normal.as_vec3() } else { normal.as_vec3() };
    }
    hits
}

/// The pixels that a light does not reach.
fn blocked(view: &View, hits: &Hits, light: &Light) -> Vec<bool> {
    let rays = ShadowRays::new(view, hits, &domain(), light).unwrap();
    let mut blocked = vec![false; hits.len()];
    let answers = answers(&rays);
    rays.mark(&answers, &mut blocked).unwrap();
    // All hits are proven.
    assert!(rays.further(&answers).unwrap().is_empty());
    blocked
}

/// The answers to shadow rays: the ball, or the plane if a ray starts on its wrong side.
fn answers(rays: &ShadowRays) -> Hits {
    let mut answers = Hits::new(Request::Any, rays.batch.rays.len());
    for (i, ray) in rays.batch.rays.iter().enumerate() {
        assert!(ray.is_valid());
        let plane = Some(f64::from(-ray.origin.z / ray.direction.z)).filter(|t| *t >= 0.0);
        if let Some(t) = ball(*ray).or(plane) {
            let work = Work::default();
            answers.set(i, Hit { bracket: [t; 2], certificate: Certificate::ROOT_HIT, work });
        }
    }
    answers
}

#[test]
fn the_shadow_of_a_ball_on_a_plane_is_an_ellipse() {
    let view = view();
    let hits = hits(&view);
    for towards in [DVec3::new(1.0, 0.0, 1.0), DVec3::new(-0.5, 0.7, 2.0)] {
        // Of any length.
        let light = Light::new(7.0 * towards.as_vec3(), 1.0);
        let blocked = blocked(&view, &hits, &light);
        let l = towards.normalize();
        let mut count = [0; 2];
        for (i, blocked) in blocked.iter().enumerate() {
            let p = view.ray(i % view.width, i / view.width).at(hits.get(i).t());
            if p.z > 0.1 {
                assert!(!blocked, "a ball casts no shadow on itself: {p}");
                continue;
            }
            // How far the line to the light passes from the ball's centre.
            let passes = (CENTRE - p).cross(l).length();
            if (passes - RADIUS).abs() > 8.0 / 256.0 {
                assert_eq!(*blocked, passes < RADIUS, "{p} passes at {passes}");
                count[usize::from(*blocked)] += 1;
            }
        }
        assert!(count[0] > 10_000 && count[1] > 500, "{count:?}");
    }
}

#[test]
fn rays_start_off_the_surface_towards_the_light_and_only_where_it_shines() {
    let view = view();
    let hits = hits(&view);
    let light = Light::new(Vec3::new(3.0, 0.0, 1.0), 1.0);
    let l = light.direction.normalize().as_dvec3();
    let rays = ShadowRays::new(&view, &hits, &domain(), &light).unwrap();
    let lit = (0..hits.len()).filter(|i| {
        let p = view.ray(i % view.width, i / view.width).at(hits.get(*i).t());
        p.z < 0.1 || (p - CENTRE).dot(l) > 0.0
    });
    assert_eq!(rays.batch.rays.len(), lit.count());
    // Two pixels of 1/30 are more than the most, 1/256 of the longest side.
    let offset = 8.0 / 256.0;
    for ray in &rays.batch.rays {
        let p = ray.origin.as_dvec3();
        let above = p.z.min((p - CENTRE).length() - RADIUS);
        assert!((above - offset).abs() < 1e-5, "{p} is {above} above");
        assert!((ray.direction.as_dvec3() - l).length() < 1e-6);
    }
    assert_eq!(rays.batch.range, [0.0, f64::INFINITY]);
}

#[test]
fn the_offset_grows_with_the_bracket_and_shrinks_with_the_pixel() {
    let offset = |height: f64, width: f64| {
        let projection = Projection::Orthographic { height };
        let view = View::new(Camera { projection, ..view().camera() }, 240, 180);
        let mut hits = hits(&view);
        // The last pixel, on the plane.
        hits.bracket[240 * 180 - 1] = [10.0 - 0.5 * width, 10.0 + 0.5 * width];
        hits.certificate[..240 * 180 - 1].fill(Certificate::MISS);
        let light = Light::new(Vec3::Z, 1.0);
        let rays = ShadowRays::new(&view, &hits, &domain(), &light).unwrap();
        assert_eq!(rays.batch.rays.len(), 1);
        f64::from(rays.batch.rays[0].origin.z)
    };
    for (height, width, expected) in [
        (1.8, 1e-6, 2.0 * 0.01),
        (6.0, 1e-6, 8.0 / 256.0),
        (6.0, 0.01, 0.08),
        (1.8, 0.01, 0.08),
        (6.0, 100.0, 1.0),
    ] {
        let found = offset(height, width);
        assert!((found - expected).abs() < 1e-6, "{height} {width}: {found}, not {expected}");
    }
}

/// A method that finds the plane thicker than it is, and can prove nothing there.
fn thick(rays: &ShadowRays, thickness: f64) -> Hits {
    let mut answers = answers(rays);
    for (i, ray) in rays.batch.rays.iter().enumerate() {
        if f64::from(ray.origin.z) < thickness {
            let bracket = [0.0, 0.01];
            let certificate = Certificate::POSSIBLE_HIT;
            answers.set(i, Hit { bracket, certificate, work: Work::default() });
        }
    }
    answers
}

#[test]
fn a_surface_that_seems_thick_does_not_shade_itself() {
    let view = view();
    let hits = hits(&view);
    let light = Light::new(Vec3::new(1.0, 0.0, 1.0), 1.0);
    let true_shadow = blocked(&view, &hits, &light);
    let offset = 8.0 / 256.0;
    // 1 + 15/sqrt(2) offsets are as far above the plane as rays start.
    for (thickness, is_lit) in [(0.5 * offset, true), (10.0 * offset, true), (13.0 * offset, false)]
    {
        let mut rays = ShadowRays::new(&view, &hits, &domain(), &light).unwrap();
        let mut blocked = vec![false; hits.len()];
        let mut times = 0;
        while !rays.is_empty() {
            let answers = thick(&rays, thickness);
            rays.mark(&answers, &mut blocked).unwrap();
            rays = rays.further(&answers).unwrap();
            times += 1;
        }
        assert!(times <= 5, "{times}");
        if is_lit {
            assert!(blocked == true_shadow, "{thickness}");
        } else {
            assert!(blocked.iter().filter(|b| **b).count() > hits.len() / 2, "{thickness}");
        }
    }
}

#[test]
fn a_blocked_light_leaves_the_others_and_what_is_everywhere() {
    let view = view();
    let hits = hits(&view);
    let all = [[1.0, 0.0, 1.0], [0.8, 0.3, 1.0], [0.0, 1.0, 1.0]].map(Vec3::from);
    let with_shadow = |direction| {
        let light = Light::new(direction, 1.0 / 3.0);
        Light { blocked: blocked(&view, &hits, &light), ..light }
    };
    let shadowed = all.map(with_shadow);
    let painted = shaded::picture(&view, &hits, &shadowed, Environment::Plain).unwrap();
    assert!(painted.description().ends_with("with shadows"));
    let mut alone = BTreeMap::new();
    for i in 0..hits.len() {
        // The lights that reach the pixel, and no other.
        let reaching = shadowed.iter().filter(|light| !light.blocked[i]);
        let reaching: Vec<_> = reaching.map(|l| Light::new(l.direction, l.strength)).collect();
        let kind: Vec<_> = shadowed.iter().map(|light| light.blocked[i]).collect();
        let alone = alone.entry(kind).or_insert_with(|| {
            shaded::picture(&view, &hits, &reaching, Environment::Plain).unwrap()
        });
        assert_eq!(painted.pixels()[i], alone.pixels()[i]);
    }
    assert!(alone.len() >= 5, "{:?}", alone.keys());
}

#[test]
fn what_does_not_fit_is_an_error_and_what_is_no_number_casts_no_ray() {
    let view = view();
    let mut hits = hits(&view);
    let light = Light::new(Vec3::Z, 1.0);
    let rays = ShadowRays::new(&view, &hits, &domain(), &light).unwrap();
    let few = Hits::new(Request::Any, 3);
    for error in [rays.mark(&few, &mut []).unwrap_err(), rays.further(&few).unwrap_err()] {
        assert!(matches!(error, ShadeError::Answers { got: 3, .. }), "{error}");
    }
    let none = Hits::new(Request::First, hits.len());
    let error = ShadowRays::new(&view, &none, &domain(), &light).unwrap_err();
    assert!(matches!(error, ShadeError::NoNormals(_)), "{error}");
    for direction in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
        let nowhere = Light::new(direction, 1.0);
        let rays = ShadowRays::new(&view, &hits, &domain(), &nowhere).unwrap();
        assert_eq!(rays.batch.rays, []);
    }
    let all = rays.batch.rays.len();
    hits.normal[0] = Vec3::ZERO;
    hits.normal[1] = Vec3::NAN;
    hits.bracket[2] = [f64::NAN; 2];
    hits.bracket[3] = [f64::INFINITY; 2];
    hits.certificate[4] = Certificate::MISS;
    let rays = ShadowRays::new(&view, &hits, &domain(), &light).unwrap();
    assert_eq!(rays.batch.rays.len(), all - 5);
}
