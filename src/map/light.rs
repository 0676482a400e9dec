//! What receivers are told of a light.

use super::descriptor::quantum;
use crate::{Bias, PointLight};

/// Where a light's depths are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Depths {
    /// In this cube of the array (0 if each light has a texture of its own).
    Cube(i32),
    /// Nowhere: no caster is in range, so receivers in range are lit.
    NoCaster,
    /// Not drawn yet: receivers are unlit.
    NotYet,
}

/// `ShadowsCubeLight` in WGSL.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct LightUniform {
    pub position: [f32; 3],
    pub near: f32,
    pub range: f32,
    pub size: f32,
    pub normal_offset: f32,
    pub depth_scale: f32,
    pub quantum: f32,
    pub cube: i32,
    pub rounding: f32,
    pub centre: f32,
}

impl LightUniform {
    pub(super) fn new(
        light: &PointLight,
        near: f32,
        depths: Depths,
        size: u32,
        bias: &Bias,
        format: wgpu::TextureFormat,
    ) -> Self {
        let texel = 2.0 / size as f32;
        Self {
            position: light.position.to_array(),
            near,
            range: light.range,
            size: size as f32,
            normal_offset: bias.normal_offset * texel,
            depth_scale: 1.0 + bias.constant * texel,
            quantum: quantum(format).unwrap_or(0.0),
            cube: match depths {
                Depths::Cube(index) => index,
                Depths::NoCaster => -1,
                Depths::NotYet => -2,
            },
            rounding: bias.rounding(),
            centre: if size.is_multiple_of(2) { 0.5 } else { 0.0 },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::LightUniform;
    use crate::wgsl_layout::assert_layout;

    #[test]
    fn the_light_lies_in_memory_as_wgsl_has_it() {
        let text = include_str!("../../shaders/cube_light.wgsl");
        assert_layout!(
            text,
            "ShadowsCubeLight",
            LightUniform,
            position,
            near,
            range,
            size,
            normal_offset,
            depth_scale,
            quantum,
            cube,
            rounding,
            centre
        );
    }
}
