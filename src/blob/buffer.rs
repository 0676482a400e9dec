//! The blobs on the GPU, of which only what has changed is written.

use super::ellipsoid::Blob;
use super::records::BlobRecord;
use crate::uploads::Uploads;

/// Before the blobs: their number.
pub(super) const HEADER: u64 = 16;
const RECORD: u64 = size_of::<BlobRecord>() as u64;
/// Records at first.
const LEAST: u64 = 64;
/// Records that are rather written again than left out between two that have changed: a copy costs more.
const GAP: usize = 16;

/// The buffer that decals are instances of and receivers read.
#[derive(Debug)]
pub(super) struct BlobBuffer {
    label: String,
    usage: wgpu::BufferUsages,
    buffer: wgpu::Buffer,
    /// What the records were made from.
    blobs: Vec<Blob>,
    records: Vec<BlobRecord>,
    /// How many of them the buffer holds once the uploads are recorded, and what count it holds.
    written: usize,
    count: Option<u32>,
}

impl BlobBuffer {
    pub fn new(device: &wgpu::Device, label: &str, storage: bool) -> Self {
        let storage = match storage {
            true => wgpu::BufferUsages::STORAGE,
            false => wgpu::BufferUsages::empty(),
        };
        let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST | storage;
        Self {
            label: label.to_owned(),
            usage,
            buffer: buffer(device, label, HEADER + LEAST * RECORD, usage),
            blobs: Vec::new(),
            records: Vec::new(),
            written: 0,
            count: None,
        }
    }

    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// The instances of decals.
    pub fn instances(&self) -> wgpu::BufferSlice<'_> {
        self.buffer.slice(HEADER..)
    }

    /// How many blobs a device's buffers hold.
    pub fn most(&self, device: &wgpu::Device) -> u64 {
        let limits = device.limits();
        let size = match self.usage.contains(wgpu::BufferUsages::STORAGE) {
            true => limits
                .max_buffer_size
                .min(limits.max_storage_buffer_binding_size),
            false => limits.max_buffer_size,
        };
        (size.saturating_sub(HEADER) / RECORD).min(u64::from(u32::MAX))
    }

    /// Makes room for so many blobs, no more than [`most`](Self::most). Whether the buffer is another one.
    pub fn reserve(&mut self, device: &wgpu::Device, count: usize) -> bool {
        let count = count as u64;
        if HEADER + count * RECORD <= self.buffer.size() {
            return false;
        }
        let capacity = count.next_power_of_two().min(self.most(device));
        let size = HEADER + capacity * RECORD;
        self.buffer = buffer(device, &self.label, size, self.usage);
        self.forget();
        true
    }

    /// Takes nothing for written.
    pub fn forget(&mut self) {
        self.written = 0;
        self.count = None;
    }

    /// Uploads those that are not what they were; tells how many.
    pub fn write(&mut self, uploads: &mut Uploads, blobs: impl Iterator<Item = Blob>) -> u32 {
        let mut changed = 0;
        let mut run: Option<std::ops::Range<usize>> = None;
        let mut count = 0;
        for (at, blob) in blobs.enumerate() {
            count = at + 1;
            let is_new = self.blobs.get(at) != Some(&blob);
            if is_new {
                changed += 1;
                let record = BlobRecord::new(&blob);
                match self.blobs.get_mut(at) {
                    Some(old) => (*old, self.records[at]) = (blob, record),
                    None => {
                        self.blobs.push(blob);
                        self.records.push(record);
                    }
                }
            }
            if !is_new && at < self.written {
                continue;
            }
            match &mut run {
                Some(run) if at <= run.end + GAP => run.end = at + 1,
                _ => {
                    if let Some(done) = run.replace(at..at + 1) {
                        self.upload(uploads, done);
                    }
                }
            }
        }
        if let Some(last) = run {
            self.upload(uploads, last);
        }
        self.blobs.truncate(count);
        self.records.truncate(count);
        self.written = count;
        if self.count.replace(count as u32) != Some(count as u32) {
            uploads.write(
                &self.buffer,
                0,
                bytemuck::bytes_of(&[count as u32, 0, 0, 0]),
            );
        }
        changed
    }

    fn upload(&self, uploads: &mut Uploads, run: std::ops::Range<usize>) {
        let at = HEADER + run.start as u64 * RECORD;
        uploads.write(&self.buffer, at, bytemuck::cast_slice(&self.records[run]));
    }

    pub fn len(&self) -> u32 {
        self.records.len() as u32
    }

    pub fn without_shadow(&self) -> u32 {
        self.records.iter().filter(|record| !record.casts()).count() as u32
    }
}

fn buffer(
    device: &wgpu::Device,
    label: &str,
    size: u64,
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage,
        mapped_at_creation: false,
    })
}
