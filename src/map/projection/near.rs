//! Where the shadow map of a light with a position begins, unless the host says where.

use crate::map::encoding::{DepthEncoding, quantum};
use crate::{PointLight, SpotLight};

/// A light's near plane for one kind of texels, as a share of the light's range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NearPlane {
    share: f32,
}

impl NearPlane {
    /// Half the relative step of `f32`. In a scene as large as the range positions are rounded by as
    /// much, so nothing nearer can be told from the light itself.
    ///
    /// It costs no precision. Depth is `near / d`: another power of two for `near` changes the
    /// exponents of all depths and not one digit. The least depth, at the range, is 2^-24, and floats
    /// keep all their digits down to 2^-126.
    const OF_FLOATS: f32 = f32::EPSILON * 0.5;

    pub fn new(format: wgpu::TextureFormat, encoding: DepthEncoding) -> Self {
        Self::of_step(match encoding {
            // Written by the fragment shader: the near plane only clips.
            DepthEncoding::LinearDistance => 0.0,
            DepthEncoding::MajorAxis => quantum(format).unwrap_or(0.0),
        })
    }

    /// One step of depth is `range * step / share` wide at the range. With a share of the square root
    /// of the step that is as far as the near plane is from the light.
    fn of_step(step: f32) -> Self {
        Self {
            share: step.sqrt().max(Self::OF_FLOATS),
        }
    }

    pub fn of_point(self, light: &PointLight) -> f32 {
        self.resolve(light.near, light.range)
    }

    pub fn of_spot(self, light: &SpotLight) -> f32 {
        self.resolve(light.near, light.range)
    }

    /// GPUs may take what is smaller than the least normal number for 0.
    fn resolve(self, near: Option<f32>, range: f32) -> f32 {
        near.unwrap_or_else(|| (range * self.share).max(f32::MIN_POSITIVE))
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    const FORMATS: [wgpu::TextureFormat; 3] = [
        wgpu::TextureFormat::Depth32Float,
        wgpu::TextureFormat::Depth24Plus,
        wgpu::TextureFormat::Depth16Unorm,
    ];

    fn share(format: wgpu::TextureFormat) -> NearPlane {
        NearPlane::of_step(quantum(format).unwrap())
    }

    #[test]
    fn fixed_point_formats_lose_as_much_near_the_light_as_at_its_end() {
        let expected = [2.0_f32.powi(-24), 1.0 / 4096.0, 1.0 / 256.0];
        for (format, expected) in FORMATS.into_iter().zip(expected) {
            let near = share(format).of_point(&PointLight::new(Vec3::ZERO, 10.0));
            assert!((near / (10.0 * expected) - 1.0).abs() < 2e-3, "{near}");
            let step = 10.0 * 10.0 * quantum(format).unwrap() / near;
            assert!(step == 0.0 || (step / near - 1.0).abs() < 1e-5, "{step}");
        }
    }

    #[test]
    fn floats_tell_depths_apart_as_well_as_with_any_other_near_plane() {
        let light = PointLight::new(Vec3::ZERO, 37.3);
        let tiny = share(FORMATS[0]).of_point(&light);
        let mut distance = 1e-5_f32;
        while distance < light.range {
            let apart = |near: f32, by: f32| near / (distance * (1.0 + by)) != near / distance;
            // A power of two, so that not a digit may differ.
            let large = tiny * 2.0_f32.powi(24);
            for ulps in 1..4 {
                let by = ulps as f32 * f32::EPSILON;
                assert_eq!(apart(tiny, by), apart(large, by), "{distance}");
            }
            assert!((tiny / distance).is_normal());
            // The broken twin: so small that the far end has hardly any digits.
            let too_small = f32::MIN_POSITIVE * 8.0;
            assert!(distance < 9.0 || !(too_small / distance).is_normal());
            distance *= 1.37;
        }
    }

    #[test]
    fn no_range_that_is_a_normal_number_makes_a_near_plane_that_is_none() {
        for range in [f32::MIN_POSITIVE, 1e-37, 1e-30, 1.0, f32::MAX] {
            for format in FORMATS {
                let light = PointLight::new(Vec3::ZERO, range);
                assert_eq!(light.validate(), Ok(()));
                let near = share(format).of_point(&light);
                assert!(near.is_normal() && near <= range, "{range} {format:?}");
            }
        }
        assert!(!(f32::MIN_POSITIVE * NearPlane::OF_FLOATS).is_normal());
    }
}
