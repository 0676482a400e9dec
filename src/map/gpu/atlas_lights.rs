//! What receivers are told of the lights of an atlas.

use super::buffers::buffer;
use super::light_record::LightRecord;
use crate::uploads::Uploads;

/// The lights that a uniform buffer has room for on devices without storage buffers: all that WebGL 2 binds
/// of one is 16 KiB.
pub(crate) const UNIFORM_LIGHTS: u32 = (16_384 / size_of::<LightRecord>()) as u32;

/// Records in a buffer at least.
const LEAST: usize = 64;

/// The records of all lights in one buffer.
#[derive(Debug)]
pub(crate) struct AtlasLights {
    label: String,
    usage: wgpu::BufferUsages,
    buffer: wgpu::Buffer,
    /// What it holds once the uploads are recorded; `None`: not known.
    written: Vec<Option<LightRecord>>,
    /// From this place on it has never held a light.
    held: usize,
    /// The most that a shader can read.
    limit: usize,
    /// Of the texture that is bound beside it.
    texture_revision: u64,
    /// How often it was made anew.
    revision: u64,
    /// How often it was made anew or nothing taken for written.
    forgotten: u64,
}

impl AtlasLights {
    pub fn new(device: &wgpu::Device, label: &str) -> Self {
        let limits = device.limits();
        let storage = limits.max_storage_buffers_per_shader_stage > 0;
        let (usage, bytes) = match storage {
            true => (
                wgpu::BufferUsages::STORAGE,
                limits.max_storage_buffer_binding_size,
            ),
            false => (
                wgpu::BufferUsages::UNIFORM,
                // Shaders declare so many, whatever more the device could bind.
                limits
                    .max_uniform_buffer_binding_size
                    .min(u64::from(UNIFORM_LIGHTS) * size_of::<LightRecord>() as u64),
            ),
        };
        let limit = (bytes.min(limits.max_buffer_size) / size_of::<LightRecord>() as u64) as usize;
        // Shaders are told how long an array in a uniform buffer is.
        let count = if storage { LEAST.min(limit) } else { limit };
        let label = format!("{label} lights");
        Self {
            buffer: make(device, &label, count, usage),
            written: vec![None; count],
            held: 0,
            label,
            usage,
            limit,
            texture_revision: 0,
            revision: 0,
            forgotten: 0,
        }
    }

    /// The most records that there may be.
    pub fn limit(&self) -> usize {
        self.limit
    }

    /// Makes room for so many records, and a new buffer if bind groups must be made again in any case.
    /// Those of the old one then read lights that are dark, for good: better that than shadows that are
    /// not there, or are somebody else's.
    pub fn reserve(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        count: usize,
        texture_revision: u64,
    ) {
        let grown = count > self.written.len();
        if !grown && texture_revision == self.texture_revision {
            return;
        }
        let room = match grown {
            true => count.next_power_of_two().min(self.limit),
            false => self.written.len(),
        };
        queue.write_buffer(&self.buffer, 0, &vec![0; self.buffer.size() as usize]);
        self.buffer = make(device, &self.label, room, self.usage);
        self.written = vec![None; room];
        self.held = 0;
        self.texture_revision = texture_revision;
        self.revision += 1;
        self.forgotten += 1;
    }

    /// Changes with the buffer.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Uploads one, if it is not what it was.
    pub fn write(&mut self, uploads: &mut Uploads, place: usize, record: LightRecord) {
        self.held = self.held.max(place + 1);
        if self.written[place].replace(record) != Some(record) {
            let bytes = bytemuck::bytes_of(&record);
            uploads.write(&self.buffer, (place * bytes.len()) as u64, bytes);
        }
    }

    /// Has all places from one on hold no light.
    pub fn end(&mut self, uploads: &mut Uploads, from: usize) {
        for place in from..self.held {
            self.write(uploads, place, LightRecord::DARK);
        }
    }

    /// Takes nothing for written.
    pub fn forget(&mut self) {
        self.written.fill(None);
        self.forgotten += 1;
    }

    /// Changes when what was written must be written again.
    pub fn forgotten(&self) -> u64 {
        self.forgotten
    }

    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }
}

fn make(
    device: &wgpu::Device,
    label: &str,
    count: usize,
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    let size = (count * size_of::<LightRecord>()) as u64;
    // WebGPU has buffers begin with zeros, which is a light that is dark.
    buffer(device, label, size, usage)
}
