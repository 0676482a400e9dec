//! Parameters of blob shadows.

use super::records::STRIDE;
use crate::error::BlobShadowError;
use crate::volume::light_pass::targets::is_drawable;

/// Strips of a light's disk, at most.
const MOST_STRIPS: u32 = 64;
/// Lights and views, at most, as uniform buffers of 64 KiB hold them.
pub(super) const MOST: u32 = 256;

/// Parameters of a [`BlobShadow`](crate::BlobShadow).
#[derive(Clone, Copy, Debug)]
pub struct BlobShadowDescriptor<'a> {
    /// Name of its GPU objects in debuggers, after "shadows blobs". Default none.
    pub label: Option<&'a str>,
    /// Maximum number of lights per frame: 1 (default) to 256. If `receivers` is true, 256 bytes for each
    /// must fit the device's `max_uniform_buffer_binding_size`: 64 lights in 16 KiB.
    pub lights: u32,
    /// Maximum number of views per frame: 1 (default) to 256. Only decals use views.
    pub views: u32,
    /// Number of strips into which a light's disk is divided to compute how much of it is covered: 1 to 64,
    /// default 6. The error in area falls with their number (see `docs/survey.md`); each costs a square root
    /// and two divisions per pixel and blob.
    pub strips: u32,
    /// How to draw decals; `None` (default) for no decals.
    pub decals: Option<BlobDecalDescriptor>,
    /// Whether the host's shaders read the blobs through
    /// [`BlobShadow::wgsl_module`](crate::BlobShadow::wgsl_module). Default true. Requires storage buffers, which
    /// WebGL 2 lacks.
    pub receivers: bool,
}

impl Default for BlobShadowDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            lights: 1,
            views: 1,
            strips: 6,
            decals: None,
            receivers: true,
        }
    }
}

/// The pass in which decals are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlobDecalDescriptor {
    /// Format of the pass's only colour target, whose red, green and blue are multiplied by the visibility;
    /// alpha is unchanged. Default `R8Unorm`: a mask that the host clears to 1 and reads when it adds the
    /// light. If the target is the picture itself, ambient light is darkened, too.
    pub target_format: wgpu::TextureFormat,
    /// Format of the pass's depth-stencil attachment, if it has one (default none). It is neither tested nor
    /// written, so it may be read-only, and may be the texture that decals read.
    pub depth_stencil_format: Option<wgpu::TextureFormat>,
}

impl Default for BlobDecalDescriptor {
    fn default() -> Self {
        Self {
            target_format: wgpu::TextureFormat::R8Unorm,
            depth_stencil_format: None,
        }
    }
}

impl BlobShadowDescriptor<'_> {
    pub(super) fn validate(&self, device: &wgpu::Device) -> Result<(), BlobShadowError> {
        let limits = device.limits();
        let held = |bytes: u64| (bytes / STRIDE).min(u64::from(MOST)) as u32;
        // Receivers read all lights in one binding, decals one of them.
        let bound = match self.receivers {
            true => limits.max_uniform_buffer_binding_size,
            false => limits.max_buffer_size,
        };
        for (what, value, limit) in [
            (
                "lights",
                self.lights,
                held(bound.min(limits.max_buffer_size)),
            ),
            ("views", self.views, held(limits.max_buffer_size)),
            ("strips", self.strips, MOST_STRIPS),
        ] {
            if !(1..=limit).contains(&value) {
                return Err(BlobShadowError::Range { what, value, limit });
            }
        }
        if self.receivers && limits.max_storage_buffers_per_shader_stage == 0 {
            return Err(BlobShadowError::NoStorage);
        }
        match &self.decals {
            Some(decals) => decals.validate(device),
            None => Ok(()),
        }
    }
}

impl BlobDecalDescriptor {
    fn validate(&self, device: &wgpu::Device) -> Result<(), BlobShadowError> {
        let features = device.features();
        let format = self.target_format;
        let blends = wgpu::TextureFormatFeatureFlags::BLENDABLE;
        if !is_drawable(device, format, 1, blends) {
            return Err(BlobShadowError::TargetFormat(format));
        }
        match self.depth_stencil_format {
            Some(format)
                if !format.is_depth_stencil_format()
                    || !features.contains(format.required_features()) =>
            {
                Err(BlobShadowError::DepthFormat(format))
            }
            _ => Ok(()),
        }
    }
}
