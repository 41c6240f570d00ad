//! Beam casting compiled for a scene, on a device.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use zeroset_cpu::{Implicit, normals};
use zeroset_expr::Parameters;
use zeroset_gpu::device::{Groups, Step};
use zeroset_gpu::{Device, DeviceError};
use zeroset_raycast::{
    Certificate, Error, Hit, Hits, Intersector, Method, Progress, Rays, Report, Scene, Unsupported,
    View, Work,
};

use super::BeamGpu;
use super::canvas::{
    Answer, Canvas, FOUND, LONGEST, PROVEN, SentCell, SentLevel, SentSettings, Told, WORKGROUP,
};
use super::kernels::{Kernels, check, function, shader};
use crate::optics::Optics;
use crate::{prepared, quadtree};

/// [`BeamGpu`] compiled for a scene.
pub(super) struct PreparedOnDevice {
    method: BeamGpu,
    implicit: Implicit,
    /// What is on the device: kernels for a kind of view, buffers for a size of image.
    state: Mutex<Option<State>>,
}

struct State {
    device: Arc<Device>,
    kernels: Kernels,
    canvas: Option<Canvas>,
}

impl PreparedOnDevice {
    pub(super) fn new(method: &BeamGpu, scene: &Scene) -> Result<Self, Error> {
        let implicit = Implicit::new(method.id(), scene)?;
        check(&method.twin, &implicit)?;
        function(&method.twin, &implicit)?;
        method.find_device()?;
        Ok(Self { method: method.clone(), implicit, state: Mutex::default() })
    }

    /// Casts all beams; the answers are given row by row, band by band.
    fn cast(
        &self,
        state: &mut Option<State>,
        view: &View,
        optics: &Optics,
        progress: &Progress,
        see: &mut dyn FnMut(usize, &[Answer]),
    ) -> Result<Option<Duration>, Error> {
        let image = [view.width, view.height];
        let twin = &self.method.twin;
        let (module, kernel) = shader(twin, &self.implicit, optics)?;
        let source = module.shader(&kernel);
        if !state.as_ref().is_some_and(|s| s.kernels.source == source && !s.device.is_lost()) {
            // What was there makes room first.
            *state = None;
            let device = Device::open(&self.method.device)?;
            let kernels = Kernels::new(&device, &module, &kernel)?;
            *state = Some(State { device, kernels, canvas: None });
        }
        let State { device, kernels, canvas } = state.as_mut().expect("it was just made");
        if !canvas.as_ref().is_some_and(|canvas| canvas.fits(&self.method, image)) {
            *canvas = None;
            *canvas = Some(Canvas::new(device, kernels, &self.method, image)?);
        }
        let canvas = canvas.as_mut().expect("it was just made");
        let settings = SentSettings::new(twin, optics, &self.implicit.domain, image);
        let tolerance = twin.tolerance(view, optics, 1);
        let mut time = None;
        for row in (0..image[1]).step_by(canvas.rows) {
            progress.advance(0)?;
            let rows = canvas.rows.min(image[1] - row);
            let (constants, range) = (module.constants(), optics.range);
            let told = Told { constants, settings, tolerance, range, row };
            if canvas.sent.as_ref() != Some(&told) {
                canvas.sent = None;
                device.write(&kernels.constants, &told.constants)?;
                device.write(&canvas.settings, &[settings])?;
                self.send(device, canvas, view, optics, row, rows)?;
                canvas.sent = Some(told);
            }
            let mut steps = Vec::new();
            for (number, level) in canvas.levels.iter().enumerate() {
                let groups = Groups::Indirect(&canvas.counts, number);
                steps.push(Step { bound: &level.cast, groups });
                if let Some([scan, quarter]) = &level.next {
                    steps.push(Step { bound: scan, groups: Groups::Invocations(1) });
                    steps.push(Step { bound: quarter, groups });
                }
            }
            let elapsed = device.run_sequence(&steps, canvas.clock.as_ref())?;
            time = elapsed.map(|elapsed| elapsed + time.unwrap_or_default());
            let answers = device.read_with(&canvas.reader, &canvas.answers, rows * image[0])?;
            see(row, &answers);
            progress.advance(rows * image[0])?;
        }
        Ok(time)
    }

    /// Tells the device of a band: its first cells and its levels.
    fn send(
        &self,
        device: &Device,
        canvas: &Canvas,
        view: &View,
        optics: &Optics,
        row: usize,
        rows: usize,
    ) -> Result<(), DeviceError> {
        let image = canvas.image;
        let above = row as u32 / canvas.first;
        let cells: Vec<SentCell> =
            quadtree::cells([image[0], rows], canvas.first, optics.range[0].into())
                .into_iter()
                .map(|cell| SentCell {
                    place: cell.column | (cell.row + above) << 16,
                    start: optics.range[0],
                })
                .collect();
        let groups = cells.len().div_ceil(WORKGROUP) as u32;
        let columns = groups.min(65_535);
        let count = [columns, groups.div_ceil(columns), 1, cells.len() as u32];
        device.write(&canvas.begin, &cells)?;
        device.write(&canvas.counts, &[count])?;
        for (number, level) in (0..).zip(&canvas.levels) {
            // A band's last row of cells may reach beyond it, but not beyond the image.
            let sent = SentLevel {
                size: level.size,
                exponent: level.size.ilog2(),
                number,
                tolerance: self.method.twin.tolerance(view, optics, level.size) as f32,
                extent: quadtree::extent(image, (level.size / 2).max(1)),
                row: row as u32,
                width: image[0] as u32,
            };
            device.write(&level.level, &[sent])?;
        }
        Ok(())
    }

    /// Reads the answers of a band, which starts at a row of pixels; gives how many evaluations they cost.
    fn read(
        &self,
        first: u32,
        image: [usize; 2],
        row: usize,
        answers: &[Answer],
        hits: &mut Hits,
    ) -> u64 {
        let mut total = 0;
        let twin = &self.method.twin;
        let width = image[0];
        for (i, answer) in answers.iter().enumerate() {
            let (column, line) = (i % width, i / width);
            // The largest cell with this pixel that was excluded, or the pixel itself.
            let mut exponent = first.ilog2();
            let decided = loop {
                let corner = |n: usize| n >> exponent << exponent;
                let cell = &answers[corner(line) * width + corner(column)];
                if cell.state == exponent || exponent == 0 {
                    break cell;
                }
                exponent -= 1;
            };
            let is_first = |n: usize| n.is_multiple_of(1 << exponent);
            let intervals = if is_first(line) && is_first(column) { answer.intervals } else { 0 };
            total += u64::from(intervals);
            let work = Work { intervals: intervals.into(), ..Work::default() };
            let hit = if decided.state & FOUND == 0 {
                Hit::miss(twin.excluded(), work)
            } else {
                let certificate = twin.found(decided.state & PROVEN != 0);
                Hit { bracket: decided.piece.map(f64::from), certificate, work }
            };
            hits.set(row * width + i, hit);
        }
        total
    }
}

impl Intersector for PreparedOnDevice {
    fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        let mut implicit = self.implicit.clone();
        implicit.set_parameters(values)?;
        check(&self.method.twin, &implicit)?;
        function(&self.method.twin, &implicit)?;
        self.implicit = implicit;
        Ok(())
    }

    fn intersect(
        &self,
        rays: Rays<'_>,
        hits: &mut Hits,
        progress: &Progress,
    ) -> Result<Report, Error> {
        assert_eq!(rays.len(), hits.len(), "one answer a ray");
        let view = prepared::view(self.method.id(), rays)?;
        let image = [view.width, view.height];
        progress.advance(0)?;
        if image.contains(&0) {
            return Ok(Report::default());
        }
        if image[0].max(image[1]) > LONGEST {
            return Err(Error::Unsupported(Unsupported(format!(
                "an image of {} x {} pixels is too large for beams on a device: at most {LONGEST} \
                 a side",
                image[0], image[1]
            ))));
        }
        let mut work = Work::default();
        let Some(optics) = Optics::new(view, &self.implicit.domain)? else {
            let no_ray = Work { nonfinite: 1, ..Work::default() };
            for index in 0..rays.len() {
                hits.set(index, Hit::miss(Certificate::MISS, no_ray));
                work += no_ray;
            }
            progress.advance(rays.len())?;
            return Ok(Report { work, device_time: None });
        };
        optics.check_device()?;
        let first = self.method.twin.first(image);
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let mut intervals = 0;
        let mut see = |row: usize, answers: &[Answer]| {
            intervals += self.read(first, image, row, answers, hits);
        };
        let cast = self.cast(&mut state, view, &optics, progress, &mut see);
        if cast.is_err() {
            // What is there now is not known.
            *state = None;
        }
        work.intervals = intervals;
        let device_time = cast?;
        work += normals::fill(&self.implicit.tape, self.method.twin.normals, rays, hits);
        Ok(Report { work, device_time })
    }
}
