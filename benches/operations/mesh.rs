//! A mesh of 100,000 triangles, from the host's lists to a caster.

use std::hint::black_box;

use anyhow::{Context as _, Result};
use shadows::mesh::{Adjacency, Bounds};
use shadows::wgpu::util::DeviceExt as _;
use shadows::{CasterMesh, HostPositions, wgpu};

use crate::clock::Bench;
use crate::host::gpu::Gpu;
use crate::shared::torus::torus;

pub fn all(bench: &mut Bench<'_>, gpu: &Gpu) -> Result<()> {
    let (positions, indices) = torus(500, 100);
    bench.plain("mesh/Adjacency::new", || {
        Adjacency::new(black_box(&positions), black_box(&indices))
    });
    // A thousandth of an edge's length or less: nothing welds, everything is looked at.
    bench.plain("mesh/Adjacency::with_tolerance", || {
        Adjacency::with_tolerance(black_box(&positions), black_box(&indices), 1e-5)
    });
    let adjacency = Adjacency::new(&positions, &indices)?;
    let six = adjacency.indices();
    bench.plain("mesh/Adjacency::from_raw", || {
        Adjacency::from_raw(black_box(&positions), black_box(six))
    });
    bench.cpu(
        "mesh/CasterMesh::new",
        &mut (),
        |()| {},
        |()| CasterMesh::new(&gpu.device, &positions, &adjacency),
    );
    let buffer = wgpu::util::BufferInitDescriptor {
        label: Some("host's positions"),
        contents: bytemuck::cast_slice(&positions),
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE,
    };
    let buffer = gpu.device.create_buffer_init(&buffer);
    let points = positions.iter().map(|&position| position.into());
    let host = HostPositions {
        buffer: &buffer,
        stride: 12,
        offset: 0,
        bounds: Bounds::of_points(points).context("no positions")?,
    };
    bench.cpu(
        "mesh/CasterMesh::from_host_positions",
        &mut (),
        |()| {},
        |()| CasterMesh::from_host_positions(&gpu.device, &host, &adjacency),
    );
    Ok(())
}
