//! What a frame draws: for each slot a mask of tiles, and what becomes of the others.

use super::schedule::{Job, choose, jobs_of};
use super::slot::Slot;
use super::slots::Slots;
use super::static_layer::DrawMode;
use super::visibility::visible_tiles;
use crate::map::statistics::TileState;
use crate::scene::Frustum;
use crate::{Radius, View};

/// One slot's part of a plan.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SlotPlan {
    /// Tiles whose texels are out of date and can be seen.
    pub wanted: u8,
    /// Out of date, not seen.
    pub hidden: u8,
    /// Those of `wanted` that are drawn.
    pub drawn: u8,
}

impl SlotPlan {
    /// What becomes of a tile.
    pub fn state(&self, slot: &Slot, tile: usize) -> TileState {
        self.state_where(slot.empty(), tile)
    }

    /// The same, given the empty tiles.
    fn state_where(&self, empty: u8, tile: usize) -> TileState {
        let has = |mask: u8| mask & 1 << tile != 0;
        if has(self.drawn) {
            TileState::Rendered
        } else if has(self.wanted) {
            TileState::Postponed
        } else if has(self.hidden) {
            TileState::Hidden
        } else if has(empty) {
            TileState::Empty
        } else {
            TileState::Kept
        }
    }
}

/// What the choice of tiles goes by.
pub(crate) struct Rules<'a> {
    /// What the frame is seen from; none: from anywhere.
    pub views: &'a [&'a View],
    pub reach: Radius,
    /// Whether tiles that have not changed are left alone.
    pub cache: bool,
    /// The most tiles drawn.
    pub budget: Option<u32>,
    /// For the place of each light whether no budget holds it back; the rest are held back.
    pub pinned: &'a [bool],
}

/// Chooses the tiles to draw, of the slots that have texels: `size` says how many along a tile.
pub(crate) fn choose_tiles(
    slots: &Slots,
    rules: &Rules<'_>,
    size: impl Fn(usize) -> Option<u32>,
) -> Vec<SlotPlan> {
    let frusta: Vec<_> = rules.views.iter().map(|view| Frustum::new(view)).collect();
    let mut plans = vec![SlotPlan::default(); slots.len()];
    let mut jobs: Vec<Job> = Vec::new();
    for (place, &index) in slots.order().iter().enumerate() {
        let slot = &slots[index];
        let (Some(light), Some(size)) = (slot.light(), size(index)) else {
            continue;
        };
        let again = if rules.cache { 0 } else { !slot.empty() };
        let stale = slot.stale() | again & light.all();
        if stale == 0 {
            continue;
        }
        let visible = visible_tiles(&frusta, light, rules.reach, size);
        let plan = &mut plans[index];
        plan.wanted = stale & visible;
        plan.hidden = stale & !visible;
        let free = rules.budget.is_none() || rules.pinned.get(place) == Some(&true);
        let weight = match light.sphere() {
            Some((centre, range)) if !frusta.is_empty() => frusta
                .iter()
                .map(|frustum| frustum.weight(centre, range))
                .fold(0.0, f64::max),
            _ => 1.0,
        };
        let (must, choice) = jobs_of(index, slot, plan.wanted, free, weight);
        plan.drawn = must;
        jobs.extend(choice);
    }
    if let Some(budget) = rules.budget {
        for job in choose(jobs, budget) {
            plans[job.slot].drawn |= job.tiles;
        }
    }
    plans
}

/// Takes a plan over into the slots.
pub(crate) fn follow(plans: &[SlotPlan], slots: &mut Slots) {
    for (slot, plan) in slots.iter_mut().zip(plans) {
        slot.schedule(plan.wanted, plan.drawn);
        if plan.wanted | plan.hidden == 0 {
            slot.settle();
        }
    }
}

/// Casters on the tiles that are drawn, each counted once for every tile.
pub(crate) fn casters_drawn(plans: &[SlotPlan], slots: &Slots) -> usize {
    let pending = slots.iter().zip(plans).filter(|(_, plan)| plan.drawn != 0);
    let tiles = pending.flat_map(|(slot, plan)| {
        let drawn = |(bit, _): &(usize, _)| plan.drawn & 1 << bit != 0;
        slot.tiles.iter().enumerate().filter(drawn)
    });
    tiles.map(|(_, tile)| tile.content.casters as usize).sum()
}

/// What a plan does with the tiles of a frame's lights.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    pub rendered: u32,
    pub kept: u32,
    pub empty: u32,
    pub hidden: u32,
    pub postponed: u32,
    /// Those of `rendered` whose static casters are copied from a layer.
    pub copied: u32,
    /// Layers of static casters that are drawn.
    pub layers_drawn: u32,
    /// Casters that touch a tile, counted once for each light, and those that do not.
    pub casting: u32,
    pub not_casting: u32,
}

impl Tally {
    /// Of a frame with so many casters.
    pub fn new(plans: &[SlotPlan], slots: &Slots, casters: usize) -> Self {
        let mut tally = Self::default();
        for &index in slots.order() {
            let (slot, plan) = (&slots[index], &plans[index]);
            tally.casting += slot.casting as u32;
            tally.not_casting += (casters - slot.casting) as u32;
            let empty = slot.empty();
            for bit in 0..slot.tiles.len() {
                let state = plan.state_where(empty, bit);
                tally.count(state);
                if state == TileState::Rendered {
                    let mode = slot.tiles[bit].layer.mode();
                    tally.copied += u32::from(mode != DrawMode::Whole);
                    tally.layers_drawn += u32::from(matches!(mode, DrawMode::Build(_)));
                }
            }
        }
        tally
    }

    fn count(&mut self, state: TileState) {
        *match state {
            TileState::Rendered => &mut self.rendered,
            TileState::Kept => &mut self.kept,
            TileState::Empty => &mut self.empty,
            TileState::Hidden => &mut self.hidden,
            TileState::Postponed => &mut self.postponed,
        } += 1;
    }
}
