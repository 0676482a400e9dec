//! The GPU objects of a cube map that stay, whatever its lights do.

use std::num::NonZeroU32;

use super::descriptor::DepthEncoding;
use super::light::LightUniform;
use crate::gl;

/// The rows of a caster's map to positions relative to the light.
pub(super) type Instance = [[f32; 4]; 3];

/// Bytes of one [`Instance`].
pub(super) const INSTANCE_SIZE: u64 = size_of::<Instance>() as u64;

/// Bytes from one uniform to the next: the largest alignment a device may ask for.
pub(super) const UNIFORM_STRIDE: u64 = 256;

/// `ShadowsCubeFaceUniform` in WGSL.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct FaceUniform {
    pub clip_from_light: [f32; 16],
    pub range: f32,
    pub padding: [f32; 3],
}

/// What the lights look like to receivers, one by one and all together.
#[derive(Debug)]
pub(super) struct Lights {
    /// One every [`UNIFORM_STRIDE`] bytes.
    pub uniforms: wgpu::Buffer,
    /// One after the other; only for maps that are cube arrays.
    pub all: Option<wgpu::Buffer>,
}

pub(super) fn lights(device: &wgpu::Device, label: &str, count: u64, array: bool) -> Lights {
    let label = format!("{label} lights");
    let size = size_of::<LightUniform>() as u64;
    Lights {
        uniforms: buffer(
            device,
            &label,
            count * UNIFORM_STRIDE,
            wgpu::BufferUsages::UNIFORM,
        ),
        all: array.then(|| buffer(device, &label, count * size, wgpu::BufferUsages::STORAGE)),
    }
}

pub(super) fn instances(device: &wgpu::Device, label: &str, count: u64) -> wgpu::Buffer {
    buffer(
        device,
        &format!("{label} instances"),
        count * INSTANCE_SIZE,
        wgpu::BufferUsages::VERTEX,
    )
}

/// The matrices of six faces for each light, picked by dynamic offset.
pub(super) fn faces(
    device: &wgpu::Device,
    label: &str,
    lights: u64,
) -> (wgpu::Buffer, wgpu::BindGroupLayout, wgpu::BindGroup) {
    let faces = buffer(
        device,
        &format!("{label} faces"),
        lights * 6 * UNIFORM_STRIDE,
        wgpu::BufferUsages::UNIFORM,
    );
    let size = wgpu::BufferSize::new(size_of::<FaceUniform>() as u64);
    let (layout, group) = face_group(device, label, &faces, size);
    (faces, layout, group)
}

/// A binding of some bytes of the faces' matrices, picked by dynamic offset.
pub(super) fn face_group(
    device: &wgpu::Device,
    label: &str,
    faces: &wgpu::Buffer,
    size: Option<wgpu::BufferSize>,
) -> (wgpu::BindGroupLayout, wgpu::BindGroup) {
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
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
                buffer: faces,
                offset: 0,
                size,
            }),
        }],
    });
    (layout, group)
}

/// All that two draws must share to use the same pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct PipelineKey {
    /// Bytes between positions.
    pub stride: u64,
    pub cull: Option<wgpu::Face>,
}

/// What all pipelines of one map share.
#[derive(Debug)]
pub(super) struct PipelineKind {
    pub layout: wgpu::PipelineLayout,
    pub shader: wgpu::ShaderModule,
    pub format: wgpu::TextureFormat,
    pub encoding: DepthEncoding,
    pub slope_scale: f32,
    /// Whether casters before the near plane are pulled onto it.
    pub unclipped_depth: bool,
    /// Whether fragments write the depth, in every encoding.
    pub depth_written: bool,
    /// Constants of the vertex shader.
    pub constants: &'static [(&'static str, f64)],
}

/// Whether casters before a near plane can be pulled onto it. There they still are before every
/// receiver. What is behind the light stays clipped by the sides of the frustum, which meet in it; so
/// on a cube face, too, nothing is drawn that does not lie in the face's own pyramid.
pub(super) fn can_pull_casters(device: &wgpu::Device) -> bool {
    let features = device.features();
    features.contains(wgpu::Features::DEPTH_CLIP_CONTROL) || writes_depth(device)
}

/// Whether fragments write the depth, because vertices cannot: see `cube_caster_gl.wgsl`. What fragments
/// write is never clipped.
pub(super) fn writes_depth(device: &wgpu::Device) -> bool {
    gl::is_gl(device)
}

/// Draws casters on one face a pass.
pub(super) fn caster_shader(device: &wgpu::Device, label: &str) -> wgpu::ShaderModule {
    let source = match writes_depth(device) {
        false => crate::wgsl::CUBE_CASTER,
        true => crate::wgsl::CUBE_CASTER_GL,
    };
    crate::shader::module(device, label, source)
}

/// `views`: the faces that are drawn at once, by a shader that knows which it is on.
pub(super) fn pipeline(
    device: &wgpu::Device,
    label: &str,
    kind: &PipelineKind,
    key: PipelineKey,
    views: Option<NonZeroU32>,
) -> wgpu::RenderPipeline {
    let (vertex, fragment) = match (kind.encoding, kind.depth_written) {
        (DepthEncoding::MajorAxis, false) => ("vertex", None),
        (DepthEncoding::MajorAxis, true) => ("vertex", Some("fragment_depth")),
        (DepthEncoding::LinearDistance, _) => ("vertex_distance", Some("fragment_distance")),
    };
    let written = [
        ("slope_scale", f64::from(kind.slope_scale)),
        ("pulled", f64::from(u8::from(kind.unclipped_depth))),
    ];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(&kind.layout),
        vertex: wgpu::VertexState {
            module: &kind.shader,
            entry_point: Some(vertex),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: kind.constants,
                ..Default::default()
            },
            buffers: &[
                Some(wgpu::VertexBufferLayout {
                    array_stride: key.stride,
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
        primitive: wgpu::PrimitiveState {
            cull_mode: key.cull,
            unclipped_depth: kind.unclipped_depth && !kind.depth_written,
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: kind.format,
            depth_write_enabled: Some(true),
            depth_compare: Some(kind.encoding.nearer()),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState {
                // Away from the light is down in reverse-Z.
                slope_scale: -kind.slope_scale,
                ..Default::default()
            },
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: fragment.map(|entry_point| wgpu::FragmentState {
            module: &kind.shader,
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: if kind.depth_written { &written } else { &[] },
                ..Default::default()
            },
            targets: &[],
        }),
        multiview_mask: views,
        cache: None,
    })
}

pub(super) fn buffer(
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
