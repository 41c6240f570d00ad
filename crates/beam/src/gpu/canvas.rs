//! What is on the device for an image's size, as the shaders declare it.

use std::mem::size_of;

use bytemuck::{Pod, Zeroable};
use zeroset_gpu::Device;
use zeroset_gpu::device::{AsBinding, Bound, Buffer, Clock, Reader};
use zeroset_ia::Rounding;
use zeroset_raycast::{Domain, Error, Unsupported};

use super::BeamGpu;
use super::kernels::Kernels;
use crate::method::Beam;
use crate::optics::Optics;
use crate::region::Region;

/// The shader's `Settings`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct SentSettings {
    pub(super) low: [f32; 4],
    pub(super) high: [f32; 4],
    pub(super) centre_low: [f32; 3],
    pub(super) squared: f32,
    pub(super) centre_high: [f32; 3],
    pub(super) slack: f32,
    pub(super) fixed: [f32; 3],
    pub(super) far: f32,
    pub(super) image: [f32; 2],
    pub(super) unused: [f32; 2],
}

impl SentSettings {
    pub(super) fn new(method: &Beam, optics: &Optics, domain: &Domain, image: [usize; 2]) -> Self {
        let region = Region::<f32>::new(domain);
        // Devices may take subnormal numbers for 0: outward.
        let normal = |x: f32, i: usize| match x {
            x if x == 0.0 || x.is_normal() => x,
            x if i == 0 && x < 0.0 => -f32::MIN_POSITIVE,
            x if i == 1 && x > 0.0 => f32::MIN_POSITIVE,
            _ => 0.0,
        };
        let end = |ends: [[f32; 2]; 3], i: usize| ends.map(|ends| normal(ends[i], i));
        let four = |[x, y, z]: [f32; 3]| [x, y, z, 0.0];
        let (centre, squared) =
            region.ball.map_or(([[0.0; 2]; 3], -1.0), |ball| (ball.centre, ball.squared));
        Self {
            low: four(end(region.bounds, 0)),
            high: four(end(region.bounds, 1)),
            centre_low: end(centre, 0),
            squared,
            centre_high: end(centre, 1),
            slack: if method.rounding == Rounding::Nearest { 0.0 } else { optics.slack },
            fixed: optics.fixed.to_array(),
            far: optics.range[1],
            image: image.map(|n| n as f32),
            unused: [0.0; 2],
        }
    }
}

/// The shader's `Level`.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct SentLevel {
    pub(super) size: u32,
    pub(super) exponent: u32,
    pub(super) number: u32,
    pub(super) tolerance: f32,
    pub(super) extent: [u32; 2],
    pub(super) row: u32,
    pub(super) width: u32,
}

/// The shader's `Cell`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct SentCell {
    pub(super) place: u32,
    pub(super) start: f32,
}

/// The shader's `Answer`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Answer {
    pub(super) piece: [f32; 2],
    pub(super) state: u32,
    pub(super) intervals: u32,
}

pub(super) const FOUND: u32 = 0x100;
pub(super) const PROVEN: u32 = 0x200;

/// Invocations in a workgroup of `cast`.
pub(super) const WORKGROUP: usize = 64;
/// An image's side in pixels, at most: a cell's column and row have 16 bits.
pub(super) const LONGEST: usize = 1 << 16;

/// The buffers of an image's size, with room for the worst case, that every cell is subdivided.
pub(super) struct Canvas {
    pub(super) image: [usize; 2],
    /// The side of the first cells.
    pub(super) first: u32,
    /// Rows of a band.
    pub(super) rows: usize,
    pub(super) settings: Buffer<SentSettings>,
    pub(super) counts: Buffer<[u32; 4]>,
    pub(super) begin: Buffer<SentCell>,
    pub(super) answers: Buffer<Answer>,
    pub(super) reader: Reader<Answer>,
    pub(super) levels: Vec<LevelOnDevice>,
    pub(super) clock: Option<Clock>,
    /// What the device knows: nothing is written twice.
    pub(super) sent: Option<Told>,
}

/// What a device is told of a band.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Told {
    pub(super) constants: Vec<[f32; 4]>,
    pub(super) settings: SentSettings,
    pub(super) tolerance: f64,
    pub(super) range: [f32; 2],
    pub(super) row: usize,
}

pub(super) struct LevelOnDevice {
    pub(super) size: u32,
    pub(super) level: Buffer<SentLevel>,
    pub(super) cast: Bound,
    /// All but the last level have a next one.
    pub(super) next: Option<[Bound; 2]>,
}

impl Canvas {
    pub(super) fn new(
        device: &Device,
        kernels: &Kernels,
        method: &BeamGpu,
        image: [usize; 2],
    ) -> Result<Self, Error> {
        let first = method.twin.first(image);
        let side = first as usize;
        // Whole cells of the first level.
        let rows = (method.band / image[0] / side).max(1) * side;
        let rows = rows.min(image[1]);
        let pixels = image[0] * rows;
        if pixels * size_of::<Answer>() > device.largest_binding() as usize {
            return Err(Error::Unsupported(Unsupported(format!(
                "first cells of {first} pixels are too large on this device for an image of {} \
                 columns: set start to less",
                image[0]
            ))));
        }
        let levels = first.ilog2() as usize + 1;
        let settings = device.uniform(1)?;
        let counts = device.counts_of_groups(levels + 1)?;
        let begin = device.storage(image[0].div_ceil(side) * rows.div_ceil(side))?;
        let lists: [Buffer<SentCell>; 2] = [device.storage(pixels)?, device.storage(pixels)?];
        let quarters: Buffer<[u32; 2]> = device.storage(pixels)?;
        let sums: Buffer<u32> = device.storage(pixels.div_ceil(WORKGROUP))?;
        let answers = device.storage(pixels)?;
        let mut all = Vec::with_capacity(levels);
        for number in 0..levels {
            let level: Buffer<SentLevel> = device.uniform(1)?;
            let cells = if number == 0 { &begin } else { &lists[number % 2] };
            let buffers: [&dyn AsBinding; 8] =
                [&kernels.constants, &settings, &level, &counts, cells, &quarters, &sums, &answers];
            let cast = device.bind(&kernels.cast, &buffers)?;
            let next = if number + 1 < levels {
                let scan = device.bind(&kernels.scan, &[&level, &counts, &sums])?;
                let next = &lists[(number + 1) % 2];
                let buffers: [&dyn AsBinding; 6] = [&level, &counts, cells, &quarters, &sums, next];
                Some([scan, device.bind(&kernels.quarter, &buffers)?])
            } else {
                None
            };
            all.push(LevelOnDevice { size: first >> number, level, cast, next });
        }
        let (reader, clock) = (device.reader(pixels)?, device.clock()?);
        let levels = all;
        Ok(Self {
            image,
            first,
            rows,
            settings,
            counts,
            begin,
            answers,
            reader,
            levels,
            clock,
            sent: None,
        })
    }

    /// Is it for this image and method?
    pub(super) fn fits(&self, method: &BeamGpu, image: [usize; 2]) -> bool {
        self.image == image && self.first == method.twin.first(image)
    }
}
