//! Casters that only the host can draw: leaves that a mask is cut out of, drawn into the library's passes.

use shadows::glam::{Affine3A, Mat4};
use shadows::mesh::Bounds;
use shadows::{Caster, CasterMesh, HostDraw, wgpu};

use super::gpu::Gpu;
use super::pipelines::VERTEX_BUFFERS;
use super::scene::{self, Scene, leaf_mask};
use super::scene_gpu::SceneGpu;

/// Draws those of a scene's casters that have a mask into shadow maps, where
/// [`encode_with`](shadows::ShadowAtlas::encode_with) asks for them.
pub struct MaskedCasters {
    /// What stands for all of them among a frame's casters.
    pub caster: Caster,
    group: wgpu::BindGroup,
    matrices: wgpu::Buffer,
    matrix_stride: u32,
    tiles: u32,
    pipeline: wgpu::RenderPipeline,
}

impl MaskedCasters {
    /// For maps of a format in which what is nearer is greater, with so many tiles (a flat map has one,
    /// a cube six): each has a matrix of its own.
    ///
    /// # Errors
    /// If the scene has no such caster.
    pub fn new(
        gpu: &Gpu,
        (scene, scene_gpu): (&Scene, &SceneGpu),
        format: wgpu::TextureFormat,
        tiles: u32,
    ) -> anyhow::Result<Self> {
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
                one_of(1, &scene_gpu.object_uniforms, size_of::<Mat4>()),
            ],
        });
        Ok(Self {
            caster: caster(gpu, scene)?,
            group,
            matrices,
            matrix_stride,
            tiles,
            pipeline: pipeline(gpu, &layout, format),
        })
    }

    /// Draws what is asked for into its tile's pass.
    pub fn draw(
        &self,
        gpu: &Gpu,
        scene: &SceneGpu,
        pass: &mut wgpu::RenderPass<'_>,
        asked: &HostDraw<'_>,
    ) {
        assert!((asked.tile as u32) < self.tiles, "made for fewer tiles");
        // Written before anything that is submitted after it.
        let matrix_at = asked.tile as u32 * self.matrix_stride;
        let matrix = asked.clip_from_world.to_cols_array();
        gpu.queue.write_buffer(
            &self.matrices,
            matrix_at.into(),
            bytemuck::cast_slice(&matrix),
        );
        pass.set_pipeline(&self.pipeline);
        for casting in &scene.casting {
            let mesh = &scene.meshes[scene.objects[casting.place].mesh];
            let Some(mask) = mesh.mask.as_ref().filter(|_| mesh.index_count > 0) else {
                continue;
            };
            let object = casting.place as u32 * scene.object_stride;
            pass.set_bind_group(0, &self.group, &[matrix_at, object]);
            pass.set_vertex_buffer(0, mesh.positions.slice(..));
            pass.set_vertex_buffer(1, mask.slice(..));
            pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..mesh.index_count, 0, 0..1);
        }
    }
}

/// What stands for all casters with a mask: their bounds.
fn caster(gpu: &Gpu, scene: &Scene) -> anyhow::Result<Caster> {
    let is_masked =
        |object: &&scene::Object| object.casts && !scene.meshes[object.mesh].mask.is_empty();
    let masked = || scene.objects.iter().filter(is_masked);
    let bounds = scene::Bounds::of(masked().flat_map(|object| scene.world_points(object)));
    let triangles: usize = masked()
        .map(|object| scene.meshes[object.mesh].triangle_count())
        .sum();
    let bounds = Bounds {
        min: bounds.min.as_vec3(),
        max: bounds.max.as_vec3(),
    };
    let mesh = CasterMesh::host_drawn(&gpu.device, bounds, triangles as u32)?;
    Ok(Caster::new(mesh, Affine3A::IDENTITY))
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
            entry_point: Some("host_caster_vertex"),
            compilation_options: Default::default(),
            buffers: &both,
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
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("host_caster_mask"),
            compilation_options: Default::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}
