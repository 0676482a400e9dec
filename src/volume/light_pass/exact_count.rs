//! A count of volumes that never wraps: its target, its pass, and how light passes read it.

use std::num::NonZeroU32;

use crate::error::ScreenPassError;
use crate::volume::gpu::counter::{FEATURE, FORMAT};
use crate::volume::light_pass::checks::{
    check_buffer, check_layers, check_readable, check_samples, check_size, check_target,
};
use crate::volume::light_pass::join::bind;
use crate::volume::light_pass::read::Read;
use crate::volume::light_pass::screen::{On, SCREEN, ScreenPipeline};
use crate::volume::light_pass::targets::{DEPTH_STENCIL, has_depth_alone, has_stencil};
use crate::volume::multiview::Multiview;
use crate::wgsl::{EXACT, EXACT_LAYERS, EXACT_SAMPLES};

const MARK: &str = include_str!("../../../shaders/volume_mark.wgsl");
const MARK_SAMPLES: &str = include_str!("../../../shaders/volume_mark_samples.wgsl");
const MARK_LAYERS: &str = include_str!("../../../shaders/volume_mark_layers.wgsl");

/// Parameters of an [`ExactCount`].
#[derive(Clone, Copy, Debug)]
pub struct ExactCountDescriptor<'a> {
    /// Name of its GPU objects in debuggers, after "shadows count". Default `None`.
    pub label: Option<&'a str>,
    /// Width and height in pixels, those of the host's depth-stencil buffer: at least 1, at most
    /// the device's `max_texture_dimension_2d`. Default 1 x 1.
    pub size: [u32; 2],
    /// Format of the host's depth-stencil buffer, or of its depth buffer: `Depth32Float` and `Depth24Plus`
    /// will do unless [`ExactCount::encode`] is used. Default `Depth32FloatStencil8`.
    pub depth_stencil_format: wgpu::TextureFormat,
    /// Its samples per pixel, 1 (default) or 4; only 1 on wgpu's GL back end, whose shaders cannot read
    /// multisampled textures. Each sample has its own count.
    pub sample_count: u32,
    /// The layers that a pass draws into all at once, a bit each: that of
    /// [`ShadowVolumeDescriptor::multiview_mask`](crate::ShadowVolumeDescriptor::multiview_mask). Default `None`.
    /// With a mask there is a count for each view, and `sample_count` is 1.
    pub multiview_mask: Option<NonZeroU32>,
}

impl Default for ExactCountDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            size: [1, 1],
            depth_stencil_format: DEPTH_STENCIL,
            sample_count: 1,
            multiview_mask: None,
        }
    }
}

/// The number of volumes that contain each visible point, as 32-bit floats, for renderers with
/// [`Counter::Exact`](crate::Counter::Exact).
///
/// For each light:
/// 1. [`begin`](Self::begin) a pass and draw
///    [`ShadowVolumeRenderer::render`](crate::ShadowVolumeRenderer::render) into it;
/// 2. either, if the buffer has a stencil, [`encode`](Self::encode), which marks shadow in the stencil, so that every
///    kind of light pass works as after counting in the stencil
///    ([`light_pass_stencil`](crate::ShadowVolumeRenderer::light_pass_stencil) with its guard,
///    [`LightJoin`](crate::LightJoin), [`ShadowMask`](crate::ShadowMask));
/// 3. or a lighting pass that reads [`view`](Self::view) in its shader: with one sample per pixel as
///    `texture_2d<f32>`, by [`wgsl::EXACT`](crate::wgsl::EXACT); with four as `texture_multisampled_2d<f32>`,
///    by [`wgsl::EXACT_SAMPLES`](crate::wgsl::EXACT_SAMPLES). (Both are bound as unfilterable floats.) Of
///    several views as `texture_2d_array<f32>`, by [`wgsl::EXACT_LAYERS`](crate::wgsl::EXACT_LAYERS);
/// 4. or [`ShadowMask::encode_counts`](crate::ShadowMask::encode_counts), for any later pass.
///
/// GPU memory: four bytes per sample.
#[derive(Debug)]
pub struct ExactCount {
    label: String,
    /// Marks the stencil, if there is one.
    pipeline: Option<wgpu::RenderPipeline>,
    group: wgpu::BindGroup,
    view: wgpu::TextureView,
    depth_stencil_format: wgpu::TextureFormat,
    multiview: Multiview,
}

impl ExactCount {
    /// Creates the target and the pipeline.
    ///
    /// # Errors
    /// [`ScreenPassError`] if the device lacks
    /// [`FLOAT32_BLENDABLE`](wgpu::Features::FLOAT32_BLENDABLE), or the size, the format or the
    /// sample count is out of range.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ExactCountDescriptor<'_>,
    ) -> Result<Self, ScreenPassError> {
        if !device.features().contains(FEATURE) {
            return Err(ScreenPassError::MissingFeature {
                feature: FEATURE,
                needed_by: "ExactCount",
            });
        }
        check_size(descriptor.size, &device.limits())?;
        let format = descriptor.depth_stencil_format;
        match has_depth_alone(format) {
            true => check_samples(descriptor.sample_count)?,
            false => check_target(device, format, descriptor.sample_count)?,
        }
        let multiview = Multiview(descriptor.multiview_mask);
        check_readable(device, multiview, descriptor.sample_count, "ExactCount")?;
        let label = match descriptor.label {
            Some(name) => format!("shadows count {name}"),
            None => "shadows count".to_owned(),
        };
        let view = target(device, &label, descriptor);
        let read = Read::of(descriptor.sample_count, multiview);
        let layout = read.layout(device, &label);
        let pipeline = ScreenPipeline {
            label: &label,
            source: source(read),
            fragment: "shadowed",
            layout: &[Some(&layout)],
            target: None,
            depth_stencil_format: Some(format),
            sample_count: descriptor.sample_count,
            multiview,
            on: On::Marked,
        };
        Ok(Self {
            pipeline: has_stencil(format).then(|| pipeline.make(device)),
            group: bind(device, &label, &layout, &view),
            view,
            depth_stencil_format: format,
            multiview,
            label,
        })
    }

    /// Begins the pass that [`ShadowVolumeRenderer::render`](crate::ShadowVolumeRenderer::render)
    /// draws into: all counts are 0, and the depth-stencil buffer is only read.
    ///
    /// # Errors
    /// [`ScreenPassError::Buffer`] if the buffer does not match the descriptor. Nothing is then recorded.
    pub fn begin<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        depth_stencil: &wgpu::TextureView,
    ) -> Result<wgpu::RenderPass<'e>, ScreenPassError> {
        self.check(depth_stencil)?;
        Ok(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&self.label),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(attachment(depth_stencil, None)),
            multiview_mask: self.multiview.0,
            ..Default::default()
        }))
    }

    /// Records a pass that sets the stencil to 1 where the count is not 0, and to 0 elsewhere. The
    /// depth is only read.
    ///
    /// # Errors
    /// [`ScreenPassError::Buffer`] if the buffer does not match the descriptor,
    /// [`ScreenPassError::NoStencil`] if it has no stencil. Nothing is then recorded.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        depth_stencil: &wgpu::TextureView,
    ) -> Result<(), ScreenPassError> {
        self.check(depth_stencil)?;
        let no_stencil = ScreenPassError::NoStencil(self.depth_stencil_format);
        let pipeline = self.pipeline.as_ref().ok_or(no_stencil)?;
        let cleared = wgpu::Operations {
            load: wgpu::LoadOp::Clear(0),
            store: wgpu::StoreOp::Store,
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&self.label),
            depth_stencil_attachment: Some(attachment(depth_stencil, Some(cleared))),
            multiview_mask: self.multiview.0,
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_stencil_reference(1);
        pass.draw(0..3, 0..1);
        Ok(())
    }

    /// The counts, `R32Float`: to be bound, or to be used as the last colour attachment of a pass that the
    /// host begins itself and clears to 0.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// The texture itself, which may also be copied from if it has one sample per pixel.
    pub fn texture(&self) -> &wgpu::Texture {
        self.view.texture()
    }

    /// Binds the counts, where shaders of the light passes read them.
    pub(crate) fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }

    fn check(&self, depth_stencil: &wgpu::TextureView) -> Result<(), ScreenPassError> {
        let own = self.view.texture();
        let needed = [own.width(), own.height(), own.sample_count()];
        check_buffer(depth_stencil, needed, self.depth_stencil_format)?;
        check_layers(depth_stencil.texture(), self.multiview)
    }

    /// Whether it is of the views that are needed.
    pub(crate) fn check_multiview(&self, needed: Multiview) -> Result<(), ScreenPassError> {
        let (found, needed) = (self.multiview.0, needed.0);
        match found == needed {
            true => Ok(()),
            false => Err(ScreenPassError::Multiview { found, needed }),
        }
    }
}

/// The shader that marks the stencil.
pub(crate) fn source(read: Read) -> String {
    let own = [
        [SCREEN, EXACT, MARK],
        [SCREEN, EXACT_SAMPLES, MARK_SAMPLES],
        [SCREEN, EXACT_LAYERS, MARK_LAYERS],
    ];
    read.pick(own).join("\n")
}

fn target(
    device: &wgpu::Device,
    label: &str,
    descriptor: &ExactCountDescriptor<'_>,
) -> wgpu::TextureView {
    use wgpu::TextureUsages as U;
    let [width, height] = descriptor.size;
    let multiview = Multiview(descriptor.multiview_mask);
    // Nothing with several samples can be copied into a buffer.
    let copied = match descriptor.sample_count {
        1 => U::COPY_SRC,
        _ => U::empty(),
    };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: multiview.layers(),
        },
        mip_level_count: 1,
        sample_count: descriptor.sample_count,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: U::RENDER_ATTACHMENT | U::TEXTURE_BINDING | copied,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some(label),
        dimension: Some(multiview.dimension()),
        ..Default::default()
    })
}

/// With a read-only depth.
fn attachment(
    view: &wgpu::TextureView,
    stencil_ops: Option<wgpu::Operations<u32>>,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: None,
        stencil_ops,
    }
}
