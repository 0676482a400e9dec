//! A mask of what each light reaches, for later passes to sample.

use std::num::NonZeroU32;

use crate::error::ScreenPassError;
use crate::gl;
use crate::volume::gpu::counter::{self, Counter};
use crate::volume::light_pass::checks::{
    check_buffer, check_layers, check_multiview, check_range, check_readable_samples,
    check_samples, check_size, check_target,
};
use crate::volume::light_pass::exact_count::ExactCount;
use crate::volume::light_pass::read::Read;
use crate::volume::light_pass::screen::{On, SCREEN, ScreenPipeline};
use crate::volume::light_pass::targets::DEPTH_STENCIL;
use crate::volume::multiview::Multiview;
use crate::wgsl::{EXACT, EXACT_LAYERS, EXACT_SAMPLES};

const COUNTS: &str = include_str!("../../../shaders/volume_mask_counts.wgsl");
const COUNTS_SAMPLES: &str = include_str!("../../../shaders/volume_mask_counts_samples.wgsl");
const COUNTS_LAYERS: &str = include_str!("../../../shaders/volume_mask_counts_layers.wgsl");
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// Parameters of a [`ShadowMask`].
#[derive(Clone, Copy, Debug)]
pub struct ShadowMaskDescriptor<'a> {
    /// Name of its GPU objects in debuggers, after "shadows mask". Default `None`.
    pub label: Option<&'a str>,
    /// Width and height in pixels, those of the host's depth-stencil buffer: at least 1, at most
    /// the device's `max_texture_dimension_2d`. Default 1 x 1.
    pub size: [u32; 2],
    /// Number of lights, each of which has one layer, or with a multiview mask one per view: 1 (default) to the device's `max_texture_array_layers`.
    pub lights: u32,
    /// Format of the depth-stencil buffer that the volumes were counted in. Default
    /// `Depth32FloatStencil8`.
    pub depth_stencil_format: wgpu::TextureFormat,
    /// Its samples per pixel, 1 (default) or 4. With 4, the mask holds the fraction of lit samples.
    pub sample_count: u32,
    /// The layers that a pass draws into all at once, a bit each: that of
    /// [`ShadowVolumeDescriptor::multiview_mask`](crate::ShadowVolumeDescriptor::multiview_mask). Default `None`.
    /// With a mask `sample_count` is 1, and each light has as many layers as the mask has bits up to its
    /// last: a view reads `light * layers + view_index`.
    pub multiview_mask: Option<NonZeroU32>,
    /// What the volumes were counted in. Default [`Counter::Stencil`]: the mask is filled by
    /// [`encode`](ShadowMask::encode). With [`Counter::Exact`] it is filled by
    /// [`encode_counts`](ShadowMask::encode_counts), `depth_stencil_format` is ignored, and no stencil is
    /// needed.
    pub counter: Counter,
}

impl Default for ShadowMaskDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            size: [1, 1],
            lights: 1,
            depth_stencil_format: DEPTH_STENCIL,
            sample_count: 1,
            multiview_mask: None,
            counter: Counter::Stencil,
        }
    }
}

/// The shadows of as many lights as a texture can have layers, with one byte per pixel, light and view.
///
/// Volumes are counted in the stencil buffer one light after another; each result is copied into the light's
/// layer, and one lighting pass reads them all:
///
/// 1. for each light: a pass that clears the stencil and draws
///    [`ShadowVolumeRenderer::render`](crate::ShadowVolumeRenderer::render), then
///    [`encode`](Self::encode) with the light's layer;
/// 2. the host's lighting pass, with [`view`](Self::view) bound as `texture_2d_array<f32>` and
///    [`wgsl::MASK`](crate::wgsl::MASK) in its shader. It needs no stencil, and may use any blending.
///
/// GPU memory: one byte per pixel, light and view of a multiview mask, and with four samples five more per pixel. On wgpu's GL back
/// end, which does not treat some textures as arrays, one more byte per pixel if the number of lights is one
/// or a multiple of six.
#[derive(Debug)]
pub struct ShadowMask {
    label: String,
    pipeline: wgpu::RenderPipeline,
    texture: wgpu::Texture,
    view: wgpu::TextureView,
    layers: Vec<wgpu::TextureView>,
    /// Between stencil and layer, if there are several samples.
    samples: Option<Samples>,
    depth_stencil_format: wgpu::TextureFormat,
    counter: Counter,
    sample_count: u32,
    multiview: Multiview,
}

/// Where samples are drawn and resolved. Not into the layer itself: resolved into layers, the mask of
/// one light came out wrong on Mesa's lavapipe (22.3).
#[derive(Debug)]
struct Samples {
    drawn: wgpu::TextureView,
    resolved: wgpu::TextureView,
}

impl ShadowMask {
    /// Creates the texture and the pipeline.
    ///
    /// # Errors
    /// [`ScreenPassError`] if the size, the number of lights, the format or the sample count is out
    /// of range.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ShadowMaskDescriptor<'_>,
    ) -> Result<Self, ScreenPassError> {
        let limits = device.limits();
        let [width, height] = descriptor.size;
        check_size(descriptor.size, &limits)?;
        let multiview = Multiview(descriptor.multiview_mask);
        check_multiview(device, multiview, descriptor.sample_count, "ShadowMask")?;
        let most = most_layers(device, &limits) / multiview.layers();
        check_range("number of lights", descriptor.lights, most)?;
        let (samples, by_stencil) = (
            descriptor.sample_count,
            descriptor.counter == Counter::Stencil,
        );
        match by_stencil {
            true => check_target(device, descriptor.depth_stencil_format, samples)?,
            false => {
                check_samples(samples)?;
                check_readable_samples(device, samples, "ShadowMask of Counter::Exact")?;
            }
        }
        let label = match descriptor.label {
            Some(name) => format!("shadows mask {name}"),
            None => "shadows mask".to_owned(),
        };
        let texture = |layers, samples, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(&label),
                size: wgpu::Extent3d {
                    width,
                    height,
                    depth_or_array_layers: layers,
                },
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format: FORMAT,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        use wgpu::TextureUsages as U;
        let readable = U::TEXTURE_BINDING | U::COPY_SRC | U::COPY_DST;
        let layers = descriptor.lights * multiview.layers();
        let mask = texture(gl::array_layers(device, layers), 1, readable);
        let samples = (samples > 1 && by_stencil).then(|| Samples {
            drawn: layer_of(
                &texture(1, descriptor.sample_count, U::empty()),
                &label,
                0,
                multiview,
            ),
            resolved: layer_of(&texture(1, 1, U::COPY_SRC), &label, 0, multiview),
        });
        Ok(Self {
            pipeline: match by_stencil {
                true => by_stencil_pipeline(device, &label, descriptor),
                false => by_counts_pipeline(device, &label, descriptor),
            },
            view: mask.create_view(&wgpu::TextureViewDescriptor {
                label: Some(&label),
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                array_layer_count: Some(layers),
                ..Default::default()
            }),
            layers: (0..descriptor.lights)
                .map(|light| layer_of(&mask, &label, light, multiview))
                .collect(),
            samples,
            texture: mask,
            depth_stencil_format: descriptor.depth_stencil_format,
            counter: descriptor.counter,
            sample_count: descriptor.sample_count,
            multiview,
            label,
        })
    }

    /// Records a pass that copies the stencil's result for one light into the light's layer: 1 where the
    /// count is 0, otherwise 0. The depth-stencil buffer is only read.
    ///
    /// # Errors
    /// [`ScreenPassError`] if there is no such layer, or if the buffer does not match the descriptor. Nothing
    /// is then recorded.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        light: u32,
        depth_stencil: &wgpu::TextureView,
    ) -> Result<(), ScreenPassError> {
        let layer = self.layer(Counter::Stencil, light)?;
        let samples = self.samples.as_ref();
        let samples = samples.map_or(1, |s| s.drawn.texture().sample_count());
        let needed = [self.texture.width(), self.texture.height(), samples];
        check_buffer(depth_stencil, needed, self.depth_stencil_format)?;
        check_layers(depth_stencil.texture(), self.multiview)?;
        let (view, resolve_target) = match &self.samples {
            Some(samples) => (&samples.drawn, Some(&samples.resolved)),
            None => (layer, None),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&self.label),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth_stencil,
                depth_ops: None,
                stencil_ops: None,
            }),
            multiview_mask: self.multiview.0,
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_stencil_reference(0);
        pass.draw(0..3, 0..1);
        drop(pass);
        if let Some(resolved) = resolve_target {
            self.copy(encoder, resolved.texture(), light);
        }
        Ok(())
    }

    /// Records a pass that writes the result of the exact counts for one light into the light's layer: 1
    /// where the count is 0, otherwise 0; with several samples, the fraction of lit ones.
    ///
    /// # Errors
    /// [`ScreenPassError`] if there is no such layer, the mask was made for another counter, or the
    /// counts are of another size, number of samples or multiview mask. Nothing is then recorded.
    pub fn encode_counts(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        light: u32,
        counts: &ExactCount,
    ) -> Result<(), ScreenPassError> {
        let layer = self.layer(Counter::Exact, light)?;
        let [width, height] = [self.texture.width(), self.texture.height()];
        let needed = [width, height, self.sample_count];
        check_buffer(counts.view(), needed, counter::FORMAT)?;
        counts.check_multiview(self.multiview)?;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&self.label),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: layer,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            multiview_mask: self.multiview.0,
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, counts.group(), &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }

    /// A light's layer, if the mask is filled in this way.
    fn layer(&self, by: Counter, light: u32) -> Result<&wgpu::TextureView, ScreenPassError> {
        if by != self.counter {
            return Err(ScreenPassError::Counter(self.counter));
        }
        let lights = self.layers.len() as u32;
        let no_layer = ScreenPassError::Layer { light, lights };
        self.layers.get(light as usize).ok_or(no_layer)
    }

    fn copy(&self, encoder: &mut wgpu::CommandEncoder, resolved: &wgpu::Texture, light: u32) {
        let mut to = self.texture.as_image_copy();
        to.origin.z = light;
        encoder.copy_texture_to_texture(resolved.as_image_copy(), to, resolved.size());
    }

    /// The layers of all lights, `R8Unorm`, to bind as `texture_2d_array<f32>`.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// The texture itself, which may also be copied from. On wgpu's GL back end it may have an additional,
    /// unused layer.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.texture
    }
}

/// Copies where the stencil's count is 0.
fn by_stencil_pipeline(
    device: &wgpu::Device,
    label: &str,
    descriptor: &ShadowMaskDescriptor<'_>,
) -> wgpu::RenderPipeline {
    ScreenPipeline {
        label,
        source: SCREEN.to_owned(),
        fragment: "one",
        layout: &[],
        target: Some(FORMAT.into()),
        depth_stencil_format: Some(descriptor.depth_stencil_format),
        sample_count: descriptor.sample_count,
        multiview: Multiview(descriptor.multiview_mask),
        on: On::Lit,
    }
    .make(device)
}

/// Reads exact counts.
fn by_counts_pipeline(
    device: &wgpu::Device,
    label: &str,
    descriptor: &ShadowMaskDescriptor<'_>,
) -> wgpu::RenderPipeline {
    let multiview = Multiview(descriptor.multiview_mask);
    let read = Read::of(descriptor.sample_count, multiview);
    ScreenPipeline {
        label,
        source: counts_source(read),
        fragment: "counted",
        layout: &[Some(&read.layout(device, label))],
        target: Some(FORMAT.into()),
        depth_stencil_format: None,
        sample_count: 1,
        multiview,
        on: On::Everything,
    }
    .make(device)
}

/// The shader that reads them.
pub(crate) fn counts_source(read: Read) -> String {
    let own = [
        [SCREEN, EXACT, COUNTS],
        [SCREEN, EXACT_SAMPLES, COUNTS_SAMPLES],
        [SCREEN, EXACT_LAYERS, COUNTS_LAYERS],
    ];
    read.pick(own).join("\n")
}

/// As many as an array has layers.
fn most_layers(device: &wgpu::Device, limits: &wgpu::Limits) -> u32 {
    let layers = limits.max_texture_array_layers;
    match gl::array_layers(device, layers) > layers {
        true => layers - 1,
        false => layers,
    }
}

/// What passes draw into: the layer of a light, or those of its views.
fn layer_of(
    texture: &wgpu::Texture,
    label: &str,
    light: u32,
    multiview: Multiview,
) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some(label),
        dimension: Some(multiview.dimension()),
        base_array_layer: light * multiview.layers(),
        array_layer_count: Some(multiview.layers()),
        ..Default::default()
    })
}
