//! Animations: pictures in time.

use std::path::Path;

use crate::png::{self, LONGEST, SIGNATURE};
use crate::{ShadeError, write_atomically};

/// Frames of one size, shown one after the other and over again, as an animated PNG.
///
/// Readers that know only still pictures show the first frame. Frames stay compressed, and are those
/// of the still pictures bit for bit. (The format: "Portable Network Graphics Specification (Third
/// Edition)", W3C, 2025, Section 11.3.5.)
#[derive(Clone, Debug)]
pub struct Animation {
    frames_per_second: u16,
    /// What all frames must have in common: size, depth and kind of colour.
    header: Option<Vec<u8>>,
    frames: Vec<Vec<u8>>,
}

impl Animation {
    /// An animation without frames yet.
    pub fn new(frames_per_second: u16) -> Self {
        Self { frames_per_second, header: None, frames: Vec::new() }
    }

    /// How many frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Are there none?
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Adds the still picture in the bytes of a PNG file; `path` is for messages.
    ///
    /// # Errors
    /// [`ShadeError::Frame`], if the file is not whole, or not of the first frame's size and kind.
    pub fn push(&mut self, path: &Path, bytes: &[u8]) -> Result<(), ShadeError> {
        let wrong = |reason| ShadeError::Frame { path: path.into(), reason };
        let chunks: Vec<_> = png::chunks(bytes).collect();
        let (Some((_, header)), Some((b"IEND", _))) =
            (chunks.first().filter(|c| c.0 == *b"IHDR"), chunks.last().map(|(k, d)| (k, d)))
        else {
            return Err(wrong("it is no whole PNG file"));
        };
        if self.header.get_or_insert_with(|| header.to_vec()) != header {
            return Err(wrong("it is not of the size and kind of the first frame"));
        }
        let data = chunks.iter().filter(|(kind, _)| kind == b"IDAT").map(|(_, data)| *data);
        let data: Vec<u8> = data.flatten().copied().collect();
        // Data of later frames starts with a number of four bytes.
        if data.len() > LONGEST - 4 {
            return Err(wrong("its data is too long for a chunk of 2147483647 bytes"));
        }
        self.frames.push(data);
        Ok(())
    }

    /// Saves the animation as PNG. Missing folders are created; the file is whole or absent.
    ///
    /// # Errors
    /// If there is no frame, or the folder cannot be made or written.
    pub fn save(&self, path: &Path) -> Result<(), ShadeError> {
        let Some(header) = &self.header else {
            return Err(ShadeError::Frame { path: path.into(), reason: "there is no frame" });
        };
        let mut bytes = SIGNATURE.to_vec();
        bytes.extend(png::chunk(*b"IHDR", header));
        // The number of frames, and that they are shown for ever.
        let control = [self.frames.len() as u32, 0].map(u32::to_be_bytes);
        bytes.extend(png::chunk(*b"acTL", control.as_flattened()));
        bytes.extend(png::software());
        let mut sequence = 0_u32;
        for (i, data) in self.frames.iter().enumerate() {
            bytes.extend(png::chunk(*b"fcTL", &self.control(sequence, &header[..8])));
            sequence += 1;
            if i == 0 {
                bytes.extend(png::chunk(*b"IDAT", data));
            } else {
                let numbered = [&sequence.to_be_bytes(), &data[..]].concat();
                bytes.extend(png::chunk(*b"fdAT", &numbered));
                sequence += 1;
            }
        }
        bytes.extend(png::chunk(*b"IEND", &[]));
        write_atomically(path, &bytes)
    }

    /// A whole frame in the place of the last one: number, size, offset 0, time, ways of blending.
    fn control(&self, sequence: u32, size: &[u8]) -> Vec<u8> {
        let time = [1, self.frames_per_second].map(u16::to_be_bytes);
        [&sequence.to_be_bytes(), size, &[0; 8], time.as_flattened(), &[0; 2]].concat()
    }
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::io::BufReader;

    use image::AnimationDecoder;
    use image::codecs::png::PngDecoder;

    use super::*;
    use crate::Picture;

    fn bytes(picture: &Picture) -> Vec<u8> {
        picture.png(Path::new("frame.png")).unwrap()
    }

    /// A blot at another place in each frame.
    fn frames(count: usize) -> Vec<Picture> {
        (0..count)
            .map(|i| {
                let mut picture = Picture::filled(9, 4, [250, 240, 230]).unwrap();
                picture.fill([i, 1], [2, 2], [30 * i as u8, 5, 200]);
                picture
            })
            .collect()
    }

    #[test]
    fn frames_survive_the_round_trip_in_order_and_time() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/blot.png");
        for count in [1, 2, 7] {
            let frames = frames(count);
            let mut animation = Animation::new(24);
            for frame in &frames {
                animation.push(Path::new("f"), &bytes(frame)).unwrap();
            }
            assert_eq!((animation.len(), animation.is_empty()), (count, false));
            animation.save(&path).unwrap();

            let still = image::open(&path).unwrap().into_rgb8();
            assert_eq!(still.as_raw(), frames[0].pixels().as_flattened());
            let file = BufReader::new(File::open(&path).unwrap());
            let decoder = PngDecoder::new(file).unwrap().apng().unwrap();
            let read = decoder.into_frames().collect_frames().unwrap();
            assert_eq!(read.len(), count);
            for (read, frame) in read.iter().zip(&frames) {
                let (numerator, denominator) = read.delay().numer_denom_ms();
                assert_eq!(u64::from(numerator) * 24, u64::from(denominator) * 1000);
                let pixels: Vec<_> =
                    read.buffer().pixels().map(|p| [p.0[0], p.0[1], p.0[2]]).collect();
                assert_eq!(pixels, frame.pixels());
            }
        }
    }

    #[test]
    fn what_is_no_frame_is_refused_with_its_name() {
        let mut animation = Animation::new(24);
        let error = animation.save(Path::new("none.png")).unwrap_err().to_string();
        assert!(error.contains("none.png") && error.contains("no frame"), "{error}");
        let good = bytes(&frames(1)[0]);
        for bad in [&b"GIF89a"[..], &[], &good[..good.len() - 1]] {
            let error = animation.push(Path::new("bad.png"), bad).unwrap_err().to_string();
            assert!(error.contains("bad.png") && error.contains("whole PNG"), "{error}");
        }
        animation.push(Path::new("good.png"), &good).unwrap();
        let wide = bytes(&Picture::filled(10, 4, [0; 3]).unwrap());
        let error = animation.push(Path::new("wide.png"), &wide).unwrap_err().to_string();
        assert!(error.contains("wide.png") && error.contains("size"), "{error}");
        assert_eq!(animation.len(), 1);
    }
}
