//! The volumes that compute shaders find in one frame, for whichever lights.

use crate::mesh::{CasterMesh, MeshKind};
use crate::volume::plan::cache::VolumeCache;
use crate::volume::plan::params::{Arguments, BatchParams, InstanceParams};

/// Volumes of one mesh whose parts lie in one chunk: one dispatch for each extraction pass.
#[derive(Clone, Debug)]
pub(crate) struct Batch {
    pub mesh: CasterMesh,
    pub chunk: usize,
    pub params: BatchParams,
    pub instance_count: u32,
}

/// All batches of a frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct Batches {
    pub list: Vec<Batch>,
    /// What compute shaders find, batch after batch.
    pub instances: Vec<InstanceParams>,
    /// For each of these, its indirect arguments before anything is counted, and their number.
    pub arguments: Vec<(u32, Arguments)>,
}

impl Batches {
    /// Adds a volume that has its place; those of one mesh follow each other. `most`: workgroups in
    /// one dimension of a dispatch.
    pub fn add(&mut self, number: u32, cache: &VolumeCache, most: u32) {
        let Some(slot) = cache.get(number) else {
            return; // every number's slot is there
        };
        let first = self.instances.len() as u32;
        self.instances.push(slot.instance);
        // Caps are below the region's end, which the regions keep below 2^32.
        let cap_end = slot.place.cap + 3 * slot.mesh.triangle_count();
        let arguments = Arguments::new(slot.place.cap, cap_end);
        self.arguments.push((slot.instance.arguments, arguments));
        let open = self.list.last_mut().filter(|batch| {
            batch.mesh.id() == slot.mesh.id()
                && batch.chunk == slot.place.chunk
                && batch.instance_count < most
        });
        match open {
            Some(batch) => batch.instance_count += 1,
            None => self.list.push(Batch {
                mesh: slot.mesh.clone(),
                chunk: slot.place.chunk,
                params: batch_params(&slot.mesh, first),
                instance_count: 1,
            }),
        }
    }
}

/// Words from one position of a mesh to the next, and before the first. They fit 32 bits: the
/// positions lie in one storage binding.
pub(crate) fn position_words(mesh: &CasterMesh) -> (u32, u32) {
    let (stride, offset) = mesh.layout();
    ((stride / 4) as u32, (offset / 4) as u32)
}

fn batch_params(mesh: &CasterMesh, first_instance: u32) -> BatchParams {
    let (position_stride, position_offset) = position_words(mesh);
    BatchParams {
        first_instance,
        triangle_count: mesh.triangle_count(),
        edge_count: mesh.edge_count(),
        position_stride,
        position_offset,
        general: u32::from(mesh.kind() == MeshKind::General),
        zero: 0,
        padding: 0,
    }
}
