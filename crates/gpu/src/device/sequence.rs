//! Kernels one after another, without the host in between.

use std::sync::atomic::Ordering;
use std::time::Duration;

use super::kernel::grid;
use super::{AsBinding, Buffer, Device, DeviceError, Kernel, Reader};

/// A kernel with its buffers: made once, run often.
#[derive(Debug)]
pub struct Bound {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
}

/// How many workgroups of a kernel run.
#[derive(Clone, Copy, Debug)]
pub enum Groups<'a> {
    /// Enough for that many invocations.
    Invocations(usize),
    /// What earlier kernels wrote at this index; no kernel that runs so may write there itself.
    Indirect(&'a Buffer<[u32; 4]>, usize),
}

/// A kernel's run.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// The kernel.
    pub bound: &'a Bound,
    /// How much of it.
    pub groups: Groups<'a>,
}

/// Two timestamps.
#[derive(Debug)]
pub struct Clock {
    queries: wgpu::QuerySet,
    ticks: Buffer<u64>,
    reader: Reader<u64>,
}

impl Device {
    /// Gives a kernel its buffers.
    ///
    /// # Errors
    /// If the device is lost.
    ///
    /// # Panics
    /// If there are not as many buffers as bindings.
    pub fn bind(&self, kernel: &Kernel, buffers: &[&dyn AsBinding]) -> Result<Bound, DeviceError> {
        assert_eq!(buffers.len(), kernel.bindings, "one buffer a binding");
        let group = self.group(&kernel.layout, buffers)?;
        Ok(Bound { pipeline: kernel.pipeline.clone(), group })
    }

    /// Buffers in the order of their bindings.
    pub(super) fn group(
        &self,
        layout: &wgpu::BindGroupLayout,
        buffers: &[&dyn AsBinding],
    ) -> Result<wgpu::BindGroup, DeviceError> {
        self.made.fetch_add(1, Ordering::Relaxed);
        let entries: Vec<_> = buffers
            .iter()
            .zip(0..)
            .map(|(buffer, binding)| wgpu::BindGroupEntry { binding, resource: buffer.resource() })
            .collect();
        self.guarded(|| {
            Ok(self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout,
                entries: &entries,
            }))
        })
    }

    /// Something to measure time with; none if the device cannot.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn clock(&self) -> Result<Option<Clock>, DeviceError> {
        if !self.report.timestamps {
            return Ok(None);
        }
        self.made.fetch_add(1, Ordering::Relaxed);
        let queries = self.guarded(|| {
            Ok(self.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }))
        })?;
        let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        Ok(Some(Clock { queries, ticks: self.buffer(2, usage)?, reader: self.reader(2)? }))
    }

    /// Runs kernels, each when the one before is done, and waits; gives the time that the device measured for
    /// all, if it has a clock.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn run_sequence(
        &self,
        steps: &[Step<'_>],
        clock: Option<&Clock>,
    ) -> Result<Option<Duration>, DeviceError> {
        self.guarded(|| {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            encode(&mut encoder, steps, clock.map(|clock| clock.ends([Some(0), Some(1)])));
            if let Some(clock) = clock {
                clock.resolve(&mut encoder);
            }
            self.queue.submit([encoder.finish()]);
            self.wait()
        })?;
        clock.map(|clock| self.elapsed(clock)).transpose()
    }

    pub(super) fn elapsed(&self, clock: &Clock) -> Result<Duration, DeviceError> {
        let ticks = self.read_with(&clock.reader, &clock.ticks, 2)?;
        let nanoseconds =
            ticks[1].saturating_sub(ticks[0]) as f64 * f64::from(self.queue.get_timestamp_period());
        Ok(Duration::from_nanos(nanoseconds as u64))
    }
}

impl Clock {
    pub(super) fn queries(&self) -> &wgpu::QuerySet {
        &self.queries
    }

    /// Which of the two timestamps the begin and the end of a pass of kernels write.
    pub(super) fn ends(
        &self,
        [begin, end]: [Option<u32>; 2],
    ) -> wgpu::ComputePassTimestampWrites<'_> {
        wgpu::ComputePassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: begin,
            end_of_pass_write_index: end,
        }
    }

    pub(super) fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.resolve_query_set(&self.queries, 0..2, &self.ticks.raw, 0);
    }
}

/// Kernels, one after another.
pub(super) fn encode(
    encoder: &mut wgpu::CommandEncoder,
    steps: &[Step<'_>],
    timestamp_writes: Option<wgpu::ComputePassTimestampWrites<'_>>,
) {
    let mut pass =
        encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
    for Step { bound, groups } in steps {
        pass.set_pipeline(&bound.pipeline);
        pass.set_bind_group(0, &bound.group, &[]);
        match groups {
            Groups::Invocations(count) => {
                let [columns, rows] = grid(*count);
                pass.dispatch_workgroups(columns, rows, 1);
            }
            Groups::Indirect(counts, index) => {
                let offset = index * size_of::<[u32; 4]>();
                pass.dispatch_workgroups_indirect(&counts.raw, offset as u64);
            }
        }
    }
}
