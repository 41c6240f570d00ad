//! Rasterisation: shapes drawn into textures.

use std::sync::atomic::Ordering;
use std::time::Duration;

use super::sequence::encode;
use super::{AsBinding, Binding, Clock, Device, DeviceError, Step};

/// What a texture holds in each of its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Four floats of 32 bits.
    Single,
    /// Four floats of 16 bits.
    Half,
    /// Four bytes, for 0 to 1.
    Byte,
    /// A depth of 32 bits.
    Depth,
}

impl Format {
    fn raw(self) -> wgpu::TextureFormat {
        match self {
            Self::Single => wgpu::TextureFormat::Rgba32Float,
            Self::Half => wgpu::TextureFormat::Rgba16Float,
            Self::Byte => wgpu::TextureFormat::Rgba8Unorm,
            Self::Depth => wgpu::TextureFormat::Depth32Float,
        }
    }
}

/// An image on a device.
#[derive(Debug)]
pub struct Texture {
    view: wgpu::TextureView,
}

impl AsBinding for Texture {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::TextureView(&self.view)
    }
}

/// How what is drawn changes what is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mixing {
    /// It takes its place.
    Replace,
    /// It is added.
    Add,
}

/// What the depth decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthTest {
    /// What is nearer stays, and its depth with it.
    Nearest,
    /// What is not behind counts; the depth stays as it is.
    NotBehind,
}

/// A shader's stages `shape` and `paint`, compiled.
#[derive(Debug)]
pub struct Pipeline {
    raw: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    bindings: usize,
}

/// A pipeline with its buffers: made once, drawn often.
#[derive(Debug)]
pub struct BoundPipeline {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
}

/// Shapes drawn into textures of one size.
#[derive(Clone, Copy, Debug)]
pub struct Pass<'a> {
    /// What is drawn, each with the numbers of vertices and of instances.
    pub draws: &'a [(&'a BoundPipeline, u32, u32)],
    /// Where it is drawn to; what was there is cleared to 0.
    pub colours: &'a [&'a Texture],
    /// The depth.
    pub depth: &'a Texture,
    /// What the depth is before.
    pub start: DepthStart,
}

/// What the depth of a pass is before anything is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthStart {
    /// 1, the farthest.
    Far,
    /// What the pass before left.
    Kept,
}

impl Device {
    /// Can what is drawn be added up in 32 bits?
    pub fn adds_singles(&self) -> bool {
        self.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE)
    }

    /// The longest side of a texture.
    pub fn longest_side(&self) -> usize {
        self.device.limits().max_texture_dimension_2d as usize
    }

    /// An image of that size.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn texture(
        &self,
        format: Format,
        [width, height]: [u32; 2],
    ) -> Result<Texture, DeviceError> {
        self.made.fetch_add(1, Ordering::Relaxed);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
        self.guarded(|| {
            let texture = self.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: format.raw(),
                usage,
                view_formats: &[],
            });
            Ok(Texture { view: texture.create_view(&Default::default()) })
        })
    }

    /// Compiles the stages `shape` and `paint` of a shader, which draw triangles in strips into textures of
    /// these formats.
    ///
    /// # Errors
    /// If the shader is invalid or the driver refuses it.
    pub fn pipeline(
        &self,
        label: &str,
        source: &str,
        bindings: &[Binding],
        colours: &[(Format, Mixing)],
        test: DepthTest,
    ) -> Result<Pipeline, DeviceError> {
        self.made.fetch_add(1, Ordering::Relaxed);
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let targets: Vec<_> = colours
            .iter()
            .map(|(format, mixing)| {
                let add = wgpu::BlendComponent {
                    src_factor: wgpu::BlendFactor::One,
                    dst_factor: wgpu::BlendFactor::One,
                    operation: wgpu::BlendOperation::Add,
                };
                Some(wgpu::ColorTargetState {
                    format: format.raw(),
                    blend: (*mixing == Mixing::Add)
                        .then_some(wgpu::BlendState { color: add, alpha: add }),
                    write_mask: wgpu::ColorWrites::ALL,
                })
            })
            .collect();
        self.guarded(|| {
            let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(label),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            });
            let (layout, whole) = self.layout(label, bindings, stages);
            let raw = self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(label),
                layout: Some(&whole),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("shape"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState {
                    topology: wgpu::PrimitiveTopology::TriangleStrip,
                    ..Default::default()
                },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: Format::Depth.raw(),
                    depth_write_enabled: Some(test == DepthTest::Nearest),
                    depth_compare: Some(match test {
                        DepthTest::Nearest => wgpu::CompareFunction::Less,
                        DepthTest::NotBehind => wgpu::CompareFunction::LessEqual,
                    }),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("paint"),
                    compilation_options: Default::default(),
                    targets: &targets,
                }),
                multiview_mask: None,
                cache: None,
            });
            Ok(Pipeline { raw, layout, bindings: bindings.len() })
        })
    }

    /// Gives a pipeline its buffers.
    ///
    /// # Errors
    /// If the device is lost.
    ///
    /// # Panics
    /// If there are not as many buffers as bindings.
    pub fn bind_pipeline(
        &self,
        pipeline: &Pipeline,
        buffers: &[&dyn AsBinding],
    ) -> Result<BoundPipeline, DeviceError> {
        assert_eq!(buffers.len(), pipeline.bindings, "one buffer a binding");
        let group = self.group(&pipeline.layout, buffers)?;
        Ok(BoundPipeline { pipeline: pipeline.raw.clone(), group })
    }

    /// Draws passes and then runs kernels, each when the one before is done, and waits; gives the time that
    /// the device measured for all, if it has a clock.
    ///
    /// # Errors
    /// If the device is lost.
    ///
    /// # Panics
    /// If there are no passes, or no kernels.
    pub fn draw(
        &self,
        passes: &[Pass<'_>],
        steps: &[Step<'_>],
        clock: Option<&Clock>,
    ) -> Result<Option<Duration>, DeviceError> {
        assert!(!passes.is_empty() && !steps.is_empty(), "something is drawn, and made use of");
        self.guarded(|| {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            for (number, pass) in passes.iter().enumerate() {
                let clock = clock.filter(|_| number == 0);
                paint(&mut encoder, pass, clock);
            }
            encode(&mut encoder, steps, clock.map(|clock| clock.ends([None, Some(1)])));
            if let Some(clock) = clock {
                clock.resolve(&mut encoder);
            }
            self.queue.submit([encoder.finish()]);
            self.wait()
        })?;
        clock.map(|clock| self.elapsed(clock)).transpose()
    }
}

fn paint(encoder: &mut wgpu::CommandEncoder, pass: &Pass<'_>, clock: Option<&Clock>) {
    let colours: Vec<_> = pass
        .colours
        .iter()
        .map(|texture| {
            Some(wgpu::RenderPassColorAttachment {
                view: &texture.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })
        })
        .collect();
    let load = match pass.start {
        DepthStart::Far => wgpu::LoadOp::Clear(1.0),
        DepthStart::Kept => wgpu::LoadOp::Load,
    };
    let mut drawn = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &colours,
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &pass.depth.view,
            depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        timestamp_writes: clock.map(|clock| wgpu::RenderPassTimestampWrites {
            query_set: clock.queries(),
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: None,
        }),
        occlusion_query_set: None,
        multiview_mask: None,
    });
    for (bound, vertices, instances) in pass.draws {
        drawn.set_pipeline(&bound.pipeline);
        drawn.set_bind_group(0, &bound.group, &[]);
        drawn.draw(0..*vertices, 0..*instances);
    }
}
