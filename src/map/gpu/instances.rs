//! Where casters are relative to their light, for instanced draws.

use glam::DAffine3;

use super::buffers::buffer;
use crate::uploads::Uploads;

/// The rows of a caster's map to positions relative to the light.
pub(crate) type Instance = [[f32; 4]; 3];

/// Bytes of one [`Instance`].
pub(crate) const INSTANCE_SIZE: u64 = size_of::<Instance>() as u64;

pub(crate) fn instance(light_from_object: &DAffine3) -> Instance {
    let linear = light_from_object.matrix3.transpose();
    let offset = light_from_object.translation;
    [
        linear.x_axis.extend(offset.x).as_vec4().to_array(),
        linear.y_axis.extend(offset.y).as_vec4().to_array(),
        linear.z_axis.extend(offset.z).as_vec4().to_array(),
    ]
}

/// Bytes that are needed, and that a buffer of the device may have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TooLarge {
    pub size: u64,
    pub limit: u64,
}

/// The instances of all draws of a frame.
#[derive(Debug)]
pub(crate) struct Instances {
    label: String,
    buffer: wgpu::Buffer,
}

impl Instances {
    pub fn new(device: &wgpu::Device, label: &str) -> Self {
        let label = format!("{label} instances");
        Self {
            buffer: Self::make(device, &label, 1),
            label,
        }
    }

    fn make(device: &wgpu::Device, label: &str, count: u64) -> wgpu::Buffer {
        buffer(
            device,
            label,
            count * INSTANCE_SIZE,
            wgpu::BufferUsages::VERTEX,
        )
    }

    /// Makes room for so many.
    pub fn reserve(&mut self, device: &wgpu::Device, count: usize) -> Result<(), TooLarge> {
        let limit = device.limits().max_buffer_size;
        let size = count as u64 * INSTANCE_SIZE;
        if size > limit {
            return Err(TooLarge { size, limit });
        }
        if size > self.buffer.size() {
            let room = (count.next_power_of_two() as u64).min(limit / INSTANCE_SIZE);
            self.buffer = Self::make(device, &self.label, room);
        }
        Ok(())
    }

    /// Uploads them, after [`reserve`](Self::reserve) for as many.
    pub fn write(&self, uploads: &mut Uploads, instances: &[Instance]) {
        uploads.write(&self.buffer, 0, bytemuck::cast_slice(instances));
    }

    pub fn slice(&self, first: u64, count: u32) -> wgpu::BufferSlice<'_> {
        let first = first * INSTANCE_SIZE;
        self.buffer
            .slice(first..first + u64::from(count) * INSTANCE_SIZE)
    }

    pub fn bytes(&self) -> u64 {
        self.buffer.size()
    }
}
