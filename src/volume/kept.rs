//! What of a frame's extraction still holds in the next.

use super::params::InstanceParams;
use super::silhouette::{Counts, Way};
use crate::mesh::CasterMesh;

/// What an instance's part of the buffers follows from. Equal slots at one place hold equal volumes.
///
/// The light is the one in the mesh's own space: a caster and a light that stand still keep their
/// volume, whatever the camera does.
#[derive(Clone, Debug)]
pub(super) struct Slot {
    // Keeps the mesh alive, so that its key stays its own.
    pub mesh: CasterMesh,
    pub revision: u64,
    pub chunk: usize,
    pub instance: InstanceParams,
    pub way: Way,
    /// The size of a volume that was found on the CPU.
    pub counts: Counts,
    /// No point is in it more often than this; `None` until somebody asks.
    pub layers: Option<u64>,
    /// Whether the buffers held this volume already when the frame was prepared.
    pub ready: bool,
    /// Whether it is drawn in this frame; if not, it keeps its place and what it holds.
    pub drawn: bool,
}

impl Slot {
    /// Whether this frame needs the volume extracted.
    pub fn is_stale(&self) -> bool {
        self.drawn && !self.ready
    }

    fn holds(&self, wanted: &Self) -> bool {
        self.mesh.key() == wanted.mesh.key()
            && self.revision == wanted.revision
            && self.chunk == wanted.chunk
            && self.way == wanted.way
            && bytemuck::bytes_of(&self.instance) == bytemuck::bytes_of(&wanted.instance)
    }
}

/// The slots of the last frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kept<'a> {
    pub slots: &'a [Slot],
    /// Whether the extraction of those that were not ready was recorded.
    pub encoded: bool,
}

impl Kept<'_> {
    /// Nothing: every volume is extracted.
    pub const NOTHING: Self = Self {
        slots: &[],
        encoded: false,
    };

    /// The slot at this place in the list of instances, if it need not be extracted again.
    pub fn get(&self, instance: usize, wanted: &Slot) -> Option<&Slot> {
        // The CPU has done its work when the frame is prepared.
        let extracted = |slot: &Slot| self.encoded || slot.way == Way::Cpu;
        let done = |slot: &Slot| slot.ready || (slot.drawn && extracted(slot));
        let slot = self.slots.get(instance)?;
        (done(slot) && slot.holds(wanted)).then_some(slot)
    }
}
