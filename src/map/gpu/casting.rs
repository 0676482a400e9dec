//! What draws casters into tiles, whichever map they are of.

use glam::Mat4;

use super::draws::{Draw, DrawLists, ListedDraws};
use super::dynamic_uniforms::DynamicUniforms;
use super::host_draw::{DrawByHost, HostDraw};
use super::instances::{Instances, TooLarge};
use super::pipelines::{PipelineKind, Pipelines};
use super::tile_uniform::TileUniform;
use crate::map::plan::Slot;
use crate::map::projection::NearPlane;
use crate::map::sides::CasterSides;
use crate::mesh::Caster;
use crate::scene::Casters;
use crate::uploads::Uploads;

/// Pipelines, matrices and instances, the draws of a frame, and the uploads that the next encode records.
#[derive(Debug)]
pub(crate) struct Casting {
    sides: CasterSides,
    near_plane: NearPlane,
    unclipped_depth: bool,
    /// The most that a slot has.
    tiles_a_slot: usize,
    pipelines: Pipelines,
    uniforms: DynamicUniforms<TileUniform>,
    instances: Instances,
    draws: DrawLists,
    uploads: Uploads,
}

impl Casting {
    /// For so many slots, each of at most so many tiles.
    pub fn new(
        device: &wgpu::Device,
        label: &str,
        kind: PipelineKind,
        sides: CasterSides,
        (slots, tiles_a_slot): (usize, usize),
    ) -> Self {
        let uniforms = DynamicUniforms::new(device, format!("{label} faces"), slots * tiles_a_slot);
        Self {
            sides,
            near_plane: NearPlane::new(kind.format, kind.encoding),
            unclipped_depth: kind.unclipped_depth,
            tiles_a_slot,
            pipelines: Pipelines::new(device, label, uniforms.layout(), kind),
            uniforms,
            instances: Instances::new(device, label),
            draws: DrawLists::default(),
            uploads: Uploads::new(device),
        }
    }

    pub fn near_plane(&self) -> NearPlane {
        self.near_plane
    }

    /// Whether casters before the near plane are pulled onto it.
    pub fn unclipped_depth(&self) -> bool {
        self.unclipped_depth
    }

    pub fn draws(&self) -> &DrawLists {
        &self.draws
    }

    pub fn uploads(&mut self) -> &mut Uploads {
        &mut self.uploads
    }

    /// Bytes that the next encode copies.
    pub fn uploaded(&self) -> u64 {
        self.uploads.bytes()
    }

    /// Bytes held.
    pub fn bytes(&self) -> u64 {
        self.instances.bytes() + self.uniforms.bytes()
    }

    /// Checks that one buffer of the device holds the matrices of so many slots.
    pub fn check_slots(&self, device: &wgpu::Device, slots: usize) -> Result<(), TooLarge> {
        let size = DynamicUniforms::<TileUniform>::size(slots.saturating_mul(self.tiles_a_slot));
        let limit = DynamicUniforms::<TileUniform>::most(device);
        match size > limit {
            true => Err(TooLarge { size, limit }),
            false => Ok(()),
        }
    }

    /// Makes room for so many instances, and for the matrices of so many slots, which were
    /// [checked](Self::check_slots).
    pub fn reserve(
        &mut self,
        device: &wgpu::Device,
        instances: usize,
        slots: usize,
    ) -> Result<(), TooLarge> {
        self.uniforms.reserve(device, slots * self.tiles_a_slot);
        self.instances.reserve(device, instances)
    }

    pub fn clear(&mut self) {
        self.draws.clear();
    }

    /// Lists what some tiles of a slot show, each of `size` texels along a side.
    pub fn add(&mut self, (index, slot): (usize, &Slot), drawn: u8, size: u32, casters: &Casters) {
        let near_plane = self.near_plane;
        self.draws
            .add((index, slot), drawn, near_plane, self.sides, casters);
        for tile in (0..slot.tiles.len()).filter(|tile| drawn & 1 << tile != 0) {
            if let Some(projection) = slot.projection(tile) {
                let matrix = projection.clip_from_light(tile, near_plane);
                let uniform = TileUniform::new(&matrix, projection.range(), size);
                let at = index * self.tiles_a_slot + tile;
                self.uniforms.write(&mut self.uploads, at, uniform);
            }
        }
    }

    /// Stages what the listed draws of some of all casters need, after [`reserve`](Self::reserve) for as
    /// many instances.
    pub fn finish(&mut self, device: &wgpu::Device, all: &[Caster]) {
        self.pipelines
            .make(device, self.draws.iter().map(Draw::key));
        let (count, instances) = (self.draws.instance_count(), self.draws.instances(all));
        self.instances.write(&mut self.uploads, count, instances);
    }

    /// Forgets what was to be written, and what has been.
    pub fn forget_uploads(&mut self) {
        self.uploads.clear();
        self.uniforms.forget();
    }

    /// The pending tiles of a slot that lack what only the host can draw, if it is not asked.
    pub fn incomplete(&self, (index, slot): (usize, &Slot)) -> Vec<usize> {
        let missing = |tile: &usize| {
            let draws = self.draws.of(index, *tile);
            slot.pending & 1 << tile != 0
                && !(draws.tile.host.is_empty() && draws.layer.host.is_empty())
        };
        (0..slot.tiles.len()).filter(missing).collect()
    }

    /// Draws on a tile what is listed for it, and asks the host for what only it can draw.
    pub fn record(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        of: &DrawnTile<'_>,
        listed: &ListedDraws,
        by_host: &mut Option<DrawByHost<'_>>,
    ) {
        self.uniforms
            .bind(pass, of.index * self.tiles_a_slot + of.tile);
        for draw in &listed.draws {
            draw.record(pass, &self.pipelines, &self.instances);
        }
        if let (Some(draw), Some(projection)) = (by_host, of.slot.projection(of.tile))
            && !listed.host.is_empty()
        {
            let from_light = projection.clip_from_light(of.tile, self.near_plane);
            let asked = HostDraw {
                light: of.name.0,
                view: of.name.1,
                tile: of.tile,
                clip_from_world: from_light * Mat4::from_translation(-projection.origin()),
                size: of.size,
                casters: &listed.host,
            };
            draw(pass, &asked);
        }
    }
}

/// A tile that is drawn on.
pub(crate) struct DrawnTile<'a> {
    pub slot: &'a Slot,
    /// The slot's place.
    pub index: usize,
    pub tile: usize,
    /// Light and view by which the host knows it.
    pub name: (usize, usize),
    /// Texels along its side.
    pub size: u32,
}
