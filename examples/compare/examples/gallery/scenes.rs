//! The courtyard by day and by night.

use host::scene::surface::Surface;
use host::scene::{Cone, Light, Object, Scene, Sky, courtyard};
use shadows::glam::{Affine3A, Vec3, vec3};

/// Where the sun stands, as an angle from the x axis to the z axis, in radians.
pub const MORNING: f32 = 2.8;
/// How high it stands: the tangent of its elevation.
const HEIGHT: f32 = 1.1;

/// By the sun.
pub fn day(azimuth: f32) -> Scene {
    let mut scene = courtyard();
    let toward = vec3(azimuth.cos(), HEIGHT, azimuth.sin());
    scene.sky = Sky {
        horizon: [0.6, 0.71, 0.84],
        zenith: [0.13, 0.3, 0.66],
        ambient: [0.2, 0.235, 0.295],
        haze: 0.0011,
    };
    scene.lights = vec![Light {
        color: [1.0, 0.93, 0.8],
        intensity: Some(2.2),
        ..Light::new(toward.extend(0.0), 1.0)
    }];
    scene
}

const CANDLE: [f32; 3] = [1.0, 0.62, 0.3];
const COOL: [f32; 3] = [0.55, 0.72, 1.0];
const RED: [f32; 3] = [1.0, 0.36, 0.26];

/// Under sixteen lights: a lantern in each bay of the arcades, lamps on the stairs and the terrace, behind the
/// fence and over the court, and two spots.
pub fn night() -> Scene {
    let mut scene = courtyard();
    scene.sky = Sky {
        horizon: [0.016, 0.02, 0.036],
        zenith: [0.0025, 0.004, 0.011],
        ambient: [0.022, 0.027, 0.042],
        haze: 0.0005,
    };
    let back = (0..6).map(|bay| vec3(-7.5 + 3.0 * bay as f32, 2.9, -7.5));
    let side = (0..3).map(|bay| vec3(-10.6, 2.9, -4.5 + 3.0 * bay as f32));
    let lanterns = back.chain(side).map(|at| lamp(at, CANDLE, 2.6, 9.0));
    let lamps = [
        lamp(vec3(0.43, 4.6, 1.4), [1.0, 0.8, 0.55], 7.0, 30.0),
        lamp(vec3(4.0, 1.75, -3.5), RED, 2.2, 10.0),
        lamp(vec3(11.2, 4.1, -1.6), CANDLE, 4.0, 14.0),
        lamp(vec3(-5.4, 1.1, 3.2), COOL, 1.6, 9.0),
        lamp(vec3(3.9, 1.3, 3.5), [0.6, 1.0, 0.75], 1.5, 8.0),
    ];
    let spots = [
        spot(vec3(-7.6, 4.4, 2.9), vec3(-2.6, 0.3, 0.9), COOL, 22.0),
        spot(
            vec3(9.4, 5.2, 3.9),
            vec3(4.6, 0.0, 4.6),
            [1.0, 0.75, 0.9],
            20.0,
        ),
    ];
    scene.lights = lanterns.chain(lamps).chain(spots).collect();
    bulbs(&mut scene);
    scene
}

fn lamp(at: Vec3, color: [f32; 3], intensity: f32, range: f32) -> Light {
    Light {
        color,
        intensity: Some(intensity),
        ..Light::new(at.extend(1.0), range)
    }
}

fn spot(at: Vec3, target: Vec3, color: [f32; 3], intensity: f32) -> Light {
    Light {
        cone: Some(Cone {
            direction: target - at,
            half_angle: 0.42,
        }),
        ..lamp(at, color, intensity, 20.0)
    }
}

/// A ball at each light, which gives light and casts no shadow.
fn bulbs(scene: &mut Scene) {
    let ball = scene.add_mesh(Surface::lump(2, |_| 0.07).finish("bulb", 60.0));
    for light in scene.lights.clone() {
        scene.objects.push(Object {
            name: "bulb".into(),
            mesh: ball,
            transform: Affine3A::from_translation(light.place.truncate()),
            casts: false,
            albedo: [0.0; 3],
            glow: light.color,
        });
    }
}
