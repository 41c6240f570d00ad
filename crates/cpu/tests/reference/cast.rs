//! Scenes, rays and the judge that the tests share.

use glam::{DVec3, Vec3};
use zeroset_cpu::{Class, Reference, Truth};
use zeroset_expr::Function;
use zeroset_raycast::{Domain, Progress, Ray, RayBatch, Rays, Scene};

use crate::rational::{Poly, Roots, clip, exact};

/// The zero set of an equation in the cube `[-half, half]^3`.
pub(crate) fn scene(equation: &str, half: f64) -> Scene {
    let function = Function::parse(equation).unwrap_or_else(|e| panic!("{equation}: {e}"));
    Scene::new(equation, function, Domain::new(DVec3::splat(-half), DVec3::splat(half)).unwrap())
}

/// What the reference says with its default settings.
pub(crate) fn classify(scene: &Scene, batch: &RayBatch) -> Vec<Truth> {
    let prepared = Reference::default().prepare_reference(scene).unwrap();
    let indices: Vec<usize> = (0..batch.rays.len()).collect();
    prepared.classify(Rays::Batch(batch), &indices, &Progress::new()).unwrap()
}

/// Reproducible noise (splitmix64).
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In `[-1, 1]`.
    pub(crate) fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1_u64 << 23) as f32 - 1.0
    }

    fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit())
    }

    /// A multiple of 1/4 in `[-n/4, n/4]`.
    fn quarter(&mut self, n: u64) -> f32 {
        (self.below(2 * n + 1) as f32 - n as f32) / 4.0
    }
}

/// Rays of every kind that has ever been trouble: through the domain at random, axis-parallel, on
/// short binary coordinates (through nodes and along edges), from inside, from afar, and with long
/// and short directions.
pub(crate) fn rays(noise: &mut Noise, half: f32, count: usize) -> Vec<Ray> {
    let mut rays = Vec::new();
    while rays.len() < count {
        let target = noise.vector() * half;
        let mut ray = match noise.below(7) {
            0 | 1 => {
                let origin = noise.vector().normalize_or(Vec3::X) * 3.0 * half;
                Ray::new(origin, target - origin)
            }
            2 => {
                let mut direction = Vec3::ZERO;
                direction[noise.below(3) as usize] = if noise.below(2) == 0 { 1.0 } else { -0.75 };
                Ray::new(target - direction * 4.0 * half, direction)
            }
            3 | 4 => {
                let mut quarters = |n| Vec3::from_array([0, 1, 2].map(|_| noise.quarter(n)));
                Ray::new(quarters(12), quarters(4))
            }
            5 => Ray::new(target, noise.vector()),
            _ => {
                let origin = noise.vector() * 1e4 * half;
                Ray::new(origin, (target - origin).normalize_or(Vec3::Y))
            }
        };
        if noise.below(8) == 0 {
            ray.direction *= 2.0_f32.powi(noise.below(41) as i32 - 20);
        }
        if ray.is_valid() {
            rays.push(ray);
        }
    }
    rays
}

/// How often each class was given.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Tally {
    pub(crate) transversal: usize,
    pub(crate) tangential: usize,
    pub(crate) none: usize,
    pub(crate) undecidable: usize,
}

impl Tally {
    pub(crate) fn add(&mut self, class: Class) {
        *match class {
            Class::Transversal => &mut self.transversal,
            Class::Tangential => &mut self.tangential,
            Class::None => &mut self.none,
            Class::Undecidable => &mut self.undecidable,
        } += 1;
    }
}

/// Checks each answer against the exact roots of `f` along each ray.
///
/// # Panics
/// At a lie: about the class, the bracket, or what precedes it.
pub(crate) fn judge(
    equation: &str,
    half: f64,
    batch: &RayBatch,
    f: impl Fn([Poly; 3]) -> Poly,
) -> Tally {
    let scene = scene(equation, half);
    let mut tally = Tally::default();
    for (ray, truth) in batch.rays.iter().zip(classify(&scene, batch)) {
        tally.add(truth.class);
        let says = format!("{equation}: {ray:?} in {:?} is {truth:?}", batch.range);
        let Some([a, b]) = clip(&scene.domain, *ray, batch.range) else {
            assert!(matches!(truth.class, Class::None | Class::Undecidable), "{says}");
            continue;
        };
        let p = f(Poly::ray(*ray));
        if p.0.is_empty() {
            assert_ne!(truth.class, Class::None, "{says}");
            assert_ne!(truth.class, Class::Transversal, "{says}");
            assert!(exact(truth.bracket[0]) <= a, "{says}");
            continue;
        }
        let roots = Roots::new(&p);
        if truth.class == Class::None {
            assert_eq!(roots.within(&a, &b), 0, "{says}");
            assert_eq!(truth.bracket, [f64::INFINITY; 2]);
            continue;
        }
        let [lo, hi] = truth.bracket.map(exact);
        assert!(lo <= hi, "{says}");
        let earlier = if lo > a { roots.within(&a, &lo) - roots.within(&lo, &lo) } else { 0 };
        assert_eq!(earlier, 0, "{says}");
        if truth.class == Class::Undecidable {
            continue;
        }
        let t = truth.bracket[1].abs();
        assert!(
            truth.bracket[1] - truth.bracket[0] <= (5.0 * (t.next_up() - t)).max(1e-12),
            "{says}"
        );
        let (inner_lo, inner_hi) = (lo.clone().max(a), hi.clone().min(b));
        assert!(roots.within(&inner_lo, &inner_hi) > 0, "{says}");
        if truth.class == Class::Transversal {
            assert_eq!(roots.within(&lo, &hi), 1, "{says}");
            assert_eq!(roots.multiple_within(&lo, &hi), 0, "{says}");
        }
    }
    tally
}
