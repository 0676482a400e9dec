//! A cube map of 16 lights in a ring above the 64 spheres, 256 texels a face, and what is done with a
//! frame of many faces: a budget.

use std::f32::consts::TAU;

use anyhow::Result;
use shadows::glam::Vec3;
use shadows::{Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, PointLight};

use crate::clock::Bench;
use crate::stage::{Move, Stage, nudge};
use host::gpu::Gpu;

const LIGHTS: u32 = 16;
/// Of the 96 faces: those of two lights.
const BUDGET: u32 = 12;

/// A map and its frame.
struct Many<'a> {
    gpu: &'a Gpu,
    map: CubeShadowMap,
    lights: Vec<PointLight>,
    casters: Vec<Caster>,
}

impl<'a> Many<'a> {
    fn new(stage: &Stage<'a>, lights: u32, options: CubeShadowMapDescriptor<'_>) -> Result<Self> {
        let descriptor = CubeShadowMapDescriptor {
            size: 256,
            lights,
            cube_array: true,
            ..options
        };
        let place = |light: u32| {
            let (sin, cos) = (TAU * light as f32 / lights as f32).sin_cos();
            let one = stage.point();
            PointLight {
                position: one.position + Vec3::new(6.0 * cos, 0.0, 6.0 * sin),
                ..one
            }
        };
        let mut many = Self {
            gpu: stage.gpu,
            map: CubeShadowMap::new(&stage.gpu.device, &descriptor)?,
            lights: (0..lights).map(place).collect(),
            casters: stage.casters(),
        };
        many.prepare();
        many.encode();
        Ok(many)
    }

    fn prepare(&mut self) {
        let frame = CubeFrame {
            lights: &self.lights,
            casters: &self.casters,
            ..Default::default()
        };
        self.map
            .prepare(&self.gpu.device, &self.gpu.queue, &frame)
            .expect("the frame is in range");
    }

    fn encode(&mut self) {
        self.gpu.run(|encoder| self.map.encode(encoder));
    }
}

pub fn all(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let all: (&str, Move) = ("all moving", nudge);
    let mut many = Many::new(stage, LIGHTS, Default::default())?;
    frames(bench, &mut many, "16 lights", &[all, ("still", |_| {})]);
    let budget = CubeShadowMapDescriptor {
        max_faces_per_frame: Some(BUDGET),
        ..Default::default()
    };
    let mut few = Many::new(stage, LIGHTS, budget)?;
    frames(bench, &mut few, "max_faces_per_frame 12 of 96", &[all]);
    Ok(())
}

fn frames(bench: &mut Bench<'_>, many: &mut Many<'_>, name: &str, moved: &[(&str, Move)]) {
    for &(how, moving) in moved {
        let before = |many: &mut Many<'_>| {
            many.encode();
            moving(&mut many.casters);
        };
        let name = format!("cube map/prepare, {name}, {how}");
        bench.cpu(&name, many, before, Many::prepare);
    }
    for &(how, moving) in moved {
        let before = |many: &mut Many<'_>| {
            moving(&mut many.casters);
            many.prepare();
        };
        let name = format!("cube map/encode, {name}, {how}");
        bench.gpu(&name, many, before, |many, encoder| {
            many.map.encode(encoder);
        });
    }
}
