//! The volumes that the buffers hold, from frame to frame, for all lights and views.

use std::collections::{BTreeSet, HashMap};

use crate::mesh::{CasterMesh, MeshKind};
use crate::volume::decide::decision::{KnownCaster, Volume, words};
use crate::volume::decide::facing::Counted;
use crate::volume::plan::limits::PlanLimits;
use crate::volume::plan::meshes::MeshPlace;
use crate::volume::plan::params::{CasterParams, InstanceParams};
use crate::volume::plan::ranges::{Place, Regions, Words};
use crate::volume::silhouette::{Counts, Way};

/// What a volume follows from: equal keys, equal volumes.
///
/// The light is the one in the mesh's own space: a caster and a light that stand still keep their
/// volume, whatever the camera does, and casters of one mesh that the light meets alike (as the sun
/// meets all that are turned alike) share one, as do several views of one light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Key {
    mesh: u64,
    revision: u64,
    light: [u32; 4],
    light_rest: [u32; 3],
    counted: Counted,
    way: Way,
}

/// The buffers that a volume's shaders read and write: those of a chunk of volumes and of a pool of meshes,
/// and the positions' own where they are the host's.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Sources {
    pub chunk: usize,
    pub pool: usize,
    pub host_positions: Option<wgpu::Buffer>,
}

/// A volume that somebody draws, or keeps.
#[derive(Clone, Debug)]
pub(crate) struct Slot {
    pub mesh: CasterMesh,
    pub way: Way,
    /// Where it lies, and where its mesh does, if it was found.
    pub place: Place,
    mesh_place: MeshPlace,
    pub instance: InstanceParams,
    /// The size of a volume that was found on the CPU.
    pub counts: Counts,
    /// No point is in it more often than this; `None` until somebody asks.
    pub layers: Option<u64>,
    key: Key,
    /// Whether it has its place, which is of this size, and whether it has it since this frame.
    found: bool,
    new: bool,
    words: Words,
    /// Casters (under lights, in views) that have it, and those of them that are drawn.
    users: u32,
    drawn: u32,
}

/// All slots, by numbers that stay theirs as long as they have users.
#[derive(Debug)]
pub(crate) struct VolumeCache {
    slots: Vec<Option<Slot>>,
    /// Numbers without a slot.
    free: Vec<u32>,
    by_key: HashMap<Key, u32>,
    /// Drawn and not found, some of them more than once, some no longer.
    unfound: Vec<u32>,
    /// Without users, some of them no longer.
    unused: Vec<u32>,
    regions: Regions,
    /// Words of all that was found.
    held: Words,
    arguments: Numbers,
    /// How many volumes have the same sources.
    users_of: HashMap<Sources, u32>,
    /// The volumes found for the last frame.
    last_found: Vec<u32>,
}

impl Key {
    fn new(volume: &Volume, known: &KnownCaster) -> Self {
        Self {
            mesh: known.mesh().id(),
            revision: known.mesh().revision(),
            light: volume.light.light.map(f32::to_bits),
            light_rest: volume.light.rest.map(f32::to_bits),
            counted: volume.counted,
            way: known.way,
        }
    }
}

impl Slot {
    pub fn sources(&self) -> Sources {
        let is_hosts = self.way != Way::Vertex && self.mesh.data().is_none();
        Sources {
            chunk: self.place.chunk,
            pool: self.mesh_place.pool,
            host_positions: is_hosts.then(|| self.mesh.positions().clone()),
        }
    }

    /// Whether it was found for the last frame.
    pub fn is_new(&self) -> bool {
        self.new
    }

    /// Writes into a caster's parameters where its mesh lies.
    pub fn locate(&self, params: &mut CasterParams) {
        let instance = &self.instance;
        params.edge_base = instance.edge_base;
        params.position_stride = instance.position_stride;
        params.position_offset = instance.position_offset;
    }

    fn settle(&mut self, place: Place, mesh_place: MeshPlace) {
        (self.place, self.mesh_place) = (place, mesh_place);
        let mesh = &self.mesh;
        // Words of a mesh in a pool, and of the host's positions, lie in one storage binding and fit 32
        // bits.
        let (stride, offset) = match mesh.data() {
            Some(_) => (3, 3 * mesh_place.position),
            None => position_words(mesh),
        };
        let instance = &mut self.instance;
        instance.facing_base = place.facing;
        instance.cap_base = place.cap;
        instance.side_base = place.side;
        instance.triangle_count = mesh.triangle_count();
        instance.triangle_base = 3 * mesh_place.triangle;
        instance.edge_count = mesh.edge_count();
        instance.edge_base = mesh_place.edge;
        instance.use_base = mesh_place.edge_use;
        instance.general = u32::from(mesh.kind() == MeshKind::General);
        instance.position_stride = stride;
        instance.position_offset = offset;
    }
}

/// Words from one position of a mesh to the next in its own buffer, and before the first. They fit 32
/// bits: the positions lie in one storage binding.
pub(crate) fn position_words(mesh: &CasterMesh) -> (u32, u32) {
    let (stride, offset) = mesh.layout();
    ((stride / 4) as u32, (offset / 4) as u32)
}

/// Numbers of indirect arguments.
#[derive(Debug, Default)]
struct Numbers {
    end: u32,
    free: BTreeSet<u32>,
}

impl Numbers {
    fn take(&mut self) -> u32 {
        self.free.pop_first().unwrap_or_else(|| {
            self.end += 1;
            self.end - 1
        })
    }

    fn in_use(&self) -> usize {
        self.end as usize - self.free.len()
    }
}

impl VolumeCache {
    /// `bytes`: the largest storage buffer that can be made and bound.
    pub fn new(bytes: u64) -> Self {
        Self {
            slots: Vec::new(),
            free: Vec::new(),
            by_key: HashMap::new(),
            unfound: Vec::new(),
            unused: Vec::new(),
            regions: Regions::new(bytes),
            held: [0; 3],
            arguments: Numbers::default(),
            users_of: HashMap::new(),
            last_found: Vec::new(),
        }
    }

    pub fn regions(&self) -> &Regions {
        &self.regions
    }

    /// How many indirect arguments there are.
    pub fn arguments(&self) -> usize {
        self.arguments.end as usize
    }

    pub fn get(&self, slot: u32) -> Option<&Slot> {
        self.slots.get(slot as usize)?.as_ref()
    }

    pub fn get_mut(&mut self, slot: u32) -> Option<&mut Slot> {
        self.slots.get_mut(slot as usize)?.as_mut()
    }

    /// Whether any volume has these sources.
    pub fn has(&self, sources: &Sources) -> bool {
        self.users_of.contains_key(sources)
    }

    /// The volumes found for the last frame.
    pub fn last_found(&self) -> &[u32] {
        &self.last_found
    }

    /// One user more of a volume, which is drawn or only kept.
    pub fn acquire(&mut self, volume: &Volume, known: &KnownCaster, drawn: bool) -> u32 {
        let key = Key::new(volume, known);
        let number = match self.by_key.get(&key) {
            Some(number) => *number,
            None => self.insert(key, volume, known.mesh()),
        };
        if let Some(slot) = self.get_mut(number) {
            slot.users += 1;
            slot.drawn += u32::from(drawn);
            if drawn && !slot.found {
                self.unfound.push(number);
            }
        }
        number
    }

    /// Takes note that a user of a volume wants this one in its place, drawn or only kept as it was
    /// before and as it is now. Whether it is the same, so that nothing else is to be done.
    pub fn is_still(
        &mut self,
        number: u32,
        (volume, known): (&Volume, &KnownCaster),
        [was_drawn, is_drawn]: [bool; 2],
    ) -> bool {
        let key = Key::new(volume, known);
        let Some(slot) = self.get_mut(number).filter(|slot| slot.key == key) else {
            return false;
        };
        slot.drawn = (slot.drawn + u32::from(is_drawn)).saturating_sub(u32::from(was_drawn));
        if is_drawn && !slot.found {
            self.unfound.push(number);
        }
        true
    }

    /// One user less, which had it drawn or only kept. The volume stays until the next
    /// [`sweep`](Self::sweep).
    pub fn release(&mut self, number: u32, drawn: bool) {
        let Some(slot) = self.get_mut(number) else {
            return;
        };
        slot.users = slot.users.saturating_sub(1);
        slot.drawn = slot.drawn.saturating_sub(u32::from(drawn));
        if slot.users == 0 {
            self.unused.push(number);
        }
    }

    /// Lets go of what has no users.
    pub fn sweep(&mut self) {
        for number in std::mem::take(&mut self.unused) {
            if self.get(number).is_none_or(|slot| slot.users > 0) {
                continue;
            }
            self.forget(number);
            if let Some(slot) = self.slots[number as usize].take() {
                self.by_key.remove(&slot.key);
                self.free.push(number);
            }
        }
    }

    /// Has everything found anew.
    pub fn forget_all(&mut self) {
        for number in 0..self.slots.len() as u32 {
            self.forget(number);
        }
    }

    /// Has what was found for the last frame found anew.
    pub fn forget_last(&mut self) {
        for number in std::mem::take(&mut self.last_found) {
            self.forget(number);
        }
    }

    /// What is drawn and has to be found now, the volumes of one mesh together. If it does not fit
    /// beside what is kept for casters out of view, that is let go.
    pub fn take_wanted(&mut self, limits: &PlanLimits) -> Vec<u32> {
        let mut wanted = std::mem::take(&mut self.unfound);
        wanted.sort_unstable();
        wanted.dedup();
        let is_wanted = |slot: &Slot| slot.drawn > 0 && !slot.found;
        wanted.retain(|&number| self.get(number).is_some_and(is_wanted));
        for number in std::mem::take(&mut self.last_found) {
            if let Some(slot) = self.get_mut(number) {
                slot.new = false;
            }
        }
        if wanted.is_empty() {
            return wanted;
        }
        wanted.sort_by_key(|&number| self.get(number).map(|slot| slot.mesh.id()));
        let mut total = self.held;
        for slot in wanted.iter().filter_map(|&number| self.get(number)) {
            for (total, words) in total.iter_mut().zip(words(&slot.mesh, slot.way)) {
                *total += words;
            }
        }
        let most = limits.storage_bytes / 4;
        let crowded = total.iter().any(|words| *words > most)
            || self.arguments.in_use() + wanted.len() > limits.casters;
        if crowded {
            for number in 0..self.slots.len() as u32 {
                if self.get(number).is_some_and(|slot| slot.drawn == 0) {
                    self.forget(number);
                }
            }
        }
        self.last_found.clone_from(&wanted);
        wanted
    }

    /// Gives a wanted slot its place; its mesh has one.
    pub fn place(&mut self, number: u32, words: Words, mesh: MeshPlace) {
        let place = self.regions.take(words);
        let Some(slot) = (self.slots.get_mut(number as usize)).and_then(Option::as_mut) else {
            return;
        };
        (slot.found, slot.new) = (true, true);
        slot.words = words;
        slot.settle(place, mesh);
        if slot.way == Way::Compute {
            slot.instance.arguments = self.arguments.take();
        }
        *self.users_of.entry(slot.sources()).or_default() += 1;
        (self.held.iter_mut().zip(words)).for_each(|(held, words)| *held += words);
    }

    /// The same for one that the CPU has found, which takes no more than it came to.
    pub fn place_found(&mut self, slot: u32, counts: Counts, mesh: MeshPlace) {
        let caps = u64::from(counts.front) + u64::from(counts.back);
        self.place(slot, [0, caps, counts.sides.into()], mesh);
        if let Some(slot) = self.get_mut(slot) {
            slot.counts = counts;
        }
    }

    fn insert(&mut self, key: Key, volume: &Volume, mesh: &CasterMesh) -> u32 {
        let number = self.free.pop().unwrap_or_else(|| {
            self.slots.push(None);
            self.slots.len() as u32 - 1
        });
        self.slots[number as usize] = Some(Slot {
            mesh: mesh.clone(),
            way: key.way,
            place: Place::default(),
            mesh_place: MeshPlace::default(),
            instance: InstanceParams {
                light: volume.light.light,
                light_rest: volume.light.rest,
                both_sides: volume.counted as u32,
                ..bytemuck::Zeroable::zeroed()
            },
            counts: Counts::default(),
            layers: None,
            key,
            found: false,
            new: false,
            words: [0; 3],
            users: 0,
            drawn: 0,
        });
        self.by_key.insert(key, number);
        number
    }

    /// Gives a volume's place back, if it has one.
    fn forget(&mut self, number: u32) {
        let slot = self.slots.get_mut(number as usize).and_then(Option::as_mut);
        let Some(slot) = slot.filter(|slot| slot.found) else {
            return;
        };
        (slot.found, slot.new) = (false, false);
        self.regions.give_back(&slot.place, slot.words);
        let sources = slot.sources();
        if let Some(users) = self.users_of.get_mut(&sources) {
            *users -= 1;
            if *users == 0 {
                self.users_of.remove(&sources);
            }
        }
        if slot.way == Way::Compute {
            self.arguments.free.insert(slot.instance.arguments);
        }
        (self.held.iter_mut().zip(slot.words)).for_each(|(held, words)| *held -= words);
        if slot.drawn > 0 {
            self.unfound.push(number);
        }
    }
}
