//! By which conventions other engines draw their shadow maps, and what their receivers are told.

use std::f32::consts::{FRAC_PI_2, SQRT_2};

use shadows::glam::camera::lh::view::look_to_mat4 as look_to_left_handed;
use shadows::glam::camera::{lh, rh};
use shadows::glam::{Mat3, Mat4, Vec3, Vec4};
use shadows::mesh::Bounds;
use shadows::wgpu;

use super::peers::{Engine, Peer, PeerLight};
use super::scene::Cone;
use super::warped::{Seen, warped};

/// The axis and the upper side of a cube's faces.
const FACES: [(Vec3, Vec3); 6] = [
    (Vec3::X, Vec3::Y),
    (Vec3::NEG_X, Vec3::Y),
    (Vec3::Y, Vec3::NEG_Z),
    (Vec3::NEG_Y, Vec3::Z),
    (Vec3::Z, Vec3::Y),
    (Vec3::NEG_Z, Vec3::Y),
];

/// How an engine draws.
pub struct Convention {
    pub format: wgpu::TextureFormat,
    /// 1 at the near plane; else 0 there.
    pub reverse: bool,
    /// Whether casters show the sides that look away from the light.
    pub far_sides: bool,
    /// Whether an open mesh casts by both sides: materials are set to what is better for the engine.
    pub open_both_sides: bool,
    pub near: f32,
    pub bias: wgpu::DepthBiasState,
    /// Whether casters before the near plane are drawn onto it.
    pub unclipped: bool,
}

impl Convention {
    /// The one by which a peer is drawn.
    pub fn of(peer: &Peer) -> Self {
        let usual = Self {
            format: wgpu::TextureFormat::Depth32Float,
            reverse: false,
            far_sides: false,
            open_both_sides: true,
            near: 0.1,
            bias: wgpu::DepthBiasState::default(),
            unclipped: false,
        };
        match peer.engine {
            Engine::Bevy => Self {
                reverse: true,
                unclipped: peer.light == PeerLight::Directional,
                ..usual
            },
            Engine::Three => Self {
                format: wgpu::TextureFormat::Depth24Plus,
                far_sides: true,
                open_both_sides: false,
                near: 0.5,
                ..usual
            },
            Engine::WgpuExample | Engine::Warped => Self {
                near: 1.0,
                bias: wgpu::DepthBiasState {
                    constant: 2,
                    slope_scale: 2.0,
                    clamp: 0.0,
                },
                unclipped: true,
                ..usual
            },
        }
    }

    /// Of depths, when casters are drawn and when a receiver compares.
    pub fn nearer_or_equal(&self) -> wgpu::CompareFunction {
        match self.reverse {
            true => wgpu::CompareFunction::GreaterEqual,
            false => wgpu::CompareFunction::LessEqual,
        }
    }

    /// Of a cube; with an end only where depth is not reversed.
    fn face(&self, range: f32) -> Mat4 {
        let angle = FRAC_PI_2;
        match self.reverse {
            true => lh::proj::directx::perspective_infinite_reverse(angle, 1.0, self.near),
            false => lh::proj::directx::perspective(angle, 1.0, self.near, range),
        }
    }
}

/// What it is told each frame.
pub struct PeerInputs {
    pub light: Vec4,
    pub cone: Option<Cone>,
    pub range: f32,
    /// All that casts or receives.
    pub bounds: Bounds,
    /// By what a warped map is fitted; without it that is a square around everything.
    pub seen: Option<Seen>,
}

/// An orthographic map of everything.
struct Sun {
    clip_from_world: Mat4,
    width: f32,
}

impl Convention {
    /// Clip from world space, for each face.
    pub fn faces(&self, peer: &Peer, inputs: &PeerInputs) -> Vec<Mat4> {
        let place = inputs.light.truncate();
        if peer.is_cube() {
            let face = |(axis, up)| self.face(inputs.range) * look_to_left_handed(place, axis, up);
            return FACES.map(face).to_vec();
        }
        vec![match inputs.cone {
            Some(cone) => self.spot(place, cone, inputs.range),
            None if peer.engine == Engine::Warped => {
                let seen = inputs.seen.as_ref();
                let warped = seen.and_then(|seen| warped(place, seen, &inputs.bounds));
                warped.unwrap_or_else(|| self.sun(inputs).clip_from_world)
            }
            None => self.sun(inputs).clip_from_world,
        }]
    }

    fn spot(&self, place: Vec3, cone: Cone, range: f32) -> Mat4 {
        let angle = 2.0 * cone.half_angle;
        let projection = match self.reverse {
            true => rh::proj::directx::perspective_infinite_reverse(angle, 1.0, self.near),
            false => rh::proj::directx::perspective(angle, 1.0, self.near, range),
        };
        let back = -cone.direction.normalize();
        projection * rotation(back) * Mat4::from_translation(-place)
    }

    /// A square around everything.
    fn sun(&self, inputs: &PeerInputs) -> Sun {
        let axes = rotation(inputs.light.truncate().normalize());
        let bounds = &inputs.bounds;
        let middle = 0.5 * (bounds.min + bounds.max);
        let half = 0.5 * (bounds.max - bounds.min);
        let reach = 1.001 * (Mat3::from_mat4(axes).abs() * half);
        let side = reach.x.max(reach.y);
        let (first, last) = match self.reverse {
            true => (reach.z, -reach.z),
            false => (-reach.z, reach.z),
        };
        let projection = rh::proj::directx::orthographic(-side, side, -side, side, first, last);
        Sun {
            clip_from_world: projection * axes * Mat4::from_translation(-middle),
            width: 2.0 * side,
        }
    }

    /// What the receiver is told, for a map of `size` texels.
    pub fn uniform(&self, peer: &Peer, inputs: &PeerInputs, size: u32) -> Vec<f32> {
        let place = inputs.light.truncate();
        let size = size as f32;
        match (peer.light, inputs.cone) {
            (PeerLight::Point, _) => self.cube_light(peer, place, inputs.range, size),
            (PeerLight::Spot, Some(cone)) => self.spot_light(place, cone, size),
            (_, cone) if cone.is_some() || peer.engine == Engine::Warped => {
                flat_light(self.faces(peer, inputs)[0], place, 0.0, size)
            }
            _ => {
                let Sun {
                    clip_from_world,
                    width,
                } = self.sun(inputs);
                flat_light(clip_from_world, place, width / size, size)
            }
        }
    }

    /// `PeerCubeLight`. Bevy: `shadow_depth_bias`, and `shadow_normal_bias` in texels of what is at a
    /// distance of 1, on the diagonal. three.js: `bias`, `radius` and `intensity`.
    fn cube_light(&self, peer: &Peer, place: Vec3, range: f32, size: f32) -> Vec<f32> {
        let [x, y, z] = place.to_array();
        let [bias, normal_bias] = match peer.engine {
            Engine::Bevy => [0.08, 0.6 * SQRT_2 * 2.0 / size],
            _ => [0.0, 0.0],
        };
        let (radius, intensity) = (1.0, 1.0);
        let near = self.near;
        [
            [x, y, z, range],
            // What of an infinite projection depth comes from.
            [0.0, -1.0, near, 0.0],
            [near, size, bias, normal_bias],
            [radius, intensity, 0.0, 0.0],
        ]
        .concat()
    }

    /// `PeerSpotLight`, the biases likewise.
    fn spot_light(&self, place: Vec3, cone: Cone, size: f32) -> Vec<f32> {
        let [x, y, z] = place.to_array();
        let direction = cone.direction.normalize();
        let down = f32::from_bits(u32::from(direction.y < 0.0));
        let tangent = cone.half_angle.tan();
        let normal_bias = 1.8 * SQRT_2 * 2.0 * tangent / size;
        [
            [x, y, z, self.near],
            [direction.x, direction.z, down, tangent],
            [size, 0.02, normal_bias, 0.0],
        ]
        .concat()
    }
}

/// `PeerFlatLight`: Bevy's `shadow_depth_bias`, and `shadow_normal_bias` in texels, on the diagonal.
fn flat_light(clip_from_world: Mat4, toward_light: Vec3, texel: f32, size: f32) -> Vec<f32> {
    let [x, y, z] = toward_light.normalize().to_array();
    let matrix = clip_from_world.to_cols_array();
    let rest = [x, y, z, texel, size, 0.02, 1.8 * SQRT_2, 0.0];
    [&matrix[..], &rest].concat()
}

/// To the axes that `peer_axes` has for a direction.
fn rotation(back: Vec3) -> Mat4 {
    let (x, y) = back.any_orthonormal_pair();
    Mat4::from_mat3(Mat3::from_cols(x, y, back).transpose())
}
