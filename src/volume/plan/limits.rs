//! What a device must be able to do.

use crate::error::ShadowVolumeError;
use crate::support::STORAGE_BUFFERS;
use crate::support::has_vertex_storage;

/// Invocations in a workgroup of the extraction passes.
pub(crate) const WORKGROUP: u32 = 256;

/// A limit's name, what is needed, and where it is found.
type Need = (&'static str, u32, fn(&wgpu::Limits) -> u32);

/// For volumes whose silhouettes compute shaders find: the storage buffers of the largest pass,
/// and dispatches of which two dimensions hold one invocation for each `u32`.
pub(crate) const COMPUTE: &[Need] = &[
    (
        "max_storage_buffers_per_shader_stage",
        STORAGE_BUFFERS,
        |l| l.max_storage_buffers_per_shader_stage,
    ),
    ("max_compute_workgroup_size_x", WORKGROUP, |l| {
        l.max_compute_workgroup_size_x
    }),
    ("max_compute_invocations_per_workgroup", WORKGROUP, |l| {
        l.max_compute_invocations_per_workgroup
    }),
    ("max_compute_workgroups_per_dimension", 4096, |l| {
        l.max_compute_workgroups_per_dimension
    }),
];

/// Storage buffers of a vertex shader that pulls: casters, positions, edges, and sides or caps.
pub(crate) const PULLED_BUFFERS: u32 = 4;

const PULL: &[Need] = &[(
    "max_storage_buffers_per_shader_stage",
    PULLED_BUFFERS,
    |l| l.max_storage_buffers_per_shader_stage,
)];

/// For all volumes: caster, view and light.
pub(crate) const EVERY_WAY: &[Need] =
    &[("max_dynamic_uniform_buffers_per_pipeline_layout", 3, |l| {
        l.max_dynamic_uniform_buffers_per_pipeline_layout
    })];

/// The first limit that is too low.
pub(crate) fn check(needs: &[Need], limits: &wgpu::Limits) -> Result<(), ShadowVolumeError> {
    needs.iter().try_for_each(|&(name, needed, available)| {
        check_one(name, needed.into(), available(limits).into())
    })
}

/// Whether vertex shaders can pull what they draw.
pub(crate) fn check_pulling(device: &wgpu::Device) -> Result<(), ShadowVolumeError> {
    check(PULL, &device.limits())?;
    match has_vertex_storage(device) {
        true => Ok(()),
        false => Err(ShadowVolumeError::VertexStorage),
    }
}

/// One limit.
pub(crate) fn check_one(
    name: &'static str,
    needed: u64,
    available: u64,
) -> Result<(), ShadowVolumeError> {
    if needed <= available {
        return Ok(());
    }
    Err(ShadowVolumeError::Limit {
        name,
        needed,
        available,
    })
}

/// What of the device's limits a plan depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlanLimits {
    /// Bytes of the largest buffer that can be made.
    pub buffer_bytes: u64,
    /// Bytes of the largest buffer that can be made and bound as storage.
    pub storage_bytes: u64,
    /// Bytes of the largest buffer that can hold casters' parameters.
    pub caster_bytes: u64,
    /// Casters whose parameters fit the buffers.
    pub casters: usize,
    /// Workgroups in one dimension of a dispatch.
    pub workgroups: u32,
    /// Cameras in one window of the views: see `multiview.rs`.
    pub cameras: usize,
    /// Bytes from one caster's, view's, light's and batch's parameters to the next's.
    pub caster_window: u32,
    pub view_window: u32,
    pub light_window: u32,
    pub batch_window: u32,
}

impl PlanLimits {
    /// Views, or sets of views that are drawn together, whose cameras fit the buffer.
    pub fn passes(&self) -> usize {
        // Dynamic offsets are 32 bits wide.
        let bytes = self.buffer_bytes.min(u64::from(u32::MAX));
        let windows = bytes / u64::from(self.view_window);
        usize::try_from(windows).map_or(self.casters, |windows| windows.min(self.casters))
    }
}
