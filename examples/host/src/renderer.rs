//! A forward renderer without a window: depth and ambient light first, then one pass that adds the
//! light and writes its visibility beside it.

use anyhow::Result;
use shadows::glam::Mat4;
use shadows::glam::camera::rh::proj::directx;
use shadows::{DepthConvention, View, wgpu};

use super::gpu::Gpu;
use super::image;
pub use super::pipelines::{DEPTH, LitPipeline, Look, Orthographic, SHADED, ShadowAccess};
use super::pipelines::{ambient_pipeline, lit_pipeline};
use super::scene::Scene;
use super::scene_gpu::SceneGpu;
use super::targets::{Targets, color};

/// Share of the light that comes from everywhere.
const AMBIENT: f32 = 0.1;
/// Linear colour where there is no surface.
const SKY: wgpu::Color = wgpu::Color {
    r: 0.012,
    g: 0.018,
    b: 0.032,
    a: 1.0,
};

/// `HostFrame` in host.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct FrameUniform {
    clip_from_world: [[f32; 4]; 4],
    eye: [f32; 4],
    light: [f32; 4],
    cone: [f32; 4],
    range: f32,
    intensity: f32,
    ambient: f32,
    padding: u32,
}

/// Targets and pipelines for one scene seen by one camera.
pub struct Renderer {
    size: [u32; 2],
    look: Look,
    depth_stencil_format: wgpu::TextureFormat,
    targets: Targets,
    host_layout: wgpu::BindGroupLayout,
    host_group: wgpu::BindGroup,
    frame: wgpu::Buffer,
    ambient: wgpu::RenderPipeline,
    unshadowed: LitPipeline,
}

impl Renderer {
    /// Targets of `size` pixels, pipelines and the frame's uniforms.
    ///
    /// # Errors
    /// If the device cannot make targets of this size.
    pub fn new(gpu: &Gpu, size: [u32; 2], scene: &Scene, scene_gpu: &SceneGpu) -> Result<Self> {
        Self::with_look(gpu, size, scene, scene_gpu, Look::default())
    }

    /// The same, drawn in another way.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_look(
        gpu: &Gpu,
        size: [u32; 2],
        scene: &Scene,
        scene_gpu: &SceneGpu,
        look: Look,
    ) -> Result<Self> {
        let best = gpu.support.depth_stencil_format();
        let depth_stencil_format = look.depth_stencil.unwrap_or(best);
        let targets = Targets::new(gpu, size, depth_stencil_format, look.samples)?;
        let frame = frame_buffer(gpu, scene, size, look);
        let host_layout = host_layout(&gpu.device);
        let host_group = host_group(gpu, &host_layout, &frame, scene_gpu);
        Ok(Self {
            size,
            look,
            depth_stencil_format,
            targets,
            frame,
            ambient: ambient_pipeline(&gpu.device, &host_layout, depth_stencil_format, look),
            unshadowed: lit_pipeline(
                &gpu.device,
                &host_layout,
                depth_stencil_format,
                look,
                &ShadowAccess::default(),
            ),
            host_layout,
            host_group,
        })
    }

    /// Draws from now on what the scene's camera and light have become, through a matrix of its own.
    pub fn show(&self, gpu: &Gpu, scene: &Scene, clip_from_world: Mat4) {
        let frame = frame_uniform(scene, clip_from_world);
        gpu.queue
            .write_buffer(&self.frame, 0, bytemuck::bytes_of(&frame));
    }

    /// Takes over another light or camera of the scene, and another size: what a window needs.
    ///
    /// # Errors
    /// If the device cannot make targets of this size.
    pub fn update(&mut self, gpu: &Gpu, size: [u32; 2], scene: &Scene) -> Result<()> {
        if size != self.size {
            let format = self.depth_stencil_format;
            self.targets = Targets::new(gpu, size, format, self.look.samples)?;
            self.size = size;
        }
        self.show(gpu, scene, matrix(scene, size, self.look));
        Ok(())
    }

    /// The shaded picture, sRGB.
    pub fn shaded(&self) -> &wgpu::Texture {
        &self.targets.shaded.texture
    }

    /// Visibility of the light at each pixel, `R8Unorm`: 1 lit; 0 also where there is no surface.
    pub fn visibility(&self) -> &wgpu::Texture {
        &self.targets.visibility.texture
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// How it draws.
    pub fn look(&self) -> Look {
        self.look
    }

    /// The format of the depth-stencil buffer.
    pub fn depth_stencil_format(&self) -> wgpu::TextureFormat {
        self.depth_stencil_format
    }

    /// The depth-stencil buffer.
    pub fn depth_stencil(&self) -> &wgpu::TextureView {
        &self.targets.depth_stencil
    }

    /// The lit pass's pipeline for one way to find shadows.
    pub fn lit_pipeline(&self, gpu: &Gpu, access: &ShadowAccess<'_>) -> LitPipeline {
        lit_pipeline(
            &gpu.device,
            &self.host_layout,
            self.depth_stencil_format,
            self.look,
            access,
        )
    }

    /// The lit pass's pipeline without shadows.
    pub fn unshadowed(&self) -> &LitPipeline {
        &self.unshadowed
    }

    /// Clears, then draws depth and ambient light.
    pub fn draw_ambient(&self, encoder: &mut wgpu::CommandEncoder, scene: &SceneGpu) {
        let (shaded, _) = self.targets.shaded.views();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("ambient"),
            color_attachments: &[Some(color(&shaded, None, wgpu::LoadOp::Clear(SKY)))],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.targets.depth_stencil,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(self.look.depth.clear_depth()),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0),
                    store: wgpu::StoreOp::Store,
                }),
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.ambient);
        self.draw_objects(&mut pass, scene);
    }

    /// A pass that may count in the stencil buffer, cleared to 0, against the scene's depth.
    pub fn begin_stencil_pass<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
    ) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("stencil"),
            depth_stencil_attachment: Some(self.stencil_attachment(wgpu::LoadOp::Clear(0))),
            ..Default::default()
        })
    }

    /// A pass that draws over the shaded picture, depth and stencil read-only.
    pub fn begin_overlay_pass<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
    ) -> wgpu::RenderPass<'e> {
        let (shaded, resolved) = self.targets.shaded.views();
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("overlay"),
            color_attachments: &[Some(color(&shaded, resolved.as_ref(), wgpu::LoadOp::Load))],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.targets.depth_stencil,
                depth_ops: None,
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    /// Adds the light where it is not shadowed, and writes its visibility.
    pub fn draw_lit(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &SceneGpu,
        lit: &LitPipeline,
        shadow_group: Option<&wgpu::BindGroup>,
    ) {
        let (shaded, resolved) = self.targets.shaded.views();
        let (visibility, resolved_visibility) = self.targets.visibility.views();
        let mut depth_stencil = self.stencil_attachment(wgpu::LoadOp::Load);
        if !lit.uses_stencil {
            depth_stencil.stencil_ops = None;
        }
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("lit"),
            color_attachments: &[
                Some(color(&shaded, resolved.as_ref(), wgpu::LoadOp::Load)),
                Some(color(
                    &visibility,
                    resolved_visibility.as_ref(),
                    wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                )),
            ],
            depth_stencil_attachment: Some(depth_stencil),
            ..Default::default()
        });
        pass.set_pipeline(&lit.pipeline);
        pass.set_stencil_reference(0);
        if let Some(group) = shadow_group {
            pass.set_bind_group(1, group, &[]);
        }
        self.draw_objects(&mut pass, scene);
    }

    /// The shaded picture, sRGB.
    pub fn read_shaded(&self, gpu: &Gpu) -> Vec<[u8; 3]> {
        image::without_alpha(&gpu.read_texture(self.shaded(), 0, wgpu::TextureAspect::All))
    }

    /// Visibility of the light at each pixel, 255 lit; 0 also where there is no surface.
    pub fn read_visibility(&self, gpu: &Gpu) -> Vec<u8> {
        gpu.read_texture(self.visibility(), 0, wgpu::TextureAspect::All)
    }

    fn stencil_attachment(
        &self,
        load: wgpu::LoadOp<u32>,
    ) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.targets.depth_stencil,
            depth_ops: None,
            stencil_ops: Some(wgpu::Operations {
                load,
                store: wgpu::StoreOp::Store,
            }),
        }
    }

    fn draw_objects(&self, pass: &mut wgpu::RenderPass<'_>, scene: &SceneGpu) {
        for (place, &mesh) in scene.objects.iter().enumerate() {
            let mesh = &scene.meshes[mesh];
            if mesh.index_count == 0 {
                continue;
            }
            let offset = place as u32 * scene.object_stride;
            pass.set_bind_group(0, &self.host_group, &[offset]);
            pass.set_vertex_buffer(0, mesh.positions.slice(..));
            pass.set_vertex_buffer(1, mesh.normals.slice(..));
            pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..mesh.index_count, 0, 0..1);
        }
    }
}

/// The host's view of a scene.
///
/// # Errors
/// If the camera's numbers make no view, e.g. because it looks straight up or down.
pub fn view(scene: &Scene, size: [u32; 2]) -> Result<View> {
    view_as(scene, size, Look::default())
}

/// The same, drawn in another way.
///
/// # Errors
/// As [`view`].
pub fn view_as(scene: &Scene, size: [u32; 2], look: Look) -> Result<View> {
    Ok(View::new(matrix(scene, size, look), look.depth)?)
}

impl Orthographic {
    /// Clip space from what the camera sees; depth must have an end.
    fn projection(&self, depth: DepthConvention) -> Mat4 {
        let (first, last) = match depth {
            DepthConvention::Standard => (self.near, self.far),
            DepthConvention::FiniteReverse | DepthConvention::InfiniteReverse => {
                (self.far, self.near)
            }
        };
        directx::orthographic(self.left, self.right, self.bottom, self.top, first, last)
    }
}

/// Clip from world space.
pub fn matrix(scene: &Scene, size: [u32; 2], look: Look) -> Mat4 {
    let aspect = size[0] as f32 / size[1] as f32;
    match look.orthographic {
        Some(seen) => seen.projection(look.depth) * scene.camera.eye_from_world(),
        None => scene.camera.clip_from_world_as(aspect, look.depth),
    }
}

fn frame_uniform(scene: &Scene, clip_from_world: Mat4) -> FrameUniform {
    let camera = &scene.camera;
    // A surface that faces the light at the picture's middle gets 1 - exp(-2.2) of full light,
    // whatever the scene's scale.
    let reach = scene.light.truncate().distance(camera.target);
    let intensity = 2.2
        * if scene.light.w == 0.0 {
            1.0
        } else {
            reach * reach
        };
    FrameUniform {
        clip_from_world: clip_from_world.to_cols_array_2d(),
        eye: camera.eye.extend(1.0).to_array(),
        light: scene.light.to_array(),
        // Direction and cosine; without a cone every angle's cosine is above the -1.
        cone: scene.cone.map_or([0.0, 0.0, 0.0, -1.0], |cone| {
            let axis = cone.direction.normalize();
            axis.extend(cone.half_angle.cos()).to_array()
        }),
        range: scene.range,
        intensity,
        ambient: AMBIENT,
        padding: 0,
    }
}

fn frame_buffer(gpu: &Gpu, scene: &Scene, size: [u32; 2], look: Look) -> wgpu::Buffer {
    use wgpu::util::DeviceExt as _;
    gpu.device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("frame"),
            contents: bytemuck::bytes_of(&frame_uniform(scene, matrix(scene, size, look))),
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        })
}

fn host_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, has_dynamic_offset| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset,
            min_binding_size: None,
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("host"),
        entries: &[entry(0, false), entry(1, true)],
    })
}

fn host_group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    frame: &wgpu::Buffer,
    scene: &SceneGpu,
) -> wgpu::BindGroup {
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("host"),
        layout,
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: frame.as_entire_binding(),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: &scene.object_uniforms,
                    offset: 0,
                    size: wgpu::BufferSize::new(u64::from(scene.object_stride)),
                }),
            },
        ],
    })
}
