//! The kernels, and the WGSL that each of them needs.

/// How many texels of the map a receiver looks at, and with what weights.
///
/// Whatever the kernel, every texel is compared with the depth of the receiver's own plane in that
/// texel's direction, so wide kernels and face edges need no more bias than narrow ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kernel {
    /// One tap on the nearest texel (Williams 1978). Hard, stair-stepped edges.
    Hard,
    /// One bilinear compare tap: 2x2 texels (Reeves, Salesin and Cook 1987).
    #[default]
    Bilinear,
    /// Four bilinear compare taps one texel away on the diagonals: 4x4 texels.
    FourTaps,
}

impl Kernel {
    /// Every kernel.
    pub const ALL: [Self; 3] = [Self::Hard, Self::Bilinear, Self::FourTaps];

    /// Half the kernel's width in texels: how far from a shadow's true edge its result may be
    /// anything but 0 or 1.
    pub fn radius(self) -> f32 {
        match self {
            Self::Hard => 0.5,
            Self::Bilinear => 1.0,
            Self::FourTaps => 2.0,
        }
    }

    /// The name of its function in WGSL.
    pub fn function(self) -> &'static str {
        match self {
            Self::Hard => "shadows_cube_hard",
            Self::Bilinear => "shadows_cube_bilinear",
            Self::FourTaps => "shadows_cube_four_taps",
        }
    }

    /// The parts of WGSL it is made of, and no others.
    pub(crate) fn parts(self) -> &'static [&'static str] {
        const RECEIVER: &str = include_str!("../../shaders/cube_receiver.wgsl");
        const QUAD: &str = include_str!("../../shaders/cube_quad.wgsl");
        match self {
            Self::Hard => &[RECEIVER, include_str!("../../shaders/cube_hard.wgsl")],
            Self::Bilinear => &[
                RECEIVER,
                QUAD,
                include_str!("../../shaders/cube_bilinear.wgsl"),
            ],
            Self::FourTaps => &[
                RECEIVER,
                QUAD,
                include_str!("../../shaders/cube_four_taps.wgsl"),
            ],
        }
    }
}
