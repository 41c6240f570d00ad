//! EXR files: hits as numbers.

use std::io::Cursor;
use std::path::Path;

use ::exr::prelude::*;
use zeroset_raycast::{Hits, View};

use crate::picture::{check_count, check_hits};
use crate::{Colour, Picture, ShadeError, steps, write_atomically};

/// Saves hits in single precision, one named channel each, without loss of what is stored.
///
/// | channel | content |
/// |---|---|
/// | `t` | the middle of the bracket, rounded to nearest; infinite for a miss |
/// | `t.lo`, `t.hi` | the bracket, rounded down and up: it encloses the bracket in double precision |
/// | `N.X`, `N.Y`, `N.Z` | the unit normal along the gradient, zero for a miss; if the hits have normals |
/// | `steps` | evaluations of all kinds |
/// | `certificate` | the bits as a number: HIT 1, FIRST 2, ROOT 4 |
/// | `R`, `G`, `B` | the picture in linear light, if there is one |
///
/// All channels are 32-bit floats, which every viewer reads. Missing folders are created; the file
/// is whole or absent.
///
/// # Errors
/// If the view has no pixels, the hits or the picture are not those of the view, or the file cannot
/// be written.
pub fn save(
    path: &Path,
    view: &View,
    hits: &Hits,
    picture: Option<&Picture>,
) -> std::result::Result<(), ShadeError> {
    check_hits(view, hits)?;
    let (width, height) = (view.width, view.height);
    if i32::try_from(width).is_err() || i32::try_from(height).is_err() {
        let limit = "EXR holds at most 2147483647 pixels a side";
        return Err(ShadeError::TooLarge { width, height, limit });
    }
    let mut channels = hit_channels(hits);
    if let Some(picture) = picture {
        check_count(view, "pixels of the picture", picture.pixels().len())?;
        channels.extend(colour_channels(picture));
    }
    let bytes = encode([width, height], channels)
        .map_err(|e| ShadeError::Encoding { path: path.into(), reason: e.to_string() })?;
    write_atomically(path, &bytes)
}

type Channel = AnyChannel<FlatSamples>;

fn channel(name: &str, samples: impl Iterator<Item = f32>) -> Channel {
    AnyChannel {
        name: name.into(),
        sample_data: FlatSamples::F32(samples.collect()),
        // For lossy compression alone, which is not used.
        quantize_linearly: false,
        sampling: Vec2(1, 1),
    }
}

fn hit_channels(hits: &Hits) -> Vec<Channel> {
    let mut channels = vec![
        channel("t", (0..hits.len()).map(|i| hits.get(i).t() as f32)),
        channel("t.lo", hits.bracket.iter().map(|b| round_down(b[0]))),
        channel("t.hi", hits.bracket.iter().map(|b| round_up(b[1]))),
        channel("steps", hits.work.iter().map(|w| steps::evaluations(w) as f32)),
        channel("certificate", hits.certificate.iter().map(|c| f32::from(c.bits()))),
    ];
    if !hits.normal.is_empty() {
        for (axis, name) in ["N.X", "N.Y", "N.Z"].into_iter().enumerate() {
            channels.push(channel(name, hits.normal.iter().map(|n| n[axis])));
        }
    }
    channels
}

fn colour_channels(picture: &Picture) -> impl Iterator<Item = Channel> {
    ["R", "G", "B"].into_iter().enumerate().map(|(axis, name)| {
        channel(name, picture.pixels().iter().map(|p| Colour::from_bytes(*p).0[axis]))
    })
}

fn encode([width, height]: [usize; 2], channels: Vec<Channel>) -> Result<Vec<u8>> {
    let mut attributes = LayerAttributes {
        software_name: Some(concat!("zeroset ", env!("CARGO_PKG_VERSION")).into()),
        ..LayerAttributes::default()
    };
    attributes.comments = Some(
        "t.lo and t.hi enclose what was found; misses are infinite. certificate: HIT 1, FIRST 2, \
         ROOT 4"
            .into(),
    );
    // Lines in order, so that equal hits give equal files.
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let channels = AnyChannels::sort(channels.into());
    let image = Image::from_layer(Layer::new((width, height), attributes, encoding, channels));
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

/// The greatest single-precision number that is not above `x`.
fn round_down(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x { nearest.next_down() } else { nearest }
}

/// The least single-precision number that is not below `x`.
fn round_up(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) < x { nearest.next_up() } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_encloses_and_is_tight() {
        let tiny = f64::from(f32::from_bits(1));
        let cases = [
            0.0,
            -0.0,
            1.0,
            0.1,
            -0.1,
            1.0 + f64::EPSILON,
            1.0 - f64::EPSILON,
            tiny,
            0.3 * tiny,
            -0.3 * tiny,
            1e39,
            -1e39,
            f64::MAX,
            f64::MIN_POSITIVE,
            f64::from(f32::MAX),
            16_777_217.0,
        ];
        for x in cases {
            let (down, up) = (round_down(x), round_up(x));
            assert!(f64::from(down) <= x && x <= f64::from(up), "{down} {x} {up}");
            assert!(f64::from(down.next_up()) > x || down == up, "{x}");
            assert!(f64::from(up.next_down()) < x || down == up, "{x}");
        }
        assert_eq!(round_down(1e39), f32::MAX);
        assert_eq!(round_up(1e39), f32::INFINITY);
        assert_eq!([round_down(f64::INFINITY), round_up(f64::INFINITY)], [f32::INFINITY; 2]);
        assert!(round_down(f64::NAN).is_nan() && round_up(f64::NAN).is_nan());
    }
}
