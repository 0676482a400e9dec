//! An ellipsoid for each caster, in both ways.

use anyhow::{Context as _, Result};
use serde_json::{Value, json};
use shadows::reference::Interior;
use shadows::{
    BlobDecalDescriptor, BlobFrame, BlobLight, BlobShadow, BlobShadowDescriptor, ContactHardening,
    wgpu,
};

use super::SurveyShadow;
use crate::shadow::{Cost, ShadowInputs};
use host::gpu::Gpu;
use host::renderer::{LitPipeline, Renderer, ShadowAccess};
use host::scene_gpu::SceneGpu;

/// How blobs are applied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blobs {
    /// By the function, which asks all of them at each pixel.
    Asked,
    /// As decals in a mask, which the lit pass reads.
    Decals,
}

const ASKS: &str = "
fn host_visibility(at: HostReceiver) -> f32 {
    return shadows_blob_visibility(0u, at.world);
}
";

const READS: &str = "
@group(1) @binding(0) var host_blobs: texture_2d<f32>;
fn host_visibility(at: HostReceiver) -> f32 {
    return textureLoad(host_blobs, vec2i(at.pixel), 0).r;
}
";

impl Blobs {
    pub(super) fn settings(self) -> Value {
        let descriptor = BlobShadowDescriptor::default();
        json!({
            "applied": format!("{self:?}"),
            "strips": descriptor.strips,
            "light_radius": light_radius(),
        })
    }

    pub(crate) fn snippet(self) -> String {
        match self {
            Self::Asked => "let blobs = BlobShadowDescriptor::default();\n".to_owned(),
            Self::Decals => "let blobs = BlobShadowDescriptor {\n    \
                decals: Some(BlobDecalDescriptor::default()),\n    ..Default::default()\n};\n"
                .to_owned(),
        }
    }

    pub(super) fn make(
        self,
        gpu: &Gpu,
        renderer: &Renderer,
    ) -> Result<(Box<dyn SurveyShadow>, LitPipeline)> {
        let blobs = BlobShadow::new(
            &gpu.device,
            &BlobShadowDescriptor {
                label: Some("compare"),
                decals: (self == Self::Decals).then(BlobDecalDescriptor::default),
                ..Default::default()
            },
        )?;
        let mask = match self {
            Self::Asked => None,
            Self::Decals => Some(Mask::new(gpu, renderer, &blobs)?),
        };
        let (module, layout) = match &mask {
            None => (blobs.wgsl_module(1) + ASKS, blobs.bind_group_layout()),
            Some(mask) => (READS.to_owned(), Some(&mask.layout)),
        };
        let lit = renderer.lit_pipeline(
            gpu,
            &ShadowAccess {
                module: Some(&module),
                layout,
                ..Default::default()
            },
        );
        Ok((Box::new(AtWork { blobs, mask }), lit))
    }
}

/// The truth of soft edges has this light.
fn light_radius() -> f32 {
    ContactHardening::default().light_size
}

struct AtWork {
    blobs: BlobShadow,
    mask: Option<Mask>,
}

/// What decals are multiplied in.
struct Mask {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    depth: wgpu::BindGroup,
}

impl Mask {
    fn new(gpu: &Gpu, renderer: &Renderer, blobs: &BlobShadow) -> Result<Self> {
        let depth = blobs
            .decal_bind_group(&gpu.device, renderer.depth_stencil())
            .context("decals need a depth buffer of one sample")?;
        let texture = gpu.target(renderer.size(), wgpu::TextureFormat::R8Unorm, 1);
        let view = texture.create_view(&Default::default());
        let layout = gpu
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("blobs"),
                entries: &[wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: false },
                        view_dimension: wgpu::TextureViewDimension::D2,
                        multisampled: false,
                    },
                    count: None,
                }],
            });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("blobs"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            }],
        });
        Ok(Self {
            texture,
            view,
            layout,
            group,
            depth,
        })
    }
}

impl SurveyShadow for AtWork {
    fn prepare(&mut self, gpu: &Gpu, inputs: &ShadowInputs) -> Result<()> {
        // Everything that is seen is within reach.
        let reach = (inputs.receivers.max - inputs.receivers.min).length();
        let light = BlobLight::new(inputs.light, light_radius(), 2.0 * reach);
        let frame = BlobFrame {
            lights: &[light],
            views: &[inputs.view],
            casters: &inputs.casters,
            blobs: &[],
        };
        // As if everything moved.
        self.blobs.invalidate();
        Ok(self.blobs.prepare(&gpu.device, &gpu.queue, &frame)?)
    }

    fn generate(&mut self, _: &Renderer, _: &SceneGpu, encoder: &mut wgpu::CommandEncoder) {
        self.blobs.encode(encoder);
        let Some(mask) = &self.mask else { return };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("blobs"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &mask.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        self.blobs
            .render(&mut pass, 0, 0, &mask.depth)
            .expect("it is encoded");
    }

    fn group(&self) -> Option<&wgpu::BindGroup> {
        match &self.mask {
            Some(mask) => Some(&mask.group),
            None => self.blobs.bind_group(),
        }
    }

    fn cost(&self) -> Cost {
        let taken = self.blobs.statistics();
        let pixels = self.mask.as_ref().map_or(0, |mask| {
            u64::from(mask.texture.width()) * u64::from(mask.texture.height())
        });
        let drawn = self.mask.is_some();
        Cost {
            bytes: taken.bytes + pixels,
            draws: u64::from(drawn),
            triangles: 12 * u64::from(taken.blobs) * u64::from(drawn),
        }
    }

    fn interior(&self) -> Interior {
        Interior::Screen
    }
}
