//! Wavefront OBJ: vertices, normals and faces; all else is passed over.
//!
//! A reader of our own: those at hand keep no line for a message, and split a vertex where its normals differ.

use glam::DVec3;

use super::faces::Faces;
use super::raw::Raw;
use super::text::{Line, lines, quoted};
use super::{Error, Place};

/// What has been read so far.
#[derive(Debug, Default)]
struct Model {
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    faces: Faces,
    /// For each corner of a face the normal that it names.
    corner_normals: Vec<Option<u32>>,
    /// The last vertex and the last normal that a face names, each with its line.
    last: [Option<(u32, usize)>; 2],
}

/// Reads `v`, `vn` and `f`.
pub(super) fn read(file: &str, bytes: &[u8]) -> Result<Raw, Error> {
    let mut model = Model::default();
    for line in lines(file, bytes) {
        let mut words = line.words();
        match words.next() {
            Some("v") => model.points.push(line.vector(&mut words)?),
            Some("vn") => model.normals.push(line.vector(&mut words)?),
            Some("f") => model.face(&line, words)?,
            _ => {}
        }
    }
    // A face may name what comes after it, so that names are checked last.
    let counts = [model.points.len(), model.normals.len()];
    for ((last, count), what) in model.last.into_iter().zip(counts).zip(["vertex", "normal"]) {
        if let Some((index, line)) = last
            && index as usize >= count
        {
            let what = format!("a face names {what} {} of {count}", u64::from(index) + 1);
            return Err(Error::new(file, Place::Line(line), what, "the file may be cut short"));
        }
    }
    Ok(model.raw())
}

impl Model {
    /// Adds the face whose corners are `v`, `v/vt`, `v//vn` or `v/vt/vn`, each from 1, or from -1 backwards.
    fn face<'w>(
        &mut self,
        line: &Line<'_>,
        corners: impl Iterator<Item = &'w str>,
    ) -> Result<(), Error> {
        let counts = [self.points.len(), self.normals.len()];
        for corner in corners {
            let mut parts = corner.split('/');
            let vertex = index(line, corner, parts.next().unwrap_or_default(), counts[0])?;
            let normal = match parts.nth(1) {
                None | Some("") => None,
                Some(word) => Some(index(line, corner, word, counts[1])?),
            };
            for (last, index) in self.last.iter_mut().zip([Some(vertex), normal]) {
                if let Some(index) = index
                    && last.is_none_or(|(before, _)| before < index)
                {
                    *last = Some((index, line.number()));
                }
            }
            self.faces.add_corner(vertex);
            self.corner_normals.push(normal);
        }
        self.faces.close();
        Ok(())
    }

    fn raw(self) -> Raw {
        let named = self.corner_normals.iter().any(Option::is_some);
        let normals = match () {
            () if named => Some(self.through_faces()),
            () if self.normals.len() == self.points.len() => Some(self.normals),
            () => None,
        };
        Raw { points: self.points, normals, faces: self.faces }
    }

    /// For each vertex the mean of the normals that faces give it; of the faces themselves if they give none.
    fn through_faces(&self) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.points.len()];
        let mut given = vec![false; self.points.len()];
        for (&vertex, normal) in self.faces.corners().iter().zip(&self.corner_normals) {
            if let Some(normal) = normal {
                sums[vertex as usize] += self.normals[*normal as usize].normalize_or_zero();
                given[vertex as usize] = true;
            }
        }
        for ((sum, given), of_faces) in
            sums.iter_mut().zip(given).zip(self.faces.normals(&self.points))
        {
            if !given {
                *sum = of_faces;
            }
        }
        sums
    }
}

/// An index from 0 for a word that counts from 1, or from -1 backwards over the `count` so far.
fn index(line: &Line<'_>, corner: &str, word: &str, count: usize) -> Result<u32, Error> {
    let number: i64 = word.parse().map_err(|_| {
        let what = format!("a face has the corner {}", quoted(corner));
        line.error(what, "write v, v/vt, v//vn or v/vt/vn")
    })?;
    let index = if number < 0 { number + count as i64 } else { number - 1 };
    u32::try_from(index).map_err(|_| {
        let what = format!("a face has the index {number}, and {count} lie before it");
        line.error(what, "count from 1, or from -1 backwards")
    })
}
