//! Omnidirectional shadow maps.

use glam::Mat4;

use super::cube_descriptor::{Allocation, CubeFrame, CubeShadowMapDescriptor};
use super::encoding::DepthEncoding;
use super::gpu::{CubeGpu, Draw, TooLarge, most_tiles};
use super::plan::{
    Rules, Slot, SlotPlan, Slots, Tally, casters_drawn, choose_tiles, follow, longest_wait,
};
use super::projection::{CubeFace, LightProjection, SlotLight};
use super::statistics::{CubeStatistics, TileStatistics};
use crate::Radius;
use crate::clock::Clock;
use crate::error::CubeShadowMapError;
use crate::scene::Casters;
use crate::submissions::Submissions;

/// Omnidirectional depth maps for point lights: six faces each, drawn only where a caster is, and
/// only when it has changed.
///
/// By default `Depth32Float`, infinite reverse-Z: a texel holds `near / d`, where `d` is the
/// distance along the face's major axis, and 0 where no caster is. That is linear over a face for
/// any plane, which is what lets [`PcfSampler`](crate::PcfSampler) compare every tap with the
/// receiver's own plane. (Cube maps for point lights: Gerasimov, "Omnidirectional Shadow Mapping",
/// GPU Gems, 2004.)
///
/// # What is drawn again
///
/// A face is drawn again only if its light, its casters, their transforms or the revisions of their
/// meshes have changed since it was drawn. The map finds this by comparison, so there is no flag to
/// set. The one exception is a mesh that the host deforms in its own buffer: call
/// [`CasterMesh::bump_revision`](crate::CasterMesh::bump_revision) for it. The order of the casters
/// does not matter.
///
/// A static scene costs the CPU one comparison of 80 bytes per caster and the GPU nothing. A caster
/// that moves costs one culling test per light and the draws of the faces that it left or entered. A
/// light that moves finds its casters through a tree (boxes over the casters in Morton order), which is
/// kept between frames where that pays. `docs/benches.md` has what `prepare` takes for 100 to 100,000
/// casters, and how the tree compares with a linear search and a compute shader.
///
/// # Accuracy
///
/// A map is as exact as its texels are small. On the 64 spheres of the example `compare` (1280x720
/// pixels, one bilinear tap) 0.28 % of the pixels are wrong with 512 texels per face, 0.14 % with 1024 and
/// 0.07 % with 2048. All of them lie at shadow edges.
#[derive(Debug)]
pub struct CubeShadowMap {
    size: u32,
    pub(crate) reach: Radius,
    array: bool,
    encoding: DepthEncoding,
    allocation: Allocation,
    cache: bool,
    budget: Option<u32>,
    /// The fewest triangles that are worth a static layer.
    layer_least: Option<u64>,
    casters: Casters,
    slots: Slots,
    plans: Vec<SlotPlan>,
    gpu: CubeGpu,
    submissions: Submissions,
    statistics: CubeStatistics,
}

impl CubeShadowMap {
    /// Makes a map. It has no texture until a light casts ([`Allocation`]).
    ///
    /// # Errors
    /// [`CubeShadowMapError`] if size, bias, lights, format or budget is out of range.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &CubeShadowMapDescriptor<'_>,
    ) -> Result<Self, CubeShadowMapError> {
        descriptor.validate(device, most_tiles(&device.limits()))?;
        let slots = descriptor.lights as usize;
        let mut gpu = CubeGpu::new(device, descriptor);
        if descriptor.allocation == Allocation::AtOnce {
            for slot in 0..slots {
                gpu.allocate(device, slot);
            }
        }
        Ok(Self {
            size: descriptor.size,
            reach: descriptor.reach,
            array: descriptor.cube_array,
            encoding: descriptor.encoding,
            allocation: descriptor.allocation,
            cache: descriptor.cache,
            budget: descriptor.max_faces_per_frame,
            layer_least: descriptor.layer_least(device),
            casters: Casters::default(),
            slots: Slots::new(slots, descriptor.cull_casters),
            plans: Vec::new(),
            gpu,
            submissions: Submissions::default(),
            statistics: CubeStatistics::default(),
        })
    }

    /// Decides which casters go on which faces and which faces are drawn, and uploads what that
    /// needs.
    ///
    /// # Errors
    /// [`CubeShadowMapError`] if a light or a caster is out of range, or there are too many. What
    /// an earlier `prepare` found then still stands.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        frame: &CubeFrame<'_>,
    ) -> Result<(), CubeShadowMapError> {
        let clock = Clock::start();
        frame.validate(self.slots.len())?;
        self.casters.compare(frame.casters, device)?;
        let encoder_dropped = self.submissions.take_dropped();
        if encoder_dropped {
            self.invalidate();
        }
        let lights = frame.lights.iter().copied().map(LightProjection::Point);
        let lights: Vec<_> = lights.map(SlotLight::from).collect();
        self.casters.update(frame.casters);
        self.slots.take_over(&lights, &mut self.casters);
        self.allocate(device);
        let revision = self.texture_revision();
        self.gpu.replace_lights(device, queue, revision);
        let plans = self.plan(frame);
        self.reserve(device, &plans)?;
        let not_encoded = self.is_pending();
        if not_encoded {
            self.gpu.forget_uploads();
        }
        follow(&plans, &mut self.slots);
        self.record_draws(device, &plans, frame);
        let lazy = self.allocation == Allocation::WithFirstCaster;
        self.gpu.write_lights(frame.lights, &self.slots, lazy);

        let tally = Tally::new(&plans, &self.slots, self.casters.records().len());
        let draws = self.gpu.draws();
        let statistics = CubeStatistics {
            draws: draws.iter().count() as u32,
            triangles: draws.iter().map(Draw::triangles).sum(),
            bytes: self.gpu.bytes(),
            uploaded: self.gpu.uploaded(),
            not_encoded,
            encoder_dropped,
            ..CubeStatistics::of(&tally)
        };
        self.statistics = CubeStatistics {
            prepare: clock.elapsed(),
            ..statistics
        };
        self.plans = plans;
        Ok(())
    }

    /// Records what the last [`prepare`](Self::prepare) found necessary: its passes, and what it tells
    /// receivers of the lights. Once: a second call before the next `prepare` records nothing.
    ///
    /// Call it after every `prepare`, whatever that found. Until it is called, receivers see texels and
    /// lights as they were; of a map that was never drawn they see all lights dark. What is recorded
    /// must be submitted: if its encoder is dropped, the `prepare` after that draws everything again
    /// ([`CubeStatistics::encoder_dropped`](crate::CubeStatistics)).
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let mut recorded = self.gpu.upload(encoder);
        recorded |= self.gpu.clear_placeholder(encoder);
        for (index, slot) in self.slots.iter_mut().enumerate() {
            recorded |= slot.pending != 0;
            self.gpu.encode(encoder, index, slot);
            slot.encoded(slot.pending);
        }
        if recorded {
            self.submissions.watch(encoder);
        }
    }

    /// Takes nothing for drawn: the next [`prepare`](Self::prepare) has every face drawn again that the
    /// view shows, whatever the budget. What the last one found is forgotten.
    ///
    /// For a host that has written to the map's textures, or has lost what was recorded in a way that
    /// the map cannot see: an encoder that is kept but never submitted, a submission that failed.
    pub fn invalidate(&mut self) {
        self.slots.iter_mut().for_each(Slot::doubt_texels);
        self.gpu.doubt();
    }

    /// Begins a pass that clears one face of a light, for a host that draws its own geometry
    /// (skinned, alpha-tested) with [`clip_from_world`](Self::clip_from_world): the map's format,
    /// one sample, the comparison and clear depth of its [`DepthEncoding`](crate::DepthEncoding), and
    /// unclipped depth where the device has it, so that what is nearer than the near plane casts. On
    /// wgpu's GL back end, let the fragment shader write clip z times its position's w as `frag_depth`:
    /// the rasteriser's own depth has too few digits there (see [`Support`](crate::Support)).
    /// `None` if the light has no texels (see [`Allocation::AtOnce`](crate::Allocation::AtOnce)) or
    /// the last frame had no such light.
    ///
    /// Call it after [`encode`](Self::encode) (or instead of it): what `encode` drew on this face
    /// is cleared, so pass such a host's other casters through its own draws too. The next
    /// `prepare` takes the face's content for unknown and draws it again.
    pub fn begin_face<'encoder>(
        &mut self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        light: usize,
        face: CubeFace,
    ) -> Option<wgpu::RenderPass<'encoder>> {
        let index = self.slots.of_light(light)?;
        // A host that calls this instead of `encode` tells receivers of the light through it.
        if self.gpu.upload(encoder) {
            self.submissions.watch(encoder);
        }
        let clear = self.gpu.clear();
        let pass = self.gpu.begin_face(encoder, index, face, clear)?;
        self.slots[index].touched(face.layer() as usize);
        Some(pass)
    }

    /// The matrix of a face for a light of the last [`prepare`](Self::prepare), world space to clip
    /// space; `None` if there was no such light. The frame is left-handed: triangles that are
    /// counter-clockwise seen from the light are clockwise on the face. While a light that moved
    /// waits for its faces, this is still the matrix of where it was.
    pub fn clip_from_world(&self, light: usize, face: CubeFace) -> Option<Mat4> {
        let slot = &self.slots[self.slots.of_light(light)?];
        let tile = face.layer() as usize;
        let shown = slot.tiles.get(tile)?.shown;
        let projection = shown.or_else(|| slot.projection(tile))?;
        let from_light = projection.clip_from_light(tile, self.gpu.near_plane());
        Some(from_light * Mat4::from_translation(-projection.origin()))
    }

    /// A light's texture and the first of its six layers, in the order of [`CubeFace::ALL`]; `None`
    /// if it has no texels. On wgpu's GL back end the texture has a spare layer after all lights', which
    /// nothing is drawn into.
    pub fn texture(&self, light: usize) -> Option<(&wgpu::Texture, u32)> {
        let slot = self.gpu.textures().slot(self.slots.of_light(light)?)?;
        Some((&slot.texture, slot.first_layer))
    }

    /// A light's map as a cube texture, for hosts that sample it themselves; a placeholder of one
    /// texel a face if it has none.
    ///
    /// # Errors
    /// [`CubeShadowMapError::CubeView`] on wgpu's GL back end, which reads a texture as layers, as receivers
    /// do, or as a cube, and not as both.
    pub fn view(&self, light: usize) -> Result<&wgpu::TextureView, CubeShadowMapError> {
        let view = self.gpu.textures().cube(self.slot_of(light));
        view.ok_or(CubeShadowMapError::CubeView)
    }

    /// One face of a light's map as a 2D texture; `None` if it has no texels.
    pub fn face_view(&self, light: usize, face: CubeFace) -> Option<&wgpu::TextureView> {
        let slot = self.gpu.textures().slot(self.slots.of_light(light)?)?;
        Some(&slot.faces[face.layer() as usize])
    }

    /// Changes when a bind group of this map must be made again: when its texture came or went, or
    /// (for bind groups of one light) when a light changed its place. Compare it after each
    /// [`prepare`](Self::prepare), before the bind groups are used. To a bind group that was not made
    /// again all lights are dark, so that nobody takes it for right.
    #[must_use]
    pub fn texture_revision(&self) -> u64 {
        self.gpu.textures().revision() + self.slots.reordered()
    }

    /// Whether all lights are in one binding, so that one bind group serves them all.
    pub fn lights_in_one_binding(&self) -> bool {
        self.array
    }

    /// The most frames that a face which changed waits to be drawn while the view shows it:
    /// `6 lights / (max_faces_per_frame / 2)`, both divisions rounded up; `None` without a budget.
    ///
    /// Half the budget goes to the faces that have waited longest, the rest to the most important:
    /// those where most has changed (the solid angle of what did, seen from the light) for lights
    /// that are nearest to the eye and whose range is largest on screen. A light that moved has its
    /// faces drawn together; until then receivers see it, and its shadows, where it was. A new
    /// light is dark until then. Pinned lights, and faces that turned visible and show another
    /// position of their light, are drawn at once, outside the budget.
    pub fn max_age(&self) -> Option<u32> {
        let budget = self.budget?;
        Some(longest_wait(6 * self.slots.len(), budget))
    }

    /// Texels along each side of a face.
    pub fn size(&self) -> u32 {
        self.size
    }

    /// What texels hold.
    pub fn encoding(&self) -> DepthEncoding {
        self.encoding
    }

    /// What the last [`prepare`](Self::prepare) found.
    pub fn statistics(&self) -> CubeStatistics {
        self.statistics
    }

    /// What became of one face of the light at place `light` of the last prepared frame; `None` if
    /// the frame had no such light.
    pub fn face_statistics(&self, light: usize, face: CubeFace) -> Option<TileStatistics> {
        let index = self.slots.of_light(light)?;
        let slot = &self.slots[index];
        let tile = face.layer() as usize;
        let of = slot.tiles.get(tile)?;
        Some(TileStatistics {
            state: self.plans.get(index)?.state(slot, tile),
            casters: of.content.casters,
            triangles: of.content.triangles,
            age: of.age,
        })
    }

    /// How many lights it was made for.
    pub(crate) fn most_lights(&self) -> usize {
        self.slots.len()
    }

    pub(crate) fn light_uniform(&self, light: usize) -> wgpu::BindingResource<'_> {
        self.gpu.lights().one(light)
    }

    /// All layers of the texture that a light is in.
    pub(crate) fn layers(&self, light: usize) -> &wgpu::TextureView {
        self.gpu.textures().layers(self.slot_of(light))
    }

    /// The buffer of all lights, where they share a binding.
    pub(crate) fn all_lights(&self) -> Option<&wgpu::Buffer> {
        self.gpu.lights().all()
    }

    fn slot_of(&self, light: usize) -> usize {
        let same_place = light.min(self.slots.len() - 1);
        self.slots.of_light(light).unwrap_or(same_place)
    }

    /// Whether an `encode` would record anything.
    fn is_pending(&self) -> bool {
        self.gpu.uploaded() > 0 || self.slots.iter().any(|slot| slot.pending != 0)
    }

    /// Makes the texels that this frame's lights need, and gives back those that none needs any more.
    fn allocate(&mut self, device: &wgpu::Device) {
        let lazy = self.allocation == Allocation::WithFirstCaster;
        if lazy {
            for index in self.slots.idle(self.array) {
                if self.gpu.free(index) {
                    self.slots[index].texels_freed();
                }
            }
        }
        for place in 0..self.slots.order().len() {
            let index = self.slots.order()[place];
            if self.slots[index].casting > 0 || !lazy {
                for new in self.gpu.allocate(device, index) {
                    self.slots[new].forget_texels();
                }
            }
        }
    }

    /// Chooses the faces to draw. Changes nothing.
    fn plan(&self, frame: &CubeFrame<'_>) -> Vec<SlotPlan> {
        let mut pinned = vec![false; frame.lights.len()];
        frame.pinned.iter().for_each(|&place| pinned[place] = true);
        let rules = Rules {
            views: frame.view.as_slice(),
            reach: self.reach,
            cache: self.cache,
            budget: self.budget,
            pinned: &pinned,
        };
        choose_tiles(&self.slots, &rules, |slot| {
            self.gpu.textures().slot(slot).map(|_| self.size)
        })
    }

    /// Makes the instance buffer large enough.
    fn reserve(
        &mut self,
        device: &wgpu::Device,
        plans: &[SlotPlan],
    ) -> Result<(), CubeShadowMapError> {
        let instances = casters_drawn(plans, &self.slots);
        let reserved = self.gpu.reserve(device, instances);
        reserved.map_err(
            |TooLarge { size, limit }| CubeShadowMapError::TooManyCasters {
                instances,
                size,
                limit,
            },
        )
    }

    /// Lists what the faces of a plan show, and stages what drawing that needs.
    fn record_draws(&mut self, device: &wgpu::Device, plans: &[SlotPlan], frame: &CubeFrame<'_>) {
        self.gpu.clear_draws();
        let casters = (&self.casters, frame.casters);
        for (index, (slot, plan)) in self.slots.iter_mut().zip(plans).enumerate() {
            if plan.drawn != 0 {
                let (slot, least) = ((index, slot), self.layer_least);
                self.gpu.add_faces(device, slot, plan.drawn, least, casters);
            }
        }
        self.gpu.finish_draws(device);
    }
}
