//! Unit normals at hits.

use rayon::prelude::*;
use zeroset_expr::Tape;
use zeroset_ia::{Dual, plain::Plain};
use zeroset_raycast::{Hits, Rays, Request, Work};

use glam::{DVec3, Vec3};

/// Fills in the normals if they were asked for: the unit gradient at the middle of each bracket, in
/// double precision; zero where it vanishes or is not finite. Gives what that cost.
pub(crate) fn fill(tape: &Tape, rays: Rays<'_>, hits: &mut Hits) -> Work {
    if hits.request != Request::FirstWithNormal {
        return Work::default();
    }
    let (bracket, certificate) = (&hits.bracket, &hits.certificate);
    hits.normal.par_chunks_mut(1024).zip(hits.work.par_chunks_mut(1024)).enumerate().for_each(
        |(chunk, (normals, work))| {
            let zero = Dual::<_, 3>::constant_value(Plain(0.0_f64));
            let mut evaluator = tape.evaluator(&zero);
            for (i, (normal, work)) in normals.iter_mut().zip(work).enumerate() {
                let index = 1024 * chunk + i;
                if !certificate[index].is_hit() {
                    continue;
                }
                let [lo, hi] = bracket[index];
                let p = rays.get(index).at(0.5 * (lo + hi));
                let point = [0, 1, 2].map(|axis| Dual::variable(Plain(p[axis]), axis));
                let [x, y, z] = evaluator.evaluate(point).tangent.map(|t| t.0);
                *work += Work { gradients: 1, ..Work::default() };
                *normal = unit(DVec3::new(x, y, z));
            }
        },
    );
    let gradients = hits.certificate.iter().filter(|c| c.is_hit()).count() as u64;
    Work { gradients, ..Work::default() }
}

/// The unit vector along `v`, scaled first so that its square neither overflows nor vanishes.
fn unit(v: DVec3) -> Vec3 {
    let largest = v.abs().max_element();
    if !(largest > 0.0 && largest.is_finite()) {
        return Vec3::ZERO;
    }
    (v / largest).normalize().as_vec3()
}
