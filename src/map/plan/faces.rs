//! What a frame draws: for each slot a mask of faces, and what becomes of the others.

use super::schedule::{Job, choose, jobs_of};
use super::slot::Slot;
use super::slots::Slots;
use super::static_layer::DrawMode;
use super::visibility::visible_faces;
use crate::map::projection::{ALL_FACES, CubeFace};
use crate::map::statistics::{CubeStatistics, FaceState};
use crate::scene::Frustum;
use crate::{Radius, View};

/// One slot's part of a plan.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SlotPlan {
    /// Faces whose texels are out of date and can be seen.
    pub wanted: u8,
    /// Out of date, not seen.
    pub hidden: u8,
    /// Those of `wanted` that are drawn.
    pub drawn: u8,
}

impl SlotPlan {
    /// What becomes of a face.
    pub fn state(&self, slot: &Slot, face: CubeFace) -> FaceState {
        let has = |mask: u8| mask & face.bit() != 0;
        if has(self.drawn) {
            FaceState::Rendered
        } else if has(self.wanted) {
            FaceState::Postponed
        } else if has(self.hidden) {
            FaceState::Hidden
        } else if has(slot.empty()) {
            FaceState::Empty
        } else {
            FaceState::Kept
        }
    }
}

/// What the choice of faces goes by.
pub(crate) struct Rules<'a> {
    pub view: Option<&'a View>,
    pub reach: Radius,
    /// Texels along a face.
    pub size: u32,
    /// Whether faces that have not changed are left alone.
    pub cache: bool,
    /// The most faces drawn.
    pub budget: Option<u32>,
    /// Places of lights that no budget holds back.
    pub pinned: &'a [usize],
}

/// Chooses the faces to draw, of the slots that have texels.
pub(crate) fn choose_faces(
    slots: &Slots,
    rules: &Rules<'_>,
    has_texels: impl Fn(usize) -> bool,
) -> Vec<SlotPlan> {
    let frustum = rules.view.map(Frustum::new);
    let mut plans = vec![SlotPlan::default(); slots.len()];
    let mut jobs: Vec<Job> = Vec::new();
    for (place, &index) in slots.order().iter().enumerate() {
        let slot = &slots[index];
        let Some(light) = slot.light.filter(|_| has_texels(index)) else {
            continue;
        };
        let visible = match &frustum {
            Some(frustum) => visible_faces(frustum, &light, rules.reach, rules.size),
            None => ALL_FACES,
        };
        let again = if rules.cache { 0 } else { !slot.empty() };
        let stale = slot.stale() | again & ALL_FACES;
        let plan = &mut plans[index];
        plan.wanted = stale & visible;
        plan.hidden = stale & !visible;
        let free = rules.budget.is_none() || rules.pinned.contains(&place);
        let weight = frustum.as_ref().map_or(1.0, |frustum| {
            frustum.weight(light.position.as_dvec3(), f64::from(light.range))
        });
        let (must, choice) = jobs_of(index, slot, plan.wanted, free, weight);
        plan.drawn = must;
        jobs.extend(choice);
    }
    if let Some(budget) = rules.budget {
        for job in choose(jobs, budget) {
            plans[job.slot].drawn |= job.faces;
        }
    }
    plans
}

/// Takes a plan over into the slots.
pub(crate) fn follow(plans: &[SlotPlan], slots: &mut Slots) {
    for (slot, plan) in slots.iter_mut().zip(plans) {
        if plan.drawn == plan.wanted {
            slot.shown = slot.light;
        }
        slot.schedule(plan.drawn);
        slot.grow_older(plan.wanted & !plan.drawn);
    }
}

/// Casters on the faces that are drawn, each counted once for every face.
pub(crate) fn casters_drawn(plans: &[SlotPlan], slots: &Slots) -> usize {
    let faces = slots.iter().zip(plans).flat_map(|(slot, plan)| {
        let drawn = |(bit, _): &(usize, _)| plan.drawn & 1 << bit != 0;
        slot.faces.iter().enumerate().filter(drawn)
    });
    faces.map(|(_, face)| face.content.casters as usize).sum()
}

/// Counts what a plan does with every face of every light, of which each has so many casters.
pub(crate) fn tally(plans: &[SlotPlan], slots: &Slots, casters: usize) -> CubeStatistics {
    let mut statistics = CubeStatistics::default();
    for &index in slots.order() {
        let (slot, plan) = (&slots[index], &plans[index]);
        statistics.casters_in_range += slot.casting as u32;
        statistics.casters_out_of_range += (casters - slot.casting) as u32;
        for face in CubeFace::ALL {
            statistics.count(plan.state(slot, face));
            if plan.drawn & face.bit() != 0 {
                let mode = slot.faces[face.layer() as usize].layer.mode();
                statistics.faces_copied += u32::from(mode != DrawMode::Whole);
                statistics.layers_drawn += u32::from(matches!(mode, DrawMode::Build(_)));
            }
        }
    }
    statistics
}
