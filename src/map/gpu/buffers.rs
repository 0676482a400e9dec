//! Buffers that are written by copies.

pub(crate) fn buffer(
    device: &wgpu::Device,
    label: &str,
    size: u64,
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// The largest buffer that copies can fill.
pub(crate) fn largest_buffer(device: &wgpu::Device) -> u64 {
    let limit = device.limits().max_buffer_size;
    limit - limit % wgpu::COPY_BUFFER_ALIGNMENT
}
