//! Frames of a mesh that the host deforms in its own buffer: 20,000 triangles, of which neither map
//! nor volume may keep anything. What the host writes there is its own affair and not timed.

use anyhow::{Context as _, Result};
use host::one_light::{OneLight, PrepareOne as _};
use shadows::glam::Affine3A;
use shadows::mesh::{Adjacency, Bounds};
use shadows::wgpu::util::DeviceExt as _;
use shadows::{
    Caster, CasterMesh, CubeFrame, CubeShadowMap, FlatLight, HostPositions, ShadowFrame, ShadowMap,
    ShadowMapDescriptor, ShadowVolumeDescriptor, ShadowVolumeRenderer, Silhouettes, wgpu,
};

use crate::clock::Bench;
use crate::shared::torus::torus;
use crate::stage::{SIZE, Stage};
use host::gpu::Gpu;
use host::renderer::DEPTH;

/// Positions in a buffer as a host would have them, and what encloses them.
pub struct Deformed {
    buffer: wgpu::Buffer,
    bounds: Bounds,
}

impl Deformed {
    pub fn new(gpu: &Gpu, positions: &[[f32; 3]]) -> Result<Self> {
        let buffer = wgpu::util::BufferInitDescriptor {
            label: Some("host's positions"),
            contents: bytemuck::cast_slice(positions),
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE,
        };
        let points = positions.iter().map(|&position| position.into());
        Ok(Self {
            buffer: gpu.device.create_buffer_init(&buffer),
            bounds: Bounds::of_points(points).context("no positions")?,
        })
    }

    pub fn positions(&self) -> HostPositions<'_> {
        HostPositions {
            buffer: &self.buffer,
            stride: 12,
            offset: 0,
            bounds: self.bounds,
        }
    }
}

/// What shows the mesh.
trait Shown {
    fn prepare(&mut self, stage: &Stage<'_>, casters: &[Caster]);
    fn encode(&mut self, encoder: &mut wgpu::CommandEncoder);
}

impl Shown for CubeShadowMap {
    fn prepare(&mut self, stage: &Stage<'_>, casters: &[Caster]) {
        let frame = CubeFrame::new(stage.point(), casters);
        self.prepare(&stage.gpu.device, &stage.gpu.queue, &frame)
            .expect("the frame is in range");
    }

    fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.encode(encoder);
    }
}

impl Shown for ShadowMap {
    fn prepare(&mut self, stage: &Stage<'_>, casters: &[Caster]) {
        let frame = ShadowFrame::new(FlatLight::Spot(stage.spot()), casters);
        self.prepare(&stage.gpu.device, &stage.gpu.queue, &frame)
            .expect("the frame is in range");
    }

    fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.encode(encoder);
    }
}

impl Shown for ShadowVolumeRenderer {
    fn prepare(&mut self, stage: &Stage<'_>, casters: &[Caster]) {
        let frame = OneLight {
            range: Some(stage.scene.light().range),
            target_size: Some(SIZE),
            receivers: Some(stage.receivers),
            ..OneLight::new(&stage.view, stage.light(), casters)
        };
        self.prepare_one(&stage.gpu.device, &stage.gpu.queue, &frame)
            .expect("the frame is in range");
    }

    fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        ShadowVolumeRenderer::encode(self, encoder);
    }
}

pub fn all(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let device = &stage.gpu.device;
    let (positions, indices) = torus(200, 50);
    let adjacency = Adjacency::new(&positions, &indices)?;
    let host = Deformed::new(stage.gpu, &positions)?;
    let mesh = CasterMesh::from_host_positions(device, &host.positions(), &adjacency)?;
    let casters = [Caster::new(mesh, Affine3A::IDENTITY)];
    frames(bench, stage, "cube map", &casters, stage.cube_map(true)?);
    let flat = ShadowMap::new(device, &ShadowMapDescriptor::default())?;
    frames(bench, stage, "flat map", &casters, flat);
    let descriptor = ShadowVolumeDescriptor {
        depth_stencil_format: stage.host.depth_stencil_format(),
        depth: DEPTH,
        silhouettes: Silhouettes::Compute, // the one way to read them there
        ..Default::default()
    };
    match ShadowVolumeRenderer::new(device, &descriptor) {
        Ok(volumes) => frames(bench, stage, "volumes", &casters, volumes),
        Err(missing) => println!("volumes of positions in the host's buffer: {missing:#}"),
    }
    Ok(())
}

fn frames<S: Shown>(
    bench: &mut Bench<'_>,
    stage: &Stage<'_>,
    group: &str,
    casters: &[Caster],
    mut shown: S,
) {
    let bump = || casters.iter().for_each(|c| c.mesh.bump_revision());
    shown.prepare(stage, casters);
    let before = |shown: &mut S| {
        stage.gpu.run(|encoder| shown.encode(encoder));
        bump();
    };
    let name = format!("{group}/prepare, from_host_positions, bump_revision");
    bench.cpu(&name, &mut shown, before, |shown| {
        shown.prepare(stage, casters);
    });
    let before = |shown: &mut S| {
        bump();
        shown.prepare(stage, casters);
    };
    let name = format!("{group}/encode, from_host_positions, bump_revision");
    bench.gpu(&name, &mut shown, before, |shown, encoder| {
        shown.encode(encoder);
    });
}
