//! The kinds of shadow map that a sampler can read.

use crate::CubeShadowMap;

/// Which kind of map a [`PcfSampler`](super::PcfSampler) reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MapKind {
    /// [`CubeShadowMap`]: point lights.
    #[default]
    Cube,
}

/// A map, of whichever kind.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum AnyMap<'a> {
    /// A cube map.
    Cube(&'a CubeShadowMap),
}

impl<'a> From<&'a CubeShadowMap> for AnyMap<'a> {
    fn from(map: &'a CubeShadowMap) -> Self {
        Self::Cube(map)
    }
}

impl<'a> AnyMap<'a> {
    /// Which kind it is.
    pub fn kind(self) -> MapKind {
        match self {
            Self::Cube(_) => MapKind::Cube,
        }
    }

    pub(super) fn view(self) -> &'a wgpu::TextureView {
        match self {
            Self::Cube(map) => map.view(),
        }
    }

    pub(super) fn light_uniform(self) -> &'a wgpu::Buffer {
        match self {
            Self::Cube(map) => map.light_uniform(),
        }
    }
}

/// The files that a kind of map brings along.
pub(super) struct MapWgsl {
    pub receiver: &'static str,
    pub texel: &'static str,
    pub gather: &'static str,
    pub tap: &'static str,
}

impl MapKind {
    pub(super) fn wgsl(self) -> MapWgsl {
        match self {
            Self::Cube => MapWgsl {
                receiver: include_str!("../../shaders/cube_receiver.wgsl"),
                texel: include_str!("../../shaders/cube_texel.wgsl"),
                gather: include_str!("../../shaders/cube_gather.wgsl"),
                tap: include_str!("../../shaders/cube_tap.wgsl"),
            },
        }
    }

    /// Kernels are written for cube maps; this makes them another kind's.
    pub(super) fn rename(self, wgsl: &str) -> String {
        match self {
            Self::Cube => wgsl.to_owned(),
        }
    }
}
