//! What other engines' lighting shaders do with a shadow map, written anew: our rendition, to count what
//! it costs and to measure how wrong it is. Settings are those engines' defaults.
//!
//! From Bevy 0.20.1 (crates `bevy_pbr`, `bevy_light`), three.js r187 (`WebGLRenderer`) and the example
//! `shadow` of wgpu 30. `peer_map` draws the maps.

/// Whose arithmetic it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    Bevy,
    Three,
    WgpuExample,
    /// No engine's: the technique of a paper, with the rest of the wgpu example's.
    Warped,
}

/// The lights that it is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PeerLight {
    Point,
    Spot,
    Directional,
    /// Both by the same matrix.
    SpotOrDirectional,
}

/// How far from the receiver it reads texels.
#[derive(Clone, Copy, Debug)]
pub enum PeerReach {
    Texels(f32),
    /// Of a cube's face, in lengths of the way to its plane.
    Spread(f32),
}

/// A receiver of another engine.
#[derive(Debug)]
pub struct Peer {
    /// `cube/...` or `flat/...`: the kind of map, and whose.
    pub name: &'static str,
    pub engine: Engine,
    pub light: PeerLight,
    pub reach: PeerReach,
    wgsl: &'static [&'static str],
}

/// The uniforms. Projections are as the engine's own shaders have them.
const LIGHTS: &str = "
struct PeerCubeLight {
    position: vec3f, range: f32, projection: vec4f,
    near: f32, size: f32, bias: f32, normal_bias: f32, radius: f32, intensity: f32
}
struct PeerFlatLight {
    clip_from_world: mat4x4f, toward_light: vec3f, texel: f32,
    size: f32, bias: f32, normal_bias: f32
}
struct PeerSpotLight {
    position: vec3f, near: f32, direction_xz: vec2f, down: u32, tan_angle: f32,
    size: f32, bias: f32, normal_bias: f32
}
";

const AXES: &str = include_str!("peers/axes.wgsl");
const FLAT_BEVY: &str = include_str!("peers/flat_bevy_receiver.wgsl");
const FLAT_BEVY_SPOT: &str = include_str!("peers/flat_bevy_spot_receiver.wgsl");
const FILTER_2X2: &str = include_str!("peers/filter_2x2.wgsl");
const FILTER_CASTANO: &str = include_str!("peers/filter_castano.wgsl");

/// A filter of two texels across, and Castano's of six.
const BILINEAR: PeerReach = PeerReach::Texels(1.0);
const TENT: PeerReach = PeerReach::Texels(3.0);

/// All of them. Each has `peer_visibility(position, normal, pixel)` and its map in group 1.
pub static PEERS: [Peer; 8] = [
    Peer {
        name: "cube/bevy-2x2",
        engine: Engine::Bevy,
        light: PeerLight::Point,
        reach: BILINEAR,
        wgsl: &[include_str!("peers/cube_bevy.wgsl")],
    },
    Peer {
        name: "cube/bevy-gaussian",
        engine: Engine::Bevy,
        light: PeerLight::Point,
        // Its farthest tap, along an edge of the face's plane at the corner.
        reach: PeerReach::Spread(0.003 * 1.24 * 1.74),
        wgsl: &[include_str!("peers/cube_bevy_gaussian.wgsl"), AXES],
    },
    Peer {
        name: "cube/three-pcf",
        engine: Engine::Three,
        light: PeerLight::Point,
        // A radius of half a texel on the unit sphere, at the corner of a face.
        reach: PeerReach::Texels(2.5),
        wgsl: &[include_str!("peers/cube_three.wgsl")],
    },
    Peer {
        name: "flat/wgpu-example",
        engine: Engine::WgpuExample,
        light: PeerLight::SpotOrDirectional,
        reach: BILINEAR,
        wgsl: &[include_str!("peers/flat_wgpu.wgsl")],
    },
    Peer {
        name: "flat/bevy-2x2",
        engine: Engine::Bevy,
        light: PeerLight::Directional,
        reach: BILINEAR,
        wgsl: &[FLAT_BEVY, FILTER_2X2],
    },
    Peer {
        name: "flat/bevy-gaussian",
        engine: Engine::Bevy,
        light: PeerLight::Directional,
        reach: TENT,
        wgsl: &[FLAT_BEVY, FILTER_CASTANO],
    },
    Peer {
        name: "flat/bevy-spot-2x2",
        engine: Engine::Bevy,
        light: PeerLight::Spot,
        reach: BILINEAR,
        wgsl: &[FLAT_BEVY_SPOT, FILTER_2X2, AXES],
    },
    Peer {
        name: "flat/bevy-spot-gaussian",
        engine: Engine::Bevy,
        light: PeerLight::Spot,
        reach: TENT,
        wgsl: &[FLAT_BEVY_SPOT, FILTER_CASTANO, AXES],
    },
];

/// Light space perspective shadow maps (Wimmer, Scherzer and Purgathofer 2004; `warped`): what cascades are measured
/// against. Not one of [`PEERS`], as it costs what `flat/wgpu-example` costs.
pub static WARPED: Peer = Peer {
    name: "flat/lispsm",
    engine: Engine::Warped,
    light: PeerLight::Directional,
    reach: BILINEAR,
    wgsl: &[include_str!("peers/flat_wgpu.wgsl")],
};

/// The one of that name.
///
/// # Panics
/// If there is none.
pub fn peer(name: &str) -> &'static Peer {
    let found = PEERS.iter().find(|peer| peer.name == name);
    found.unwrap_or_else(|| panic!("no peer {name}"))
}

impl Peer {
    /// Its structs, bindings and functions.
    pub fn wgsl(&self) -> String {
        [LIGHTS, &self.wgsl.join("\n")].concat()
    }

    /// Whether it reads a cube.
    pub fn is_cube(&self) -> bool {
        self.light == PeerLight::Point
    }

    /// How far from a receiver it reads, in texels of a map of `size`.
    pub fn reach_in_texels(&self, size: u32) -> f32 {
        match self.reach {
            PeerReach::Texels(texels) => texels,
            PeerReach::Spread(spread) => 0.5 * spread * size as f32 + 1.0,
        }
    }
}
