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

/// The copies that the next encode records, and where their bytes wait.
#[derive(Debug)]
pub(crate) struct Uploads {
    belt: StagingBelt,
    /// The device's largest buffer, down to a size that can be mapped.
    limit: u64,
    /// Where what is written waits.
    written: Stream,
    /// What a buffer held that was made anew: copied before everything else.
    moved: Vec<Copy>,
    copies: Vec<Copy>,
    /// Whether bytes wait that were not recorded.
    waits: bool,
}

impl Uploads {
    pub fn new(device: &wgpu::Device) -> Self {
        let limit = device.limits().max_buffer_size;
        let limit = limit - limit % wgpu::COPY_BUFFER_ALIGNMENT;
        Self {
            belt: StagingBelt::new(device.clone(), CHUNK.min(limit)),
            limit,
            written: Stream::default(),
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

    /// Forgets what was written and never recorded; what buffers held before they grew is not
    /// forgotten.
    pub fn clear(&mut self) {
        self.copies.clear();
        self.written = Stream::default();
        if std::mem::take(&mut self.waits) {
            self.belt.finish();
            self.belt.recall();
        }
    }

    /// Writes into a buffer, no more than one may hold. Offset and length are multiples of 4.
    pub fn write(&mut self, to: &wgpu::Buffer, to_offset: u64, bytes: &[u8]) {
        let size = bytes.len() as u64;
        let mut stream = std::mem::take(&mut self.written);
        let staged = self.stage(&mut stream, size, |mut place| place.copy_from_slice(bytes));
        self.written = stream;
        if let Some((from, from_offset)) = staged {
            self.copy(Copy {
                from,
                from_offset,
                to: to.clone(),
                to_offset,
                size,
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
        let full = |block: &Block| block.end - block.next < size;
        if stream.block.as_ref().is_none_or(full) {
            stream.block = Some(self.block(wanted)?);
        }
        let block = stream.block.as_mut()?;
        let place = block.next..block.next + size;
        // Views begin at multiples of 8. None outlives its piece: a buffer that is viewed cannot be
        // unmapped, nor may its device go.
        let lead = place.start % wgpu::MAP_ALIGNMENT;
        let slice = block.buffer.slice(place.start - lead..place.end);
        // Fails only where the device is lost or out of memory, which it says itself.
        let mut view = slice.get_mapped_range_mut().ok()?;
        write(view.slice(lead as usize..));
        block.next = place.end;
        Some((block.buffer.clone(), place.start))
    }

    fn block(&mut self, size: wgpu::BufferSize) -> Option<Block> {
        // Few sizes, so that a buffer that comes back fits again.
        let room = size.get().checked_next_power_of_two()?.max(CHUNK);
        let size = wgpu::BufferSize::new(room.min(self.limit).max(size.get()))?;
        let alignment = wgpu::BufferSize::new(wgpu::COPY_BUFFER_ALIGNMENT)?;
        self.waits = true;
        let slice = self.belt.allocate(size, alignment);
        Some(Block {
            buffer: slice.buffer().clone(),
            next: slice.offset(),
            end: slice.offset() + size.get(),
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

    /// Records the copies, once. False if there are none.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder) -> bool {
        if self.moved.is_empty() && self.copies.is_empty() {
            return false;
        }
        // Unmapped now, as what is submitted must not be mapped; if the encoder is dropped, so are they.
        self.belt.finish_and_recall_on_submit(encoder);
        self.written = Stream::default();
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

/// Pieces that are staged one after another, until they are recorded or cleared.
#[derive(Debug, Default)]
pub(crate) struct Stream {
    block: Option<Block>,
}

/// Part of a staging buffer, and how far it is filled.
#[derive(Debug)]
struct Block {
    buffer: wgpu::Buffer,
    next: u64,
    end: u64,
}
