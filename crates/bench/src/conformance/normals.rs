//! Normals: unit vectors along the function's gradient.

use glam::{DVec3, Vec3};
use zeroset_expr::{Parameters, Tape};
use zeroset_ia::{Dual, Plain};
use zeroset_raycast::{Geometry, Hits, Intersector, Rays, Request, Scene};

use super::suite::Suite;

impl Suite<'_> {
    /// Normals change no answer, are unit vectors or zero, and point along the gradient.
    pub(super) fn check_normals(&mut self, intersector: &dyn Intersector, first: &Hits) {
        let view = self.view();
        let rays = Rays::View(&view);
        let asked = self.ask(intersector, rays, Request::FirstWithNormal);
        let Some(hits) = asked else { return };
        let different = super::answers::differences(first, &hits, rays);
        self.fail_any("normals change no answer", "a view", &different);

        let told = |i: usize| format!("{:?}: {}", rays.get(i), hits.normal[i]);
        let is_bad = |i: &usize| {
            let n = hits.normal[*i];
            let is_unit = (n.length() - 1.0).abs() < 1e-5;
            n != Vec3::ZERO && !(is_unit && hits.certificate[*i].is_hit())
        };
        let bad: Vec<_> = (0..rays.len()).filter(is_bad).map(told).collect();
        self.fail_any("normals are unit vectors, or zero", "a view", &bad);

        let Some(tape) = tape(self.scene) else { return };
        let hit: Vec<_> = (0..rays.len()).filter(|i| hits.certificate[*i].is_hit()).collect();
        let is_off = |i: &usize| {
            let gradient = gradient(&tape, rays.get(*i).at(hits.get(*i).t()));
            let along = hits.normal[*i].as_dvec3().dot(gradient);
            gradient.length() > 0.0 && !(along > 0.9 * gradient.length())
        };
        let off: Vec<_> = hit.iter().copied().filter(is_off).map(told).collect();
        // A method may look elsewhere in the bracket, and near a singular point that matters.
        if 10 * off.len() > hit.len() {
            self.fail_any("normals are along the gradient", "a view", &off);
        }
    }
}

fn tape(scene: &Scene) -> Option<Tape> {
    let values: &Parameters = &scene.parameters;
    match &scene.geometry {
        Geometry::Implicit(function) => function.tape(values, 128).ok(),
        _ => None,
    }
}

/// The gradient in double precision; zero where it is not finite.
fn gradient(tape: &Tape, p: DVec3) -> DVec3 {
    let zero = Dual::<_, 3>::constant_value(Plain(0.0_f64));
    let point = [0, 1, 2].map(|axis| Dual::variable(Plain(p[axis]), axis));
    let tangent = tape.evaluator(&zero).evaluate(point).tangent;
    let gradient = DVec3::from_array(tangent.map(|t| t.0));
    if gradient.is_finite() { gradient } else { DVec3::ZERO }
}
