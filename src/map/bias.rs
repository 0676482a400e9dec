//! Depth bias in texels of the map, so that one setting suits every scene.

use crate::error::BiasError;

/// How far a receiver is moved before it is compared with the map.
///
/// Every tap is compared with the depth of the receiver's own plane in that tap's direction (see
/// [`PcfSampler`](crate::PcfSampler)), so the bias does not depend on slope or kernel width. It covers three
/// things: rounding, the rasteriser's snapping of vertices to 1/256 of a texel (1/16 on SwiftShader;
/// docs/numerics.md states how much margin the defaults leave there), and the bend between neighbouring
/// triangles of a concave surface. The first two fields are in texels: one texel is `2 d / size` wide at a
/// distance `d` along the major axis. They work at any scene scale.
///
/// Far from the origin, f32 positions are coarser than texels. The fourth field covers that, in units in
/// the last place of the receiver's own coordinates; docs/numerics.md derives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bias {
    /// Distance along the geometric normal toward the light, in texels at the receiver, scaled by the sine of
    /// the angle between normal and light (no offset at normal incidence). Default 0.1. At least 0. A larger
    /// value hides acne on coarse concave meshes but leaks more light where a caster touches its receiver
    /// (Holbert, "Saying Goodbye to Shadow Acne", 2011).
    pub normal_offset: f32,
    /// Distance toward the light, in texels at the receiver. Default 0.05. At least 0.
    pub constant: f32,
    /// Slope-scaled bias of the rasteriser, away from the light, as a multiple of the change in a caster's
    /// depth from one texel to the next. Default 0: receivers are compared with their own plane, so casters
    /// need none. For hosts that sample the map with a comparison of their own. At least 0.
    pub slope_scale: f32,
    /// How far rounding may have moved a receiver along each axis, in ulps of that coordinate (2^-23 of it).
    /// Used only where it exceeds `normal_offset`. Default 4, which covers the host's transform, the
    /// interpolation of world positions and the caster's own rounding. At least 0. Light leaks under a caster
    /// by the same distance: 0.5 units for a wall at x = 1e6, 0.0005 at x = 1e3. With coordinates relative to
    /// a nearer origin ([`Caster::placed`](crate::Caster::placed)) there is no leak.
    pub position_ulps: f32,
}

impl Bias {
    /// No bias at all, for measuring the effect of the defaults. Shows acne.
    pub const NONE: Self = Self {
        normal_offset: 0.0,
        constant: 0.0,
        slope_scale: 0.0,
        position_ulps: 0.0,
    };

    /// `position_ulps` as a part of a coordinate.
    pub(super) fn rounding(&self) -> f32 {
        self.position_ulps * f32::EPSILON
    }

    /// Checks that every field is finite and at least 0.
    ///
    /// # Errors
    /// [`BiasError`] names the field.
    pub fn validate(&self) -> Result<(), BiasError> {
        for (field, value) in [
            ("normal_offset", self.normal_offset),
            ("constant", self.constant),
            ("slope_scale", self.slope_scale),
            ("position_ulps", self.position_ulps),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(BiasError { field, value });
            }
        }
        Ok(())
    }
}

impl Default for Bias {
    fn default() -> Self {
        Self {
            normal_offset: 0.1,
            constant: 0.05,
            slope_scale: 0.0,
            position_ulps: 4.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bad_field_is_named() {
        assert_eq!(Bias::default().validate(), Ok(()));
        assert_eq!(Bias::NONE.validate(), Ok(()));
        let constant = -1.0;
        let bias = Bias {
            constant,
            ..Bias::NONE
        };
        assert_eq!(bias.validate().unwrap_err().field, "constant");
        let bias = Bias {
            normal_offset: f32::NAN,
            ..Bias::NONE
        };
        assert_eq!(bias.validate().unwrap_err().field, "normal_offset");
    }
}
