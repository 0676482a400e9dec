//! The kinds of shadow map that a sampler can read.

use super::text::TEXEL;
use crate::{CubeShadowMap, DepthEncoding, Radius, ShadowAtlas, ShadowMap};

const TILE_WHOLE: &str = include_str!("../../shaders/tile_whole.wgsl");
const CUBE_TEXEL: &str = include_str!("../../shaders/cube_texel.wgsl");

/// Which kind of map a [`PcfSampler`](super::PcfSampler) reads, and what its shader needs to know about it.
/// [`AnyMap::kind`] is the kind of a given map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MapKind {
    /// [`CubeShadowMap`]s with this encoding: point lights.
    Cube(DepthEncoding),
    /// [`ShadowMap`]s prepared for these lights: spots, directional lights or both.
    Flat(FlatLights),
    /// [`ShadowAtlas`]es, with lights of these kinds.
    Atlas(LightKinds),
}

impl MapKind {
    /// Cube maps with the default encoding: [`DepthEncoding::MajorAxis`].
    pub const CUBE: Self = Self::Cube(DepthEncoding::MajorAxis);
    /// Flat maps, prepared for any light.
    pub const FLAT: Self = Self::Flat(FlatLights::Any);
    /// Atlases, with lights of all kinds.
    pub const ATLAS: Self = Self::Atlas(LightKinds::ALL);

    /// What the texels hold. Flat maps and atlases know one encoding.
    pub(super) fn encoding(self) -> DepthEncoding {
        match self {
            Self::Cube(encoding) => encoding,
            Self::Flat(_) | Self::Atlas(_) => DepthEncoding::MajorAxis,
        }
    }

    /// Whether a sampler of this kind may read a map of another: which lights it is for is the sampler's own
    /// affair.
    pub(super) fn reads(self, map: Self) -> bool {
        match (self, map) {
            (Self::Cube(own), Self::Cube(given)) => own == given,
            (Self::Flat(_), Self::Flat(_)) | (Self::Atlas(_), Self::Atlas(_)) => true,
            _ => false,
        }
    }
}

impl Default for MapKind {
    fn default() -> Self {
        Self::CUBE
    }
}

/// Which kinds of light the receivers of an atlas support. Lights of other kinds appear dark, and add no code
/// to the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LightKinds {
    /// Point lights.
    pub point: bool,
    /// Spots.
    pub spot: bool,
    /// Directional lights.
    pub directional: bool,
}

impl LightKinds {
    /// All kinds.
    pub const ALL: Self = Self {
        point: true,
        spot: true,
        directional: true,
    };

    pub(super) fn is_empty(self) -> bool {
        !self.point && !self.is_flat()
    }

    /// Whether any has flat tiles.
    pub(super) fn is_flat(self) -> bool {
        self.spot || self.directional
    }

    fn flat_lights(self) -> FlatLights {
        match (self.spot, self.directional) {
            (true, false) => FlatLights::Spot,
            (false, true) => FlatLights::Directional,
            _ => FlatLights::Any,
        }
    }
}

impl Default for LightKinds {
    fn default() -> Self {
        Self::ALL
    }
}

/// Which kinds of light a sampler of flat maps supports. Supporting a single kind costs less
/// (docs/shader-cost.md).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FlatLights {
    /// Spots and directional lights, according to what the map was prepared for.
    #[default]
    Any,
    /// Spots only. With a map prepared for a directional light, everything is dark.
    Spot,
    /// Directional lights only. With a map prepared for a spot, everything is dark.
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

/// A map of any kind.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum AnyMap<'a> {
    /// A cube map.
    Cube(&'a CubeShadowMap),
    /// A flat map.
    Flat(&'a ShadowMap),
    /// An atlas.
    Atlas(&'a ShadowAtlas),
}

impl<'a> AnyMap<'a> {
    /// Which kind it is: what a sampler is made for that reads it, whichever its lights.
    pub fn kind(self) -> MapKind {
        match self {
            Self::Cube(map) => MapKind::Cube(map.encoding()),
            Self::Flat(_) => MapKind::FLAT,
            Self::Atlas(_) => MapKind::ATLAS,
        }
    }

    /// The widest kernels that it was made for.
    pub(super) fn reach(self) -> Radius {
        match self {
            Self::Cube(map) => map.reach(),
            Self::Flat(map) => map.reach(),
            Self::Atlas(map) => map.reach,
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

impl<'a> From<&'a ShadowAtlas> for AnyMap<'a> {
    fn from(map: &'a ShadowAtlas) -> Self {
        Self::Atlas(map)
    }
}

/// How shaders get at lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lights {
    /// One, in a uniform buffer.
    One,
    /// All of a map, in a storage buffer.
    Storage,
    /// The same in a uniform buffer, on devices without storage buffers.
    Uniform,
}

/// What a sampler is made to read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reads {
    pub map: MapKind,
    pub lights: Lights,
    /// Whether its sampler has a border of depth 0.
    pub border: bool,
    /// Whether squares of texels are gathered, or else fetched one by one.
    pub gather: bool,
}

/// The files that a kind of map brings along.
pub(super) struct MapWgsl {
    reads: Reads,
    /// Whether it is for spots and directional lights.
    is_flat: bool,
    /// Where the tiles of a light are.
    pub tile: &'static str,
    /// What kind of light is read, or of a cube its faces.
    pub kind: &'static str,
    pub receiver: &'static str,
    pub depth: &'static str,
    pub edge: &'static str,
    pub fetch: &'static str,
    pub gather: &'static str,
    pub texel: &'static str,
    pub four: &'static str,
    pub tap: &'static str,
    pub disk: &'static str,
    pub search: &'static str,
    /// All that [`Kernel::Hard`](super::Kernel::Hard) takes.
    pub hard: &'static [&'static str],
    pub slope: &'static str,
    pub hardware: &'static str,
}

impl MapWgsl {
    pub fn new(reads: Reads) -> Self {
        match reads.map {
            MapKind::Cube(_) | MapKind::Atlas(_) => Self::cube(reads),
            MapKind::Flat(lights) => Self::flat(reads, lights),
        }
    }

    /// The same for the flat tiles of an atlas with lights of these kinds.
    pub fn flat_tiles(reads: Reads, kinds: LightKinds) -> Self {
        Self::flat(reads, kinds.flat_lights())
    }

    fn tile(reads: Reads) -> &'static str {
        match reads.map {
            MapKind::Atlas(_) => include_str!("../../shaders/tile_placed.wgsl"),
            _ => TILE_WHOLE,
        }
    }

    fn flat(reads: Reads, lights: FlatLights) -> Self {
        Self {
            reads,
            tile: Self::tile(reads),
            is_flat: true,
            kind: lights.wgsl(),
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
            disk: include_str!("../../shaders/flat_disk.wgsl"),
            search: include_str!("../../shaders/flat_search.wgsl"),
            hard: &[include_str!("../../shaders/flat_hard.wgsl")],
            slope: include_str!("../../shaders/flat_slope.wgsl"),
            hardware: include_str!("../../shaders/flat_hardware.wgsl"),
        }
    }

    fn cube(reads: Reads) -> Self {
        Self {
            reads,
            tile: Self::tile(reads),
            is_flat: false,
            kind: include_str!("../../shaders/cube_face.wgsl"),
            receiver: include_str!("../../shaders/cube_receiver.wgsl"),
            depth: match reads.map.encoding() {
                DepthEncoding::MajorAxis => include_str!("../../shaders/cube_major.wgsl"),
                DepthEncoding::LinearDistance => include_str!("../../shaders/cube_linear.wgsl"),
            },
            edge: "",
            fetch: include_str!("../../shaders/cube_fetch.wgsl"),
            gather: match reads.gather {
                true => include_str!("../../shaders/cube_gather.wgsl"),
                false => include_str!("../../shaders/cube_gather_fetches.wgsl"),
            },
            texel: CUBE_TEXEL,
            four: include_str!("../../shaders/cube_four.wgsl"),
            tap: include_str!("../../shaders/cube_tap.wgsl"),
            disk: include_str!("../../shaders/cube_disk.wgsl"),
            search: include_str!("../../shaders/cube_search.wgsl"),
            hard: &[
                CUBE_TEXEL,
                TEXEL,
                include_str!("../../shaders/cube_hard.wgsl"),
            ],
            slope: include_str!("../../shaders/cube_slope.wgsl"),
            hardware: include_str!("../../shaders/cube_hardware.wgsl"),
        }
    }

    /// Kernels are written for cube maps, and are WGSL as they stand. On flat ones they differ in the
    /// names.
    pub fn adapt(&self, wgsl: &str) -> String {
        let own = [
            ("ShadowsCube", "ShadowsFlat"),
            ("shadows_cube_", "shadows_flat_"),
        ];
        // What cube maps and flat ones share: a shader may hold a sampler's module of each.
        let shared = [
            ("ShadowsLight", "ShadowsFlatLight"),
            ("ShadowsTile", "ShadowsFlatTile"),
            ("ShadowsKernel", "ShadowsFlatKernel"),
            ("shadows_kind", "shadows_flat_kind"),
            ("shadows_casts", "shadows_flat_casts"),
            ("shadows_tile", "shadows_flat_tile"),
        ];
        let own = own.iter().filter(|_| self.is_flat);
        let is_flat_map = matches!(self.reads.map, MapKind::Flat(_));
        let shared = shared.iter().filter(|_| is_flat_map);
        own.chain(shared)
            .fold(wgsl.to_owned(), |text, (from, to)| text.replace(from, to))
    }

    /// The same for a module with bindings, whose names have no kind in them for cube maps.
    pub fn adapt_module(&self, wgsl: &str) -> String {
        match self.reads.map {
            MapKind::Cube(_) | MapKind::Atlas(_) => self.adapt(wgsl),
            MapKind::Flat(_) => {
                let plain = wgsl.replace("shadows_cube_", "shadows_");
                self.adapt(&plain).replace("shadows_", "shadows_flat_")
            }
        }
    }
}
