//! Pictures of the casters, projected onto what receives.

use anyhow::Result;
use serde_json::{Value, json};
use shadows::reference::Interior;
use shadows::{
    ProjectedCaster, ProjectedFrame, ProjectedShadow, ProjectedShadowDescriptor, Projector,
    ProjectorState, wgpu,
};

use super::SurveyShadow;
use super::planar::light;
use crate::shadow::{Cost, ShadowInputs};
use host::gpu::Gpu;
use host::renderer::{LitPipeline, Renderer, ShadowAccess};
use host::scene_gpu::SceneGpu;

/// How many texels, and who reads them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Projected {
    /// Along the tile of all casters together. Where the light is among them each has a tile of its own, of a
    /// quarter of that.
    pub size: u32,
    /// Whether casters receive shadows, too: also their own.
    pub on_casters: bool,
}

// Bilinear, between levels.
const KERNEL_RADIUS: f32 = 1.0;

const ASKS: &str = "
fn host_visibility(at: HostReceiver) -> f32 {
    let x = dpdx(at.world);
    let y = dpdy(at.world);
    var through = 1.0;
    for (var i = 0u; i < arrayLength(&shadows_projectors); i++) {
        through *= shadows_transmittance_facing(i, at.world, at.flat_normal, x, y).g;
    }
    return select(through, 1.0, RECEIVES_NONE);
}
";

impl Projected {
    /// Of a power of two.
    pub fn new(side: u32, on_casters: bool) -> Self {
        Self {
            size: side.next_power_of_two().clamp(64, 8192),
            on_casters,
        }
    }

    fn descriptor(self) -> ProjectedShadowDescriptor<'static> {
        ProjectedShadowDescriptor {
            label: Some("compare"),
            layer_size: self.size,
            memory: 512 << 20,
            cache: false,
        }
    }

    pub(super) fn settings(self) -> Value {
        json!({
            "tile_texels": self.size,
            "receivers": match self.on_casters {
                true => "all",
                false => "what does not cast",
            },
        })
    }

    pub(crate) fn snippet(self) -> String {
        format!(
            "let projected = ProjectedShadowDescriptor {{\n    layer_size: {},\n    ..Default::default()\n}};\n",
            self.size
        )
    }

    pub(super) fn make(
        self,
        gpu: &Gpu,
        renderer: &Renderer,
    ) -> Result<(Box<dyn SurveyShadow>, LitPipeline)> {
        let shadow = ProjectedShadow::new(&gpu.device, &self.descriptor())?;
        let none = match self.on_casters {
            true => "false",
            false => "host_object.glow.w > 0.0",
        };
        let module = shadow.wgsl_module(1) + &ASKS.replace("RECEIVES_NONE", none);
        let access = ShadowAccess {
            module: Some(&module),
            layout: Some(shadow.bind_group_layout()),
            ..Default::default()
        };
        let lit = renderer.lit_pipeline(gpu, &access);
        Ok((Box::new(AtWork { shadow, of: self }), lit))
    }
}

struct AtWork {
    shadow: ProjectedShadow,
    of: Projected,
}

impl SurveyShadow for AtWork {
    fn prepare(&mut self, gpu: &Gpu, inputs: &ShadowInputs) -> Result<()> {
        let casters = inputs.casters.iter().cloned();
        let casters: Vec<ProjectedCaster> = casters.map(ProjectedCaster::opaque).collect();
        let light = light(inputs);
        let shadow = &mut self.shadow;
        let prepare = |shadow: &mut ProjectedShadow, projectors: &[Projector<'_>]| {
            shadow.prepare(&gpu.device, &gpu.queue, &ProjectedFrame { projectors })
        };
        let together = Projector::new(light, &casters).with_size(self.of.size);
        prepare(shadow, &[together])?;
        if shadow.state(0) == Some(ProjectorState::Surrounded) {
            let each = casters.chunks(1);
            let each = each.map(|one| Projector::new(light, one).with_size(self.of.size / 4));
            prepare(shadow, &each.collect::<Vec<_>>())?;
        }
        Ok(())
    }

    fn generate(&mut self, _: &Renderer, _: &SceneGpu, encoder: &mut wgpu::CommandEncoder) {
        self.shadow.encode(encoder);
    }

    fn group(&self) -> Option<&wgpu::BindGroup> {
        Some(self.shadow.bind_group())
    }

    fn cost(&self) -> Cost {
        let taken = self.shadow.statistics();
        Cost {
            bytes: taken.bytes,
            draws: taken.draws.into(),
            triangles: taken.triangles,
        }
    }

    fn interior(&self) -> Interior {
        // Where there are several, resolution excuses nothing but what the screen does.
        match (self.shadow.clip_from_world(0), self.shadow.state(1)) {
            (Some(clip_from_world), None) => Interior::FlatMap {
                clip_from_world,
                size: self.of.size,
                kernel_radius: KERNEL_RADIUS,
            },
            _ => Interior::Screen,
        }
    }
}
