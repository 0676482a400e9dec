//! What receivers are told of the light of a map that has one.

use wgpu::util::DeviceExt as _;

use super::light_record::LightRecord;
use crate::uploads::Uploads;

/// The uniform on the GPU; until something is written, [`LightRecord::DARK`].
#[derive(Debug)]
pub(crate) struct LightBuffer {
    buffer: wgpu::Buffer,
    /// What it holds once the uploads are recorded.
    written: Option<LightRecord>,
}

impl LightBuffer {
    pub fn new(device: &wgpu::Device, label: &str) -> Self {
        Self {
            buffer: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(&format!("{label} light")),
                contents: bytemuck::bytes_of(&LightRecord::DARK),
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            }),
            written: None,
        }
    }

    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Uploads a light, if it is not what it was.
    pub fn write(&mut self, uploads: &mut Uploads, light: LightRecord) {
        if self.written.replace(light) != Some(light) {
            uploads.write(&self.buffer, 0, bytemuck::bytes_of(&light));
        }
    }

    /// Takes nothing for written.
    pub fn forget(&mut self) {
        self.written = None;
    }
}
