//! The volumes that the buffers hold, from frame to frame.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use crate::Caster;
use crate::mesh::CasterMesh;
use crate::volume::decide::decision::Subject;
use crate::volume::decide::facing::{Counted, ObjectLight};
use crate::volume::plan::params::InstanceParams;
use crate::volume::plan::ranges::{Place, Regions, Words};
use crate::volume::silhouette::{Counts, Way};

/// What a volume follows from: equal keys, equal volumes. This is a caster's identity, wherever it
/// stands in the host's list.
///
/// The light is the one in the mesh's own space: a caster and a light that stand still keep their
/// volume, whatever the camera does, and casters of one mesh that the light meets alike (as the sun
/// meets all that are turned alike) share one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Key {
    mesh: u64,
    revision: u64,
    light: [u32; 4],
    light_rest: [u32; 3],
    counted: Counted,
    way: Way,
}

impl Key {
    pub fn new(mesh: &CasterMesh, light: &ObjectLight, counted: Counted, way: Way) -> Self {
        Self {
            mesh: mesh.id(),
            revision: mesh.revision(),
            light: light.light.map(f32::to_bits),
            light_rest: light.rest.map(f32::to_bits),
            counted,
            way,
        }
    }
}

/// A volume that has a place in the buffers.
#[derive(Clone, Debug)]
pub(crate) struct Slot {
    pub mesh: CasterMesh,
    pub way: Way,
    pub place: Place,
    /// The size of its place.
    words: Words,
    pub instance: InstanceParams,
    /// The size of a volume that was found on the CPU.
    pub counts: Counts,
    /// No point is in it more often than this; `None` until somebody asks.
    pub layers: Option<u64>,
    key: Key,
    /// The last frame that had a caster of it.
    seen: u64,
}

/// All slots, by numbers that stay theirs while they are kept.
#[derive(Debug)]
pub(crate) struct Kept {
    slots: Vec<Option<Slot>>,
    /// Numbers without a slot, the least last.
    free: Vec<u32>,
    by_key: HashMap<Key, u32>,
    /// For each subject of the last frame, its slot.
    order: Vec<Option<u32>>,
    /// Those whose volumes this frame has to find.
    wanted: Vec<u32>,
    regions: Regions,
    /// Counts the frames.
    frame: u64,
}

impl Kept {
    /// `bytes`: the largest storage buffer that can be made and bound.
    pub fn new(bytes: u64) -> Self {
        Self {
            slots: Vec::new(),
            free: Vec::new(),
            by_key: HashMap::new(),
            order: Vec::new(),
            wanted: Vec::new(),
            regions: Regions::new(bytes),
            frame: 0,
        }
    }

    pub fn regions(&self) -> &Regions {
        &self.regions
    }

    /// How many numbers there are.
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    pub fn get(&self, slot: u32) -> Option<&Slot> {
        self.slots.get(slot as usize)?.as_ref()
    }

    pub fn get_mut(&mut self, slot: u32) -> Option<&mut Slot> {
        self.slots.get_mut(slot as usize)?.as_mut()
    }

    /// The slots whose volumes this frame has to find, those of one mesh together.
    pub fn wanted(&self) -> &[u32] {
        &self.wanted
    }

    /// For each subject that [`update`](Self::update) was given, its slot; those out of view need
    /// not have one.
    pub fn order(&self) -> &[Option<u32>] {
        &self.order
    }

    /// Lets everything go.
    pub fn clear(&mut self) {
        for slot in 0..self.slots.len() as u32 {
            self.remove(slot);
        }
        self.wanted.clear();
        self.order.clear();
        self.sort_free();
    }

    /// Lets go what was wanted and never found.
    pub fn forget_wanted(&mut self) {
        for slot in std::mem::take(&mut self.wanted) {
            self.remove(slot);
        }
    }

    /// Finds the subjects' slots by what they are, lets go of what no subject has any more, and makes
    /// slots for what is drawn and has none.
    pub fn update(&mut self, subjects: &[Subject], casters: &[Caster]) {
        self.frame += 1;
        self.wanted.clear();
        let last = std::mem::take(&mut self.order);
        self.order.reserve(subjects.len());
        for (at, subject) in subjects.iter().enumerate() {
            // Most stand where they stood in the last frame's list.
            let here = last.get(at).copied().flatten();
            let here = here.filter(|&slot| self.get(slot).is_some_and(|s| s.key == subject.key));
            let found = here.or_else(|| self.by_key.get(&subject.key).copied());
            if let Some(slot) = found {
                let frame = self.frame;
                if let Some(slot) = self.get_mut(slot) {
                    slot.seen = frame;
                }
            }
            self.order.push(found);
        }
        for slot in 0..self.slots.len() as u32 {
            if self.get(slot).is_some_and(|s| s.seen != self.frame) {
                self.remove(slot);
            }
        }
        self.sort_free();
        for (at, subject) in subjects.iter().enumerate() {
            if self.order[at].is_none() && subject.form.is_some() {
                self.order[at] = Some(self.insert(subject, &casters[subject.index].mesh));
            }
        }
    }

    /// Gives a wanted slot its place.
    pub fn place(&mut self, slot: u32, words: Words) {
        let place = self.regions.take(words);
        if let Some(slot) = self.get_mut(slot) {
            slot.place = place;
            slot.words = words;
            slot.instance.facing_base = place.facing;
            slot.instance.cap_base = place.cap;
            slot.instance.side_base = place.side;
        }
    }

    /// The same for one that the CPU has found, which takes no more than it came to.
    pub fn place_found(&mut self, slot: u32, counts: Counts) {
        let caps = u64::from(counts.front) + u64::from(counts.back);
        self.place(slot, [0, caps, counts.sides.into()]);
        if let Some(slot) = self.get_mut(slot) {
            slot.counts = counts;
        }
    }

    fn insert(&mut self, subject: &Subject, mesh: &CasterMesh) -> u32 {
        let entry = match self.by_key.entry(subject.key) {
            // A twin was here first.
            Entry::Occupied(entry) => return *entry.get(),
            Entry::Vacant(entry) => entry,
        };
        let number = self.free.pop().unwrap_or_else(|| {
            self.slots.push(None);
            self.slots.len() as u32 - 1
        });
        self.slots[number as usize] = Some(Slot {
            mesh: mesh.clone(),
            way: subject.way,
            place: Place::default(),
            words: [0; 3],
            instance: InstanceParams {
                light: subject.light.light,
                light_rest: subject.light.rest,
                both_sides: subject.counted as u32,
                arguments: number,
                ..bytemuck::Zeroable::zeroed()
            },
            counts: Counts::default(),
            layers: None,
            key: subject.key,
            seen: self.frame,
        });
        self.wanted.push(number);
        *entry.insert(number)
    }

    fn remove(&mut self, number: u32) {
        let Some(slot) = self.slots.get_mut(number as usize).and_then(Option::take) else {
            return;
        };
        self.by_key.remove(&slot.key);
        self.regions.give_back(&slot.place, slot.words);
        self.free.push(number);
    }

    /// What is made next takes the least numbers, one after another, so that what is written for
    /// them lies together.
    fn sort_free(&mut self) {
        if !self.free.is_sorted_by(|a, b| a > b) {
            self.free.sort_unstable_by(|a, b| b.cmp(a));
        }
    }
}
