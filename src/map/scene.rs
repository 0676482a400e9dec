//! The casters as the last frame had them, so that what changed is found by looking.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use glam::{Affine3A, DVec3};

use super::descriptor::CasterSides;
use super::reach::Reach;
use super::slot::Slot;
use crate::PointLight;
use crate::error::CasterError;
use crate::mesh::{Caster, CasterMesh, MeshKind};

/// All that comparing one caster with its predecessor reads, side by side in memory.
#[derive(Clone, Copy, PartialEq)]
struct Seen {
    mesh: u64,
    revision: u64,
    transform: Affine3A,
}

impl Seen {
    fn of(caster: &Caster) -> Self {
        Self {
            mesh: caster.mesh.id(),
            revision: caster.mesh.revision(),
            transform: caster.world_from_object,
        }
    }
}

/// What a light needs to know of a caster; nothing here depends on any light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Record {
    /// Centre and half extents of its box in world space, and the radius around the centre.
    pub centre: DVec3,
    pub half: DVec3,
    pub radius: f64,
    /// Its part in the content of a face; see [`digest`].
    pub digest: u128,
    pub triangles: u32,
    /// Index of its [`Group`].
    pub group: u32,
    pub winding: Winding,
    /// The frame in which it became what it is.
    pub since: u64,
}

/// What a caster's winding says of its sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Winding {
    /// Nothing; both sides count.
    Any,
    /// Counter-clockwise seen from outside.
    Sound,
    /// Clockwise, after a transform that mirrors.
    Mirrored,
}

/// The casters of one mesh, which can go out in one draw call.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub mesh: CasterMesh,
    casters: usize,
}

#[derive(Default)]
pub(super) struct Scene {
    seen: Vec<Seen>,
    records: Vec<Record>,
    /// Centre and radius of each record: what a light that moved looks through.
    reach: Reach,
    groups: Vec<Option<Group>>,
    group_of_mesh: HashMap<u64, u32>,
    changed: Vec<u32>,
    sides: CasterSides,
    /// Counts the updates.
    frame: u64,
}

impl std::fmt::Debug for Scene {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Scene")
            .field("casters", &self.seen.len())
            .finish_non_exhaustive()
    }
}

impl Scene {
    pub fn new(sides: CasterSides) -> Self {
        Self {
            sides,
            ..Self::default()
        }
    }

    pub fn sides(&self) -> CasterSides {
        self.sides
    }

    pub fn records(&self) -> &[Record] {
        &self.records
    }

    /// Appends the casters whose spheres a light reaches, in any order.
    pub fn within(&mut self, light: &PointLight, found: &mut Vec<u32>) {
        let centre = light.position.as_dvec3();
        self.reach.within(centre, f64::from(light.range), found);
    }

    /// The last frame in which anything changed.
    pub fn frame(&self) -> u64 {
        self.frame
    }

    pub fn group(&self, index: u32) -> Option<&Group> {
        self.groups.get(index as usize)?.as_ref()
    }

    /// Finds the casters that are not what they were and checks those. Changes nothing that counts.
    pub fn compare(
        &mut self,
        casters: &[Caster],
        device: &wgpu::Device,
    ) -> Result<(), CasterError> {
        self.changed.clear();
        for (index, caster) in casters.iter().enumerate() {
            if self.seen.get(index) != Some(&Seen::of(caster)) {
                caster.validate(index, device)?;
                self.changed.push(index as u32);
            }
        }
        Ok(())
    }

    /// Whether the last [`compare`](Self::compare) found the casters as they were.
    pub fn is_still(&self, casters: &[Caster]) -> bool {
        self.changed.is_empty() && casters.len() == self.seen.len()
    }

    /// Takes over what [`compare`](Self::compare) found, and tells the lights.
    pub fn update(&mut self, casters: &[Caster], slots: &mut [Slot]) {
        self.frame += 1;
        let leaving = self.leaving(casters.len());
        for index in (casters.len()..self.records.len()).rev() {
            let old = self.records[index];
            slots.iter_mut().for_each(|slot| slot.remove_last(&old));
            self.leave_group(old.group);
        }
        self.records.truncate(casters.len());
        self.reach.truncate(casters.len());
        self.seen.truncate(casters.len());
        for changed in std::mem::take(&mut self.changed) {
            let index = changed as usize;
            let caster = &casters[index];
            let mut new = self.record(caster);
            if let Some(&since) = leaving.get(&new.digest) {
                new.since = since;
            }
            match self.records.get(index).copied() {
                Some(old) => {
                    slots
                        .iter_mut()
                        .for_each(|slot| slot.replace(index, &old, &new));
                    self.leave_group(old.group);
                    self.records[index] = new;
                    self.reach.set(index, new.centre.extend(new.radius));
                    self.seen[index] = Seen::of(caster);
                }
                None => {
                    slots.iter_mut().for_each(|slot| slot.push(&new));
                    self.records.push(new);
                    self.reach.push(new.centre.extend(new.radius));
                    self.seen.push(Seen::of(caster));
                }
            }
        }
    }

    /// The casters that are no longer where they were in the host's list, which may only have
    /// changed their order: since when each has been what it was.
    fn leaving(&self, count: usize) -> HashMap<u128, u64, BuildHasherDefault<DigestHasher>> {
        let changed = self.changed.iter().map(|&index| index as usize);
        let gone = changed
            .filter(|&index| index < count)
            .chain(count..self.records.len())
            .filter_map(|index| self.records.get(index));
        // Of two that are alike the younger counts: what was drawn since then holds both.
        let mut leaving = HashMap::default();
        for record in gone {
            let since = leaving.entry(record.digest).or_insert(record.since);
            *since = record.since.max(*since);
        }
        leaving
    }

    fn record(&mut self, caster: &Caster) -> Record {
        let transform = caster.transform();
        let (centre, half) = caster.mesh.bounds().transformed(&transform);
        Record {
            centre,
            half,
            radius: caster.mesh.radius_under(&transform.matrix3),
            digest: digest(&Seen::of(caster)),
            triangles: caster.mesh.triangle_count(),
            group: self.join_group(caster),
            winding: self.winding(caster),
            since: self.frame,
        }
    }

    fn winding(&self, caster: &Caster) -> Winding {
        let heeded = match self.sides {
            CasterSides::Both => false,
            CasterSides::Nearest => caster.mesh.is_solid(),
            CasterSides::Far => caster.mesh.kind() == MeshKind::Closed,
        };
        match heeded {
            false => Winding::Any,
            // In f64, where no scale underflows.
            true if caster.transform().matrix3.determinant() < 0.0 => Winding::Mirrored,
            true => Winding::Sound,
        }
    }

    fn join_group(&mut self, caster: &Caster) -> u32 {
        let groups = &mut self.groups;
        let index = *self
            .group_of_mesh
            .entry(caster.mesh.id())
            .or_insert_with(|| {
                let group = Some(Group {
                    mesh: caster.mesh.clone(),
                    casters: 0,
                });
                match groups.iter().position(Option::is_none) {
                    Some(free) => {
                        groups[free] = group;
                        free as u32
                    }
                    None => {
                        groups.push(group);
                        groups.len() as u32 - 1
                    }
                }
            });
        if let Some(group) = &mut self.groups[index as usize] {
            group.casters += 1;
        }
        index
    }

    /// A mesh that no caster has any more is let go.
    fn leave_group(&mut self, index: u32) {
        let place = &mut self.groups[index as usize];
        let Some(group) = place else { return };
        group.casters -= 1;
        if group.casters == 0 {
            self.group_of_mesh.remove(&group.mesh.id());
            *place = None;
        }
    }
}

/// Digests are hashes already.
#[derive(Default)]
struct DigestHasher(u64);

impl Hasher for DigestHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.0 ^= u64::from_ne_bytes(word);
        }
    }

    fn write_u128(&mut self, digest: u128) {
        self.0 = digest as u64;
    }
}

/// 128 bits that stand for one caster: mesh, revision and transform. A face's content is the sum
/// over its casters, so that their order means nothing and one can be taken out again (an additive
/// multiset hash: Clarke et al., "Incremental Multiset Hash Functions and Their Application to
/// Memory Integrity Checking", 2003). Two contents that differ have the same sum with a chance of
/// about 2^-128.
fn digest(seen: &Seen) -> u128 {
    let transform = seen.transform.to_cols_array();
    let mut lanes = [0x9e37_79b9_7f4a_7c15_u64, 0xc2b2_ae3d_27d4_eb4f];
    let mut take = |word: u64| {
        for (lane, key) in lanes
            .iter_mut()
            .zip([0xa076_1d64_78bd_642f_u64, 0xe703_7ed1_a0b4_28db])
        {
            // Multiply and fold, as wyhash does (Wang Yi, 2019).
            let product = u128::from(*lane ^ word) * u128::from(key);
            *lane = (product as u64) ^ ((product >> 64) as u64) ^ word.rotate_left(32);
        }
    };
    take(seen.mesh);
    take(seen.revision);
    for pair in transform.chunks_exact(2) {
        take(u64::from(pair[0].to_bits()) << 32 | u64::from(pair[1].to_bits()));
    }
    take(0);
    take(0);
    u128::from(lanes[0]) << 64 | u128::from(lanes[1])
}
