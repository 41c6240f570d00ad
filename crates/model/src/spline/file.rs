//! Files of tetrahedra: `docs/tets-file.md`.

use std::path::Path;

use glam::DVec3;

use super::lattice::Lattice;
use super::mask::SAMPLES;
use super::sector::SECTORS;
use super::tets::Cell;
use super::{Outside, Tets};
use crate::checksum::checksum;
use crate::volume::{Fault, ReadError, bytes_of, check_grid};

/// The first byte is none of text; line ends show a transfer that changes them.
const MAGIC: &[u8; 8] = b"\x89TETS\r\n\x1a";

const VERSION: u32 = 1;

/// Bytes of the header.
const HEADER: usize = 104;

/// Bytes of a cube.
const CUBE: usize = 4 + 4 + 4 * SAMPLES;

/// Bytes of the checksum.
const CHECKSUM: usize = 4;

/// Little-endian numbers one after the other.
struct Numbers<'a>(&'a [u8]);

impl Numbers<'_> {
    /// The next `N` bytes, which must be there.
    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        let (bytes, rest) = self.0.split_first_chunk().expect("lengths were checked");
        self.0 = rest;
        *bytes
    }

    fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.bytes())
    }

    fn u64(&mut self) -> u64 {
        u64::from_le_bytes(self.bytes())
    }

    fn f32(&mut self) -> f32 {
        f32::from_le_bytes(self.bytes())
    }

    fn f64(&mut self) -> f64 {
        f64::from_le_bytes(self.bytes())
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.f64(), self.f64(), self.f64())
    }
}

fn damaged(what: &str) -> Fault {
    Fault::new(format!("{what}; the file is damaged, make it again"))
}

impl Tets {
    /// The bytes of a `.tets` file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(HEADER + CUBE * self.cells.len() + CHECKSUM);
        bytes.extend(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        let outside: u32 = match self.outside {
            Outside::Below => 0,
            Outside::Above => 1,
        };
        bytes.extend(outside.to_le_bytes());
        let Lattice { size, spacing, origin, .. } = self.lattice;
        for n in size {
            bytes.extend((n as u32).to_le_bytes());
        }
        bytes.extend((self.cells.len() as u32).to_le_bytes());
        for number in [spacing.to_array(), origin.to_array()].as_flattened() {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend(self.isovalue.to_le_bytes());
        bytes.extend(self.dropped.to_le_bytes());
        bytes.extend((self.len() as u64).to_le_bytes());
        debug_assert_eq!(bytes.len(), HEADER);
        for Cell { number, sectors, samples } in &self.cells {
            bytes.extend(number.to_le_bytes());
            bytes.extend(sectors.to_le_bytes());
            for sample in samples {
                bytes.extend(sample.to_le_bytes());
            }
        }
        let checksum = checksum(&bytes);
        bytes.extend(checksum.to_le_bytes());
        bytes
    }

    /// The tetrahedra in a `.tets` file.
    ///
    /// # Errors
    /// If the file cannot be read, is of another version, or is damaged.
    pub fn read(file: &Path) -> Result<Self, ReadError> {
        Self::from_bytes(&bytes_of(file)?).map_err(|fault| ReadError::data(file, fault))
    }

    /// The tetrahedra in the bytes of a `.tets` file.
    ///
    /// # Errors
    /// If they are of another version or damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Fault> {
        if !bytes.starts_with(MAGIC) {
            return Err(Fault::new("the file does not start like a .tets file; name one"));
        }
        if bytes.len() < HEADER + CHECKSUM {
            return Err(damaged("the file is cut off in its header"));
        }
        let mut numbers = Numbers(&bytes[MAGIC.len()..]);
        let version = numbers.u32();
        if version != VERSION {
            return Err(Fault::new(format!(
                "the file is of version {version}; only {VERSION} is read, make it again"
            )));
        }
        let outside = numbers.u32();
        let size = [numbers.u32(), numbers.u32(), numbers.u32()].map(|n| n as usize);
        let cubes = numbers.u32() as usize;
        let expected = cubes as u128 * CUBE as u128 + (HEADER + CHECKSUM) as u128;
        if bytes.len() as u128 != expected {
            return Err(damaged(&format!(
                "{} bytes, but {cubes} cubes take {expected}",
                bytes.len()
            )));
        }
        let (content, sum) = bytes.split_at(bytes.len() - CHECKSUM);
        if sum != checksum(content).to_le_bytes() {
            return Err(damaged("the checksum is wrong"));
        }
        let outside = match outside {
            0 => Outside::Below,
            1 => Outside::Above,
            _ => return Err(damaged("the outside is neither below nor above")),
        };
        let (spacing, origin) = (numbers.vector(), numbers.vector());
        check_grid(size, spacing, origin)?;
        let (isovalue, dropped, count) = (numbers.f64(), numbers.u64(), numbers.u64());
        if !isovalue.is_finite() {
            return Err(damaged("the isovalue is not finite"));
        }
        let lattice = Lattice::new(size, spacing, origin);
        let mut cells = Vec::with_capacity(cubes);
        for _ in 0..cubes {
            let (number, sectors) = (numbers.u32(), numbers.u32());
            let cell = Cell { number, sectors, samples: std::array::from_fn(|_| numbers.f32()) };
            check(&cell, cells.last(), &lattice)?;
            cells.push(cell);
        }
        let tets = Self::new(lattice, isovalue, outside, dropped, cells);
        if tets.len() as u64 != count {
            return Err(damaged(&format!("{} tetrahedra, but {count} are told", tets.len())));
        }
        Ok(tets)
    }
}

fn check(cell: &Cell, before: Option<&Cell>, lattice: &Lattice) -> Result<(), Fault> {
    let number = cell.number;
    let is_inside = lattice.is_inside(lattice.cell(number as usize));
    if !is_inside || before.is_some_and(|before| before.number >= number) {
        return Err(damaged(&format!("cube {number} is in no place for one")));
    }
    if cell.sectors == 0 || cell.sectors >> SECTORS != 0 {
        return Err(damaged(&format!("cube {number} has tetrahedra that there are not")));
    }
    if !cell.samples.iter().all(|sample| sample.is_finite()) {
        return Err(damaged(&format!("cube {number} has samples that are not finite")));
    }
    Ok(())
}
