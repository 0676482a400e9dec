//! The shadow techniques behind one interface: prepare, generate, shade.

use anyhow::{Result, bail};
use serde_json::{Value, json};
use shadows::reference::Interior;
use shadows::{
    Bias, Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, HomogeneousLight, Kernel,
    PcfDescriptor, PcfSampler, PointLight, Radius, ShadowVolumeDescriptor, ShadowVolumeFrame,
    ShadowVolumeRenderer, View, wgpu,
};

use crate::host::gpu::Gpu;
use crate::host::pipelines::visibility_module;
use crate::host::renderer::{DEPTH, LitPipeline, Renderer, ShadowAccess};
use crate::host::scene_gpu::SceneGpu;

/// A way to make shadows. Maps are drawn anew every frame unless said otherwise, as if everything
/// moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Technique {
    /// A cube shadow map read through a kernel.
    Cube(Kernel),
    /// The same with the default kernel, whatever the size asked for, at 1024 texels a face.
    Cube1024,
    /// The same with the default kernel; faces that have not changed are not drawn again.
    CubeCached,
    /// A cube map as textbooks have it.
    CubeTextbook,
    /// Stencil shadow volumes.
    Volume,
}

impl Technique {
    /// The name on the command line, in reports and of files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cube(Kernel::Hard) => "cube-hard",
            Self::Cube(Kernel::Bilinear) => "cube-2x2",
            Self::Cube(Kernel::FourTaps) => "cube-16",
            Self::Cube(_) => "cube",
            Self::Cube1024 => "cube-1024",
            Self::CubeCached => "cube-cached",
            Self::CubeTextbook => "cube-textbook",
            Self::Volume => "volume",
        }
    }

    /// Whether it can shadow this light.
    pub fn applies_to(self, light: HomogeneousLight) -> bool {
        match self {
            Self::Volume => true,
            _ => !light.is_directional(),
        }
    }

    /// The map and what reads it.
    fn cube(
        self,
        face: u32,
        bias: Bias,
    ) -> (CubeShadowMapDescriptor<'static>, PcfDescriptor<'static>) {
        let label = Some(self.name());
        let ours = CubeShadowMapDescriptor {
            label,
            size: face,
            bias,
            cache: false,
            ..Default::default()
        };
        let map = match self {
            Self::Cube1024 => CubeShadowMapDescriptor { size: 1024, ..ours },
            Self::CubeCached => CubeShadowMapDescriptor {
                cache: true,
                ..ours
            },
            Self::CubeTextbook => CubeShadowMapDescriptor {
                label,
                size: face,
                ..CubeShadowMapDescriptor::textbook()
            },
            Self::Cube(_) | Self::Volume => ours,
        };
        let sampler = PcfDescriptor {
            label,
            kernel: self.kernel(),
            encoding: map.encoding,
            textbook: self == Self::CubeTextbook,
            ..Default::default()
        };
        (map, sampler)
    }

    fn kernel(self) -> Kernel {
        match self {
            Self::Cube(kernel) => kernel,
            Self::CubeTextbook => Kernel::Hard,
            _ => Kernel::default(),
        }
    }
}

/// What a technique is told each frame.
#[derive(Clone)]
pub struct ShadowInputs {
    pub view: View,
    pub light: HomogeneousLight,
    /// Where cube maps begin; shadow volumes begin at the light.
    pub near: f32,
    pub range: f32,
    pub casters: Vec<Caster>,
}

impl ShadowInputs {
    /// The light's end; directional lights have none.
    pub fn light_range(&self) -> Option<f32> {
        (!self.light.is_directional()).then_some(self.range)
    }

    fn point_light(&self) -> Result<PointLight> {
        if self.light.is_directional() {
            bail!("cube shadow maps need a point light (w = 1)");
        }
        Ok(PointLight::new(
            self.light.0.truncate(),
            self.near,
            self.range,
        ))
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
}

enum Means {
    Cube {
        map: Box<CubeShadowMap>,
        sampler: Box<PcfSampler>,
        /// With the revision of the map's texture that it is for.
        group: (u64, wgpu::BindGroup),
        bias: Bias,
    },
    Volume {
        renderer: Box<ShadowVolumeRenderer>,
        cap_bias_ulps: u32,
    },
}

impl Shadow {
    /// Makes what the technique needs; `face` is the texels along a cube map's side.
    ///
    /// # Errors
    /// If the device cannot do it.
    pub fn new(gpu: &Gpu, renderer: &Renderer, technique: Technique, face: u32) -> Result<Self> {
        Self::with_bias(gpu, renderer, technique, face, Bias::default())
    }

    /// The same with a bias other than the default, for those that have one.
    ///
    /// # Errors
    /// If the device cannot do it.
    pub fn with_bias(
        gpu: &Gpu,
        renderer: &Renderer,
        technique: Technique,
        face: u32,
        bias: Bias,
    ) -> Result<Self> {
        match technique {
            Technique::Volume => Self::volume(gpu, renderer),
            _ => Self::cube(gpu, renderer, technique, face, bias),
        }
    }

    fn cube(
        gpu: &Gpu,
        renderer: &Renderer,
        technique: Technique,
        face: u32,
        bias: Bias,
    ) -> Result<Self> {
        let (map, sampler) = technique.cube(face, bias);
        let bias = map.bias;
        let map = CubeShadowMap::new(&gpu.device, &map)?;
        let sampler = PcfSampler::new(&gpu.device, &gpu.queue, &sampler)?;
        let lit = renderer.lit_pipeline(
            gpu,
            &ShadowAccess {
                module: Some(&visibility_module(&sampler)),
                layout: Some(sampler.bind_group_layout()),
                stencil: None,
            },
        );
        let group = (
            map.texture_revision(),
            sampler.bind_group(&gpu.device, &map)?,
        );
        Ok(Self {
            technique,
            lit,
            means: Means::Cube {
                map: Box::new(map),
                sampler: Box::new(sampler),
                group,
                bias,
            },
        })
    }

    fn volume(gpu: &Gpu, renderer: &Renderer) -> Result<Self> {
        let descriptor = ShadowVolumeDescriptor {
            label: Some(Technique::Volume.name()),
            depth_stencil_format: renderer.depth_stencil_format(),
            depth: DEPTH,
            // Every frame pays for its silhouettes, as a frame of a moving light does.
            keep_between_frames: false,
            ..Default::default()
        };
        let lit = renderer.lit_pipeline(
            gpu,
            &ShadowAccess {
                stencil: Some(ShadowVolumeRenderer::light_pass_stencil()),
                ..Default::default()
            },
        );
        Ok(Self {
            technique: Technique::Volume,
            lit,
            means: Means::Volume {
                renderer: Box::new(ShadowVolumeRenderer::new(&gpu.device, &descriptor)?),
                cap_bias_ulps: descriptor.cap_bias_ulps,
            },
        })
    }

    /// Which technique it is.
    pub fn technique(&self) -> Technique {
        self.technique
    }

    /// The frame's work on the CPU.
    ///
    /// # Errors
    /// If the technique refuses the inputs.
    pub fn prepare(&mut self, gpu: &Gpu, inputs: &ShadowInputs) -> Result<()> {
        let casters = &inputs.casters;
        match &mut self.means {
            Means::Cube {
                map,
                sampler,
                group,
                ..
            } => {
                let frame = CubeFrame {
                    lights: &[inputs.point_light()?],
                    casters,
                    ..Default::default()
                };
                map.prepare(&gpu.device, &gpu.queue, &frame)?;
                let revision = map.texture_revision();
                if group.0 != revision {
                    *group = (revision, sampler.bind_group(&gpu.device, &**map)?);
                }
            }
            Means::Volume { renderer, .. } => {
                let frame = ShadowVolumeFrame {
                    range: inputs.light_range(),
                    ..ShadowVolumeFrame::new(&inputs.view, inputs.light, casters)
                };
                renderer.prepare(&gpu.device, &gpu.queue, &frame)?;
            }
        }
        Ok(())
    }

    /// Records what finds the shadows: the map's faces, or the volumes and their stencil pass.
    pub fn generate(&self, host: &Renderer, encoder: &mut wgpu::CommandEncoder) {
        match &self.means {
            Means::Cube { map, .. } => map.encode(encoder),
            Means::Volume { renderer, .. } => {
                renderer.encode(encoder);
                renderer.render(&mut host.begin_stencil_pass(encoder));
            }
        }
    }

    /// Records the lit pass.
    pub fn shade(&self, host: &Renderer, scene: &SceneGpu, encoder: &mut wgpu::CommandEncoder) {
        let group = match &self.means {
            Means::Cube { group, .. } => Some(&group.1),
            Means::Volume { .. } => None,
        };
        host.draw_lit(encoder, scene, &self.lit, group);
    }

    /// What the last prepared frame takes.
    pub fn cost(&self) -> Cost {
        match &self.means {
            Means::Cube { map, .. } => {
                let statistics = map.statistics();
                Cost {
                    bytes: statistics.bytes,
                    draws: statistics.draws.into(),
                    triangles: statistics.triangles,
                }
            }
            Means::Volume { renderer, .. } => {
                let statistics = renderer.statistics();
                Cost {
                    bytes: statistics.gpu_bytes,
                    draws: statistics.draws.into(),
                    triangles: statistics.triangles,
                }
            }
        }
    }

    /// Everything that was chosen, by name.
    pub fn settings(&self) -> Value {
        let kernel = self.technique.kernel();
        match &self.means {
            Means::Cube { map, bias, .. } => json!({
                "face_texels": map.size(),
                "encoding": format!("{:?}", map.encoding()),
                "kernel": format!("{kernel:?}"),
                "kernel_radius_texels": decimal(radius_in_texels(kernel)),
                "bias_normal_offset_texels": decimal(bias.normal_offset),
                "bias_constant_texels": decimal(bias.constant),
            }),
            Means::Volume { cap_bias_ulps, .. } => json!({
                "stencil": "z-fail, 8 bits, wrapping",
                "cap_bias_ulps": cap_bias_ulps,
            }),
        }
    }

    /// Where resolution is no excuse for this technique's errors.
    pub fn interior(&self) -> Interior {
        match &self.means {
            Means::Cube { map, .. } => Interior::Map {
                face_size: map.size(),
                kernel_radius: radius_in_texels(self.technique.kernel()),
            },
            Means::Volume { .. } => Interior::Screen,
        }
    }
}

/// The number as one would write it: 0.1 rather than the f64 nearest to the f32 nearest to 0.1.
fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(f64::from(value))
}

/// How many texels a kernel reaches, at most: disks are measured on the surface, where texels are
/// up to `sqrt(3)` smaller than straight ahead, and reach to the centre of the texel they hit.
fn radius_in_texels(kernel: Kernel) -> f32 {
    match kernel.radius() {
        Radius::Texels(radius) if kernel.uses_pixel() => radius * 3.0_f32.sqrt() + 0.5,
        Radius::Texels(radius) => radius,
        Radius::World(_) => f32::INFINITY, // no pixel is safely interior
    }
}
