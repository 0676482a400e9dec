//! How planar shadows fit into the host's passes.

use crate::DepthConvention;
use crate::error::PlanarShadowError;
use crate::volume::light_pass::targets::{DEPTH_STENCIL, bytes_a_sample, has_stencil, is_drawable};

/// What is done where there is shadow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PlanarOutput {
    /// [`shadow_bit`](PlanarShadowDescriptor::shadow_bit) of the stencil is set, for the host's light pass to be
    /// drawn where it is not ([`PlanarShadow::light_pass_stencil`](crate::PlanarShadow::light_pass_stencil)).
    #[default]
    Stencil,
    /// The same, and the host's colours are multiplied by the light's
    /// [`shade`](crate::PlanarLight::shade): for hosts that light everything in one pass. Where a spot's cone or a
    /// light's range does not reach, nothing is darkened.
    Darken {
        /// Which of [`color_formats`](PlanarShadowDescriptor::color_formats). Its alpha is left as it is.
        target: usize,
    },
}

/// How a [`PlanarShadow`](crate::PlanarShadow) fits into the host's passes.
#[derive(Clone, Copy, Debug)]
pub struct PlanarShadowDescriptor<'a> {
    /// Names its GPU objects, after "shadows planar". Default `None`.
    pub label: Option<&'a str>,
    /// Format of the passes' depth-stencil attachment: `Depth32FloatStencil8` (default) or
    /// `Depth24PlusStencil8`; see [`Support::depth_stencil_format`](crate::Support::depth_stencil_format).
    pub depth_stencil_format: wgpu::TextureFormat,
    /// Samples per pixel of the passes, 1 (default) or 4. Each sample is in shadow or not by itself.
    pub sample_count: u32,
    /// How the host's projection maps depth. Default [`DepthConvention::InfiniteReverse`].
    pub depth: DepthConvention,
    /// Formats of the passes' colour attachments. Default none.
    pub color_formats: &'a [Option<wgpu::TextureFormat>],
    /// What is done where there is shadow. Default [`PlanarOutput::Stencil`].
    pub output: PlanarOutput,
    /// The stencil's bit that is set where there is shadow: one, and 0 when a pass begins. Default `0x80`.
    pub shadow_bit: u8,
    /// The stencil's bit in which polygons are marked while they are drawn: one, and 0 when a pass begins; it is
    /// 0 again after each. Default `0x40`.
    pub outline_bit: u8,
    /// The stencil's bits in which the host may mark receivers
    /// ([`PlanarOutline::Stencil`](crate::PlanarOutline::Stencil)); they are only read. Default `0x3f`.
    pub receiver_bits: u8,
    /// How far the depth of the host's receivers may be off that of a polygon's plane, in pixels: by how much
    /// depth changes from one pixel to the next, times this. Default 1/16. Rasterisers take depth from corners
    /// that are moved to a grid, on GPUs of 1/256 of a pixel. At 0, and `bias_ulps` 0, there is z-fighting.
    pub bias_pixels: f32,
    /// The same in units of depth's last place, where the plane faces the camera and depth does not change. Default
    /// 16: more than rounding takes near the origin. Far from it, count positions from a point near the
    /// camera ([`View::placed`](crate::View::placed)), or raise this.
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
