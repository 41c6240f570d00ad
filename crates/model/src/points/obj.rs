//! Wavefront OBJ: `v`, `vn` and `f`; all else is skipped.

use glam::DVec3;

use super::{Fault, Raw, lines, number};

pub(super) fn read(bytes: &[u8]) -> Result<Raw, Fault> {
    let mut raw = Raw::default();
    let mut given = Vec::new();
    // The sum of the normals that faces give a vertex.
    let mut by_faces: Vec<DVec3> = Vec::new();
    for (line, words) in lines(bytes) {
        let fault = |why: &str| (format!("line {line}"), why.to_owned());
        let Some((kind, words)) = words.split_first() else { continue };
        match kind.as_str() {
            "v" => raw.points.push(vector(words).ok_or_else(|| fault("v has three numbers"))?),
            "vn" => given.push(vector(words).ok_or_else(|| fault("vn has three numbers"))?),
            "f" => {
                let mut corners = Vec::new();
                for word in words {
                    let mut parts = word.split('/');
                    let vertex = parts.next().and_then(|i| index(i, raw.points.len()));
                    let vertex =
                        vertex.ok_or_else(|| fault("f names a vertex that is not there"))?;
                    corners.push(vertex);
                    let Some(name) = parts.nth(1).filter(|name| !name.is_empty()) else { continue };
                    let normal = index(name, given.len());
                    let normal =
                        normal.ok_or_else(|| fault("f names a normal that is not there"))?;
                    by_faces.resize(raw.points.len(), DVec3::ZERO);
                    by_faces[vertex] += given[normal];
                }
                for i in 2..corners.len() {
                    raw.faces.push([corners[0], corners[i - 1], corners[i]]);
                }
            }
            _ => {}
        }
    }
    if by_faces.iter().any(|n| *n != DVec3::ZERO) {
        by_faces.resize(raw.points.len(), DVec3::ZERO);
        raw.normals = by_faces;
    } else if given.len() == raw.points.len() {
        raw.normals = given;
    }
    Ok(raw)
}

fn vector(words: &[String]) -> Option<DVec3> {
    let numbers: Option<Vec<f64>> = words.iter().take(3).map(|word| number(word)).collect();
    numbers.and_then(|n| (n.len() == 3).then(|| DVec3::from_slice(&n)))
}

/// An index counted from 1, or back from the last one.
fn index(text: &str, count: usize) -> Option<usize> {
    let i: i64 = text.parse().ok()?;
    let i = if i < 0 { i + count as i64 } else { i - 1 };
    usize::try_from(i).ok().filter(|i| *i < count)
}
