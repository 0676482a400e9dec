//! Kernels on a disk and their parameters.

use super::kernel::{KernelUniform, MAX_TAPS};
use crate::error::PcfError;

/// The width of a kernel at the receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Radius {
    /// In texels of the map: its width in the world follows the size of texels at the receiver. Greater than
    /// 0, at most 64.
    Texels(f32),
    /// In world units: the penumbra's width does not depend on the map's size. Greater than 0, finite.
    World(f32),
}

impl Radius {
    /// The largest radius in texels.
    pub const MAX_TEXELS: f32 = 64.0;

    pub(crate) fn is_in_range(self) -> bool {
        let (value, limit) = match self {
            Self::Texels(value) => (value, Self::MAX_TEXELS),
            Self::World(value) => (value, f32::MAX),
        };
        value > 0.0 && value <= limit
    }

    fn validate(self) -> Result<(), PcfError> {
        match self.is_in_range() {
            true => Ok(()),
            false => Err(PcfError::Radius { radius: self }),
        }
    }

    pub(crate) fn texels_and_world(self) -> (f32, f32) {
        match self {
            Self::Texels(value) => (value, 0.0),
            Self::World(value) => (0.0, value),
        }
    }

    /// The reach of kernels in texels that a map has whose reach is in world units: as far as any
    /// kernel does by default.
    pub(crate) const USUAL_TEXELS: f32 = 12.0;

    /// The widest kernels, in texels and in world units, that a map of this reach is made for.
    pub(crate) fn reach(self) -> (f32, f32) {
        match self {
            Self::Texels(value) => (value, 0.0),
            Self::World(value) => (Self::USUAL_TEXELS, value),
        }
    }

    /// Whether kernels of this radius may read a map of that reach.
    pub(crate) fn is_within(self, reach: Self) -> bool {
        let ((texels, world), (most_texels, most_world)) = (self.texels_and_world(), reach.reach());
        texels <= most_texels && world <= most_world
    }
}

/// Parameters of [`Kernel::RandomDisk`](super::Kernel::RandomDisk).
///
/// An `n x n x d` texture of offsets (`d` texels of two offsets each), jittered within `u x v` strata and
/// warped onto the disk, outermost ring first, from a fixed seed. A pixel uses the column at its coordinates
/// modulo `n` (Wolff, "OpenGL 4 Shading Language Cookbook", 2013; after Uralsky, "Efficient Soft-Edged
/// Shadows Using Pixel Shader Branching", GPU Gems 2, 2005).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomDisk {
    /// Radius of the disk. Default 3 texels.
    pub radius: Radius,
    /// Strata around the disk (`u`). Default 8. `u * v` is the number of taps: 8 to 256, even.
    pub around: u32,
    /// Rings (`v`). Default 4.
    pub rings: u32,
    /// Texels along a side of the texture (`n`): the pattern repeats after that many pixels. Default
    /// 8. 1 to 256.
    pub size: u32,
    /// Whether to stop after the first eight taps (the outermost) if they agree. Default true. This misses
    /// shadows that lie entirely inside the disk, such as that of a wire: with 8 x 8 taps on the scene of
    /// `benches/pcf.rs`, it changes 0.5 % of the pixels, with a root mean square of 0.011 over all pixels and
    /// a maximum of 0.62, and takes less than half the time.
    pub early_out: bool,
}

impl RandomDisk {
    pub(super) const DEFAULT: Self = Self {
        radius: Radius::Texels(3.0),
        around: 8,
        rings: 4,
        size: 8,
        early_out: true,
    };
    /// Taps after which the others may be left out.
    pub(super) const FIRST: u32 = 8;
    const MAX_SIZE: u32 = 256;
    const MAX_SAMPLES: u32 = 256;

    /// Total number of taps.
    pub fn taps(&self) -> u32 {
        self.around.saturating_mul(self.rings)
    }

    pub(super) fn validate(&self) -> Result<(), PcfError> {
        self.radius.validate()?;
        let (taps, limit) = (self.taps(), Self::MAX_SAMPLES);
        if taps < Self::FIRST || taps > limit || taps % 2 == 1 {
            let (around, rings) = (self.around, self.rings);
            return Err(PcfError::Samples {
                around,
                rings,
                limit,
            });
        }
        if self.size == 0 || self.size > Self::MAX_SIZE {
            let (size, limit) = (self.size, Self::MAX_SIZE);
            return Err(PcfError::OffsetTexture { size, limit });
        }
        Ok(())
    }

    pub(super) fn parameters(&self) -> KernelUniform {
        let first = if self.early_out { Self::FIRST } else { 0 };
        uniform(self.radius, 0.0, self.taps(), first)
    }
}

impl Default for RandomDisk {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Parameters of [`Kernel::Vogel`](super::Kernel::Vogel).
///
/// Offsets on a spiral of golden angles (Vogel 1979), rotated per pixel by interleaved gradient noise
/// (Jimenez, SIGGRAPH 2014), and per frame if the host calls [`set_frame`](super::PcfSampler::set_frame).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VogelDisk {
    /// Radius of the disk. Default 3 texels.
    pub radius: Radius,
    /// Taps. Default 16. 4 to 64.
    pub taps: u32,
}

impl VogelDisk {
    pub(super) const DEFAULT: Self = Self {
        radius: Radius::Texels(3.0),
        taps: 16,
    };

    pub(super) fn validate(&self) -> Result<(), PcfError> {
        self.radius.validate()?;
        validate_taps("taps", self.taps)
    }

    pub(super) fn parameters(&self) -> KernelUniform {
        uniform(self.radius, 0.0, self.taps, 0)
    }
}

impl Default for VogelDisk {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Parameters of [`Kernel::ContactHardening`](super::Kernel::ContactHardening).
///
/// The width of the penumbra follows from the light's size and the distance between blocker and receiver
/// (Fernando, "Percentage-Closer Soft Shadows", 2005): blockers are searched for in a disk of `max_radius`.
/// If there are none, the receiver is lit; if all taps find one, it is in the umbra; otherwise their mean
/// depth determines the filter disk, which is at least a texel wide. Disks lie in the receiver's tangent
/// plane and are stretched along the light's direction like the light's own outline, by at most a factor of
/// 4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactHardening {
    /// Radius of a spherical light in world units; for a directional light the tangent of its
    /// angular radius (0.00465 for the sun). Default 0.1. Greater than 0, finite.
    pub light_size: f32,
    /// Radius of the widest penumbra and of the blocker search. A wider search finds more blockers but is
    /// noisier. Default 12 texels.
    pub max_radius: Radius,
    /// Taps of the blocker search. Default 16. 4 to 64, at most `taps`.
    pub search_taps: u32,
    /// Taps of the filter. Default 32. 4 to 64.
    pub taps: u32,
}

impl ContactHardening {
    pub(super) const DEFAULT: Self = Self {
        light_size: 0.1,
        max_radius: Radius::Texels(12.0),
        search_taps: 16,
        taps: 32,
    };

    pub(super) fn validate(&self) -> Result<(), PcfError> {
        self.max_radius.validate()?;
        validate_taps("taps", self.taps)?;
        validate_taps("search_taps", self.search_taps)?;
        if self.search_taps > self.taps {
            return Err(PcfError::Taps {
                what: "search_taps",
                taps: self.search_taps,
                limit: self.taps,
            });
        }
        if self.light_size.is_finite() && self.light_size > 0.0 {
            Ok(())
        } else {
            Err(PcfError::LightSize(self.light_size))
        }
    }

    pub(super) fn parameters(&self) -> KernelUniform {
        uniform(
            self.max_radius,
            self.light_size,
            self.taps,
            self.search_taps,
        )
    }
}

impl Default for ContactHardening {
    fn default() -> Self {
        Self::DEFAULT
    }
}

fn validate_taps(what: &'static str, taps: u32) -> Result<(), PcfError> {
    if (4..=MAX_TAPS).contains(&taps) {
        Ok(())
    } else {
        let limit = MAX_TAPS;
        Err(PcfError::Taps { what, taps, limit })
    }
}

fn uniform(radius: Radius, light_size: f32, taps: u32, first_taps: u32) -> KernelUniform {
    let (radius_texels, radius_world) = radius.texels_and_world();
    KernelUniform {
        radius_texels,
        radius_world,
        light_size,
        frame_shift: 0.0,
        taps,
        first_taps,
        layer: 1.0 / taps.div_ceil(2) as f32,
        padding: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::Radius::{Texels, World};

    #[test]
    fn no_kernel_is_wider_than_a_map_was_made_for() {
        for (kernel, reach, fits) in [
            (Texels(12.0), Texels(8.0), false),
            (Texels(8.0), Texels(8.0), true),
            (World(0.2), World(0.1), false),
            (World(0.1), World(0.1), true),
            // How many texels that is depends on the receiver.
            (World(1e-9), Texels(64.0), false),
            // The kernels of every host, beside those in world units.
            (Texels(12.0), World(1e-9), true),
            (Texels(12.5), World(1e9), false),
        ] {
            assert_eq!(kernel.is_within(reach), fits, "{kernel:?} {reach:?}");
        }
    }
}
