//! The texture that places of a light are counted in, and what draws into it and reads it.

use std::collections::HashMap;

use super::descriptor::MOST_SAMPLES;
use super::frame::PlanarRectangle;
use crate::map::buffer;
use crate::planar::gpu::CastKey;
use glam::{DVec3, DVec4};

pub(super) const COUNTS: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;
const STENCIL: wgpu::TextureFormat = wgpu::TextureFormat::Stencil8;

/// The counts and the stencil beside them.
#[derive(Debug)]
pub(super) struct Target {
    pub counts: wgpu::Texture,
    pub view: wgpu::TextureView,
    stencil: wgpu::TextureView,
}

impl Target {
    pub fn new(device: &wgpu::Device, label: &str, [width, height]: [u32; 2]) -> Self {
        let texture = |format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d {
                    width,
                    height,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let target = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let read = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let counts = texture(COUNTS, target | read);
        let view = |texture: &wgpu::Texture| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                label: Some(label),
                ..Default::default()
            })
        };
        Self {
            view: view(&counts),
            stencil: view(&texture(STENCIL, target)),
            counts,
        }
    }

    pub fn bytes(&self) -> u64 {
        2 * u64::from(self.counts.width()) * u64::from(self.counts.height())
    }

    /// A pass that begins with so many places unseen everywhere.
    pub fn begin<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        label: &str,
        unseen: u32,
    ) -> wgpu::RenderPass<'e> {
        let count = f64::from(unseen) / f64::from(MOST_SAMPLES);
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(label),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color {
                        r: count,
                        g: count,
                        b: count,
                        a: count,
                    }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.stencil,
                depth_ops: None,
                stencil_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0),
                    store: wgpu::StoreOp::Discard,
                }),
            }),
            ..Default::default()
        })
    }
}

/// The pipelines that count, made when a draw first needs one.
#[derive(Debug)]
pub(super) struct CountPipelines {
    label: String,
    layout: wgpu::PipelineLayout,
    shader: wgpu::ShaderModule,
    made: HashMap<CastKey, wgpu::RenderPipeline>,
}

impl CountPipelines {
    pub fn new(device: &wgpu::Device, label: &str, uniforms: &wgpu::BindGroupLayout) -> Self {
        Self {
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &[Some(uniforms)],
                immediate_size: 0,
            }),
            shader: crate::shader::module(device, label, crate::wgsl::PLANAR_COUNT),
            made: HashMap::new(),
            label: label.to_owned(),
        }
    }

    /// Makes those that are missing.
    pub fn make(&mut self, device: &wgpu::Device, keys: impl Iterator<Item = CastKey>) {
        for key in keys {
            if !self.made.contains_key(&key) {
                let pipeline = self.pipeline(device, key);
                self.made.insert(key, pipeline);
            }
        }
    }

    pub fn get(&self, key: &CastKey) -> Option<&wgpu::RenderPipeline> {
        self.made.get(key)
    }

    fn pipeline(&self, device: &wgpu::Device, key: CastKey) -> wgpu::RenderPipeline {
        let (vertex, buffers) = key.vertex();
        // The stencil holds the number of the place that was last counted, from 1.
        let face = wgpu::StencilFaceState {
            compare: wgpu::CompareFunction::NotEqual,
            fail_op: wgpu::StencilOperation::Keep,
            depth_fail_op: wgpu::StencilOperation::Keep,
            pass_op: wgpu::StencilOperation::Replace,
        };
        let add = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&self.label),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.shader,
                entry_point: Some(vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: STENCIL,
                depth_write_enabled: Some(false),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: wgpu::StencilState {
                    front: face,
                    back: face,
                    read_mask: 0xff,
                    write_mask: 0xff,
                },
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some(if key.is_cut() { "count_cut" } else { "count" }),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: COUNTS,
                    blend: Some(wgpu::BlendState {
                        color: add,
                        alpha: add,
                    }),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// `ShadowsPlanarSoft` in WGSL.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct SoftUniform {
    corner: [f32; 4],
    across: [f32; 4],
    down: [f32; 4],
    up: [f32; 4],
}

impl SoftUniform {
    pub fn new(receiver: &PlanarRectangle, size: [u32; 2], samples: u32) -> Self {
        let [across, down] = texture_from_offset(receiver);
        let sides = [receiver.width, receiver.height].map(|side| side.as_dvec3().length());
        let texel = (sides[0] / f64::from(size[0])).max(sides[1] / f64::from(size[1]));
        let narrow = |vector: DVec3, w: f64| vector.extend(w).as_vec4().to_array();
        Self {
            corner: narrow(
                receiver.corner.as_dvec3(),
                f64::from(MOST_SAMPLES) / f64::from(samples),
            ),
            across: narrow(across, 0.0),
            down: narrow(down, 0.0),
            up: narrow(receiver.normal().normalize() / texel, 0.0),
        }
    }
}

/// By which an offset from the corner becomes the part of the width, and of the height, that it is along.
fn texture_from_offset(receiver: &PlanarRectangle) -> [DVec3; 2] {
    let (width, height) = (receiver.width.as_dvec3(), receiver.height.as_dvec3());
    let normal = receiver.normal();
    // The reciprocal basis.
    [
        height.cross(normal) / width.dot(height.cross(normal)),
        normal.cross(width) / height.dot(normal.cross(width)),
    ]
}

/// What world space becomes in the texture's clip space, for points of the plane: four rows, of x, y, z and w.
pub(super) fn clip_rows(receiver: &PlanarRectangle) -> [DVec4; 4] {
    let corner = receiver.corner.as_dvec3();
    let part = |row: DVec3| row.extend(-row.dot(corner));
    let [across, down] = texture_from_offset(receiver).map(part);
    // Depth is in the middle of clip space, whatever a back end makes of it.
    let one = DVec4::W;
    [2.0 * across - one, one - 2.0 * down, 0.5 * one, one]
}

/// What receivers are told, and the group in which they are.
#[derive(Debug)]
pub(super) struct Receiver {
    pub uniform: wgpu::Buffer,
    pub layout: wgpu::BindGroupLayout,
    pub group: wgpu::BindGroup,
}

impl Receiver {
    pub fn new(device: &wgpu::Device, label: &str, counts: &wgpu::TextureView) -> Self {
        let label = format!("{label} receiver");
        let size = size_of::<SoftUniform>() as u64;
        let uniform = buffer(device, &label, size, wgpu::BufferUsages::UNIFORM);
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(&label),
            entries: &[
                entry(
                    0,
                    wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: true },
                        view_dimension: wgpu::TextureViewDimension::D2,
                        multisampled: false,
                    },
                ),
                entry(
                    1,
                    wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                ),
                entry(
                    2,
                    wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Uniform,
                        has_dynamic_offset: false,
                        min_binding_size: wgpu::BufferSize::new(size),
                    },
                ),
            ],
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some(&label),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&label),
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(counts),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::Sampler(&sampler),
                },
                wgpu::BindGroupEntry {
                    binding: 2,
                    resource: uniform.as_entire_binding(),
                },
            ],
        });
        Self {
            uniform,
            layout,
            group,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::SoftUniform;
    use crate::wgsl_layout::assert_layout;

    #[test]
    fn the_shader_has_the_same_layout() {
        assert_layout!(
            crate::wgsl::PLANAR_SOFT,
            "ShadowsPlanarSoft",
            SoftUniform,
            corner,
            across,
            down,
            up,
        );
    }
}
