//! What most operations are tried on: `spheres`, 64 of them over a floor, at 640 x 360.

use anyhow::Result;
use shadows::glam::Vec3A;
use shadows::mesh::Bounds;
use shadows::{
    Caster, CubeShadowMap, CubeShadowMapDescriptor, DirectionalLight, FlatLight, HomogeneousLight,
    PointLight, SpotLight, View,
};

use host::gpu::Gpu;
use host::renderer::{self, Renderer};
use host::scene::{self, Scene, homogeneous};
use host::scene_gpu::SceneGpu;

pub const SIZE: [u32; 2] = [640, 360];

pub struct Stage<'a> {
    pub gpu: &'a Gpu,
    pub scene: Scene,
    pub scene_gpu: SceneGpu,
    pub host: Renderer,
    pub view: View,
    pub receivers: Bounds,
}

impl<'a> Stage<'a> {
    /// With the scene's depth and ambient light drawn.
    pub fn new(gpu: &'a Gpu) -> Result<Self> {
        let scene = scene::spheres();
        let scene_gpu = SceneGpu::new(gpu, &scene)?;
        let host = Renderer::new(gpu, SIZE, &scene, &scene_gpu)?;
        gpu.run(|encoder| host.draw_ambient(encoder, &scene_gpu));
        let all = scene.bounds();
        Ok(Self {
            receivers: Bounds {
                min: all.min.as_vec3(),
                max: all.max.as_vec3(),
            },
            view: renderer::view(&scene, SIZE)?,
            gpu,
            scene,
            scene_gpu,
            host,
        })
    }

    pub fn casters(&self) -> Vec<Caster> {
        self.scene_gpu.casters.clone()
    }

    pub fn light(&self) -> HomogeneousLight {
        homogeneous(self.scene.light().place)
    }

    pub fn point(&self) -> PointLight {
        PointLight::new(
            self.scene.light().place.truncate(),
            self.scene.light().range,
        )
    }

    /// From the scene's light at what the camera looks at.
    pub fn spot(&self) -> SpotLight {
        let PointLight {
            position, range, ..
        } = self.point();
        let direction = self.scene.camera.target - position;
        SpotLight::new(position, direction, std::f32::consts::FRAC_PI_4, range)
    }

    /// The flat maps' lights and their names.
    pub fn flat_lights(&self) -> [(&'static str, FlatLight); 2] {
        let spot = self.spot();
        [
            ("spot", FlatLight::Spot(spot)),
            (
                "directional",
                FlatLight::Directional(DirectionalLight::new(-spot.direction)),
            ),
        ]
    }

    pub fn cube_map(&self, cache: bool) -> Result<CubeShadowMap> {
        let descriptor = CubeShadowMapDescriptor {
            cache,
            ..Default::default()
        };
        Ok(CubeShadowMap::new(&self.gpu.device, &descriptor)?)
    }
}

/// What moves before a frame.
pub type Move = fn(&mut [Caster]);

/// Moves casters a little: some thousand times, and they are still where they were, more or less.
pub fn nudge(casters: &mut [Caster]) {
    for caster in casters {
        caster.world_from_object.translation += Vec3A::splat(1e-4);
    }
}
