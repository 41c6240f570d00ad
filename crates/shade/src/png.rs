//! PNG files.

use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::{Picture, ShadeError};

/// The bytes with which every file starts.
pub(crate) const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";
/// The signature and the header, which must come first.
const HEAD: usize = SIGNATURE.len() + 25;
/// The longest data of a chunk.
pub(crate) const LONGEST: usize = i32::MAX as usize;

/// The bytes of a PNG file, with the picture's description as text. `path` is for messages.
pub(crate) fn encode(path: &Path, picture: &Picture) -> Result<Vec<u8>, ShadeError> {
    let (width, height) = (picture.width(), picture.height());
    let limit = "PNG holds at most 2147483647 pixels a side";
    let side = |n: usize| {
        i32::try_from(n).map(i32::unsigned_abs).map_err(|_| ShadeError::TooLarge {
            width,
            height,
            limit,
        })
    };
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive)
        .write_image(
            picture.pixels().as_flattened(),
            side(width)?,
            side(height)?,
            ExtendedColorType::Rgb8,
        )
        .map_err(|e| ShadeError::Encoding { path: path.into(), reason: e.to_string() })?;
    let mut notes = software();
    if !picture.description().is_empty() {
        notes.extend(text_chunk("Description", picture.description()));
    }
    bytes.splice(HEAD..HEAD, notes);
    Ok(bytes)
}

/// The program that made the file, as text.
pub(crate) fn software() -> Vec<u8> {
    text_chunk("Software", concat!("zeroset ", env!("CARGO_PKG_VERSION")))
}

/// International text (`iTXt`), not compressed, of no stated language.
fn text_chunk(keyword: &str, text: &str) -> Vec<u8> {
    // A zero would end the text for some readers.
    let text = text.replace('\0', " ");
    chunk(*b"iTXt", &[keyword.as_bytes(), &[0; 5], text.as_bytes()].concat())
}

/// A chunk: the length of the data, at most [`LONGEST`], the kind, the data, the checksum.
pub(crate) fn chunk(kind: [u8; 4], data: &[u8]) -> Vec<u8> {
    let body = [&kind, data].concat();
    let mut chunk = (data.len() as u32).to_be_bytes().to_vec();
    chunk.extend(&body);
    chunk.extend(checksum(&body).to_be_bytes());
    chunk
}

/// The chunks of a file by kind and data, as far as they are whole; none, if it is no PNG.
pub(crate) fn chunks(bytes: &[u8]) -> impl Iterator<Item = ([u8; 4], &[u8])> {
    let mut rest = bytes.strip_prefix(&SIGNATURE).unwrap_or_default();
    std::iter::from_fn(move || {
        let (length, tail) = rest.split_first_chunk()?;
        let (kind, tail) = tail.split_first_chunk()?;
        let length = u32::from_be_bytes(*length) as usize;
        let (data, tail) = tail.split_at_checked(length)?;
        let (code, tail) = tail.split_first_chunk()?;
        let body = &rest[4..8 + length];
        rest = tail;
        (checksum(body) == u32::from_be_bytes(*code)).then_some((*kind, data))
    })
}

/// The cyclic redundancy code of PNG: the polynomial 0xedb88320, least bit first.
fn checksum(bytes: &[u8]) -> u32 {
    let mut code = u32::MAX;
    for byte in bytes {
        code ^= u32::from(*byte);
        for _ in 0..8 {
            let bit = code & 1;
            code = (code >> 1) ^ (0xedb8_8320 * bit);
        }
    }
    !code
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_survives_the_round_trip() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/ramp.png");
        let mut picture = Picture::filled(7, 5, [10, 20, 30]).unwrap().described("a blot, 1\u{b5}");
        picture.fill([2, 1], [3, 2], [255, 128, 0]);
        picture.save_png(&path).unwrap();
        let read = image::open(&path).unwrap().into_rgb8();
        assert_eq!(read.dimensions(), (7, 5));
        assert_eq!(read.as_raw(), picture.pixels().as_flattened());
    }

    #[test]
    fn the_description_is_a_valid_chunk() {
        let text = "depth, t from 1 to 2";
        let picture = Picture::filled(1, 1, [0; 3]).unwrap().described(text);
        let bytes = encode(Path::new("x.png"), &picture).unwrap();
        let found: Vec<_> = chunks(&bytes).collect();
        assert_eq!(found[0].0, *b"IHDR");
        let description = [b"Description\0\0\0\0\0", text.as_bytes()].concat();
        assert_eq!(found[2], (*b"iTXt", &description[..]));
        assert_eq!(found.last(), Some(&(*b"IEND", &b""[..])));
        let whole: usize = found.iter().map(|(_, data)| 12 + data.len()).sum();
        assert_eq!(SIGNATURE.len() + whole, bytes.len());
    }

    #[test]
    fn chunks_end_where_the_file_is_damaged() {
        let picture = Picture::filled(3, 2, [7; 3]).unwrap();
        let bytes = encode(Path::new("x.png"), &picture).unwrap();
        let whole = chunks(&bytes).count();
        for end in 0..bytes.len() {
            assert!(chunks(&bytes[..end]).count() < whole, "{end}");
        }
        let mut wrong = bytes.clone();
        wrong[20] ^= 1;
        assert_eq!(chunks(&wrong).count(), 0);
        assert_eq!(chunks(b"GIF89a").count(), 0);
    }

    #[test]
    fn the_checksum_is_the_standard_one() {
        assert_eq!(checksum(b"123456789"), 0xcbf4_3926);
    }
}
