//! A small host whose receivers are planes, and the exact answer on them.

use host::gpu::Gpu;
use host::shapes::{self, Shape};
use shadows::glam::camera::rh::{proj::directx as proj, view};
use shadows::glam::{Affine3A, DAffine3, DMat3, Mat4, Vec3};
use shadows::reference::{Class, Interior, ReferenceImage, ReferenceObject, ReferenceScene};
use shadows::{
    Caster, CasterMesh, DepthConvention, HomogeneousLight, Light, PlanarFrame, PlanarLight,
    PlanarOutline, PlanarOutput, PlanarReceiver, PlanarShadow, PlanarShadowDescriptor, View,
    mesh::Adjacency, wgpu, wgsl,
};
use wgpu::util::DeviceExt as _;

pub const FLOAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32FloatStencil8;
pub const FIXED: wgpu::TextureFormat = wgpu::TextureFormat::Depth24PlusStencil8;
const PICTURE: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// A shape somewhere in the world.
#[derive(Clone, Debug)]
pub struct Body {
    pub shape: Shape,
    pub transform: Affine3A,
    pub casts: bool,
    /// What the host writes into the stencil where it is seen.
    pub mark: u8,
}

pub fn caster(shape: Shape, transform: Affine3A) -> Body {
    Body {
        shape,
        transform,
        casts: true,
        mark: 0,
    }
}

pub fn at(x: f32, y: f32, z: f32) -> Affine3A {
    Affine3A::from_translation(Vec3::new(x, y, z))
}

/// How the host says where a plane receives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Told {
    Stencil,
    Polygon,
}

/// A plane of the scene, and the body that lies in it.
#[derive(Clone, Debug)]
pub struct Ground {
    pub body: usize,
    pub point: Vec3,
    pub normal: Vec3,
    pub corners: Vec<Vec3>,
}

/// All that a picture depends on.
#[derive(Clone, Debug)]
pub struct Stage {
    pub bodies: Vec<Body>,
    pub grounds: Vec<Ground>,
    pub told: Told,
    pub light: Light,
    pub eye: Vec3,
    pub target: Vec3,
    pub near: f32,
    pub depth: DepthConvention,
    pub format: wgpu::TextureFormat,
    pub samples: u32,
    pub orthographic: bool,
    /// Whether the host multiplies its matrices first: other last bits than ours.
    pub premultiplied: bool,
    pub bias: Option<[f32; 2]>,
    pub side: u32,
}

/// Interior pixels of receivers, and those of them that are wrong.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    pub lit: usize,
    pub shadowed: usize,
    pub wrong: usize,
}

impl Stage {
    /// Casters on and above a square of 12 by 12 at height 0.
    pub fn new(light: impl Into<Light>, casters: Vec<Body>) -> Self {
        let mut stage = Self {
            bodies: casters,
            grounds: Vec::new(),
            told: Told::Stencil,
            light: light.into(),
            eye: Vec3::new(1.0, 6.0, 9.0),
            target: Vec3::new(0.0, 0.2, 0.0),
            near: 0.1,
            depth: DepthConvention::InfiniteReverse,
            format: FLOAT,
            samples: 1,
            orthographic: false,
            premultiplied: false,
            bias: None,
            side: 160,
        };
        stage.add_ground(6.0, Affine3A::IDENTITY);
        stage
    }

    /// A square that receives, turned and moved.
    pub fn add_ground(&mut self, half: f32, transform: Affine3A) {
        let shape = shapes::square(half);
        let corners = shape.positions.iter();
        let corners: Vec<Vec3> = corners
            .map(|&corner| transform.transform_point3(corner.into()))
            .collect();
        self.grounds.push(Ground {
            body: self.bodies.len(),
            point: corners[0],
            normal: transform.transform_vector3(Vec3::Y),
            corners,
        });
        self.bodies.push(Body {
            casts: false,
            mark: self.grounds.len() as u8,
            ..caster(shape, transform)
        });
    }

    /// Everything so many times as large.
    pub fn scaled(mut self, by: f32) -> Self {
        let scale = Affine3A::from_scale(Vec3::splat(by));
        for body in &mut self.bodies {
            body.transform = scale * body.transform;
        }
        for ground in &mut self.grounds {
            ground.point *= by;
            ground.corners.iter_mut().for_each(|corner| *corner *= by);
        }
        match &mut self.light {
            Light::Point(light) => {
                light.position *= by;
                light.range *= by;
            }
            Light::Spot(light) => {
                light.position *= by;
                light.range *= by;
            }
            _ => {}
        }
        self.eye *= by;
        self.target *= by;
        self.near *= by;
        self
    }

    pub fn view(&self) -> View {
        let (near, far) = (self.near, 1000.0 * self.near);
        let distance = self.eye.distance(self.target);
        let half = 0.45 * distance;
        let projection = match (self.orthographic, self.depth) {
            (true, DepthConvention::Standard) => {
                proj::orthographic(-half, half, -half, half, near, far)
            }
            (true, _) => proj::orthographic(-half, half, -half, half, far, near),
            (false, DepthConvention::InfiniteReverse) => {
                proj::perspective_infinite_reverse(0.9, 1.0, near)
            }
            (false, DepthConvention::FiniteReverse) => proj::perspective(0.9, 1.0, far, near),
            (false, DepthConvention::Standard) => proj::perspective(0.9, 1.0, near, far),
        };
        let camera = view::look_at_mat4(self.eye, self.target, Vec3::Y);
        View::new(projection * camera, self.depth).unwrap()
    }

    pub fn descriptor(&self) -> PlanarShadowDescriptor<'static> {
        let usual = PlanarShadowDescriptor::default();
        let [bias_pixels, bias_ulps] = self.bias.unwrap_or([usual.bias_pixels, usual.bias_ulps]);
        PlanarShadowDescriptor {
            label: Some("test"),
            depth_stencil_format: self.format,
            sample_count: self.samples,
            depth: self.depth,
            bias_pixels,
            bias_ulps,
            ..usual
        }
    }

    /// What the library is told of the planes.
    pub fn receivers(&self) -> Vec<PlanarReceiver<'_>> {
        let grounds = self.grounds.iter();
        grounds
            .map(|ground| PlanarReceiver {
                point: ground.point,
                normal: ground.normal,
                outline: match self.told {
                    Told::Stencil => PlanarOutline::Stencil(self.bodies[ground.body].mark),
                    Told::Polygon => PlanarOutline::Polygon(&ground.corners),
                },
            })
            .collect()
    }

    pub fn casters(&self, gpu: &Gpu) -> Vec<Caster> {
        let casting = self.bodies.iter().filter(|body| body.casts);
        casting
            .map(|body| {
                let Shape { positions, indices } = &body.shape;
                let adjacency = Adjacency::new(positions, indices).unwrap();
                let mesh = CasterMesh::new(&gpu.device, positions, &adjacency).unwrap();
                Caster::new(mesh, body.transform)
            })
            .collect()
    }

    /// The exact answer at the pixels' centres.
    pub fn truth(&self) -> ReferenceImage {
        self.truth_beside([0.0; 2])
    }

    /// Whether an edge of a shadow or of a body passes between a pixel's samples, by pixel. (WebGPU's standard pattern, in pixels from
    /// the centre.)
    pub fn splits(&self, truth: &ReferenceImage) -> Vec<bool> {
        let pattern = [
            [-0.125, -0.375],
            [0.375, -0.125],
            [-0.375, 0.125],
            [0.125, 0.375],
        ];
        let mut splits = vec![false; truth.classes().len()];
        for offset in pattern.into_iter().filter(|_| self.samples > 1) {
            let sample = self.truth_beside(offset);
            let classes = sample.classes().zip(truth.classes());
            for ((pixel, split), (a, b)) in (0..).zip(&mut splits).zip(classes) {
                let (x, y) = (pixel % self.side, pixel / self.side);
                let object = |image: &ReferenceImage| image.hit(x, y).map(|hit| hit.object);
                *split |= a != b || object(&sample) != object(truth);
            }
        }
        splits
    }

    fn truth_beside(&self, [x, y]: [f32; 2]) -> ReferenceImage {
        let transforms: Vec<DAffine3> = self
            .bodies
            .iter()
            .map(|body| exact(body.transform))
            .collect();
        let objects = self.bodies.iter().zip(transforms);
        let objects: Vec<_> = objects
            .map(|(body, transform)| ReferenceObject {
                positions: &body.shape.positions,
                indices: &body.shape.indices,
                transform,
                casts: body.casts,
            })
            .collect();
        let scene = ReferenceScene::new(&objects).unwrap();
        let side = self.side;
        // A picture moved by -offset shows at its centres what was at centre + offset.
        let pixel = 2.0 / side as f32;
        let shift = Mat4::from_translation(Vec3::new(-x * pixel, y * pixel, 0.0));
        let view = View::new(shift * self.view().clip_from_world(), self.depth).unwrap();
        match &self.light {
            Light::Spot(spot) => scene.render_spot(&view, side, side, spot).unwrap(),
            Light::Point(point) => {
                let (light, range) = (point.homogeneous(), Some(point.range));
                scene.render(&view, side, side, light, range).unwrap()
            }
            Light::Directional(sun) => {
                let light = HomogeneousLight::directional(sun.toward_light);
                scene.render(&view, side, side, light, None).unwrap()
            }
            _ => unreachable!("a kind of light that this test does not know"),
        }
    }

    /// Whether a pixel shows a receiver.
    fn is_ground(&self, truth: &ReferenceImage, pixel: usize) -> bool {
        let (x, y) = (pixel as u32 % self.side, pixel as u32 / self.side);
        let hit = truth.hit(x, y);
        hit.is_some_and(|hit| self.grounds.iter().any(|g| g.body == hit.object as usize))
    }

    /// Judges a picture where receivers are: 255 lit, 0 in shadow, in between where samples differ.
    pub fn judge(&self, truth: &ReferenceImage, picture: &[u8]) -> Found {
        let right = truth.visibility();
        let splits = self.splits(truth);
        let wrong = |keep: fn(u8) -> bool| {
            let pixels = picture.iter().zip(&right).enumerate();
            let shown: Vec<u8> = pixels
                .map(|(pixel, (&value, &right))| match keep(value) {
                    _ if splits[pixel] || !self.is_ground(truth, pixel) => right,
                    true => 255,
                    false => 0,
                })
                .collect();
            truth.compare(&shown, Interior::Screen).unwrap()
        };
        let count = |class| {
            let classes = truth.classes().enumerate();
            classes
                .filter(|&(pixel, found)| found == class && self.is_ground(truth, pixel))
                .count()
        };
        Found {
            lit: count(Class::Lit),
            shadowed: count(Class::Shadowed),
            wrong: wrong(|value| value > 0).false_lit_interior
                + wrong(|value| value == 255).false_shadow_interior,
        }
    }

    /// The picture by a planar shadow of its own: one byte a pixel.
    pub fn draw(&self, gpu: &Gpu) -> Vec<u8> {
        let mut planar = PlanarShadow::new(&gpu.device, &self.descriptor()).unwrap();
        self.draw_with(gpu, &mut planar, &self.casters(gpu))
    }

    pub fn draw_with(&self, gpu: &Gpu, planar: &mut PlanarShadow, casters: &[Caster]) -> Vec<u8> {
        self.prepare(gpu, planar, casters);
        gpu.checked(|| {
            let host = HostGpu::new(gpu, self);
            gpu.run(|encoder| {
                planar.encode(encoder);
                host.draw_scene(encoder);
                let mut pass = host.begin(encoder, None);
                for plane in 0..self.grounds.len() {
                    planar.render(&mut pass, 0, plane, 0).unwrap();
                }
                drop(pass);
                host.draw_light(encoder, planar.light_pass_stencil());
            });
            host.read(gpu)
        })
    }

    pub fn prepare(&self, gpu: &Gpu, planar: &mut PlanarShadow, casters: &[Caster]) {
        let frame = PlanarFrame {
            lights: &[PlanarLight::new(self.light)],
            planes: &self.receivers(),
            views: &[self.view()],
            casters,
        };
        planar.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
    }

    /// A white picture that the shadows of some lights darken one after another; `each`: every caster by itself,
    /// the stencil set back after it.
    pub fn darken(&self, gpu: &Gpu, lights: &[PlanarLight], each: bool) -> Vec<u8> {
        let descriptor = PlanarShadowDescriptor {
            color_formats: &[Some(PICTURE)],
            output: PlanarOutput::Darken { target: 0 },
            ..self.descriptor()
        };
        let casters = self.casters(gpu);
        let groups: Vec<&[Caster]> = match each {
            true => casters.chunks(1).collect(),
            false => vec![&casters],
        };
        let host = HostGpu::new(gpu, self);
        gpu.run(|encoder| host.draw_scene(encoder));
        for (place, casters) in groups.into_iter().enumerate() {
            let mut planar = PlanarShadow::new(&gpu.device, &descriptor).unwrap();
            let frame = PlanarFrame {
                lights,
                planes: &self.receivers(),
                views: &[self.view()],
                casters,
            };
            planar.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
            gpu.checked(|| {
                gpu.run(|encoder| {
                    planar.encode(encoder);
                    let load = match place {
                        0 => wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                        _ => wgpu::LoadOp::Load,
                    };
                    let mut pass = host.begin(encoder, Some(load));
                    for light in 0..lights.len() {
                        for plane in 0..self.grounds.len() {
                            planar.render(&mut pass, light, plane, 0).unwrap();
                        }
                        planar.reset(&mut pass);
                    }
                });
            });
        }
        host.read(gpu)
    }
}

fn exact(transform: Affine3A) -> DAffine3 {
    let m = transform.matrix3;
    DAffine3 {
        matrix3: DMat3::from_cols(
            m.x_axis.as_dvec3(),
            m.y_axis.as_dvec3(),
            m.z_axis.as_dvec3(),
        ),
        translation: transform.translation.as_dvec3(),
    }
}

const HOST: &str = "
struct Frame { clip_from_world: mat4x4f, world_from_object: mat4x4f, premultiplied: vec4f }
@group(0) @binding(0) var<uniform> frame: Frame;
@vertex fn surface(@location(0) position: vec3f) -> @invariant @builtin(position) vec4f {
    let ours = shadows_clip_position(frame.clip_from_world, frame.world_from_object, position);
    let other = (frame.clip_from_world * frame.world_from_object) * vec4f(position, 1.0);
    return select(ours, other, frame.premultiplied.x > 0.0);
}
@vertex fn screen(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}
@fragment fn lit() -> @location(0) vec4f { return vec4f(1.0); }
";

/// The host's targets and surfaces.
pub struct HostGpu {
    device: wgpu::Device,
    stage: Stage,
    module: wgpu::ShaderModule,
    depth: wgpu::TextureView,
    /// What is drawn into, and what it is resolved to.
    color: wgpu::TextureView,
    picture: wgpu::Texture,
    surface: wgpu::RenderPipeline,
    surfaces: Vec<(u8, wgpu::BindGroup, wgpu::Buffer, wgpu::Buffer, u32)>,
}

fn view_of(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

impl HostGpu {
    pub fn new(gpu: &Gpu, stage: &Stage) -> Self {
        let device = &gpu.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("host"),
            source: wgpu::ShaderSource::Wgsl([wgsl::POSITION, HOST].join("\n").into()),
        });
        let size = [stage.side; 2];
        let replace = wgpu::StencilFaceState {
            compare: wgpu::CompareFunction::Always,
            fail_op: wgpu::StencilOperation::Keep,
            depth_fail_op: wgpu::StencilOperation::Keep,
            pass_op: wgpu::StencilOperation::Replace,
        };
        let marks = wgpu::StencilState {
            front: replace,
            back: replace,
            read_mask: 0xff,
            write_mask: 0xff,
        };
        let surface = pipeline(device, &module, stage, "surface", marks);
        let surfaces = stage.bodies.iter().map(|body| {
            let buffer = |contents: &[u8], usage| {
                device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some("surface"),
                    contents,
                    usage,
                })
            };
            let matrices = [
                stage.view().clip_from_world(),
                Mat4::from(body.transform),
                Mat4::from_diagonal(
                    Vec3::splat(f32::from(u8::from(stage.premultiplied))).extend(0.0),
                ),
            ];
            let words: Vec<f32> = matrices.iter().flat_map(Mat4::to_cols_array).collect();
            let uniform = buffer(bytemuck::cast_slice(&words), wgpu::BufferUsages::UNIFORM);
            let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("surface"),
                layout: &surface.get_bind_group_layout(0),
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: uniform.as_entire_binding(),
                }],
            });
            (
                body.mark,
                group,
                buffer(
                    bytemuck::cast_slice(&body.shape.positions),
                    wgpu::BufferUsages::VERTEX,
                ),
                buffer(
                    bytemuck::cast_slice(&body.shape.indices),
                    wgpu::BufferUsages::INDEX,
                ),
                body.shape.indices.len() as u32,
            )
        });
        let surfaces = surfaces.collect();
        let picture = gpu.target(size, PICTURE, 1);
        Self {
            depth: view_of(&gpu.target(size, stage.format, stage.samples)),
            color: match stage.samples {
                1 => view_of(&picture),
                samples => view_of(&gpu.target(size, PICTURE, samples)),
            },
            picture,
            surface,
            surfaces,
            module,
            stage: stage.clone(),
            device: device.clone(),
        }
    }

    /// Depth of all surfaces, and what receivers leave in the stencil.
    pub fn draw_scene(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(self.stage.depth.clear_depth()),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0),
                    store: wgpu::StoreOp::Store,
                }),
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.surface);
        for (mark, group, positions, indices, count) in &self.surfaces {
            pass.set_stencil_reference(u32::from(*mark));
            pass.set_bind_group(0, group, &[]);
            pass.set_vertex_buffer(0, positions.slice(..));
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..*count, 0, 0..1);
        }
    }

    /// A pass over the scene's depth, which is read-only, with the picture if `load` says how it begins.
    pub fn begin<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        load: Option<wgpu::LoadOp<wgpu::Color>>,
    ) -> wgpu::RenderPass<'e> {
        let resolved = view_of(&self.picture);
        let color = load.map(|load| wgpu::RenderPassColorAttachment {
            view: &self.color,
            depth_slice: None,
            resolve_target: (self.stage.samples > 1).then_some(&resolved),
            ops: wgpu::Operations {
                load,
                store: wgpu::StoreOp::Store,
            },
        });
        let colors = color.map(|color| vec![Some(color)]).unwrap_or_default();
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("over the scene"),
            color_attachments: &colors,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: None,
                stencil_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                }),
            }),
            ..Default::default()
        })
    }

    /// White where the stencil lets it through.
    pub fn draw_light(&self, encoder: &mut wgpu::CommandEncoder, stencil: wgpu::StencilState) {
        let lit = pipeline(&self.device, &self.module, &self.stage, "screen", stencil);
        let mut pass = self.begin(encoder, Some(wgpu::LoadOp::Clear(wgpu::Color::BLACK)));
        pass.set_pipeline(&lit);
        pass.set_stencil_reference(0);
        pass.draw(0..3, 0..1);
    }

    pub fn read(&self, gpu: &Gpu) -> Vec<u8> {
        gpu.read_texture(&self.picture, 0, wgpu::TextureAspect::All)
    }
}

fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    stage: &Stage,
    entry: &str,
    stencil: wgpu::StencilState,
) -> wgpu::RenderPipeline {
    let is_surface = entry == "surface";
    let targets = [Some(PICTURE.into())];
    let buffers = [Some(wgpu::VertexBufferLayout {
        array_stride: 12,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3],
    })];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            buffers: if is_surface { &buffers } else { &[] },
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: stage.format,
            depth_write_enabled: Some(is_surface),
            depth_compare: Some(match is_surface {
                true => stage.depth.nearer(),
                false => wgpu::CompareFunction::Always,
            }),
            stencil,
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState {
            count: stage.samples,
            ..Default::default()
        },
        fragment: (!is_surface).then(|| wgpu::FragmentState {
            module,
            entry_point: Some("lit"),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}
