//! A mesh in a buffer of the host's, which may deform it.

use shadows::glam::Vec3;
use shadows::mesh::{Adjacency, Bounds};
use shadows::{CasterMesh, HostPositions, wgpu};
use wgpu::util::DeviceExt as _;

use crate::common::shapes::{Shape, cuboid};
use host::gpu::Gpu;

pub struct Deformed {
    shape: Shape,
    buffer: wgpu::Buffer,
    pub mesh: CasterMesh,
}

impl Deformed {
    pub fn new(gpu: &Gpu) -> Self {
        let shape = cuboid(Vec3::splat(0.5));
        let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE;
        let init = wgpu::util::BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(&shape.positions),
            usage: usage | wgpu::BufferUsages::COPY_DST,
        };
        let buffer = gpu.device.create_buffer_init(&init);
        let positions = HostPositions {
            buffer: &buffer,
            stride: 12,
            offset: 0,
            bounds: Bounds {
                min: Vec3::splat(-2.0),
                max: Vec3::splat(2.0),
            },
        };
        let adjacency = Adjacency::new(&shape.positions, &shape.indices).unwrap();
        let mesh = CasterMesh::from_host_positions(&gpu.device, &positions, &adjacency).unwrap();
        Self {
            shape,
            buffer,
            mesh,
        }
    }

    pub fn deform(&self, gpu: &Gpu, factor: f32) {
        let moved: Vec<[f32; 3]> = self
            .shape
            .positions
            .iter()
            .map(|p| p.map(|x| x * factor))
            .collect();
        gpu.queue
            .write_buffer(&self.buffer, 0, bytemuck::cast_slice(&moved));
    }
}
