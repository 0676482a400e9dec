//! Everything that this application adds to have shadows: objects made once for a choice of
//! settings, and the same three verbs each frame whatever was chosen.

use anyhow::Result;
use shadows::reference::Interior;
use shadows::wgpu;
use shadows::{
    AtlasDebug, AtlasDebugDescriptor, AtlasFrame, AtlasLight, AtlasView, Bias, Cascades, Caster,
    CubeCross, CubeCrossDescriptor, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor,
    DirectionalLight, FlatLight, HomogeneousLight, Kernel, MapKind, MapSettings, PcfDescriptor,
    PcfSampler, PointLight, ShadowAtlas, ShadowAtlasDescriptor, ShadowFrame, ShadowMap,
    ShadowMapDescriptor, ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer, TileSize,
    View, VolumeDebug, VolumeDebugDescriptor, VolumeLight, VolumeSurvey, VolumeView,
};

use crate::statistics::{self, Rows};
use host::gpu::Gpu;
use host::interior;
use host::pipelines::{DEPTH, SHADED, ShadowAccess, visibility_module};
use host::renderer::{LitPipeline, Renderer};
use host::scene_gpu::SceneGpu;

/// How shadows are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Technique {
    /// A cube map for a point light, a flat one for a directional light.
    Map,
    /// An atlas, as for all lights of a scene; a directional light has four cascades.
    Atlas,
    /// Stencil shadow volumes.
    Volumes,
    /// No shadows.
    None,
}

/// What objects are made for. With other settings, others are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    pub technique: Technique,
    /// Whether the light is infinitely far away.
    pub directional: bool,
    pub kernel: Kernel,
    /// In texels.
    pub bias: Bias,
    /// Texels along a side of the map.
    pub size: u32,
}

impl Settings {
    /// What maps of all kinds are told.
    fn of_maps(&self) -> MapSettings {
        MapSettings {
            bias: self.bias,
            reach: self.kernel.radius(),
            ..Default::default()
        }
    }
}

/// What may be shown of how shadows come about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DebugView {
    /// The cube map, unfolded.
    Cross,
    /// The layers of the atlas.
    Tiles,
    /// Surfaces of the volumes, with their silhouette edges.
    Surfaces,
    /// Stencil counts as colours.
    Counts,
    /// Casters by what was decided for them.
    Casters,
}

/// What is told each frame.
pub struct Frame<'a> {
    pub view: View,
    pub light: HomogeneousLight,
    pub range: f32,
    pub casters: &'a [Caster],
    /// Pixels of the picture.
    pub size: [u32; 2],
    /// What is to be shown, if the technique has it.
    pub debug: Option<DebugView>,
}

/// Shadows of one light, by one technique.
pub struct Shadows {
    lit: LitPipeline,
    means: Means,
}

enum Means {
    Cube(Box<Cube>),
    Atlas(Box<Atlas>),
    Flat(Box<ShadowMap>, wgpu::BindGroup),
    Volumes(Box<Volumes>),
    None,
}

struct Cube {
    map: CubeShadowMap,
    cross: CubeCross,
    /// What the lit pass reads, and what the cross does.
    group: wgpu::BindGroup,
    cross_group: wgpu::BindGroup,
}

struct Atlas {
    atlas: ShadowAtlas,
    sampler: PcfSampler,
    /// What the lit pass reads, and the revision that it is for.
    group: (u64, wgpu::BindGroup),
    /// Texels along a tile.
    size: u32,
    debug: AtlasDebug,
}

struct Volumes {
    renderer: ShadowVolumeRenderer,
    debug: VolumeDebug,
    shown: Option<DebugView>,
    /// Of the last frame that had a debug view: it takes too long for every frame.
    survey: Option<(View, HomogeneousLight, [u32; 2], VolumeSurvey)>,
}

impl Shadows {
    /// `window` is the format of egui's own pass, into which the cube cross is drawn.
    ///
    /// # Errors
    /// If a setting is out of its range, or the device cannot do it.
    pub fn new(
        gpu: &Gpu,
        renderer: &Renderer,
        window: wgpu::TextureFormat,
        settings: &Settings,
    ) -> Result<Self> {
        match (settings.technique, settings.directional) {
            (Technique::Map, false) => Self::cube(gpu, renderer, window, settings),
            (Technique::Map, true) => Self::flat(gpu, renderer, settings),
            (Technique::Atlas, _) => Self::atlas(gpu, renderer, window, settings),
            (Technique::Volumes, _) => Self::volumes(gpu, renderer),
            (Technique::None, _) => Ok(Self {
                lit: renderer.lit_pipeline(gpu, &ShadowAccess::default()),
                means: Means::None,
            }),
        }
    }

    fn cube(
        gpu: &Gpu,
        renderer: &Renderer,
        window: wgpu::TextureFormat,
        settings: &Settings,
    ) -> Result<Self> {
        let map = CubeShadowMapDescriptor {
            size: settings.size,
            settings: settings.of_maps(),
            ..Default::default()
        };
        let sampler = sampler(gpu, settings, MapKind::CUBE)?;
        let cross = CubeCrossDescriptor {
            color_format: window,
            ..Default::default()
        };
        let map = CubeShadowMap::new(&gpu.device, &map)?;
        let cross = CubeCross::new(&gpu.device, &cross)?;
        Ok(Self {
            lit: sampled(gpu, renderer, &sampler),
            means: Means::Cube(Box::new(Cube {
                group: sampler.bind_group(&gpu.device, &map)?,
                cross_group: cross.bind_group(&gpu.device, &map)?,
                map,
                cross,
            })),
        })
    }

    fn flat(gpu: &Gpu, renderer: &Renderer, settings: &Settings) -> Result<Self> {
        let map = ShadowMapDescriptor {
            size: settings.size,
            settings: settings.of_maps(),
            ..Default::default()
        };
        let map = ShadowMap::new(&gpu.device, &map)?;
        let sampler = sampler(gpu, settings, MapKind::FLAT)?;
        let group = sampler.bind_group(&gpu.device, &map)?;
        Ok(Self {
            lit: sampled(gpu, renderer, &sampler),
            means: Means::Flat(Box::new(map), group),
        })
    }

    fn atlas(
        gpu: &Gpu,
        renderer: &Renderer,
        window: wgpu::TextureFormat,
        settings: &Settings,
    ) -> Result<Self> {
        let atlas = ShadowAtlasDescriptor {
            layer_size: settings.size,
            memory: 512 << 20,
            settings: settings.of_maps(),
            ..Default::default()
        };
        let atlas = ShadowAtlas::new(&gpu.device, &atlas)?;
        let sampler = sampler(gpu, settings, MapKind::ATLAS)?;
        let debug = AtlasDebugDescriptor {
            color_format: window,
            ..Default::default()
        };
        Ok(Self {
            lit: sampled(gpu, renderer, &sampler),
            means: Means::Atlas(Box::new(Atlas {
                group: (atlas.revision(), sampler.bind_group(&gpu.device, &atlas)?),
                atlas,
                sampler,
                size: settings.size,
                debug: AtlasDebug::new(&gpu.device, &debug)?,
            })),
        })
    }

    fn volumes(gpu: &Gpu, renderer: &Renderer) -> Result<Self> {
        let descriptor = ShadowVolumeDescriptor {
            depth_stencil_format: renderer.depth_stencil_format(),
            depth: DEPTH,
            ..Default::default()
        };
        let debug = VolumeDebugDescriptor {
            color_format: SHADED,
            depth_stencil_format: descriptor.depth_stencil_format,
            depth: DEPTH,
            ..Default::default()
        };
        let access = ShadowAccess {
            stencil: Some(ShadowVolumeRenderer::light_pass_stencil()),
            ..Default::default()
        };
        Ok(Self {
            lit: renderer.lit_pipeline(gpu, &access),
            means: Means::Volumes(Box::new(Volumes {
                renderer: ShadowVolumeRenderer::new(&gpu.device, &descriptor)?,
                debug: VolumeDebug::new(&gpu.device, &debug)?,
                shown: None,
                survey: None,
            })),
        })
    }

    /// First verb: what the CPU decides.
    ///
    /// # Errors
    /// If the frame is refused; what was prepared before stands.
    pub fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<()> {
        let (device, queue) = (&gpu.device, &gpu.queue);
        let position = frame.light.xyzw().truncate();
        let casters = frame.casters;
        match &mut self.means {
            Means::Cube(cube) => {
                let frame = CubeFrame {
                    view: Some(&frame.view),
                    ..CubeFrame::new(PointLight::new(position, frame.range), casters)
                };
                cube.map.prepare(device, queue, &frame)?;
            }
            Means::Flat(map, _) => {
                let light = FlatLight::Directional(DirectionalLight::new(position));
                map.prepare(device, queue, &ShadowFrame::new(light, casters))?;
            }
            Means::Atlas(atlas) => atlas.prepare(gpu, frame)?,
            Means::Volumes(volumes) => volumes.prepare(gpu, frame)?,
            Means::None => {}
        }
        Ok(())
    }

    /// Second verb: what is drawn before the lit pass, once the scene's depth is there.
    pub fn encode(
        &mut self,
        renderer: &Renderer,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<()> {
        match &mut self.means {
            Means::Cube(cube) => cube.map.encode(encoder),
            Means::Flat(map, _) => map.encode(encoder),
            Means::Atlas(atlas) => atlas.atlas.encode(encoder),
            Means::Volumes(volumes) => {
                volumes.renderer.encode(encoder);
                volumes
                    .renderer
                    .render(&mut renderer.begin_stencil_pass(encoder), 0, 0)?;
            }
            Means::None => {}
        }
        Ok(())
    }

    /// Third verb: the lit pass, with the map bound or the stencil tested, and what is to be shown of
    /// the volumes.
    pub fn shade(
        &self,
        renderer: &Renderer,
        scene: &SceneGpu,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<()> {
        let group = match &self.means {
            Means::Cube(cube) => Some(&cube.group),
            Means::Flat(_, group) => Some(group),
            Means::Atlas(atlas) => Some(&atlas.group.1),
            Means::Volumes(_) | Means::None => None,
        };
        // The light pass changes counts, and adds nothing where there are any.
        self.draw_over(renderer, encoder, &[DebugView::Counts])?;
        renderer.draw_lit(encoder, scene, &self.lit, group);
        let after = [DebugView::Surfaces, DebugView::Casters];
        self.draw_over(renderer, encoder, &after)
    }

    /// Draws the volumes' view, if it is one of these, into the host's picture: it takes the scene's
    /// depth and stencil, which egui's pass does not have.
    fn draw_over(
        &self,
        renderer: &Renderer,
        encoder: &mut wgpu::CommandEncoder,
        views: &[DebugView],
    ) -> Result<()> {
        if let Means::Volumes(volumes) = &self.means
            && let Some(view) = volumes.shown.filter(|view| views.contains(view))
        {
            volumes.draw_debug(&mut renderer.begin_overlay_pass(encoder), view)?;
        }
        Ok(())
    }

    /// Draws what the maps hold into egui's pass; false if there is none.
    pub fn draw_debug(&self, pass: &mut wgpu::RenderPass<'_>) -> bool {
        match &self.means {
            Means::Cube(cube) => cube.cross.render(pass, &cube.cross_group),
            Means::Atlas(atlas) => atlas.debug.render(pass),
            _ => return false,
        }
        true
    }

    /// Where resolution is no excuse for errors of the last prepared frame.
    pub fn interior(&self, kernel: Kernel) -> Interior {
        match &self.means {
            Means::Cube(cube) => interior::of_cube(&cube.map, kernel),
            Means::Flat(map, _) => interior::of_flat(map, kernel),
            Means::Atlas(atlas) => atlas.interior(kernel),
            Means::Volumes(_) | Means::None => Interior::Screen,
        }
    }

    /// What the last frame came to: names and values.
    pub fn statistics(&self) -> Rows {
        match &self.means {
            Means::Cube(cube) => statistics::of_cube(&cube.map.statistics()),
            Means::Flat(map, _) => statistics::of_flat(&map.statistics()),
            Means::Atlas(atlas) => statistics::of_atlas(&atlas.atlas.statistics()),
            Means::Volumes(volumes) => {
                let mut rows = statistics::of_volumes(&volumes.renderer.statistics());
                if let Some((.., size, survey)) = &volumes.survey {
                    rows.extend(statistics::of_survey(survey, *size));
                }
                rows
            }
            Means::None => Vec::new(),
        }
    }
}

impl Atlas {
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<()> {
        let position = frame.light.xyzw().truncate();
        let light = match frame.light.is_directional() {
            false => AtlasLight::new(PointLight::new(position, frame.range)),
            true => AtlasLight::directional(DirectionalLight::new(position), Cascades::default()),
        };
        let [width, height] = frame.size;
        let frame = AtlasFrame {
            lights: &[light.with_size(TileSize::Fixed(self.size))],
            casters: frame.casters,
            views: &[AtlasView::new(&frame.view, width, height)],
            receivers: None,
        };
        self.atlas.prepare(&gpu.device, &gpu.queue, &frame)?;
        self.debug.prepare(&gpu.device, &self.atlas);
        if self.group.0 != self.atlas.revision() {
            let group = self.sampler.bind_group(&gpu.device, &self.atlas)?;
            self.group = (self.atlas.revision(), group);
        }
        Ok(())
    }

    /// Of cascades the widest decides.
    fn interior(&self, kernel: Kernel) -> Interior {
        let kernel_radius = interior::radius_in_texels(kernel);
        match self.atlas.tiles(0, 0)[..] {
            [] => Interior::Screen,
            [tile, _, _, _, _, _] => Interior::Map {
                face_size: tile.size,
                kernel_radius,
            },
            [.., tile] => Interior::FlatMap {
                clip_from_world: tile.clip_from_world,
                size: tile.size,
                kernel_radius,
            },
        }
    }
}

impl Volumes {
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<()> {
        let (view, light, size) = (frame.view, frame.light, frame.size);
        let volumes = ShadowVolumeFrame {
            lights: &[VolumeLight::new(
                light,
                (!light.is_directional()).then_some(frame.range),
            )],
            views: &[VolumeView {
                view: frame.view,
                target_size: Some(size),
            }],
            casters: frame.casters,
            ..Default::default()
        };
        self.renderer.prepare(&gpu.device, &gpu.queue, &volumes)?;
        self.shown = frame.debug;
        if self.shown.is_none() {
            self.survey = None;
            return Ok(());
        }
        self.debug
            .prepare(&gpu.device, &volumes, &self.renderer, 0, 0)?;
        if self
            .survey
            .is_none_or(|(v, l, s, _)| (v, l, s) != (view, light, size))
        {
            self.survey = Some((view, light, size, self.renderer.survey(0, 0, size)?));
        }
        Ok(())
    }

    fn draw_debug(&self, pass: &mut wgpu::RenderPass<'_>, view: DebugView) -> Result<()> {
        match view {
            DebugView::Surfaces => {
                self.debug.draw_surfaces(pass, &self.renderer, 0, 0)?;
                self.debug.draw_edges(pass, &self.renderer, 0, 0)?;
            }
            DebugView::Counts => self.debug.draw_counts(pass)?,
            DebugView::Casters => self.debug.draw_casters(pass),
            DebugView::Cross | DebugView::Tiles => {}
        }
        Ok(())
    }
}

fn sampler(gpu: &Gpu, settings: &Settings, map: MapKind) -> Result<PcfSampler> {
    let descriptor = PcfDescriptor {
        kernel: settings.kernel,
        map,
        ..Default::default()
    };
    Ok(PcfSampler::new(&gpu.device, &gpu.queue, &descriptor)?)
}

/// The lit pass that asks a map: the sampler's WGSL before the host's own, its group as group 1.
fn sampled(gpu: &Gpu, renderer: &Renderer, sampler: &PcfSampler) -> LitPipeline {
    renderer.lit_pipeline(
        gpu,
        &ShadowAccess {
            module: Some(&visibility_module(sampler)),
            layout: Some(sampler.bind_group_layout()),
            ..Default::default()
        },
    )
}
