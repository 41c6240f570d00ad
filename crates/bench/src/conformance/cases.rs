//! Sets of rays that find faults.

use glam::{DVec3, Vec3};
use zeroset_raycast::{Domain, Ray, RayBatch, Rays, View};

use super::suite::Suite;

/// Rays with a name.
pub(super) struct Case {
    pub(super) name: String,
    rays: Kind,
}

enum Kind {
    View(View),
    Batch(RayBatch),
}

impl Case {
    pub(super) fn rays(&self) -> Rays<'_> {
        match &self.rays {
            Kind::View(view) => Rays::View(view),
            Kind::Batch(batch) => Rays::Batch(batch),
        }
    }

    fn batch(name: impl Into<String>, rays: Vec<Ray>, range: [f64; 2]) -> Self {
        Self { name: name.into(), rays: Kind::Batch(RayBatch { rays, range }) }
    }
}

const ALL: [f64; 2] = [0.0, f64::INFINITY];

impl Suite<'_> {
    /// The cases for a scene.
    pub(super) fn cases(&self) -> Vec<Case> {
        let domain = &self.scene.domain;
        let view = self.view();
        let through = through(domain);
        let distance = (view.camera().eye - domain.centre()).length();
        let seen: Vec<Ray> = (0..37).map(|column| view.ray(column, 14)).collect();
        let mut cases = vec![
            Case { name: "a view".into(), rays: Kind::View(view) },
            Case::batch("rays along axes", along_axes(domain), ALL),
            Case::batch("rays through the domain", through.clone(), ALL),
            Case::batch("rays from inside", from_inside(domain), ALL),
            Case::batch("rays from faces and corners", from_faces(domain), ALL),
            Case::batch("rays beside the domain", beside(domain), ALL),
            Case::batch("rays that are no rays", no_rays(&seen), ALL),
            Case::batch("one ray", vec![seen[18]], ALL),
        ];
        for scale in [1e-12, 1e-3, 1e3, 1e12] {
            let scaled = through.iter().map(|r| Ray::new(r.origin, scale * r.direction)).collect();
            cases.push(Case::batch(format!("directions scaled by {scale:e}"), scaled, ALL));
        }
        // The middle of the view's rays is near the centre of the domain.
        for (name, range) in [
            ("a range that ends in the domain", [0.0, distance]),
            ("a range that starts in the domain", [distance, f64::INFINITY]),
            ("a range within the domain", [0.9 * distance, 1.05 * distance]),
            ("a range of one t", [distance, distance]),
            ("a range with negative t", [-distance, 0.9 * distance]),
            ("a range before the domain", [0.0, 1e-3 * distance]),
            ("an inverted range", [distance, 0.5 * distance]),
        ] {
            cases.push(Case::batch(name, seen.clone(), range));
        }
        cases
    }
}

/// A point of the box: (0, 0, 0) is its centre, the faces are at -1 and 1.
fn place(domain: &Domain, p: DVec3) -> Vec3 {
    (domain.centre() + 0.5 * (domain.max - domain.min) * p).as_vec3()
}

fn axes() -> impl Iterator<Item = DVec3> {
    [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis])
}

/// Rays along axes, through the centre, beside it, and in faces.
fn along_axes(domain: &Domain) -> Vec<Ray> {
    let mut rays = Vec::new();
    for axis in axes() {
        let across = [axis.any_orthonormal_vector(), axis.cross(axis.any_orthonormal_vector())];
        for (u, v) in [(0.0, 0.0), (0.1, 0.23), (-0.45, 0.0), (0.71, -0.64), (1.0, 0.3), (1.1, 0.0)]
        {
            let origin = place(domain, -3.0 * axis + u * across[0] + v * across[1]);
            rays.push(Ray::new(origin, axis.as_vec3()));
            // Negative zeros are zeros.
            rays.push(Ray::new(origin, -(-axis).as_vec3()));
        }
    }
    rays
}

/// Rays from a sphere around the domain to points in it, some with a direction component of zero or
/// nearly so.
fn through(domain: &Domain) -> Vec<Ray> {
    let mut rays = Vec::new();
    for i in 0..24 {
        // Points on a spiral are spread evenly and are in general position.
        let z = (f64::from(i) + 0.5) / 12.0 - 1.0;
        let (sin, cos) = (2.4 * f64::from(i)).sin_cos();
        let from = DVec3::new(cos, sin, z);
        let origin = place(domain, 2.5 * from);
        let target = place(domain, 0.4 * DVec3::new(sin, z, cos));
        let mut direction = target - origin;
        match i % 4 {
            1 => direction.x = 0.0,
            2 => direction.y = 1e-40,
            3 => direction.z *= 1e-7,
            _ => {}
        }
        rays.push(Ray::new(origin, direction));
    }
    rays
}

fn from_inside(domain: &Domain) -> Vec<Ray> {
    let places = [DVec3::ZERO, DVec3::new(0.13, -0.21, 0.34), DVec3::new(-0.7, 0.6, 0.05)];
    let diagonals = [DVec3::ONE, DVec3::new(1.0, -1.0, 0.0), DVec3::new(-0.3, 0.2, -0.9)];
    let directions: Vec<DVec3> = axes().chain(diagonals).collect();
    places
        .iter()
        .flat_map(|p| directions.iter().map(|d| Ray::new(place(domain, *p), d.as_vec3())))
        .collect()
}

/// Rays that start on a face or a corner, into the domain, along the face, and away.
fn from_faces(domain: &Domain) -> Vec<Ray> {
    let mut rays = Vec::new();
    for axis in axes() {
        let along = axis.any_orthonormal_vector();
        let origin = place(domain, axis + 0.2 * along);
        for direction in [-axis, along, axis, 0.4 * along - axis, 0.4 * along + axis] {
            rays.push(Ray::new(origin, direction.as_vec3()));
        }
    }
    for corner in [DVec3::ONE, DVec3::new(1.0, -1.0, -1.0)] {
        for direction in [-corner, corner, DVec3::new(-corner.x, 0.0, 0.0)] {
            rays.push(Ray::new(place(domain, corner), direction.as_vec3()));
        }
    }
    rays
}

/// Rays that pass the domain, or have it behind them.
fn beside(domain: &Domain) -> Vec<Ray> {
    axes()
        .flat_map(|axis| {
            let along = axis.any_orthonormal_vector();
            let origin = place(domain, 2.0 * axis);
            [axis, along, axis - 0.1 * along].map(|d| Ray::new(origin, d.as_vec3()))
        })
        .collect()
}

/// Every kind of invalid ray, between valid ones.
fn no_rays(valid: &[Ray]) -> Vec<Ray> {
    let mut rays = Vec::new();
    for (i, ray) in valid.iter().enumerate() {
        let mut bad = *ray;
        let wrong = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][i % 3];
        match i % 7 {
            0..3 => bad.origin[i % 3] = wrong,
            3..6 => bad.direction[i % 3] = wrong,
            _ => bad.direction = Vec3::ZERO,
        }
        rays.extend([*ray, bad]);
    }
    rays
}
