//! The draw calls of one volume's faces.

use crate::mesh::{CasterMesh, MeshKind};
use crate::volume::decide::facing::Counted;
use crate::volume::gpu::buffers::Buffers;
use crate::volume::plan::cache::Slot;
use crate::volume::plan::faces::{Draw, Faces};
use crate::volume::plan::params::{Arguments, CasterParams};
use crate::volume::silhouette::Way;

/// Records one draw, its pipeline and bind group being set.
pub(crate) fn record(
    pass: &mut wgpu::RenderPass<'_>,
    draw: &Draw,
    (slot, caster): (&Slot, &CasterParams),
    buffers: &Buffers,
) {
    match slot.way {
        Way::Vertex => record_all(pass, draw.style.faces, &slot.mesh, caster),
        Way::Cpu => {
            if let Some(each) = vertices_a_side(draw.style.faces, caster) {
                return pass.draw(0..slot.counts.sides * each, 0..1);
            }
            let Some([_, caps, _]) = buffers.chunk(slot.place.chunk) else {
                return;
            };
            let middle = slot.place.cap + slot.counts.front;
            let range = match draw.back {
                false => slot.place.cap..middle,
                true => middle..middle + slot.counts.back,
            };
            pass.set_index_buffer(caps.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(range, 0, 0..1);
        }
        Way::Compute => {
            let chunk = buffers.chunk(slot.place.chunk);
            let (Some(bound), Some([_, caps, _])) = (buffers.bound(), chunk) else {
                return;
            };
            let own = u64::from(slot.instance.arguments) * size_of::<Arguments>() as u64;
            match vertices_a_side(draw.style.faces, caster) {
                Some(3) => return pass.draw_indirect(bound.arguments, own + Arguments::TRIANGLES),
                Some(_) => return pass.draw_indirect(bound.arguments, own + Arguments::QUADS),
                None => {}
            }
            let list = match draw.back {
                false => Arguments::FRONT,
                true => Arguments::BACK,
            };
            pass.set_index_buffer(caps.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed_indirect(bound.arguments, own + list);
        }
    }
}

/// Vertices for each side, of faces that come from sides.
fn vertices_a_side(faces: Faces, caster: &CasterParams) -> Option<u32> {
    match faces {
        Faces::Sides => Some(caster.side_vertices),
        Faces::Fan => Some(3),
        Faces::LightCap | Faces::DarkCap => None,
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
    let Some(each) = vertices_a_side(faces, caster) else {
        pass.set_vertex_buffer(0, records.triangles.slice(..));
        return pass.draw(0..3, 0..mesh.triangle_count());
    };
    // Two triangles that both count are extruded twice where they run through the edge alike.
    let copies = match (mesh.kind(), caster.both_sides) {
        (MeshKind::Closed, counted) if counted != Counted::All as u32 => 1,
        _ => 2,
    };
    pass.set_vertex_buffer(0, records.edges.slice(..));
    pass.draw(0..copies * each, 0..records.edge_count);
}
