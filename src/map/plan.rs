//! What a frame draws: for each slot a mask of faces, and what becomes of the others.

use super::cube::CubeShadowMap;
use super::descriptor::{Allocation, CubeFrame};
use super::face::CubeFace;
use super::schedule::{Job, choose, jobs_of};
use super::slot::{ALL_FACES, Slot};
use super::statistics::{CubeStatistics, FaceState, FaceStatistics};
use super::still::Way;
use super::visible::Frustum;

/// Frames in which a light reaches no caster after which its texels are given back: enough that a
/// caster which comes and goes does not have them made each time.
const IDLE: u32 = 60;

/// One slot's part of a plan.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SlotPlan {
    /// Faces whose texels are out of date and can be seen.
    pub wanted: u8,
    /// Out of date, not seen.
    pub hidden: u8,
    /// Those of `wanted` that are drawn.
    pub drawn: u8,
}

impl CubeShadowMap {
    /// Chooses the faces to draw. Changes nothing.
    pub(super) fn plan(&self, frame: &CubeFrame<'_>) -> Vec<SlotPlan> {
        let frustum = frame.view.map(Frustum::new);
        let mut plans = vec![SlotPlan::default(); self.slots.len()];
        let mut jobs: Vec<Job> = Vec::new();
        for (place, &index) in self.order.iter().enumerate() {
            let slot = &self.slots[index];
            let (Some(light), Some(_)) = (&slot.light, self.textures.slot(index)) else {
                continue;
            };
            let visible = match &frustum {
                Some(frustum) => frustum.faces(light, self.reach, self.size),
                None => ALL_FACES,
            };
            let again = if self.cache { 0 } else { !slot.empty() };
            let stale = slot.stale() | again & ALL_FACES;
            let plan = &mut plans[index];
            plan.wanted = stale & visible;
            plan.hidden = stale & !visible;
            let free = self.budget.is_none() || frame.pinned.contains(&place);
            let weight = frustum
                .as_ref()
                .map_or(1.0, |frustum| frustum.weight(light));
            let (must, choice) = jobs_of(index, slot, plan.wanted, free, weight);
            plan.drawn = must;
            jobs.extend(choice);
        }
        if let Some(budget) = self.budget {
            for job in choose(jobs, budget) {
                plans[job.slot].drawn |= job.faces;
            }
        }
        plans
    }

    /// Takes a plan over into the slots.
    pub(super) fn follow(&mut self, plans: &[SlotPlan]) {
        for (slot, plan) in self.slots.iter_mut().zip(plans) {
            if plan.drawn == plan.wanted {
                slot.shown = slot.light;
            }
            slot.schedule(plan.drawn);
            slot.grow_older(plan.wanted & !plan.drawn);
        }
    }

    /// Counts what a plan does with every face of every light.
    pub(super) fn tally(&mut self, plans: &[SlotPlan]) -> CubeStatistics {
        let mut statistics = CubeStatistics::default();
        let casters = self.scene.records().len();
        for &index in &self.order {
            let slot = &self.slots[index];
            statistics.casters_in_range += slot.casting as u32;
            statistics.casters_out_of_range += (casters - slot.casting) as u32;
            for face in CubeFace::ALL {
                statistics.count(state(slot, &plans[index], face));
                if plans[index].drawn & face.bit() != 0 {
                    let way = slot.faces[face.layer() as usize].still.way();
                    statistics.faces_copied += u32::from(way != Way::Whole);
                    statistics.layers_drawn += u32::from(matches!(way, Way::Build(_)));
                }
            }
        }
        self.plans.clear();
        self.plans.extend_from_slice(plans);
        statistics
    }

    /// What became of one face of the light at place `light` of the last prepared frame; `None` if
    /// the frame had no such light.
    pub fn face_statistics(&self, light: usize, face: CubeFace) -> Option<FaceStatistics> {
        let &index = self.order.get(light)?;
        let slot = &self.slots[index];
        let of = &slot.faces[face.layer() as usize];
        Some(FaceStatistics {
            state: state(slot, self.plans.get(index)?, face),
            casters: of.content.casters,
            triangles: of.content.triangles,
            age: of.age,
        })
    }

    /// Gives back the texels that no light needs any more. The lights of an array share theirs.
    fn give_back(&mut self) {
        let no_light = self.order.is_empty();
        let idle = |slot: &Slot| no_light || slot.idle >= IDLE;
        for slot in &mut self.slots {
            slot.idle = match slot.casting {
                0 => slot.idle.saturating_add(1),
                _ => 0,
            };
        }
        let all = self.slots.iter().all(idle);
        for index in 0..self.slots.len() {
            let unused = all || !self.array && idle(&self.slots[index]);
            if unused && self.textures.free(index) {
                self.slots[index].forget_texels();
                self.free_layers(index);
            }
        }
    }

    /// Makes the texels that this frame's lights need.
    pub(super) fn allocate(&mut self, device: &wgpu::Device) {
        if self.allocation == Allocation::WithFirstCaster {
            self.give_back();
        }
        for &index in &self.order {
            if self.slots[index].casting > 0 || self.allocation == Allocation::AtOnce {
                for new in self.textures.allocate(device, index) {
                    self.slots[new].forget_texels();
                }
            }
        }
    }
}

fn state(slot: &Slot, plan: &SlotPlan, face: CubeFace) -> FaceState {
    let has = |mask: u8| mask & face.bit() != 0;
    if has(plan.drawn) {
        FaceState::Rendered
    } else if has(plan.wanted) {
        FaceState::Postponed
    } else if has(plan.hidden) {
        FaceState::Hidden
    } else if has(slot.empty()) {
        FaceState::Empty
    } else {
        FaceState::Kept
    }
}
