//! Buffers that grow, and are kept between frames.

use crate::uploads::Uploads;

/// A buffer that grows.
#[derive(Debug)]
pub(crate) struct Grown {
    label: String,
    usage: wgpu::BufferUsages,
    pub buffer: Option<wgpu::Buffer>,
    /// Whether later frames read what this one writes.
    keeps: bool,
    /// What [`write_changed`](Self::write_changed) has written.
    written: Vec<u8>,
}

impl Grown {
    pub fn new(label: String, usage: wgpu::BufferUsages) -> Self {
        Self {
            label,
            usage,
            buffer: None,
            keeps: false,
            written: Vec::new(),
        }
    }

    /// One that takes along what it holds when it grows.
    pub fn keeping(label: String, usage: wgpu::BufferUsages) -> Self {
        use wgpu::BufferUsages as U;
        Self {
            keeps: true,
            ..Self::new(label, usage | U::COPY_SRC | U::COPY_DST)
        }
    }

    /// Has the items written that are not there yet, so many of them in a window, and so many bytes from one
    /// window to the next.
    pub fn write_changed<T: bytemuck::NoUninit>(
        &mut self,
        uploads: &mut Uploads,
        (items, each): (&[T], usize),
        window: u32,
    ) {
        let Some(buffer) = &self.buffer else { return };
        let bytes = spread_runs(items, each, window);
        let windows = bytes.chunks(window as usize);
        for (offset, new) in (0..).step_by(window as usize).zip(windows) {
            let old = self.written.get(offset..offset + new.len());
            if old != Some(new) {
                uploads.write(buffer, offset as u64, new);
            }
        }
        self.written = bytes;
    }

    /// Has all of it written again, whatever was written before.
    pub fn renew(&mut self) {
        self.written.clear();
    }

    pub fn size(&self) -> u64 {
        self.buffer.as_ref().map_or(0, wgpu::Buffer::size)
    }
}

/// Makes buffers large enough.
pub(crate) struct Grower<'a> {
    pub device: &'a wgpu::Device,
    pub uploads: &'a mut Uploads,
    /// Whether one was made.
    pub made: bool,
}

impl Grower<'_> {
    /// Room for at least `size` bytes, `most` being the largest buffer that there can be.
    pub fn grow(&mut self, grown: &mut Grown, size: u64, most: u64) {
        if grown.buffer.is_some() && grown.size() >= size {
            return;
        }
        // A frame that needs a little more than the last should not allocate again.
        let room = size.max(256).next_power_of_two().min(most).max(size);
        let new = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(&grown.label),
            size: room,
            usage: grown.usage,
            mapped_at_creation: false,
        });
        if let Some(old) = grown.buffer.as_ref().filter(|_| grown.keeps) {
            self.uploads.replace(old, &new);
        }
        grown.buffer = Some(new);
        self.made = true;
    }
}

/// Items one after another, so many bytes apart.
pub(crate) fn spread<T: bytemuck::NoUninit>(items: &[T], window: u32) -> Vec<u8> {
    spread_runs(items, 1, window)
}

/// The same of runs of so many items.
fn spread_runs<T: bytemuck::NoUninit>(items: &[T], each: usize, window: u32) -> Vec<u8> {
    let (runs, window) = (items.chunks_exact(each), window as usize);
    let mut bytes = vec![0; window * runs.len()];
    for (target, run) in bytes.chunks_exact_mut(window).zip(runs) {
        target[..size_of_val(run)].copy_from_slice(bytemuck::cast_slice(run));
    }
    bytes
}
