//! Extraction on the CPU: one byte of facing a triangle, then the edges between unequal bytes.

use glam::{Vec3, Vec4};

use super::super::params::InstanceParams;
use super::light_side::light_side;
use crate::mesh::{MeshData, MeshKind};

/// What an extraction found, in the form the draws read. Kept for its memory.
#[derive(Debug, Default)]
pub(in super::super) struct CpuVolume {
    facings: Vec<i8>,
    /// Indices of the caps that count +1.
    pub front: Vec<u32>,
    /// Indices of the caps that count -1.
    pub back: Vec<u32>,
    /// `edge << 1 | flipped`, once for each side.
    pub sides: Vec<u32>,
}

/// How many indices and sides a volume has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in super::super) struct Counts {
    pub front: u32,
    pub back: u32,
    pub sides: u32,
}

impl CpuVolume {
    /// Finds the volume of one instance, as `volume_facing.wgsl` and `volume_edges.wgsl` do.
    pub fn extract(&mut self, mesh: &MeshData, kind: MeshKind, instance: &InstanceParams) {
        self.find_facings(mesh, instance);
        self.sides.clear();
        match kind {
            MeshKind::Closed => self.find_sides_closed(mesh),
            MeshKind::General => self.find_sides_general(mesh),
        }
    }

    /// The sizes of the lists, each below 2^32 because its region is.
    pub fn counts(&self) -> Counts {
        Counts {
            front: self.front.len() as u32,
            back: self.back.len() as u32,
            sides: self.sides.len() as u32,
        }
    }

    fn find_facings(&mut self, mesh: &MeshData, instance: &InstanceParams) {
        self.facings.clear();
        self.front.clear();
        self.back.clear();
        let light = Vec4::from(instance.light);
        let rest = Vec3::from(instance.light_rest);
        let lowest = if instance.both_sides == 0 { 0 } else { -1 };
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|v| Vec3::from(mesh.positions[v as usize]));
            let count = light_side(a, b, c, light, rest).max(lowest);
            self.facings.push(count);
            match count {
                1 => self.front.extend(corners),
                -1 => self.back.extend(corners),
                _ => {}
            }
        }
    }

    fn find_sides_closed(&mut self, mesh: &MeshData) {
        for (edge, &[_, _, there, back]) in (0u32..).zip(&mesh.edges) {
            let sum = self.facings[there as usize] - self.facings[back as usize];
            if sum != 0 {
                self.push(edge, i32::from(sum));
            }
        }
    }

    fn find_sides_general(&mut self, mesh: &MeshData) {
        for (edge, &[_, _, first, count]) in (0u32..).zip(&mesh.edges) {
            let uses = &mesh.edge_uses[first as usize..][..count as usize];
            let sum = uses.iter().map(|edge_use| {
                let count = i32::from(self.facings[edge_use.triangle() as usize]);
                if edge_use.reversed() { -count } else { count }
            });
            self.push(edge, sum.sum());
        }
    }

    /// An edge that the caps' boundary runs through `sum` times.
    fn push(&mut self, edge: u32, sum: i32) {
        let side = edge << 1 | u32::from(sum < 0);
        for _ in 0..sum.unsigned_abs() {
            self.sides.push(side);
        }
    }
}
