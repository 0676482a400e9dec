//! Where silhouettes are found.

use super::super::limits;
use crate::error::ShadowVolumeError;
use crate::mesh::CasterMesh;

/// How the silhouettes of casters are found. All ways count the same volumes, but for a light at the
/// very skin of a triangle: see [`ShadowVolumeRenderer`](crate::ShadowVolumeRenderer).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Silhouettes {
    /// What is fastest and possible (the default): [`Compute`](Self::Compute) on a GPU,
    /// [`Cpu`](Self::Cpu) on a software adapter (where one thread without an upload to speak of
    /// beats the same work as shaders) and where there is no compute, [`Vertex`](Self::Vertex)
    /// where vertex shaders read no storage buffers. Meshes over the host's own positions are
    /// extracted by compute, wherever the others are not.
    #[default]
    Auto,
    /// Two compute passes. Needs compute, storage buffers in vertex shaders and indirect draws.
    Compute,
    /// One thread of the CPU during `prepare`: facings, 64 triangles at a time by their planes, then
    /// the edges near those that differ. Needs storage buffers in vertex shaders, and positions that
    /// were uploaded by [`CasterMesh::new`]. A million triangles on a grid take no longer than a
    /// plain loop over triangles and edges whose lists are never uploaded
    /// (`cargo bench --bench shadow_volume`).
    Cpu,
    /// The vertex shader alone: every triangle and every edge is drawn every frame, and those that
    /// are not part of the volume are degenerate. Runs at WebGL2's limits; needs positions that
    /// were uploaded by [`CasterMesh::new`], and 76 bytes of GPU memory an edge and 36 a triangle.
    ///
    /// Weaker than the others in two ways: its work grows with the mesh, not the silhouette; and
    /// where more than two triangles meet in an edge, they are taken in pairs, so that sides may be
    /// drawn which cancel each other. The picture is the same.
    Vertex,
}

/// A way that was decided on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Way {
    Compute,
    Cpu,
    Vertex,
}

/// The ways open to one renderer, the best first.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Ways {
    first: Way,
    second: Option<Way>,
}

impl Ways {
    /// What is asked for, or for `Auto` what the device does best.
    pub fn new(asked: Silhouettes, device: &wgpu::Device) -> Result<Self, ShadowVolumeError> {
        let limits = &device.limits();
        limits::check(limits::EVERY_WAY, limits)?;
        let only = |first| Self {
            first,
            second: None,
        };
        let compute = || limits::check(limits::COMPUTE, limits);
        match asked {
            Silhouettes::Auto => {}
            Silhouettes::Compute => return compute().map(|()| only(Way::Compute)),
            Silhouettes::Cpu => {
                return limits::check(limits::PULL, limits).map(|()| only(Way::Cpu));
            }
            Silhouettes::Vertex => return Ok(only(Way::Vertex)),
        }
        if limits::check(limits::PULL, limits).is_err() {
            return Ok(only(Way::Vertex));
        }
        if compute().is_err() {
            return Ok(only(Way::Cpu));
        }
        if device.adapter_info().device_type == wgpu::DeviceType::Cpu {
            return Ok(Self {
                first: Way::Cpu,
                second: Some(Way::Compute),
            });
        }
        Ok(only(Way::Compute))
    }

    /// Whether any mesh may go this way.
    pub fn contain(&self, way: Way) -> bool {
        self.first == way || self.second == Some(way)
    }

    /// The way for one mesh.
    pub fn of(&self, mesh: &CasterMesh) -> Option<Way> {
        [Some(self.first), self.second]
            .into_iter()
            .flatten()
            .find(|way| *way == Way::Compute || mesh.data().is_some())
    }
}
