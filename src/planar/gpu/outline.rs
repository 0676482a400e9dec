//! The polygons of planes.

use glam::Vec3;

use crate::map::buffer;
use crate::planar::axes::PlaneAxes;
use crate::uploads::Uploads;

/// A corner along the plane's axes.
pub(crate) type Corner = [f32; 2];

/// Bytes of one [`Corner`].
pub(crate) const CORNER_SIZE: u64 = size_of::<Corner>() as u64;

/// A polygon as a fan of triangles: a point is inside where an odd number of them covers it.
#[derive(Debug)]
pub(crate) struct OutlineGpu {
    label: String,
    buffer: wgpu::Buffer,
    corners: Vec<Corner>,
    written: bool,
}

impl OutlineGpu {
    pub fn new(device: &wgpu::Device, label: &str) -> Self {
        let label = format!("{label} outline");
        Self {
            buffer: buffer(device, &label, CORNER_SIZE, wgpu::BufferUsages::VERTEX),
            corners: Vec::new(),
            written: true,
            label,
        }
    }

    /// Bytes that a polygon of so many corners takes.
    pub fn size(corners: usize) -> u64 {
        3 * CORNER_SIZE * (corners as u64).saturating_sub(2)
    }

    /// Takes over a polygon in world space; none has no corners.
    pub fn update(
        &mut self,
        (device, uploads): (&wgpu::Device, &mut Uploads),
        axes: &PlaneAxes,
        polygon: &[Vec3],
    ) {
        let place = |corner: &Vec3| {
            axes.place(corner.as_dvec3())
                .truncate()
                .as_vec2()
                .to_array()
        };
        let corners: Vec<Corner> = polygon.iter().map(place).collect();
        let edges = corners.windows(2).skip(1);
        let fan: Vec<Corner> = edges
            .flat_map(|edge| [corners[0], edge[0], edge[1]])
            .collect();
        if self.written && self.corners == fan {
            return;
        }
        let size = fan.len() as u64 * CORNER_SIZE;
        if size > self.buffer.size() {
            self.buffer = buffer(device, &self.label, size, wgpu::BufferUsages::VERTEX);
        }
        uploads.write(&self.buffer, 0, bytemuck::cast_slice(&fan));
        self.corners = fan;
        self.written = true;
    }

    /// Takes nothing for written.
    pub fn forget(&mut self) {
        self.written = self.corners.is_empty();
    }

    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    pub fn bytes(&self) -> u64 {
        self.buffer.size()
    }

    /// Draws it, with the pipeline and the bind group set.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.buffer.slice(..));
        pass.draw(0..self.corners.len() as u32, 0..1);
    }
}
