//! A scene set up to be seen: on the GPU, with a renderer, and as exact geometry for the reference.

use anyhow::Result;
use shadows::HomogeneousLight;
use shadows::reference::ReferenceImage;

use crate::host::exact;
use crate::host::gpu::Gpu;
use crate::host::renderer::{self, Renderer};
use crate::host::scene::Scene;
use crate::host::scene_gpu::SceneGpu;
use crate::technique::{Shadow, ShadowInputs};

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
        let view = renderer::view(&scene, size)?;
        let scene_gpu = SceneGpu::new(gpu, &scene)?;
        let renderer = Renderer::new(gpu, size, &scene, &scene_gpu)?;
        let inputs = ShadowInputs {
            view,
            light: HomogeneousLight(scene.light),
            near: scene.shadow_near,
            range: scene.range,
            casters: scene_gpu.casters.clone(),
        };
        Ok(Self {
            scene,
            scene_gpu,
            renderer,
            inputs,
        })
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
            shadow.generate(&self.renderer, encoder);
            shadow.shade(&self.renderer, &self.scene_gpu, encoder);
        });
        Ok(Picture {
            visibility: self.renderer.read_visibility(gpu),
            shaded: self.renderer.read_shaded(gpu),
        })
    }

    /// The exact answer; `progress` hears, from any thread, what part of it is done.
    ///
    /// # Errors
    /// If the scene is broken.
    pub fn reference(
        &self,
        progress: impl Fn(f64) + Send + Sync + 'static,
    ) -> Result<ReferenceImage> {
        let [width, height] = self.renderer.size();
        let scene = exact::reference_scene(&self.scene)?.with_progress(progress);
        let (light, range) = (self.inputs.light, self.inputs.light_range());
        Ok(scene.render(&self.inputs.view, width, height, light, range)?)
    }
}
