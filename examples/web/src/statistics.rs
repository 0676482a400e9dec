//! What a frame came to, in the same words for every method.

use host::peer_map::PeerStatistics;
use shadows::{AtlasStatistics, CubeStatistics, ShadowMapStatistics, VolumeStatistics};

/// What is shown of a method's work.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    /// What had to be drawn for shadows in this frame.
    pub drawn: String,
    pub draws: u32,
    pub triangles: u64,
    /// Of the GPU.
    pub bytes: u64,
}

pub fn of_cube(s: &CubeStatistics) -> Rows {
    let faces = s.faces_rendered + s.faces_kept + s.faces_hidden + s.faces_empty;
    Rows {
        drawn: format!("{} of {faces} faces", s.faces_rendered),
        draws: s.draws,
        triangles: s.triangles,
        bytes: s.bytes,
    }
}

pub fn of_flat(s: &ShadowMapStatistics) -> Rows {
    Rows {
        drawn: if s.rendered { "the map" } else { "nothing" }.into(),
        draws: s.draws,
        triangles: s.triangles,
        bytes: s.bytes,
    }
}

pub fn of_atlas(s: &AtlasStatistics) -> Rows {
    let tiles = s.tiles_rendered + s.tiles_kept + s.tiles_hidden + s.tiles_empty;
    Rows {
        drawn: format!("{} of {tiles} tiles", s.tiles_rendered),
        draws: s.draws,
        triangles: s.triangles,
        bytes: s.bytes,
    }
}

pub fn of_volumes(s: &VolumeStatistics) -> Rows {
    let casters = s.casters_drawn + s.casters_skipped;
    Rows {
        drawn: format!("{} of {casters} volumes", s.casters_drawn),
        draws: s.draws,
        triangles: s.triangles,
        bytes: s.gpu_bytes,
    }
}

pub fn of_peer(s: &PeerStatistics) -> Rows {
    Rows {
        drawn: "everything".into(),
        draws: s.draws,
        triangles: s.triangles,
        bytes: s.bytes,
    }
}
