//! The casters of a frame, each with a number that stays its own wherever it stands in the host's list.

use std::collections::HashMap;

use crate::Caster;
use crate::error::ShadowVolumeError;
use crate::scene::Casters;
use crate::volume::decide::decision::{KnownCaster, words};
use crate::volume::plan::limits::PlanLimits;
use crate::volume::plan::meshes::MeshPool;
use crate::volume::plan::ranges::{Overflow, Regions};
use crate::volume::silhouette::{Way, Ways};

/// The casters of the last frame.
#[derive(Debug, Default)]
pub(crate) struct SceneCasters {
    compared: Casters,
    /// For each place in the host's list, the caster's number.
    numbers: Vec<u32>,
    known: Vec<Option<KnownCaster>>,
    free: Vec<u32>,
    /// How many casters have a mesh.
    users_of_mesh: HashMap<u64, u32>,
}

/// The numbers of casters that are not what they were.
#[derive(Debug, Default)]
pub(crate) struct Changes {
    /// New, or others than before: places in the host's list, and numbers.
    pub changed: Vec<(usize, u32)>,
    pub departed: Vec<u32>,
    /// Meshes that no caster has any more.
    pub meshes: Vec<u64>,
    /// By number, whether a caster changed; empty if none did.
    marks: Vec<bool>,
}

impl Changes {
    pub fn is_empty(&self) -> bool {
        self.changed.is_empty() && self.departed.is_empty()
    }

    /// Whether this caster is not what it was.
    pub fn has(&self, number: u32) -> bool {
        self.marks.get(number as usize) == Some(&true)
    }
}

/// What casters have to comply with.
pub(crate) struct Requirements<'a> {
    pub device: &'a wgpu::Device,
    pub ways: &'a Ways,
    pub limits: &'a PlanLimits,
    pub regions: &'a Regions,
    pub meshes: &'a MeshPool,
}

impl SceneCasters {
    /// Finds what changed, and checks that. Changes nothing that counts.
    pub fn compare(
        &mut self,
        casters: &[Caster],
        required: &Requirements<'_>,
    ) -> Result<(), ShadowVolumeError> {
        self.compared.compare(casters, required.device)?;
        for &index in self.compared.different() {
            required.check(index as usize, &casters[index as usize])?;
        }
        Ok(())
    }

    /// Takes over what [`compare`](Self::compare) found.
    pub fn update(&mut self, casters: &[Caster], ways: &Ways) -> Changes {
        let (mut gone, mut came) = (Vec::new(), Vec::new());
        self.compared.update(casters);
        for change in self.compared.changes() {
            let own = change
                .old
                .map(|old| (old.digest, self.numbers[change.index]));
            gone.extend(own);
            came.extend(change.new.map(|new| Arrival {
                index: change.index,
                digest: new.digest,
                instead_of: own.map(|(_, number)| number),
            }));
        }
        if gone.is_empty() && came.is_empty() {
            return Changes::default();
        }
        self.numbers.resize(casters.len(), 0);
        let mut changes = self.renumber(&gone, came);
        let mut left = Vec::new();
        changes.marks = vec![false; self.known.len()];
        for &(index, number) in &changes.changed {
            let caster = &casters[index];
            // Who has no way was refused before.
            let way = ways.of(&caster.mesh).unwrap_or(Way::Compute);
            let new = KnownCaster::new(caster, way);
            changes.marks[number as usize] = true;
            left.extend(self.replace(number, Some(new)));
        }
        for &number in &changes.departed {
            left.extend(self.replace(number, None));
            self.free.push(number);
        }
        left.retain(|mesh| !self.users_of_mesh.contains_key(mesh));
        changes.meshes = left;
        changes
    }

    /// Puts one caster in the place of another. The mesh of which that was the last.
    fn replace(&mut self, number: u32, new: Option<KnownCaster>) -> Option<u64> {
        let mesh = |caster: &Option<KnownCaster>| Some(caster.as_ref()?.mesh().id());
        let old = std::mem::replace(&mut self.known[number as usize], new);
        let [old, new] = [mesh(&old), mesh(&self.known[number as usize])];
        if old == new {
            return None;
        }
        if let Some(new) = new {
            *self.users_of_mesh.entry(new).or_default() += 1;
        }
        let old = old?;
        let users = self.users_of_mesh.get_mut(&old)?;
        *users -= 1;
        if *users > 0 {
            return None;
        }
        self.users_of_mesh.remove(&old);
        Some(old)
    }

    /// The numbers of all casters, in the order of the host's list.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    pub fn get(&self, number: u32) -> Option<&KnownCaster> {
        self.known.get(number as usize)?.as_ref()
    }

    /// What only changed its place in the list keeps its number; of the others, the new take over
    /// those of the old.
    fn renumber(&mut self, gone: &[(u128, u32)], came: Vec<Arrival>) -> Changes {
        let mut is_left = vec![false; self.known.len()];
        for &(_, number) in gone {
            is_left[number as usize] = true;
        }
        let mut take = |number: u32| std::mem::take(&mut is_left[number as usize]);
        let of_digest: HashMap<u128, u32> = gone.iter().copied().collect();
        let mut changes = Changes::default();
        let mut others = Vec::new();
        for arrival in came {
            let moved = of_digest.get(&arrival.digest);
            match moved.filter(|&&number| take(number)) {
                Some(number) => self.numbers[arrival.index] = *number,
                None => others.push(arrival),
            }
        }
        let mut without = Vec::new();
        for Arrival {
            index, instead_of, ..
        } in others
        {
            match instead_of.filter(|&number| take(number)) {
                Some(number) => changes.changed.push((index, number)),
                None => without.push(index),
            }
        }
        let mut left = gone.iter().map(|(_, number)| *number);
        for index in without {
            let number = (left.by_ref().find(|&number| take(number)))
                .or_else(|| self.free.pop())
                .unwrap_or_else(|| {
                    self.known.push(None);
                    self.known.len() as u32 - 1
                });
            changes.changed.push((index, number));
        }
        changes.departed.extend(left.filter(|&number| take(number)));
        for &(index, number) in &changes.changed {
            self.numbers[index] = number;
        }
        changes
    }
}

/// A caster that stands where it did not stand before.
struct Arrival {
    index: usize,
    digest: u128,
    /// Of whose place it took.
    instead_of: Option<u32>,
}

impl Requirements<'_> {
    /// Whether enough is known of a caster, and its volume fits the device's buffers.
    fn check(&self, index: usize, caster: &Caster) -> Result<(), ShadowVolumeError> {
        let mesh = &caster.mesh;
        if !mesh.has_adjacency() {
            return Err(ShadowVolumeError::NoAdjacency { index });
        }
        let way = self.ways.of(mesh);
        let way = way.ok_or(ShadowVolumeError::HostPositions { index })?;
        let records = match way {
            Way::Vertex => mesh.record_bytes(),
            Way::Compute | Way::Cpu => 0,
        };
        let checked = match records > self.limits.buffer_bytes {
            true => Err(Overflow {
                what: "edge records",
                size: records,
                limit: self.limits.buffer_bytes,
            }),
            false => {
                (self.regions.check(words(mesh, way))).and_then(|()| self.meshes.check(mesh, way))
            }
        };
        checked.map_err(|overflow| ShadowVolumeError::TooLarge {
            index,
            what: overflow.what,
            size: overflow.size,
            limit: overflow.limit,
        })
    }
}
