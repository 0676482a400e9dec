//! A scene set up to be seen: on the GPU, with a renderer, and as exact geometry for the reference.

use std::sync::Arc;

use anyhow::Result;
use shadows::glam::{Mat4, Vec3, Vec4};
use shadows::mesh::Bounds;
use shadows::reference::{ReferenceImage, ReferenceScene};
use shadows::{DepthBounds, View};

use crate::shadow::{Shadow, ShadowInputs};
use crate::survey;
use host::exact;
use host::gpu::Gpu;
use host::renderer::{self, Look, Renderer};
use host::scene::{Camera, LightKind, Scene, homogeneous};
use host::scene_gpu::SceneGpu;

/// A scene, the targets it is drawn to, and what every technique is told about it.
pub struct Stage {
    pub scene: Scene,
    pub scene_gpu: SceneGpu,
    pub renderer: Renderer,
    pub inputs: ShadowInputs,
}

/// What one technique shows.
pub struct Picture {
    /// 255 lit, 0 in shadow; rows from the top.
    pub visibility: Vec<u8>,
    pub shaded: Vec<[u8; 3]>,
}

impl Stage {
    /// Uploads the scene and makes targets of `size` pixels.
    ///
    /// # Errors
    /// If something of it does not fit the device, or the camera makes no view.
    pub fn new(gpu: &Gpu, scene: Scene, size: [u32; 2]) -> Result<Self> {
        Self::with_look(gpu, scene, size, Look::default())
    }

    /// The same, drawn in another way.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_look(gpu: &Gpu, scene: Scene, size: [u32; 2], look: Look) -> Result<Self> {
        let view = renderer::view_as(&scene, size, look)?;
        let scene_gpu = SceneGpu::new(gpu, &scene)?;
        let renderer = Renderer::with_look(gpu, size, &scene, &scene_gpu, look)?;
        let inputs = ShadowInputs {
            view,
            light: homogeneous(scene.light().place),
            cone: scene.light().cone,
            near: scene.light().near,
            range: scene.light().range,
            casters: scene_gpu.casters.clone(),
            masked: match &scene_gpu.masked {
                Some(masked) => masked.casters.clone(),
                None => Vec::new(),
            },
            receivers: receivers(&scene),
            seen: seen(&scene),
            depths: depths(gpu, &renderer, &scene_gpu, &scene, &view),
            ground: survey::planar::ground(&scene),
            scene: Arc::new(scene.clone()),
        };
        Ok(Self {
            scene,
            scene_gpu,
            renderer,
            inputs,
        })
    }

    /// What a technique is told of one of the scene's lights.
    pub fn inputs_of(&self, light: usize) -> ShadowInputs {
        let light = &self.scene.lights[light];
        ShadowInputs {
            light: homogeneous(light.place),
            cone: light.cone,
            near: light.near,
            range: light.range,
            ..self.inputs.clone()
        }
    }

    /// One frame of a technique, told `inputs` (which a test may have falsified).
    ///
    /// # Errors
    /// If the technique refuses the inputs.
    pub fn picture(
        &self,
        gpu: &Gpu,
        shadow: &mut Shadow,
        inputs: &ShadowInputs,
    ) -> Result<Picture> {
        shadow.prepare(gpu, inputs)?;
        gpu.run(|encoder| {
            self.renderer.draw_ambient(encoder, &self.scene_gpu);
            shadow.generate(&self.renderer, &self.scene_gpu, encoder);
            shadow.shade(&self.renderer, &self.scene_gpu, encoder);
        });
        Ok(Picture {
            visibility: self.renderer.read_visibility(gpu),
            shaded: self.renderer.read_shaded(gpu),
        })
    }

    /// Moves the camera and the light; the picture then moves by `shift` pixels to the right and
    /// down, as by a lens that is shifted.
    ///
    /// # Errors
    /// If the camera makes no view.
    pub fn move_to(
        &mut self,
        gpu: &Gpu,
        camera: Camera,
        light: Vec4,
        shift: [f32; 2],
    ) -> Result<()> {
        self.scene.camera = camera;
        self.scene.light_mut().place = light;
        let (size, look) = (self.renderer.size(), self.renderer.look());
        let [right, down] = [0, 1].map(|axis| 2.0 * shift[axis] / size[axis] as f32);
        let shifted = Mat4::from_translation(Vec3::new(right, -down, 0.0));
        let matrix = shifted * renderer::matrix(&self.scene, size, look);
        self.inputs.view = View::new(matrix, look.depth)?;
        self.inputs.light = homogeneous(light);
        self.inputs.seen = seen(&self.scene);
        // What is read from the last frame's buffer is no more than a guess where the camera moves.
        self.inputs.depths = None;
        self.renderer.show(gpu, &self.scene, matrix);
        Ok(())
    }

    /// The exact answer; `progress` hears, from any thread, what part of it is done.
    ///
    /// # Errors
    /// If the scene is broken.
    pub fn reference(
        &self,
        progress: impl Fn(f64) + Send + Sync + 'static,
    ) -> Result<ReferenceImage> {
        self.reference_in(&self.reference_scene()?.with_progress(progress))
    }

    /// The objects as exact geometry.
    ///
    /// # Errors
    /// If the scene is broken.
    pub fn reference_scene(&self) -> Result<ReferenceScene> {
        Ok(exact::reference_scene(&self.scene)?)
    }

    /// The exact answer for the camera and the light as they are, in the scene's geometry.
    ///
    /// # Errors
    /// If the light is none.
    pub fn reference_in(&self, scene: &ReferenceScene) -> Result<ReferenceImage> {
        let [width, height] = self.renderer.size();
        if let Some(spot) = self.inputs.spot_light() {
            return Ok(scene.render_spot(&self.inputs.view, width, height, &spot)?);
        }
        let (light, range) = (self.inputs.light, self.inputs.light_range());
        Ok(scene.render(&self.inputs.view, width, height, light, range)?)
    }
}

impl Stage {
    /// The exact answer for one of the scene's lights, from the picture under another.
    ///
    /// # Errors
    /// If the light is none.
    pub fn relit(&self, other: &ReferenceImage, light: usize) -> Result<ReferenceImage> {
        let inputs = self.inputs_of(light);
        Ok(match inputs.spot_light() {
            Some(spot) => other.relit_by_spot(&spot)?,
            None => other.relit(inputs.light, inputs.light_range())?,
        })
    }
}

/// Between which depths the picture shows anything, for lights that can make use of it.
fn depths(
    gpu: &Gpu,
    renderer: &Renderer,
    scene_gpu: &SceneGpu,
    scene: &Scene,
    view: &View,
) -> Option<DepthBounds> {
    let mut lights = scene.lights.iter();
    match lights.any(|light| light.kind() == LightKind::Directional) {
        true => renderer.depth_bounds(gpu, scene_gpu, view),
        false => None,
    }
}

/// Bounds of all that is seen.
fn receivers(scene: &Scene) -> Bounds {
    let bounds = scene.bounds();
    Bounds {
        min: bounds.min.as_vec3(),
        max: bounds.max.as_vec3(),
    }
}

/// Distance along the camera's axis to the last of all corners, at least the near plane.
fn seen(scene: &Scene) -> f32 {
    let camera = &scene.camera;
    let axis = (camera.target - camera.eye).normalize();
    let Bounds { min, max } = receivers(scene);
    let farthest = Vec3::select(axis.cmpgt(Vec3::ZERO), max, min);
    axis.dot(farthest - camera.eye).max(camera.near)
}
