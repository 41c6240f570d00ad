//! Files of samples alone.

use glam::DVec3;

use super::{ByteOrder, Fault, Sample, error};

/// How the samples lie in a file that does not say it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// The number of samples along x, y and z; x is the fastest.
    pub size: [usize; 3],
    /// Their type.
    pub sample: Sample,
    /// The order of their bytes.
    pub order: ByteOrder,
    /// How many bytes come before them, unpacked.
    pub skip: usize,
    /// The distance between samples.
    pub spacing: DVec3,
    /// Where the first lies.
    pub origin: DVec3,
}

/// Names of types, with the order of bytes where it is part of the name.
const TYPES: [(&str, Sample); 24] = [
    ("u8", Sample::U8),
    ("uint8", Sample::U8),
    ("uchar", Sample::U8),
    ("i8", Sample::I8),
    ("int8", Sample::I8),
    ("u16", Sample::U16),
    ("uint16", Sample::U16),
    ("ushort", Sample::U16),
    ("i16", Sample::I16),
    ("int16", Sample::I16),
    ("short", Sample::I16),
    ("u32", Sample::U32),
    ("uint32", Sample::U32),
    ("uint", Sample::U32),
    ("i32", Sample::I32),
    ("int32", Sample::I32),
    ("int", Sample::I32),
    ("f32", Sample::F32),
    ("float32", Sample::F32),
    ("float", Sample::F32),
    ("f64", Sample::F64),
    ("float64", Sample::F64),
    ("double", Sample::F64),
    ("char", Sample::I8),
];

impl Layout {
    /// Samples of this type, little-endian, at distances of 1 from the origin, with nothing before them.
    pub fn new(size: [usize; 3], sample: Sample) -> Self {
        let (order, skip) = (ByteOrder::Little, 0);
        Self { size, sample, order, skip, spacing: DVec3::ONE, origin: DVec3::ZERO }
    }

    /// The layout that a name tells: `fuel_64x64x64_uint8.raw`, `x_64x64x64_f32be.raw.gz`.
    ///
    /// # Errors
    /// If it has no size or no type.
    pub fn of_name(name: &str) -> Result<Self, Fault> {
        let words = || name.split(['_', '.', '-', ' ']);
        let size = words().find_map(|word| {
            let sizes: Vec<usize> = word.split('x').map_while(|n| n.parse().ok()).collect();
            <[usize; 3]>::try_from(sizes).ok().filter(|_| word.matches('x').count() == 2)
        });
        let sample = words().find_map(|word| {
            let (word, order) = match word.strip_suffix("be") {
                Some(word) => (word, ByteOrder::Big),
                None => (word.strip_suffix("le").unwrap_or(word), ByteOrder::Little),
            };
            // The name of a type may end in these letters itself.
            let full = if word == "doub" { "double" } else { word };
            TYPES.iter().find(|(name, _)| *name == full).map(|(_, sample)| (*sample, order))
        });
        let (Some(size), Some((sample, order))) = (size, sample) else {
            return Err(Fault::new(
                "samples alone say neither their size nor their type; give a layout, \
                 or name the file like fuel_64x64x64_u8.raw",
            ));
        };
        error::samples(size)?;
        Ok(Self { order, ..Self::new(size, sample) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_layouts() {
        let big = Layout { order: ByteOrder::Big, ..Layout::new([4, 5, 6], Sample::U16) };
        for (name, layout) in [
            ("fuel_64x64x64_uint8.raw", Layout::new([64; 3], Sample::U8)),
            ("my-fox_4x5x6_u16be.raw.gz", big),
            ("a.1x2x3.float32le.raw", Layout::new([1, 2, 3], Sample::F32)),
            ("a.1x2x3.double.raw", Layout::new([1, 2, 3], Sample::F64)),
        ] {
            assert_eq!(Layout::of_name(name), Ok(layout), "{name}");
        }
        for name in
            ["fuel.raw", "a_64x64_u8.raw", "a_64x64x64.raw", "a_1x2x3x4_u8.raw", "a_0x1x1_u8.raw"]
        {
            Layout::of_name(name).unwrap_err();
        }
    }
}
