//! Casters that only the host can draw: leaves that a mask is cut out of, drawn into any depth pass.

use shadows::glam::Mat4;
use shadows::wgpu;

use super::gpu::Gpu;
use super::pipelines::VERTEX_BUFFERS;
use super::scene::leaf_mask;
use super::scene_gpu::SceneGpu;

/// Draws a scene's casters into shadow maps: those with a mask, or all of them, for a pass whose
/// content was cleared.
pub struct MaskedCasters {
    group: wgpu::BindGroup,
    matrices: wgpu::Buffer,
    matrix_stride: u32,
    solid: wgpu::RenderPipeline,
    masked: wgpu::RenderPipeline,
}

/// Which casters are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// Those with a mask, beside what the library drew.
    Masked,
    All,
}

impl MaskedCasters {
    /// For maps of a format in which what is nearer is greater, with so many tiles (a flat map has one,
    /// a cube six): each has a matrix of its own.
    pub fn new(gpu: &Gpu, scene: &SceneGpu, format: wgpu::TextureFormat, tiles: u32) -> Self {
        let device = &gpu.device;
        let alignment = device.limits().min_uniform_buffer_offset_alignment;
        let matrix_stride = (size_of::<Mat4>() as u32).next_multiple_of(alignment);
        let matrices = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("tiles' matrices"),
            size: u64::from(matrix_stride * tiles),
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let layout = layout(device);
        let one_of = |binding, buffer, size: usize| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer,
                offset: 0,
                size: wgpu::BufferSize::new(size as u64),
            }),
        };
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("masked casters"),
            layout: &layout,
            entries: &[
                one_of(0, &matrices, size_of::<Mat4>()),
                // An object's matrix is the first of what the host tells its shaders of it.
                one_of(1, &scene.object_uniforms, size_of::<Mat4>()),
            ],
        });
        let pipeline = |masked| pipeline(gpu, &layout, format, masked);
        Self {
            group,
            matrices,
            matrix_stride,
            solid: pipeline(false),
            masked: pipeline(true),
        }
    }

    /// Says what a tile's clip space is, before the passes that draw it are submitted.
    pub fn set(&self, gpu: &Gpu, tile: u32, clip_from_world: Mat4) {
        let at = u64::from(tile * self.matrix_stride);
        let matrix = clip_from_world.to_cols_array();
        gpu.queue
            .write_buffer(&self.matrices, at, bytemuck::cast_slice(&matrix));
    }

    /// Draws casters of the scene into a tile's pass.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, scene: &SceneGpu, tile: u32, which: Which) {
        for casting in &scene.casting {
            let mesh = &scene.meshes[scene.objects[casting.place].mesh];
            if mesh.index_count == 0 || (mesh.mask.is_none() && which == Which::Masked) {
                continue;
            }
            match &mesh.mask {
                Some(mask) => {
                    pass.set_pipeline(&self.masked);
                    pass.set_vertex_buffer(1, mask.slice(..));
                }
                None => pass.set_pipeline(&self.solid),
            }
            let object = casting.place as u32 * scene.object_stride;
            pass.set_bind_group(0, &self.group, &[tile * self.matrix_stride, object]);
            pass.set_vertex_buffer(0, mesh.positions.slice(..));
            pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..mesh.index_count, 0, 0..1);
        }
    }
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: None,
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("masked casters"),
        entries: &[entry(0), entry(1)],
    })
}

fn pipeline(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
    masked: bool,
) -> wgpu::RenderPipeline {
    let device = &gpu.device;
    let source = leaf_mask::wgsl() + include_str!("shaders/caster.wgsl");
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("masked casters"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let [positions, _, mask] = VERTEX_BUFFERS;
    let both = [positions, mask];
    let clips = device
        .features()
        .contains(wgpu::Features::DEPTH_CLIP_CONTROL);
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("masked casters"),
        layout: Some(
            &device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("masked casters"),
                bind_group_layouts: &[Some(layout)],
                immediate_size: 0,
            }),
        ),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(if masked {
                "host_caster_vertex"
            } else {
                "host_solid_vertex"
            }),
            compilation_options: Default::default(),
            buffers: if masked { &both[..] } else { &both[..1] },
        },
        // Leaves have two sides; what is nearer than the near plane casts from there.
        primitive: wgpu::PrimitiveState {
            unclipped_depth: clips,
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: masked.then(|| wgpu::FragmentState {
            module: &module,
            entry_point: Some("host_caster_mask"),
            compilation_options: Default::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}
