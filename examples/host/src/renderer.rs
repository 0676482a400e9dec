//! A forward renderer without a window: depth and ambient light first, then one pass that adds the
//! light and writes its visibility beside it.

use anyhow::Result;
use shadows::glam::Mat4;
use shadows::glam::camera::rh::proj::directx;
use shadows::{DepthBounds, DepthConvention, View, wgpu};

use super::depth_bounds::depth_bounds;
use super::gpu::Gpu;
use super::image;
use super::pipelines::{self, Drawing, Shared};
pub use super::pipelines::{DEPTH, LitPipeline, Look, Orthographic, SHADED, ShadowAccess};
use super::scene::{Light, Scene};
use super::scene_gpu::SceneGpu;
use super::targets::{Targets, color};
use super::uniforms::Uniforms;

/// Targets and pipelines for one scene seen by one camera.
pub struct Renderer {
    size: [u32; 2],
    look: Look,
    depth_stencil_format: wgpu::TextureFormat,
    targets: Targets,
    host_layout: wgpu::BindGroupLayout,
    /// One for each light.
    host_groups: Vec<wgpu::BindGroup>,
    uniforms: Uniforms,
    /// As they were last shown.
    lights: Vec<Light>,
    horizon: [f32; 3],
    masks: bool,
    sky: Option<wgpu::RenderPipeline>,
    ambient: Drawing,
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
        let uniforms = Uniforms::new(gpu, scene);
        uniforms.write(gpu, scene, matrix(scene, size, look));
        let host_layout = host_layout(&gpu.device);
        let lights = 0..scene.lights.len();
        let host_groups = lights
            .map(|light| host_group(gpu, &host_layout, &uniforms, scene_gpu, light))
            .collect();
        let shared = Shared {
            device: &gpu.device,
            layout: &host_layout,
            format: depth_stencil_format,
            look,
            masks: scene_gpu.has_masks(),
        };
        let gradient = scene.sky.horizon != scene.sky.zenith;
        Ok(Self {
            size,
            look,
            depth_stencil_format,
            targets,
            uniforms,
            lights: scene.lights.clone(),
            horizon: scene.sky.horizon,
            masks: shared.masks,
            sky: gradient.then(|| pipelines::sky(&shared)),
            ambient: pipelines::ambient(&shared),
            unshadowed: pipelines::lit(&shared, &ShadowAccess::default()),
            host_layout,
            host_groups,
        })
    }

    /// Draws from now on what the scene's camera and lights have become, through a matrix of its own.
    /// The lights are as many as at first.
    pub fn show(&mut self, gpu: &Gpu, scene: &Scene, clip_from_world: Mat4) {
        self.lights.clone_from(&scene.lights);
        self.uniforms.write(gpu, scene, clip_from_world);
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

    /// Draws the scene's depth, and tells between which depths its picture shows anything. The view is that of
    /// the camera that was last shown.
    pub fn depth_bounds(&self, gpu: &Gpu, scene: &SceneGpu, view: &View) -> Option<DepthBounds> {
        gpu.run(|encoder| self.draw_ambient(encoder, scene));
        depth_bounds(gpu, &self.targets.depth_texture, view)
    }

    /// The lit pass's pipeline for one way to find shadows.
    pub fn lit_pipeline(&self, gpu: &Gpu, access: &ShadowAccess<'_>) -> LitPipeline {
        let shared = Shared {
            device: &gpu.device,
            layout: &self.host_layout,
            format: self.depth_stencil_format,
            look: self.look,
            masks: self.masks,
        };
        pipelines::lit(&shared, access)
    }

    /// The lit pass's pipeline without shadows.
    pub fn unshadowed(&self) -> &LitPipeline {
        &self.unshadowed
    }

    /// Clears, then draws depth and ambient light.
    pub fn draw_ambient(&self, encoder: &mut wgpu::CommandEncoder, scene: &SceneGpu) {
        let (shaded, _) = self.targets.shaded.views();
        let [r, g, b] = self.horizon.map(f64::from);
        let sky = wgpu::Color { r, g, b, a: 1.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("ambient"),
            color_attachments: &[Some(color(&shaded, None, wgpu::LoadOp::Clear(sky)))],
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
        if let Some(sky) = &self.sky {
            pass.set_pipeline(sky);
            pass.set_bind_group(0, &self.host_groups[0], &[0]);
            pass.draw(0..3, 0..1);
        }
        self.draw_objects(&mut pass, scene, &self.ambient, 0, None);
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

    /// Adds the first light where it is not shadowed, and writes its visibility.
    pub fn draw_lit(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &SceneGpu,
        lit: &LitPipeline,
        shadow_group: Option<&wgpu::BindGroup>,
    ) {
        self.draw_lit_by(encoder, scene, 0, lit, shadow_group);
    }

    /// Adds one of the lights where it is not shadowed, and writes its visibility, over that of any
    /// light before it.
    pub fn draw_lit_by(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &SceneGpu,
        light: usize,
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
        pass.set_stencil_reference(0);
        if let Some(group) = shadow_group {
            pass.set_bind_group(1, group, &[]);
        }
        let reach = Some(&self.lights[light]);
        self.draw_objects(&mut pass, scene, &lit.drawing, light, reach);
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

    /// Draws the objects, or those that a light reaches.
    fn draw_objects(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        scene: &SceneGpu,
        drawing: &Drawing,
        light: usize,
        reach: Option<&Light>,
    ) {
        let group = &self.host_groups[light];
        let mut masked = None;
        for (place, object) in scene.objects.iter().enumerate() {
            let mesh = &scene.meshes[object.mesh];
            let seen = reach.is_none_or(|light| object.is_reached(light));
            if mesh.index_count == 0 || !seen {
                continue;
            }
            if masked != Some(mesh.mask.is_some()) {
                masked = Some(mesh.mask.is_some());
                pass.set_pipeline(match (&mesh.mask, &drawing.masked) {
                    (Some(_), Some(masked)) => masked,
                    _ => &drawing.solid,
                });
            }
            let offset = place as u32 * scene.object_stride;
            pass.set_bind_group(0, group, &[offset]);
            pass.set_vertex_buffer(0, mesh.positions.slice(..));
            pass.set_vertex_buffer(1, mesh.normals.slice(..));
            if let Some(mask) = &mesh.mask {
                pass.set_vertex_buffer(2, mask.slice(..));
            }
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
    uniforms: &Uniforms,
    scene: &SceneGpu,
    light: usize,
) -> wgpu::BindGroup {
    let one_of = |buffer, stride: u32, place: usize| {
        wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer,
            offset: place as u64 * u64::from(stride),
            size: wgpu::BufferSize::new(u64::from(stride)),
        })
    };
    let resources = [
        one_of(&uniforms.frames, uniforms.stride, light),
        one_of(&scene.object_uniforms, scene.object_stride, 0),
    ];
    let entries = (0..).zip(resources);
    let entries: Vec<_> = entries
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("host"),
        layout,
        entries: &entries,
    })
}
