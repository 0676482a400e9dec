//! What a frame writes to the GPU.

/// Bytes that the next `encode` copies to where its passes and receivers read them.
///
/// They do not go through the queue, whose writes come before everything that is submitted with them.
/// In the order of the encoder, what receivers are told of a light changes with its texels, and only
/// with them: not where `encode` is forgotten or its encoder dropped. And each of two frames in one
/// submission has its own.
#[derive(Debug)]
pub(super) struct Transfers {
    label: String,
    /// The device's largest buffer.
    limit: u64,
    chunks: Vec<Chunk>,
    size: u64,
}

/// What fits one buffer.
#[derive(Debug, Default)]
struct Chunk {
    bytes: Vec<u8>,
    copies: Vec<Copy>,
    staged: Option<wgpu::Buffer>,
}

#[derive(Debug)]
struct Copy {
    from: u64,
    to: wgpu::Buffer,
    at: u64,
    size: u64,
}

impl Transfers {
    pub fn new(device: &wgpu::Device, label: &str) -> Self {
        Self {
            label: format!("{label} transfers"),
            limit: device.limits().max_buffer_size,
            chunks: vec![Chunk::default()],
            size: 0,
        }
    }

    /// Bytes that wait for an `encode`.
    pub fn size(&self) -> u64 {
        self.size
    }

    pub fn clear(&mut self) {
        self.size = 0;
        self.chunks.truncate(1);
        for chunk in &mut self.chunks {
            chunk.bytes.clear();
            chunk.copies.clear();
            chunk.staged = None;
        }
    }

    /// Adds bytes for a buffer, no more than one may hold; a multiple of 4 of them, at a multiple of 4.
    pub fn push(&mut self, to: &wgpu::Buffer, at: u64, bytes: &[u8]) {
        let size = bytes.len() as u64;
        if size == 0 {
            return;
        }
        let full = |chunk: &Chunk| chunk.bytes.len() as u64 + size > self.limit;
        if self.chunks.last().is_none_or(full) {
            self.chunks.push(Chunk::default());
        }
        if let Some(chunk) = self.chunks.last_mut() {
            let (from, to) = (chunk.bytes.len() as u64, to.clone());
            chunk.copies.push(Copy { from, to, at, size });
            chunk.bytes.extend_from_slice(bytes);
            self.size += size;
        }
    }

    /// Puts the bytes where the GPU finds them.
    pub fn stage(&mut self, device: &wgpu::Device) {
        for chunk in &mut self.chunks {
            chunk.staged = None;
            if chunk.bytes.is_empty() {
                continue;
            }
            let staged = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(&self.label),
                size: chunk.bytes.len() as u64,
                usage: wgpu::BufferUsages::MAP_WRITE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: true,
            });
            // A buffer that could not be made (the device is lost) is not mapped.
            if let Ok(mut view) = staged.get_mapped_range_mut(..) {
                view.copy_from_slice(&chunk.bytes);
            }
            staged.unmap();
            chunk.staged = Some(staged);
        }
    }

    /// Records the copies, once. False if there are none.
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) -> bool {
        let any = self.size > 0;
        for chunk in &mut self.chunks {
            if let Some(staged) = &chunk.staged {
                for copy in &chunk.copies {
                    let Copy { from, to, at, size } = copy;
                    encoder.copy_buffer_to_buffer(staged, *from, to, *at, *size);
                }
            }
        }
        self.clear();
        any
    }
}
