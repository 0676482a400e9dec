//! Everything that this application adds to have shadows: objects made once for a choice of
//! settings, and the same three verbs each frame whatever was chosen.

use anyhow::Result;
use shadows::wgpu;
use shadows::{
    Bias, Caster, CubeCross, CubeCrossDescriptor, CubeFrame, CubeShadowMap,
    CubeShadowMapDescriptor, DirectionalLight, FlatLight, HomogeneousLight, Kernel, MapKind,
    PcfDescriptor, PcfSampler, PointLight, ShadowFrame, ShadowMap, ShadowMapDescriptor,
    ShadowVolumeDescriptor, ShadowVolumeFrame, ShadowVolumeRenderer, View,
};

use crate::host::gpu::Gpu;
use crate::host::pipelines::{DEPTH, ShadowAccess, visibility_module};
use crate::host::renderer::{LitPipeline, Renderer};
use crate::host::scene_gpu::SceneGpu;

/// How shadows are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Technique {
    /// A cube map for a point light, a flat one for a directional light.
    Map,
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

/// What is told each frame.
pub struct Frame<'a> {
    pub view: View,
    pub light: HomogeneousLight,
    pub near: f32,
    pub range: f32,
    pub casters: &'a [Caster],
    /// Pixels of the picture.
    pub size: [u32; 2],
}

/// Shadows of one light, by one technique.
pub struct Shadows {
    lit: LitPipeline,
    means: Means,
}

enum Means {
    Cube(Box<Cube>),
    Flat(Box<ShadowMap>, wgpu::BindGroup),
    Volumes(Box<ShadowVolumeRenderer>),
    None,
}

struct Cube {
    map: CubeShadowMap,
    sampler: PcfSampler,
    cross: CubeCross,
    /// For this revision of the map's texture: what the lit pass reads, and what the cross does.
    groups: Option<(u64, wgpu::BindGroup, wgpu::BindGroup)>,
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
            bias: settings.bias,
            reach: settings.kernel.radius(),
            ..Default::default()
        };
        let sampler = sampler(gpu, settings, MapKind::Cube)?;
        let cross = CubeCrossDescriptor {
            format: window,
            ..Default::default()
        };
        Ok(Self {
            lit: sampled(gpu, renderer, &sampler),
            means: Means::Cube(Box::new(Cube {
                map: CubeShadowMap::new(&gpu.device, &map)?,
                sampler,
                cross: CubeCross::new(&gpu.device, &cross),
                groups: None,
            })),
        })
    }

    fn flat(gpu: &Gpu, renderer: &Renderer, settings: &Settings) -> Result<Self> {
        let map = ShadowMapDescriptor {
            size: settings.size,
            bias: settings.bias,
            reach: settings.kernel.radius(),
            ..Default::default()
        };
        let map = ShadowMap::new(&gpu.device, &map)?;
        let sampler = sampler(gpu, settings, MapKind::Flat)?;
        let group = sampler.bind_group(&gpu.device, &map)?;
        Ok(Self {
            lit: sampled(gpu, renderer, &sampler),
            means: Means::Flat(Box::new(map), group),
        })
    }

    fn volumes(gpu: &Gpu, renderer: &Renderer) -> Result<Self> {
        let descriptor = ShadowVolumeDescriptor {
            depth_stencil_format: renderer.depth_stencil_format(),
            depth: DEPTH,
            ..Default::default()
        };
        let access = ShadowAccess {
            stencil: Some(ShadowVolumeRenderer::light_pass_stencil()),
            ..Default::default()
        };
        Ok(Self {
            lit: renderer.lit_pipeline(gpu, &access),
            means: Means::Volumes(Box::new(ShadowVolumeRenderer::new(
                &gpu.device,
                &descriptor,
            )?)),
        })
    }

    /// First verb: what the CPU decides.
    ///
    /// # Errors
    /// If the frame is refused; what was prepared before stands.
    pub fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<()> {
        let (device, queue) = (&gpu.device, &gpu.queue);
        let position = frame.light.0.truncate();
        let casters = frame.casters;
        match &mut self.means {
            Means::Cube(cube) => {
                let lights = [PointLight::new(position, frame.near, frame.range)];
                let frame = CubeFrame {
                    lights: &lights,
                    casters,
                    view: Some(&frame.view),
                    ..Default::default()
                };
                cube.map.prepare(device, queue, &frame)?;
                cube.bind(device)?;
            }
            Means::Flat(map, _) => {
                let light = FlatLight::Directional(DirectionalLight::new(position));
                map.prepare(device, queue, &ShadowFrame::new(light, casters))?;
            }
            Means::Volumes(volumes) => {
                let range = (!frame.light.is_directional()).then_some(frame.range);
                let frame = ShadowVolumeFrame {
                    range,
                    target_size: Some(frame.size),
                    ..ShadowVolumeFrame::new(&frame.view, frame.light, casters)
                };
                volumes.prepare(device, queue, &frame)?;
            }
            Means::None => {}
        }
        Ok(())
    }

    /// Second verb: what is drawn before the lit pass, once the scene's depth is there.
    pub fn encode(&self, renderer: &Renderer, encoder: &mut wgpu::CommandEncoder) {
        match &self.means {
            Means::Cube(cube) => cube.map.encode(encoder),
            Means::Flat(map, _) => map.encode(encoder),
            Means::Volumes(volumes) => {
                volumes.encode(encoder);
                volumes.render(&mut renderer.begin_stencil_pass(encoder));
            }
            Means::None => {}
        }
    }

    /// Third verb: the lit pass, with the map bound or the stencil tested.
    pub fn shade(&self, renderer: &Renderer, scene: &SceneGpu, encoder: &mut wgpu::CommandEncoder) {
        let group = match &self.means {
            Means::Cube(cube) => cube.groups.as_ref().map(|(_, lit, _)| lit),
            Means::Flat(_, group) => Some(group),
            Means::Volumes(_) | Means::None => None,
        };
        renderer.draw_lit(encoder, scene, &self.lit, group);
    }

    /// Draws the cube map, unfolded, into egui's pass; false if there is none.
    ///
    /// A view of the volumes belongs here, too: another arm, another pipeline.
    pub fn draw_debug(&self, pass: &mut wgpu::RenderPass<'_>) -> bool {
        let Means::Cube(cube) = &self.means else {
            return false;
        };
        let Some((_, _, group)) = &cube.groups else {
            return false;
        };
        cube.cross.render(pass, group);
        true
    }

    /// What the last frame came to: names and values.
    pub fn statistics(&self) -> Vec<(&'static str, String)> {
        match &self.means {
            Means::Cube(cube) => {
                let s = cube.map.statistics();
                let faces = s.faces_rendered + s.faces_kept;
                vec![
                    (
                        "faces drawn",
                        format!("{} of {faces} with casters", s.faces_rendered),
                    ),
                    ("faces hidden", s.faces_hidden.to_string()),
                    ("casters in range", s.casters_in_range.to_string()),
                    ("draws", s.draws.to_string()),
                    ("triangles", s.triangles.to_string()),
                    ("memory", mebibytes(s.bytes)),
                    (
                        "prepare",
                        format!("{:.0} µs", s.prepare.as_secs_f64() * 1e6),
                    ),
                ]
            }
            Means::Flat(map, _) => {
                let s = map.statistics();
                vec![
                    ("drawn again", if s.rendered { "yes" } else { "no" }.into()),
                    ("casters", s.casters_drawn.to_string()),
                    ("draws", s.draws.to_string()),
                    ("triangles", s.triangles.to_string()),
                    ("memory", mebibytes(s.bytes)),
                ]
            }
            Means::Volumes(volumes) => {
                let s = volumes.statistics();
                let of = s.casters_drawn + s.casters_skipped;
                vec![
                    ("casters drawn", format!("{} of {of}", s.casters_drawn)),
                    (
                        "z-pass, z-fail",
                        format!("{}, {}", s.casters_z_pass, s.casters_z_fail),
                    ),
                    ("searched again", s.casters_extracted.to_string()),
                    ("out of range", s.skipped_out_of_range.to_string()),
                    ("out of view", s.skipped_out_of_view.to_string()),
                    ("draws", s.draws.to_string()),
                    ("triangles", s.triangles.to_string()),
                    ("memory", mebibytes(s.gpu_bytes)),
                ]
            }
            Means::None => Vec::new(),
        }
    }
}

impl Cube {
    /// Bind groups follow the map's texture, which comes with the first caster.
    fn bind(&mut self, device: &wgpu::Device) -> Result<()> {
        let revision = self.map.texture_revision();
        if self
            .groups
            .as_ref()
            .is_none_or(|(made, ..)| *made != revision)
        {
            self.groups = Some((
                revision,
                self.sampler.bind_group(device, &self.map)?,
                self.cross.bind_group(device, &self.map, 0),
            ));
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

fn mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}
