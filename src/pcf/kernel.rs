//! The kernels, and the WGSL that each of them uses.

use super::disk::{ContactHardening, Radius, RandomDisk, VogelDisk};
use super::map_kind::MapKind;
use super::weights::Weights;
use crate::DepthEncoding;
use crate::error::PcfError;

/// Which texels of the map a receiver reads, and with what weights.
///
/// With every kernel except [`HardwareBilinear`](Self::HardwareBilinear), each texel is compared with the depth of
/// the receiver's own plane in that texel's direction. Wide kernels and face edges therefore need no additional
/// bias.
///
/// At grazing angles, near the horizon of that plane as seen from the light, its depth grows without bound. Two rules
/// limit it:
///
/// - No tap assumes the plane to be nearer to the light than 1/32 of the receiver's own distance along the axis of
///   the face (for a directional light: nearer than the receiver by more than sixteen times the map's width). A
///   caster nearer than that therefore casts at any grazing angle. One farther away is missed only where the plane
///   itself comes that near: for a kernel of `k` texels on a face of `n`, where the light arrives at an angle below
///   `2 k / (31 n)` (for the widest square, 0.015 degrees at 1024 texels).
/// - A texel beyond the horizon is replaced by its mirror image about the receiver. If that is beyond the horizon too,
///   and for the texels of disks (whose taps all lie on the plane), the receiver's own depth is used for the
///   comparison.
///
/// A receiver whose plane passes closer to the light than the normal offset of the [`Bias`](crate::Bias) is
/// lit.
///
/// On a cube a kernel continues across edges and corners, texel for texel: within a texel of them, fewer
/// points are wrong than in the middle of a face, by a factor of 0.7 or less
/// (`tests/receivers/pcf_seams.rs`).
///
/// The first seven are squares of texels. The last three are disks in the receiver's tangent plane, rotated
/// or jittered per pixel: they need the pixel's coordinates ([`uses_pixel`](Self::uses_pixel)) and trade
/// stair steps for noise.
///
/// The table gives the measurements of `tests/receivers/pcf_quality.rs` over a penumbra at 0.73 texels per
/// pixel, in visibility (0 to 1), on a cube or a flat map, whichever is worse (squares are the same on both).
/// Its columns are the root mean square and largest difference from the ideal kernel (the same one with
/// infinitely many taps of an infinitely fine map), and from a light of radius 0.1 (1,024 rays per pixel);
/// the largest step between neighbouring pixels beyond that of the ideal kernel (banding); the noise beyond
/// it; and the share of pixels that change by 0.05 more than with the ideal kernel when the camera moves by a
/// tenth of a pixel.
///
/// | | ideal kernel: rms | largest | area light: rms | largest | largest step | noise | flips |
/// |---|--:|--:|--:|--:|--:|--:|--:|
/// | `Hard` | 0.130 | 1.00 | 0.177 | 1.00 | 1.00 | 0.131 | 0.3 % |
/// | `Bilinear` | 0.047 | 0.44 | 0.142 | 0.67 | 0.40 | 0.039 | 0 |
/// | `FourTaps` | 0.022 | 0.12 | 0.087 | 0.63 | 0.10 | 0.018 | 0 |
/// | `Weighted3` | 0.019 | 0.14 | 0.103 | 0.59 | 0.10 | 0.010 | 0 |
/// | `Weighted5` | 0.013 | 0.08 | 0.081 | 0.63 | 0.04 | 0.005 | 0 |
/// | `Weighted7` | 0.012 | 0.07 | 0.073 | 0.65 | 0.03 | 0.004 | 0 |
/// | `HardwareBilinear` | 0.047 | 0.44 | 0.142 | 0.67 | 0.40 | 0.039 | 0 |
/// | `RandomDisk`, 32 taps | 0.025 | 0.14 | 0.071 | 0.69 | 0.15 | 0.022 | 1.2 % |
/// | `Vogel`, 16 taps | 0.030 | 0.16 | 0.072 | 0.63 | 0.21 | 0.028 | 4.4 % |
/// | `ContactHardening` | 0.022 | 0.16 | 0.057 | 0.63 | 0.12 | 0.021 | 1.3 % |
///
/// `docs/kernels.png` in the repository shows all of them on the same shadows
/// (`cargo run --release --example kernel_sheet -- --kernels docs/kernels.png`).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Kernel {
    /// One tap on the nearest texel (Williams 1978). Hard, stair-stepped edges.
    Hard,
    /// One bilinear compare tap: 2x2 texels (Reeves, Salesin and Cook 1987).
    #[default]
    Bilinear,
    /// Four bilinear compare taps one texel away on the diagonals: 4x4 texels.
    FourTaps,
    /// 3x3 texels with tent weights, from four taps of 2x2 (Castano 2013).
    Weighted3,
    /// 5x5 texels, weighted, from nine taps of 2x2 (Castano 2013).
    Weighted5,
    /// 7x7 texels, weighted, from sixteen taps of 2x2 (Castano 2013).
    Weighted7,
    /// One bilinear comparison by the sampler (`textureSampleCompareLevel`): [`Bilinear`](Self::Bilinear) at half its
    /// instructions (`docs/shader-cost.md`), for the tightest budgets. All four texels are compared with one depth,
    /// that of the receiver's plane at whichever of them is nearest to the light (on a cube: a bound on it, within a
    /// texel along both axes). No plane therefore shadows itself at any angle, and nothing is darker than with
    /// `Bilinear`. The price is paid at contacts: where a caster touches a surface, its shadow starts late, by the
    /// length of surface that one texel covers away from the light, by at most 1.12 times that where the surface is
    /// steep along one axis of the map, and by twice that along both (`tests/receivers/pcf_hardware.rs`; `Bilinear`:
    /// 0). A surface grazed by the light at a slope of 0.1 loses ten texels of a contact shadow.
    ///
    /// Errors in pictures of 480x270 pixels with maps of 512 texels, falsely lit + falsely in shadow, in per
    /// cent of the pixels that face the light. None of them is away from a shadow edge:
    ///
    /// | | `Bilinear` | `HardwareBilinear` |
    /// |---|--:|--:|
    /// | `spheres`, cube | 0.129 + 0.132 | 0.132 + 0.132 |
    /// | `courtyard`, cube | 0.621 + 0.966 | 0.923 + 0.623 |
    /// | `courtyard`, sun | 0.829 + 1.346 | 1.026 + 0.647 |
    /// | `courtyard`, spot | 0.609 in total | 0.395 in total |
    ///
    /// Far from the origin, a pixel is hardly wider than the rounding of positions, and screen derivatives give no
    /// usable normal. This kernel cannot fall back to a slope read from the map, so everything there is lit unless it
    /// is behind a caster very near the light. Pass a normal in such scenes.
    ///
    /// It reads [`MajorAxis`](DepthEncoding::MajorAxis) depths only. On a cube its taps do not cross edges:
    /// within half a texel of an edge, only the outermost texels count.
    HardwareBilinear,
    /// Random disk: a table of jittered, stratified offsets, indexed by the pixel.
    RandomDisk(RandomDisk),
    /// Vogel disk, rotated by interleaved gradient noise.
    Vogel(VogelDisk),
    /// Contact hardening (PCSS), for a light with a size.
    ContactHardening(ContactHardening),
}

impl Kernel {
    /// Every kernel, those with parameters at their defaults.
    pub const ALL: [Self; 10] = [
        Self::Hard,
        Self::Bilinear,
        Self::FourTaps,
        Self::Weighted3,
        Self::Weighted5,
        Self::Weighted7,
        Self::HardwareBilinear,
        Self::RandomDisk(RandomDisk::DEFAULT),
        Self::Vogel(VogelDisk::DEFAULT),
        Self::ContactHardening(ContactHardening::DEFAULT),
    ];

    /// The kernel's radius: how far from the true edge of a shadow its result may be partial. Disks reach
    /// half a texel further, to the centre of the texel that a tap falls on, and are measured on the surface:
    /// towards the corners of a face or a frustum, texels are smaller than straight ahead, and a radius of
    /// one texel may cover `sqrt(3)` of them.
    pub fn radius(self) -> Radius {
        match self {
            Self::Hard => Radius::Texels(0.5),
            Self::Bilinear | Self::HardwareBilinear => Radius::Texels(1.0),
            Self::FourTaps | Self::Weighted3 => Radius::Texels(2.0),
            Self::Weighted5 => Radius::Texels(3.0),
            Self::Weighted7 => Radius::Texels(4.0),
            Self::RandomDisk(disk) => disk.radius,
            Self::Vogel(disk) => disk.radius,
            Self::ContactHardening(contact) => contact.max_radius,
        }
    }

    /// Whether its functions take the pixel's coordinates as the last argument.
    pub fn uses_pixel(self) -> bool {
        self.parameters().is_some()
    }

    /// Whether it reads such maps: [`HardwareBilinear`](Self::HardwareBilinear) reads only
    /// [`MajorAxis`](DepthEncoding::MajorAxis), in which the depths of a plane are linear over a face.
    pub fn reads(self, map: MapKind) -> bool {
        self != Self::HardwareBilinear || map.encoding() == DepthEncoding::MajorAxis
    }

    /// The name of its WGSL function for cube maps. For flat maps, `flat` replaces `cube`.
    pub fn function(self) -> &'static str {
        match self {
            Self::Hard => "shadows_cube_hard",
            Self::Bilinear => "shadows_cube_bilinear",
            Self::FourTaps => "shadows_cube_four_taps",
            Self::Weighted3 => "shadows_cube_weighted_3",
            Self::Weighted5 => "shadows_cube_weighted_5",
            Self::Weighted7 => "shadows_cube_weighted_7",
            Self::HardwareBilinear => "shadows_cube_hardware_bilinear",
            Self::RandomDisk(_) => "shadows_cube_random_disk",
            Self::Vogel(_) => "shadows_cube_vogel",
            Self::ContactHardening(_) => "shadows_cube_contact",
        }
    }

    /// Checks that all parameters are in range.
    ///
    /// # Errors
    /// [`PcfError`] names the parameter and its range.
    pub fn validate(self) -> Result<(), PcfError> {
        match self {
            Self::RandomDisk(disk) => disk.validate(),
            Self::Vogel(disk) => disk.validate(),
            Self::ContactHardening(contact) => contact.validate(),
            _ => Ok(()),
        }
    }

    /// What the disks need to know; nothing for the squares.
    pub(super) fn parameters(self) -> Option<KernelUniform> {
        match self {
            Self::RandomDisk(disk) => Some(disk.parameters()),
            Self::Vogel(disk) => Some(disk.parameters()),
            Self::ContactHardening(contact) => Some(contact.parameters()),
            _ => None,
        }
    }

    /// Its weights, if it is a square of texels with any.
    pub(super) fn weights(self) -> Option<Weights> {
        match self {
            Self::Bilinear => Some(Weights::BILINEAR),
            Self::FourTaps => Some(Weights::FOUR_TAPS),
            Self::Weighted3 => Some(Weights::WEIGHTED_3),
            Self::Weighted5 => Some(Weights::WEIGHTED_5),
            Self::Weighted7 => Some(Weights::WEIGHTED_7),
            _ => None,
        }
    }
}

/// Parameters of a kernel; `ShadowsKernel` in WGSL.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct KernelUniform {
    pub radius_texels: f32,
    pub radius_world: f32,
    pub light_size: f32,
    pub frame_shift: f32,
    pub taps: u32,
    pub first_taps: u32,
    pub layer: f32,
    /// WebGL 2 takes uniforms in units of 16 bytes.
    pub padding: u32,
}

/// The most taps that a table of offsets holds.
pub(super) const MAX_TAPS: u32 = 64;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wgsl_layout::assert_layout;

    #[test]
    fn the_parameters_lie_in_memory_as_wgsl_has_them() {
        assert_layout!(
            include_str!("../../shaders/pcf_parameters.wgsl"),
            "ShadowsKernel",
            KernelUniform,
            radius_texels,
            radius_world,
            light_size,
            frame_shift,
            taps,
            first_taps,
            layer,
            padding
        );
    }
}
