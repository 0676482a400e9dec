//! Meshes on their way to the pools: through staging buffers that are gone when they have arrived.

use crate::uploads::{Copy, Uploads};
use crate::volume::gpu::buffers::Buffers;
use crate::volume::plan::limits::PlanLimits;
use crate::volume::plan::meshes::{MeshPool, Piece};

/// Bytes of a staging buffer, if no single piece needs more.
const BLOCK: u64 = 1 << 24;

/// Has the meshes written that are new in this frame. There is room for them.
///
/// What a whole level brings waits in buffers of its own, not in those that frames share, which keep
/// their size.
pub(crate) fn write_meshes(
    device: &wgpu::Device,
    uploads: &mut Uploads,
    (meshes, buffers): (&MeshPool, &Buffers),
    limits: &PlanLimits,
) {
    let most = BLOCK.min(limits.buffer_bytes);
    let mut block = Vec::new();
    let mut size = 0;
    for piece in meshes.pieces() {
        let own = piece.bytes.len() as u64;
        if size + own > most {
            write_block(device, uploads, buffers, &block);
            block.clear();
            size = 0;
        }
        size += own;
        block.push(piece);
    }
    write_block(device, uploads, buffers, &block);
}

fn write_block(
    device: &wgpu::Device,
    uploads: &mut Uploads,
    buffers: &Buffers,
    block: &[Piece<'_>],
) {
    let size = block.iter().map(|piece| piece.bytes.len() as u64).sum();
    if size == 0 {
        return;
    }
    let from = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("shadows volume staged meshes"),
        size,
        usage: wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: true,
    });
    // Fails only where the device is lost or out of memory, which it says itself.
    let Ok(mut view) = from.slice(..).get_mapped_range_mut() else {
        return;
    };
    let mut at = 0;
    for piece in block {
        view.slice(at..at + piece.bytes.len())
            .copy_from_slice(piece.bytes);
        at += piece.bytes.len();
    }
    drop(view);
    from.unmap();
    let mut from_offset = 0;
    for piece in block {
        let size = piece.bytes.len() as u64;
        if let Some(lists) = buffers.pool(piece.pool) {
            uploads.copy(Copy {
                from: from.clone(),
                from_offset,
                to: lists[piece.list].clone(),
                to_offset: piece.offset,
                size,
            });
        }
        from_offset += size;
    }
}
