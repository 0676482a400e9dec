//! Parameters of a planar soft shadow.

use crate::error::PlanarSoftShadowError;

/// The most places of a light that a count of 8 bits tells apart.
pub(super) const MOST_SAMPLES: u32 = 255;

/// Parameters of a [`PlanarSoftShadow`](crate::PlanarSoftShadow).
#[derive(Clone, Copy, Debug)]
pub struct PlanarSoftShadowDescriptor<'a> {
    /// Name of its GPU objects in debuggers, after "shadows planar soft". Default `None`.
    pub label: Option<&'a str>,
    /// Texels along the rectangle's width and height. Default 512 each. 1 to the device's
    /// `max_texture_dimension_2d`. Memory: 2 bytes per texel.
    pub size: [u32; 2],
    /// Sample points on the light. Default 64. 1 to 255, all counted exactly in 8 bits. Both the cost and the number
    /// of shades in a penumbra grow with it.
    pub samples: u32,
    /// Whether the projection of each sample is shifted within a texel, so that edges sharper than a texel are
    /// antialiased. Default `true`.
    pub jitter: bool,
    /// Whether a texture whose content has not changed is left alone. Default `true`; `false` redraws it every
    /// frame, to measure the benefit.
    #[doc(hidden)]
    pub cache: bool,
}

impl Default for PlanarSoftShadowDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            size: [512; 2],
            samples: 64,
            jitter: true,
            cache: true,
        }
    }
}

impl PlanarSoftShadowDescriptor<'_> {
    pub(super) fn validate(&self, device: &wgpu::Device) -> Result<(), PlanarSoftShadowError> {
        let limit = device.limits().max_texture_dimension_2d;
        let size = self.size;
        if size.iter().any(|&texels| texels == 0 || texels > limit) {
            return Err(PlanarSoftShadowError::Size { size, limit });
        }
        match (1..=MOST_SAMPLES).contains(&self.samples) {
            true => Ok(()),
            false => Err(PlanarSoftShadowError::Samples {
                samples: self.samples,
                limit: MOST_SAMPLES,
            }),
        }
    }
}
