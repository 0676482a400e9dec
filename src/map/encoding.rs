//! The depth encoding of cube maps.

/// What the texels of a [`CubeShadowMap`](crate::CubeShadowMap) hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DepthEncoding {
    /// `near / d`, where `d` is the distance along the face's major axis: infinite reverse-Z, 0 where there
    /// is no caster. Linear over a face for any plane, and needs no fragment shader.
    #[default]
    MajorAxis,
    /// `distance / range` from light to caster, written by the fragment shader, 1 where there is no caster.
    /// Evenly spaced, so the better choice for `Depth16Unorm`; drawing costs about a third more than with
    /// [`MajorAxis`](Self::MajorAxis), since depths are not known before the fragment shader.
    LinearDistance,
}

impl DepthEncoding {
    /// The depth that means "no caster".
    pub fn clear_depth(self) -> f32 {
        match self {
            Self::MajorAxis => 0.0,
            Self::LinearDistance => 1.0,
        }
    }

    /// The depth comparison that keeps the nearer caster.
    pub fn nearer(self) -> wgpu::CompareFunction {
        match self {
            Self::MajorAxis => wgpu::CompareFunction::Greater,
            Self::LinearDistance => wgpu::CompareFunction::Less,
        }
    }
}

/// One step of a format's depths, 0 for floats; `None` for formats that are not supported.
pub(crate) fn quantum(format: wgpu::TextureFormat) -> Option<f32> {
    match format {
        wgpu::TextureFormat::Depth32Float => Some(0.0),
        wgpu::TextureFormat::Depth24Plus => Some(1.0 / 16_777_215.0),
        wgpu::TextureFormat::Depth16Unorm => Some(1.0 / 65_535.0),
        _ => None,
    }
}

/// Bytes of a texel.
pub(crate) fn texel_bytes(format: wgpu::TextureFormat) -> u64 {
    match format {
        wgpu::TextureFormat::Depth16Unorm => 2,
        _ => 4,
    }
}
