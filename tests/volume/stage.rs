//! A scene as a small host draws it, and the same scene for the reference.

use host::one_light::{OneLight, PrepareOne as _};
use shadows::glam::camera::rh::{proj::directx as proj, view};
use shadows::glam::{Affine3A, DAffine3, DMat4, Mat4, Vec3};
use shadows::mesh::{Adjacency, Bounds};
use shadows::reference::{ReferenceObject, ReferenceScene};
use shadows::{
    Caps, Caster, CasterMesh, Counter, DepthConvention, ExactCount, ExactCountDescriptor,
    Extrusion, HomogeneousLight, HostPositions, Method, ShadowVolumeDescriptor,
    ShadowVolumeRenderer, Silhouettes, SpotLight, StartFrom, View, VolumeCone, wgpu,
};
use wgpu::util::DeviceExt as _;

use crate::passes::{
    Arithmetic, HostPipelines, LightPass, Surface, attach, begin, bytes_of, clear, view_of,
};
use crate::shapes::Shape;
use crate::truth::Truth;
use host::gpu::Gpu;

pub const SIDE: u32 = 256;

/// Every way to find silhouettes.
pub const WAYS: [Silhouettes; 3] = [Silhouettes::Compute, Silhouettes::Cpu, Silhouettes::Vertex];

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

/// How the camera projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    Perspective,
    /// Left and right exchanged, as with a left-handed world: everything turns the other way.
    Mirrored,
    Orthographic,
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
    /// How the host multiplies.
    pub arithmetic: Arithmetic,
    /// Bytes between positions and before the first, in a buffer of the host's.
    pub host_layout: Option<(usize, usize)>,
    pub light_pass: LightPass,
    pub lens: Lens,
    /// Pixels along an edge of the picture.
    pub side: u32,
    pub range: Option<f32>,
    /// Of a spot.
    pub cone: Option<VolumeCone>,
    /// Bounds of what receives, where the renderer is told.
    pub receivers: Option<Bounds>,
    pub savings: Savings,
    /// The camera, where it is not the one that the fields above describe.
    pub placed_view: Option<View>,
}

/// What of the volumes is drawn.
#[derive(Clone, Copy, Debug, Default)]
pub struct Savings {
    pub method: Method,
    pub caps: Caps,
    pub extrusion: Extrusion,
    /// Whether nothing is skipped or clipped.
    pub unculled: bool,
    pub silhouettes: Silhouettes,
    pub start_from: StartFrom,
    pub counter: Counter,
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
            format: ShadowVolumeDescriptor::default().depth_stencil_format,
            samples: 1,
            cap_bias_ulps: ShadowVolumeDescriptor::default().cap_bias_ulps,
            arithmetic: Arithmetic::Ours,
            host_layout: None,
            light_pass: LightPass::Screen,
            lens: Lens::Perspective,
            side: SIDE,
            range: None,
            cone: None,
            receivers: None,
            savings: Savings::default(),
            placed_view: None,
        }
    }

    /// The box around all bodies, world space.
    pub fn bounds(bodies: &[Body]) -> Bounds {
        let points = bodies.iter().flat_map(|body| {
            let positions = body.shape.positions.iter();
            positions.map(|&p| body.transform.transform_point3(p.into()))
        });
        Bounds::of_points(points).unwrap()
    }

    pub fn view(&self) -> View {
        if let Some(view) = self.placed_view {
            return view;
        }
        let [projection, camera] = self.projection_and_camera();
        View::new(projection * camera, self.depth).unwrap()
    }

    fn projection_and_camera(&self) -> [Mat4; 2] {
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
        let projection = match self.lens {
            Lens::Perspective => projection,
            Lens::Mirrored => Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)) * projection,
            Lens::Orthographic => {
                let (one, zero) = match self.depth {
                    DepthConvention::Standard => (far, near),
                    _ => (near, far),
                };
                proj::orthographic(-5.0, 5.0, -5.0, 5.0, zero, one)
            }
        };
        [projection, camera]
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
            let pixel = 2.0 / self.side as f32;
            let shift = Mat4::from_translation(Vec3::new(-x * pixel, y * pixel, 0.0));
            let view = View::new(shift * self.view().clip_from_world(), self.depth).unwrap();
            match self.spot() {
                Some(spot) => scene.render_spot(&view, self.side, self.side, &spot),
                None => scene.render(&view, self.side, self.side, self.light, self.range),
            }
            .unwrap()
        };
        Truth {
            centres: image((0.0, 0.0)),
            samples: offsets
                .iter()
                .map(|&offset| image(offset).classes().collect())
                .collect(),
        }
    }

    /// The light, if it has a cone; it then has a range, too.
    fn spot(&self) -> Option<SpotLight> {
        let (
            VolumeCone {
                direction,
                half_angle,
            },
            range,
        ) = (self.cone?, self.range?);
        let position = self.light.xyzw().truncate();
        Some(SpotLight::new(position, direction, half_angle, range))
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

    pub fn descriptor(&self) -> ShadowVolumeDescriptor<'_> {
        ShadowVolumeDescriptor {
            label: Some("test"),
            depth_stencil_format: self.format,
            sample_count: self.samples,
            depth: self.depth,
            cap_bias_ulps: self.cap_bias_ulps,
            method: self.savings.method,
            caps: self.savings.caps,
            extrusion: self.savings.extrusion,
            culling: !self.savings.unculled,
            silhouettes: self.savings.silhouettes,
            start_from: self.savings.start_from,
            counter: self.savings.counter,
            ..Default::default()
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
    pub fn redraw(&self, gpu: &Gpu, renderer: &mut ShadowVolumeRenderer) -> Vec<u8> {
        gpu.checked(|| self.record(gpu, Some(renderer), None))
    }

    /// The picture, and a target that is red before the stencil pass.
    pub fn draw_with_color(
        &self,
        gpu: &Gpu,
        renderer: &mut ShadowVolumeRenderer,
        format: wgpu::TextureFormat,
    ) -> (Vec<u8>, Vec<u8>) {
        let color = gpu.target([self.side; 2], format, 1);
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

    pub fn prepare(&self, gpu: &Gpu, renderer: &mut ShadowVolumeRenderer, casters: &[Caster]) {
        let view = self.view();
        let frame = OneLight {
            range: self.range,
            cone: self.cone,
            target_size: Some([self.side; 2]),
            receivers: self.receivers,
            ..OneLight::new(&view, self.light, casters)
        };
        renderer
            .prepare_one(&gpu.device, &gpu.queue, &frame)
            .unwrap();
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
        mut renderer: Option<&mut ShadowVolumeRenderer>,
        extra: Option<&wgpu::TextureView>,
    ) -> Vec<u8> {
        let size = [self.side; 2];
        let depth = gpu.target(size, self.format, self.samples);
        let color = gpu.target(size, wgpu::TextureFormat::R8Unorm, self.samples);
        let picture = gpu.target(size, wgpu::TextureFormat::R8Unorm, 1);
        let (depth_view, color_view) = (view_of(&depth), view_of(&color));
        let resolved = view_of(&picture);
        let host = HostPipelines::new(gpu, self);
        let surfaces = self.surfaces(gpu);
        let counts = (self.savings.counter == Counter::Exact).then(|| self.exact_count(gpu));
        gpu.run(|encoder| {
            if let Some(renderer) = &mut renderer {
                renderer.encode(encoder);
            }
            self.prepass(encoder, &depth_view, &host, &surfaces);
            if let (Some(renderer), Some(counts)) = (&renderer, &counts) {
                renderer
                    .render(&mut counts.begin(encoder, &depth_view).unwrap(), 0, 0)
                    .unwrap();
                counts.encode(encoder, &depth_view).unwrap();
            } else if let Some(renderer) = &renderer {
                let colors = extra.map(|view| vec![Some(clear(view, wgpu::Color::RED, None))]);
                let colors = colors.unwrap_or_default();
                let mut pass = begin(encoder, "stencil", &colors, attach(&depth_view, None));
                renderer.render(&mut pass, 0, 0).unwrap();
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

    /// What fits the stage's passes.
    pub fn exact_count(&self, gpu: &Gpu) -> ExactCount {
        let descriptor = ExactCountDescriptor {
            size: [self.side; 2],
            depth_stencil_format: self.format,
            sample_count: self.samples,
            ..Default::default()
        };
        ExactCount::new(&gpu.device, &descriptor).unwrap()
    }

    pub fn prepass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        depth: &wgpu::TextureView,
        host: &HostPipelines,
        surfaces: &[Surface],
    ) {
        let attachment = attach(depth, Some(self.depth.clear_depth()));
        let mut pass = begin(encoder, "depth prepass", &[], attachment);
        pass.set_pipeline(&host.depth);
        surfaces.iter().for_each(|surface| surface.draw(&mut pass));
    }

    /// The stencil's counts, of one sample a pixel.
    pub fn counts(&self, gpu: &Gpu) -> Vec<u8> {
        let mut renderer = ShadowVolumeRenderer::new(&gpu.device, &self.descriptor()).unwrap();
        self.prepare(gpu, &mut renderer, &self.casters(gpu));
        let depth = gpu.target([self.side; 2], self.format, 1);
        let depth_view = view_of(&depth);
        let (host, surfaces) = (HostPipelines::new(gpu, self), self.surfaces(gpu));
        gpu.checked(|| {
            gpu.run(|encoder| {
                renderer.encode(encoder);
                self.prepass(encoder, &depth_view, &host, &surfaces);
                let mut pass = begin(encoder, "stencil", &[], attach(&depth_view, None));
                renderer.render(&mut pass, 0, 0).unwrap();
            });
        });
        gpu.read_texture(&depth, 0, wgpu::TextureAspect::StencilOnly)
    }

    /// Each body's corners with the matrices that they go through, and its indices.
    pub fn surfaces(&self, gpu: &Gpu) -> Vec<Surface> {
        let clip = self.view().clip_from_world();
        let surface = |body: &Body| {
            let world = Mat4::from(body.transform);
            let [projection, camera] = self.projection_and_camera();
            let matrices = match self.arithmetic {
                Arithmetic::Ours => [Mat4::IDENTITY, clip, world],
                Arithmetic::Premultiplied => [Mat4::IDENTITY, clip * world, Mat4::IDENTITY],
                Arithmetic::OneByOne => [projection, camera, world],
            };
            Surface::new(gpu, &body.shape, matrices)
        };
        self.bodies.iter().map(surface).collect()
    }
}

fn exact(transform: Affine3A) -> DAffine3 {
    DAffine3::from_mat4(DMat4::from_cols_array(
        &Mat4::from(transform).to_cols_array().map(f64::from),
    ))
}
