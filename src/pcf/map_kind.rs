//! The kinds of shadow map that a sampler can read.

use super::text::TEXEL;
use crate::{CubeShadowMap, DepthEncoding, Radius, ShadowMap};

const CUBE_TAP: &str = include_str!("../../shaders/cube_tap.wgsl");

/// Which kind of map a [`PcfSampler`](super::PcfSampler) reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MapKind {
    /// [`CubeShadowMap`]: point lights.
    #[default]
    Cube,
    /// [`ShadowMap`]: spot and directional lights.
    Flat,
}

/// Which kinds of light a sampler of flat maps serves. One for a single kind costs less (docs/shader-cost.md).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FlatLights {
    /// Spots and directional lights, whichever the map is prepared for.
    #[default]
    Any,
    /// Spots. A map that is prepared for a directional light is dark to them.
    Spot,
    /// Directional lights. A map that is prepared for a spot is dark to them.
    Directional,
}

impl FlatLights {
    fn wgsl(self) -> &'static str {
        match self {
            Self::Any => include_str!("../../shaders/flat_any.wgsl"),
            Self::Spot => include_str!("../../shaders/flat_spot.wgsl"),
            Self::Directional => include_str!("../../shaders/flat_directional.wgsl"),
        }
    }
}

/// A map, of whichever kind.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum AnyMap<'a> {
    /// A cube map.
    Cube(&'a CubeShadowMap),
    /// A flat map.
    Flat(&'a ShadowMap),
}

impl<'a> AnyMap<'a> {
    /// Which kind it is.
    pub fn kind(self) -> MapKind {
        match self {
            Self::Cube(_) => MapKind::Cube,
            Self::Flat(_) => MapKind::Flat,
        }
    }

    /// The widest kernels that it was made for.
    pub(super) fn reach(self) -> Radius {
        match self {
            Self::Cube(map) => map.reach,
            Self::Flat(map) => map.reach,
        }
    }
}

impl<'a> From<&'a CubeShadowMap> for AnyMap<'a> {
    fn from(map: &'a CubeShadowMap) -> Self {
        Self::Cube(map)
    }
}

impl<'a> From<&'a ShadowMap> for AnyMap<'a> {
    fn from(map: &'a ShadowMap) -> Self {
        Self::Flat(map)
    }
}

/// What a sampler is made to read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reads {
    pub map: MapKind,
    pub encoding: DepthEncoding,
    pub many_lights: bool,
    pub flat_lights: FlatLights,
    /// Whether its sampler has a border of depth 0.
    pub border: bool,
    /// Whether squares of texels are gathered, or else fetched one by one.
    pub gather: bool,
}

/// The files that a kind of map brings along.
pub(super) struct MapWgsl {
    reads: Reads,
    pub light: &'static str,
    pub kind: &'static str,
    pub receiver: &'static str,
    pub depth: &'static str,
    pub edge: &'static str,
    pub fetch: &'static str,
    pub gather: &'static str,
    pub texel: &'static str,
    pub four: &'static str,
    pub tap: &'static str,
    /// All that [`Kernel::Hard`](super::Kernel::Hard) takes.
    pub hard: [&'static str; 2],
    pub slope: &'static str,
    pub compare: &'static str,
    pub hardware: &'static str,
}

impl MapWgsl {
    pub fn new(reads: Reads) -> Self {
        match reads.map {
            MapKind::Cube => Self::cube(reads),
            MapKind::Flat => Self::flat(reads),
        }
    }

    fn flat(reads: Reads) -> Self {
        Self {
            reads,
            light: include_str!("../../shaders/flat_light.wgsl"),
            kind: reads.flat_lights.wgsl(),
            receiver: include_str!("../../shaders/flat_receiver.wgsl"),
            depth: "",
            edge: match reads.border {
                false => include_str!("../../shaders/flat_edge_test.wgsl"),
                true => include_str!("../../shaders/flat_edge_border.wgsl"),
            },
            fetch: include_str!("../../shaders/flat_texel.wgsl"),
            gather: match reads.gather {
                true => include_str!("../../shaders/flat_four.wgsl"),
                false => include_str!("../../shaders/flat_four_fetches.wgsl"),
            },
            texel: "",
            four: include_str!("../../shaders/flat_compare.wgsl"),
            tap: include_str!("../../shaders/flat_tap.wgsl"),
            hard: [TEXEL, include_str!("../../shaders/flat_hard.wgsl")],
            slope: include_str!("../../shaders/flat_slope.wgsl"),
            compare: "",
            hardware: include_str!("../../shaders/flat_hardware.wgsl"),
        }
    }

    fn cube(reads: Reads) -> Self {
        let (fetch, gather) = match reads.many_lights {
            false => (
                include_str!("../../shaders/cube_fetch.wgsl"),
                include_str!("../../shaders/cube_gather.wgsl"),
            ),
            true => (
                include_str!("../../shaders/cube_array_fetch.wgsl"),
                include_str!("../../shaders/cube_array_gather.wgsl"),
            ),
        };
        let gather = match reads.gather {
            true => gather,
            false => include_str!("../../shaders/cube_gather_fetches.wgsl"),
        };
        Self {
            reads,
            light: include_str!("../../shaders/cube_light.wgsl"),
            kind: "",
            receiver: include_str!("../../shaders/cube_receiver.wgsl"),
            depth: match reads.encoding {
                DepthEncoding::MajorAxis => include_str!("../../shaders/cube_major.wgsl"),
                DepthEncoding::LinearDistance => include_str!("../../shaders/cube_linear.wgsl"),
            },
            edge: "",
            fetch,
            gather,
            texel: include_str!("../../shaders/cube_texel.wgsl"),
            four: include_str!("../../shaders/cube_four.wgsl"),
            tap: CUBE_TAP,
            hard: [CUBE_TAP, include_str!("../../shaders/cube_hard.wgsl")],
            slope: include_str!("../../shaders/cube_slope.wgsl"),
            compare: match reads.many_lights {
                false => include_str!("../../shaders/cube_compare.wgsl"),
                true => include_str!("../../shaders/cube_array_compare.wgsl"),
            },
            hardware: include_str!("../../shaders/cube_hardware.wgsl"),
        }
    }

    /// Whether the map is an array with a cube for each light.
    pub fn many_lights(&self) -> bool {
        self.reads.many_lights
    }

    /// Kernels are written for one cube map, and are WGSL as they stand. On other maps they differ
    /// in the texture's type, and on flat ones in the names.
    pub fn adapt(&self, wgsl: &str) -> String {
        match (self.reads.map, self.reads.many_lights) {
            (MapKind::Cube, false) => wgsl.to_owned(),
            (MapKind::Cube, true) => wgsl
                .replace("texture_cube<f32>", "texture_cube_array<f32>")
                .replace("texture_depth_cube,", "texture_depth_cube_array,")
                .replace("texture_depth_cube;", "texture_depth_cube_array;"),
            (MapKind::Flat, _) => wgsl
                .replace("texture_cube<f32>", "texture_2d<f32>")
                .replace("texture_depth_cube", "texture_depth_2d")
                .replace("ShadowsCube", "ShadowsFlat")
                .replace("shadows_cube_", "shadows_flat_"),
        }
    }

    /// The same for a module with bindings, whose names have no kind in them for cube maps.
    pub fn adapt_module(&self, wgsl: &str) -> String {
        match self.reads.map {
            MapKind::Cube => self.adapt(wgsl),
            MapKind::Flat => {
                let plain = wgsl.replace("shadows_cube_", "shadows_");
                self.adapt(&plain).replace("shadows_", "shadows_flat_")
            }
        }
    }
}
