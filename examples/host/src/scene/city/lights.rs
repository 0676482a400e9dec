//! The town's lights by night.

use shadows::glam::Vec3;

use super::super::{Camera, Cone, Light};

/// The most lights that are lit.
pub const MOST: usize = 1000;
/// How many lead the list: street lamps near what the camera looks at.
const FIRST: usize = 16;

/// What a light is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lamp {
    /// On a post in the street.
    Street,
    /// On a wall, or on a string over the square.
    Lantern,
    /// A room behind a window, as a spot out of it.
    Window,
    /// A small bulb.
    Bulb,
}

/// A light that there could be.
pub struct Candidate {
    pub lamp: Lamp,
    pub light: Light,
}

impl Candidate {
    /// A lamp at a place; `out` is the way out of a window.
    pub fn new(lamp: Lamp, position: Vec3, out: Vec3) -> Self {
        let (range, intensity, color) = match lamp {
            Lamp::Street => (19.0, 30.0, [1.0, 0.74, 0.43]),
            Lamp::Lantern => (9.0, 6.5, [1.0, 0.66, 0.33]),
            Lamp::Window => (10.0, 7.0, [1.0, 0.68, 0.36]),
            Lamp::Bulb => (4.5, 1.6, [1.0, 0.7, 0.4]),
        };
        let cone = (lamp == Lamp::Window).then_some(Cone {
            direction: out - 0.75 * Vec3::Y,
            half_angle: 0.75,
        });
        let light = Light {
            cone,
            color,
            intensity: Some(intensity),
            ..Light::new(position.extend(1.0), range)
        };
        Self { lamp, light }
    }
}

/// The lights that are lit: first the street lamps around what the camera looks at, then all the
/// others by their distance from the eye.
pub fn chosen(mut all: Vec<Candidate>, camera: &Camera) -> Vec<Light> {
    let place = |candidate: &Candidate| candidate.light.place.truncate();
    let ahead = camera.eye + 0.45 * (camera.target - camera.eye);
    all.sort_by(|a, b| {
        let order = |c: &Candidate| (c.lamp != Lamp::Street, place(c).distance(ahead));
        order(a).partial_cmp(&order(b)).expect("places are finite")
    });
    let streets = all.iter().filter(|c| c.lamp == Lamp::Street).count();
    let first = FIRST.min(streets);
    all[first..].sort_by(|a, b| {
        let distance = |c: &Candidate| place(c).distance(camera.eye);
        distance(a).total_cmp(&distance(b))
    });
    all.truncate(MOST);
    all.into_iter().map(|candidate| candidate.light).collect()
}
