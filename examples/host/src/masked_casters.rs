//! Casters that only the host can draw: leaves that a mask is cut out of, drawn into the library's passes.

use shadows::glam::{Affine3A, Mat4};
use shadows::mesh::Bounds;
use shadows::{Cascades, Caster, CasterMesh, HostDraw, wgpu};

use super::gpu::Gpu;
use super::pipelines::VERTEX_BUFFERS;
use super::scene::{self, Scene, leaf_mask};
use super::scene_gpu::SceneGpu;

/// Of the maps that they are drawn into.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// The most tiles of a light: six faces, or its cascades.
const TILES: u32 = Cascades::MOST;

/// Draws those of a scene's casters that have a mask into shadow maps, where
/// [`encode_with`](shadows::ShadowAtlas::encode_with) asks for them.
pub struct MaskedCasters {
    /// What stands for them among a frame's casters, one for each.
    pub casters: Vec<Caster>,
    /// Their places among the scene's objects.
    objects: Vec<usize>,
    group: wgpu::BindGroup,
    /// One for each tile of each light of one map.
    matrices: wgpu::Buffer,
    matrix_stride: u32,
    pipeline: wgpu::RenderPipeline,
    queue: wgpu::Queue,
}

impl MaskedCasters {
    /// For a scene whose objects are on the GPU; `None` if none of them casts through a mask.
    ///
    /// # Errors
    /// If one's bounds are not finite.
    pub(super) fn new(
        gpu: &Gpu,
        scene: &Scene,
        object_uniforms: &wgpu::Buffer,
    ) -> anyhow::Result<Option<Self>> {
        let objects = scene.objects.iter().enumerate();
        let objects: Vec<usize> = objects
            .filter(|(_, object)| object.casts && !scene.meshes[object.mesh].mask.is_empty())
            .map(|(place, _)| place)
            .collect();
        if objects.is_empty() {
            return Ok(None);
        }
        let device = &gpu.device;
        let alignment = device.limits().min_uniform_buffer_offset_alignment;
        let matrix_stride = (size_of::<Mat4>() as u32).next_multiple_of(alignment);
        let tiles = TILES * scene.lights.len() as u32;
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
                one_of(1, object_uniforms, size_of::<Mat4>()),
            ],
        });
        let casters = objects.iter().map(|&place| caster(gpu, scene, place));
        Ok(Some(Self {
            casters: casters.collect::<anyhow::Result<_>>()?,
            objects,
            group,
            matrices,
            matrix_stride,
            pipeline: pipeline(gpu, &layout),
            queue: gpu.queue.clone(),
        }))
    }

    /// Draws what is asked for into its tile's pass, for a frame in whose casters [`casters`](Self::casters)
    /// begin at the place `first`.
    pub(super) fn draw(
        &self,
        scene: &SceneGpu,
        first: usize,
        pass: &mut wgpu::RenderPass<'_>,
        asked: &HostDraw<'_>,
    ) {
        // Written before anything that is submitted after it, so that every tile needs its own.
        let matrix_at = (asked.light as u32 * TILES + asked.tile as u32) * self.matrix_stride;
        let matrix = asked.clip_from_world.to_cols_array();
        self.queue.write_buffer(
            &self.matrices,
            matrix_at.into(),
            bytemuck::cast_slice(&matrix),
        );
        pass.set_pipeline(&self.pipeline);
        for place in asked.casters {
            let object = self.objects[place - first];
            let mesh = &scene.meshes[scene.objects[object].mesh];
            let Some(mask) = mesh.mask.as_ref().filter(|_| mesh.index_count > 0) else {
                continue;
            };
            let object_at = object as u32 * scene.object_stride;
            pass.set_bind_group(0, &self.group, &[matrix_at, object_at]);
            pass.set_vertex_buffer(0, mesh.positions.slice(..));
            pass.set_vertex_buffer(1, mask.slice(..));
            pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..mesh.index_count, 0, 0..1);
        }
    }
}

/// What stands for one object: its bounds.
fn caster(gpu: &Gpu, scene: &Scene, place: usize) -> anyhow::Result<Caster> {
    let object = &scene.objects[place];
    let bounds = scene::Bounds::of(scene.world_points(object));
    let bounds = Bounds {
        min: bounds.min.as_vec3(),
        max: bounds.max.as_vec3(),
    };
    let triangles = scene.meshes[object.mesh].triangle_count() as u32;
    let mesh = CasterMesh::host_drawn(&gpu.device, bounds, triangles)?;
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

fn pipeline(gpu: &Gpu, layout: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
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
            format: FORMAT,
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
