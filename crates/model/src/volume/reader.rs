//! Which file is read how.

use std::path::Path;

use glam::DVec3;

use super::encoding::{Encoding, Format};
use super::error::bytes_of;
use super::{Fault, Layout, ReadError, Volume, inrimage, metaimage, nifti, nrrd, volpack};

/// The scale of values that are the samples.
pub(super) const UNSCALED: [f64; 2] = [1.0, 0.0];

/// What a header says.
pub(super) struct Header<'a> {
    pub(super) format: Format,
    pub(super) spacing: DVec3,
    pub(super) origin: DVec3,
    /// Slope and intercept of the values over the samples.
    pub(super) scale: [f64; 2],
    pub(super) data: Data<'a>,
}

/// Where the samples are.
pub(super) enum Data<'a> {
    /// In the same file.
    Here(&'a [u8]),
    /// In another file, named relative to the header's.
    Beside(String),
    /// At the end of those bytes of another file.
    AtEndOf(String),
}

impl Volume {
    /// The volume in a file, read as its name ends: see the [module](super).
    ///
    /// # Errors
    /// If the file cannot be read, its name ends otherwise, or its contents are not what its format asks for.
    /// The message says what to do.
    pub fn read(file: &Path) -> Result<Self, ReadError> {
        let name = file.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let ends = |ending: &str| name.ends_with(ending);
        let fault = |fault| ReadError::data(file, fault);
        if ends(".raw") || ends(".raw.gz") {
            let layout = Layout::of_name(&name).map_err(fault)?;
            return Self::read_raw(file, &layout);
        }
        let parse = match () {
            () if ends(".mhd") || ends(".mha") => metaimage::parse,
            () if ends(".nrrd") || ends(".nhdr") => nrrd::parse,
            () if ends(".nii") => nifti::parse,
            () if ends(".den") => volpack::parse,
            () if ends(".inr") => inrimage::parse,
            () if ends(".nii.gz") => {
                let bytes = nifti::unpacked(&bytes_of(file)?).map_err(fault)?;
                return nifti::parse(&bytes).and_then(|header| header.volume(&[])).map_err(fault);
            }
            () => {
                return Err(fault(Fault::new(
                    "no volume has such a name; the name must end in .mhd, .mha, .nrrd, .nhdr, .nii, .nii.gz, \
                     .den, .inr, .raw or .raw.gz",
                )));
            }
        };
        let bytes = bytes_of(file)?;
        let header = parse(&bytes).map_err(fault)?;
        match &header.data {
            Data::Here(_) => header.volume(&[]).map_err(fault),
            Data::Beside(name) | Data::AtEndOf(name) => {
                let other = file.with_file_name(name);
                // The mistake is as likely in the header: both are named.
                let data = bytes_of(&other).map_err(|cause| {
                    fault(Fault::new(format!("its samples are not there: {cause}")))
                })?;
                header.volume(&data).map_err(|cause| {
                    fault(Fault::new(format!("with its samples in {}: {cause}", other.display())))
                })
            }
        }
    }

    /// The volume in a file of samples alone, packed by gzip if its name ends in `.gz`.
    ///
    /// # Errors
    /// If the file cannot be read, or has more or fewer bytes than the layout.
    pub fn read_raw(file: &Path, layout: &Layout) -> Result<Self, ReadError> {
        let is_packed = file.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz"));
        let encoding = if is_packed { Encoding::Gzip } else { Encoding::Raw };
        let Layout { size, sample, order, skip, spacing, origin } = *layout;
        let format = Format { size, sample, order, encoding };
        let values = format.decode(&bytes_of(file)?, skip);
        let volume = values.and_then(|values| Self::new(size, spacing, origin, values));
        volume.map_err(|fault| ReadError::data(file, fault))
    }
}

impl Header<'_> {
    /// The volume, with the bytes of the other file if there is one.
    pub(super) fn volume(&self, other: &[u8]) -> Result<Volume, Fault> {
        let (packed, skip) = match &self.data {
            Data::Here(bytes) => (*bytes, 0),
            Data::Beside(_) => (other, 0),
            Data::AtEndOf(_) => (other, other.len().saturating_sub(self.format.bytes()?)),
        };
        let mut values = self.format.decode(packed, skip)?;
        let [slope, intercept] = self.scale;
        if self.scale != UNSCALED {
            for value in &mut values {
                *value = (slope * f64::from(*value) + intercept) as f32;
            }
        }
        Volume::new(self.format.size, self.spacing, self.origin, values)
    }
}
