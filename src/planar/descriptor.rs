//! Parameters of planar shadows.

use crate::DepthConvention;
use crate::error::PlanarShadowError;
use crate::volume::light_pass::targets::{DEPTH_STENCIL, bytes_a_sample, has_stencil, is_drawable};

/// What happens in shadow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PlanarOutput {
    /// [`shadow_bit`](PlanarShadowDescriptor::shadow_bit) is set in the stencil buffer; the host draws its light
    /// pass where it is not set ([`PlanarShadow::light_pass_stencil`](crate::PlanarShadow::light_pass_stencil)).
    #[default]
    Stencil,
    /// The same, and the host's colours are multiplied by the light's [`shade`](crate::PlanarLight::shade): for
    /// hosts that light everything in one pass. Nothing is darkened outside a spot's cone or a light's range.
    Darken {
        /// Which of [`color_formats`](PlanarShadowDescriptor::color_formats). Its alpha is left as it is.
        target: usize,
    },
}

/// Parameters of a [`PlanarShadow`](crate::PlanarShadow), which must match the host's passes.
#[derive(Clone, Copy, Debug)]
pub struct PlanarShadowDescriptor<'a> {
    /// Name of its GPU objects in debuggers, after "shadows planar". Default `None`.
    pub label: Option<&'a str>,
    /// Format of the passes' depth-stencil attachment: `Depth32FloatStencil8` (default) or
    /// `Depth24PlusStencil8`; see [`Support::depth_stencil_format`](crate::Support::depth_stencil_format).
    pub depth_stencil_format: wgpu::TextureFormat,
    /// Samples per pixel of the passes, 1 (default) or 4. Shadow is determined for each sample.
    pub sample_count: u32,
    /// How the host's projection maps depth. Default [`DepthConvention::InfiniteReverse`].
    pub depth: DepthConvention,
    /// Formats of the passes' colour attachments. Default none.
    pub color_formats: &'a [Option<wgpu::TextureFormat>],
    /// What happens in shadow. Default [`PlanarOutput::Stencil`].
    pub output: PlanarOutput,
    /// The stencil bit that is set in shadow: a single bit, which must be 0 when a pass begins. Default
    /// `0x80`.
    pub shadow_bit: u8,
    /// The stencil bit that marks polygons while they are drawn: a single bit, which must be 0 when a pass
    /// begins and is 0 again after each polygon. Default `0x40`.
    pub outline_bit: u8,
    /// The stencil bits in which the host may mark receivers
    /// ([`PlanarOutline::Stencil`](crate::PlanarOutline::Stencil)); they are only read. Default `0x3f`.
    pub receiver_bits: u8,
    /// How far the depth of the host's receivers may differ from that of a polygon's plane, as a multiple of
    /// the change in depth from one pixel to the next. Default 1/16. Rasterisers snap vertices to a grid, on
    /// GPUs of 1/256 of a pixel, which changes depth. If this and `bias_ulps` are 0, there is z-fighting.
    pub bias_pixels: f32,
    /// The same in ulps of the depth, for planes that face the camera, whose depth does not change. Default 16:
    /// more than the rounding error near the origin. Far from it, use positions relative to a point near the camera
    /// ([`View::placed`](crate::View::placed)), or raise this.
    pub bias_ulps: f32,
}

impl Default for PlanarShadowDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            depth_stencil_format: DEPTH_STENCIL,
            sample_count: 1,
            depth: DepthConvention::default(),
            color_formats: &[],
            output: PlanarOutput::default(),
            shadow_bit: 0x80,
            outline_bit: 0x40,
            receiver_bits: 0x3f,
            bias_pixels: 1.0 / 16.0,
            bias_ulps: 16.0,
        }
    }
}

impl PlanarShadowDescriptor<'_> {
    pub(super) fn validate(&self, device: &wgpu::Device) -> Result<(), PlanarShadowError> {
        let format = self.depth_stencil_format;
        if !has_stencil(format) {
            return Err(PlanarShadowError::Format(format));
        }
        if !device.features().contains(format.required_features()) {
            return Err(PlanarShadowError::FormatFeature(format));
        }
        if !matches!(self.sample_count, 1 | 4) {
            return Err(PlanarShadowError::SampleCount(self.sample_count));
        }
        self.validate_colors(device)?;
        let (shadow, outline, receivers) = (self.shadow_bit, self.outline_bit, self.receiver_bits);
        let single = |bits: u8| bits.count_ones() == 1;
        let shared = shadow & outline | (shadow | outline) & receivers;
        if !single(shadow) || !single(outline) || shared != 0 {
            return Err(PlanarShadowError::Bits {
                shadow,
                outline,
                receivers,
            });
        }
        let biases = [
            ("bias_pixels", self.bias_pixels),
            ("bias_ulps", self.bias_ulps),
        ];
        match biases
            .into_iter()
            .find(|(_, value)| !(value.is_finite() && *value >= 0.0))
        {
            Some((field, value)) => Err(PlanarShadowError::Bias { field, value }),
            None => Ok(()),
        }
    }

    fn validate_colors(&self, device: &wgpu::Device) -> Result<(), PlanarShadowError> {
        let drawable = |format, also| is_drawable(device, format, self.sample_count, also);
        for (place, format) in self.color_formats.iter().enumerate() {
            let Some(format) = *format else { continue };
            if !drawable(format, wgpu::TextureFormatFeatureFlags::empty()) {
                return Err(PlanarShadowError::ColorFormat { place, format });
            }
        }
        let limits = device.limits();
        let bytes = bytes_a_sample(self.color_formats.iter().copied().flatten());
        for (name, needed, available) in [
            (
                "max_color_attachments",
                self.color_formats.len() as u64,
                limits.max_color_attachments,
            ),
            (
                "max_color_attachment_bytes_per_sample",
                u64::from(bytes),
                limits.max_color_attachment_bytes_per_sample,
            ),
        ] {
            let available = u64::from(available);
            if needed > available {
                return Err(PlanarShadowError::ColorLimit {
                    name,
                    needed,
                    available,
                });
            }
        }
        let PlanarOutput::Darken { target } = self.output else {
            return Ok(());
        };
        let found = self.color_formats.get(target).copied().flatten();
        let blends = |format| drawable(format, wgpu::TextureFormatFeatureFlags::BLENDABLE);
        match found.is_some_and(blends) {
            true => Ok(()),
            false => Err(PlanarShadowError::Target { target, found }),
        }
    }
}
