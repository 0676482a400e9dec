//! The matrices of tiles, for the shader that draws casters.

/// `ShadowsCubeFaceUniform` in WGSL.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct TileUniform {
    clip_from_light: [f32; 16],
    range: f32,
    /// Of the map's side, where that is 2 wide.
    texel: f32,
    padding: [f32; 2],
}

impl TileUniform {
    /// `size`: texels along a side of the map.
    pub fn new(clip_from_light: &glam::Mat4, range: f32, size: u32) -> Self {
        Self {
            clip_from_light: clip_from_light.to_cols_array(),
            range,
            texel: 2.0 / size as f32,
            padding: [0.0; 2],
        }
    }
}
