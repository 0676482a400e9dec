//! Flat maps of the 64 spheres, 2048 texels, for a spot and a directional light.

use anyhow::Result;
use shadows::{Caster, FlatLight, ShadowFrame, ShadowMap, ShadowMapDescriptor};

use crate::clock::Bench;
use crate::stage::{Move, Stage, nudge};
use host::gpu::Gpu;

/// A map and its frame.
pub struct Flat<'a> {
    gpu: &'a Gpu,
    pub map: ShadowMap,
    light: FlatLight,
    casters: Vec<Caster>,
}

impl<'a> Flat<'a> {
    /// With its texels drawn.
    pub fn new(stage: &Stage<'a>, light: FlatLight) -> Result<Self> {
        let map = ShadowMap::new(&stage.gpu.device, &ShadowMapDescriptor::default())?;
        let mut flat = Self {
            gpu: stage.gpu,
            map,
            light,
            casters: stage.casters(),
        };
        flat.prepare();
        flat.encode();
        Ok(flat)
    }

    fn prepare(&mut self) {
        let frame = ShadowFrame::new(self.light, &self.casters);
        self.map
            .prepare(&self.gpu.device, &self.gpu.queue, &frame)
            .expect("the frame is in range");
    }

    fn encode(&mut self) {
        self.gpu.run(|encoder| self.map.encode(encoder));
    }
}

pub fn all(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let device = &stage.gpu.device;
    bench.cpu(
        "flat map/ShadowMap::new",
        &mut (),
        |()| {},
        |()| ShadowMap::new(device, &ShadowMapDescriptor::default()),
    );
    for (kind, light) in stage.flat_lights() {
        let mut flat = Flat::new(stage, light)?;
        let moved: [(&str, Move); 2] = [("all moving", nudge), ("still", |_| {})];
        for (name, moving) in moved {
            let before = |flat: &mut Flat<'_>| {
                flat.encode();
                moving(&mut flat.casters);
            };
            let name = format!("flat map/prepare, {kind}, {name}");
            bench.cpu(&name, &mut flat, before, Flat::prepare);
        }
        let before = |flat: &mut Flat<'_>| {
            nudge(&mut flat.casters);
            flat.prepare();
        };
        let name = format!("flat map/encode, {kind}, all moving");
        bench.gpu(&name, &mut flat, before, |flat, encoder| {
            flat.map.encode(encoder);
        });
    }
    Ok(())
}
