//! PNG files.

use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use crate::{Picture, ShadeError};

/// The signature and the header, which must come first.
const HEAD: usize = 8 + 25;

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
    let mut notes = text_chunk("Software", concat!("zeroset ", env!("CARGO_PKG_VERSION")));
    if !picture.description().is_empty() {
        notes.extend(text_chunk("Description", picture.description()));
    }
    bytes.splice(HEAD..HEAD, notes);
    Ok(bytes)
}

/// International text (`iTXt`), not compressed, of no stated language.
fn text_chunk(keyword: &str, text: &str) -> Vec<u8> {
    // A zero would end the text for some readers.
    let text = text.replace('\0', " ");
    let mut body = b"iTXt".to_vec();
    body.extend(keyword.bytes());
    body.extend([0; 5]);
    body.extend(text.bytes());
    let length = (body.len() - 4) as u32;
    let mut chunk = length.to_be_bytes().to_vec();
    chunk.extend(&body);
    chunk.extend(checksum(&body).to_be_bytes());
    chunk
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
        let mut rest = &bytes[8..];
        let mut chunks = Vec::new();
        while !rest.is_empty() {
            let length = u32::from_be_bytes(rest[..4].try_into().unwrap()) as usize;
            let (body, tail) = rest[4..].split_at(4 + length);
            let code = u32::from_be_bytes(tail[..4].try_into().unwrap());
            assert_eq!(checksum(body), code);
            chunks.push(body);
            rest = &tail[4..];
        }
        assert_eq!(&chunks[0][..4], b"IHDR");
        assert_eq!(chunks[2], [b"iTXtDescription\0\0\0\0\0", text.as_bytes()].concat());
        assert_eq!(chunks.last(), Some(&&b"IEND"[..]));
    }

    #[test]
    fn the_checksum_is_the_standard_one() {
        assert_eq!(checksum(b"123456789"), 0xcbf4_3926);
    }
}
