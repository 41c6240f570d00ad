//! What a file says, and what of it can be used.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt;

use glam::DVec3;

use super::estimate::estimated;
use super::faces::Faces;
use super::{Cloud, Error, Place};

/// Diagonals between which products of a few lengths neither vanish nor overflow.
const DIAGONALS: [f64; 2] = [1e-60, 1e60];

/// Points as a file says them.
#[derive(Clone, Debug, Default)]
pub(super) struct Raw {
    pub(super) points: Vec<DVec3>,
    /// As many, of any length.
    pub(super) normals: Option<Vec<DVec3>>,
    /// Between points that there are.
    pub(super) faces: Faces,
}

/// Points that were left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dropped {
    /// A coordinate or the normal is infinite or not a number.
    pub not_finite: usize,
    /// Another point before it is at the same place.
    pub duplicates: usize,
    /// The normal's length is 0, or no face has the point.
    pub without_normal: usize,
}

impl Dropped {
    /// All of them.
    pub fn total(&self) -> usize {
        self.not_finite + self.duplicates + self.without_normal
    }
}

impl fmt::Display for Dropped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all = [
            (self.not_finite, "not finite"),
            (self.duplicates, "duplicates"),
            (self.without_normal, "without a normal"),
        ];
        let said = all.iter().filter(|(count, _)| *count > 0);
        let said: Vec<_> = said.map(|(count, why)| format!("{count} {why}")).collect();
        match self.total() {
            0 => write!(f, "no points dropped"),
            1 => write!(f, "1 point dropped: {}", said.join(", ")),
            total => write!(f, "{total} points dropped: {}", said.join(", ")),
        }
    }
}

impl Raw {
    /// Drops what cannot be used, and finds normals if there are none.
    pub(super) fn cloud(self, file: &str) -> Result<(Cloud, Dropped), Error> {
        let Self { points, normals, faces } = self;
        let mut dropped = Dropped::default();
        let names = firsts(&points);
        let mut kept = Vec::new();
        for (i, &first) in names.iter().enumerate() {
            let normal = normals.as_ref().map_or(DVec3::ZERO, |normals| normals[i]);
            match () {
                () if !(points[i].is_finite() && normal.is_finite()) => dropped.not_finite += 1,
                () if first as usize != i => dropped.duplicates += 1,
                () => kept.push(i),
            }
        }
        let mut cloud =
            Cloud { points: kept.iter().map(|&i| points[i]).collect(), normals: vec![] };
        if kept.len() >= 2 {
            let diagonal = cloud.diagonal();
            if !(DIAGONALS[0]..=DIAGONALS[1]).contains(&diagonal) {
                let [least, most] = DIAGONALS;
                let what = format!("the box of the points has the diagonal {diagonal:e}");
                let remedy = format!("scale the points to between {least:e} and {most:e}");
                return Err(Error::new(file, Place::Whole, what, remedy));
            }
        }
        let all = match normals {
            Some(normals) => Some(normals),
            None if faces.is_empty() => None,
            // Faces at duplicates count for the first.
            None => Some(faces.renamed(&names).normals(&points)),
        };
        match all {
            Some(all) => {
                let pairs = kept.iter().map(|&i| (points[i], unit(all[i])));
                let pairs: Vec<_> = pairs.filter(|(_, n)| *n != DVec3::ZERO).collect();
                dropped.without_normal = kept.len() - pairs.len();
                (cloud.points, cloud.normals) = pairs.into_iter().unzip();
            }
            None => cloud.normals = estimated(&cloud.points),
        }
        if cloud.points.len() < 2 {
            let some = if cloud.points.is_empty() { "none" } else { "only one" };
            let what = format!("of {} points {some} can be used ({dropped})", points.len());
            return Err(Error::new(file, Place::Whole, what, "a surface needs two at least"));
        }
        Ok((cloud, dropped))
    }
}

/// For each point the first that is at the same place.
fn firsts(points: &[DVec3]) -> Vec<u32> {
    let mut seen = HashMap::with_capacity(points.len());
    let place = |(i, p): (usize, &DVec3)| {
        // Adding 0 takes the sign of -0.
        match seen.entry((p + 0.0).to_array().map(f64::to_bits)) {
            Entry::Occupied(first) => *first.get(),
            Entry::Vacant(free) => *free.insert(i as u32),
        }
    };
    points.iter().enumerate().map(place).collect()
}

/// The vector at length 1, or 0 if it has none. Scaled first: squares of small numbers vanish.
fn unit(v: DVec3) -> DVec3 {
    let size = v.abs().max_element();
    if size > 0.0 && size.is_finite() { (v / size).normalize_or_zero() } else { DVec3::ZERO }
}
