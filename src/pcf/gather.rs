//! How square kernels read four texels.

use crate::error::PcfError;
use crate::support::has_gather;

/// Whether the shaders of square kernels read four texels with one texture gather, or fetch each by
/// itself. Both read the same texels, and give the same visibility bit for bit. Exhaustive: there is no
/// third way.
///
/// [`Hard`](crate::Kernel::Hard) and the disks gather nothing, and are the same with any.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Gather {
    /// A gather wherever there is one: [`Support::gather`](crate::Support::gather).
    #[default]
    Auto,
    /// A gather; refused where there is none.
    Always,
    /// Four fetches: for devices whose gathers are wrong.
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
