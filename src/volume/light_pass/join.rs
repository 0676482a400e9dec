//! Combining ambient and direct light from two targets in a full-screen pass.

use std::num::NonZeroU32;

use crate::error::ScreenPassError;
use crate::volume::light_pass::checks::{check_layers, check_readable, check_target};
use crate::volume::light_pass::read::Read;
use crate::volume::light_pass::screen::{On, SCREEN, ScreenPipeline};
use crate::volume::light_pass::targets::{DEPTH_STENCIL, is_drawable};
use crate::volume::multiview::Multiview;

const JOIN: &str = include_str!("../../../shaders/volume_join.wgsl");
const JOIN_SAMPLES: &str = include_str!("../../../shaders/volume_join_samples.wgsl");
const JOIN_LAYERS: &str = include_str!("../../../shaders/volume_join_layers.wgsl");

/// Parameters of a [`LightJoin`].
#[derive(Clone, Copy, Debug)]
pub struct LightJoinDescriptor<'a> {
    /// Name of its GPU objects in debuggers, after "shadows join". Default `None`.
    pub label: Option<&'a str>,
    /// Format of the target, which must be blendable. Default `Rgba8Unorm`.
    pub color_format: wgpu::TextureFormat,
    /// Format of the depth-stencil buffer that the volumes were counted in. Default
    /// `Depth32FloatStencil8`.
    pub depth_stencil_format: wgpu::TextureFormat,
    /// Samples per pixel of target, depth-stencil buffer and sources: 1 (default) or 4; only 1 on wgpu's GL
    /// back end, whose shaders cannot read multisampled textures.
    pub sample_count: u32,
    /// The layers that a pass draws into all at once, a bit each: that of
    /// [`ShadowVolumeDescriptor::multiview_mask`](crate::ShadowVolumeDescriptor::multiview_mask). Default `None`.
    /// With a mask sources have a layer for each view, too, and `sample_count` is 1.
    pub multiview_mask: Option<NonZeroU32>,
}

impl Default for LightJoinDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            color_format: wgpu::TextureFormat::Rgba8Unorm,
            depth_stencil_format: DEPTH_STENCIL,
            sample_count: 1,
            multiview_mask: None,
        }
    }
}

/// Combines what the host has drawn in a single pass: ambient light in one target, diffuse and specular light
/// in another (Wolff, "OpenGL 4 Shading Language Cookbook", 3rd edition, 2018, chapter 8).
///
/// The scene's geometry is drawn once, with both targets and the depth; then the volumes are counted; then
/// one pass with that depth-stencil buffer (which may be read-only) and a third target:
/// [`render_ambient`](Self::render_ambient) copies the ambient light everywhere,
/// [`render_lit`](Self::render_lit) adds the rest where the count is 0. With several lights, each has its own
/// source and its own count, and `render_lit` is called for each.
#[derive(Debug)]
pub struct LightJoin {
    device: wgpu::Device,
    label: String,
    layout: wgpu::BindGroupLayout,
    ambient: wgpu::RenderPipeline,
    lit: wgpu::RenderPipeline,
    sample_count: u32,
    multiview: Multiview,
}

impl LightJoin {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// [`ScreenPassError`] if the device does not support a format or the sample count.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &LightJoinDescriptor<'_>,
    ) -> Result<Self, ScreenPassError> {
        check_target(
            device,
            descriptor.depth_stencil_format,
            descriptor.sample_count,
        )?;
        let multiview = Multiview(descriptor.multiview_mask);
        check_readable(device, multiview, descriptor.sample_count, "LightJoin")?;
        check_color(device, descriptor.color_format, descriptor.sample_count)?;
        let label = match descriptor.label {
            Some(name) => format!("shadows join {name}"),
            None => "shadows join".to_owned(),
        };
        let read = Read::of(descriptor.sample_count, multiview);
        let layout = read.layout(device, &label);
        let join = read.pick([JOIN, JOIN_SAMPLES, JOIN_LAYERS]);
        let make = |blend, on| {
            ScreenPipeline {
                label: &label,
                source: [SCREEN, join].join("\n"),
                fragment: "same",
                layout: &[Some(&layout)],
                target: Some(wgpu::ColorTargetState {
                    format: descriptor.color_format,
                    blend,
                    write_mask: wgpu::ColorWrites::ALL,
                }),
                depth_stencil_format: Some(descriptor.depth_stencil_format),
                sample_count: descriptor.sample_count,
                multiview,
                on,
            }
            .make(device)
        };
        let (ambient, lit) = (make(None, On::Everything), make(Some(ADD), On::Lit));
        Ok(Self {
            device: device.clone(),
            ambient,
            lit,
            layout,
            label,
            sample_count: descriptor.sample_count,
            multiview,
        })
    }

    /// Binds a picture of the target's size to read from, a view of one layer (with a multiview mask, of the
    /// dimension `D2Array`): any format that a shader reads as float, with the usage `TEXTURE_BINDING`.
    ///
    /// # Errors
    /// [`ScreenPassError::Source`] if it has another number of samples than the target,
    /// [`ScreenPassError::Unreadable`] if its format or usage does not fit, [`ScreenPassError::Layers`] if a
    /// view has no layer in it.
    pub fn bind(&self, source: &wgpu::TextureView) -> Result<wgpu::BindGroup, ScreenPassError> {
        let samples = source.texture().sample_count();
        if samples != self.sample_count {
            return Err(ScreenPassError::Source {
                found: samples,
                needed: self.sample_count,
            });
        }
        check_layers(source.texture(), self.multiview)?;
        let (format, usage) = (source.texture().format(), source.texture().usage());
        let read_as = format.sample_type(None, Some(self.device.features()));
        let is_float = matches!(read_as, Some(wgpu::TextureSampleType::Float { .. }));
        if !(is_float && usage.contains(wgpu::TextureUsages::TEXTURE_BINDING)) {
            return Err(ScreenPassError::Unreadable { format, usage });
        }
        Ok(bind(&self.device, &self.label, &self.layout, source))
    }

    /// Draws the source of [`bind`](Self::bind) over the whole target.
    pub fn render_ambient(&self, pass: &mut wgpu::RenderPass<'_>, source: &wgpu::BindGroup) {
        draw(pass, &self.ambient, source);
    }

    /// Adds the source of [`bind`](Self::bind) where the stencil count is 0; alpha is unchanged.
    pub fn render_lit(&self, pass: &mut wgpu::RenderPass<'_>, source: &wgpu::BindGroup) {
        draw(pass, &self.lit, source);
    }
}

/// Light adds up; alpha is that of the ambient picture.
const ADD: wgpu::BlendState = wgpu::BlendState {
    color: wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    },
    alpha: wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::Zero,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    },
};

fn draw(
    pass: &mut wgpu::RenderPass<'_>,
    pipeline: &wgpu::RenderPipeline,
    source: &wgpu::BindGroup,
) {
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, source, &[]);
    pass.set_stencil_reference(0);
    pass.draw(0..3, 0..1);
}

/// What [`Read::layout`] describes.
pub(crate) fn bind(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    source: &wgpu::TextureView,
) -> wgpu::BindGroup {
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(source),
        }],
    })
}

pub(crate) fn check_color(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    sample_count: u32,
) -> Result<(), ScreenPassError> {
    let blends = wgpu::TextureFormatFeatureFlags::BLENDABLE;
    match is_drawable(device, format, sample_count, blends) {
        true => Ok(()),
        false => Err(ScreenPassError::ColorFormat(format)),
    }
}

#[cfg(test)]
mod tests {
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    use super::*;
    use crate::volume::light_pass::{exact_count, mask};

    #[test]
    fn every_shader_is_valid() {
        let mask = crate::wgsl::MASK.to_owned();
        for (source, needed) in [
            (mask, Capabilities::empty()),
            ([SCREEN, JOIN].join("\n"), Capabilities::empty()),
            (
                [SCREEN, JOIN_SAMPLES].join("\n"),
                Capabilities::MULTISAMPLED_SHADING,
            ),
            ([SCREEN, JOIN_LAYERS].join("\n"), Capabilities::MULTIVIEW),
            (exact_count::source(Read::Plain), Capabilities::empty()),
            (exact_count::source(Read::Samples), Capabilities::empty()),
            (exact_count::source(Read::Layers), Capabilities::MULTIVIEW),
            (mask::counts_source(Read::Plain), Capabilities::empty()),
            (mask::counts_source(Read::Samples), Capabilities::empty()),
            (mask::counts_source(Read::Layers), Capabilities::MULTIVIEW),
        ] {
            let module = naga::front::wgsl::parse_str(&source).unwrap();
            Validator::new(ValidationFlags::all(), needed)
                .validate(&module)
                .unwrap();
        }
    }
}
