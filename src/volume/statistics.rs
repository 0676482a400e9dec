//! Statistics of shadow volumes, for each caster and in total.

use crate::volume::decide::method::{Count, Skip};

/// The decision of a renderer for one caster under one light in one view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CasterState {
    /// Drawn, with its volume counted in front of the visible surfaces.
    ZPass,
    /// Drawn, with its volume counted behind the visible surfaces.
    ZFail,
    /// Left out: its mesh has no triangles.
    Empty,
    /// Left out: it is on none of the light's layers, or has the same owner as the light.
    Masked,
    /// Left out: after its transform, the light sees no area of it. It is flattened to a line or a point, or
    /// to a plane that contains the light.
    EdgeOn,
    /// Left out: it is beyond the light's range, or beside its cone.
    OutOfRange,
    /// Left out: nothing that it could shadow is in view.
    OutOfView,
}

impl From<Count> for CasterState {
    fn from(count: Count) -> Self {
        match count {
            Count::Pass => Self::ZPass,
            Count::Fail => Self::ZFail,
        }
    }
}

impl From<Skip> for CasterState {
    fn from(skip: Skip) -> Self {
        match skip {
            Skip::Empty => Self::Empty,
            Skip::Masked => Self::Masked,
            Skip::EdgeOn => Self::EdgeOn,
            Skip::OutOfRange => Self::OutOfRange,
            Skip::OutOfView => Self::OutOfView,
        }
    }
}

/// The result of the last [`prepare`](crate::ShadowVolumeRenderer::prepare). Casters are summed over all
/// lights and views: one that two lights shine on is counted twice. Views that a pass draws together
/// ([`multiview_mask`](crate::ShadowVolumeDescriptor::multiview_mask)) are one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct VolumeStatistics {
    /// Casters whose volumes are drawn.
    pub casters_drawn: u32,
    /// The subset counted in front of the visible surfaces.
    pub casters_z_pass: u32,
    /// The subset counted behind the visible surfaces.
    pub casters_z_fail: u32,
    /// The subset whose volumes start from the triangles facing away from the light, as requested by
    /// [`StartFrom::AwayFacing`](crate::StartFrom::AwayFacing); otherwise 0.
    pub casters_away_facing: u32,
    /// Casters left out, for any of the next five reasons.
    pub casters_skipped: u32,
    /// Casters left out because their meshes have no triangles.
    pub skipped_empty: u32,
    /// Casters left out because the light does not cast their shadows
    /// ([`VolumeLight::layers`](crate::VolumeLight::layers), [`owner`](crate::VolumeLight::owner)).
    pub skipped_masked: u32,
    /// Casters left out because after their transforms, the light sees no area of them: those of scale 0 on
    /// two or three axes, and those flattened to a plane that contains the light. (A caster flattened to any
    /// other plane casts the shadow of its flat shape.)
    pub skipped_edge_on: u32,
    /// Casters left out because they are beyond the light's range, or beside its cone.
    pub skipped_out_of_range: u32,
    /// Casters left out because nothing they could shadow is in view, or among the receivers.
    pub skipped_out_of_view: u32,
    /// Draw calls that `render` records. Up to 256 casters under one light in one view share one for each
    /// kind of faces that they have: sides and caps, counted in front of or behind what is visible. Drawn
    /// individually are caps of meshes with 1,024 triangles or more, casters over different host buffers
    /// ([`CasterMesh::from_host_positions`](crate::CasterMesh::from_host_positions)), and all casters if
    /// vertex shaders find the silhouettes ([`Silhouettes::Vertex`](crate::Silhouettes::Vertex)).
    pub draws: u32,
    /// Silhouettes that were extracted in this frame. Those of the other drawn casters were kept from the
    /// previous frame, or are shared: casters of one mesh that the light meets in the same way (with a sun,
    /// all of the same orientation) share theirs.
    pub casters_extracted: u32,
    /// Dispatches that `encode` records: two in which compute shaders find silhouettes and one that builds
    /// the draws which casters share, regardless of the number of lights and meshes. One more for each host
    /// buffer of positions ([`CasterMesh::from_host_positions`](crate::CasterMesh::from_host_positions)), and
    /// more if volumes or meshes are too large for one buffer.
    pub dispatches: u32,
    /// Bytes that `encode` copies into the renderer's buffers; 0 if nothing has changed.
    pub uploaded: u64,
    /// Bytes of GPU memory that the renderer holds, without those of the meshes.
    pub gpu_bytes: u64,
    /// Triangles of all casters drawn.
    pub triangles: u64,
    /// Whether the previous frame was never encoded, so that its preparation was wasted.
    pub not_encoded: bool,
    /// Whether the encoder of an earlier frame was dropped, so that everything had to be extracted again.
    pub encoder_dropped: bool,
}

/// The casters under one light in one view, counted.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    /// Those left out but for their number, which is the frame's less those drawn.
    statistics: VolumeStatistics,
}

/// What a [`Tally`] counts of one caster.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counted {
    pub state: CasterState,
    pub away_facing: bool,
    pub triangles: u32,
}

impl Tally {
    pub fn add(&mut self, caster: Counted) {
        *self.of_state(caster.state) += 1;
        if caster.is_drawn() {
            let statistics = &mut self.statistics;
            statistics.casters_drawn += 1;
            statistics.casters_away_facing += u32::from(caster.away_facing);
            statistics.triangles += u64::from(caster.triangles);
        } else {
            self.statistics.casters_skipped += 1;
        }
    }

    /// Takes back what was added before.
    pub fn remove(&mut self, caster: Counted) {
        *self.of_state(caster.state) -= 1;
        if caster.is_drawn() {
            let statistics = &mut self.statistics;
            statistics.casters_drawn -= 1;
            statistics.casters_away_facing -= u32::from(caster.away_facing);
            statistics.triangles -= u64::from(caster.triangles);
        } else {
            self.statistics.casters_skipped -= 1;
        }
    }

    /// Adds all of it to the statistics of a frame.
    pub fn sum_into(&self, sum: &mut VolumeStatistics) {
        let own = &self.statistics;
        sum.casters_drawn += own.casters_drawn;
        sum.casters_z_pass += own.casters_z_pass;
        sum.casters_z_fail += own.casters_z_fail;
        sum.casters_away_facing += own.casters_away_facing;
        sum.casters_skipped += own.casters_skipped;
        sum.skipped_empty += own.skipped_empty;
        sum.skipped_masked += own.skipped_masked;
        sum.skipped_edge_on += own.skipped_edge_on;
        sum.skipped_out_of_range += own.skipped_out_of_range;
        sum.skipped_out_of_view += own.skipped_out_of_view;
        sum.triangles += own.triangles;
    }

    fn of_state(&mut self, state: CasterState) -> &mut u32 {
        let statistics = &mut self.statistics;
        match state {
            CasterState::ZPass => &mut statistics.casters_z_pass,
            CasterState::ZFail => &mut statistics.casters_z_fail,
            CasterState::Empty => &mut statistics.skipped_empty,
            CasterState::Masked => &mut statistics.skipped_masked,
            CasterState::EdgeOn => &mut statistics.skipped_edge_on,
            CasterState::OutOfRange => &mut statistics.skipped_out_of_range,
            CasterState::OutOfView => &mut statistics.skipped_out_of_view,
        }
    }
}

impl Counted {
    fn is_drawn(self) -> bool {
        matches!(self.state, CasterState::ZPass | CasterState::ZFail)
    }
}
