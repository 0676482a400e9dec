//! A scene as it is seen: on the GPU, and what methods are told of it each frame.

use anyhow::Result;
use host::gpu::Gpu;
use host::renderer;
use host::scene::{self, Light, LightKind, Scene};
use host::scene_gpu::SceneGpu;
use shadows::glam::{Vec2, Vec3};
use shadows::mesh::Bounds;
use shadows::{Caster, DirectionalLight, FlatLight, HomogeneousLight, PointLight, SpotLight, View};

use crate::choice::Place;
use crate::motion::{self, Walk};
use crate::places;

/// The scene, its light and its camera.
pub struct World {
    pub place: Place,
    pub scene: Scene,
    pub scene_gpu: SceneGpu,
    pub receivers: Bounds,
    walk: Walk,
    first_light: Light,
    /// Around what the light is turned.
    middle: Vec3,
}

/// What a method is told of a frame.
pub struct Inputs<'a> {
    pub view: View,
    pub light: Light,
    pub casters: &'a [Caster],
    /// Everything that receives, world space.
    pub receivers: Bounds,
    /// Up to where along the camera's axis there is something to see.
    pub seen: f32,
    /// Pixels of the picture.
    pub size: [u32; 2],
}

impl World {
    /// Makes the scene and uploads it.
    ///
    /// # Errors
    /// If something of it does not fit the device.
    pub fn new(gpu: &Gpu, place: Place, kind: LightKind) -> Result<Self> {
        let (scene, walk) = places::load(place, kind);
        let bounds = scene.bounds();
        let ahead = scene.camera.target - scene.camera.eye;
        let middle = match walk {
            Walk::Around => scene.camera.target,
            Walk::Along => scene.camera.eye + 20.0 * ahead.normalize(),
        };
        Ok(Self {
            place,
            scene_gpu: SceneGpu::new(gpu, &scene)?,
            receivers: Bounds {
                min: bounds.min.as_vec3(),
                max: bounds.max.as_vec3(),
            },
            walk,
            first_light: *scene.light(),
            middle,
            scene,
        })
    }

    /// What methods are told of a picture of so many pixels.
    ///
    /// # Errors
    /// If the camera makes no view.
    pub fn inputs(&self, size: [u32; 2]) -> Result<Inputs<'_>> {
        let camera = &self.scene.camera;
        let axis = (camera.target - camera.eye).normalize();
        let Bounds { min, max } = self.receivers;
        let farthest = Vec3::select(axis.cmpgt(Vec3::ZERO), max, min);
        Ok(Inputs {
            view: renderer::view(&self.scene, size)?,
            light: *self.scene.light(),
            casters: &self.scene_gpu.casters,
            receivers: self.receivers,
            seen: axis.dot(farthest - camera.eye).max(camera.near),
            size,
        })
    }

    /// Which kind of light it is.
    pub fn light_kind(&self) -> LightKind {
        self.scene.light().kind()
    }

    /// Turns the camera by a drag, in heights of the picture.
    pub fn turn_camera(&mut self, drag: Vec2) {
        motion::turn_camera(&mut self.scene.camera, self.walk, drag);
    }

    /// Brings the camera nearer.
    pub fn advance_camera(&mut self, steps: f32) {
        motion::advance_camera(&mut self.scene.camera, self.walk, steps);
    }

    /// Moves the light by a drag, in heights of the picture.
    pub fn drag_light(&mut self, drag: Vec2) {
        motion::drag_light(&mut self.scene, &self.first_light, drag);
    }

    /// Turns the light about the vertical, in radians.
    pub fn turn_light(&mut self, angle: f32) {
        motion::turn_light(&mut self.scene, &self.first_light, self.middle, angle);
    }

    /// Where a picture of so many pixels shows the lamp, in parts of its width and height from the top
    /// left; `None` if it does not, or if there is only a sun.
    pub fn lamp_on_screen(&self, size: [u32; 2]) -> Option<[f32; 2]> {
        let matrix = renderer::view(&self.scene, size).ok()?.clip_from_world();
        let place = self.scene.light().place;
        let clip = matrix * place;
        let at = [0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w];
        let inside = at.iter().all(|at| (0.0..=1.0).contains(at));
        (place.w != 0.0 && clip.w > 0.0 && inside).then_some(at)
    }
}

impl Inputs<'_> {
    /// The light as shadow volumes take it.
    pub fn homogeneous(&self) -> HomogeneousLight {
        scene::homogeneous(self.light.place)
    }

    /// The light's end; a sun has none.
    pub fn range(&self) -> Option<f32> {
        (self.light.kind() != LightKind::Directional).then_some(self.light.range)
    }

    /// The light without its cone.
    pub fn point(&self) -> PointLight {
        PointLight::new(self.light.place.truncate(), self.light.range)
    }

    /// The light as a spot, if it is one.
    pub fn spot(&self) -> Option<SpotLight> {
        spot(&self.light)
    }

    /// The spot or the sun.
    pub fn flat(&self) -> FlatLight {
        match self.spot() {
            Some(spot) => FlatLight::Spot(spot),
            None => FlatLight::Directional(self.sun()),
        }
    }

    /// The light as a sun.
    pub fn sun(&self) -> DirectionalLight {
        DirectionalLight::new(self.light.place.truncate())
    }
}

/// The light as a spot, if it is one.
pub fn spot(light: &Light) -> Option<SpotLight> {
    light.cone.map(|cone| SpotLight {
        position: light.place.truncate(),
        direction: cone.direction,
        half_angle: cone.half_angle,
        near: light.near,
        range: light.range,
    })
}
