//! Rays in chunks: made ready on the CPU, answered on the device, and stored.

use std::time::{Duration, Instant};

use bytemuck::Pod;
use rayon::prelude::*;
use zeroset_cpu::tiles;
use zeroset_raycast::{
    Camera, Certificate, Domain, Error, Hit, Hits, Intersector, Progress, Ray, Rays, Report,
    Request, View, Work,
};

use crate::device::{AsBinding, Buffer, Device, Kernel};

/// How long a chunk should take: far below the time after which drivers reset a device that is also
/// used for a display, and short enough to be interrupted.
const CHUNK_TIME: Duration = Duration::from_millis(100);
/// Tiles in the first chunk.
const FIRST: usize = 16;
/// Tiles in the largest chunk: a million rays.
const MOST: usize = 1024;

/// A kernel over rays: binding 0 holds the constants, 1 the settings, 2 the rays, 3 the answers.
pub(crate) struct Job<'a> {
    pub device: &'a Device,
    pub kernel: &'a Kernel,
    pub constants: &'a Buffer<[f32; 4]>,
}

/// How a method's rays come to the device and its answers back.
pub(crate) trait Traffic: Sync {
    /// A ray made ready.
    type Ready: Send + Sync;
    /// What the device is given of it.
    type Sent: Pod + Send;
    /// What the device answers.
    type Answer: Pod + Send + Sync;
    /// The settings of a chunk with so many rays.
    type Settings: Pod;
    /// What reads answers, one a thread.
    type Reader;

    /// Makes a valid ray ready, or answers it here.
    fn ready(&self, ray: Ray) -> Result<Self::Ready, Hit>;
    /// What the device needs of a ray.
    fn sent(&self, ready: &Self::Ready) -> Self::Sent;
    /// The settings for a number of rays.
    fn settings(&self, rays: u32) -> Self::Settings;
    /// What reads answers.
    fn reader(&self) -> Self::Reader;
    /// The answer in terms of the ray, or the ray once more.
    fn read(
        &self,
        reader: &mut Self::Reader,
        ready: Self::Ready,
        answer: &Self::Answer,
    ) -> Result<Hit, Self::Ready>;
}

/// Answers all rays, a chunk of tiles at a time.
pub(crate) fn cast<T: Traffic>(
    job: &Job<'_>,
    traffic: &T,
    rays: Rays<'_>,
    hits: &mut Hits,
    progress: &Progress,
) -> Result<Report, Error> {
    assert_eq!(rays.len(), hits.len(), "one answer a ray");
    let tiles = tiles::tiles(rays);
    let mut buffers = Buffers::<T>::new(job.device, 0)?;
    let (mut next, mut size) = (0, FIRST);
    let (mut work, mut time) = (Work::default(), None);
    while next < tiles.len() {
        let chunk = &tiles[next..(next + size).min(tiles.len())];
        next += chunk.len();
        let start = Instant::now();
        let (ready, answered) = prepare(traffic, chunk);
        for (index, hit) in answered.iter().flatten() {
            hits.set(*index, *hit);
            work += hit.work;
        }
        let marched = ready.len();
        let count = marched + answered.iter().map(Vec::len).sum::<usize>();
        let mut waiting = ready;
        while !waiting.is_empty() {
            let sent: Vec<T::Sent> =
                waiting.par_iter().map(|(_, ready)| traffic.sent(ready)).collect();
            if sent.len() > buffers.sent.len() {
                buffers = Buffers::new(job.device, sent.len())?;
            }
            let (answers, elapsed) = job.run(traffic, &buffers, &sent)?;
            time = elapsed.map(|elapsed| elapsed + time.unwrap_or_default());
            let read: Vec<_> = waiting
                .into_par_iter()
                .zip(answers)
                .map_init(
                    || traffic.reader(),
                    |reader, ((index, ready), answer)| {
                        (index, traffic.read(reader, ready, &answer))
                    },
                )
                .collect();
            waiting = Vec::new();
            for (index, result) in read {
                match result {
                    Ok(hit) => {
                        hits.set(index, hit);
                        work += hit.work;
                    }
                    Err(ready) => waiting.push((index, ready)),
                }
            }
            // Between the rounds too, the work can be asked to stop.
            progress.advance(0)?;
        }
        // Rays that miss the domain take no time there; the next chunk may have none of them.
        if marched > 0 {
            let full = start.elapsed().mul_f64(count as f64 / marched as f64);
            if full < CHUNK_TIME / 16 {
                size = (8 * size).min(MOST);
            } else if full < CHUNK_TIME / 2 {
                size = (2 * size).min(MOST);
            } else if full > CHUNK_TIME {
                size = (size / 2).max(1);
            }
        }
        progress.advance(count)?;
    }
    Ok(Report { work, device_time: time })
}

/// Casts a ray through the middle of the domain: drivers compile when a kernel first runs, which is part of
/// preparing.
pub(crate) fn warm_up(intersector: &dyn Intersector, domain: &Domain) -> Result<(), Error> {
    let view = View::new(Camera::facing(domain), 1, 1);
    let mut hits = Hits::new(Request::First, 1);
    intersector.intersect(Rays::View(&view), &mut hits, &Progress::new()).map(|_| ())
}

type Indexed<T> = Vec<(usize, T)>;

/// The rays of tiles: those made ready, neighbours together, and by tile those that are answered.
fn prepare<T: Traffic>(
    traffic: &T,
    tiles: &[tiles::Tile<'_>],
) -> (Indexed<T::Ready>, Vec<Indexed<Hit>>) {
    let parts: Vec<(Indexed<T::Ready>, Indexed<Hit>)> = tiles
        .par_iter()
        .map(|tile| {
            let (mut ready, mut answered) = (Vec::new(), Vec::new());
            let (indices, rays) = tile.rays();
            for (index, ray) in indices.into_iter().zip(rays.iter().copied()) {
                let result = if ray.is_valid() {
                    traffic.ready(ray)
                } else {
                    let no_ray = Work { nonfinite: 1, ..Work::default() };
                    Err(Hit::miss(Certificate::MISS, no_ray))
                };
                match result {
                    Ok(ray) => ready.push((index, ray)),
                    Err(hit) => answered.push((index, hit)),
                }
            }
            (ready, answered)
        })
        .collect();
    let (ready, answered): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
    (ready.into_iter().flatten().collect(), answered)
}

/// The buffers of a chunk.
struct Buffers<T: Traffic> {
    settings: Buffer<T::Settings>,
    sent: Buffer<T::Sent>,
    answers: Buffer<T::Answer>,
}

impl<T: Traffic> Buffers<T> {
    fn new(device: &Device, rays: usize) -> Result<Self, Error> {
        Ok(Self {
            settings: device.uniform(1)?,
            sent: device.storage(rays)?,
            answers: device.storage(rays)?,
        })
    }
}

impl Job<'_> {
    fn run<T: Traffic>(
        &self,
        traffic: &T,
        buffers: &Buffers<T>,
        sent: &[T::Sent],
    ) -> Result<(Vec<T::Answer>, Option<Duration>), Error> {
        if sent.is_empty() {
            return Ok((Vec::new(), None));
        }
        self.device.write(&buffers.settings, &[traffic.settings(sent.len() as u32)])?;
        self.device.write(&buffers.sent, sent)?;
        let bound: [&dyn AsBinding; 4] =
            [self.constants, &buffers.settings, &buffers.sent, &buffers.answers];
        let time = self.device.run(self.kernel, &bound, sent.len())?;
        Ok((self.device.read(&buffers.answers, sent.len())?, time))
    }
}
