//! Combining ambient and direct light from two targets in a full-screen pass.

use crate::error::ScreenPassError;
use crate::volume::light_pass::mask::{check_readable_samples, check_target};
use crate::volume::light_pass::screen::{On, SCREEN, ScreenPipeline};
use crate::volume::light_pass::targets::{DEPTH_STENCIL, is_drawable};

const JOIN: &str = include_str!("../../../shaders/volume_join.wgsl");
const JOIN_SAMPLES: &str = include_str!("../../../shaders/volume_join_samples.wgsl");

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
}

impl Default for LightJoinDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            color_format: wgpu::TextureFormat::Rgba8Unorm,
            depth_stencil_format: DEPTH_STENCIL,
            sample_count: 1,
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
        check_readable_samples(device, descriptor.sample_count, "LightJoin")?;
        check_color(device, descriptor.color_format, descriptor.sample_count)?;
        let label = match descriptor.label {
            Some(name) => format!("shadows join {name}"),
            None => "shadows join".to_owned(),
        };
        let multisampled = descriptor.sample_count > 1;
        let layout = layout(device, &label, multisampled);
        let join = if multisampled { JOIN_SAMPLES } else { JOIN };
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
        })
    }

    /// Binds a picture of the target's size as a source: a view of one layer, in any format that a shader
    /// reads as float, with the usage `TEXTURE_BINDING`.
    ///
    /// # Errors
    /// [`ScreenPassError::Source`] if it has another number of samples than the target,
    /// [`ScreenPassError::Unreadable`] if its format or usage is unsuitable.
    pub fn bind(&self, source: &wgpu::TextureView) -> Result<wgpu::BindGroup, ScreenPassError> {
        let samples = source.texture().sample_count();
        if samples != self.sample_count {
            return Err(ScreenPassError::Source {
                found: samples,
                needed: self.sample_count,
            });
        }
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

/// Binds one picture, of one sample a pixel or several.
pub(crate) fn layout(
    device: &wgpu::Device,
    label: &str,
    multisampled: bool,
) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: false },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled,
            },
            count: None,
        }],
    })
}

/// What [`layout`] describes.
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
            (
                crate::volume::light_pass::exact_count::source(false),
                Capabilities::empty(),
            ),
            (
                crate::volume::light_pass::exact_count::source(true),
                Capabilities::empty(),
            ),
            (
                crate::volume::light_pass::mask::counts_source(false),
                Capabilities::empty(),
            ),
            (
                crate::volume::light_pass::mask::counts_source(true),
                Capabilities::empty(),
            ),
        ] {
            let module = naga::front::wgsl::parse_str(&source).unwrap();
            Validator::new(ValidationFlags::all(), needed)
                .validate(&module)
                .unwrap();
        }
    }
}
