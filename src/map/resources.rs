//! The GPU objects of a cube map.

use super::cube::LightUniform;
use super::cull::INSTANCE_SIZE;
use super::face::CubeFace;

/// Depth of the map's texels.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Bytes from one face's matrix to the next: the largest alignment a device may ask for.
pub(super) const MATRIX_STRIDE: u64 = 256;

pub(super) fn texture(device: &wgpu::Device, label: &str, size: u32) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d {
            width: size,
            height: size,
            depth_or_array_layers: 6,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

pub(super) fn cube_view(texture: &wgpu::Texture, label: &str) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some(label),
        dimension: Some(wgpu::TextureViewDimension::Cube),
        ..Default::default()
    })
}

pub(super) fn face_view(texture: &wgpu::Texture, label: &str, face: CubeFace) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some(&format!("{label} {face:?}")),
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: face.layer(),
        array_layer_count: Some(1),
        ..Default::default()
    })
}

pub(super) fn light_uniform(device: &wgpu::Device, label: &str) -> wgpu::Buffer {
    buffer(
        device,
        &format!("{label} light"),
        size_of::<LightUniform>() as u64,
        wgpu::BufferUsages::UNIFORM,
    )
}

pub(super) fn instances(device: &wgpu::Device, label: &str, count: usize) -> wgpu::Buffer {
    buffer(
        device,
        &format!("{label} instances"),
        count as u64 * INSTANCE_SIZE,
        wgpu::BufferUsages::VERTEX,
    )
}

/// The matrices of the six faces, picked by dynamic offset.
pub(super) fn matrices(
    device: &wgpu::Device,
    label: &str,
) -> (wgpu::Buffer, wgpu::BindGroupLayout, wgpu::BindGroup) {
    let matrices = buffer(
        device,
        &format!("{label} matrices"),
        6 * MATRIX_STRIDE,
        wgpu::BufferUsages::UNIFORM,
    );
    let size = wgpu::BufferSize::new(size_of::<glam::Mat4>() as u64);
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: true,
                min_binding_size: size,
            },
            count: None,
        }],
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout: &layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &matrices,
                offset: 0,
                size,
            }),
        }],
    });
    (matrices, layout, group)
}

pub(super) fn pipeline(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::PipelineLayout,
    shader: &wgpu::ShaderModule,
    stride: u64,
) -> wgpu::RenderPipeline {
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module: shader,
            entry_point: Some("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[
                Some(wgpu::VertexBufferLayout {
                    array_stride: stride,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x3],
                }),
                Some(wgpu::VertexBufferLayout {
                    array_stride: INSTANCE_SIZE,
                    step_mode: wgpu::VertexStepMode::Instance,
                    attributes: &wgpu::vertex_attr_array![
                        1 => Float32x4, 2 => Float32x4, 3 => Float32x4
                    ],
                }),
            ],
        },
        // Both sides cast: an open mesh has no back to cull.
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    })
}

fn buffer(
    device: &wgpu::Device,
    label: &str,
    size: u64,
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
