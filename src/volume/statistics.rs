//! What became of each caster, and of all of them.

use crate::volume::decide::method::{Count, Skip};

/// What a renderer decided for one caster, under one light in one view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CasterState {
    /// Drawn, its volume counted in front of the visible surfaces.
    ZPass,
    /// Drawn, its volume counted behind the visible surfaces.
    ZFail,
    /// Left out: its mesh has no triangles.
    Empty,
    /// Left out: it is on none of the light's layers, or of the light's own owner.
    Masked,
    /// Left out: its transform leaves no area of it that the light sees. It is flattened to a line or a
    /// point, or to a plane that holds the light.
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

/// What the last [`prepare`](crate::ShadowVolumeRenderer::prepare) came to. What is said of casters is
/// summed over all lights and views: one that two lights shine on is counted twice. Views that a pass draws
/// together ([`multiview_mask`](crate::ShadowVolumeDescriptor::multiview_mask)) are one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct VolumeStatistics {
    /// Casters whose volumes are drawn.
    pub casters_drawn: u32,
    /// Those of them that are counted in front of the visible surfaces.
    pub casters_z_pass: u32,
    /// Those of them that are counted behind the visible surfaces.
    pub casters_z_fail: u32,
    /// Those of the casters drawn whose volumes start from the triangles turned away from the light,
    /// as [`StartFrom::AwayFacing`](crate::StartFrom::AwayFacing) asks; 0 where it is not asked for.
    pub casters_away_facing: u32,
    /// Casters left out, for any of the next five reasons.
    pub casters_skipped: u32,
    /// Casters left out because their meshes have no triangles.
    pub skipped_empty: u32,
    /// Casters left out because the light is not to cast their shadows
    /// ([`VolumeLight::layers`](crate::VolumeLight::layers), [`owner`](crate::VolumeLight::owner)).
    pub skipped_masked: u32,
    /// Casters left out because their transforms leave no area of them that the light sees: those of
    /// scale 0 on two axes or all, and those flattened to a plane that holds the light. (Flattened to
    /// any other plane, a caster casts what is left of it.)
    pub skipped_edge_on: u32,
    /// Casters left out because they are beyond the light's range, or beside its cone.
    pub skipped_out_of_range: u32,
    /// Casters left out because nothing they could shadow is in view, or among the receivers.
    pub skipped_out_of_view: u32,
    /// Draw calls that `render` records. Up to 256 casters under one light in one view share one for each
    /// kind of faces that they have: sides and caps, counted before or behind what is visible. By
    /// themselves are drawn caps of meshes of 1,024 triangles or more, casters over different buffers of
    /// the host's ([`CasterMesh::from_host_positions`](crate::CasterMesh::from_host_positions)), and where
    /// vertex shaders find the silhouettes ([`Silhouettes::Vertex`](crate::Silhouettes::Vertex)) all of
    /// them.
    pub draws: u32,
    /// Silhouettes that were searched for this frame; those of the other casters drawn were kept from
    /// the frame before, or found for another caster: casters of one mesh that the light meets alike
    /// (the sun, all that are turned alike) share theirs.
    pub casters_extracted: u32,
    /// Dispatches that `encode` records: two where compute shaders look for silhouettes and one that makes
    /// the draws which casters share, however many lights and meshes there are. One more for each buffer
    /// that positions of the host lie in
    /// ([`CasterMesh::from_host_positions`](crate::CasterMesh::from_host_positions)), and more where
    /// volumes or meshes are too large for one buffer.
    pub dispatches: u32,
    /// Bytes that `encode` copies into the renderer's buffers: 0 where nothing changed.
    pub uploaded: u64,
    /// Bytes of GPU memory that the renderer holds (the meshes' own not counted).
    pub gpu_bytes: u64,
    /// Triangles of all casters drawn.
    pub triangles: u64,
    /// Whether the frame before was never encoded, so that it was prepared in vain.
    pub not_encoded: bool,
    /// Whether an encoder was dropped that a frame before was encoded into, so that everything had to
    /// be found anew.
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
