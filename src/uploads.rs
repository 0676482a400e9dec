//! What a frame writes into its buffers, as copies in the host's encoder.
//!
//! `Queue::write_buffer` comes before everything that is submitted with it: of two frames in one
//! submission, the second would overwrite what the first reads. A recorded copy comes where it was
//! recorded, and not at all where `encode` is forgotten or its encoder dropped: what receivers are told
//! of a light changes with its texels, and only with them.

use wgpu::util::StagingBelt;

/// Bytes of a staging buffer, if no single piece needs more.
const CHUNK: u64 = 1 << 16;

/// Bytes that go from one buffer to another.
#[derive(Clone, Debug)]
pub(crate) struct Copy {
    pub from: wgpu::Buffer,
    pub from_offset: u64,
    pub to: wgpu::Buffer,
    pub to_offset: u64,
    pub size: u64,
}

impl Copy {
    fn precedes(&self, next: &Self) -> bool {
        self.from_offset + self.size == next.from_offset
            && self.to_offset + self.size == next.to_offset
            && self.from == next.from
            && self.to == next.to
    }
}

/// The copies that the next encode records, and where their bytes wait.
#[derive(Debug)]
pub(crate) struct Uploads {
    belt: StagingBelt,
    /// The device's largest buffer, down to a size that can be mapped.
    limit: u64,
    /// Where what is written next waits.
    written: Option<Room>,
    /// What a buffer held that was made anew: copied before everything else.
    moved: Vec<Copy>,
    copies: Vec<Copy>,
    /// Whether bytes wait that were not recorded.
    waits: bool,
}

impl Uploads {
    pub fn new(device: &wgpu::Device) -> Self {
        let limit = crate::map::largest_buffer(device);
        Self {
            belt: StagingBelt::new(device.clone(), CHUNK.min(limit)),
            limit,
            written: None,
            moved: Vec::new(),
            copies: Vec::new(),
            waits: false,
        }
    }

    /// Bytes that the next [`record`](Self::record) copies, not counting what buffers held before they
    /// grew.
    pub fn bytes(&self) -> u64 {
        self.copies.iter().map(|copy| copy.size).sum()
    }

    /// Whether the next [`record`](Self::record) copies anything.
    pub fn is_waiting(&self) -> bool {
        !(self.moved.is_empty() && self.copies.is_empty())
    }

    /// Forgets what was written and never recorded; what buffers held before they grew is not
    /// forgotten.
    pub fn clear(&mut self) {
        self.copies.clear();
        self.written = None;
        if std::mem::take(&mut self.waits) {
            self.belt.finish();
            self.belt.recall();
        }
    }

    /// Writes into a buffer, no more than one may hold. Offset and length are multiples of 4.
    pub fn write(&mut self, to: &wgpu::Buffer, to_offset: u64, bytes: &[u8]) {
        let size = bytes.len() as u64;
        self.write_with(to, to_offset, size, |mut room| room.copy_from_slice(bytes));
    }

    /// Has `size` bytes written straight to where they wait.
    pub fn write_with(
        &mut self,
        to: &wgpu::Buffer,
        to_offset: u64,
        size: u64,
        write: impl FnOnce(wgpu::WriteOnly<'_, [u8]>),
    ) {
        if size == 0 {
            return;
        }
        if self.written.as_ref().is_none_or(|room| room.left() < size) {
            self.written = self.room(size);
        }
        let Some(room) = &mut self.written else {
            return;
        };
        let place = room.take(size);
        // Views begin at multiples of 8.
        let lead = place.start % wgpu::MAP_ALIGNMENT;
        let slice = room.buffer.slice(place.start - lead..place.end);
        let from = room.buffer.clone();
        // Fails only where the device is lost or out of memory, which it says itself.
        let Ok(mut view) = slice.get_mapped_range_mut() else {
            return;
        };
        write(view.slice(lead as usize..));
        self.copy(Copy {
            from,
            from_offset: place.start,
            to: to.clone(),
            to_offset,
            size,
        });
    }

    /// Has bytes written that wait for a copy, those of one stream one after another as far as
    /// buffers go; tells where they lie. Their number is a multiple of 4.
    pub fn stage(
        &mut self,
        stream: &mut Stream,
        size: u64,
        write: impl FnOnce(wgpu::WriteOnly<'_, [u8]>),
    ) -> Option<(wgpu::Buffer, u64)> {
        if size == 0 {
            return None;
        }
        let full = |block: &Block| block.room.left() < size;
        if stream.block.as_ref().is_none_or(full) {
            let room = self.room(size)?;
            stream.block = Some(Block {
                view: room.buffer.get_mapped_range_mut(room.next..room.end).ok()?,
                start: room.next,
                room,
            });
        }
        let block = stream.block.as_mut()?;
        let place = block.room.take(size);
        let [from, to] = [place.start, place.end].map(|at| (at - block.start) as usize);
        write(block.view.slice(from..to));
        Some((block.room.buffer.clone(), place.start))
    }

    fn room(&mut self, size: u64) -> Option<Room> {
        // Few sizes, so that a buffer that comes back fits again.
        let room = size.checked_next_power_of_two()?.max(CHUNK);
        let size = wgpu::BufferSize::new(room.min(self.limit).max(size))?;
        let alignment = wgpu::BufferSize::new(wgpu::MAP_ALIGNMENT)?;
        self.waits = true;
        let slice = self.belt.allocate(size, alignment);
        Some(Room {
            buffer: slice.buffer().clone(),
            next: slice.offset(),
            end: slice.offset() + size.get(),
        })
    }

    /// Has bytes copied after everything that was asked for before; with those that lie before them,
    /// here and there, in one copy.
    pub fn copy(&mut self, copy: Copy) {
        match self.copies.last_mut().filter(|last| last.precedes(&copy)) {
            Some(last) => last.size += copy.size,
            None => self.copies.push(copy),
        }
    }

    /// Has a buffer take over what another held that it replaces.
    pub fn replace(&mut self, old: &wgpu::Buffer, new: &wgpu::Buffer) {
        // One that grew again before it was filled never held anything.
        match self.moved.iter_mut().find(|moved| moved.to == *old) {
            Some(moved) => moved.to = new.clone(),
            None => self.moved.push(Copy {
                from: old.clone(),
                from_offset: 0,
                to: new.clone(),
                to_offset: 0,
                size: old.size(),
            }),
        }
    }

    /// Records the copies, once. False if there are none.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder) -> bool {
        if !self.is_waiting() {
            return false;
        }
        // Unmapped now, as what is submitted must not be mapped; if the encoder is dropped, so are they.
        self.belt.finish_and_recall_on_submit(encoder);
        self.written = None;
        self.waits = false;
        for copy in self.moved.drain(..).chain(self.copies.drain(..)) {
            let Copy {
                from,
                from_offset,
                to,
                to_offset,
                size,
            } = copy;
            encoder.copy_buffer_to_buffer(&from, from_offset, &to, to_offset, size);
        }
        true
    }
}

/// Pieces that are staged one after another, through one view, which must be dropped before they are
/// recorded or cleared: what is viewed cannot be unmapped.
#[derive(Default)]
pub(crate) struct Stream {
    block: Option<Block>,
}

struct Block {
    view: wgpu::BufferViewMut,
    /// Where the view begins.
    start: u64,
    room: Room,
}

/// Part of a staging buffer that is not yet filled.
#[derive(Debug)]
struct Room {
    buffer: wgpu::Buffer,
    next: u64,
    end: u64,
}

impl Room {
    fn left(&self) -> u64 {
        self.end - self.next
    }

    fn take(&mut self, size: u64) -> std::ops::Range<u64> {
        let start = self.next;
        self.next += size;
        start..self.next
    }
}

#[cfg(test)]
mod tests {
    use super::{CHUNK, Uploads};

    fn device(max_buffer_size: u64) -> (wgpu::Device, wgpu::Queue) {
        wgpu::Device::noop(&wgpu::DeviceDescriptor {
            required_limits: wgpu::Limits {
                max_buffer_size,
                ..wgpu::Limits::defaults()
            },
            ..Default::default()
        })
    }

    fn buffer(device: &wgpu::Device, words: usize) -> wgpu::Buffer {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 4 * words as u64,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        })
    }

    fn read(device: &wgpu::Device, buffer: &wgpu::Buffer) -> Vec<u32> {
        buffer.map_async(wgpu::MapMode::Read, .., |_| {});
        device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        let words = bytemuck::pod_collect_to_vec(&buffer.get_mapped_range(..).unwrap());
        buffer.unmap();
        words
    }

    #[test]
    fn what_is_written_arrives_once_in_few_staging_buffers() {
        // The largest buffer cannot be mapped.
        let (device, queue) = device(4 * 40 + 2);
        let to = buffer(&device, 40);
        let words: Vec<u32> = (1..=40).collect();
        let mut uploads = Uploads::new(&device);
        let submit = |uploads: &mut Uploads| {
            let mut encoder = device.create_command_encoder(&Default::default());
            let any = uploads.record(&mut encoder);
            queue.submit([encoder.finish()]);
            any
        };
        assert!(!submit(&mut uploads), "nothing yet");
        // Pieces of 3, some of which begin between two places that can be mapped.
        let zeros = [0; 40];
        for all in [&zeros[..], &words] {
            for (piece, at) in all.chunks(3).zip((0..).step_by(12)) {
                uploads.write(&to, at, bytemuck::cast_slice(piece));
            }
        }
        uploads.write(&to, 0, &[]);
        assert_eq!(uploads.bytes(), 320);
        let mut staging: Vec<_> = uploads.copies.iter().map(|copy| &copy.from).collect();
        staging.dedup();
        assert_eq!(staging.len(), 2, "28 pieces");
        assert!(submit(&mut uploads));
        assert_eq!(read(&device, &to), words);
        assert!(!submit(&mut uploads), "once");

        uploads.write(&to, 0, bytemuck::bytes_of(&99_u32));
        uploads.clear();
        assert_eq!(uploads.bytes(), 0);
        assert!(!submit(&mut uploads));
        assert_eq!(read(&device, &to), words, "what is cleared does not arrive");
        uploads.write(&to, 4, bytemuck::bytes_of(&98_u32));
        let mut dropped = device.create_command_encoder(&Default::default());
        assert!(uploads.record(&mut dropped));
        drop(dropped);
        assert_eq!(read(&device, &to), words, "nor what is dropped");
        uploads.write(&to, 0, bytemuck::bytes_of(&97_u32));
        assert!(submit(&mut uploads));
        assert_eq!(read(&device, &to)[..3], [97, 2, 3]);
    }

    #[test]
    fn staging_buffers_come_back() {
        let (device, queue) = device(1 << 20);
        let to = buffer(&device, 8);
        let mut uploads = Uploads::new(&device);
        let mut seen: Vec<wgpu::Buffer> = Vec::new();
        for frame in 0..20_u32 {
            let mut encoder = device.create_command_encoder(&Default::default());
            for word in 0..8 {
                uploads.write(&to, 4 * word, bytemuck::bytes_of(&frame));
            }
            for copy in &uploads.copies {
                assert_eq!(copy.from.size(), CHUNK);
                if !seen.contains(&copy.from) {
                    seen.push(copy.from.clone());
                }
            }
            // Every third is forgotten.
            if frame % 3 == 0 {
                uploads.clear();
            }
            uploads.record(&mut encoder);
            queue.submit([encoder.finish()]);
            device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        }
        assert_eq!(seen.len(), 1);
    }
}
