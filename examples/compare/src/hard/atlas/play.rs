//! Draws an atlas's frames, and judges what they show.

use anyhow::{Result, ensure};
use shadows::glam::Vec3A;
use shadows::reference::ReferenceImage;
use shadows::{
    AtlasFrame, AtlasLight, AtlasView, CascadeFit, Caster, Kernel, PcfSampler, ShadowAtlas, View,
};

use super::frames::{Frame, Frames, Lamp, Seen};
use super::resolution::Resolution;
use crate::hard::SIZE;
use crate::hard::expect::Expect;
use crate::hard::judge::{Lit, judge_found};
use crate::hard::outcome::Outcome;
use crate::technique::{Config, Technique};
use host::gpu::Gpu;
use host::interior::radius_in_texels;
use host::pipelines::visibility_module;
use host::renderer::{LitPipeline, Renderer, ShadowAccess};
use host::scene::{Bounds, LightKind};
use host::scene_gpu::SceneGpu;

/// What a light shows in one view of one judged frame.
pub struct Shown {
    /// Its place among the judged frames, among the frame's views and among its lights.
    pub at: [usize; 3],
    pub lamp: Lamp,
    /// 255 lit.
    pub visibility: Vec<u8>,
    /// Under the lights up to this one.
    pub shaded: Vec<[u8; 3]>,
    resolution: Resolution,
}

impl Shown {
    /// Judges a picture of the light, its own or what a test puts in its place.
    ///
    /// # Errors
    /// If the picture does not fit the reference.
    pub fn judge(
        &self,
        what: &str,
        truth: &[Vec<Vec<ReferenceImage>>],
        visibility: &[u8],
        expect: Expect,
    ) -> Result<Outcome> {
        let [frame, view, light] = self.at;
        let reference = &truth[frame][view][light];
        let what = format!("{what}, frame {frame}, view {view}, light {light}");
        let found = self.resolution.compare(reference, visibility)?;
        let lit = Lit {
            visibility,
            may_wrap: false,
            reach: self.lamp.reach(),
        };
        Ok(judge_found(&what, reference, &found, &lit, expect))
    }
}

/// What every light shows in each judged frame, read as the technique reads an atlas but for a change of the
/// shader, which is a test's. What did not change between frames is kept.
///
/// # Errors
/// If the technique is no atlas's, a frame is refused, or what was to come about did not.
pub fn play(
    gpu: &Gpu,
    frames: &Frames,
    technique: &Technique,
    change: fn(String) -> String,
) -> Result<Vec<Shown>> {
    let mut player = Player::new(gpu, frames, technique, change)?;
    let mut shown = Vec::new();
    let mut came_about = frames.came_about.is_none();
    let mut judged = 0;
    for frame in &frames.frames {
        player.prepare(frame)?;
        let statistics = player.atlas.statistics();
        came_about |= frames.came_about.is_some_and(|(_, came)| came(&statistics));
        if !frame.judged {
            gpu.run(|encoder| player.atlas.encode(encoder));
            continue;
        }
        shown.extend(player.pictures(frame, judged)?);
        judged += 1;
    }
    let what = frames.came_about.map_or("", |(what, _)| what);
    ensure!(came_about, "{}: {what} did not come about", frames.what);
    Ok(shown)
}

struct Player<'a> {
    gpu: &'a Gpu,
    frames: &'a Frames,
    scene: SceneGpu,
    atlas: ShadowAtlas,
    sampler: PcfSampler,
    kernel: Kernel,
    module: String,
}

/// A view's targets, and the pass that lights them.
struct Screen {
    renderer: Renderer,
    lit: LitPipeline,
}

impl<'a> Player<'a> {
    fn new(
        gpu: &'a Gpu,
        frames: &'a Frames,
        technique: &Technique,
        change: fn(String) -> String,
    ) -> Result<Self> {
        let Config::Atlas { sampler, .. } = &technique.config else {
            anyhow::bail!("{} has no atlas", technique.name);
        };
        let kernel = sampler.kernel;
        let sampler = PcfSampler::new(&gpu.device, &gpu.queue, sampler)?;
        Ok(Self {
            gpu,
            frames,
            scene: SceneGpu::new(gpu, &frames.scene)?,
            atlas: ShadowAtlas::new(&gpu.device, &frames.atlas)?,
            kernel,
            module: change(visibility_module(&sampler)),
            sampler,
        })
    }

    fn prepare(&mut self, frame: &Frame) -> Result<()> {
        let lights: Vec<AtlasLight> = frame.lights.iter().map(Lamp::of_atlas).collect();
        let mut casters: Vec<Caster> = self.scene.casters.clone();
        for caster in casters.iter_mut().skip(1).step_by(2) {
            caster.world_from_object.translation += Vec3A::from(frame.moved);
        }
        let views: Vec<View> = frame.views.iter().map(Seen::view).collect::<Result<_>>()?;
        let [width, height] = SIZE;
        let views = views.iter().map(|view| AtlasView::new(view, width, height));
        let views: Vec<AtlasView<'_>> = views.collect();
        let Bounds { min, max } = self.frames.scene.bounds();
        let of = AtlasFrame {
            lights: &lights,
            casters: &casters,
            views: &views,
            receivers: Some(shadows::mesh::Bounds {
                min: min.as_vec3(),
                max: max.as_vec3(),
            }),
        };
        Ok(self.atlas.prepare(&self.gpu.device, &self.gpu.queue, &of)?)
    }

    /// Of every light in every view. All views of a light are drawn in one submission, with the first light's the
    /// tiles.
    fn pictures(&mut self, frame: &Frame, judged: usize) -> Result<Vec<Shown>> {
        let screens = frame.views.iter().map(|seen| self.screen(frame, seen));
        let screens: Vec<Screen> = screens.collect::<Result<_>>()?;
        let group = self.sampler.bind_group(&self.gpu.device, &self.atlas)?;
        let (gpu, scene, atlas) = (self.gpu, &self.scene, &mut self.atlas);
        let mut shown = Vec::new();
        for light in 0..frame.lights.len() {
            gpu.run(|encoder| {
                if light == 0 {
                    atlas.encode(encoder);
                }
                for (view, Screen { renderer, lit }) in screens.iter().enumerate() {
                    if light == 0 {
                        renderer.draw_ambient(encoder, scene);
                    }
                    let number = atlas.light_index(light, view) as usize;
                    renderer.draw_lit_by(encoder, scene, number, lit, Some(&group));
                }
            });
            for (view, Screen { renderer, .. }) in screens.iter().enumerate() {
                shown.push(Shown {
                    at: [judged, view, light],
                    lamp: frame.lights[light],
                    visibility: renderer.read_visibility(gpu),
                    shaded: renderer.read_shaded(gpu),
                    resolution: resolution(atlas, &frame.lights[light], [light, view], self.kernel),
                });
            }
        }
        Ok(shown)
    }

    fn screen(&self, frame: &Frame, seen: &Seen) -> Result<Screen> {
        let scene = seen.scene(&self.frames.scene, frame);
        let mut renderer =
            Renderer::with_look(self.gpu, self.frames.size, &scene, &self.scene, seen.look)?;
        renderer.show(self.gpu, &scene, seen.matrix());
        let access = ShadowAccess {
            module: Some(&self.module),
            layout: Some(self.sampler.bind_group_layout()),
            ..Default::default()
        };
        let lit = renderer.lit_pipeline(self.gpu, &access);
        Ok(Screen { renderer, lit })
    }
}

fn resolution(
    atlas: &ShadowAtlas,
    lamp: &Lamp,
    [light, view]: [usize; 2],
    kernel: Kernel,
) -> Resolution {
    let tiles = atlas.tiles(light, view);
    let half = tiles.first().map_or(0.0, |tile| 0.5 * f64::from(tile.size));
    let (kind, cascades) = (lamp.light.kind(), &lamp.cascades);
    Resolution {
        kind,
        kernel_radius: radius_in_texels(kernel),
        band: match cascades.fit {
            _ if cascades.blend == 0.0 => 0.0,
            // As wide to each side as it reaches far, or wider.
            CascadeFit::Stable => f64::from(cascades.blend) * half,
            // Its slice may be longer than it is wide.
            _ => f64::INFINITY,
        },
        // Only directional lights have tiles of their own for each view.
        tiles: match kind {
            LightKind::Directional => tiles,
            _ => atlas.tiles(light, 0),
        },
    }
}
