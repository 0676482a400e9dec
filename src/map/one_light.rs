//! What the maps of one light share: its casters, its tiles, and what became of them.

use super::gpu::{Draw, DrawByHost, OneLightGpu, OneLightKind, TooLarge};
use super::plan::{Rules, Slot, SlotPlan, Slots, Tally, casters_drawn, choose_tiles, follow};
use super::projection::LightProjection;
use super::statistics::TileStatistics;
use crate::clock::Clock;
use crate::error::CasterError;
use crate::mesh::Caster;
use crate::scene::Casters;
use crate::submissions::Submissions;
use crate::{Radius, View};

/// What is kept of one map between frames.
#[derive(Debug)]
pub(super) struct OneLightMap {
    pub reach: Radius,
    cache: bool,
    /// The fewest triangles that are worth a static layer.
    layer_least: Option<u64>,
    casters: Casters,
    /// One.
    slots: Slots,
    plans: Vec<SlotPlan>,
    pub gpu: OneLightGpu,
    submissions: Submissions,
    /// Whether an encoder was dropped since a frame was last prepared.
    encoder_dropped: bool,
    not_encoded: bool,
    incomplete: u32,
}

/// How such a map is made.
pub(super) struct OneLightSettings {
    pub kind: OneLightKind,
    pub reach: Radius,
    pub cache: bool,
    /// Whether casters go only on the tiles they touch.
    pub cull: bool,
    pub layer_least: Option<u64>,
}

/// A frame's casters do not fit a buffer.
pub(super) struct TooMany {
    /// Casters, each counted once for every tile it touches.
    pub instances: usize,
    pub size: u64,
    pub limit: u64,
}

/// What a frame took, whatever its map calls its tiles.
pub(super) struct Taken {
    pub tally: Tally,
    pub draws: u32,
    pub triangles: u64,
    pub bytes: u64,
    pub uploaded: u64,
    pub not_encoded: bool,
    pub encoder_dropped: bool,
    pub prepare: std::time::Duration,
}

impl OneLightMap {
    pub fn new(device: &wgpu::Device, settings: OneLightSettings) -> Self {
        Self {
            reach: settings.reach,
            cache: settings.cache,
            layer_least: settings.layer_least.filter(|_| settings.cache),
            casters: Casters::default(),
            slots: Slots::new(1, settings.cull),
            plans: vec![SlotPlan::default()],
            gpu: OneLightGpu::new(device, settings.kind),
            submissions: Submissions::default(),
            encoder_dropped: false,
            not_encoded: false,
            incomplete: 0,
        }
    }

    /// The light's tiles.
    pub fn slot(&self) -> &Slot {
        &self.slots[0]
    }

    pub fn casters(&self) -> &Casters {
        &self.casters
    }

    /// Tiles that lacked what only the host can draw.
    pub fn incomplete(&self) -> u32 {
        self.incomplete
    }

    /// Takes over a frame's casters. [`prepare`](Self::prepare) follows, or [`refuse`](Self::refuse).
    pub fn take_casters(
        &mut self,
        device: &wgpu::Device,
        casters: &[Caster],
    ) -> Result<(), CasterError> {
        self.casters.compare(casters, device)?;
        self.casters.update(casters);
        Ok(())
    }

    /// Learns that a frame was refused whose casters were taken over.
    pub fn refuse(&mut self) {
        self.slots.miss_update();
    }

    /// Decides which tiles are drawn and stages what that needs.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        light: LightProjection,
        views: &[&View],
        casters: &[Caster],
    ) -> Result<(), TooMany> {
        self.slots.take_over(&[light.into()], &mut self.casters);
        if self.submissions.take_dropped() {
            self.encoder_dropped = true;
            self.invalidate();
        }
        let rules = Rules {
            views,
            reach: self.reach,
            cache: self.cache,
            budget: None,
            pinned: &[],
        };
        let size = self.gpu.size();
        let plans = choose_tiles(&self.slots, &rules, |_| Some(size));
        let instances = casters_drawn(&plans, &self.slots);
        let reserved = self.gpu.reserve(device, instances);
        reserved.map_err(|TooLarge { size, limit }| TooMany {
            instances,
            size,
            limit,
        })?;
        self.not_encoded = self.slots[0].pending != 0 || self.gpu.uploaded() > 0;
        if self.not_encoded {
            self.gpu.forget_uploads();
        }
        follow(&plans, &mut self.slots);
        self.plans = plans;
        self.incomplete = 0;
        let casters = (&self.casters, casters);
        self.gpu
            .list(device, &mut self.slots[0], self.layer_least, casters);
        Ok(())
    }

    /// Records what was found necessary, once.
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder, by_host: Option<DrawByHost<'_>>) {
        let slot = &mut self.slots[0];
        let recorded = self.gpu.upload(encoder) | (slot.pending != 0);
        let missing = match by_host {
            Some(_) => Vec::new(),
            None => self.gpu.incomplete(slot),
        };
        self.gpu.encode(encoder, slot, by_host);
        slot.encoded(slot.pending);
        self.incomplete += missing.len() as u32;
        missing.into_iter().for_each(|tile| slot.spoil(tile));
        if recorded {
            self.submissions.watch(encoder);
        }
    }

    /// Takes nothing for drawn.
    pub fn invalidate(&mut self) {
        self.slots[0].doubt_texels();
        self.gpu.forget_uploads();
    }

    /// What the last frame took, as [`prepare`](Self::prepare) ends.
    pub fn taken(&mut self, clock: &Clock) -> Taken {
        let draws = self.gpu.draws();
        Taken {
            tally: Tally::new(&self.plans, &self.slots, self.casters.records().len()),
            draws: draws.iter().count() as u32,
            triangles: draws.iter().map(Draw::triangles).sum(),
            bytes: self.gpu.bytes(),
            uploaded: self.gpu.uploaded(),
            not_encoded: self.not_encoded,
            encoder_dropped: std::mem::take(&mut self.encoder_dropped),
            prepare: clock.elapsed(),
        }
    }

    /// What became of a tile of the last frame.
    pub fn tile(&self, tile: usize) -> Option<TileStatistics> {
        let slot = self.slot();
        let of = slot.tiles.get(tile)?;
        Some(TileStatistics {
            state: self.plans[0].state(slot, tile),
            casters: of.content.casters,
            triangles: of.content.triangles,
            age: of.age,
        })
    }
}
