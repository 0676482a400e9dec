//! Other engines' shadow maps, drawn by their conventions (`peer_light`). Every caster is drawn on every
//! face, every frame.

use shadows::glam::Mat4;
use shadows::mesh::MeshKind;
use shadows::reference::Interior;
use shadows::wgpu;

use super::gpu::Gpu;
use super::peer_light::{Convention, PeerInputs};
use super::peers::Peer;
use super::scene_gpu::SceneGpu;

const CASTER: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;
@group(0) @binding(1) var<uniform> world_from_object: mat4x4f;
@vertex fn caster(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return clip_from_world * (world_from_object * vec4f(position, 1.0));
}
";

/// Between the matrices of faces, in bytes.
const STRIDE: u64 = 256;

/// Of the last frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct PeerStatistics {
    pub bytes: u64,
    pub draws: u32,
    pub triangles: u64,
}

/// An engine's map, and the binding by which its receiver reads it.
pub struct PeerMap {
    peer: &'static Peer,
    size: u32,
    device: wgpu::Device,
    convention: Convention,
    faces: Vec<wgpu::TextureView>,
    /// Nothing culled, back faces culled, front faces culled.
    pipelines: [wgpu::RenderPipeline; 3],
    caster_layout: wgpu::BindGroupLayout,
    matrices: wgpu::Buffer,
    clip_from_world: Mat4,
    light: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    statistics: PeerStatistics,
}

impl PeerMap {
    /// A map of `size` texels a side.
    pub fn new(gpu: &Gpu, peer: &'static Peer, size: u32) -> Self {
        let device = &gpu.device;
        let convention = Convention::of(peer);
        let layers = if peer.is_cube() { 6 } else { 1 };
        let texture = texture(device, convention.format, size, layers);
        let faces = (0..layers).map(|layer| face_view(&texture, layer));
        let faces = faces.collect();
        let caster_layout = caster_layout(device);
        let cull = [None, Some(wgpu::Face::Back), Some(wgpu::Face::Front)];
        let pipelines = cull.map(|cull| pipeline(device, &convention, &caster_layout, cull));
        let uniform = |bytes| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(peer.name),
                size: bytes,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let (matrices, light) = (uniform(6 * STRIDE), uniform(96));
        let layout = receiver_layout(device, peer);
        let group = receiver_group(device, &layout, peer, &convention, (&texture, &light));
        Self {
            peer,
            size,
            device: device.clone(),
            convention,
            faces,
            pipelines,
            caster_layout,
            matrices,
            clip_from_world: Mat4::IDENTITY,
            light,
            layout,
            group,
            statistics: PeerStatistics::default(),
        }
    }

    /// WGSL for the host's lit pass.
    pub fn module(&self) -> String {
        self.peer.wgsl()
            + "
fn host_visibility(at: HostReceiver) -> f32 {
    return peer_visibility(at.world, at.normal, at.pixel);
}
"
    }

    pub fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.group
    }

    pub fn statistics(&self) -> PeerStatistics {
        self.statistics
    }

    /// Of a flat map, as it was last prepared.
    pub fn clip_from_world(&self) -> Mat4 {
        self.clip_from_world
    }

    /// Where resolution is no excuse for an error.
    pub fn interior(&self) -> Interior {
        let kernel_radius = self.peer.reach_in_texels(self.size);
        match self.peer.is_cube() {
            true => Interior::Map {
                face_size: self.size,
                kernel_radius,
            },
            false => Interior::FlatMap {
                clip_from_world: self.clip_from_world,
                size: self.size,
                kernel_radius,
            },
        }
    }

    /// Matrices and the receiver's uniform, at once.
    pub fn prepare(&mut self, gpu: &Gpu, inputs: &PeerInputs) {
        let (peer, size) = (self.peer, self.size);
        let faces = self.convention.faces(peer, inputs);
        for (face, matrix) in (0..).zip(&faces) {
            let bytes = bytemuck::bytes_of(matrix);
            gpu.queue.write_buffer(&self.matrices, face * STRIDE, bytes);
        }
        self.clip_from_world = faces[0];
        let light = self.convention.uniform(peer, inputs, size);
        gpu.queue
            .write_buffer(&self.light, 0, bytemuck::cast_slice(&light));
    }

    /// Records the drawing of all faces.
    pub fn encode(&mut self, scene: &SceneGpu, encoder: &mut wgpu::CommandEncoder) {
        let group = self.caster_group(scene);
        let format = self.convention.format;
        let texel = format.block_copy_size(Some(wgpu::TextureAspect::DepthOnly));
        let texels = self.faces.len() as u64 * u64::from(self.size).pow(2);
        self.statistics = PeerStatistics {
            bytes: texels * u64::from(texel.unwrap_or(4)),
            ..Default::default()
        };
        for face in 0..self.faces.len() {
            self.draw_face(scene, &group, face, encoder);
        }
    }

    fn draw_face(
        &mut self,
        scene: &SceneGpu,
        group: &wgpu::BindGroup,
        face: usize,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let nothing = if self.convention.reverse { 0.0 } else { 1.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(self.peer.name),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.faces[face],
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(nothing),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        for casting in &scene.casting {
            let mesh = &scene.meshes[scene.objects[casting.place].mesh];
            if mesh.index_count == 0 {
                continue;
            }
            // Faces are left-handed, which turns windings around, as a mirroring transform does.
            let turned = self.peer.is_cube() != casting.mirrored;
            pass.set_pipeline(match mesh.kind {
                MeshKind::General if self.convention.open_both_sides => &self.pipelines[0],
                _ if turned == self.convention.far_sides => &self.pipelines[1],
                _ => &self.pipelines[2],
            });
            let object = casting.place as u32 * scene.object_stride;
            pass.set_bind_group(0, group, &[face as u32 * STRIDE as u32, object]);
            pass.set_vertex_buffer(0, mesh.positions.slice(..));
            pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..mesh.index_count, 0, 0..1);
            self.statistics.draws += 1;
            self.statistics.triangles += u64::from(mesh.index_count / 3);
        }
    }

    fn caster_group(&self, scene: &SceneGpu) -> wgpu::BindGroup {
        let matrix = |buffer| {
            wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer,
                offset: 0,
                size: wgpu::BufferSize::new(64),
            })
        };
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.peer.name),
            layout: &self.caster_layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: matrix(&self.matrices),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: matrix(&scene.object_uniforms),
                },
            ],
        })
    }
}

fn texture(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    size: u32,
    layers: u32,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("peer"),
        size: wgpu::Extent3d {
            width: size,
            height: size,
            depth_or_array_layers: layers,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

fn face_view(texture: &wgpu::Texture, layer: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

fn caster_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let matrix = |binding| wgpu::BindGroupLayoutEntry {
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
        label: Some("peer casters"),
        entries: &[matrix(0), matrix(1)],
    })
}

fn pipeline(
    device: &wgpu::Device,
    convention: &Convention,
    layout: &wgpu::BindGroupLayout,
    cull_mode: Option<wgpu::Face>,
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("peer casters"),
        source: wgpu::ShaderSource::Wgsl(CASTER.into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("peer casters"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    let can_clamp = device
        .features()
        .contains(wgpu::Features::DEPTH_CLIP_CONTROL);
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("peer casters"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("caster"),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 12,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            })],
        },
        primitive: wgpu::PrimitiveState {
            cull_mode,
            unclipped_depth: convention.unclipped && can_clamp,
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: convention.format,
            depth_write_enabled: Some(true),
            depth_compare: Some(convention.nearer_or_equal()),
            stencil: wgpu::StencilState::default(),
            bias: convention.bias,
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    })
}

fn dimension(peer: &Peer) -> wgpu::TextureViewDimension {
    match peer.is_cube() {
        true => wgpu::TextureViewDimension::Cube,
        false => wgpu::TextureViewDimension::D2,
    }
}

fn receiver_layout(device: &wgpu::Device, peer: &Peer) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let map = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: dimension(peer),
        multisampled: false,
    };
    let light = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(peer.name),
        entries: &[entry(0, map), entry(1, sampler), entry(2, light)],
    })
}

fn receiver_group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    peer: &Peer,
    convention: &Convention,
    (map, light): (&wgpu::Texture, &wgpu::Buffer),
) -> wgpu::BindGroup {
    let map = map.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(dimension(peer)),
        ..Default::default()
    });
    let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some(peer.name),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        compare: Some(convention.nearer_or_equal()),
        ..Default::default()
    });
    let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(peer.name),
        layout,
        entries: &[
            entry(0, wgpu::BindingResource::TextureView(&map)),
            entry(1, wgpu::BindingResource::Sampler(&sampler)),
            entry(2, light.as_entire_binding()),
        ],
    })
}
