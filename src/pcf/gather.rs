//! How square kernels read four texels.

use super::MapKind;
use crate::error::PcfError;
use crate::support::{has_cube_gather, has_gather};

/// Whether the shaders of square kernels read four texels with one texture gather, or fetch each by
/// itself. Both read the same texels, and give the same visibility bit for bit. Exhaustive: there is no
/// third way.
///
/// [`Hard`](crate::Kernel::Hard) and the disks gather nothing, and are the same with any.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Gather {
    /// A gather wherever it can be relied on: flat maps where there is [`Support::gather`], cube maps
    /// where there is [`Support::cube_gather`].
    ///
    /// [`Support::gather`]: crate::Support::gather
    /// [`Support::cube_gather`]: crate::Support::cube_gather
    #[default]
    Auto,
    /// A gather, on Intel's GPUs, too: for hosts that know theirs to be right.
    Always,
    /// Four fetches: for devices whose gathers are wrong and that the crate does not know, among them
    /// Intel's in browsers, which do not tell the vendor.
    Never,
}

impl Gather {
    /// Whether a device's shaders gather from a kind of map.
    pub(super) fn on(self, device: &wgpu::Device, map: MapKind) -> Result<bool, PcfError> {
        match (self, map) {
            (Self::Never, _) => Ok(false),
            (Self::Auto, MapKind::Cube) => Ok(has_cube_gather(device)),
            (Self::Auto, MapKind::Flat) => Ok(has_gather(device)),
            (Self::Always, _) if has_gather(device) => Ok(true),
            (Self::Always, _) => Err(PcfError::Gather),
        }
    }
}
