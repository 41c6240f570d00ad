//! The ordinates of a cube from its 27 samples.
//!
//! The ordinate b(p, q) of two corners p and q of a tetrahedron stands at their middle. A cube has 65 such
//! places; in quarters of its side they are p + q, with coordinates from -2 to 2. All weights are at least 0
//! and add up to 1. The sums run over samples in the order of the volume, so that cubes that share a place
//! round its ordinate alike.

use super::sector::Sector;

/// Places of ordinates in a cube.
pub(super) const PLACES: usize = 65;

/// Samples of a cube and its neighbours, with x fastest.
pub(super) const SAMPLES: usize = 27;

/// No mask has more samples.
const MOST_TAPS: usize = 10;

/// The weights of one ordinate.
#[derive(Clone, Copy)]
struct Mask {
    taps: [(u8, f64); MOST_TAPS],
    length: usize,
}

/// The number of a place that has no ordinate.
const NOWHERE: u8 = u8::MAX;

static TABLE: ([Mask; PLACES], [u8; 125]) = table();

const fn table() -> ([Mask; PLACES], [u8; 125]) {
    let mut masks = [Mask { taps: [(0, 0.0); MOST_TAPS], length: 0 }; PLACES];
    let mut numbers = [NOWHERE; 125];
    let (mut found, mut i) = (0, 0);
    while i < 125 {
        let place = [i as i32 % 5 - 2, i as i32 / 5 % 5 - 2, i as i32 / 25 - 2];
        if let Some(mask) = mask(place) {
            masks[found] = mask;
            numbers[i] = found as u8;
            found += 1;
        }
        i += 1;
    }
    assert!(found == PLACES, "a place is missing");
    (masks, numbers)
}

const fn mask(place: [i32; 3]) -> Option<Mask> {
    let mut mask = Mask { taps: [(0, 0.0); MOST_TAPS], length: 0 };
    let (mut sum, mut s) = (0, 0);
    while s < SAMPLES {
        let sample = [s as i32 % 3 - 1, s as i32 / 3 % 3 - 1, s as i32 / 9 - 1];
        let Some(weight) = sixteenths(place, sample) else { return None };
        if weight > 0 {
            mask.taps[mask.length] = (s as u8, weight as f64 / 16.0);
            mask.length += 1;
            sum += weight;
        }
        s += 1;
    }
    assert!(sum == 16, "weights add up to 1");
    Some(mask)
}

/// The weight of a sample, in steps from the cube's own, at a place.
///
/// With f0 the cube's sample, f_i its neighbours:
///
/// | ordinate | at | is |
/// |---|---|---|
/// | b(v0, v0) | (0, 0, 0) | f0/4 + (six neighbours)/8 |
/// | b(v0, v1) | (1, 0, 0) | (f0 + f1)/4 + (four neighbours beside)/8, with f1 across the face of v1 |
/// | b(v0, v2) | (1, 1, 1) | (f0 + three neighbours towards v2)/4 |
/// | b(v1, v1) | (2, 0, 0) | mean over the two cubes at the face of f/2 + (four neighbours beside)/8 |
/// | b(v1, v2) | (2, 1, 1) | mean over the two cubes of f/2 + (two neighbours beside, towards v2)/4 |
/// | b(v2, v2) | (2, 2, 2) | mean of the eight cubes at the corner |
/// | b(v2, v3) | (2, 2, 0) | mean of the four cubes at the edge |
const fn sixteenths(place: [i32; 3], sample: [i32; 3]) -> Option<i32> {
    // Axes along which the place is shared with the next cube, and those along which it lies half way there.
    let (mut shared, mut half) = (0, 0);
    let mut axis = 0;
    while axis < 3 {
        match place[axis] {
            -2 | 2 => shared += 1,
            -1 | 1 => half += 1,
            _ => {}
        }
        axis += 1;
    }
    // The weight of a step along an axis, and whether the sample lies outside the mask.
    let (mut steps, mut weight, mut is_outside) = (0, 4, false);
    axis = 0;
    while axis < 3 {
        let (p, s) = (place[axis], sample[axis]);
        axis += 1;
        if s == 0 || (p.abs() == 2 && 2 * s == p) {
            continue;
        }
        if p.abs() == 2 || shared >= 2 {
            is_outside = true;
            continue;
        }
        steps += 1;
        weight = match (shared, half) {
            (0, 0) => 2,
            (0, 1) if p == 0 => 2,
            (1, 0) => 1,
            _ if s != p => 0,
            (0, _) => 4,
            _ => 2,
        };
    }
    if steps > 1 || is_outside {
        weight = 0;
    }
    match (shared, half) {
        (0 | 1, 0) | (0, 1 | 3) | (1, 2) | (2, 0) => Some(weight),
        (3, 0) => Some(weight / 2),
        _ => None,
    }
}

/// All ordinates of a cube.
pub(super) struct Ordinates([f64; PLACES]);

impl Ordinates {
    /// From the samples of the cube and its neighbours.
    pub(super) fn new(samples: &[f32; SAMPLES]) -> Self {
        Self(TABLE.0.map(|mask| {
            let taps = &mask.taps[..mask.length];
            taps.iter().map(|(s, weight)| weight * f64::from(samples[usize::from(*s)])).sum()
        }))
    }

    /// Those of a tetrahedron, in the order of [`PAIRS`].
    pub(super) fn of(&self, sector: Sector) -> [f64; 10] {
        let corners = sector.corners();
        PAIRS.map(|[p, q]| {
            let [x, y, z] =
                [0, 1, 2].map(|axis| (corners[p][axis] + corners[q][axis] + 2) as usize);
            self.0[usize::from(TABLE.1[x + 5 * y + 25 * z])]
        })
    }
}

/// The corners p and q of the ordinates b(p, q) of a tetrahedron.
pub(super) const PAIRS: [[usize; 2]; 10] =
    [[0, 0], [1, 1], [2, 2], [3, 3], [0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

#[cfg(test)]
mod tests {
    use super::*;

    /// The weight of each sample at a place, in sixteenths.
    fn weights(place: [i32; 3]) -> Vec<([i32; 3], f64)> {
        let mask = mask(place).unwrap();
        let taps = mask.taps[..mask.length].iter();
        taps.map(|(s, weight)| {
            let s = i32::from(*s);
            ([s % 3 - 1, s / 3 % 3 - 1, s / 9 - 1], 16.0 * weight)
        })
        .collect()
    }

    #[test]
    fn masks_are_those_of_the_table() {
        assert_eq!(
            weights([0, 0, -1]),
            [
                ([0, 0, -1], 4.0),
                ([0, -1, 0], 2.0),
                ([-1, 0, 0], 2.0),
                ([0, 0, 0], 4.0),
                ([1, 0, 0], 2.0),
                ([0, 1, 0], 2.0),
            ]
        );
        assert_eq!(
            weights([1, -1, 1]),
            [([0, -1, 0], 4.0), ([0, 0, 0], 4.0), ([1, 0, 0], 4.0), ([0, 0, 1], 4.0)]
        );
        assert_eq!(
            weights([-1, 2, 1]),
            [
                ([-1, 0, 0], 2.0),
                ([0, 0, 0], 4.0),
                ([-1, 1, 0], 2.0),
                ([0, 1, 0], 4.0),
                ([0, 0, 1], 2.0),
                ([0, 1, 1], 2.0),
            ]
        );
        assert_eq!(
            weights([0, 2, -2]),
            [([0, 0, -1], 4.0), ([0, 1, -1], 4.0), ([0, 0, 0], 4.0), ([0, 1, 0], 4.0)]
        );
        assert_eq!([weights([0, 0, 0]).len(), weights([2, 0, 0]).len()], [7, 10]);
        assert!(
            weights([2, 2, 2])
                .iter()
                .all(|(s, weight)| s.iter().all(|c| *c >= 0) && *weight == 2.0)
        );
        assert!(mask([1, 1, 0]).is_none() && mask([2, 1, 0]).is_none());
    }

    #[test]
    fn each_tetrahedron_has_its_ten_places() {
        let mut seen = [0; PLACES];
        for sector in Sector::all() {
            let corners = sector.corners();
            for [p, q] in PAIRS {
                let sum = [0, 1, 2].map(|axis| (corners[p][axis] + corners[q][axis] + 2) as usize);
                seen[usize::from(TABLE.1[sum[0] + 5 * sum[1] + 25 * sum[2]])] += 1;
            }
        }
        assert!(seen.iter().all(|n| *n > 0));
        assert_eq!(seen.iter().sum::<usize>(), 240);
    }
}
