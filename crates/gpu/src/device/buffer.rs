//! Buffers of plain values.

use std::marker::PhantomData;
use std::sync::atomic::Ordering;

use bytemuck::Pod;

use super::{Device, DeviceError};

/// An array of `T` on a device, at most as long as it was made.
#[derive(Debug)]
pub struct Buffer<T> {
    pub(super) raw: wgpu::Buffer,
    len: usize,
    values: PhantomData<T>,
}

impl<T> Buffer<T> {
    /// How many values it holds.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Does it hold none?
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
}

/// What values are read through.
#[derive(Debug)]
pub struct Reader<T>(Buffer<T>);

impl Device {
    /// Room for `len` values that kernels read and write.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn storage<T: Pod>(&self, len: usize) -> Result<Buffer<T>, DeviceError> {
        self.buffer(len, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC)
    }

    /// Room for `len` values that are the same for every invocation of a kernel.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn uniform<T: Pod>(&self, len: usize) -> Result<Buffer<T>, DeviceError> {
        self.buffer(len, wgpu::BufferUsages::UNIFORM)
    }

    /// Room for `len` counts of workgroups along x, y and z, and one number more, that kernels write and that
    /// tell how many workgroups of [later ones](super::Groups::Indirect) run.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn counts_of_groups(&self, len: usize) -> Result<Buffer<[u32; 4]>, DeviceError> {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT;
        self.buffer(len, usage | wgpu::BufferUsages::COPY_SRC)
    }

    pub(super) fn buffer<T: Pod>(
        &self,
        len: usize,
        usage: wgpu::BufferUsages,
    ) -> Result<Buffer<T>, DeviceError> {
        self.made.fetch_add(1, Ordering::Relaxed);
        let raw = self.guarded(|| {
            Ok(self.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                // No buffer is empty, and copies are whole words.
                size: ((len * size_of::<T>()).max(16) as u64).next_multiple_of(4),
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }))
        })?;
        Ok(Buffer { raw, len, values: PhantomData })
    }

    /// Writes values to the start of a buffer, before the next kernel runs.
    ///
    /// # Errors
    /// If the device is lost.
    ///
    /// # Panics
    /// If there are more values than the buffer has room for.
    pub fn write<T: Pod>(&self, buffer: &Buffer<T>, values: &[T]) -> Result<(), DeviceError> {
        assert!(values.len() <= buffer.len, "{} values for {}", values.len(), buffer.len);
        self.guarded(|| {
            self.queue.write_buffer(&buffer.raw, 0, bytemuck::cast_slice(values));
            Ok(())
        })
    }

    /// Reads the first `len` values, once all kernels are done.
    ///
    /// # Errors
    /// If the device is lost, or out of memory.
    ///
    /// # Panics
    /// If the buffer has fewer values.
    pub fn read<T: Pod>(&self, buffer: &Buffer<T>, len: usize) -> Result<Vec<T>, DeviceError> {
        assert!(len <= buffer.len, "{len} values of {}", buffer.len);
        if len == 0 {
            return Ok(Vec::new());
        }
        self.read_with(&self.reader(len)?, buffer, len)
    }

    /// Room through which up to `len` values are read, again and again.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn reader<T: Pod>(&self, len: usize) -> Result<Reader<T>, DeviceError> {
        Ok(Reader(self.buffer(len, wgpu::BufferUsages::MAP_READ)?))
    }

    /// As [`read`](Self::read), without making anything on the device.
    ///
    /// # Errors
    /// If the device is lost.
    ///
    /// # Panics
    /// If the buffer has fewer values, or the reader has no room for them.
    pub fn read_with<T: Pod>(
        &self,
        reader: &Reader<T>,
        buffer: &Buffer<T>,
        len: usize,
    ) -> Result<Vec<T>, DeviceError> {
        assert!(len <= buffer.len && len <= reader.0.len, "{len} values of {}", buffer.len);
        self.read.fetch_add(1, Ordering::Relaxed);
        let copy = &reader.0.raw;
        self.guarded(|| {
            let size = ((len * size_of::<T>()) as u64).next_multiple_of(4);
            let mut encoder = self.device.create_command_encoder(&Default::default());
            encoder.copy_buffer_to_buffer(&buffer.raw, 0, copy, 0, size);
            self.queue.submit([encoder.finish()]);
            let (sender, receiver) = std::sync::mpsc::channel();
            copy.map_async(wgpu::MapMode::Read, 0..size, move |result| {
                // The receiver is gone only after an error below.
                let _ = sender.send(result);
            });
            self.wait()?;
            let invalid = |e: String| DeviceError::Invalid(self.report.name.clone(), e);
            match receiver.try_recv() {
                Ok(Ok(())) => {}
                Ok(Err(e)) => return Err(invalid(e.to_string())),
                Err(_) => return Err(invalid("a buffer was not mapped".into())),
            }
            let view = copy.get_mapped_range(0..size).map_err(|e| invalid(e.to_string()))?;
            let values = bytemuck::pod_collect_to_vec(&view[..len * size_of::<T>()]);
            drop(view);
            copy.unmap();
            Ok(values)
        })
    }
}
