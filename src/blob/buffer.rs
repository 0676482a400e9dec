//! The blobs on the GPU, of which only what has changed is written.

use super::ellipsoid::Blob;
use super::records::BlobRecord;
use crate::map::buffer;
use crate::runs::Runs;
use crate::uploads::Uploads;

/// Before the blobs: their number.
pub(super) const HEADER: u64 = 16;
const RECORD: u64 = size_of::<BlobRecord>() as u64;
/// Records at first.
const LEAST: u64 = 64;

/// The buffer that decals are instances of and receivers read.
#[derive(Debug)]
pub(super) struct BlobBuffer {
    label: String,
    usage: wgpu::BufferUsages,
    buffer: wgpu::Buffer,
    /// What the records were made from.
    blobs: Vec<Blob>,
    records: Vec<BlobRecord>,
    /// How many of them cast nothing.
    without_shadow: u32,
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
        let usage = wgpu::BufferUsages::VERTEX | storage;
        Self {
            label: label.to_owned(),
            usage,
            buffer: buffer(device, label, HEADER + LEAST * RECORD, usage),
            blobs: Vec::new(),
            records: Vec::new(),
            without_shadow: 0,
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

    /// Takes over a list of blobs and uploads those that are not what they were; tells how many.
    ///
    /// `may_differ`: places below `count` and blobs there, in order, among them all that differ.
    pub fn write(
        &mut self,
        uploads: &mut Uploads,
        count: usize,
        may_differ: impl Iterator<Item = (usize, Blob)>,
    ) -> u32 {
        let mut changed = 0;
        let mut runs = Runs::default();
        for (at, blob) in may_differ {
            if self.blobs.get(at) == Some(&blob) {
                continue;
            }
            changed += 1;
            self.set(at, blob);
            if at < self.written {
                runs.add(at..at + 1);
            }
        }
        let gone = self.records.get(count..).unwrap_or_default();
        self.without_shadow -= gone.iter().filter(|record| !record.casts()).count() as u32;
        self.records.truncate(count);
        self.blobs.truncate(count);
        if self.written < count {
            runs.add(self.written..count);
        }
        self.written = count;
        runs.write(uploads, (&self.buffer, HEADER), &self.records);
        if self.count.replace(count as u32) != Some(count as u32) {
            let header = [count as u32, 0, 0, 0];
            uploads.write(&self.buffer, 0, bytemuck::bytes_of(&header));
        }
        changed
    }

    /// Puts a blob in place of another, or behind the last.
    fn set(&mut self, at: usize, blob: Blob) {
        let record = BlobRecord::new(&blob);
        self.without_shadow += u32::from(!record.casts());
        match self.records.get_mut(at) {
            Some(old) => {
                self.without_shadow -= u32::from(!old.casts());
                (*old, self.blobs[at]) = (record, blob);
            }
            None => {
                self.records.push(record);
                self.blobs.push(blob);
            }
        }
    }

    pub fn len(&self) -> u32 {
        self.records.len() as u32
    }

    pub fn without_shadow(&self) -> u32 {
        self.without_shadow
    }
}
