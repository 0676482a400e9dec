//! An atlas of 16 point lights in a ring above the 64 spheres, 256 texels a face, and what is done with a
//! frame of many tiles: a budget.

use std::f32::consts::TAU;

use anyhow::Result;
use shadows::glam::Vec3;
use shadows::{
    AtlasFrame, AtlasLight, Caster, PointLight, ShadowAtlas, ShadowAtlasDescriptor, TileSize,
};

use crate::clock::Bench;
use crate::stage::{Move, Stage, nudge};
use host::gpu::Gpu;

const LIGHTS: u32 = 16;
/// Of the 96 tiles: those of two lights.
const BUDGET: u32 = 12;

/// An atlas and its frame.
struct Many<'a> {
    gpu: &'a Gpu,
    atlas: ShadowAtlas,
    lights: Vec<AtlasLight>,
    casters: Vec<Caster>,
}

impl<'a> Many<'a> {
    fn new(stage: &Stage<'a>, lights: u32, budget: Option<u32>) -> Result<Self> {
        let descriptor = ShadowAtlasDescriptor {
            max_tiles_per_frame: budget,
            ..Default::default()
        };
        let place = |light: u32| {
            let (sin, cos) = (TAU * light as f32 / lights as f32).sin_cos();
            let one = stage.point();
            let light = PointLight {
                position: one.position + Vec3::new(6.0 * cos, 0.0, 6.0 * sin),
                ..one
            };
            AtlasLight::new(light).with_size(TileSize::Fixed(256))
        };
        let mut many = Self {
            gpu: stage.gpu,
            atlas: ShadowAtlas::new(&stage.gpu.device, &descriptor)?,
            lights: (0..lights).map(place).collect(),
            casters: stage.casters(),
        };
        many.prepare();
        many.encode();
        Ok(many)
    }

    fn prepare(&mut self) {
        let frame = AtlasFrame {
            lights: &self.lights,
            casters: &self.casters,
            ..Default::default()
        };
        self.atlas
            .prepare(&self.gpu.device, &self.gpu.queue, &frame)
            .expect("the frame is in range");
    }

    fn encode(&mut self) {
        self.gpu.run(|encoder| self.atlas.encode(encoder));
    }
}

pub fn all(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let all: (&str, Move) = ("all moving", nudge);
    let mut many = Many::new(stage, LIGHTS, None)?;
    frames(bench, &mut many, "16 lights", &[all, ("still", |_| {})]);
    let mut few = Many::new(stage, LIGHTS, Some(BUDGET))?;
    frames(bench, &mut few, "max_tiles_per_frame 12 of 96", &[all]);
    Ok(())
}

fn frames(bench: &mut Bench<'_>, many: &mut Many<'_>, name: &str, moved: &[(&str, Move)]) {
    for &(how, moving) in moved {
        let before = |many: &mut Many<'_>| {
            many.encode();
            moving(&mut many.casters);
        };
        let name = format!("atlas/prepare, {name}, {how}");
        bench.cpu(&name, many, before, Many::prepare);
    }
    for &(how, moving) in moved {
        let before = |many: &mut Many<'_>| {
            moving(&mut many.casters);
            many.prepare();
        };
        let name = format!("atlas/encode, {name}, {how}");
        bench.gpu(&name, many, before, |many, encoder| {
            many.atlas.encode(encoder);
        });
    }
}
