//! The input of blob shadows for each frame.

use super::ellipsoid::Blob;
use crate::error::{BlobShadowError, LightError};
use crate::mesh::Caster;
use crate::{HomogeneousLight, View};

/// A light with a size, and the reach of its shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlobLight {
    /// The light. Applying a spot's cone is up to the host.
    pub light: HomogeneousLight,
    /// Radius of the luminous disk in world units, which faces each receiver; for a directional light, the tangent
    /// of its angular radius (0.0047 for the sun). At least 0. A radius below 1/4096 of the light's distance is
    /// treated as that size, which looks hard and avoids a division by zero.
    pub radius: f32,
    /// How far a caster's shadow extends, in world units, measured from a sphere around its ellipsoid; greater
    /// than 0. The shadow has full strength up to three quarters of this distance, then fades to nothing at its
    /// end. Decals cover no more than this, so a short reach is cheap. Values above 1e16 are treated as 1e16,
    /// which `f32` can still square and add up.
    pub reach: f32,
}

impl BlobLight {
    /// A light; `radius` and `reach` in world units.
    pub fn new(light: impl Into<HomogeneousLight>, radius: f32, reach: f32) -> Self {
        Self {
            light: light.into(),
            radius,
            reach,
        }
    }

    /// Checks that its numbers are in range.
    ///
    /// # Errors
    /// [`BlobShadowError`] names what is wrong, as that of light 0.
    pub fn validate(&self) -> Result<(), BlobShadowError> {
        self.validate_as(0)
    }

    fn validate_as(&self, index: usize) -> Result<(), BlobShadowError> {
        let light = |error: LightError| BlobShadowError::Light { index, error };
        self.light.validate().map_err(light)?;
        if !(self.radius.is_finite() && self.radius >= 0.0) {
            let radius = self.radius;
            return Err(BlobShadowError::Radius { index, radius });
        }
        if !(self.reach.is_normal() && self.reach > 0.0) {
            let reach = self.reach;
            return Err(BlobShadowError::Reach { index, reach });
        }
        Ok(())
    }
}

/// One frame of a [`BlobShadow`](crate::BlobShadow).
#[derive(Clone, Copy, Debug, Default)]
pub struct BlobFrame<'a> {
    /// At most [`BlobShadowDescriptor::lights`](crate::BlobShadowDescriptor::lights). All blobs cast shadows
    /// from each of them.
    pub lights: &'a [BlobLight],
    /// The cameras that decals are drawn for, at most
    /// [`BlobShadowDescriptor::views`](crate::BlobShadowDescriptor::views).
    pub views: &'a [View],
    /// Casters, each of which becomes [`Blob::of_caster`]. Their layers and owners are ignored.
    pub casters: &'a [Caster],
    /// Additional ellipsoids, numbered after the casters.
    pub blobs: &'a [Blob],
}

impl BlobFrame<'_> {
    pub(super) fn len(&self) -> usize {
        self.casters.len() + self.blobs.len()
    }

    /// Checks all but the casters.
    pub(super) fn validate(&self, [lights, views]: [u32; 2]) -> Result<(), BlobShadowError> {
        for (what, count, limit) in [
            ("lights", self.lights.len(), lights),
            ("views", self.views.len(), views),
        ] {
            if count > limit as usize {
                return Err(BlobShadowError::TooMany { what, count, limit });
            }
        }
        for (index, light) in self.lights.iter().enumerate() {
            light.validate_as(index)?;
        }
        for (index, blob) in self.blobs.iter().enumerate() {
            if !blob.is_finite() {
                return Err(BlobShadowError::Blob { index });
            }
            let opacity = blob.opacity;
            if !(0.0..=1.0).contains(&opacity) {
                return Err(BlobShadowError::Opacity { index, opacity });
            }
        }
        Ok(())
    }
}
