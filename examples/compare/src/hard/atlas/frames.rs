//! What an atlas goes through, frame by frame, and the truth about it.

use anyhow::Result;
use shadows::glam::{DVec3, Mat4, Vec3};
use shadows::reference::{ReferenceImage, ReferenceScene};
use shadows::{
    AtlasLight, AtlasStatistics, Cascades, DirectionalLight, PointLight, ShadowAtlasDescriptor,
    SpotLight, TileSize, View,
};

use crate::hard::SIZE;
use host::exact;
use host::renderer::{self, Look};
use host::scene::{Camera, Light, LightKind, Scene, homogeneous};

/// One atlas and the frames that it is told, one after the other, of one scene.
pub struct Frames {
    /// What distinguishes them from the case's others.
    pub what: String,
    /// What is seen and casts. Lights and camera are those of each frame.
    pub scene: Scene,
    pub atlas: ShadowAtlasDescriptor<'static>,
    /// Pixels of each picture. Tiles get the sizes that [`SIZE`] asks for, whatever this is.
    pub size: [u32; 2],
    pub frames: Vec<Frame>,
    /// What must be so in one of the frames, and its name: else nothing was tried.
    pub came_about: Option<Sought>,
}

/// A name, and whether an atlas's statistics show it.
pub type Sought = (&'static str, fn(&AtlasStatistics) -> bool);

/// One of them.
#[derive(Clone)]
pub struct Frame {
    pub lights: Vec<Lamp>,
    /// At least one.
    pub views: Vec<Seen>,
    /// By how much every other caster is away from its place; none where it is judged.
    pub moved: Vec3,
    /// Whether its pictures are compared with the truth.
    pub judged: bool,
}

/// A light of an atlas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    pub light: Light,
    pub size: TileSize,
    /// Of directional lights.
    pub cascades: Cascades,
}

/// A camera and its lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    pub camera: Camera,
    pub look: Look,
    /// By how much the lens shifts the picture, to the right and up, in parts of its half.
    pub shift: [f32; 2],
}

impl Frames {
    /// The truth about each judged frame, each of its views and each of its lights.
    ///
    /// # Errors
    /// If the scene, a camera or a light is broken.
    pub fn truth(&self) -> Result<Vec<Vec<Vec<ReferenceImage>>>> {
        let exact = exact::reference_scene(&self.scene)?;
        let judged = self.frames.iter().filter(|frame| frame.judged);
        judged.map(|frame| frame.truth(&exact, self.size)).collect()
    }
}

impl Frame {
    /// One that is judged.
    pub fn new(lights: Vec<Lamp>, camera: Camera) -> Self {
        Self {
            lights,
            views: vec![Seen::by(camera)],
            moved: Vec3::ZERO,
            judged: true,
        }
    }

    /// The same, with nothing but its traces to be seen later.
    pub fn passing(mut self) -> Self {
        self.judged = false;
        self
    }

    fn truth(&self, exact: &ReferenceScene, size: [u32; 2]) -> Result<Vec<Vec<ReferenceImage>>> {
        let of_view = |seen: &Seen| {
            let view = (seen.view()?, size);
            let mut images: Vec<ReferenceImage> = Vec::new();
            for lamp in &self.lights {
                images.push(lamp.truth(exact, view, images.first())?);
            }
            Ok(images)
        };
        self.views.iter().map(of_view).collect()
    }
}

impl Lamp {
    /// With tiles of so many texels, whatever is seen.
    pub fn fixed(light: Light, texels: u32) -> Self {
        Self {
            light,
            size: TileSize::Fixed(texels),
            cascades: Cascades::default(),
        }
    }

    fn spot(&self) -> Option<SpotLight> {
        let Light {
            place, near, range, ..
        } = self.light;
        self.light.cone.map(|cone| SpotLight {
            position: place.truncate(),
            direction: cone.direction,
            half_angle: cone.half_angle,
            near,
            range,
        })
    }

    /// As the atlas takes it.
    pub fn of_atlas(&self) -> AtlasLight {
        let place = self.light.place.truncate();
        let light = match (self.light.kind(), self.spot()) {
            (_, Some(spot)) => AtlasLight::new(spot),
            (LightKind::Directional, _) => {
                AtlasLight::directional(DirectionalLight::new(place), self.cascades)
            }
            _ => AtlasLight::new(PointLight {
                near: self.light.near,
                ..PointLight::new(place, self.light.range)
            }),
        };
        light.with_size(self.size)
    }

    /// Where it is and how far it reaches; directional lights reach everything.
    pub fn reach(&self) -> Option<(DVec3, f32)> {
        let has_end = self.light.kind() != LightKind::Directional;
        has_end.then(|| (self.light.place.truncate().as_dvec3(), self.light.range))
    }

    /// What it lights, by the picture of another light of the view if there is one.
    fn truth(
        &self,
        exact: &ReferenceScene,
        (view, [width, height]): (View, [u32; 2]),
        other: Option<&ReferenceImage>,
    ) -> Result<ReferenceImage> {
        let (light, range) = (homogeneous(self.light.place), self.reach().map(|end| end.1));
        Ok(match (self.spot(), other) {
            (Some(spot), Some(other)) => other.relit_by_spot(&spot)?,
            (Some(spot), None) => exact.render_spot(&view, width, height, &spot)?,
            (None, Some(other)) => other.relit(light, range)?,
            (None, None) => exact.render(&view, width, height, light, range)?,
        })
    }
}

impl Seen {
    /// The usual lens.
    pub fn by(camera: Camera) -> Self {
        Self {
            camera,
            look: Look::default(),
            shift: [0.0; 2],
        }
    }

    /// A frame's lights as this sees them: those of the other views, too, so that each has the number that
    /// an atlas gives it in its view.
    pub fn scene(&self, of: &Scene, frame: &Frame) -> Scene {
        let lights = frame.lights.iter().map(|lamp| lamp.light);
        Scene {
            lights: lights
                .cycle()
                .take(frame.lights.len() * frame.views.len())
                .collect(),
            camera: self.camera,
            ..of.clone()
        }
    }

    /// Clip from world space.
    pub fn matrix(&self) -> Mat4 {
        let only_camera = Scene {
            camera: self.camera,
            ..Scene::empty("")
        };
        let [right, up] = self.shift;
        let shifted = Mat4::from_translation(Vec3::new(right, up, 0.0));
        shifted * renderer::matrix(&only_camera, SIZE, self.look)
    }

    /// # Errors
    /// If the camera's numbers make no view.
    pub fn view(&self) -> Result<View> {
        Ok(View::new(self.matrix(), self.look.depth)?)
    }
}
