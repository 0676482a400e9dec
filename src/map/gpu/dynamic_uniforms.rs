//! Uniforms of one buffer, picked by dynamic offset.

use super::buffers::{buffer, largest_buffer};
use crate::uploads::Uploads;

/// Bytes from one uniform to the next: the largest alignment a device may ask for.
const STRIDE: u64 = 256;

/// Uniforms that draws are told apart by, and the bind group that has them at binding 0.
#[derive(Debug)]
pub(crate) struct DynamicUniforms<T> {
    label: String,
    buffer: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    /// What they hold once the uploads are recorded.
    written: Vec<Option<T>>,
}

impl<T: bytemuck::Pod + PartialEq> DynamicUniforms<T> {
    /// Of at least one.
    pub fn new(device: &wgpu::Device, label: String, count: usize) -> Self {
        const { assert!(size_of::<T>() as u64 <= STRIDE) };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(&label),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: true,
                    min_binding_size: wgpu::BufferSize::new(size_of::<T>() as u64),
                },
                count: None,
            }],
        });
        let count = count.max(1);
        let (buffer, group) = make::<T>(device, &label, &layout, count);
        Self {
            label,
            buffer,
            layout,
            group,
            written: vec![None; count],
        }
    }

    /// Bytes that so many take.
    pub fn size(count: usize) -> u64 {
        (count as u64).saturating_mul(STRIDE)
    }

    /// The most bytes that there can be: dynamic offsets have 32 bits.
    pub fn most(device: &wgpu::Device) -> u64 {
        largest_buffer(device).min(u64::from(u32::MAX))
    }

    /// Makes room for so many, which [`most`](Self::most) holds; those that were written are written again.
    pub fn reserve(&mut self, device: &wgpu::Device, count: usize) {
        if count > self.written.len() {
            let most = (Self::most(device) / STRIDE) as usize;
            let count = count.next_power_of_two().min(most.max(count));
            (self.buffer, self.group) = make::<T>(device, &self.label, &self.layout, count);
            self.written = vec![None; count];
        }
    }

    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    pub fn bytes(&self) -> u64 {
        self.buffer.size()
    }

    /// Uploads one, if it is not what it was.
    pub fn write(&mut self, uploads: &mut Uploads, index: usize, uniform: T) {
        if self.written[index].replace(uniform) != Some(uniform) {
            let offset = index as u64 * STRIDE;
            uploads.write(&self.buffer, offset, bytemuck::bytes_of(&uniform));
        }
    }

    /// Takes nothing for written.
    pub fn forget(&mut self) {
        self.written.fill(None);
    }

    /// Binds one, in group 0.
    pub fn bind(&self, pass: &mut wgpu::RenderPass<'_>, index: usize) {
        pass.set_bind_group(0, &self.group, &[index as u32 * STRIDE as u32]);
    }
}

fn make<T>(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    count: usize,
) -> (wgpu::Buffer, wgpu::BindGroup) {
    let size = count as u64 * STRIDE;
    let buffer = buffer(device, label, size, wgpu::BufferUsages::UNIFORM);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &buffer,
                offset: 0,
                size: wgpu::BufferSize::new(size_of::<T>() as u64),
            }),
        }],
    });
    (buffer, group)
}
