//! A small host: depth prepass, stencil pass, light pass; and the same scene for the reference.

use shadows::glam::camera::rh::{proj::directx as proj, view};
use shadows::glam::{Affine3A, DAffine3, DMat4, Mat4, Vec3};
use shadows::mesh::{Adjacency, Bounds};
use shadows::reference::{Class, Interior, ReferenceImage, ReferenceObject, ReferenceScene};
use shadows::{
    Caster, CasterMesh, DepthConvention, HomogeneousLight, HostPositions, ShadowVolumeDescriptor,
    ShadowVolumeFrame, ShadowVolumeRenderer, View, wgpu, wgsl,
};
use wgpu::util::DeviceExt as _;

use crate::host::gpu::Gpu;
use crate::shapes::Shape;

pub const SIDE: u32 = 256;

/// A shape somewhere in the world.
#[derive(Clone, Debug)]
pub struct Body {
    pub shape: Shape,
    pub transform: Affine3A,
    pub casts: bool,
}

impl Body {
    pub fn caster(shape: Shape, transform: Affine3A) -> Self {
        Self {
            shape,
            transform,
            casts: true,
        }
    }

    pub fn receiver(shape: Shape, transform: Affine3A) -> Self {
        Self {
            casts: false,
            ..Self::caster(shape, transform)
        }
    }
}

/// Everything a picture depends on.
#[derive(Clone, Debug)]
pub struct Stage {
    pub bodies: Vec<Body>,
    pub light: HomogeneousLight,
    pub eye: Vec3,
    pub target: Vec3,
    pub field_of_view: f32,
    pub near: f32,
    pub depth: DepthConvention,
    pub format: wgpu::TextureFormat,
    pub samples: u32,
    pub cap_bias_ulps: u32,
    /// Whether the host multiplies its matrices before the positions: other last bits.
    pub premultiplied: bool,
    /// Bytes between positions and before the first, in a buffer of the host's.
    pub host_layout: Option<(usize, usize)>,
    pub light_pass: LightPass,
}

impl Stage {
    /// Casters over a large ground, seen from the front and above.
    pub fn new(light: HomogeneousLight, casters: Vec<Body>) -> Self {
        let ground = Body::receiver(crate::shapes::square(30.0), Affine3A::IDENTITY);
        Self {
            bodies: std::iter::once(ground).chain(casters).collect(),
            light,
            eye: Vec3::new(1.0, 5.0, 9.0),
            target: Vec3::new(0.0, 0.5, 0.0),
            field_of_view: 0.9,
            near: 0.1,
            depth: DepthConvention::InfiniteReverse,
            format: wgpu::TextureFormat::Depth24PlusStencil8,
            samples: 1,
            cap_bias_ulps: ShadowVolumeDescriptor::default().cap_bias_ulps,
            premultiplied: false,
            host_layout: None,
            light_pass: LightPass::Screen,
        }
    }

    pub fn view(&self) -> View {
        let far = 1000.0 * self.near;
        let (fov, near) = (self.field_of_view, self.near);
        let projection = match self.depth {
            DepthConvention::InfiniteReverse => proj::perspective_infinite_reverse(fov, 1.0, near),
            DepthConvention::FiniteReverse => proj::perspective(fov, 1.0, far, near),
            DepthConvention::Standard => proj::perspective(fov, 1.0, near, far),
        };
        let up = if (self.target - self.eye).normalize().y.abs() > 0.99 {
            Vec3::X
        } else {
            Vec3::Y
        };
        let camera = view::look_at_mat4(self.eye, self.target, up);
        View::new(projection * camera, self.depth).unwrap()
    }

    /// The exact answer at the centres of the pixels and, with several samples, at those.
    pub fn truth(&self) -> Truth {
        let scene = self.scene();
        // WebGPU's standard sample pattern, relative to the centre, in pixels.
        let offsets: &[(f32, f32)] = match self.samples {
            1 => &[],
            _ => &[
                (-0.125, -0.375),
                (0.375, -0.125),
                (-0.375, 0.125),
                (0.125, 0.375),
            ],
        };
        let image = |(x, y): (f32, f32)| {
            // A picture moved by -offset shows at its centres what was at centre + offset.
            let pixel = 2.0 / SIDE as f32;
            let shift = Mat4::from_translation(Vec3::new(-x * pixel, y * pixel, 0.0));
            let view = View::new(shift * self.view().clip_from_world(), self.depth).unwrap();
            scene.render(&view, SIDE, SIDE, self.light, None).unwrap()
        };
        Truth {
            centres: image((0.0, 0.0)),
            samples: offsets
                .iter()
                .map(|&offset| image(offset).visibility())
                .collect(),
        }
    }

    fn scene(&self) -> ReferenceScene {
        let objects: Vec<_> = self
            .bodies
            .iter()
            .map(|body| ReferenceObject {
                positions: &body.shape.positions,
                indices: &body.shape.indices,
                transform: exact(body.transform),
                casts: body.casts,
            })
            .collect();
        ReferenceScene::new(&objects).unwrap()
    }

    fn descriptor(&self) -> ShadowVolumeDescriptor<'_> {
        ShadowVolumeDescriptor {
            label: Some("test"),
            depth_stencil_format: self.format,
            sample_count: self.samples,
            depth: self.depth,
            color_formats: &[],
            cap_bias_ulps: self.cap_bias_ulps,
        }
    }

    /// The picture: one byte a pixel, 0 in shadow, 255 lit, in between where samples differ.
    pub fn draw(&self, gpu: &Gpu) -> Vec<u8> {
        let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &self.descriptor()).unwrap();
        let casters = self.casters(gpu);
        self.draw_with(gpu, &mut renderer, &casters)
    }

    pub fn draw_with(
        &self,
        gpu: &Gpu,
        renderer: &mut ShadowVolumeRenderer,
        casters: &[Caster],
    ) -> Vec<u8> {
        self.prepare(gpu, renderer, casters);
        self.redraw(gpu, renderer)
    }

    /// Draws what was prepared before.
    pub fn redraw(&self, gpu: &Gpu, renderer: &ShadowVolumeRenderer) -> Vec<u8> {
        gpu.checked(|| self.record(gpu, Some(renderer), None))
    }

    /// The picture, and a target that is red before the stencil pass.
    pub fn draw_with_color(
        &self,
        gpu: &Gpu,
        renderer: &mut ShadowVolumeRenderer,
        format: wgpu::TextureFormat,
    ) -> (Vec<u8>, Vec<u8>) {
        let color = gpu.target([SIDE, SIDE], format, 1);
        self.prepare(gpu, renderer, &self.casters(gpu));
        let picture = gpu.checked(|| self.record(gpu, Some(renderer), Some(&view_of(&color))));
        (
            picture,
            gpu.read_texture(&color, 0, wgpu::TextureAspect::All),
        )
    }

    /// The light pass with no volumes at all.
    pub fn draw_without_volumes(&self, gpu: &Gpu) -> Vec<u8> {
        gpu.checked(|| self.record(gpu, None, None))
    }

    fn prepare(&self, gpu: &Gpu, renderer: &mut ShadowVolumeRenderer, casters: &[Caster]) {
        let frame = ShadowVolumeFrame {
            view: &self.view(),
            light: self.light,
            range: None,
            casters,
        };
        renderer.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    }

    /// The casters, with their meshes on the GPU; equal shapes share one.
    pub fn casters(&self, gpu: &Gpu) -> Vec<Caster> {
        let mut meshes: Vec<(&Shape, CasterMesh)> = Vec::new();
        let mut casters = Vec::new();
        for body in self.bodies.iter().filter(|body| body.casts) {
            let known = meshes.iter().find(|(shape, _)| {
                shape.positions == body.shape.positions && shape.indices == body.shape.indices
            });
            let mesh = match known {
                Some((_, mesh)) => mesh.clone(),
                None => self.mesh(gpu, &body.shape),
            };
            meshes.push((&body.shape, mesh.clone()));
            casters.push(Caster::new(mesh, body.transform));
        }
        casters
    }

    fn mesh(&self, gpu: &Gpu, shape: &Shape) -> CasterMesh {
        let adjacency = Adjacency::new(&shape.positions, &shape.indices).unwrap();
        let Some((stride, offset)) = self.host_layout else {
            return CasterMesh::new(&gpu.device, &shape.positions, &adjacency).unwrap();
        };
        let mut bytes = vec![0xa5u8; offset + stride * shape.positions.len()];
        for (position, target) in shape
            .positions
            .iter()
            .zip(bytes[offset..].chunks_mut(stride))
        {
            target[..12].copy_from_slice(bytes_of(position));
        }
        let buffer = gpu
            .device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("host positions"),
                contents: &bytes,
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE,
            });
        let host = HostPositions {
            buffer: &buffer,
            stride: stride as u64,
            offset: offset as u64,
            bounds: Bounds::of_points(shape.positions.iter().map(|&p| p.into())).unwrap(),
        };
        CasterMesh::from_host_positions(&gpu.device, &host, &adjacency).unwrap()
    }

    fn record(
        &self,
        gpu: &Gpu,
        renderer: Option<&ShadowVolumeRenderer>,
        extra: Option<&wgpu::TextureView>,
    ) -> Vec<u8> {
        let size = [SIDE, SIDE];
        let depth = gpu.target(size, self.format, self.samples);
        let color = gpu.target(size, wgpu::TextureFormat::R8Unorm, self.samples);
        let picture = gpu.target(size, wgpu::TextureFormat::R8Unorm, 1);
        let (depth_view, color_view) = (view_of(&depth), view_of(&color));
        let resolved = view_of(&picture);
        let host = HostPipelines::new(gpu, self);
        let surfaces = self.surfaces(gpu);
        gpu.run(|encoder| {
            if let Some(renderer) = renderer {
                renderer.encode(encoder);
            }
            let attachment = attach(&depth_view, Some(self.depth.clear_depth()));
            let mut pass = begin(encoder, "depth prepass", &[], attachment);
            pass.set_pipeline(&host.depth);
            surfaces.iter().for_each(|surface| surface.draw(&mut pass));
            drop(pass);
            if let Some(renderer) = renderer {
                let colors = extra.map(|view| vec![Some(clear(view, wgpu::Color::RED, None))]);
                let colors = colors.unwrap_or_default();
                let mut pass = begin(encoder, "stencil", &colors, attach(&depth_view, None));
                renderer.render(&mut pass);
            }
            let target = match self.samples {
                1 => clear(&resolved, wgpu::Color::BLACK, None),
                _ => clear(&color_view, wgpu::Color::BLACK, Some(&resolved)),
            };
            let mut pass = begin(encoder, "light", &[Some(target)], attach(&depth_view, None));
            pass.set_stencil_reference(0);
            self.light_pass.draw(&mut pass, &host, &surfaces);
        });
        gpu.read_texture(&picture, 0, wgpu::TextureAspect::All)
    }

    /// Each body as position and matrices for every corner, and its indices.
    fn surfaces(&self, gpu: &Gpu) -> Vec<Surface> {
        let clip = self.view().clip_from_world();
        let buffer = |contents: &[u8], usage| {
            gpu.device
                .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some("surface"),
                    contents,
                    usage,
                })
        };
        self.bodies
            .iter()
            .map(|body| {
                let world = Mat4::from(body.transform);
                let [first, second] = if self.premultiplied {
                    [clip * world, Mat4::IDENTITY]
                } else {
                    [clip, world]
                };
                let mut vertices: Vec<f32> = Vec::new();
                for position in &body.shape.positions {
                    vertices.extend(position);
                    vertices.extend(first.to_cols_array());
                    vertices.extend(second.to_cols_array());
                }
                Surface {
                    vertices: buffer(bytes_of(&vertices[..]), wgpu::BufferUsages::VERTEX),
                    indices: buffer(bytes_of(&body.shape.indices[..]), wgpu::BufferUsages::INDEX),
                    count: body.shape.indices.len() as u32,
                }
            })
            .collect()
    }
}

/// One body's geometry as the host draws it.
struct Surface {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

impl Surface {
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
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

    fn draw(self, pass: &mut wgpu::RenderPass<'_>, host: &HostPipelines, surfaces: &[Surface]) {
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

/// Interior pixels of each kind, and those of them that a picture has wrong.
#[derive(Clone, Copy, Debug)]
pub struct Errors {
    pub interior: usize,
    pub lit: usize,
    pub shadowed: usize,
    pub wrong: usize,
}

/// What is right, at the centres and at the samples.
pub struct Truth {
    pub centres: ReferenceImage,
    samples: Vec<Vec<u8>>,
}

impl Truth {
    /// Whether a shadow edge passes between the samples of a pixel, unseen by its centre.
    fn is_split(&self, pixel: usize, centre: u8) -> bool {
        self.samples.iter().any(|sample| sample[pixel] != centre)
    }

    /// A pixel is wrong if any of its samples is.
    pub fn errors(&self, picture: &[u8]) -> Errors {
        let reference = &self.centres;
        let truth = reference.visibility();
        let wrong = |keep: fn(u8) -> bool| {
            let seen = picture.iter().zip(&truth).enumerate();
            let visible: Vec<u8> = seen
                .map(|(pixel, (&value, &centre))| match keep(value) {
                    _ if self.is_split(pixel, centre) => centre,
                    true => 255,
                    false => 0,
                })
                .collect();
            reference.compare(&visible, Interior::Screen).unwrap()
        };
        Errors {
            interior: reference.interior_pixels(Interior::Screen).unwrap(),
            lit: reference.count(Class::Lit),
            shadowed: reference.count(Class::Shadowed),
            wrong: wrong(|v| v > 0).false_lit_interior + wrong(|v| v == 255).false_shadow_interior,
        }
    }
}

fn exact(transform: Affine3A) -> DAffine3 {
    DAffine3::from_mat4(DMat4::from_cols_array(
        &Mat4::from(transform).to_cols_array().map(f64::from),
    ))
}

pub fn bytes_of<T: bytemuck::NoUninit>(data: &[T]) -> &[u8] {
    bytemuck::cast_slice(data)
}

fn view_of(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// With a depth to clear to: both aspects are cleared. Without: the depth is read-only.
fn attach(
    view: &wgpu::TextureView,
    clear: Option<f32>,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: clear.map(|depth| wgpu::Operations {
            load: wgpu::LoadOp::Clear(depth),
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: Some(wgpu::Operations {
            load: match clear {
                Some(_) => wgpu::LoadOp::Clear(0),
                None => wgpu::LoadOp::Load,
            },
            store: wgpu::StoreOp::Store,
        }),
    }
}

fn clear<'a>(
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

fn begin<'e>(
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

struct HostPipelines {
    depth: wgpu::RenderPipeline,
    light: wgpu::RenderPipeline,
    light_again: wgpu::RenderPipeline,
}

const HOST: &str = "
struct Vertex {
    @location(0) position: vec3f,
    @location(1) a: vec4f, @location(2) b: vec4f, @location(3) c: vec4f, @location(4) d: vec4f,
    @location(5) e: vec4f, @location(6) f: vec4f, @location(7) g: vec4f, @location(8) h: vec4f,
}
@vertex fn surface(v: Vertex) -> @invariant @builtin(position) vec4f {
    let first = mat4x4f(v.a, v.b, v.c, v.d);
    return shadows_clip_position(first, mat4x4f(v.e, v.f, v.g, v.h), v.position);
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
    fn new(gpu: &Gpu, stage: &Stage) -> Self {
        let module = gpu
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("host"),
                source: wgpu::ShaderSource::Wgsl([wgsl::POSITION, HOST].join("\n").into()),
            });
        let attributes = wgpu::vertex_attr_array![
            0 => Float32x3, 1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4,
            5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4
        ];
        let layout = wgpu::VertexBufferLayout {
            array_stride: 35 * 4,
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
