//! How square kernels read texels.

use crate::error::PcfError;
use crate::support::has_gather;

/// Whether the shaders of square kernels read four texels with one texture gather, or fetch them
/// individually. Both read the same texels and give bit-identical visibility. Exhaustive: there is no third
/// way.
///
/// [`Hard`](crate::Kernel::Hard) and the disks never gather and are not affected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Gather {
    /// Gather where the device supports it: [`Support::gather`](crate::Support::gather).
    #[default]
    Auto,
    /// Gather; an error if the device does not support it.
    Always,
    /// Four fetches, for devices with broken gathers.
    Never,
}

impl Gather {
    /// Whether a device's shaders gather.
    pub(super) fn on(self, device: &wgpu::Device) -> Result<bool, PcfError> {
        match self {
            Self::Never => Ok(false),
            Self::Auto => Ok(has_gather(device)),
            Self::Always if has_gather(device) => Ok(true),
            Self::Always => Err(PcfError::Gather),
        }
    }
}
