//! Where volumes start.
//!
//! The shadow of a closed mesh is cast by its light-facing triangles; or as well by those turned
//! away, for whoever stands outside the mesh and looks to a light outside sees as many of one kind
//! as of the other (see `facing.rs`). The two volumes differ inside the mesh alone. The chain that
//! starts at the far side is the sum of the triangles turned away, each turned over: a light cap
//! like any other, and everything else of a volume follows from it.
//!
//! What they make of the mesh's own surface differs. A point of a light-facing triangle of a convex
//! mesh lies in no volume either way. A point P of a triangle turned away lies in the volume of the
//! light-facing ones, and *on* the cap of the others: whether that cap counts as before or behind P
//! is for the draw to say, and it says before, so that P is lit, and what becomes of it is decided by
//! the host's shading alone.
//!
//! So faces that the viewer sees from inside the volume and faces seen from outside are set off in
//! opposite directions:
//! - of caps, those seen from inside the volume (so from outside the mesh: P's own) go toward the
//!   viewer, those seen from outside it (across the mesh, behind its visible surface) away;
//! - of sides, those seen from outside the volume go toward the viewer, too: where a triangle turned
//!   away all but holds the light in its plane, the side along its edge has its depth, and must stay
//!   before the cap. Those seen from inside go away, as all do where volumes start at the light side.
//!
//! z-pass then needs the caps that are seen from inside, for they lie before P.

/// Which side of a closed caster its shadow volume starts from.
///
/// With smooth normals over coarse triangles, shading ends somewhere within the triangles facing away from
/// the light, or within those facing it, but the caster's own shadow begins exactly where the two kinds meet,
/// along a ragged line of edges. [`AwayFacing`](Self::AwayFacing) leaves the terminator to shading alone.
/// `docs/volume-start.png` in the repository shows both, drawn by
/// `cargo run --release --example volume_debug -- --start docs/volume-start.png`.
///
/// Shadows on anything but the caster itself are the same, except for single pixels on their edges and where
/// the caster touches another surface, which depend on rasterisation (at most 2 of 65,536 in the pictures
/// measured).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum StartFrom {
    /// From the triangles facing the light: those facing away are in shadow. Correct for any host.
    #[default]
    LightFacing,
    /// From the triangles facing away from the light: a convex caster casts no shadow on itself, and any
    /// other only where another part of it lies between a point and the light.
    ///
    /// For hosts whose shading is dark where the *shading* normal faces away from the light
    /// (`max(dot(n, l), 0)`); others would see light on the far side.
    ///
    /// Applies to closed meshes wound counter-clockwise seen from outside (which is assumed for positions in
    /// the host's own buffer), while light and near rectangle are outside the caster's box. All others,
    /// including meshes with a cavity, start as with `LightFacing` and keep the ragged line;
    /// [`VolumeStatistics::casters_away_facing`](crate::VolumeStatistics::casters_away_facing) says how many
    /// of the drawn casters start as requested. Vertices at the same position must be welded (as
    /// [`Adjacency`](crate::mesh::Adjacency) does).
    ///
    /// Costs one more draw for the sides of each caster, with half of the faces culled in each of the two,
    /// and the light caps in z-pass. A host surface that lies on the far side of a caster, nearer to it than
    /// [`cap_bias_ulps`](crate::ShadowVolumeDescriptor::cap_bias_ulps) (such as a decal), is lit like the
    /// caster itself.
    AwayFacing,
}
