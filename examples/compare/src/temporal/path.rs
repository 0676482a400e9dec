//! What moves while shadows are watched: the light, the camera, or the picture alone.

use std::f32::consts::PI;

use shadows::glam::{Vec3, Vec4};

use host::scene::{Camera, Scene};

/// Texels along the map by which the light's steps are measured.
pub const TEXELS: f32 = 1024.0;
/// How far the light goes in a step, in such texels.
const LIGHT_STEP: f32 = 0.3;
/// How far the camera goes in the first step and in the last, in pixels.
const CAMERA_STEPS: [f32; 2] = [0.1, 1.0];

/// A way through a scene in small steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// The light goes sideways; the camera stands.
    Light,
    /// The camera goes sideways and nearer; the light stands.
    Camera,
    /// The picture moves by a pixel a step, as by a lens that is shifted, so that the pixels' centres
    /// see the same surface points again; the light stands.
    Pan,
}

/// Where everything is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    pub camera: Camera,
    pub light: Vec4,
    /// Of the picture, in pixels to the right and down.
    pub shift: [f32; 2],
}

impl Path {
    pub const ALL: [Self; 3] = [Self::Light, Self::Camera, Self::Pan];

    /// In reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Camera => "camera",
            Self::Pan => "pan",
        }
    }

    /// By how many pixels what is seen moves from a step to the next.
    pub fn moved(self) -> [i32; 2] {
        match self {
            Self::Light | Self::Camera => [0, 0],
            Self::Pan => [1, 0],
        }
    }

    /// The place after `step` of `steps` steps, in a picture of so many rows.
    pub fn place(self, scene: &Scene, rows: u32, step: u32, steps: u32) -> Place {
        let mut place = Place {
            camera: scene.camera,
            light: scene.light().place,
            shift: [0.0; 2],
        };
        match self {
            Self::Light => place.light = moved_light(scene, step),
            Self::Camera => place.camera = moved_camera(&scene.camera, rows, step, steps),
            Self::Pan => place.shift[0] = step as f32,
        }
        place
    }
}

/// On an arc sideways: from a point light's place, or by a directional light's angle.
fn moved_light(scene: &Scene, step: u32) -> Vec4 {
    let light = scene.light().place;
    let from_target = light.truncate() - light.w * scene.camera.target;
    // The side of a texel of a face that spans 90 degrees, at the light's distance.
    let texel = 2.0 * from_target.length() / TEXELS;
    let (aside, other) = from_target.normalize().any_orthonormal_pair();
    // A slow turn, so that steps have no direction that texels might share.
    let turn = PI * step as f32 / 256.0;
    let direction = turn.cos() * aside + turn.sin() * other;
    light + (LIGHT_STEP * step as f32 * texel * direction).extend(0.0)
}

/// Sideways in ever larger steps, a tenth of them forward.
fn moved_camera(camera: &Camera, rows: u32, step: u32, steps: u32) -> Camera {
    let forward = camera.target - camera.eye;
    let right = forward.cross(Vec3::Y).normalize();
    let pixel = 2.0 * (0.5 * camera.fovy).tan() * forward.length() / rows as f32;
    let [first, last] = CAMERA_STEPS;
    let length = |n: u32| first + (last - first) * n as f32 / steps.saturating_sub(1).max(1) as f32;
    let pixels: f32 = (0..step).map(length).sum();
    let moved = pixel * pixels * (right + 0.1 * forward.normalize());
    Camera {
        eye: camera.eye + moved,
        target: camera.target + moved,
        ..*camera
    }
}
