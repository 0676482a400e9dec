//! The casters of a plane, in its own frame.

use super::axes::PlaneAxes;
use super::light::{Casts, PlaneLight};
use super::statistics::PlanarStatistics;
use crate::map::{INSTANCE_SIZE, Instance, buffer, instance, largest_buffer};
use crate::mesh::{Caster, CasterMesh};
use crate::runs::Runs;
use crate::scene::Casters;
use crate::uploads::Uploads;

/// Where the casters of a frame are relative to a plane: one row of a buffer each, those of a mesh together.
#[derive(Debug)]
pub(crate) struct PlaneCasters {
    label: String,
    pub axes: PlaneAxes,
    /// By place in the buffer: the caster there, and what is written of it.
    order: Vec<u32>,
    rows: Vec<Instance>,
    /// By caster: its place in the buffer.
    places: Vec<u32>,
    buffer: wgpu::Buffer,
    /// Whether the buffer holds the rows once the uploads are recorded.
    written: bool,
}

impl PlaneCasters {
    pub fn new(device: &wgpu::Device, label: &str, axes: PlaneAxes) -> Self {
        let label = format!("{label} instances");
        Self {
            axes,
            order: Vec::new(),
            rows: Vec::new(),
            places: Vec::new(),
            buffer: buffer(device, &label, INSTANCE_SIZE, wgpu::BufferUsages::VERTEX),
            written: false,
            label,
        }
    }

    /// Follows a frame's changes. `reordered`: whether casters came, went or changed their meshes.
    pub fn update(
        &mut self,
        (device, uploads): (&wgpu::Device, &mut Uploads),
        axes: PlaneAxes,
        (casters, all): (&Casters, &[Caster]),
        reordered: bool,
    ) {
        let moved = std::mem::replace(&mut self.axes, axes) != axes;
        if reordered || moved || !self.written {
            return self.rebuild(device, uploads, (casters, all));
        }
        let plane_from_world = axes.plane_from_world();
        let mut changed = Vec::new();
        for change in casters.changes() {
            let row = instance(&(plane_from_world * all[change.index].transform()));
            let place = self.places[change.index] as usize;
            if std::mem::replace(&mut self.rows[place], row) != row {
                changed.push(place);
            }
        }
        changed.sort_unstable();
        let mut runs = Runs::default();
        changed.iter().for_each(|&place| runs.add(place..place + 1));
        runs.write(uploads, (&self.buffer, 0), &self.rows);
    }

    fn rebuild(
        &mut self,
        device: &wgpu::Device,
        uploads: &mut Uploads,
        (casters, all): (&Casters, &[Caster]),
    ) {
        let records = casters.records();
        self.order.clear();
        self.order.extend(0..all.len() as u32);
        self.order
            .sort_by_key(|&caster| records[caster as usize].mesh);
        self.places.resize(all.len(), 0);
        for (place, &caster) in (0..).zip(&self.order) {
            self.places[caster as usize] = place;
        }
        let plane_from_world = self.axes.plane_from_world();
        let place = |&caster: &u32| &all[caster as usize];
        let rows = self.order.iter().map(place);
        self.rows.clear();
        self.rows
            .extend(rows.map(|caster| instance(&(plane_from_world * caster.transform()))));
        let size = self.rows.len() as u64 * INSTANCE_SIZE;
        if size > self.buffer.size() {
            let room = size.next_power_of_two().min(largest_buffer(device));
            self.buffer = buffer(device, &self.label, room, wgpu::BufferUsages::VERTEX);
        }
        uploads.write(&self.buffer, 0, bytemuck::cast_slice(&self.rows));
        self.written = true;
    }

    /// Takes nothing for written.
    pub fn forget(&mut self) {
        self.written = false;
    }

    pub fn bytes(&self) -> u64 {
        self.buffer.size()
    }

    /// What casts on the plane under a light: runs of one mesh that lie side by side.
    pub fn draws(
        &self,
        casters: &Casters,
        light: &PlaneLight,
        counts: &mut PlanarStatistics,
    ) -> Vec<CastDraw> {
        let mut draws: Vec<CastDraw> = Vec::new();
        // The mesh of the run that the last draw is, and where it ends.
        let mut run = None;
        for (place, (&caster, row)) in (0..).zip(self.order.iter().zip(&self.rows)) {
            let record = &casters.records()[caster as usize];
            if !record.casts() {
                continue;
            }
            let cut = match light.casts(&self.axes, &record.bounds) {
                Casts::Nothing => {
                    counts.casters_behind += 1;
                    continue;
                }
                Casts::Beyond => {
                    counts.casters_beyond += 1;
                    continue;
                }
                _ if !row.iter().flatten().all(|entry| entry.is_finite()) => {
                    counts.casters_not_finite += 1;
                    continue;
                }
                casts => casts == Casts::Part,
            };
            counts.casters_drawn += 1;
            counts.casters_cut += u32::from(cut);
            let Some(mesh) = casters.mesh(record.mesh) else {
                continue; // the mesh of every record is there
            };
            let here = (record.mesh, cut, place);
            match draws.last_mut() {
                Some(last) if run == Some(here) && mesh.places().is_none() => last.count += 1,
                _ => draws.push(CastDraw {
                    mesh: mesh.clone(),
                    first: place,
                    count: 1,
                    cut,
                }),
            }
            run = Some((record.mesh, cut, place + 1));
        }
        draws
    }

    /// The rows that a draw reads.
    pub fn slice(&self, draw: &CastDraw) -> wgpu::BufferSlice<'_> {
        let first = u64::from(draw.first) * INSTANCE_SIZE;
        self.buffer
            .slice(first..first + u64::from(draw.count) * INSTANCE_SIZE)
    }
}

/// Whether the last update of the casters brought some, took some away or changed their meshes.
pub(crate) fn reorders(casters: &Casters) -> bool {
    casters
        .changes()
        .any(|change| match (change.old, change.new) {
            (Some(old), Some(new)) => old.mesh != new.mesh,
            _ => true,
        })
}

/// The first caster that only the host can draw, of those that the last comparison found to differ: what has it is
/// refused, and never becomes what others are compared with.
pub(crate) fn host_drawn(casters: &Casters, all: &[Caster]) -> Option<usize> {
    let mut different = casters.different().iter().map(|&index| index as usize);
    different.find(|&index| all[index].mesh.is_host_drawn())
}

/// One draw call: a mesh, and where its rows lie.
#[derive(Clone, Debug)]
pub(crate) struct CastDraw {
    pub mesh: CasterMesh,
    pub first: u32,
    pub count: u32,
    /// Whether fragments have to be cut off.
    pub cut: bool,
}

impl CastDraw {
    pub fn triangles(&self) -> u64 {
        u64::from(self.mesh.triangle_count()) * u64::from(self.count)
    }

    /// Records it, with its pipeline and bind group set.
    pub fn record(&self, pass: &mut wgpu::RenderPass<'_>, rows: wgpu::BufferSlice<'_>) {
        let (_, offset) = self.mesh.layout();
        pass.set_vertex_buffer(0, self.mesh.positions().slice(offset..));
        // Sliced rather than drawn from a first instance, which GL does not have.
        pass.set_vertex_buffer(1, rows);
        let (indices, format) = self.mesh.indices();
        pass.set_index_buffer(indices, format);
        let mut count = self.count;
        if let Some(places) = self.mesh.places() {
            pass.set_vertex_buffer(2, places.buffer.slice(places.offset..));
            count = places.count;
        }
        pass.draw_indexed(0..self.mesh.index_count(), 0, 0..count);
    }
}
