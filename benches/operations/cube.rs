//! A cube map of the 64 spheres, 1024 texels a face, and its cross.

use anyhow::Result;
use shadows::{
    Caster, CubeCross, CubeCrossDescriptor, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor,
    PointLight, wgpu,
};

use crate::clock::Bench;
use crate::stage::{Move, Stage, nudge};
use host::gpu::Gpu;
use host::renderer::SHADED;

/// A map and its frame.
struct Cube<'a> {
    gpu: &'a Gpu,
    map: CubeShadowMap,
    light: PointLight,
    casters: Vec<Caster>,
}

impl<'a> Cube<'a> {
    fn new(stage: &Stage<'a>, cache: bool) -> Result<Self> {
        let mut cube = Self {
            gpu: stage.gpu,
            map: stage.cube_map(cache)?,
            light: stage.point(),
            casters: stage.casters(),
        };
        cube.prepare();
        cube.encode();
        Ok(cube)
    }

    fn prepare(&mut self) {
        let frame = CubeFrame::new(self.light, &self.casters);
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
        "cube map/CubeShadowMap::new",
        &mut (),
        |()| {},
        |()| CubeShadowMap::new(device, &CubeShadowMapDescriptor::default()),
    );
    let mut cube = Cube::new(stage, true)?;
    let moved: [(&str, Move); 3] = [
        ("all moving", nudge),
        ("one moving", |casters| nudge(&mut casters[..1])),
        ("still", |_| {}),
    ];
    for (name, moving) in moved {
        let before = |cube: &mut Cube<'_>| {
            cube.encode();
            moving(&mut cube.casters);
        };
        let name = format!("cube map/prepare, {name}");
        bench.cpu(&name, &mut cube, before, Cube::prepare);
    }
    for (name, moving) in moved {
        let before = |cube: &mut Cube<'_>| {
            moving(&mut cube.casters);
            cube.prepare();
        };
        let name = format!("cube map/encode, {name}");
        bench.gpu(&name, &mut cube, before, |cube, encoder| {
            cube.map.encode(encoder);
        });
    }
    cross(bench, stage)
}

fn cross(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let device = &stage.gpu.device;
    let descriptor = CubeCrossDescriptor {
        color_format: SHADED,
        depth_stencil_format: Some(stage.host.depth_stencil_format()),
        ..Default::default()
    };
    bench.cpu(
        "cube cross/CubeCross::new",
        &mut (),
        |()| {},
        |()| CubeCross::new(device, &descriptor),
    );
    let cross = CubeCross::new(device, &descriptor)?;
    let mut cube = Cube::new(stage, true)?;
    bench.cpu(
        "cube cross/bind_group",
        &mut cube,
        |_| {},
        |cube| cross.bind_group(device, &cube.map).unwrap(),
    );
    let group = cross.bind_group(device, &cube.map)?;
    let draw = |_: &mut Cube<'_>, encoder: &mut wgpu::CommandEncoder| {
        cross.render(&mut stage.host.begin_overlay_pass(encoder), &group);
    };
    bench.gpu("cube cross/render", &mut cube, |_| {}, draw);
    Ok(())
}
