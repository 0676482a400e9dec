//! A mesh of 100,000 triangles, from the host's lists to a caster.

use std::hint::black_box;

use anyhow::Result;
use shadows::glam::{DAffine3, DVec3};
use shadows::mesh::Adjacency;
use shadows::{Caster, CasterMesh, HostMesh, wgpu};
use wgpu::util::{BufferInitDescriptor, DeviceExt as _};

use crate::clock::Bench;
use crate::deformed::Deformed;
use crate::shared::torus::torus;
use host::gpu::Gpu;

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
    let host = Deformed::new(gpu, &positions)?;
    bench.cpu(
        "mesh/CasterMesh::from_host_positions",
        &mut (),
        |()| {},
        |()| CasterMesh::from_host_positions(&gpu.device, &host.positions(), &adjacency),
    );
    let contents = bytemuck::cast_slice(&indices);
    let index_buffer = gpu.device.create_buffer_init(&BufferInitDescriptor {
        label: None,
        contents,
        usage: wgpu::BufferUsages::INDEX,
    });
    let at = host.positions();
    let for_maps = HostMesh {
        vertices: at.buffer,
        stride: at.stride,
        offset: at.offset,
        indices: &index_buffer,
        index_format: wgpu::IndexFormat::Uint32,
        index_offset: 0,
        index_count: indices.len() as u32,
        bounds: at.bounds,
    };
    bench.cpu(
        "mesh/CasterMesh::from_host",
        &mut (),
        |()| {},
        |()| CasterMesh::from_host(&gpu.device, &for_maps),
    );
    let mesh = CasterMesh::new(&gpu.device, &positions, &adjacency)?;
    let (place, origin) = (DAffine3::IDENTITY, DVec3::new(1e6, 0.0, 1e6));
    bench.plain("mesh/Caster::placed", || {
        Caster::placed(mesh.clone(), black_box(place), origin)
    });
    Ok(())
}
