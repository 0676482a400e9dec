//! What blob shadows are told each frame.

use super::ellipsoid::Blob;
use crate::error::{BlobShadowError, LightError};
use crate::mesh::Caster;
use crate::{HomogeneousLight, View};

/// A light with a size, and how far its shadows are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlobLight {
    /// Where it is. A spot's cone is the host's.
    pub light: HomogeneousLight,
    /// Radius in world units of the disk that shines, which faces each receiver; of a directional light the
    /// tangent of its angular radius (the sun's is 0.0047). At least 0. One that is seen smaller than 1/4096 of its
    /// distance counts as that large: its penumbra is then hard for the eye, and there is a width to divide by.
    pub radius: f32,
    /// How far from a caster its shadow is seen, in world units, counted from a sphere around its ellipsoid;
    /// greater than 0. The shadow is whole up to three quarters of it, fades, and is gone at its end. Decals
    /// cover no more than this, so a short reach is a cheap one. More than 1e16 counts as that, which `f32` can
    /// still square and add up.
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
    /// [`BlobShadowError`] names what is wrong, of light 0.
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
    /// As many as [`BlobShadowDescriptor::lights`](crate::BlobShadowDescriptor::lights) at most. All blobs
    /// cast shadows from each.
    pub lights: &'a [BlobLight],
    /// The cameras that decals are drawn for, as many as
    /// [`BlobShadowDescriptor::views`](crate::BlobShadowDescriptor::views) at most.
    pub views: &'a [View],
    /// Casters, each of which becomes [`Blob::of_caster`]. Their layers and owners count for nothing here.
    pub casters: &'a [Caster],
    /// Ellipsoids besides, numbered after the casters.
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
