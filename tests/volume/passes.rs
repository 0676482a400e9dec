//! What a host needs to draw: its passes, its pipelines, its surfaces.

use shadows::glam::Mat4;
use shadows::{ShadowVolumeRenderer, wgpu, wgsl};
use wgpu::util::DeviceExt as _;

use crate::shapes::Shape;
use crate::stage::Stage;
use host::gpu::Gpu;

/// In which order the host multiplies: other orders have other last bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Arithmetic {
    /// `(p * v) * (m * x)`, as `wgsl::POSITION` has it.
    Ours,
    /// `(p * v * m) * x`.
    Premultiplied,
    /// `p * (v * (m * x))`.
    OneByOne,
}

/// One body's geometry as the host draws it.
pub struct Surface {
    pub vertices: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub count: u32,
}

impl Surface {
    /// Its vertices: position, and three matrices of which the last is applied first.
    pub fn new(gpu: &Gpu, shape: &Shape, matrices: [Mat4; 3]) -> Self {
        let buffer = |contents, usage| {
            gpu.device
                .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some("surface"),
                    contents,
                    usage,
                })
        };
        let mut vertices: Vec<f32> = Vec::new();
        for position in &shape.positions {
            vertices.extend(position);
            vertices.extend(matrices.iter().flat_map(Mat4::to_cols_array));
        }
        Self {
            vertices: buffer(bytes_of(&vertices[..]), wgpu::BufferUsages::VERTEX),
            indices: buffer(bytes_of(&shape.indices[..]), wgpu::BufferUsages::INDEX),
            count: shape.indices.len() as u32,
        }
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, 0..1);
    }
}

/// How the host adds its light. Each fragment adds 255 in `Screen`, 100 in the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightPass {
    /// One triangle over the screen.
    Screen,
    /// The scene once more, so many times, where its depth is equal.
    Scene { times: u32, guarded: bool },
}

impl LightPass {
    fn is_unguarded(self) -> bool {
        matches!(self, Self::Scene { guarded: false, .. })
    }

    pub fn draw(self, pass: &mut wgpu::RenderPass<'_>, host: &HostPipelines, surfaces: &[Surface]) {
        match self {
            Self::Screen => {
                pass.set_pipeline(&host.light);
                pass.draw(0..3, 0..1);
            }
            Self::Scene { times, .. } => {
                pass.set_pipeline(&host.light_again);
                for _ in 0..times {
                    surfaces.iter().for_each(|surface| surface.draw(pass));
                }
            }
        }
    }
}

pub fn view_of(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// With a depth to clear to: both aspects are cleared. Without: the depth is read-only.
pub fn attach(
    view: &wgpu::TextureView,
    clear: Option<f32>,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: clear.map(|depth| wgpu::Operations {
            load: wgpu::LoadOp::Clear(depth),
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: (view.texture().format().has_stencil_aspect()).then_some(wgpu::Operations {
            load: match clear {
                Some(_) => wgpu::LoadOp::Clear(0),
                None => wgpu::LoadOp::Load,
            },
            store: wgpu::StoreOp::Store,
        }),
    }
}

pub fn clear<'a>(
    view: &'a wgpu::TextureView,
    color: wgpu::Color,
    resolve_target: Option<&'a wgpu::TextureView>,
) -> wgpu::RenderPassColorAttachment<'a> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(color),
            store: wgpu::StoreOp::Store,
        },
    }
}

pub fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    label: &str,
    colors: &[Option<wgpu::RenderPassColorAttachment<'_>>],
    depth_stencil: wgpu::RenderPassDepthStencilAttachment<'_>,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: colors,
        depth_stencil_attachment: Some(depth_stencil),
        ..Default::default()
    })
}

pub struct HostPipelines {
    pub depth: wgpu::RenderPipeline,
    pub light: wgpu::RenderPipeline,
    pub light_again: wgpu::RenderPipeline,
}

const HOST: &str = "
struct Vertex {
    @location(0) position: vec3f,
    @location(1) a: vec4f, @location(2) b: vec4f, @location(3) c: vec4f, @location(4) d: vec4f,
    @location(5) e: vec4f, @location(6) f: vec4f, @location(7) g: vec4f, @location(8) h: vec4f,
    @location(9) i: vec4f, @location(10) j: vec4f, @location(11) k: vec4f, @location(12) l: vec4f,
}
@vertex fn surface(v: Vertex) -> @invariant @builtin(position) vec4f {
    let middle = mat4x4f(v.e, v.f, v.g, v.h);
    let inner = mat4x4f(v.i, v.j, v.k, v.l);
    return mat4x4f(v.a, v.b, v.c, v.d) * shadows_clip_position(middle, inner, v.position);
}
@vertex fn screen(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}
@fragment fn lit() -> @location(0) vec4f {
    return vec4f(1.0);
}
@fragment fn dim() -> @location(0) vec4f {
    return vec4f(100.0 / 255.0);
}
";

impl HostPipelines {
    pub fn new(gpu: &Gpu, stage: &Stage) -> Self {
        let module = gpu
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("host"),
                source: wgpu::ShaderSource::Wgsl([wgsl::POSITION, HOST].join("\n").into()),
            });
        let attributes = wgpu::vertex_attr_array![
            0 => Float32x3, 1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4,
            5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4,
            9 => Float32x4, 10 => Float32x4, 11 => Float32x4, 12 => Float32x4
        ];
        let layout = wgpu::VertexBufferLayout {
            array_stride: 51 * 4,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        };
        let add = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let targets = [Some(wgpu::ColorTargetState {
            format: wgpu::TextureFormat::R8Unorm,
            blend: Some(wgpu::BlendState {
                color: add,
                alpha: add,
            }),
            write_mask: wgpu::ColorWrites::ALL,
        })];
        let make = |entry, fragment: Option<&str>, write, compare, stencil| {
            let buffers = [Some(layout.clone())];
            gpu.device
                .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                    label: Some("host"),
                    layout: None,
                    vertex: wgpu::VertexState {
                        module: &module,
                        entry_point: Some(entry),
                        compilation_options: Default::default(),
                        buffers: if entry == "screen" { &[] } else { &buffers },
                    },
                    primitive: Default::default(),
                    depth_stencil: Some(wgpu::DepthStencilState {
                        format: stage.format,
                        depth_write_enabled: Some(write),
                        depth_compare: Some(compare),
                        stencil,
                        bias: Default::default(),
                    }),
                    multisample: wgpu::MultisampleState {
                        count: stage.samples,
                        ..Default::default()
                    },
                    fragment: fragment.map(|entry| wgpu::FragmentState {
                        module: &module,
                        entry_point: Some(entry),
                        compilation_options: Default::default(),
                        targets: &targets,
                    }),
                    multiview_mask: None,
                    cache: None,
                })
        };
        let mut guard = ShadowVolumeRenderer::light_pass_stencil();
        if !stage.format.has_stencil_aspect() {
            guard = wgpu::StencilState::default();
        }
        if stage.light_pass.is_unguarded() {
            guard.front.pass_op = wgpu::StencilOperation::Keep;
            guard.back.pass_op = wgpu::StencilOperation::Keep;
        }
        let always = wgpu::CompareFunction::Always;
        let equal = wgpu::CompareFunction::Equal;
        let nearer = stage.depth.nearer();
        Self {
            depth: make("surface", None, true, nearer, Default::default()),
            light: make("screen", Some("lit"), false, always, guard.clone()),
            light_again: make("surface", Some("dim"), false, equal, guard),
        }
    }
}

pub fn bytes_of<T: bytemuck::NoUninit>(data: &[T]) -> &[u8] {
    bytemuck::cast_slice(data)
}
