//! How the bytes of samples are packed.

use std::borrow::Cow;
use std::io::Read;

use flate2::read::{MultiGzDecoder, ZlibDecoder};

use super::{ByteOrder, Fault, Sample, error, sample};

/// The most bytes that a byte of a deflate stream can stand for, rounded up: 258 for every two bits.
const MOST_INFLATION: usize = 1032;

/// How samples are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Raw,
    Gzip,
    Zlib,
    Text,
}

/// What a header says of the samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Format {
    pub(super) size: [usize; 3],
    pub(super) sample: Sample,
    pub(super) order: ByteOrder,
    pub(super) encoding: Encoding,
}

impl Format {
    /// The bytes that the samples have when unpacked.
    pub(super) fn bytes(&self) -> Result<usize, Fault> {
        Ok(error::samples(self.size)? * self.sample.width())
    }

    /// The samples, after `skip` unpacked bytes.
    pub(super) fn decode(&self, packed: &[u8], skip: usize) -> Result<Vec<f32>, Fault> {
        let count = error::samples(self.size)?;
        if self.encoding == Encoding::Text {
            return sample::parse(packed.get(skip..).unwrap_or(&[]), count);
        }
        let wanted = self.bytes()?.checked_add(skip).ok_or_else(|| {
            Fault::new(format!(
                "{skip} bytes to skip are more than any file has; correct the header"
            ))
        })?;
        let bytes = unpacked(self.encoding, packed, wanted)?;
        if bytes.len() != wanted {
            let size = error::shown(self.size);
            let (sample, width) = (self.sample, self.sample.width());
            let what = format!("the size of {size} asks for {}", wanted - skip);
            let what = format!("{what} ({width} for each sample, {sample:?})");
            return Err(Fault::new(match bytes.len() {
                found if found < wanted => format!(
                    "{} bytes of samples, but {what}; the file is cut off, or its header is wrong",
                    found.saturating_sub(skip)
                ),
                _ => format!(
                    "more bytes of samples than there should be: {what}; correct the size or the type"
                ),
            }));
        }
        Ok(self.sample.decode(self.order, &bytes[skip..]))
    }
}

/// The unpacked bytes: all of them if there are no more than `wanted`, else at least one more than that.
pub(super) fn unpacked(
    encoding: Encoding,
    packed: &[u8],
    wanted: usize,
) -> Result<Cow<'_, [u8]>, Fault> {
    if matches!(encoding, Encoding::Raw | Encoding::Text) {
        return Ok(Cow::Borrowed(packed));
    }
    if wanted > packed.len().saturating_mul(MOST_INFLATION) {
        return Err(Fault::new(format!(
            "{} packed bytes cannot hold the {wanted} that the header asks for; \
             the file is cut off, or its header is wrong",
            packed.len()
        )));
    }
    start(encoding, packed, wanted.saturating_add(1)).map(Cow::Owned)
}

/// The first unpacked bytes, at most so many.
pub(super) fn start(encoding: Encoding, packed: &[u8], most: usize) -> Result<Vec<u8>, Fault> {
    let mut reader: Box<dyn Read + '_> = match encoding {
        Encoding::Raw | Encoding::Text => Box::new(packed),
        Encoding::Gzip => Box::new(MultiGzDecoder::new(packed)),
        Encoding::Zlib => Box::new(ZlibDecoder::new(packed)),
    };
    let mut bytes = Vec::new();
    match reader.by_ref().take(most as u64).read_to_end(&mut bytes) {
        Ok(_) => Ok(bytes),
        Err(error) => Err(Fault::new(format!(
            "unpacking failed after {} bytes ({error}); the file is damaged or cut off, fetch it again",
            bytes.len()
        ))),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    fn format(size: [usize; 3], encoding: Encoding) -> Format {
        Format { size, sample: Sample::U8, order: ByteOrder::Little, encoding }
    }

    #[test]
    fn no_more_is_unpacked_than_asked_for() {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(&vec![0; 1 << 24]).unwrap();
        let bomb = encoder.finish().unwrap();
        assert_eq!(unpacked(Encoding::Gzip, &bomb, 1000).unwrap().len(), 1001);
        let refused = |size, packed: &[u8]| {
            format(size, Encoding::Gzip).decode(packed, 0).unwrap_err().to_string()
        };
        assert!(refused([10, 10, 10], &bomb).contains("more bytes"));
        assert!(refused([1 << 10; 3], &bomb).contains("cannot hold"));
        assert!(refused([1 << 8; 3], &bomb[..bomb.len() - 10]).contains("unpacking failed after"));
        assert!(format([1 << 8; 3], Encoding::Gzip).decode(&bomb, 0).is_ok());
    }

    #[test]
    fn what_is_missing_is_counted() {
        let format = format([2, 2, 2], Encoding::Raw);
        assert_eq!(format.decode(&[9; 11], 3).unwrap(), [9.0; 8]);
        let said = |bytes: &[u8], skip| format.decode(bytes, skip).unwrap_err().to_string();
        assert!(
            said(&[9; 10], 3)
                .starts_with("7 bytes of samples, but the size of 2 x 2 x 2 asks for 8")
        );
        assert!(said(&[9; 12], 3).starts_with("more bytes"));
        assert!(said(&[], usize::MAX).contains("skip"));
        assert!(said(&[], 3).starts_with("0 bytes"));
    }
}
