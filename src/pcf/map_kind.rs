//! The kinds of shadow map that a sampler can read.

use crate::{CubeShadowMap, DepthEncoding};

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

impl<'a> AnyMap<'a> {
    /// Which kind it is.
    pub fn kind(self) -> MapKind {
        match self {
            Self::Cube(_) => MapKind::Cube,
        }
    }
}

impl<'a> From<&'a CubeShadowMap> for AnyMap<'a> {
    fn from(map: &'a CubeShadowMap) -> Self {
        Self::Cube(map)
    }
}

/// The files that a kind of map brings along.
pub(super) struct MapWgsl {
    kind: MapKind,
    many_lights: bool,
    pub receiver: &'static str,
    pub depth: &'static str,
    pub fetch: &'static str,
    pub gather: &'static str,
    pub texel: &'static str,
    pub four: &'static str,
    pub tap: &'static str,
}

impl MapWgsl {
    pub fn new(kind: MapKind, encoding: DepthEncoding, many_lights: bool) -> Self {
        match kind {
            MapKind::Cube => Self::cube(encoding, many_lights),
        }
    }

    fn cube(encoding: DepthEncoding, many_lights: bool) -> Self {
        let (fetch, gather) = match many_lights {
            false => (
                include_str!("../../shaders/cube_fetch.wgsl"),
                include_str!("../../shaders/cube_gather.wgsl"),
            ),
            true => (
                include_str!("../../shaders/cube_array_fetch.wgsl"),
                include_str!("../../shaders/cube_array_gather.wgsl"),
            ),
        };
        Self {
            kind: MapKind::Cube,
            many_lights,
            receiver: include_str!("../../shaders/cube_receiver.wgsl"),
            depth: match encoding {
                DepthEncoding::MajorAxis => include_str!("../../shaders/cube_major.wgsl"),
                DepthEncoding::LinearDistance => include_str!("../../shaders/cube_linear.wgsl"),
            },
            fetch,
            gather,
            texel: include_str!("../../shaders/cube_texel.wgsl"),
            four: include_str!("../../shaders/cube_four.wgsl"),
            tap: include_str!("../../shaders/cube_tap.wgsl"),
        }
    }

    /// Kernels are written for one cube map, and are WGSL as they stand. On other maps they differ
    /// in the texture's type, and on flat ones in the names.
    pub fn adapt(&self, wgsl: &str) -> String {
        match (self.kind, self.many_lights) {
            (MapKind::Cube, false) => wgsl.to_owned(),
            (MapKind::Cube, true) => wgsl.replace("texture_cube<f32>", "texture_cube_array<f32>"),
        }
    }
}
