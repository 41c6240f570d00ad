//! What files end in.

use flate2::Crc;

/// The CRC-32 (IEEE) of bytes.
pub(crate) fn checksum(bytes: &[u8]) -> u32 {
    let mut crc = Crc::new();
    crc.update(bytes);
    crc.sum()
}
