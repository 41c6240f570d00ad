//! Single quadrics from near and far: which formula finds what is there.

use glam::{DMat3, DVec3};
use zeroset::cpu::{Class, Truth};
use zeroset::quadric::{Formula, Precision, QuadricReference, Quadrics};
use zeroset::raycast::{
    Blending, Bound, Error, Hits, Method, Patch, Patches, Progress, Quadric, Ray, RayBatch, Rays,
    Request, Scene, Sides,
};

/// Rays are judged whose discriminant is at least this, to beta^2 + |alpha gamma|, about the point of the ray
/// that is nearest to the patch, and whose root is at least [`EDGE`] radii from where the bound ends.
const CLEAR: f64 = 1e-5;
const EDGE: f64 = 1e-5;

/// Numbers without pattern.
struct Numbers(u64);

impl Numbers {
    /// From -1 to 1.
    fn next(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }

    fn unit(&mut self) -> DVec3 {
        loop {
            let v = self.vector();
            if (0.01..1.0).contains(&v.length()) {
                return v.normalize();
            }
        }
    }
}

/// A kind of quadrics and of rays.
struct Case {
    name: String,
    rank: usize,
    /// The size of its second derivatives.
    curvature: f64,
    eye: Eye,
}

#[derive(Clone, Copy)]
enum Eye {
    /// At that many radii.
    At(f64),
    /// On the surface.
    OnSurface,
    /// In the ball.
    Inside,
}

fn cases() -> Vec<Case> {
    let case = |name: String, rank, curvature, eye| Case { name, rank, curvature, eye };
    let mut all = Vec::new();
    for distance in [3.0, 30.0, 1e3, 1e4, 1e5, 1e6] {
        all.push(case(format!("eye at {distance} radii"), 3, 1.0, Eye::At(distance)));
    }
    for exponent in [2, 4, 6, 8, 12, 16] {
        let curvature = 10.0_f64.powi(-exponent);
        all.push(case(format!("alpha about 1e-{exponent}"), 3, curvature, Eye::At(3.0)));
    }
    for rank in [2, 1, 0] {
        all.push(case(format!("rank {rank}"), rank, 1.0, Eye::At(3.0)));
    }
    all.push(case("eye on the surface".into(), 3, 1.0, Eye::OnSurface));
    all.push(case("eye inside".into(), 3, 1.0, Eye::Inside));
    all
}

impl Case {
    /// A patch of radius 1, and rays at it.
    fn patch(&self, numbers: &mut Numbers, rays: usize) -> (Patch, RayBatch) {
        let mut axes = self.curvature * numbers.vector();
        for axis in self.rank..3 {
            axes[axis] = 0.0;
        }
        let turn = DMat3::from_rotation_x(3.0 * numbers.next())
            * DMat3::from_rotation_y(3.0 * numbers.next());
        let a = turn * DMat3::from_diagonal(axes) * turn.transpose();
        // The surface passes near the middle.
        let through = 0.3 * numbers.vector();
        let flat = Quadric { a: 0.5 * (a + a.transpose()), b: numbers.unit(), c: 0.0 };
        let origin = 2.0 * numbers.vector();
        let bound = Bound::Ball { centre: DVec3::ZERO, radius: 1.0 };
        let quadric = flat.about(-through);
        let patch = Patch { origin, quadric, bound, clip: None };
        let one = |numbers: &mut Numbers| {
            let target = origin + numbers.vector();
            let eye = match self.eye {
                Eye::At(distance) => origin + distance * numbers.unit(),
                Eye::OnSurface => origin + through,
                Eye::Inside => origin + 0.9 * numbers.vector() / 3.0_f64.sqrt(),
            };
            let eye = eye.as_vec3();
            Ray::new(eye, (target - eye.as_dvec3()).normalize().as_vec3())
        };
        let rays = (0..rays).map(|_| one(numbers)).collect();
        // What is at the eye does not count where it is on the surface.
        let from = if let Eye::OnSurface = self.eye { 1e-3 } else { 0.0 };
        (patch, RayBatch { rays, range: [from, f64::INFINITY] })
    }
}

/// How far from undecided is a ray?
fn is_clear(patch: &Patch, ray: Ray, from: f64, truth: &Truth) -> bool {
    let (o, d) = (ray.origin.as_dvec3() - patch.origin, ray.direction.as_dvec3());
    let start = -o.dot(d) / d.length_squared();
    let p = o + start * d;
    let q = patch.quadric;
    let (alpha, beta, gamma) = (d.dot(q.a * d), d.dot(q.half_gradient(p)), q.value(p));
    let size = beta * beta + (alpha * gamma).abs();
    let square = beta * beta - alpha * gamma;
    if square.abs() < CLEAR * size {
        return false;
    }
    // Every root, seen or not, is clear of the sphere and of the eye.
    let roots = if square < 0.0 {
        Vec::new()
    } else {
        let s = square.sqrt().copysign(-beta);
        vec![gamma / (s - beta), (s - beta) / alpha]
    };
    let is_off = |t: &f64| {
        let distance = (p + *t * d).length();
        !t.is_finite() || (distance - 1.0).abs() > EDGE && (start + t - from).abs() > EDGE
    };
    [Class::Transversal, Class::None].contains(&truth.class) && roots.iter().all(is_off)
}

#[derive(Clone, Copy, Default)]
struct Count {
    false_hits: usize,
    false_misses: usize,
    worst: f64,
}

fn contenders() -> Vec<(&'static str, Quadrics)> {
    let of = |formula, precision| Quadrics { formula, precision, ..Quadrics::brute() };
    vec![
        ("local, double", of(Formula::Local, Precision::Double)),
        ("local, single", of(Formula::Local, Precision::Single)),
        ("Eq. 7, single", of(Formula::Quotient, Precision::Single)),
        ("Eq. 15, single", of(Formula::Reciprocal, Precision::Single)),
    ]
}

/// Prints a table over `rays` rays a case.
pub(crate) fn print(rays: usize) -> Result<(), Error> {
    const RAYS_A_PATCH: usize = 500;
    println!("## Accuracy on single quadrics\n");
    println!(
        "Random quadrics in a ball of radius 1, random rays, judged against the reference. False hits / \
         false misses among the clear rays (discriminant at least {CLEAR:e} of beta^2 + |alpha gamma|, no \
         root within {EDGE:e} of the bound or of where the ray starts), and the largest error of t.\n"
    );
    print!("| case | rays | not clear |");
    contenders().iter().for_each(|(name, _)| print!(" {name} |"));
    println!("\n|---|---|---|---|---|---|---|");
    for case in cases() {
        let mut numbers = Numbers(1);
        let (mut clear, mut asked) = (0, 0);
        let mut counts = vec![Count::default(); contenders().len()];
        while asked < rays {
            let (patch, batch) = case.patch(&mut numbers, RAYS_A_PATCH);
            let patches = Patches::new(vec![patch], Sides::Front, Blending::None)?;
            let scene = Scene::of_patches("one", patches);
            let all: Vec<usize> = (0..RAYS_A_PATCH).collect();
            let oracle = QuadricReference.prepare_reference(&scene)?;
            let request = Rays::Batch(&batch);
            let truths = oracle.classify(request, &all, &Progress::new())?;
            let judged: Vec<usize> = all
                .into_iter()
                .filter(|i| is_clear(&patch, batch.rays[*i], batch.range[0], &truths[*i]))
                .collect();
            for ((_, method), count) in contenders().iter().zip(&mut counts) {
                let mut hits = Hits::new(Request::First, RAYS_A_PATCH);
                method.prepare(&scene)?.intersect(request, &mut hits, &Progress::new())?;
                judged.iter().for_each(|&i| count.add(&hits, i, &truths[i]));
            }
            clear += judged.len();
            asked += RAYS_A_PATCH;
        }
        print!("| {} | {asked} | {} |", case.name, asked - clear);
        counts.iter().for_each(|c| {
            print!(" {} / {}, {:.1e} |", c.false_hits, c.false_misses, c.worst);
        });
        println!();
    }
    println!();
    Ok(())
}

impl Count {
    fn add(&mut self, hits: &Hits, i: usize, truth: &Truth) {
        let hit = hits.get(i);
        match (hit.certificate.is_hit(), truth.class == Class::Transversal) {
            (true, true) => self.worst = self.worst.max((hit.t() - truth.bracket[0]).abs()),
            (true, false) => self.false_hits += 1,
            (false, true) => self.false_misses += 1,
            (false, false) => {}
        }
    }
}
