//! How to make a planar soft shadow.

use crate::error::PlanarSoftShadowError;

/// The most places of a light that a count of 8 bits tells apart.
pub(super) const MOST_SAMPLES: u32 = 255;

/// How to make a [`PlanarSoftShadow`](crate::PlanarSoftShadow).
#[derive(Clone, Copy, Debug)]
pub struct PlanarSoftShadowDescriptor<'a> {
    /// Names its GPU objects, after "shadows planar soft". Default `None`.
    pub label: Option<&'a str>,
    /// Texels along the rectangle's width and height. Default 512 each. 1 to the device's
    /// `max_texture_dimension_2d`. Memory: 2 bytes a texel.
    pub size: [u32; 2],
    /// Places of the light that shadows are cast from. Default 64. 1 to 255, exact whatever the number: each adds one
    /// step of 8 bits. Cost and steps between light and shadow grow with it.
    pub samples: u32,
    /// Whether each place's projection is moved within a texel, so that edges that are sharper than a texel are
    /// smoothed over it. Default `true`.
    pub jitter: bool,
    /// Whether a texture whose content has not changed is left alone. Default `true`; `false` draws every frame, for
    /// measuring what that is worth.
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
