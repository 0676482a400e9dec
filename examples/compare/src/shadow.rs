//! The shadow techniques behind one interface: prepare, generate, shade.

use std::sync::Arc;

use anyhow::Result;
use host::one_light::{OneLight, PrepareOne as _};
use serde_json::{Value, json};
use shadows::glam::Vec3;
use shadows::mesh::Bounds;
use shadows::reference::Interior;
use shadows::{
    Bias, Caster, Counter, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DepthBounds,
    DirectionalLight, ExactCount, ExactCountDescriptor, FlatLight, HomogeneousLight, HostDraw,
    Kernel, PcfDescriptor, PcfSampler, PointLight, ShadowFrame, ShadowMap, ShadowMapDescriptor,
    ShadowVolumeDescriptor, ShadowVolumeRenderer, SpotLight, View, wgpu,
};

use crate::atlas::Atlas;
use crate::survey::{Bake, SurveyShadow};
use crate::technique::{Config, Technique};
use host::gpu::Gpu;
use host::interior::{self, radius_in_texels};
use host::peer_light::PeerInputs;
use host::peer_map::PeerMap;
use host::pipelines::visibility_module;
use host::renderer::{LitPipeline, Renderer, ShadowAccess};
use host::scene::{Cone, Scene};
use host::scene_gpu::SceneGpu;
use host::warped::Seen;

/// What a technique is told each frame.
#[derive(Clone)]
pub struct ShadowInputs {
    pub view: View,
    pub light: HomogeneousLight,
    /// Into which a spot shines; lights of other kinds have none.
    pub cone: Option<Cone>,
    /// Where maps begin, if not where they choose; shadow volumes begin at the light.
    pub near: Option<f32>,
    pub range: f32,
    pub casters: Vec<Caster>,
    /// What stands for the casters that the host alone can draw, which it does into maps.
    pub masked: Vec<Caster>,
    /// Everything that receives, world space.
    pub receivers: Bounds,
    /// Up to where along the camera's axis there is something to see.
    pub seen: f32,
    /// Between which depths the view's picture shows anything, where the host has read that.
    pub depths: Option<DepthBounds>,
    /// The corners of a horizontal rectangle that receives and does not cast, if there is one.
    pub ground: Option<[Vec3; 4]>,
    /// What there is, for what is made of it once.
    pub scene: Arc<Scene>,
}

impl ShadowInputs {
    /// The light's end; directional lights have none.
    pub fn light_range(&self) -> Option<f32> {
        (!self.light.is_directional()).then_some(self.range)
    }

    /// As a point light, whatever a cone leaves of it.
    pub fn point_light(&self) -> PointLight {
        PointLight {
            near: self.near,
            ..PointLight::new(self.light.xyzw().truncate(), self.range)
        }
    }

    /// The spot, if it is one.
    pub fn spot_light(&self) -> Option<SpotLight> {
        self.cone.map(|cone| SpotLight {
            position: self.light.xyzw().truncate(),
            direction: cone.direction,
            half_angle: cone.half_angle,
            near: self.near,
            range: self.range,
        })
    }

    /// All that casts into maps: the library's casters, then the host's.
    pub fn of_maps(&self) -> Vec<Caster> {
        self.casters.iter().chain(&self.masked).cloned().collect()
    }

    fn flat_light(&self) -> FlatLight {
        match self.spot_light() {
            Some(spot) => FlatLight::Spot(spot),
            None => FlatLight::Directional(DirectionalLight::new(self.light.xyzw().truncate())),
        }
    }
}

/// What it takes, for reports.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// GPU memory beyond what the host has anyway (meshes, depth-stencil buffer).
    pub bytes: u64,
    pub draws: u64,
    pub triangles: u64,
}

/// A technique at work.
pub struct Shadow {
    technique: Technique,
    lit: LitPipeline,
    means: Means,
    /// The place of the first caster that the host draws, in the last prepared frame.
    first_masked: usize,
}

enum Means {
    Cube {
        map: Box<CubeShadowMap>,
        group: wgpu::BindGroup,
    },
    Flat {
        map: Box<ShadowMap>,
        group: wgpu::BindGroup,
    },
    Atlas(Box<Atlas>),
    Volume {
        volumes: Box<ShadowVolumeRenderer>,
        /// Where they are counted, if not in the stencil.
        counts: Option<ExactCount>,
    },
    Peer(Box<PeerMap>),
    Survey(Box<dyn SurveyShadow>),
}

impl Shadow {
    /// Makes what the technique needs.
    ///
    /// # Errors
    /// If the device cannot do it.
    pub fn new(gpu: &Gpu, renderer: &Renderer, technique: Technique) -> Result<Self> {
        Self::read_by(gpu, renderer, technique, visibility_module)
    }

    /// The same with another call of the library's receivers.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn read_by(
        gpu: &Gpu,
        renderer: &Renderer,
        technique: Technique,
        module: fn(&PcfSampler) -> String,
    ) -> Result<Self> {
        let label = Some(technique.name.as_ref());
        let (means, lit) = match &technique.config {
            Config::Cube { map, sampler } => {
                let map = CubeShadowMapDescriptor {
                    label,
                    ..map.clone()
                };
                let map = CubeShadowMap::new(&gpu.device, &map)?;
                let sampler = make_sampler(gpu, label, sampler)?;
                let lit = sampled(gpu, renderer, &sampler, module);
                let group = sampler.bind_group(&gpu.device, &map)?;
                let means = Means::Cube {
                    map: Box::new(map),
                    group,
                };
                (means, lit)
            }
            Config::Flat { map, sampler } => {
                let map = ShadowMapDescriptor {
                    label,
                    ..map.clone()
                };
                let map = Box::new(ShadowMap::new(&gpu.device, &map)?);
                let sampler = make_sampler(gpu, label, sampler)?;
                let group = sampler.bind_group(&gpu.device, &*map)?;
                let lit = sampled(gpu, renderer, &sampler, module);
                (Means::Flat { map, group }, lit)
            }
            Config::Atlas {
                size,
                kept,
                sampler,
            } => {
                let sampler = make_sampler(gpu, label, sampler)?;
                let lit = sampled(gpu, renderer, &sampler, module);
                let atlas = Atlas::new(gpu, renderer, (*size, *kept), sampler)?;
                (Means::Atlas(Box::new(atlas)), lit)
            }
            Config::Volume(descriptor) => {
                let descriptor = ShadowVolumeDescriptor {
                    label,
                    depth_stencil_format: renderer.depth_stencil_format(),
                    depth: renderer.look().depth,
                    sample_count: renderer.look().samples,
                    ..*descriptor
                };
                let volumes = ShadowVolumeRenderer::new(&gpu.device, &descriptor)?;
                let access = ShadowAccess {
                    stencil: Some(ShadowVolumeRenderer::light_pass_stencil()),
                    ..Default::default()
                };
                let lit = renderer.lit_pipeline(gpu, &access);
                let counts = match descriptor.counter {
                    Counter::Stencil => None,
                    Counter::Exact => Some(exact_count(gpu, label, renderer)?),
                    other => {
                        anyhow::bail!("{other:?} is a counter that this example does not know")
                    }
                };
                let volumes = Box::new(volumes);
                (Means::Volume { volumes, counts }, lit)
            }
            &Config::Peer { peer, size } => {
                let map = PeerMap::new(gpu, peer, size);
                let access = ShadowAccess {
                    module: Some(&map.module()),
                    layout: Some(map.bind_group_layout()),
                    ..Default::default()
                };
                let lit = renderer.lit_pipeline(gpu, &access);
                (Means::Peer(Box::new(map)), lit)
            }
            Config::Survey(survey) => {
                let (means, lit) = survey.make(gpu, renderer)?;
                (Means::Survey(means), lit)
            }
        };
        Ok(Self {
            technique,
            lit,
            means,
            first_masked: 0,
        })
    }

    /// Which technique it is.
    pub fn technique(&self) -> &Technique {
        &self.technique
    }

    /// The frame's work on the CPU.
    ///
    /// # Errors
    /// If the technique refuses the inputs.
    pub fn prepare(&mut self, gpu: &Gpu, inputs: &ShadowInputs) -> Result<()> {
        let casters = &inputs.casters;
        self.first_masked = casters.len();
        match &mut self.means {
            Means::Atlas(atlas) => atlas.prepare(gpu, std::slice::from_ref(inputs))?,
            Means::Cube { map, .. } => {
                let casters = inputs.of_maps();
                let frame = CubeFrame::new(inputs.point_light(), &casters);
                map.prepare(&gpu.device, &gpu.queue, &frame)?;
            }
            Means::Flat { map, .. } => {
                let casters = inputs.of_maps();
                let frame = ShadowFrame {
                    view: Some((&inputs.view, inputs.seen)),
                    receivers: Some(inputs.receivers),
                    ..ShadowFrame::new(inputs.flat_light(), &casters)
                };
                map.prepare(&gpu.device, &gpu.queue, &frame)?;
            }
            Means::Volume { volumes, .. } => {
                let frame = OneLight {
                    range: inputs.light_range(),
                    receivers: Some(inputs.receivers),
                    ..OneLight::new(&inputs.view, inputs.light, casters)
                };
                volumes.prepare_one(&gpu.device, &gpu.queue, &frame)?;
            }
            Means::Survey(survey) => survey.prepare(gpu, inputs)?,
            Means::Peer(map) => map.prepare(
                gpu,
                &PeerInputs {
                    light: inputs.light.xyzw(),
                    cone: inputs.cone,
                    range: inputs.range,
                    bounds: inputs.receivers,
                    seen: Some(Seen {
                        clip_from_world: inputs.view.clip_from_world(),
                        nearest: None,
                        far: inputs.seen,
                    }),
                },
            ),
        }
        Ok(())
    }

    /// The same for several lights that one atlas shadows, of one view and with the same casters.
    ///
    /// # Errors
    /// As [`prepare`](Self::prepare); and if it is no atlas.
    pub fn prepare_all(&mut self, gpu: &Gpu, lights: &[ShadowInputs]) -> Result<()> {
        self.first_masked = lights.first().map_or(0, |first| first.casters.len());
        match &mut self.means {
            Means::Atlas(atlas) => atlas.prepare(gpu, lights),
            _ => anyhow::bail!("only an atlas shadows several lights at once"),
        }
    }

    /// Records what finds the shadows: the map, or the volumes and their stencil pass.
    pub fn generate(
        &mut self,
        host: &Renderer,
        scene: &SceneGpu,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let first = self.first_masked;
        let masked = |pass: &mut wgpu::RenderPass<'_>, asked: &HostDraw<'_>| {
            scene.draw_masked(first, pass, asked);
        };
        match &mut self.means {
            Means::Cube { map, .. } => map.encode_with(encoder, masked),
            Means::Flat { map, .. } => map.encode_with(encoder, masked),
            Means::Atlas(atlas) => atlas.encode_with(encoder, masked),
            Means::Volume { volumes, counts } => {
                volumes.encode(encoder);
                let Some(counts) = counts else {
                    return volumes
                        .render(&mut host.begin_stencil_pass(encoder), 0, 0)
                        .expect("it is encoded");
                };
                let fits = "made for the renderer's buffer";
                let buffer = host.depth_stencil();
                volumes
                    .render(&mut counts.begin(encoder, buffer).expect(fits), 0, 0)
                    .expect("it is encoded");
                counts.encode(encoder, buffer).expect(fits);
            }
            Means::Peer(map) => map.encode(scene, encoder),
            Means::Survey(survey) => survey.generate(host, scene, encoder),
        }
    }

    /// Records the lit pass.
    pub fn shade(&self, host: &Renderer, scene: &SceneGpu, encoder: &mut wgpu::CommandEncoder) {
        self.shade_by(host, scene, 0, encoder);
    }

    /// Records the lit pass of one of the scene's lights, which it was prepared for.
    pub fn shade_by(
        &self,
        host: &Renderer,
        scene: &SceneGpu,
        light: usize,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let group = match &self.means {
            Means::Cube { group, .. } => Some(group),
            Means::Flat { group, .. } => Some(group),
            Means::Atlas(atlas) => Some(atlas.group()),
            Means::Volume { .. } => None,
            Means::Peer(map) => Some(map.bind_group()),
            Means::Survey(survey) => survey.group(),
        };
        host.draw_lit_by(encoder, scene, light, &self.lit, group);
    }

    /// Whether 8-bit counts of volumes may be wrong in the last prepared frame.
    pub fn may_wrap(&mut self) -> bool {
        match &mut self.means {
            Means::Volume { volumes, .. } => volumes.may_wrap(0, 0),
            _ => false,
        }
    }

    /// What the last prepared frame takes.
    pub fn cost(&self) -> Cost {
        let (bytes, draws, triangles) = match &self.means {
            Means::Cube { map, .. } => {
                let taken = map.statistics();
                (taken.bytes, taken.draws, taken.triangles)
            }
            Means::Flat { map, .. } => {
                let taken = map.statistics();
                (taken.bytes, taken.draws, taken.triangles)
            }
            Means::Atlas(atlas) => {
                let taken = atlas.statistics();
                (taken.bytes, taken.draws, taken.triangles)
            }
            Means::Volume { volumes, counts } => {
                let taken = volumes.statistics();
                let counts = counts.as_ref().map_or(0, |counts| {
                    let target = counts.texture();
                    4 * u64::from(target.width()) * u64::from(target.height())
                });
                (taken.gpu_bytes + counts, taken.draws, taken.triangles)
            }
            Means::Peer(map) => {
                let taken = map.statistics();
                (taken.bytes, taken.draws, taken.triangles)
            }
            Means::Survey(survey) => return survey.cost(),
        };
        let draws = draws.into();
        Cost {
            bytes,
            draws,
            triangles,
        }
    }

    /// What was baked before the first frame, if anything was.
    pub fn bake(&self) -> Option<Bake> {
        match &self.means {
            Means::Survey(survey) => survey.bake(),
            _ => None,
        }
    }

    /// The same of one of the lights that an atlas was prepared for.
    pub fn interior_of(&self, light: usize) -> Interior {
        match &self.means {
            Means::Atlas(atlas) => atlas.interior(light),
            _ => self.interior(),
        }
    }

    /// Where resolution is no excuse for this technique's errors in the last prepared frame.
    pub fn interior(&self) -> Interior {
        let kernel = self.technique.config.kernel().unwrap_or_default();
        match &self.means {
            Means::Cube { map, .. } => interior::of_cube(map, kernel),
            Means::Flat { map, .. } => interior::of_flat(map, kernel),
            Means::Atlas(atlas) => atlas.interior(0),
            Means::Volume { .. } => Interior::Screen,
            Means::Peer(map) => map.interior(),
            Means::Survey(survey) => survey.interior(),
        }
    }
}

impl Technique {
    /// Everything that was chosen, by name.
    pub fn settings(&self) -> Value {
        let (map, sampler) = match &self.config {
            Config::Cube { map, sampler } => (
                json!({
                    "face_texels": map.size,
                    "encoding": format!("{:?}", map.encoding),
                    "format": format!("{:?}", map.format),
                    "cache": map.cache,
                }),
                (sampler, map.bias),
            ),
            Config::Flat { map, sampler } => (
                json!({ "map_texels": map.size, "cache": map.cache }),
                (sampler, map.bias),
            ),
            Config::Atlas {
                size,
                kept,
                sampler,
            } => (
                json!({ "tile_texels": size, "cache": kept }),
                (sampler, Bias::default()),
            ),
            Config::Peer { peer, size } => {
                return json!({
                    "rendition_of": format!("{:?}", peer.engine),
                    "map_texels": size,
                });
            }
            Config::Survey(survey) => return survey.settings(),
            Config::Volume(volume) => {
                return json!({
                    "method": format!("{:?}", volume.method),
                    "silhouettes": format!("{:?}", volume.silhouettes),
                    "counter": format!("{:?}", volume.counter),
                    "caps": format!("{:?}", volume.caps),
                    "extrusion": format!("{:?}", volume.extrusion),
                    "culling": volume.culling,
                    "keep_between_frames": volume.keep_between_frames,
                    "cap_bias_ulps": volume.cap_bias_ulps,
                });
            }
        };
        with_receiver(map, sampler.0, self.config.kernel(), sampler.1)
    }
}

/// The settings of a map, and those by which it is read.
fn with_receiver(
    mut map: Value,
    sampler: &PcfDescriptor<'_>,
    kernel: Option<Kernel>,
    bias: Bias,
) -> Value {
    let kernel = kernel.unwrap_or_default();
    if sampler.textbook {
        map["textbook"] = true.into();
    }
    map["kernel"] = format!("{kernel:?}").into();
    map["kernel_radius_texels"] = decimal(radius_in_texels(kernel)).into();
    map["bias_normal_offset_texels"] = decimal(bias.normal_offset).into();
    map["bias_constant_texels"] = decimal(bias.constant).into();
    map
}

fn make_sampler(
    gpu: &Gpu,
    label: Option<&str>,
    sampler: &PcfDescriptor<'static>,
) -> Result<PcfSampler> {
    let descriptor = PcfDescriptor {
        label,
        ..sampler.clone()
    };
    Ok(PcfSampler::new(&gpu.device, &gpu.queue, &descriptor)?)
}

/// A count that fits the renderer's depth-stencil buffer.
fn exact_count(gpu: &Gpu, label: Option<&str>, renderer: &Renderer) -> Result<ExactCount> {
    let descriptor = ExactCountDescriptor {
        label,
        size: renderer.size(),
        depth_stencil_format: renderer.depth_stencil_format(),
        sample_count: renderer.look().samples,
        ..Default::default()
    };
    Ok(ExactCount::new(&gpu.device, &descriptor)?)
}

/// The lit pass that asks a map.
fn sampled(
    gpu: &Gpu,
    renderer: &Renderer,
    sampler: &PcfSampler,
    module: fn(&PcfSampler) -> String,
) -> LitPipeline {
    renderer.lit_pipeline(
        gpu,
        &ShadowAccess {
            module: Some(&module(sampler)),
            layout: Some(sampler.bind_group_layout()),
            stencil: None,
            ..Default::default()
        },
    )
}

/// The number as one would write it: 0.1 rather than the f64 nearest to the f32 nearest to 0.1.
fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(f64::from(value))
}
