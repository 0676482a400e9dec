//! Buffers of meshes on the GPU.

use wgpu::util::DeviceExt as _;

use crate::error::CasterMeshError;

pub(super) fn upload<T: bytemuck::NoUninit>(
    device: &wgpu::Device,
    what: &'static str,
    data: &[T],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, CasterMeshError> {
    check_size(device, what, size_of_val(data) as u64)?;
    // A binding may not be empty, so an empty mesh still gets one zeroed element.
    let empty = [0u8; 16];
    let contents = if data.is_empty() {
        &empty[..]
    } else {
        bytemuck::cast_slice(data)
    };
    Ok(
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(&format!("shadows caster {what}")),
            contents,
            usage,
        }),
    )
}

/// `STORAGE`, or where the device has no storage buffers a usage that every buffer may have.
pub(super) fn storage_usage(device: &wgpu::Device) -> wgpu::BufferUsages {
    match device.limits().max_storage_buffers_per_shader_stage {
        0 => wgpu::BufferUsages::VERTEX,
        _ => wgpu::BufferUsages::STORAGE,
    }
}

pub(super) fn check_size(
    device: &wgpu::Device,
    what: &'static str,
    size: u64,
) -> Result<(), CasterMeshError> {
    let limits = device.limits();
    let bound = match storage_usage(device) {
        wgpu::BufferUsages::STORAGE => limits.max_storage_buffer_binding_size,
        _ => u64::MAX,
    };
    for (limit_name, limit) in [
        ("max_buffer_size", limits.max_buffer_size),
        ("max_storage_buffer_binding_size", bound),
    ] {
        if size > limit {
            return Err(CasterMeshError::TooLarge {
                what,
                size,
                limit_name,
                limit,
            });
        }
    }
    Ok(())
}
