//! The scenes under each kind of light: by day under the sun, by night under one lamp.

use host::scene::{self, Cone, Light, LightKind, Scene, Sky, Time};
use shadows::glam::{Vec3, vec3};

use crate::choice::Place;
use crate::motion::Walk;

/// Where the lamp hangs, and what it looks at as a spot.
struct Lamp {
    at: Vec3,
    aim: Vec3,
    range: f32,
    /// How bright a surface is that faces it a metre away.
    intensity: f32,
}

/// A scene in one light, and how the camera moves in it.
pub fn load(place: Place, kind: LightKind) -> (Scene, Walk) {
    let day = kind == LightKind::Directional;
    let (mut scene, lamp, walk) = match place {
        Place::Courtyard => courtyard(),
        Place::City => city(if day { Time::Day } else { Time::Night }),
        Place::Valley => valley(),
    };
    if day != (scene.light().kind() == LightKind::Directional) || place == Place::Courtyard {
        scene.sky = if day { DAY } else { NIGHT };
    }
    scene.lights = vec![match kind {
        LightKind::Directional if day && scene.light().place.w == 0.0 => *scene.light(),
        LightKind::Directional => sun(),
        LightKind::Point => lamp.light(None),
        LightKind::Spot => lamp.light(Some(Cone {
            direction: lamp.aim - lamp.at,
            half_angle: 0.7,
        })),
    }];
    (scene, walk)
}

fn courtyard() -> (Scene, Lamp, Walk) {
    let lamp = Lamp {
        at: vec3(0.43, 4.07, 0.86),
        aim: vec3(0.75, 0.0, -1.2),
        range: 40.0,
        intensity: 30.0,
    };
    (scene::courtyard(), lamp, Walk::Around)
}

fn city(time: Time) -> (Scene, Lamp, Walk) {
    let lamp = Lamp {
        at: vec3(-0.5, 5.8, 46.0),
        aim: vec3(1.0, 0.0, 40.0),
        range: 60.0,
        intensity: 60.0,
    };
    (scene::city(time), lamp, Walk::Along)
}

fn valley() -> (Scene, Lamp, Walk) {
    let scene = scene::valley();
    let ahead = (scene.camera.target - scene.camera.eye).normalize();
    let lamp = Lamp {
        at: scene.camera.eye + 22.0 * ahead + vec3(0.0, 4.0, 0.0),
        aim: scene.camera.eye + 25.0 * ahead - vec3(0.0, 2.0, 0.0),
        range: 80.0,
        intensity: 90.0,
    };
    (scene, lamp, Walk::Along)
}

impl Lamp {
    fn light(&self, cone: Option<Cone>) -> Light {
        Light {
            cone,
            color: [1.0, 0.83, 0.6],
            intensity: Some(self.intensity),
            ..Light::new(self.at.extend(1.0), self.range)
        }
    }
}

fn sun() -> Light {
    Light {
        color: [1.0, 0.93, 0.8],
        intensity: Some(2.2),
        ..Light::new(vec3(0.5, 0.75, 0.45).extend(0.0), 1.0)
    }
}

const DAY: Sky = Sky {
    horizon: [0.6, 0.71, 0.84],
    zenith: [0.13, 0.3, 0.66],
    ambient: [0.2, 0.235, 0.295],
    haze: 0.0011,
};

const NIGHT: Sky = Sky {
    horizon: [0.016, 0.02, 0.036],
    zenith: [0.0025, 0.004, 0.011],
    ambient: [0.03, 0.036, 0.055],
    haze: 0.0005,
};
