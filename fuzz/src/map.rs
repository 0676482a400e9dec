//! What cube and flat maps are made with.

use arbitrary::Arbitrary;
use shadows::{CasterSides, Radius, wgpu};

use crate::Length;

/// How far kernels reach.
#[derive(Arbitrary, Clone, Copy, Debug)]
pub enum Reach {
    Texels(Length),
    World(Length),
}

impl Reach {
    pub fn radius(self) -> Radius {
        match self {
            Self::Texels(Length(texels)) => Radius::Texels(texels),
            Self::World(Length(width)) => Radius::World(width),
        }
    }

    /// What the documentation asks for.
    pub fn is_in_range(self) -> bool {
        match self {
            Self::Texels(Length(texels)) => texels > 0.0 && texels <= 64.0,
            Self::World(Length(width)) => width > 0.0 && width.is_finite(),
        }
    }
}

/// Those that a map can have.
const FORMATS: [wgpu::TextureFormat; 3] = [
    wgpu::TextureFormat::Depth32Float,
    wgpu::TextureFormat::Depth24Plus,
    wgpu::TextureFormat::Depth16Unorm,
];

/// Those that it cannot: with a stencil, without depth, of a feature that the device lacks.
const OTHERS: [wgpu::TextureFormat; 3] = [
    wgpu::TextureFormat::Depth24PlusStencil8,
    wgpu::TextureFormat::R32Float,
    wgpu::TextureFormat::Depth32FloatStencil8,
];

/// Mostly one that a map can have.
pub fn format(place: u8) -> wgpu::TextureFormat {
    match place {
        0..=239 => FORMATS[usize::from(place % 3)],
        _ => OTHERS[usize::from(place % 3)],
    }
}

/// Whether a map can have it.
pub fn takes(format: wgpu::TextureFormat) -> bool {
    FORMATS.contains(&format)
}

/// One of the three.
pub fn sides(place: u8) -> CasterSides {
    [CasterSides::Nearest, CasterSides::Both, CasterSides::Far][usize::from(place % 3)]
}
