//! Blobs as instances that are drawn over the host's depth.

use wgpu::util::DeviceExt as _;

use super::descriptor::{BlobDecalDescriptor, BlobShadowDescriptor};
use super::receivers::visibility;
use super::records::{BlobRecord, STRIDE};
use crate::error::BlobShadowError;
use crate::shader;

const DECAL: &str = include_str!("../../shaders/blob_decal.wgsl");
/// Of a hull: six quads of two triangles.
pub(super) const INDICES: u32 = 36;

/// The pipeline, and what it reads besides blobs and lights.
#[derive(Debug)]
pub(super) struct Decals {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    indices: wgpu::Buffer,
}

impl Decals {
    pub fn new(
        device: &wgpu::Device,
        label: &str,
        descriptor: &BlobShadowDescriptor<'_>,
        decals: &BlobDecalDescriptor,
    ) -> Self {
        let layout = layout(device, label);
        let module = shader::module(device, label, source(descriptor.strips));
        Self {
            pipeline: pipeline(device, label, &layout, &module, decals),
            layout,
            indices: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(&format!("{label} hull")),
                contents: bytemuck::cast_slice(&indices()),
                usage: wgpu::BufferUsages::INDEX,
            }),
        }
    }

    /// A group that reads a depth texture.
    pub fn group(
        &self,
        device: &wgpu::Device,
        label: &str,
        [views, lights]: [&wgpu::Buffer; 2],
        depth: &wgpu::TextureView,
    ) -> Result<wgpu::BindGroup, BlobShadowError> {
        let texture = depth.texture();
        check_depth(texture)?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            label: Some(label),
            dimension: Some(wgpu::TextureViewDimension::D2),
            aspect: wgpu::TextureAspect::DepthOnly,
            mip_level_count: Some(1),
            ..Default::default()
        });
        let one_of = |buffer| {
            wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer,
                offset: 0,
                size: wgpu::BufferSize::new(STRIDE),
            })
        };
        let resources = [
            one_of(views),
            one_of(lights),
            wgpu::BindingResource::TextureView(&view),
        ];
        let entries: Vec<_> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        Ok(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(label),
            layout: &self.layout,
            entries: &entries,
        }))
    }

    /// Draws so many instances in one draw.
    pub fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        group: &wgpu::BindGroup,
        [view, light]: [usize; 2],
        (instances, count): (wgpu::BufferSlice<'_>, u32),
    ) {
        let offsets = [view, light].map(|place| place as u32 * STRIDE as u32);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &offsets);
        pass.set_vertex_buffer(0, instances);
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint16);
        pass.draw_indexed(0..INDICES, 0, 0..count);
    }
}

/// Whether shaders can read it as one picture.
fn check_depth(texture: &wgpu::Texture) -> Result<(), BlobShadowError> {
    let format = texture.format();
    let readable = texture
        .usage()
        .contains(wgpu::TextureUsages::TEXTURE_BINDING);
    let (samples, layers) = (texture.sample_count(), texture.depth_or_array_layers());
    let is_picture = samples == 1 && layers == 1;
    match format.has_depth_aspect() && readable && is_picture {
        true => Ok(()),
        false => Err(BlobShadowError::Depth {
            format,
            usage: texture.usage(),
            samples,
            layers,
        }),
    }
}

pub(super) fn source(strips: u32) -> String {
    visibility(strips) + DECAL
}

fn layout(device: &wgpu::Device, label: &str) -> wgpu::BindGroupLayout {
    let uniform = |binding, visibility| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: wgpu::BufferSize::new(STRIDE),
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[
            uniform(0, wgpu::ShaderStages::VERTEX_FRAGMENT),
            uniform(1, wgpu::ShaderStages::VERTEX_FRAGMENT),
            wgpu::BindGroupLayoutEntry {
                binding: 2,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            },
        ],
    })
}

fn pipeline(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    module: &wgpu::ShaderModule,
    decals: &BlobDecalDescriptor,
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    let component = |src_factor, dst_factor| wgpu::BlendComponent {
        src_factor,
        dst_factor,
        operation: wgpu::BlendOperation::Add,
    };
    use wgpu::BlendFactor as F;
    let multiply = wgpu::BlendState {
        color: component(F::Dst, F::Zero),
        alpha: component(F::Zero, F::One),
    };
    let depth = |format| wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(false),
        depth_compare: Some(wgpu::CompareFunction::Always),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("shadows_blob_vertex"),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<BlobRecord>() as u64,
                step_mode: wgpu::VertexStepMode::Instance,
                attributes: &wgpu::vertex_attr_array![
                    0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x4
                ],
            })],
        },
        primitive: wgpu::PrimitiveState {
            cull_mode: Some(wgpu::Face::Front),
            ..Default::default()
        },
        depth_stencil: decals.depth_stencil_format.map(depth),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("shadows_blob_fragment"),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: decals.target_format,
                blend: Some(multiply),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Corners of a hull, a bit of the number for each axis, counter-clockwise seen from outside.
fn indices() -> Vec<u16> {
    let quad = [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]];
    let mut indices = Vec::with_capacity(INDICES as usize);
    for (axis, side) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)] {
        for [a, b] in quad {
            // The next two axes turn counter-clockwise around this one.
            let [a, b] = if side == 1 { [a, b] } else { [b, a] };
            indices.push(side << axis | a << ((axis + 1) % 3) | b << ((axis + 2) % 3));
        }
    }
    indices
}

#[cfg(test)]
mod tests {
    use super::indices;
    use glam::Vec3;

    #[test]
    fn triangles_of_a_hull_face_outward() {
        let corner = |bits: u16| {
            let axis = |axis: u16| f32::from(bits >> axis & 1) - 0.5;
            Vec3::new(axis(0), axis(1), axis(2))
        };
        let mut volume = 0.0;
        for [a, b, c] in indices().as_chunks::<3>().0 {
            let [a, b, c] = [a, b, c].map(|&bits| corner(bits));
            let six = a.dot(b.cross(c));
            assert!(six > 0.0, "{a} {b} {c}");
            volume += six / 6.0;
        }
        // Twelve sixths, each rounded.
        assert!((volume - 1.0).abs() < 1e-6, "{volume}");
    }
}
