//! What the host is asked to draw itself.

use glam::Mat4;

/// One tile, and the casters on it that only the host can draw.
#[derive(Debug)]
#[non_exhaustive]
pub struct HostDraw<'a> {
    /// The light's index in the last frame; 0 for maps of one light.
    pub light: usize,
    /// The view's index, for a directional light of an atlas; otherwise 0.
    pub view: usize,
    /// The face of a point light, in the order of [`CubeFace::ALL`](crate::CubeFace::ALL), or the cascade of
    /// a directional light.
    pub tile: usize,
    /// World space to clip space. It maps to a left-handed space: triangles that are counter-clockwise seen
    /// from the light are clockwise on the tile.
    pub clip_from_world: Mat4,
    /// Texels along the tile's side.
    pub size: u32,
    /// The indices of the casters to draw, in the last frame's list.
    pub casters: &'a [usize],
}

/// Draws what only the host can.
pub(crate) type DrawByHost<'a> = &'a mut dyn FnMut(&mut wgpu::RenderPass<'_>, &HostDraw<'_>);
