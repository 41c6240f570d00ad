//! Kernels: compiled shaders, run over arrays.

use std::sync::atomic::Ordering;
use std::time::Duration;

use super::{Buffer, Device, DeviceError, Groups, Step};

/// Invocations in a workgroup, as every shader here declares.
const WORKGROUP: u32 = 64;

/// How a kernel uses a buffer; the order is that of the shader's binding numbers in group 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// `var<uniform>`.
    Uniform,
    /// `var<storage, read>`.
    Read,
    /// `var<storage, read_write>`.
    Write,
    /// `texture_2d<f32>`, whose pixels are loaded one by one.
    Texture,
}

/// A compute shader, compiled.
#[derive(Debug)]
pub struct Kernel {
    pub(super) pipeline: wgpu::ComputePipeline,
    pub(super) layout: wgpu::BindGroupLayout,
    pub(super) bindings: usize,
}

impl Device {
    /// Compiles the entry point `main` of a shader.
    ///
    /// # Errors
    /// If the shader is invalid or the driver refuses it.
    pub fn kernel(
        &self,
        label: &str,
        source: &str,
        bindings: &[Binding],
    ) -> Result<Kernel, DeviceError> {
        self.made.fetch_add(1, Ordering::Relaxed);
        self.guarded(|| {
            let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(label),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
            let (layout, whole) = self.layout(label, bindings, wgpu::ShaderStages::COMPUTE);
            let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(label),
                layout: Some(&whole),
                module: &module,
                entry_point: Some("main"),
                compilation_options: Default::default(),
                cache: None,
            });
            Ok(Kernel { pipeline, layout, bindings: bindings.len() })
        })
    }

    /// The layout of a shader's bindings, alone and as that of a pipeline.
    pub(super) fn layout(
        &self,
        label: &str,
        bindings: &[Binding],
        stages: wgpu::ShaderStages,
    ) -> (wgpu::BindGroupLayout, wgpu::PipelineLayout) {
        let buffer = |ty| wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let entries: Vec<_> = bindings
            .iter()
            .zip(0..)
            .map(|(kind, binding)| wgpu::BindGroupLayoutEntry {
                binding,
                visibility: stages,
                ty: match kind {
                    Binding::Uniform => buffer(wgpu::BufferBindingType::Uniform),
                    Binding::Read => buffer(wgpu::BufferBindingType::Storage { read_only: true }),
                    Binding::Write => buffer(wgpu::BufferBindingType::Storage { read_only: false }),
                    Binding::Texture => wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: false },
                        view_dimension: wgpu::TextureViewDimension::D2,
                        multisampled: false,
                    },
                },
                count: None,
            })
            .collect();
        let layout = self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &entries,
        });
        let whole = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        (layout, whole)
    }

    /// Runs a kernel with at least that many invocations, and waits; gives the time that the device
    /// measured, if it can.
    ///
    /// # Errors
    /// If the device is lost.
    ///
    /// # Panics
    /// If there are not as many buffers as bindings.
    pub fn run(
        &self,
        kernel: &Kernel,
        buffers: &[&dyn AsBinding],
        invocations: usize,
    ) -> Result<Option<Duration>, DeviceError> {
        let (bound, clock) = (self.bind(kernel, buffers)?, self.clock()?);
        let step = Step { bound: &bound, groups: Groups::Invocations(invocations) };
        self.run_sequence(&[step], clock.as_ref())
    }
}

/// A buffer of any type, or a texture, to be bound.
pub trait AsBinding {
    /// What is behind it.
    #[doc(hidden)]
    fn resource(&self) -> wgpu::BindingResource<'_>;
}

impl<T> AsBinding for Buffer<T> {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        self.raw.as_entire_binding()
    }
}

/// The most workgroups along one side of a grid that every device allows.
const LONGEST_SIDE: u32 = 65_535;

/// Columns and rows of a grid with at least that many invocations.
pub(super) fn grid(invocations: usize) -> [u32; 2] {
    let groups = invocations.div_ceil(WORKGROUP as usize) as u32;
    let columns = groups.clamp(1, LONGEST_SIDE);
    [columns, groups.div_ceil(columns).max(1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_hold_all_invocations() {
        for n in [0, 1, 64, 65, 1 << 20, 1 << 22, (1 << 22) + 1, 1 << 28] {
            let [columns, rows] = grid(n);
            assert!(columns <= LONGEST_SIDE && rows <= LONGEST_SIDE);
            assert!(columns as usize * rows as usize * WORKGROUP as usize >= n, "{n}");
        }
    }
}
