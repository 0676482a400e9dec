//! What became of each caster.

use crate::volume::VolumeStatistics;
use crate::volume::decide::method::{Count, Skip};

/// What a renderer decided for one caster of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CasterState {
    /// Drawn, its volume counted in front of the visible surfaces.
    ZPass,
    /// Drawn, its volume counted behind the visible surfaces.
    ZFail,
    /// Left out: its mesh has no triangles.
    Empty,
    /// Left out: its transform leaves no area of it that the light sees. It is flattened to a line or a
    /// point, or to a plane that holds the light.
    EdgeOn,
    /// Left out: it is beyond the light's range.
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
            Skip::EdgeOn => Self::EdgeOn,
            Skip::OutOfRange => Self::OutOfRange,
            Skip::OutOfView => Self::OutOfView,
        }
    }
}

/// What is counted while a frame is planned.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub statistics: VolumeStatistics,
    /// One for each caster of the frame, in its order.
    pub states: Vec<CasterState>,
}

impl Tally {
    pub fn note(&mut self, state: CasterState) {
        let statistics = &mut self.statistics;
        *match state {
            CasterState::ZPass => &mut statistics.casters_z_pass,
            CasterState::ZFail => &mut statistics.casters_z_fail,
            CasterState::Empty => &mut statistics.skipped_empty,
            CasterState::EdgeOn => &mut statistics.skipped_edge_on,
            CasterState::OutOfRange => &mut statistics.skipped_out_of_range,
            CasterState::OutOfView => &mut statistics.skipped_out_of_view,
        } += 1;
        self.states.push(state);
    }
}
