//! Textures that are read back, which in a browser takes until later.

use anyhow::Result;
use futures_channel::oneshot;
use host::gpu::Gpu;
use js_sys::Promise;
use shadows::wgpu;
use wasm_bindgen::prelude::*;

/// A texture on its way to the CPU.
pub struct Readback {
    buffer: wgpu::Buffer,
    mapped: oneshot::Receiver<Result<(), wgpu::BufferAsyncError>>,
    /// Bytes of a row, without and with what fills it up.
    row: [usize; 2],
}

impl Readback {
    /// Records the copy.
    pub fn new(gpu: &Gpu, texture: &wgpu::Texture, encoder: &mut wgpu::CommandEncoder) -> Self {
        let pixel = texture.format().block_copy_size(None).unwrap_or(4);
        let row = texture.width() * pixel;
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("copy"),
            size: u64::from(padded) * u64::from(texture.height()),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let destination = wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded),
                rows_per_image: None,
            },
        };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, texture.size());
        let (sender, mapped) = oneshot::channel();
        encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, .., move |result| {
            // Nobody may be waiting any more.
            let _ = sender.send(result);
        });
        Self {
            buffer,
            mapped,
            row: [row, padded].map(|bytes| bytes as usize),
        }
    }

    /// The rows without what fills them up.
    ///
    /// # Errors
    /// If the device was lost.
    pub async fn bytes(self) -> Result<Vec<u8>> {
        self.mapped.await??;
        let [row, padded] = self.row;
        let bytes = self.buffer.get_mapped_range(..)?;
        let rows = bytes.chunks(padded).flat_map(|bytes| &bytes[..row]);
        Ok(rows.copied().collect())
    }
}

/// What JavaScript waits for.
pub fn promise(work: impl Future<Output = Result<JsValue>> + 'static) -> Promise {
    let work = async move { work.await.map_err(|error| JsError::from(&*error).into()) };
    wasm_bindgen_futures::future_to_promise(work)
}
