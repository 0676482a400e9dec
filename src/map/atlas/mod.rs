//! One texture for the shadows of all lights.

mod debug;
mod descriptor;
mod lights;
mod records;
mod statistics;
mod suns;

use glam::Mat4;

use super::gpu::{AtlasGpu, AtlasKind, Draw, DrawByHost, HostDraw, Resized, Tiled, TooLarge};
use super::plan::{
    Place, Residents, Rules, Slot, SlotPlan, Slots, Tally, Tile, casters_drawn, choose_tiles,
    follow, longest_wait,
};
use super::projection::FlatFrame;
use super::statistics::{TileState, TileStatistics};
use super::{Cascades, DepthBounds, MapSettings, StaticLayers};
use crate::clock::Clock;
use crate::error::ShadowAtlasError;
use crate::scene::Casters;
use crate::submissions::Submissions;
use crate::{Bias, Radius, SpotLight};
pub use debug::{AtlasDebug, AtlasDebugDescriptor};
use descriptor::LEAST_TILE;
pub use descriptor::{AtlasFrame, AtlasLight, AtlasView, LocalLight, ShadowAtlasDescriptor};
use lights::{Entry, entries};
use records::Told;
pub use statistics::AtlasStatistics;
use suns::Suns;

/// The shadow maps of all lights of a scene, of any kinds and sizes, as tiles of one texture. There is one
/// light buffer, and one bind group that needs to be recreated only when the texture or the buffer grows.
///
/// A point light has six tiles, the faces of a cube; a spot has one; a directional light has one for each
/// cascade and view. Each tile holds the same as a [`CubeShadowMap`](crate::CubeShadowMap) or
/// [`ShadowMap`](crate::ShadowMap) of that size would for the same light, texel for texel; depths of steep
/// triangles may differ by the rasteriser's rounding, which depends on the tile's place in the layer (by at
/// most 2^-14 of the depth in our measurements).
///
/// Receivers also see the same as with such a map. The one exception is
/// [`Kernel::HardwareBilinear`](crate::Kernel), which clamps at a tile's edge: this affects half a texel along
/// the seams of a point light's faces and along the border of a spot.
///
/// # What is redrawn
///
/// A tile is left alone as long as its light, casters, transforms and mesh revisions are those it was drawn
/// with, as in a [`CubeShadowMap`](crate::CubeShadowMap). A static scene costs one comparison of 80 bytes per
/// caster and no GPU work.
///
/// # Space
///
/// Each light specifies the size of its tiles, or a range of sizes within which its importance on screen
/// decides ([`TileSize`](crate::TileSize)). Lights without casters have no tiles. When
/// [`memory`](ShadowAtlasDescriptor::memory) runs short, the tiles of the least important lights are halved,
/// and [`AtlasStatistics::lights_reduced`] counts those lights; no light is left out. A tile whose size or
/// place has changed is drawn at once, regardless of the budget.
#[derive(Debug)]
pub struct ShadowAtlas {
    layer_size: u32,
    bias: Bias,
    format: wgpu::TextureFormat,
    pub(crate) reach: Radius,
    budget: Option<u32>,
    static_layers: StaticLayers,
    adapter: wgpu::AdapterInfo,
    casters: Casters,
    slots: Slots,
    suns: Suns,
    residents: Residents,
    plans: Vec<SlotPlan>,
    /// Lights and views of the last frame, and for each light its first slot's place among all and how
    /// many it has.
    lights: usize,
    views: usize,
    of_light: Vec<(usize, usize)>,
    /// For each slot its light and view in the last frame.
    names: Vec<(usize, usize)>,
    /// For each of those lights and views what receivers were told last.
    told: Vec<Option<Told>>,
    /// For each of them the last spot, and where its map lies.
    spots: Vec<Option<(SpotLight, FlatFrame)>>,
    gpu: AtlasGpu,
    submissions: Submissions,
    /// Whether an encoder was dropped since a frame was last prepared.
    encoder_dropped: bool,
    statistics: AtlasStatistics,
}

/// One tile: its place in the texture and its projection.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AtlasTile {
    /// The layer of the texture.
    pub layer: u32,
    /// Of the corner nearest to texel (0, 0), in texels.
    pub x: u32,
    /// See `x`.
    pub y: u32,
    /// Texels along a side.
    pub size: u32,
    /// World space to clip space. It maps to a left-handed space: triangles that are counter-clockwise seen
    /// from the light are clockwise on the tile.
    pub clip_from_world: Mat4,
    /// Its state after the last `prepare`.
    pub statistics: TileStatistics,
}

impl ShadowAtlas {
    /// Creates an atlas. It allocates no texture until a light has casters.
    ///
    /// # Errors
    /// [`ShadowAtlasError`] if a parameter is out of range.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ShadowAtlasDescriptor<'_>,
    ) -> Result<Self, ShadowAtlasError> {
        descriptor.validate(device)?;
        let layer_size = descriptor.layer_size;
        let MapSettings {
            format,
            bias,
            sides,
            reach,
        } = descriptor.settings;
        let label = match descriptor.label {
            Some(label) => format!("shadows atlas {label}"),
            None => "shadows atlas".to_owned(),
        };
        let gpu = AtlasGpu::new(
            device,
            AtlasKind {
                label,
                layer_size,
                format,
                slope_scale: bias.slope_scale,
                sides,
            },
        );
        Ok(Self {
            layer_size,
            bias,
            format,
            reach,
            budget: descriptor.max_tiles_per_frame,
            static_layers: descriptor.static_layers,
            adapter: device.adapter_info(),
            casters: Casters::default(),
            slots: Slots::new(0, true),
            suns: Suns::new(reach, gpu.unclipped_depth()),
            residents: Residents::new(layer_size, descriptor.most_layers(device), LEAST_TILE),
            plans: Vec::new(),
            lights: 0,
            views: 1,
            of_light: Vec::new(),
            names: Vec::new(),
            told: Vec::new(),
            spots: Vec::new(),
            gpu,
            submissions: Submissions::default(),
            encoder_dropped: false,
            statistics: AtlasStatistics::default(),
        })
    }

    /// Decides which casters belong to which tiles, how large the tiles are and which of them to draw, and
    /// stages the uploads.
    ///
    /// # Errors
    /// [`ShadowAtlasError`] if a light, a view or a caster is out of range, or if there are too many.
    /// Receivers then see what was last encoded. Work that an earlier `prepare` found but that was not
    /// encoded is dropped; the next frame finds it again.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        frame: &AtlasFrame<'_>,
    ) -> Result<(), ShadowAtlasError> {
        let clock = Clock::start();
        let entries = entries(frame);
        let (moved, not_encoded) = match self.plan_frame(device, queue, frame, &entries) {
            Ok(planned) => planned,
            Err(error) => {
                self.give_up();
                return Err(error);
            }
        };
        self.record_draws(device, frame);
        self.name_slots(frame, &entries);
        self.write_lights(&entries);
        let encoder_dropped = std::mem::take(&mut self.encoder_dropped);
        self.statistics = AtlasStatistics {
            lights_moved: moved as u32,
            not_encoded,
            encoder_dropped,
            ..self.count()
        };
        self.statistics.prepare = clock.elapsed();
        Ok(())
    }

    /// All of a frame that may be refused: what is drawn, and room for it. Tells how many lights' tiles were
    /// elsewhere before, and whether an earlier frame's work was not encoded.
    fn plan_frame(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        frame: &AtlasFrame<'_>,
        entries: &[Entry<'_>],
    ) -> Result<(usize, bool), ShadowAtlasError> {
        frame.validate(self.layer_size)?;
        let records = self.count_records(frame)?;
        self.check_matrices(device, entries)?;
        self.casters.compare(frame.casters, device)?;
        self.casters.update(frame.casters);
        self.suns.casters_changed(&self.casters);
        if self.submissions.take_dropped() {
            self.encoder_dropped = true;
            self.invalidate();
        }
        let moved = self.take_over(frame, entries)?;
        let layers = self.residents.layers();
        let resized = self.gpu.resize(device, queue, layers, records);
        if resized == Resized::Lost {
            self.slots.iter_mut().for_each(Slot::forget_texels);
        }
        let plans = self.plan(frame, entries, &moved, resized);
        self.reserve(device, &plans)?;
        let not_encoded = self.is_pending();
        if not_encoded {
            self.gpu.forget_uploads();
        }
        follow(&plans, &mut self.slots);
        self.plans = plans;
        Ok((moved.len(), not_encoded))
    }

    /// Nothing is left to encode, after a frame was refused: slots may have gone on to its lights.
    fn give_up(&mut self) {
        // Nor is it known what changed among the casters.
        self.slots.miss_update();
        self.slots.iter_mut().for_each(|slot| slot.pending = 0);
        self.gpu.forget_uploads();
        self.of_light.clear();
    }

    /// Notes which slots are whose, for those who ask by light and view.
    fn name_slots(&mut self, frame: &AtlasFrame<'_>, entries: &[Entry<'_>]) {
        self.lights = frame.lights.len();
        self.views = frame.views.len().max(1);
        self.of_light.clear();
        for run in entries.chunk_by(|a, b| a.index == b.index) {
            let (first, count) = self.of_light.last().copied().unwrap_or_default();
            self.of_light.push((first + count, run.len()));
        }
        self.names.clear();
        self.names.resize(self.slots.len(), (0, 0));
        for (place, entry) in entries.iter().enumerate() {
            if let Some(slot) = self.slots.of_light(place) {
                self.names[slot] = (entry.index, entry.view.map_or(0, |(view, _)| view));
            }
        }
    }

    /// Records the work that the last [`prepare`](Self::prepare) found necessary: render passes, and the
    /// lights' data for receivers. Does so once: a second call before the next `prepare` records nothing.
    ///
    /// Call it after every `prepare`, whatever the result. Until then, receivers see the previous texels and
    /// lights; an atlas that has never been drawn makes all lights appear dark. The recorded work must be
    /// submitted: if the encoder is dropped, the next `prepare` redraws everything
    /// ([`AtlasStatistics::encoder_dropped`]).
    ///
    /// Casters that only the host can draw ([`CasterMesh::host_drawn`](crate::CasterMesh::host_drawn)) are
    /// not drawn by this call. Tiles that lack them are counted ([`AtlasStatistics::tiles_incomplete`]) and
    /// redrawn in the next frame. Hosts with such casters call [`encode_with`](Self::encode_with) instead.
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.encode_tiles(encoder, None);
    }

    /// Like [`encode`](Self::encode), but also lets the host draw what only it can: `draw` is called within
    /// the pass of each tile that such casters touch, after everything else on that tile, either once per
    /// tile, or once for its static casters and once for the others ([`StaticLayers`](crate::StaticLayers)).
    ///
    /// Viewport and scissor are set, and must stay. The pass has no colour target, one sample and a depth
    /// target of the atlas's [`format`](MapSettings::format); compare with `Greater`, write
    /// depth, and let vertices be at [`clip_from_world`](HostDraw::clip_from_world) times their position,
    /// with `unclipped_depth` where the device has
    /// [`DEPTH_CLIP_CONTROL`](wgpu::Features::DEPTH_CLIP_CONTROL), so that what is nearer than the near
    /// plane casts. On wgpu's GL back end, let the fragment shader of lights with a position write
    /// clip z times its position's w as `frag_depth`: the rasteriser's own depth has too few digits there
    /// (see [`Support`](crate::Support)).
    pub fn encode_with(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        mut draw: impl FnMut(&mut wgpu::RenderPass<'_>, &HostDraw<'_>),
    ) {
        self.encode_tiles(encoder, Some(&mut draw));
    }

    fn encode_tiles(&mut self, encoder: &mut wgpu::CommandEncoder, draw: Option<DrawByHost<'_>>) {
        let mut recorded = self.gpu.upload(encoder);
        let host_draws = draw.is_some();
        let tiles = Tiled {
            slots: &self.slots,
            residents: &self.residents,
            names: &self.names,
        };
        self.gpu.encode(encoder, &tiles, draw);
        for (index, slot) in self.slots.iter_mut().enumerate() {
            recorded |= slot.pending != 0;
            let missing = match host_draws {
                true => Vec::new(),
                false => self.gpu.incomplete((index, slot)),
            };
            slot.encoded(slot.pending);
            self.statistics.tiles_incomplete += missing.len() as u32;
            missing.into_iter().for_each(|tile| slot.spoil(tile));
        }
        if recorded {
            self.submissions.watch(encoder);
        }
    }

    /// Marks every tile as outdated: the next [`prepare`](Self::prepare) redraws all tiles that a view shows,
    /// regardless of the budget. The result of the last one is discarded.
    ///
    /// For a host that has written to the texture, or has lost recorded work in a way that the atlas cannot
    /// detect: an encoder that is kept but never submitted, or a submission that failed.
    pub fn invalidate(&mut self) {
        self.slots.iter_mut().for_each(Slot::doubt_texels);
        self.gpu.doubt();
    }

    /// The index that shaders use for a light of the last [`prepare`](Self::prepare) in one of its views:
    /// `view * lights + light`. Only directional lights differ between views. With one view, or none, it is
    /// the light's index in the frame.
    pub fn light_index(&self, light: usize, view: usize) -> u32 {
        (view * self.lights + light) as u32
    }

    /// The tiles of a light: the faces of a point light in the order of
    /// [`CubeFace::ALL`](crate::CubeFace::ALL), or the cascades of a directional light from the nearest on,
    /// without those that have no casters. Empty if nothing casts.
    pub fn tiles(&self, light: usize, view: usize) -> Vec<AtlasTile> {
        let Some(index) = self.slot_of(light, view) else {
            return Vec::new();
        };
        let (slot, places) = (&self.slots[index], self.residents.places(index));
        let tiles = places.iter().zip(&slot.tiles).enumerate();
        let tile = |(number, (place, tile)): (usize, (&Place, &Tile))| {
            let projection = tile.shown.or_else(|| slot.projection(number))?;
            let from_light = projection.clip_from_light(number, self.gpu.near_plane());
            let plan = self.plans.get(index);
            Some(AtlasTile {
                layer: place.layer,
                x: place.x,
                y: place.y,
                size: place.size,
                clip_from_world: from_light * Mat4::from_translation(-projection.origin()),
                statistics: TileStatistics {
                    state: plan.map_or(TileState::Empty, |plan| plan.state(slot, number)),
                    casters: tile.content.casters,
                    triangles: tile.content.triangles,
                    age: tile.age,
                },
            })
        };
        tiles.filter_map(tile).collect()
    }

    /// The texture of all tiles, of [`MapSettings::format`]; one texel while no light casts.
    pub fn texture(&self) -> &wgpu::Texture {
        self.gpu.texture().texture()
    }

    /// All layers as a 2D array, for hosts that sample them themselves.
    pub fn view(&self) -> &wgpu::TextureView {
        self.gpu.texture().view()
    }

    /// Changes when bind groups of this atlas must be recreated: when its texture or its light buffer has
    /// grown or been released. Compare it after each [`prepare`](Self::prepare), before using bind groups.
    /// With an outdated bind group all lights appear dark, so that the mistake is noticed.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.gpu.lights().revision()
    }

    /// The maximum number of frames that a changed tile waits to be drawn while a view shows it: the number
    /// of tiles in the last frame divided by half of `max_tiles_per_frame`, both rounded up; `None` without a
    /// budget.
    ///
    /// Half the budget goes to the tiles that have waited longest, the rest to the most important ones: those with the
    /// most change (the share of the tile covered by what changed), of lights that are nearest to the eye and whose
    /// range is largest on screen. The tiles of a light that has moved are drawn together; until then it is seen at its
    /// old place with its old shadows. A new light is dark until then. Pinned lights, tiles whose size or place
    /// changed, the first cascades of a directional light, and outdated tiles that become visible are drawn at once,
    /// outside the budget.
    pub fn max_age(&self) -> Option<u32> {
        let tiles = self.slots.iter().map(|slot| slot.tiles.len()).sum();
        Some(longest_wait(tiles, self.budget?))
    }

    /// Statistics of the last [`prepare`](Self::prepare).
    pub fn statistics(&self) -> AtlasStatistics {
        self.statistics
    }

    pub(crate) fn light_buffer(&self) -> &wgpu::Buffer {
        self.gpu.lights().buffer()
    }

    /// Chooses the tiles to draw. Changes nothing.
    fn plan(
        &self,
        frame: &AtlasFrame<'_>,
        entries: &[Entry<'_>],
        moved: &[usize],
        resized: Resized,
    ) -> Vec<SlotPlan> {
        let views: Vec<_> = frame.views.iter().map(|view| view.view).collect();
        let mut pinned: Vec<bool> = entries.iter().map(|of| of.light.is_pinned()).collect();
        for (place, pinned) in pinned.iter_mut().enumerate() {
            let slot = self.slots.of_light(place);
            // In the order of the slots.
            *pinned |= slot.is_some_and(|slot| moved.binary_search(&slot).is_ok());
        }
        let rules = Rules {
            views: &views,
            reach: self.reach,
            cache: true,
            budget: self.budget.filter(|_| resized != Resized::Lost),
            pinned: &pinned,
        };
        choose_tiles(&self.slots, &rules, |slot| self.residents.size(slot))
    }

    /// Makes room for instances and matrices.
    fn reserve(
        &mut self,
        device: &wgpu::Device,
        plans: &[SlotPlan],
    ) -> Result<(), ShadowAtlasError> {
        let instances = casters_drawn(plans, &self.slots);
        let reserved = self.gpu.reserve(device, instances, self.slots.len());
        reserved.map_err(
            |TooLarge { size, limit }| ShadowAtlasError::TooManyCasters {
                instances,
                size,
                limit,
            },
        )
    }

    /// Lists what the pending tiles show, and stages what drawing that needs.
    fn record_draws(&mut self, device: &wgpu::Device, frame: &AtlasFrame<'_>) {
        let least = |size: u32| self.static_layers.least_triangles(size, &self.adapter);
        self.gpu.clear_draws();
        for (index, slot) in self.slots.iter_mut().enumerate() {
            if slot.pending != 0 {
                let places = self.residents.places(index);
                self.gpu
                    .add_tiles(device, (index, slot), places, &least, &self.casters);
            }
        }
        self.gpu.finish_draws(device, frame.casters);
    }

    /// Whether an `encode` would record anything.
    fn is_pending(&self) -> bool {
        self.gpu.uploaded() > 0 || self.slots.iter().any(|slot| slot.pending != 0)
    }

    /// The slot of a light of the last frame for a view.
    fn slot_of(&self, light: usize, view: usize) -> Option<usize> {
        let &(first, count) = self.of_light.get(light)?;
        let place = match count {
            1 => first,
            _ => first + view,
        };
        self.slots.of_light(place).filter(|_| view < self.views)
    }

    fn count(&self) -> AtlasStatistics {
        let draws = self.gpu.draws();
        let tally = Tally::new(&self.plans, &self.slots, self.casters.records().len());
        AtlasStatistics {
            lights_reduced: self.residents.reduced(),
            draws: draws.iter().count() as u32,
            triangles: draws.iter().map(Draw::triangles).sum(),
            layers: self.gpu.texture().layers(),
            texels: self.residents.texels(),
            bytes: self.gpu.bytes(),
            uploaded: self.gpu.uploaded(),
            ..AtlasStatistics::of(&tally)
        }
    }
}
