//! What blob shadows are made from.

use super::records::STRIDE;
use crate::error::BlobShadowError;
use crate::volume::light_pass::targets::is_drawable;

/// Strips of a light's disk, at most.
const MOST_STRIPS: u32 = 64;
/// Lights and views, at most, as uniform buffers of 64 KiB hold them.
pub(super) const MOST: u32 = 256;

/// How to make a [`BlobShadow`](crate::BlobShadow).
#[derive(Clone, Copy, Debug)]
pub struct BlobShadowDescriptor<'a> {
    /// Names the GPU objects, after "shadows blobs". Default none.
    pub label: Option<&'a str>,
    /// Lights of a frame, at most: 1 (default) to 256, and to what the device's
    /// `max_uniform_buffer_binding_size` holds of 256 bytes each where `receivers` is true: 64 in 16 KiB.
    pub lights: u32,
    /// Views of a frame, at most: 1 (default) to 256. Only decals are drawn for a view.
    pub views: u32,
    /// Strips into which a light's disk is divided to find how much of it is covered: 1 to 64, default 6.
    /// The error of the area falls with their number (`docs/survey.md` has it), and each costs a square root
    /// and two divisions a pixel and blob.
    pub strips: u32,
    /// How decals are drawn; `None` (default) if they are not.
    pub decals: Option<BlobDecalDescriptor>,
    /// Whether the host's shaders read the blobs, by [`BlobShadow::wgsl_module`](crate::BlobShadow::wgsl_module).
    /// Default true. It takes storage buffers, which WebGL 2 has not.
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
    /// Format of the pass's only colour target, which is multiplied with the visibility in its red, green and
    /// blue; alpha stays as it is. Default `R8Unorm`: a mask that the host clears to 1 and reads where it adds
    /// the light. Where the picture itself is the target, ambient light darkens, too.
    pub target_format: wgpu::TextureFormat,
    /// Format of the pass's depth-stencil attachment, if it has one (default none). It is neither tested nor
    /// written, so it may be read-only and the texture that is read.
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
