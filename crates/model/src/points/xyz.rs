//! Lines of `x y z` or `x y z nx ny nz`.

use glam::DVec3;

use super::{Fault, Raw, lines, number};

pub(super) fn read(bytes: &[u8]) -> Result<Raw, Fault> {
    let mut raw = Raw::default();
    for (line, words) in lines(bytes) {
        let fault = |why: &str| (format!("line {line}"), why.to_owned());
        let numbers: Option<Vec<f64>> = words.iter().map(|word| number(word)).collect();
        match numbers.as_deref() {
            Some([]) => {}
            Some([x, y, z]) if raw.normals.is_empty() => raw.points.push(DVec3::new(*x, *y, *z)),
            Some([x, y, z, nx, ny, nz]) if raw.normals.len() == raw.points.len() => {
                raw.points.push(DVec3::new(*x, *y, *z));
                raw.normals.push(DVec3::new(*nx, *ny, *nz));
            }
            Some([_, _, _] | [_, _, _, _, _, _]) => {
                return Err(fault("either all points have normals or none has"));
            }
            _ => return Err(fault("a point is x y z, or x y z nx ny nz")),
        }
    }
    Ok(raw)
}
