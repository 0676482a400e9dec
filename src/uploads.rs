//! What a frame writes into its buffers, as copies in the host's encoder.
//!
//! `Queue::write_buffer` comes before everything that is submitted with it: of two frames in one
//! submission, the second would overwrite what the first reads. A recorded copy comes where it was
//! recorded.

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

/// The copies that the next encode records, and where their bytes wait.
#[derive(Debug)]
pub(crate) struct Uploads {
    belt: StagingBelt,
    /// The device's largest buffer.
    limit: u64,
    /// What a buffer held that was made anew: copied before everything else.
    moved: Vec<Copy>,
    copies: Vec<Copy>,
    /// Whether bytes wait that were not recorded.
    waits: bool,
}

impl Uploads {
    pub fn new(device: &wgpu::Device) -> Self {
        let limit = device.limits().max_buffer_size;
        Self {
            belt: StagingBelt::new(device.clone(), CHUNK.min(limit)),
            limit,
            moved: Vec::new(),
            copies: Vec::new(),
            waits: false,
        }
    }

    /// Forgets what was written and never recorded; what buffers held before they grew is not
    /// forgotten.
    pub fn clear(&mut self) {
        self.copies.clear();
        if std::mem::take(&mut self.waits) {
            self.belt.finish();
            self.belt.recall();
        }
    }

    /// Writes into a buffer. Offset and length are multiples of 4.
    pub fn write(&mut self, to: &wgpu::Buffer, to_offset: u64, bytes: &[u8]) {
        let mut stream = Stream::default();
        let from = self.stage(&mut stream, bytes.len() as u64, |mut place| {
            place.copy_from_slice(bytes);
        });
        if let Some((from, from_offset)) = from {
            self.copy(Copy {
                from,
                from_offset,
                to: to.clone(),
                to_offset,
                size: bytes.len() as u64,
            });
        }
    }

    /// Has bytes written that wait for a copy, those of one stream one after another as far as
    /// buffers go; tells where they lie. Their number is a multiple of 4.
    pub fn stage(
        &mut self,
        stream: &mut Stream,
        size: u64,
        write: impl FnOnce(wgpu::WriteOnly<'_, [u8]>),
    ) -> Option<(wgpu::Buffer, u64)> {
        let wanted = wgpu::BufferSize::new(size)?;
        if stream
            .block
            .as_ref()
            .is_none_or(|block| block.left() < size)
        {
            stream.block = self.block(wanted);
        }
        let block = stream.block.as_mut()?;
        let place = block.used as usize..(block.used + size) as usize;
        write(block.view.slice(place));
        let offset = block.offset + block.used;
        block.used += size;
        Some((block.buffer.clone(), offset))
    }

    fn block(&mut self, size: wgpu::BufferSize) -> Option<Block> {
        // Few sizes, so that a buffer that comes back fits again.
        let room = size.get().checked_next_power_of_two()?.max(CHUNK);
        let size = room.min(self.limit).max(size.get());
        let alignment = wgpu::BufferSize::new(wgpu::COPY_BUFFER_ALIGNMENT)?;
        self.waits = true;
        let slice = self.belt.allocate(wgpu::BufferSize::new(size)?, alignment);
        Some(Block {
            // Fails only where the device is lost or out of memory, which it says itself.
            view: slice.get_mapped_range_mut().ok()?,
            buffer: slice.buffer().clone(),
            offset: slice.offset(),
            used: 0,
            size,
        })
    }

    /// Has bytes copied after everything that was asked for before.
    pub fn copy(&mut self, copy: Copy) {
        self.copies.push(copy);
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

    /// Records the copies, once.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.belt.finish_and_recall_on_submit(encoder);
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
    }
}

/// Pieces that are staged one after another. Must be dropped before they are recorded.
#[derive(Default)]
pub(crate) struct Stream {
    block: Option<Block>,
}

struct Block {
    view: wgpu::BufferViewMut,
    buffer: wgpu::Buffer,
    offset: u64,
    used: u64,
    size: u64,
}

impl Block {
    fn left(&self) -> u64 {
        self.size - self.used
    }
}
