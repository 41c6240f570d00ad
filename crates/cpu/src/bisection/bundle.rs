//! Rays side by side.

use glam::{DVec3, Vec3};
use zeroset_raycast::{Domain, Ray};

use super::march::Marcher;

/// Rays in a bundle at most: as many as the widest packet has lanes.
pub(super) const SIZE: usize = 32;

/// Rays of a tile that are cut alike, in arrays by component, so that loops over them become vectors.
#[derive(Clone, Debug)]
pub(super) struct Bundle {
    count: usize,
    /// Indices in the tile.
    rays: [u32; SIZE],
    /// Components of origins, all of them finite.
    pub origin: [[f64; SIZE]; 3],
    /// Components of directions.
    pub direction: [[f64; SIZE]; 3],
    /// The range of t that contains all that count.
    pub range: [[f64; SIZE]; 2],
    /// How often pieces are bisected before they count as hit.
    pub depth: [u32; SIZE],
}

impl Bundle {
    /// No rays.
    pub(super) fn new() -> Self {
        Self {
            count: 0,
            rays: [0; SIZE],
            origin: [[0.0; SIZE]; 3],
            direction: [[1.0; SIZE]; 3],
            range: [[0.0; SIZE]; 2],
            depth: [0; SIZE],
        }
    }

    /// Takes neighbours in a tile, the first at this index, in place of its rays, and clips them to the
    /// domain: where a range ends before it starts, there is none. The places behind the last repeat
    /// its geometry.
    ///
    /// # Panics
    /// If there are none, or more than [`SIZE`].
    #[inline(always)]
    pub(super) fn clip(&mut self, lines: &[Ray], first: usize, domain: &Domain, range: [f64; 2]) {
        let mut padded = [lines[0]; SIZE];
        let whole: &[Ray; SIZE] = lines.try_into().unwrap_or_else(|_| {
            padded.fill(lines[lines.len() - 1]);
            padded[..lines.len()].copy_from_slice(lines);
            &padded
        });
        self.count = lines.len();
        for axis in 0..3 {
            let (origin, direction) = (&mut self.origin[axis], &mut self.direction[axis]);
            for i in 0..SIZE {
                origin[i] = f64::from(whole[i].origin[axis]);
                direction[i] = f64::from(whole[i].direction[axis]);
            }
        }
        for i in 0..SIZE {
            self.rays[i] = (first + i) as u32;
        }
        self.range = domain.outer(&self.origin, &self.direction, range);
    }

    /// How many rays.
    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// Adds a ray of another bundle.
    ///
    /// # Panics
    /// If it is full.
    #[inline(always)]
    pub(super) fn push(&mut self, from: &Self, i: usize) {
        let place = self.count;
        self.rays[place] = from.rays[i];
        for axis in 0..3 {
            self.origin[axis][place] = from.origin[axis][i];
            self.direction[axis][place] = from.direction[axis][i];
        }
        for end in 0..2 {
            self.range[end][place] = from.range[end][i];
        }
        self.count += 1;
    }

    /// Lets the places behind the last ray repeat its geometry.
    #[inline(always)]
    pub(super) fn fill(&mut self) {
        for place in self.count.max(1)..SIZE {
            let last = self.count.max(1) - 1;
            for axis in 0..3 {
                self.origin[axis][place] = self.origin[axis][last];
                self.direction[axis][place] = self.direction[axis][last];
            }
            for end in 0..2 {
                self.range[end][place] = self.range[end][last];
            }
        }
    }

    /// Its rays, so many at a time.
    pub(super) fn packets(&self, lanes: usize) -> impl Iterator<Item = Few<'_>> {
        (0..self.count).step_by(lanes).map(move |first| {
            let count = lanes.min(self.count - first);
            Few { bundle: self, first, count }
        })
    }
}

/// Some rays of a bundle, one a lane of a packet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Few<'a> {
    bundle: &'a Bundle,
    first: usize,
    count: usize,
}

impl<'a> Few<'a> {
    /// How many.
    #[inline(always)]
    pub(super) fn len(self) -> usize {
        self.count
    }

    /// What so many lanes read of an array of the bundle; those without a ray of their own may read that
    /// of another.
    #[inline(always)]
    pub(super) fn lanes<T>(
        self,
        of: impl Fn(&'a Bundle) -> &'a [T; SIZE],
        lanes: usize,
    ) -> &'a [T] {
        &of(self.bundle)[self.first..self.first + lanes]
    }

    /// How often the pieces of each ray are bisected.
    #[inline(always)]
    pub(super) fn depths(self) -> &'a [u32] {
        self.lanes(|bundle| &bundle.depth, self.count)
    }

    /// The index in the tile of the ray in a lane.
    #[inline(always)]
    pub(super) fn ray(self, lane: usize) -> usize {
        self.bundle.rays[self.first + lane] as usize
    }

    /// The ray in a lane.
    #[inline(always)]
    pub(super) fn marcher(self, lane: usize) -> Marcher {
        let (Bundle { origin, direction, range, .. }, i) = (self.bundle, self.first + lane);
        let at = |v: &[[f64; SIZE]; 3]| -> Vec3 {
            // Exact: they come from single precision.
            DVec3::new(v[0][i], v[1][i], v[2][i]).as_vec3()
        };
        Marcher {
            ray: self.ray(lane),
            line: Ray::new(at(origin), at(direction)),
            range: [range[0][i], range[1][i]],
        }
    }
}
