//! The matrices of tiles, for the shader that draws casters.

use super::buffers::buffer;
use crate::uploads::Uploads;

/// Bytes from one uniform to the next: the largest alignment a device may ask for.
pub(crate) const UNIFORM_STRIDE: u64 = 256;

/// `ShadowsCubeFaceUniform` in WGSL.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct TileUniform {
    clip_from_light: [f32; 16],
    range: f32,
    /// Of the map's side, where that is 2 wide.
    texel: f32,
    padding: [f32; 2],
}

impl TileUniform {
    /// `size`: texels along a side of the map.
    pub fn new(clip_from_light: &glam::Mat4, range: f32, size: u32) -> Self {
        Self {
            clip_from_light: clip_from_light.to_cols_array(),
            range,
            texel: 2.0 / size as f32,
            padding: [0.0; 2],
        }
    }
}

/// The uniforms of all tiles of a map, picked by dynamic offset.
#[derive(Debug)]
pub(crate) struct TileUniforms {
    label: String,
    buffer: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    /// What they hold once the uploads are recorded.
    written: Vec<Option<TileUniform>>,
}

impl TileUniforms {
    pub fn new(device: &wgpu::Device, label: &str, count: usize) -> Self {
        let label = format!("{label} faces");
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(&label),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: true,
                    min_binding_size: wgpu::BufferSize::new(size_of::<TileUniform>() as u64),
                },
                count: None,
            }],
        });
        let (buffer, group) = make(device, &label, &layout, count);
        Self {
            label,
            buffer,
            layout,
            group,
            written: vec![None; count],
        }
    }

    /// Makes room for so many; those that were written are written again.
    pub fn reserve(&mut self, device: &wgpu::Device, count: usize) {
        if count > self.written.len() {
            let count = count.next_power_of_two();
            (self.buffer, self.group) = make(device, &self.label, &self.layout, count);
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
    pub fn write(&mut self, uploads: &mut Uploads, index: usize, uniform: TileUniform) {
        if self.written[index].replace(uniform) != Some(uniform) {
            let offset = index as u64 * UNIFORM_STRIDE;
            uploads.write(&self.buffer, offset, bytemuck::bytes_of(&uniform));
        }
    }

    /// Takes nothing for written.
    pub fn forget(&mut self) {
        self.written.fill(None);
    }

    pub fn bind(&self, pass: &mut wgpu::RenderPass<'_>, index: usize) {
        pass.set_bind_group(0, &self.group, &[index as u32 * UNIFORM_STRIDE as u32]);
    }
}

fn make(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    count: usize,
) -> (wgpu::Buffer, wgpu::BindGroup) {
    let size = count as u64 * UNIFORM_STRIDE;
    let buffer = buffer(device, label, size, wgpu::BufferUsages::UNIFORM);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &buffer,
                offset: 0,
                size: wgpu::BufferSize::new(size_of::<TileUniform>() as u64),
            }),
        }],
    });
    (buffer, group)
}
