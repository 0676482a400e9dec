//! How the camera and the light are moved by hand.

use std::f32::consts::{PI, TAU};

use host::scene::{Camera, Light, LightKind, Scene};
use shadows::glam::{Quat, Vec2, Vec3, vec3};

/// How a camera moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Walk {
    /// Around what it looks at.
    Around,
    /// Turning where it stands, and ahead.
    Along,
}

/// Elevations to which cameras are kept, and the sun, in radians.
const STEEPEST: f32 = 1.45;
const LOWEST_SUN: f32 = 0.06;

/// Turns the camera by a drag, in heights of the picture, to the right and down.
pub fn turn_camera(camera: &mut Camera, walk: Walk, drag: Vec2) {
    let arm = camera.target - camera.eye;
    match walk {
        Walk::Around => {
            let turned = turned(-arm, -PI * drag.x, PI * drag.y, 0.02, STEEPEST);
            camera.eye = camera.target + turned;
        }
        Walk::Along => {
            // What is under the finger stays there.
            let angle = camera.fovy * drag;
            let turned = turned(arm, angle.x, angle.y, -STEEPEST, STEEPEST);
            camera.target = camera.eye + turned;
        }
    }
}

/// Brings the camera nearer, by a number of steps (below 0: away).
pub fn advance_camera(camera: &mut Camera, walk: Walk, steps: f32) {
    let arm = camera.target - camera.eye;
    match walk {
        Walk::Around => {
            let length = (arm.length() * 0.9_f32.powf(steps)).clamp(1.0, 60.0);
            camera.eye = camera.target - length * arm.normalize();
        }
        Walk::Along => {
            let way = steps * vec3(arm.x, 0.0, arm.z).normalize();
            camera.eye += way;
            camera.target += way;
        }
    }
}

/// Moves the light by a drag, in heights of the picture, to the right and down: a lamp as the pointer
/// does, across the picture; a sun over the sky. Lamps stay within `room` of where they hung at first.
pub fn drag_light(scene: &mut Scene, first: &Light, drag: Vec2) {
    let camera = scene.camera;
    let light = scene.light_mut();
    if light.kind() == LightKind::Directional {
        let sun = light.place.truncate();
        light.place = turned(sun, PI * drag.x, -PI * drag.y, LOWEST_SUN, STEEPEST).extend(0.0);
        return;
    }
    let ahead = (camera.target - camera.eye).normalize();
    let right = ahead.cross(Vec3::Y).normalize();
    let up = right.cross(ahead);
    let place = light.place.truncate();
    let depth = ahead.dot(place - camera.eye).max(camera.near);
    let height = 2.0 * depth * (0.5 * camera.fovy).tan();
    move_lamp(
        light,
        first,
        place + height * (drag.x * right - drag.y * up),
    );
}

/// Turns the light about the vertical, a lamp about what a spot in its place would look at.
pub fn turn_light(scene: &mut Scene, first: &Light, around: Vec3, angle: f32) {
    let turn = Quat::from_rotation_y(angle);
    let light = scene.light_mut();
    let place = light.place.truncate();
    if light.kind() == LightKind::Directional {
        light.place = (turn * place).extend(0.0);
    } else {
        move_lamp(light, first, around + turn * (place - around));
    }
}

/// Puts a lamp elsewhere, within its range of where it hung; a spot goes on looking at what it did.
fn move_lamp(light: &mut Light, first: &Light, place: Vec3) {
    let home = first.place.truncate();
    let place = home + (place - home).clamp_length_max(0.4 * first.range);
    if let (Some(cone), Some(before)) = (&mut light.cone, &first.cone) {
        let looks_at = home + before.direction;
        let direction = looks_at - place;
        if direction != Vec3::ZERO {
            cone.direction = direction;
        }
    }
    light.place = place.extend(1.0);
}

/// A vector turned to the right about the vertical, and up, with its elevation kept between two.
fn turned(vector: Vec3, right: f32, up: f32, least: f32, most: f32) -> Vec3 {
    let length = vector.length();
    let flat = vector.x.hypot(vector.z);
    let elevation = (vector.y.atan2(flat) + up).clamp(least, most);
    let azimuth = (vector.z.atan2(vector.x) + right).rem_euclid(TAU);
    let (sin, cos) = elevation.sin_cos();
    length * vec3(cos * azimuth.cos(), sin, cos * azimuth.sin())
}
