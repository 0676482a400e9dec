//! Which sides of casters are drawn into maps.

use crate::scene::Record;

/// Which sides of casters are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CasterSides {
    /// Only the sides that face the light, where the result is the same as with both: for closed meshes each
    /// of whose surfaces encloses a positive volume (determined when the mesh is created; never for meshes in
    /// the host's own buffer), under any transform, as long as the light is outside the mesh's bounds. Both
    /// sides of all other meshes. Saves about a third of the drawing time.
    ///
    /// On outlines, where a near and a far side meet within a texel, depths may differ from
    /// [`Both`](Self::Both) by the depth of that texel. Where a surface passes through itself and is inside
    /// out, its far side casts.
    #[default]
    Nearest,
    /// Both sides of every mesh.
    Both,
    /// Only the sides of closed meshes that face away from the light; both sides of meshes that are not
    /// closed. Hides acne where receivers are compared without their plane, but leaks light where thin
    /// casters touch receivers. Closed meshes must be wound counter-clockwise seen from outside.
    Far,
}

/// Which triangles of a caster the rasteriser drops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Cull {
    None,
    Front,
    Back,
}

impl Cull {
    /// `clear`: whether the light is outside the caster's bounds and the near plane does not cut them.
    pub fn of(sides: CasterSides, record: &Record, clear: impl FnOnce() -> bool) -> Self {
        let (far, wound) = match sides {
            CasterSides::Both => return Self::None,
            CasterSides::Nearest => (false, record.solid),
            CasterSides::Far => (true, record.closed),
        };
        // Where it is not clear the light may be inside, or the near plane cut the nearest side.
        if !wound || !far && !clear() {
            return Self::None;
        }
        // The faces' frames are left-handed: what is counter-clockwise seen from the light is
        // clockwise (a back face) on the map, unless the transform mirrors it once more.
        match far == record.mirrored {
            true => Self::Front,
            false => Self::Back,
        }
    }

    pub fn face(self) -> Option<wgpu::Face> {
        match self {
            Self::None => None,
            Self::Front => Some(wgpu::Face::Front),
            Self::Back => Some(wgpu::Face::Back),
        }
    }
}
