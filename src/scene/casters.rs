//! The casters as the last frame had them, so that what changed is found by looking.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
use std::num::NonZeroU32;

use glam::{Affine3A, DVec3};

use super::blocks::{Block, Blocks};
use super::bounds::CasterBounds;
use super::caster_tree::CasterSpheres;
use super::digest::Digest;
use crate::error::CasterError;
use crate::mesh::{Caster, CasterMesh, MeshKind};

/// All that comparing one caster with its predecessor reads, side by side in memory.
#[derive(Clone, Copy, PartialEq)]
struct Compared {
    mesh: u64,
    revision: u64,
    transform: Affine3A,
    layers: u32,
    owner: Option<NonZeroU32>,
}

impl Compared {
    fn of(caster: &Caster) -> Self {
        Self {
            mesh: caster.mesh.id(),
            revision: caster.mesh.revision(),
            transform: caster.world_from_object,
            layers: caster.layers,
            owner: caster.owner,
        }
    }
}

/// What a light needs to know of a caster; nothing here depends on any light or map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Record {
    /// In world space.
    pub bounds: CasterBounds,
    /// Stands for mesh, revision, transform, layers and owner; see [`digest`].
    pub digest: u128,
    pub triangles: u32,
    /// Its mesh's place: see [`Casters::mesh`].
    pub mesh: u32,
    /// Whether its mesh is closed, and each of its surfaces encloses a positive volume.
    pub closed: bool,
    pub solid: bool,
    /// Whether its transform turns windings over.
    pub mirrored: bool,
    /// Whether the host draws it.
    pub host_drawn: bool,
    pub layers: u32,
    pub owner: Option<NonZeroU32>,
    /// The frame in which it became what it is.
    pub since: u64,
}

impl Record {
    /// Whether it casts at all.
    pub fn casts(&self) -> bool {
        self.triangles > 0
    }
}

/// One caster that is not what it was at this place of the host's list: new, another, or gone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change<'a> {
    pub index: usize,
    pub old: Option<&'a Record>,
    pub new: Option<&'a Record>,
}

/// A mesh and how many casters have it: those can go out in one draw call.
#[derive(Clone, Debug)]
struct Shared {
    mesh: CasterMesh,
    casters: usize,
}

/// The casters of the last frame.
#[derive(Default)]
pub(crate) struct Casters {
    compared: Vec<Compared>,
    records: Vec<Record>,
    /// Centre and radius of each record: what a light that moved looks through.
    spheres: CasterSpheres,
    blocks: Blocks,
    meshes: Vec<Option<Shared>>,
    place_of_mesh: HashMap<u64, u32>,
    /// Found by the last [`compare`](Self::compare).
    different: Vec<u32>,
    /// What the last update replaced, by index.
    replaced: Vec<(u32, Option<Record>)>,
    // Kept only for its memory.
    leaving: Leaving,
    /// Counts the updates.
    frame: u64,
}

impl std::fmt::Debug for Casters {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Casters")
            .field("count", &self.compared.len())
            .finish_non_exhaustive()
    }
}

impl Casters {
    pub fn records(&self) -> &[Record] {
        &self.records
    }

    /// Appends the casters whose spheres reach into a sphere, in any order.
    pub fn within(&mut self, centre: DVec3, range: f64, found: &mut Vec<u32>) {
        self.spheres.within(centre, range, found);
    }

    /// The last frame in which anything changed.
    pub fn frame(&self) -> u64 {
        self.frame
    }

    /// The mesh at a place that a record names.
    pub fn mesh(&self, place: u32) -> Option<&CasterMesh> {
        Some(&self.meshes.get(place as usize)?.as_ref()?.mesh)
    }

    /// The records by eights; the last few are in none.
    pub fn blocks(&self) -> &[Block] {
        self.blocks.all()
    }

    /// Finds the casters that are not what they were and checks those. Changes nothing that counts.
    pub fn compare(
        &mut self,
        casters: &[Caster],
        device: &wgpu::Device,
    ) -> Result<(), CasterError> {
        self.different.clear();
        for (index, caster) in casters.iter().enumerate() {
            if self.compared.get(index) != Some(&Compared::of(caster)) {
                caster.validate(index, device)?;
                self.different.push(index as u32);
            }
        }
        Ok(())
    }

    /// The places of those that the last [`compare`](Self::compare) found to be new, or others.
    pub fn different(&self) -> &[u32] {
        &self.different
    }

    /// Whether the last [`compare`](Self::compare) found the casters as they were.
    pub fn are_unchanged(&self, casters: &[Caster]) -> bool {
        self.different.is_empty() && casters.len() == self.compared.len()
    }

    /// Takes over what [`compare`](Self::compare) found: see [`changes`](Self::changes).
    pub fn update(&mut self, casters: &[Caster]) {
        if !self.are_unchanged(casters) {
            self.take_over(casters);
        } else {
            self.replaced.clear();
        }
    }

    /// What the last [`update`](Self::update) changed: those that are gone from the end of the list
    /// first, the last of them before the others.
    pub fn changes(&self) -> impl ExactSizeIterator<Item = Change<'_>> {
        self.replaced.iter().map(|(index, old)| Change {
            index: *index as usize,
            old: old.as_ref(),
            new: self.records.get(*index as usize),
        })
    }

    fn take_over(&mut self, casters: &[Caster]) {
        self.frame += 1;
        self.replaced.clear();
        let leaving = self.leaving(casters.len());
        for index in (casters.len()..self.records.len()).rev() {
            let old = self.records[index];
            self.replaced.push((index as u32, Some(old)));
            self.leave_mesh(old.mesh);
        }
        self.records.truncate(casters.len());
        self.spheres.truncate(casters.len());
        self.compared.truncate(casters.len());
        let different = std::mem::take(&mut self.different);
        for &place in &different {
            let index = place as usize;
            let caster = &casters[index];
            let compared = Compared::of(caster);
            let digest = digest(&compared);
            let since = leaving.get(&digest).copied().unwrap_or(self.frame);
            let mesh = self.mesh_at(index, caster);
            let bounds = CasterBounds::of(caster);
            let sphere = bounds.centre.extend(bounds.radius);
            let new = Record {
                bounds,
                digest,
                triangles: caster.mesh.triangle_count(),
                mesh,
                closed: caster.mesh.kind() == MeshKind::Closed,
                solid: caster.mesh.is_solid(),
                // In f64, where no scale underflows.
                mirrored: caster.transform().matrix3.determinant() < 0.0,
                host_drawn: caster.mesh.is_host_drawn(),
                layers: caster.layers,
                owner: caster.owner,
                since,
            };
            match self.records.get_mut(index) {
                Some(record) => {
                    self.replaced.push((place, Some(*record)));
                    *record = new;
                    self.spheres.set(index, sphere);
                    self.compared[index] = compared;
                }
                None => {
                    self.replaced.push((place, None));
                    self.records.push(new);
                    self.spheres.push(sphere);
                    self.compared.push(compared);
                }
            }
        }
        self.blocks.update(&self.records, &different);
        // Given back for their memory.
        self.leaving = leaving;
        self.different = different;
        self.different.clear();
    }

    /// The casters that are no longer where they were in the host's list, which may only have
    /// changed their order: since when each has been what it was.
    fn leaving(&mut self, count: usize) -> Leaving {
        let mut leaving = std::mem::take(&mut self.leaving);
        leaving.clear();
        let different = self.different.iter().map(|&index| index as usize);
        let gone = different
            .filter(|&index| index < count)
            .chain(count..self.records.len())
            .filter_map(|index| self.records.get(index));
        // Of two that are alike the younger counts: what was drawn since then holds both.
        for record in gone {
            let since = leaving.entry(record.digest).or_insert(record.since);
            *since = record.since.max(*since);
        }
        leaving
    }

    /// The place of the mesh of a caster, in exchange for that of the one before it.
    fn mesh_at(&mut self, index: usize, caster: &Caster) -> u32 {
        let before = self.compared.get(index).map(|before| before.mesh);
        let old = self.records.get(index).map(|old| old.mesh);
        match old {
            Some(old) if before == Some(caster.mesh.id()) => old,
            _ => {
                let joined = self.join_mesh(caster);
                old.into_iter().for_each(|old| self.leave_mesh(old));
                joined
            }
        }
    }

    fn join_mesh(&mut self, caster: &Caster) -> u32 {
        let meshes = &mut self.meshes;
        let place = *self
            .place_of_mesh
            .entry(caster.mesh.id())
            .or_insert_with(|| {
                let shared = Some(Shared {
                    mesh: caster.mesh.clone(),
                    casters: 0,
                });
                match meshes.iter().position(Option::is_none) {
                    Some(free) => {
                        meshes[free] = shared;
                        free as u32
                    }
                    None => {
                        meshes.push(shared);
                        meshes.len() as u32 - 1
                    }
                }
            });
        if let Some(shared) = &mut self.meshes[place as usize] {
            shared.casters += 1;
        }
        place
    }

    /// A mesh that no caster has any more is let go.
    fn leave_mesh(&mut self, place: u32) {
        let place = &mut self.meshes[place as usize];
        let Some(shared) = place else { return };
        shared.casters -= 1;
        if shared.casters == 0 {
            self.place_of_mesh.remove(&shared.mesh.id());
            *place = None;
        }
    }
}

/// Frames by digests of casters.
type Leaving = HashMap<u128, u64, BuildHasherDefault<DigestHasher>>;

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

/// 128 bits that stand for one caster: mesh, revision, transform, layers and owner. A tile's content is the sum
/// over its casters, so that their order means nothing and one can be taken out again (an additive
/// multiset hash: Clarke et al., "Incremental Multiset Hash Functions and Their Application to
/// Memory Integrity Checking", 2003). Two contents that differ have the same sum with a chance of
/// about 2^-128.
fn digest(of: &Compared) -> u128 {
    let mut digest = Digest::new();
    digest.take(of.mesh);
    digest.take(of.revision);
    digest.take_f32(&of.transform.to_cols_array());
    digest.take(u64::from(of.layers) << 32 | u64::from(of.owner.map_or(0, NonZeroU32::get)));
    digest.finish()
}

/// The same of a caster.
pub(crate) fn caster_digest(caster: &Caster) -> u128 {
    digest(&Compared::of(caster))
}
