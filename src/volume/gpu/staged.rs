//! What the CPU found, on its way to buffers that are not yet large enough.

use crate::mesh::MeshData;
use crate::uploads::{Copy, Stream, Uploads};
use crate::volume::gpu::buffers::Buffers;
use crate::volume::plan::cache::Slot;
use crate::volume::silhouette::CpuVolume;

/// Bytes of one list of a chunk that lie together, where they wait as well as where they go.
struct Run {
    from: wgpu::Buffer,
    from_offset: u64,
    chunk: usize,
    to_offset: u64,
    size: u64,
}

/// Caps and sides of volumes, staged in few pieces.
#[derive(Default)]
pub(crate) struct StagedVolumes {
    streams: [Stream; 2],
    runs: [Vec<Run>; 2],
}

impl StagedVolumes {
    /// Stages a volume that has its place.
    pub fn add(&mut self, uploads: &mut Uploads, volume: &CpuVolume, mesh: &MeshData, slot: &Slot) {
        let at = |word: u32| u64::from(word) * 4;
        let sizes = [
            at(slot.counts.front) + at(slot.counts.back),
            at(slot.counts.sides),
        ];
        let starts = [at(slot.place.cap), at(slot.place.side)];
        for list in 0..2 {
            let stream = &mut self.streams[list];
            let staged = uploads.stage(stream, sizes[list], |mut bytes| match list {
                // Caps are most of it, and go straight where they wait.
                0 => volume.write_caps(mesh, bytes),
                _ => bytes.copy_from_slice(bytemuck::cast_slice(&volume.sides)),
            });
            if let Some((from, from_offset)) = staged {
                self.push(
                    list,
                    Run {
                        from,
                        from_offset,
                        chunk: slot.place.chunk,
                        to_offset: starts[list],
                        size: sizes[list],
                    },
                );
            }
        }
    }

    fn push(&mut self, list: usize, run: Run) {
        let runs = &mut self.runs[list];
        let last = runs.last_mut().filter(|last| {
            last.from == run.from
                && last.from_offset + last.size == run.from_offset
                && last.chunk == run.chunk
                && last.to_offset + last.size == run.to_offset
        });
        match last {
            Some(last) => last.size += run.size,
            None => runs.push(run),
        }
    }

    /// Has everything copied to its place, there being room for it.
    pub fn write(self, uploads: &mut Uploads, buffers: &Buffers) {
        for (list, runs) in self.runs.into_iter().enumerate() {
            for run in runs {
                let Some([_, caps, sides]) = buffers.chunk(run.chunk) else {
                    continue;
                };
                uploads.copy(Copy {
                    from: run.from,
                    from_offset: run.from_offset,
                    to: [caps, sides][list].clone(),
                    to_offset: run.to_offset,
                    size: run.size,
                });
            }
        }
    }
}
