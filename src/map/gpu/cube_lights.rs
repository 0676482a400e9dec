//! What receivers are told of the lights of a cube map.

use super::buffers::buffer;
use super::light_record::LightRecord;
use super::uniforms::UNIFORM_STRIDE;
use crate::support::has_storage;
use crate::uploads::Uploads;

/// What a uniform buffer of lights holds on devices without storage buffers: all that WebGL 2 binds of one.
const UNIFORM_BYTES: u64 = 16_384;

/// The lights that such a buffer has room for.
pub(crate) const UNIFORM_LIGHTS: u32 = (UNIFORM_BYTES / size_of::<LightRecord>() as u64) as u32;

/// The lights one by one and all together.
#[derive(Debug)]
pub(crate) struct CubeLights {
    label: String,
    buffers: Buffers,
    /// What they hold once the uploads are recorded, by place.
    written: Vec<Option<LightRecord>>,
    /// The revision of the bind groups that they are in.
    revision: u64,
}

#[derive(Debug)]
struct Buffers {
    /// One every [`UNIFORM_STRIDE`] bytes.
    uniforms: wgpu::Buffer,
    /// One after the other; only for maps whose lights share a texture.
    all: Option<wgpu::Buffer>,
}

impl Buffers {
    fn new(device: &wgpu::Device, label: &str, count: u64, array: bool) -> Self {
        let make = |stride, usage| buffer(device, label, count * stride, usage);
        let size = size_of::<LightRecord>() as u64;
        Self {
            uniforms: make(UNIFORM_STRIDE, wgpu::BufferUsages::UNIFORM),
            all: array.then(|| match has_storage(device) {
                true => make(size, wgpu::BufferUsages::STORAGE),
                false => buffer(device, label, UNIFORM_BYTES, wgpu::BufferUsages::UNIFORM),
            }),
        }
    }
}

impl CubeLights {
    pub fn new(
        device: &wgpu::Device,
        label: &str,
        count: usize,
        array: bool,
        revision: u64,
    ) -> Self {
        let label = format!("{label} lights");
        Self {
            buffers: Buffers::new(device, &label, count as u64, array),
            label,
            written: vec![None; count],
            revision,
        }
    }

    /// Gives the lights other buffers, once bind groups of the old ones must be made again. Those that
    /// are not read a light without range, which is dark, for good: better that than shadows that are
    /// not there, or are somebody else's.
    pub fn replace(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, revision: u64) {
        if std::mem::replace(&mut self.revision, revision) == revision {
            return;
        }
        let Buffers { uniforms, all } = &self.buffers;
        for old in std::iter::once(uniforms).chain(all) {
            queue.write_buffer(old, 0, &vec![0; old.size() as usize]);
        }
        let (count, array) = (self.written.len(), all.is_some());
        self.buffers = Buffers::new(device, &self.label, count as u64, array);
        self.forget();
    }

    /// Uploads one, if it is not what it was.
    pub fn write(&mut self, uploads: &mut Uploads, place: usize, uniform: LightRecord) {
        if self.written[place].replace(uniform) == Some(uniform) {
            return;
        }
        let bytes = bytemuck::bytes_of(&uniform);
        uploads.write(&self.buffers.uniforms, place as u64 * UNIFORM_STRIDE, bytes);
        if let Some(all) = &self.buffers.all {
            uploads.write(all, (place * bytes.len()) as u64, bytes);
        }
    }

    /// Takes nothing for written.
    pub fn forget(&mut self) {
        self.written.fill(None);
    }

    /// The light at a place, or the last.
    pub fn one(&self, place: usize) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &self.buffers.uniforms,
            offset: place.min(self.written.len() - 1) as u64 * UNIFORM_STRIDE,
            size: wgpu::BufferSize::new(size_of::<LightRecord>() as u64),
        })
    }

    /// All of them, where they share a texture.
    pub fn all(&self) -> Option<&wgpu::Buffer> {
        self.buffers.all.as_ref()
    }

    pub fn bytes(&self) -> u64 {
        let all = self.all().map_or(0, wgpu::Buffer::size);
        self.buffers.uniforms.size() + all
    }
}
