//! The draw calls of volumes' faces.

use crate::mesh::{CasterMesh, MeshKind};
use crate::volume::decide::facing::Counted;
use crate::volume::gpu::buffers::Buffers;
use crate::volume::plan::cache::{Slot, VolumeCache};
use crate::volume::plan::faces::Faces;
use crate::volume::plan::merged::{DRAW_BYTES, MergedDraw};
use crate::volume::plan::params::{Arguments, CasterParams};
use crate::volume::plan::windows::Windows;
use crate::volume::silhouette::Way;

/// What draw calls are recorded from.
#[derive(Clone, Copy)]
pub(crate) struct Recorder<'a> {
    pub windows: &'a Windows,
    pub cache: &'a VolumeCache,
    pub buffers: &'a Buffers,
}

impl Recorder<'_> {
    /// Records one draw, its pipeline and bind group being set.
    pub fn record(&self, pass: &mut wgpu::RenderPass<'_>, draw: &MergedDraw) {
        match (draw.key.way, draw.key.own) {
            (Way::Vertex, _) => {
                if let Some((slot, caster)) = self.only(draw) {
                    record_all(pass, draw.key.style.faces, &slot.mesh, caster);
                }
            }
            (_, true) => self.record_indexed(pass, draw),
            (_, false) => self.record_blocks(pass, draw),
        }
    }

    /// The lines of the silhouettes that a draw of sides has, pipeline and bind group being set.
    pub fn record_edges(&self, pass: &mut wgpu::RenderPass<'_>, draw: &MergedDraw) {
        if draw.key.way != Way::Vertex {
            return self.record_blocks(pass, draw);
        }
        let only = self.only(draw);
        if let Some(records) = only.and_then(|(slot, _)| slot.mesh.records()) {
            pass.set_vertex_buffer(0, records.edges.slice(..));
            pass.draw(0..2, 0..records.edge_count);
        }
    }

    /// Instances that are blocks.
    fn record_blocks(&self, pass: &mut wgpu::RenderPass<'_>, draw: &MergedDraw) {
        let Some([_, blocks, draws]) = self.buffers.merged(draw.chunk()) else {
            return;
        };
        let Some(blocks) = blocks else { return };
        pass.set_vertex_buffer(0, blocks.slice(draw.block_bytes()));
        match draw.key.way {
            Way::Cpu => pass.draw(0..draw.key.block_vertices(), 0..draw.block_count()),
            Way::Compute | Way::Vertex => {
                let [_, _, own] = draw.starts();
                if let Some(draws) = draws {
                    pass.draw_indirect(draws, u64::from(own) * DRAW_BYTES);
                }
            }
        }
    }

    /// The caps of one caster.
    fn record_indexed(&self, pass: &mut wgpu::RenderPass<'_>, draw: &MergedDraw) {
        let Some((slot, _)) = self.only(draw) else {
            return;
        };
        let chunk = self.buffers.chunk(slot.place.chunk);
        let merged = self.buffers.merged(draw.chunk());
        let (Some([_, caps, _]), Some([_, Some(block), _])) = (chunk, merged) else {
            return;
        };
        pass.set_vertex_buffer(0, block.slice(draw.block_bytes()));
        pass.set_index_buffer(caps.slice(..), wgpu::IndexFormat::Uint32);
        if slot.way == Way::Cpu {
            let middle = slot.place.cap + slot.counts.front;
            let range = match draw.key.back {
                false => slot.place.cap..middle,
                true => middle..middle + slot.counts.back,
            };
            return pass.draw_indexed(range, 0, 0..1);
        }
        if let Some(bound) = self.buffers.bound() {
            let own = u64::from(slot.instance.arguments) * size_of::<Arguments>() as u64;
            let list = match draw.key.back {
                false => Arguments::FRONT,
                true => Arguments::BACK,
            };
            pass.draw_indexed_indirect(bound.arguments, own + list);
        }
    }

    /// The caster of a draw that has but one.
    fn only(&self, draw: &MergedDraw) -> Option<(&Slot, &CasterParams)> {
        let window = self.windows.get(draw.first()?)?;
        Some((self.cache.get(window.slot)?, &window.params))
    }
}

/// Every triangle or every edge as an instance.
fn record_all(
    pass: &mut wgpu::RenderPass<'_>,
    faces: Faces,
    mesh: &CasterMesh,
    caster: &CasterParams,
) {
    let Some(records) = mesh.records() else {
        return;
    };
    let each = match faces {
        Faces::Sides => caster.side_vertices,
        Faces::Fan => 3,
        Faces::LightCap | Faces::DarkCap => {
            pass.set_vertex_buffer(0, records.triangles.slice(..));
            return pass.draw(0..3, 0..mesh.triangle_count());
        }
    };
    // Two triangles that both count are extruded twice where they run through the edge alike.
    let copies = match (mesh.kind(), caster.both_sides) {
        (MeshKind::Closed, counted) if counted != Counted::All as u32 => 1,
        _ => 2,
    };
    pass.set_vertex_buffer(0, records.edges.slice(..));
    pass.draw(0..copies * each, 0..records.edge_count);
}
