//! Where silhouettes are found.

use crate::error::ShadowVolumeError;
use crate::mesh::CasterMesh;
use crate::volume::plan::limits;

/// How the silhouettes of casters are found. All ways give the same volumes, except for a light extremely
/// near to the surface of a triangle: see [`ShadowVolumeRenderer`](crate::ShadowVolumeRenderer).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Silhouettes {
    /// The fastest available way (the default): [`Compute`](Self::Compute) on a GPU, [`Cpu`](Self::Cpu) on a
    /// software adapter (where one thread with hardly any upload beats the same work in shaders) and where
    /// there are no compute shaders, and [`Vertex`](Self::Vertex) where vertex shaders cannot read storage
    /// buffers. Meshes over the host's own positions always use compute shaders.
    #[default]
    Auto,
    /// Three compute passes. Needs compute, storage buffers in vertex shaders and indirect draws.
    Compute,
    /// One CPU thread during `prepare`: facings, 64 triangles at a time by their planes, then the edges near
    /// those that differ. Needs storage buffers in vertex shaders, and positions that were uploaded by
    /// [`CasterMesh::new`]. A million triangles on a grid take no longer than a plain loop over triangles and
    /// edges without any upload (`cargo bench --bench shadow_volume`).
    Cpu,
    /// Vertex shaders only: every triangle and every edge is drawn every frame, and those that are not part
    /// of the volume become degenerate. Runs within WebGL2's limits; needs positions that were uploaded by
    /// [`CasterMesh::new`], and 76 bytes of GPU memory per edge and 36 per triangle.
    ///
    /// It has three disadvantages: its work grows with the mesh rather than the silhouette; casters share no
    /// draws (their triangles and edges lie in separate buffers, and without storage buffers a vertex
    /// identifies its caster by what is bound), so there are two to five draws for each; and where more than
    /// two triangles meet in an edge, they are taken in pairs, so sides may be drawn that cancel each other.
    /// The picture is the same.
    Vertex,
}

/// A way that was decided on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Way {
    Compute,
    Cpu,
    Vertex,
}

/// The ways open to one renderer, the best first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ways {
    first: Way,
    second: Option<Way>,
}

impl Ways {
    /// What is asked for, or for `Auto` what the device does best.
    pub fn new(asked: Silhouettes, device: &wgpu::Device) -> Result<Self, ShadowVolumeError> {
        let limits = &device.limits();
        limits::check(limits::EVERY_WAY, limits)?;
        let pulling = limits::check_pulling(device);
        let software = device.adapter_info().device_type == wgpu::DeviceType::Cpu;
        Self::choose(asked, limits, pulling, software)
    }

    fn choose(
        asked: Silhouettes,
        limits: &wgpu::Limits,
        pulling: Result<(), ShadowVolumeError>,
        software: bool,
    ) -> Result<Self, ShadowVolumeError> {
        let only = |first| Self {
            first,
            second: None,
        };
        let compute = limits::check(limits::COMPUTE, limits).and(pulling.clone());
        Ok(match asked {
            Silhouettes::Compute => compute.map(|()| only(Way::Compute))?,
            Silhouettes::Cpu => pulling.map(|()| only(Way::Cpu))?,
            Silhouettes::Vertex => only(Way::Vertex),
            Silhouettes::Auto if pulling.is_err() => only(Way::Vertex),
            Silhouettes::Auto if compute.is_err() => only(Way::Cpu),
            Silhouettes::Auto if software => Self {
                first: Way::Cpu,
                second: Some(Way::Compute),
            },
            Silhouettes::Auto => only(Way::Compute),
        })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_without_vertex_storage_is_left_to_the_vertex_shader() {
        let limits = wgpu::Limits::defaults();
        let vertex = Ways {
            first: Way::Vertex,
            second: None,
        };
        // Some GLES 3.1 devices have storage buffers in all shaders but these.
        let none = Err(ShadowVolumeError::VertexStorage);
        let chosen = |asked, pulling| Ways::choose(asked, &limits, pulling, false);
        assert_eq!(chosen(Silhouettes::Auto, none.clone()), Ok(vertex));
        assert_eq!(chosen(Silhouettes::Vertex, none.clone()), Ok(vertex));
        for asked in [Silhouettes::Compute, Silhouettes::Cpu] {
            let refused = chosen(asked, none.clone());
            assert_eq!(refused, Err(ShadowVolumeError::VertexStorage));
            assert_ne!(chosen(asked, Ok(())), Ok(vertex));
        }
        assert_ne!(chosen(Silhouettes::Auto, Ok(())), Ok(vertex));
    }

    #[test]
    fn a_device_without_compute_is_left_to_the_cpu() {
        let limits = wgpu::Limits {
            max_compute_workgroup_size_x: 0,
            ..wgpu::Limits::defaults()
        };
        let auto = |limits| Ways::choose(Silhouettes::Auto, limits, Ok(()), false);
        let only = |first| {
            Ok(Ways {
                first,
                second: None,
            })
        };
        assert_eq!(auto(&limits), only(Way::Cpu));
        assert_eq!(auto(&wgpu::Limits::defaults()), only(Way::Compute));
    }
}
