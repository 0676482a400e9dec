//! The meshes that shaders read, all in shared buffers: where each of them lies.

use std::collections::HashMap;

use crate::mesh::{CasterMesh, MeshKind};
use crate::volume::plan::ranges::{Chunks, Overflow};
use crate::volume::silhouette::Way;

/// The lists of a mesh.
pub(crate) const LISTS: usize = 4;

/// What they are called, in errors and labels.
pub(crate) const NAMES: [&str; LISTS] = ["positions", "triangles", "edges", "edge uses"];

/// Bytes of a position, a triangle, an edge and a use of an edge.
pub(crate) const ITEM_BYTES: [u64; LISTS] = [12, 12, 16, 4];

/// Items of each list.
type Items = [u64; LISTS];

/// Where a mesh lies: the buffers, and its first item in each of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct MeshPlace {
    pub pool: usize,
    pub position: u32,
    pub triangle: u32,
    pub edge: u32,
    pub edge_use: u32,
}

/// A mesh that has its place.
#[derive(Clone, Debug)]
struct Entry {
    mesh: CasterMesh,
    place: MeshPlace,
    items: Items,
    /// Whether it was written there, or will be in this frame.
    written: bool,
}

/// The meshes under a renderer's volumes. One is written when a volume of it is first looked for, and
/// stays as long as any caster has it.
#[derive(Debug)]
pub(crate) struct MeshPool {
    chunks: Chunks<LISTS>,
    entries: HashMap<u64, Entry>,
    /// Those to be written in this frame.
    new: Vec<u64>,
}

/// Bytes of a mesh, and where they go.
pub(crate) struct Piece<'a> {
    pub pool: usize,
    pub list: usize,
    pub offset: u64,
    pub bytes: &'a [u8],
}

impl MeshPool {
    /// `bytes`: the largest storage buffer that can be made and bound.
    pub fn new(bytes: u64) -> Self {
        // Shaders count in words of 32 bits.
        let bytes = bytes.min(u64::from(u32::MAX) * 4);
        let limit = ITEM_BYTES.map(|each| bytes / each);
        Self {
            chunks: Chunks::new(NAMES, ITEM_BYTES, limit),
            entries: HashMap::new(),
            new: Vec::new(),
        }
    }

    /// Whether a mesh fits.
    pub fn check(&self, mesh: &CasterMesh, way: Way) -> Result<(), Overflow> {
        self.chunks.check(items(mesh, way))
    }

    /// Forgets what the last frame had to write, as that is done.
    pub fn begin(&mut self) {
        self.new.clear();
    }

    /// Where a mesh lies that passed the [`check`](Self::check); it is written if it is not there yet.
    pub fn place(&mut self, mesh: &CasterMesh, way: Way) -> MeshPlace {
        if way == Way::Vertex {
            return MeshPlace::default();
        }
        let chunks = &mut self.chunks;
        let entry = self.entries.entry(mesh.id()).or_insert_with(|| {
            let items = items(mesh, way);
            let (pool, [position, triangle, edge, edge_use]) = chunks.take(items);
            let place = MeshPlace {
                pool,
                position,
                triangle,
                edge,
                edge_use,
            };
            Entry {
                mesh: mesh.clone(),
                place,
                items,
                written: false,
            }
        });
        if !entry.written {
            entry.written = true;
            self.new.push(mesh.id());
        }
        entry.place
    }

    /// Takes the place of a mesh back that no caster has any more.
    pub fn release(&mut self, mesh: u64) {
        if let Some(Entry { place, items, .. }) = self.entries.remove(&mesh) {
            let starts = [place.position, place.triangle, place.edge, place.edge_use];
            self.chunks.give_back((place.pool, starts), items);
        }
    }

    /// Has what the last frame had to write written again when it is asked for.
    pub fn forget_last(&mut self) {
        for mesh in std::mem::take(&mut self.new) {
            if let Some(entry) = self.entries.get_mut(&mesh) {
                entry.written = false;
            }
        }
    }

    /// Has every mesh written again when it is asked for.
    pub fn forget_all(&mut self) {
        self.entries
            .values_mut()
            .for_each(|entry| entry.written = false);
    }

    /// Items of each list in each pool up to the last that is taken.
    pub fn ends(&self) -> impl Iterator<Item = Items> {
        self.chunks.ends()
    }

    /// What this frame has to write, list by list.
    pub fn pieces(&self) -> impl Iterator<Item = Piece<'_>> {
        let new = || self.new.iter().filter_map(|mesh| self.entries.get(mesh));
        (0..LISTS).flat_map(move |list| new().filter_map(move |entry| piece(entry, list)))
    }
}

fn piece(entry: &Entry, list: usize) -> Option<Piece<'_>> {
    let data = entry.mesh.welded_data()?;
    let place = &entry.place;
    let (start, bytes): (u32, &[u8]) = match list {
        0 => (place.position, bytemuck::cast_slice(&data.positions)),
        1 => (place.triangle, bytemuck::cast_slice(&data.triangles)),
        2 => (place.edge, bytemuck::cast_slice(&data.edges)),
        _ => (place.edge_use, bytemuck::cast_slice(&data.edge_uses)),
    };
    (entry.items[list] > 0).then_some(Piece {
        pool: place.pool,
        list,
        offset: u64::from(start) * ITEM_BYTES[list],
        bytes,
    })
}

/// What shaders read of a mesh: all draws positions and edges, extraction the rest.
fn items(mesh: &CasterMesh, way: Way) -> Items {
    let Some(data) = mesh.welded_data() else {
        return [0; LISTS];
    };
    let (positions, edges) = (data.positions.len() as u64, data.edges.len() as u64);
    let uses = match mesh.kind() {
        MeshKind::Closed => 0,
        MeshKind::General => data.edge_uses.len() as u64,
    };
    match way {
        Way::Compute => [positions, data.triangles.len() as u64, edges, uses],
        Way::Cpu => [positions, 0, edges, 0],
        Way::Vertex => [0; LISTS],
    }
}
