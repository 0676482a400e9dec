//! What other engines' lighting shaders do with a shadow map, written anew: for the cost of the same
//! operations and the error that they come to.

/// A receiver of another engine.
pub struct Peer {
    /// `cube/...` or `flat/...`: the kind of map, and whose.
    pub name: &'static str,
    wgsl: &'static str,
}

const LIGHTS: &str = "
struct PeerCubeLight { position: vec3f, near: f32, range: f32, size: f32 }
struct PeerFlatLight {
    clip_from_world: mat4x4f, toward_light: vec3f, texel: f32, size: f32
}
";

/// All of them. Each has `peer_visibility(position, normal, pixel)` and its map in group 1.
pub const PEERS: [Peer; 7] = [
    Peer {
        name: "cube/textbook",
        wgsl: include_str!("peers/cube_textbook.wgsl"),
    },
    Peer {
        name: "cube/bevy-2x2",
        wgsl: include_str!("peers/cube_bevy.wgsl"),
    },
    Peer {
        name: "cube/bevy-gaussian",
        wgsl: include_str!("peers/cube_bevy_gaussian.wgsl"),
    },
    Peer {
        name: "cube/three-pcf",
        wgsl: include_str!("peers/cube_three.wgsl"),
    },
    Peer {
        name: "flat/wgpu-example",
        wgsl: include_str!("peers/flat_wgpu.wgsl"),
    },
    Peer {
        name: "flat/bevy-2x2",
        wgsl: include_str!("peers/flat_bevy.wgsl"),
    },
    Peer {
        name: "flat/bevy-gaussian",
        wgsl: include_str!("peers/flat_bevy_castano.wgsl"),
    },
];

impl Peer {
    /// Its structs, bindings and functions.
    pub fn wgsl(&self) -> String {
        [LIGHTS, self.wgsl].concat()
    }
}
