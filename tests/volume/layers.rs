//! A pass that draws several views, each into a layer of its target.

use std::num::NonZeroU32;

use shadows::{
    Caster, ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer, VolumeLight,
    VolumeView, wgpu,
};

use crate::passes::{HostPipelines, attach, clear, view_of};
use crate::stage::{SIDE, Stage};
use host::gpu::Gpu;

/// A device that draws several views in a pass and has these features.
pub fn gpu_with(features: wgpu::Features) -> Option<Gpu> {
    let gpu = Gpu::for_test()?;
    let missing = (wgpu::Features::MULTIVIEW | features) - gpu.device.features();
    if missing.is_empty() {
        return Some(gpu);
    }
    // Mesa's has all of them.
    let is_mesa = gpu.info.name.contains("llvmpipe") && gpu.info.backend == wgpu::Backend::Vulkan;
    assert!(!is_mesa, "{missing:?}");
    eprintln!("skipped: no {missing:?}");
    None
}

/// One whose clipped triangles are in the layers of their views. Mesa's lavapipe 22.3 draws those of one view
/// into the layer of another, with whatever pipeline; 25.0 does not.
pub fn gpu_that_clips(features: wgpu::Features) -> Option<Gpu> {
    let gpu = gpu_with(features)?;
    if clips_in_layers(&gpu) {
        return Some(gpu);
    }
    eprintln!(
        "skipped: {} draws clipped triangles into other layers",
        gpu.info.driver_info
    );
    None
}

/// Of the first view a triangle in the left half, of the second one in the right half. The near plane cuts
/// both.
const CLIPPED: &str = "
@vertex fn corner(
    @builtin(vertex_index) corner: u32,
    @builtin(view_index) layer: u32,
) -> @builtin(position) vec4f {
    let side = select(-1.0, 1.0, layer == 1u);
    let x = select(0.9, 0.1, corner == 0u);
    return vec4f(side * x, select(-1.0, 1.0, corner == 2u), select(0.5, -0.5, corner == 2u), 1.0);
}
@fragment fn one() -> @location(0) vec4f {
    return vec4f(1.0);
}
";

fn clips_in_layers(gpu: &Gpu) -> bool {
    let format = wgpu::TextureFormat::R8Unorm;
    let module = gpu
        .device
        .create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(CLIPPED.into()),
        });
    let pipeline = gpu
        .device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("one"),
                compilation_options: Default::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: NonZeroU32::new(0b11),
            cache: None,
        });
    let target = layered(gpu, 2, format, 1);
    let view = view_of(&target);
    gpu.run(|encoder| {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(clear(&view, wgpu::Color::BLACK, None))],
            multiview_mask: NonZeroU32::new(0b11),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.draw(0..3, 0..1);
    });
    [0, 1].into_iter().all(|layer| {
        let picture = gpu.read_texture(&target, layer, wgpu::TextureAspect::All);
        let is_right = |place: usize| place % SIDE as usize >= SIDE as usize / 2;
        let drawn = picture.iter().enumerate().filter(|(_, byte)| **byte != 0);
        let mut sides = drawn.map(|(place, _)| is_right(place)).peekable();
        sides.peek().is_some() && sides.all(|right| right == (layer == 1))
    })
}

pub fn layered(gpu: &Gpu, layers: u32, format: wgpu::TextureFormat, samples: u32) -> wgpu::Texture {
    use wgpu::TextureUsages as U;
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("layers"),
        size: wgpu::Extent3d {
            width: SIDE,
            height: SIDE,
            depth_or_array_layers: layers,
        },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: match samples {
            1 => U::RENDER_ATTACHMENT | U::COPY_SRC | U::COPY_DST | U::TEXTURE_BINDING,
            _ => U::RENDER_ATTACHMENT,
        },
        view_formats: &[],
    })
}

pub fn layer_of(texture: &wgpu::Texture, layer: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

/// The views of a pass that draws into these layers.
pub struct Pass<'a> {
    pub gpu: &'a Gpu,
    pub mask: u32,
    pub stages: Vec<Stage>,
    casters: Vec<Caster>,
}

impl<'a> Pass<'a> {
    pub fn new(gpu: &'a Gpu, mask: u32, stages: &[Stage]) -> Self {
        Self {
            gpu,
            mask,
            stages: stages.to_vec(),
            casters: stages[0].casters(gpu),
        }
    }

    pub fn multiview_mask(&self) -> Option<NonZeroU32> {
        NonZeroU32::new(self.mask)
    }

    pub fn renderer(&self) -> ShadowVolumeRenderer {
        let descriptor = ShadowVolumeDescriptor {
            multiview_mask: self.multiview_mask(),
            ..self.stages[0].descriptor()
        };
        ShadowVolumeRenderer::new(&self.gpu.device, &descriptor).unwrap()
    }

    pub fn target(&self, format: wgpu::TextureFormat, samples: u32) -> wgpu::Texture {
        let layers = u32::BITS - self.mask.leading_zeros();
        layered(self.gpu, layers, format, samples)
    }

    pub fn prepare(&self, renderer: &mut ShadowVolumeRenderer, lights: &[VolumeLight]) {
        let view = |stage: &Stage| VolumeView {
            view: stage.view(),
            target_size: Some([SIDE; 2]),
        };
        let views: Vec<_> = self.stages.iter().map(view).collect();
        let frame = ShadowVolumeFrame {
            lights,
            views: &views,
            receivers: self.stages[0].receivers,
            casters: &self.casters,
        };
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        renderer.prepare(device, queue, &frame).unwrap();
    }

    /// Draws the depth of each view alone into its layer, and clears the other layers.
    pub fn prepass(&self, encoder: &mut wgpu::CommandEncoder, depth: &wgpu::Texture) {
        let host = HostPipelines::new(self.gpu, &self.stages[0]);
        let mut stages = self.stages.iter();
        for layer in 0..depth.depth_or_array_layers() {
            let stage = (self.mask >> layer & 1 == 1).then(|| stages.next());
            let surfaces = stage.flatten().map(|stage| stage.surfaces(self.gpu));
            let surfaces = surfaces.unwrap_or_default();
            self.stages[0].prepass(encoder, &layer_of(depth, layer), &host, &surfaces);
        }
    }

    /// What `draw` draws into all layers at once, over the depth of each.
    pub fn record(
        &self,
        renderer: &mut ShadowVolumeRenderer,
        depth: &wgpu::Texture,
        counts: Option<&wgpu::Texture>,
        draw: impl FnOnce(&ShadowVolumeRenderer, &mut wgpu::RenderPass<'_>),
    ) {
        let (depth_view, counts) = (view_of(depth), counts.map(view_of));
        let counts = counts.as_ref();
        let colors = counts.map(|view| Some(clear(view, wgpu::Color::TRANSPARENT, None)));
        let colors: Vec<_> = colors.into_iter().collect();
        self.gpu.checked(|| {
            self.gpu.run(|encoder| {
                renderer.encode(encoder);
                self.prepass(encoder, depth);
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("all layers"),
                    color_attachments: &colors,
                    depth_stencil_attachment: Some(attach(&depth_view, None)),
                    multiview_mask: self.multiview_mask(),
                    ..Default::default()
                });
                draw(renderer, &mut pass);
            });
        });
    }

    pub fn light(&self) -> VolumeLight {
        VolumeLight::new(self.stages[0].light, self.stages[0].range)
    }

    /// The stencil's counts, layer by layer.
    pub fn counts(&self) -> Vec<Vec<u8>> {
        let mut renderer = self.renderer();
        self.prepare(&mut renderer, &[self.light()]);
        self.counts_of(&mut renderer, |renderer, pass| {
            renderer.render(pass, 0, 0).unwrap();
        })
    }

    pub fn counts_of(
        &self,
        renderer: &mut ShadowVolumeRenderer,
        draw: impl FnOnce(&ShadowVolumeRenderer, &mut wgpu::RenderPass<'_>),
    ) -> Vec<Vec<u8>> {
        let depth = self.target(self.stages[0].format, 1);
        self.record(renderer, &depth, None, draw);
        read(self.gpu, &depth, wgpu::TextureAspect::StencilOnly)
    }
}

/// All layers.
pub fn read(gpu: &Gpu, texture: &wgpu::Texture, aspect: wgpu::TextureAspect) -> Vec<Vec<u8>> {
    let layers = 0..texture.depth_or_array_layers();
    layers
        .map(|layer| gpu.read_texture(texture, layer, aspect))
        .collect()
}

/// The layers of a pass are those of each view alone.
pub fn assert_same(found: &[Vec<u8>], right: &[Vec<u8>], what: &str) {
    assert_eq!(found.len(), right.len(), "{what}");
    let of = |(a, b): (&Vec<u8>, &Vec<u8>)| a.iter().zip(b).filter(|(a, b)| a != b).count();
    let differences: Vec<usize> = found.iter().zip(right).map(of).collect();
    assert_eq!(differences, vec![0; right.len()], "{what}");
}
