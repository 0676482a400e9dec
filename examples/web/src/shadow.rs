//! One method at work on one light: objects made once, and three verbs each frame.

use anyhow::Result;
use host::gpu::Gpu;
use host::interior;
use host::peer_light::PeerInputs;
use host::peer_map::PeerMap;
use host::peers::peer;
use host::pipelines::{ShadowAccess, visibility_module};
use host::renderer::{LitPipeline, Renderer};
use host::scene::LightKind;
use host::scene_gpu::SceneGpu;
use shadows::reference::Interior;
use shadows::{
    CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, Kernel, MapKind, PcfDescriptor, PcfSampler,
    ShadowFrame, ShadowMap, ShadowMapDescriptor, ShadowVolumeDescriptor, ShadowVolumeFrame,
    ShadowVolumeRenderer, VolumeLight, VolumeView, wgpu,
};

use crate::atlas::Atlas;
use crate::choice::{Maps, Method};
use crate::statistics::{self, Rows};
use crate::world::Inputs;

/// Shadows of one light.
pub struct Shadow {
    lit: LitPipeline,
    means: Means,
}

enum Means {
    Cube(Box<Cube>),
    Flat(Box<ShadowMap>, Kernel, wgpu::BindGroup),
    Atlas(Box<Atlas>),
    Volumes(Box<ShadowVolumeRenderer>),
    Peer(Box<PeerMap>),
    None,
}

struct Cube {
    map: CubeShadowMap,
    kernel: Kernel,
    group: wgpu::BindGroup,
}

impl Shadow {
    /// Makes what the method needs for a light of that kind.
    ///
    /// # Errors
    /// If a size or a bias is out of its range, or the device cannot do it.
    pub fn new(
        gpu: &Gpu,
        renderer: &Renderer,
        kind: LightKind,
        method: Method,
        maps: &Maps,
    ) -> Result<Self> {
        let point = kind == LightKind::Point;
        let volumes = |descriptor| Self::volumes(gpu, renderer, descriptor);
        let peer = |name| Ok(Self::peer(gpu, renderer, name, maps.size));
        match method {
            Method::Map if point => Self::cube(gpu, renderer, maps),
            Method::Map => Self::flat(gpu, renderer, maps),
            Method::Atlas => Self::atlas(gpu, renderer, maps),
            Method::Volumes => volumes(ShadowVolumeDescriptor::default()),
            Method::TextbookVolumes => volumes(ShadowVolumeDescriptor::textbook()),
            Method::Textbook if point => Self::textbook_cube(gpu, renderer, maps),
            Method::Textbook => peer("flat/wgpu-example"),
            Method::Bevy | Method::BevyGaussian => peer(bevy(method, kind)),
            Method::Three if point => peer("cube/three-pcf"),
            // Of another light it has no rendition here.
            Method::Three | Method::None => Ok(Self {
                lit: renderer.lit_pipeline(gpu, &ShadowAccess::default()),
                means: Means::None,
            }),
        }
    }

    fn cube(gpu: &Gpu, renderer: &Renderer, maps: &Maps) -> Result<Self> {
        let map = CubeShadowMapDescriptor {
            size: maps.size,
            settings: maps.settings(),
            ..Default::default()
        };
        let sampler = PcfDescriptor {
            kernel: maps.kernel,
            ..Default::default()
        };
        Self::of_cube(gpu, renderer, &map, &sampler)
    }

    fn textbook_cube(gpu: &Gpu, renderer: &Renderer, maps: &Maps) -> Result<Self> {
        let map = CubeShadowMapDescriptor {
            size: maps.size,
            ..CubeShadowMapDescriptor::textbook()
        };
        let sampler = PcfDescriptor {
            kernel: Kernel::Hard,
            map: MapKind::Cube(map.encoding),
            textbook: true,
            ..Default::default()
        };
        Self::of_cube(gpu, renderer, &map, &sampler)
    }

    fn of_cube(
        gpu: &Gpu,
        renderer: &Renderer,
        map: &CubeShadowMapDescriptor<'_>,
        sampler: &PcfDescriptor<'_>,
    ) -> Result<Self> {
        let map = CubeShadowMap::new(&gpu.device, map)?;
        let sampler = PcfSampler::new(&gpu.device, &gpu.queue, sampler)?;
        Ok(Self {
            lit: sampled(gpu, renderer, &sampler),
            means: Means::Cube(Box::new(Cube {
                group: sampler.bind_group(&gpu.device, &map)?,
                kernel: sampler.kernel(),
                map,
            })),
        })
    }

    fn flat(gpu: &Gpu, renderer: &Renderer, maps: &Maps) -> Result<Self> {
        let map = ShadowMapDescriptor {
            size: maps.size,
            settings: maps.settings(),
            ..Default::default()
        };
        let map = Box::new(ShadowMap::new(&gpu.device, &map)?);
        let sampler = sampler(gpu, maps.kernel, MapKind::FLAT)?;
        let group = sampler.bind_group(&gpu.device, &*map)?;
        Ok(Self {
            lit: sampled(gpu, renderer, &sampler),
            means: Means::Flat(map, maps.kernel, group),
        })
    }

    fn atlas(gpu: &Gpu, renderer: &Renderer, maps: &Maps) -> Result<Self> {
        let sampler = sampler(gpu, maps.kernel, MapKind::ATLAS)?;
        Ok(Self {
            lit: sampled(gpu, renderer, &sampler),
            means: Means::Atlas(Box::new(Atlas::new(gpu, maps, sampler)?)),
        })
    }

    fn volumes(
        gpu: &Gpu,
        renderer: &Renderer,
        descriptor: ShadowVolumeDescriptor<'_>,
    ) -> Result<Self> {
        let descriptor = ShadowVolumeDescriptor {
            depth_stencil_format: renderer.depth_stencil_format(),
            depth: renderer.look().depth,
            sample_count: renderer.look().samples,
            ..descriptor
        };
        let access = ShadowAccess {
            stencil: Some(ShadowVolumeRenderer::light_pass_stencil()),
            ..Default::default()
        };
        let volumes = ShadowVolumeRenderer::new(&gpu.device, &descriptor)?;
        Ok(Self {
            lit: renderer.lit_pipeline(gpu, &access),
            means: Means::Volumes(Box::new(volumes)),
        })
    }

    fn peer(gpu: &Gpu, renderer: &Renderer, name: &str, size: u32) -> Self {
        let map = PeerMap::new(gpu, peer(name), size);
        let access = ShadowAccess {
            module: Some(&map.module()),
            layout: Some(map.bind_group_layout()),
            ..Default::default()
        };
        Self {
            lit: renderer.lit_pipeline(gpu, &access),
            means: Means::Peer(Box::new(map)),
        }
    }

    /// First verb: what the CPU decides.
    ///
    /// # Errors
    /// If the frame is refused.
    pub fn prepare(&mut self, gpu: &Gpu, inputs: &Inputs<'_>) -> Result<()> {
        match &mut self.means {
            Means::Cube(cube) => {
                let frame = CubeFrame {
                    view: Some(&inputs.view),
                    ..CubeFrame::new(inputs.point(), inputs.casters)
                };
                cube.map.prepare(&gpu.device, &gpu.queue, &frame)?;
            }
            Means::Flat(map, ..) => {
                let frame = ShadowFrame {
                    view: Some((&inputs.view, inputs.seen)),
                    receivers: Some(inputs.receivers),
                    ..ShadowFrame::new(inputs.flat(), inputs.casters)
                };
                map.prepare(&gpu.device, &gpu.queue, &frame)?;
            }
            Means::Atlas(atlas) => atlas.prepare(gpu, inputs)?,
            Means::Volumes(volumes) => {
                let frame = ShadowVolumeFrame {
                    lights: &[VolumeLight::new(inputs.homogeneous(), inputs.range())],
                    views: &[VolumeView {
                        view: inputs.view,
                        target_size: Some(inputs.size),
                    }],
                    receivers: Some(inputs.receivers),
                    casters: inputs.casters,
                };
                volumes.prepare(&gpu.device, &gpu.queue, &frame)?;
            }
            Means::Peer(map) => map.prepare(
                gpu,
                &PeerInputs {
                    light: inputs.light.place,
                    cone: inputs.light.cone,
                    range: inputs.light.range,
                    bounds: inputs.receivers,
                    seen: None,
                },
            ),
            Means::None => {}
        }
        Ok(())
    }

    /// Second verb: what is drawn before the lit pass, once the scene's depth is there.
    ///
    /// # Errors
    /// If the volumes were not prepared.
    pub fn encode(
        &mut self,
        renderer: &Renderer,
        scene: &SceneGpu,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<()> {
        match &mut self.means {
            Means::Cube(cube) => cube.map.encode(encoder),
            Means::Flat(map, ..) => map.encode(encoder),
            Means::Atlas(atlas) => atlas.encode(encoder),
            Means::Volumes(volumes) => {
                volumes.encode(encoder);
                volumes.render(&mut renderer.begin_stencil_pass(encoder), 0, 0)?;
            }
            Means::Peer(map) => map.encode(scene, encoder),
            Means::None => {}
        }
        Ok(())
    }

    /// Third verb: the lit pass, with the map bound or the stencil tested.
    pub fn shade(&self, renderer: &Renderer, scene: &SceneGpu, encoder: &mut wgpu::CommandEncoder) {
        let group = match &self.means {
            Means::Cube(cube) => Some(&cube.group),
            Means::Flat(.., group) => Some(group),
            Means::Atlas(atlas) => Some(atlas.group()),
            Means::Peer(map) => Some(map.bind_group()),
            Means::Volumes(_) | Means::None => None,
        };
        renderer.draw_lit(encoder, scene, &self.lit, group);
    }

    /// Where resolution is no excuse for errors of the last prepared frame.
    pub fn interior(&self) -> Interior {
        match &self.means {
            Means::Cube(cube) => interior::of_cube(&cube.map, cube.kernel),
            Means::Flat(map, kernel, _) => interior::of_flat(map, *kernel),
            Means::Atlas(atlas) => atlas.interior(),
            Means::Peer(map) => map.interior(),
            Means::Volumes(_) | Means::None => Interior::Screen,
        }
    }

    /// What the last frame came to.
    pub fn statistics(&self) -> Rows {
        match &self.means {
            Means::Cube(cube) => statistics::of_cube(&cube.map.statistics()),
            Means::Flat(map, ..) => statistics::of_flat(&map.statistics()),
            Means::Atlas(atlas) => statistics::of_atlas(&atlas.statistics()),
            Means::Volumes(volumes) => statistics::of_volumes(&volumes.statistics()),
            Means::Peer(map) => statistics::of_peer(&map.statistics()),
            Means::None => Rows::default(),
        }
    }
}

fn bevy(method: Method, kind: LightKind) -> &'static str {
    match (method, kind) {
        (Method::BevyGaussian, LightKind::Point) => "cube/bevy-gaussian",
        (Method::BevyGaussian, LightKind::Spot) => "flat/bevy-spot-gaussian",
        (Method::BevyGaussian, LightKind::Directional) => "flat/bevy-gaussian",
        (_, LightKind::Point) => "cube/bevy-2x2",
        (_, LightKind::Spot) => "flat/bevy-spot-2x2",
        (_, LightKind::Directional) => "flat/bevy-2x2",
    }
}

fn sampler(gpu: &Gpu, kernel: Kernel, map: MapKind) -> Result<PcfSampler> {
    let descriptor = PcfDescriptor {
        kernel,
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
