//! Volumes: samples on a rectangular grid, from files and from formulas.
//!
//! | format | names | encodings |
//! |---|---|---|
//! | samples alone | `.raw`, `.raw.gz` | raw, gzip; the layout is in the name or given |
//! | MetaImage | `.mhd`, `.mha` | raw, zlib, ASCII |
//! | NRRD | `.nrrd`, `.nhdr` | raw, gzip, ASCII |
//! | NIfTI-1 | `.nii`, `.nii.gz` | raw, gzip |
//! | VolPack | `.den` | raw |
//! | INRIMAGE | `.inr` | raw |
//!
//! Axes are those of the samples: directions that a header gives to them are not used. Samples become `f32`,
//! rounded where they have more digits. No size is believed before the data are there.

mod encoding;
mod error;
mod header;
mod inrimage;
mod metaimage;
mod nifti;
mod nrrd;
mod raw;
mod reader;
mod sample;
mod signal;
mod volpack;

use glam::DVec3;

pub(crate) use error::bytes_of;
pub use error::{Fault, ReadError};
pub use raw::Layout;
pub use sample::{ByteOrder, Sample};
pub use signal::{marschner_lobb, marschner_lobb_gradient};

/// The most samples of a volume: 2^30, 4 GiB.
pub const MOST_SAMPLES: usize = 1 << 30;

/// The least and the greatest spacing. Rays are of single precision; squares of these stay in its range.
const SPACINGS: [f64; 2] = [1e-18, 1e18];

/// How many times its spacing a volume may lie from the origin.
const FARTHEST: f64 = 1e6;

/// Samples f_ijk at origin + (i, j, k) spacing, with i fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    size: [usize; 3],
    spacing: DVec3,
    origin: DVec3,
    values: Vec<f32>,
}

/// How many samples a grid has, if it is one that a volume can have.
pub(crate) fn check_grid(size: [usize; 3], spacing: DVec3, origin: DVec3) -> Result<usize, Fault> {
    let count = error::samples(size)?;
    let [least, most] = SPACINGS;
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let (step, start) = (spacing[axis], origin[axis]);
        if !(step >= least && step <= most) {
            return Err(Fault::new(format!(
                "the spacing {step} along {name} is not between {least:e} and {most:e}; scale the grid"
            )));
        }
        if !(start.abs() <= FARTHEST * step) {
            return Err(Fault::new(format!(
                "the origin {start} along {name} is not within {FARTHEST:e} times the spacing {step}; \
                 move the grid"
            )));
        }
    }
    Ok(count)
}

impl Volume {
    /// A volume of these samples, with x fastest.
    ///
    /// # Errors
    /// If a size is 0 or there are too many samples, their count is another than that of the size, or the grid
    /// is not finite, too coarse, too fine, or far from the origin.
    pub fn new(
        size: [usize; 3],
        spacing: DVec3,
        origin: DVec3,
        values: Vec<f32>,
    ) -> Result<Self, Fault> {
        let count = check_grid(size, spacing, origin)?;
        if values.len() != count {
            return Err(Fault::new(format!(
                "{} samples for a size of {}, which takes {count}; correct the size",
                values.len(),
                error::shown(size)
            )));
        }
        Ok(Self { size, spacing, origin, values })
    }

    /// Samples of a function on a grid that has its first sample at `min` and its last at `max`.
    ///
    /// # Errors
    /// As for [`Volume::new`], and if a size is below 2.
    pub fn sampled(
        size: [usize; 3],
        [min, max]: [DVec3; 2],
        function: impl Fn(DVec3) -> f64,
    ) -> Result<Self, Fault> {
        let count = error::samples(size)?;
        if size.contains(&1) {
            return Err(Fault::new(format!(
                "a size of {} has no spacing; take at least 2 samples along each axis",
                error::shown(size)
            )));
        }
        let steps = DVec3::from(size.map(|n| (n - 1) as f64));
        let mut values = Vec::with_capacity(count);
        for k in 0..size[2] {
            for j in 0..size[1] {
                for i in 0..size[0] {
                    // Symmetric grids get symmetric samples: each end has its part.
                    let at = DVec3::from([i, j, k].map(|n| n as f64));
                    values.push(function((min * (steps - at) + max * at) / steps) as f32);
                }
            }
        }
        Self::new(size, (max - min) / steps, min, values)
    }

    /// The number of samples along x, y and z.
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// The distance between samples along x, y and z.
    pub fn spacing(&self) -> DVec3 {
        self.spacing
    }

    /// Where the first sample lies.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The samples, with x fastest.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The least and the greatest sample that is finite, if any is.
    pub fn range(&self) -> Option<[f32; 2]> {
        let finite = self.values.iter().copied().filter(|v| v.is_finite());
        finite.fold(None, |range, v| {
            let [least, most] = range.unwrap_or([v; 2]);
            Some([least.min(v), most.max(v)])
        })
    }

    /// The same grid with other samples.
    pub(crate) fn with_values(&self, values: Vec<f32>) -> Self {
        debug_assert_eq!(values.len(), self.values.len());
        Self { values, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_volume_is_what_it_says() {
        let values: Vec<f32> = (0..24).map(|v| v as f32).collect();
        let new = |size, spacing: f64, origin: f64, values: &[f32]| {
            Volume::new(size, DVec3::splat(spacing), DVec3::splat(origin), values.to_vec())
        };
        let volume = new([2, 3, 4], 0.5, -1.0, &values).unwrap();
        assert_eq!(volume.range(), Some([0.0, 23.0]));
        for (refused, why) in [
            (
                new([2, 3, 5], 0.5, -1.0, &values),
                "24 samples for a size of 2 x 3 x 5, which takes 30",
            ),
            (new([2, 0, 4], 0.5, -1.0, &values), "size"),
            (new([usize::MAX, 3, 4], 0.5, -1.0, &values), "most"),
            (new([2, 3, 4], 0.0, -1.0, &values), "spacing 0 along x"),
            (new([2, 3, 4], f64::NAN, -1.0, &values), "spacing NaN"),
            (new([2, 3, 4], 0.5, 1e6, &values), "origin"),
            (new([2, 3, 4], 0.5, f64::NAN, &values), "origin"),
        ] {
            let said = refused.unwrap_err().to_string();
            assert!(said.contains(why), "{said}");
        }
        let holes = [f32::NAN, 3.0, f32::INFINITY, -1.0];
        assert_eq!(new([4, 1, 1], 1.0, 0.0, &holes).unwrap().range(), Some([-1.0, 3.0]));
        assert_eq!(new([1, 1, 1], 1.0, 0.0, &[f32::NAN]).unwrap().range(), None);
    }
}
