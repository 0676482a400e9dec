//! What draws that casters share are made of, on its way to their buffers.

use crate::uploads::Uploads;
use crate::volume::gpu::buffers::Buffers;
use crate::volume::plan::merged::{BLOCK_BYTES, Member, MergedDraw, MergedDraws};
use crate::volume::silhouette::Way;

/// Has written what changed of these draws: their casters where the GPU makes the blocks, and else the
/// blocks. There is room for it.
pub(crate) fn write_draws(
    uploads: &mut Uploads,
    merged: &MergedDraws,
    touched: &[u32],
    buffers: &Buffers,
) {
    for draw in touched.iter().filter_map(|&number| merged.get(number)) {
        write_draw(uploads, draw, buffers);
    }
}

fn write_draw(uploads: &mut Uploads, draw: &MergedDraw, buffers: &Buffers) {
    let Some([members, blocks, _]) = buffers.merged(draw.chunk()) else {
        return;
    };
    let [first_member, first_block, _] = draw.starts().map(u64::from);
    let mut write_blocks = |list: &[[u32; 3]]| {
        if let Some(blocks) = blocks {
            uploads.write(
                blocks,
                first_block * BLOCK_BYTES,
                bytemuck::cast_slice(list),
            );
        }
    };
    match (draw.key.way, draw.key.own) {
        (Way::Vertex, _) => {}
        (_, true) => {
            let only = draw.first().filter(|_| draw.is_changed());
            // No elements: the vertices are an index buffer's.
            write_blocks(&only.map_or(Vec::new(), |caster| vec![[caster, 0, 0]]));
        }
        (Way::Cpu, _) => write_blocks(&draw.blocks()),
        (Way::Compute, _) => {
            let Some(buffer) = members else { return };
            for (seat, run) in draw.changed() {
                let place = (first_member + u64::from(seat)) * size_of::<Member>() as u64;
                uploads.write(buffer, place, bytemuck::cast_slice(&run));
            }
        }
    }
}
