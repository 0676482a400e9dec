//! Which sides of casters a map shows.

use crate::scene::Record;

/// Which sides of casters are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CasterSides {
    /// The sides that face the light, where that shows the same as both: for closed meshes each of
    /// whose surfaces encloses a positive volume (found when the mesh is made; never for meshes in
    /// the host's own buffer), under any transform, if the light is outside the mesh's bounds. Both
    /// sides of all others. Takes about a third off the time of drawing.
    ///
    /// On outlines, where a near and a far side meet within a texel, depths may differ from
    /// [`Both`](Self::Both) by the depth of that texel. A surface that passes through itself and is
    /// inside out there casts from the far side of that part.
    #[default]
    Nearest,
    /// Both sides of every mesh.
    Both,
    /// Of closed meshes only the sides that look away from the light; meshes that are not closed
    /// keep both. It hides acne where receivers are compared without their plane, and lets light in
    /// where thin casters touch receivers. Closed meshes must be wound counter-clockwise seen from
    /// outside.
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
