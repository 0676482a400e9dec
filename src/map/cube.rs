//! Omnidirectional shadow maps.

use std::collections::HashMap;

use glam::Mat4;

use super::assign::assign;
use super::descriptor::{Allocation, CubeFrame, CubeShadowMapDescriptor, DepthEncoding};
use super::draws::DrawLists;
use super::face::CubeFace;
use super::light::LightUniform;
use super::near::NearPlane;
use super::plan::SlotPlan;
use super::resources::{self, PipelineKey, PipelineKind, UNIFORM_STRIDE};
use super::scene::Scene;
use super::slot::Slot;
use super::statistics::{Clock, CubeStatistics};
use super::still_layer::StillLayer;
use super::texture::Textures;
use crate::error::CubeShadowMapError;
use crate::submissions::Submissions;
use crate::uploads::Uploads;
use crate::{Bias, PointLight, Radius};

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
/// A face whose light, casters, transforms and mesh revisions are those it was drawn with is left
/// alone. This is found by comparing, so there is no flag to set; only a mesh that the host deforms
/// in its own buffer needs [`CasterMesh::bump_revision`](crate::CasterMesh::bump_revision). The
/// order of the casters does not matter. A still scene costs one comparison of 80 bytes a caster
/// and no GPU work; a caster that moves costs a culling test a light, and the faces it left or
/// entered their draws; a light that moves finds the casters that it reaches through a tree.
///
/// `prepare` for 16 lights that reach some 700 casters each, on one core of a shared server, medians
/// of the bench `cube_map`:
///
/// | casters | none moved | one moved | one light moved |
/// |---|---|---|---|
/// | 100 | 0.01 ms | 0.02 ms | 0.02 ms |
/// | 10,000 | 0.02 ms | 0.04 ms | 0.08 ms |
/// | 100,000 | 0.29 ms | 0.41 ms | 0.50 ms |
///
/// What grows with the casters that stand still is the comparison, 3 to 5 ns each, and that it
/// empties the caches: a hundred casters that move near a light add 36 us among 1,000, 48 us among
/// 100,000 (`moved_among_1e5_vs_among_1e3`), and no more than that among 400,000.
///
/// The tree (boxes over the casters in Morton order) is kept from frame to frame where it pays, which
/// is found by adding up. With a hundredth of the casters and all 16 lights moving, keeping it and
/// asking it takes as long as testing every caster's sphere among 100 casters (too few for a tree),
/// 0.26 to 0.41 of that among 10,000 and 0.04 to 0.14 among 100,000 (`culling_N_vs_linear`). A
/// uniform grid took 20 to 35, 0.6 to 1.3 and 0.03 to 0.29. A compute shader that fills the lists of
/// indirect draws takes at least 4, 7 and 12 times as long as the tree on llvmpipe
/// (`culling_N_vs_compute`), and only the CPU can tell beforehand which faces need no draw at all.
///
/// # What depths are at fault for
///
/// On the 64 spheres of the example `compare` (1280 x 720 pixels, one bilinear tap) 0.28 % of the
/// pixels are wrong at 512 texels a face, 0.14 % at 1024 and 0.07 % at 2048, none of them away from
/// an outline.
#[derive(Debug)]
pub struct CubeShadowMap {
    pub(super) size: u32,
    pub(super) bias: Bias,
    pub(crate) reach: Radius,
    pub(super) label: String,
    pub(super) array: bool,
    pub(super) format: wgpu::TextureFormat,
    pub(super) encoding: DepthEncoding,
    pub(super) near_plane: NearPlane,
    pub(super) allocation: Allocation,
    pub(super) cache: bool,
    pub(super) budget: Option<u32>,
    pub(super) textures: Textures,
    pub(super) kind: PipelineKind,
    pub(super) pipelines: HashMap<PipelineKey, wgpu::RenderPipeline>,
    pub(super) face_uniforms: wgpu::Buffer,
    pub(super) face_group: wgpu::BindGroup,
    pub(super) lights: resources::Lights,
    /// The [`texture_revision`](Self::texture_revision) for which those buffers are.
    pub(super) lights_revision: u64,
    pub(super) instances: wgpu::Buffer,
    pub(super) scene: Scene,
    /// Kept only for its memory: the casters that a light reaches.
    reached: Vec<u32>,
    pub(super) slots: Vec<Slot>,
    /// For each light of the frame its slot.
    pub(super) order: Vec<usize>,
    pub(super) plans: Vec<SlotPlan>,
    pub(super) draws: DrawLists,
    /// The layers of what stands still, by slot and face, and the fewest triangles worth one.
    pub(super) still: Vec<[Option<StillLayer>; 6]>,
    pub(super) still_least: Option<u64>,
    // What the uniforms hold once the uploads are recorded, by light and by slot.
    pub(super) written_lights: Vec<Option<LightUniform>>,
    pub(super) written_faces: Vec<Option<[f32; 2]>>,
    pub(super) uploads: Uploads,
    pub(super) submissions: Submissions,
    pub(super) statistics: CubeStatistics,
    pub(super) reordered: u64,
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
        descriptor.validate(device)?;
        let &CubeShadowMapDescriptor {
            size,
            bias,
            cube_array,
            format,
            encoding,
            ..
        } = descriptor;
        let slots = descriptor.lights as usize;
        let label = match descriptor.label {
            Some(label) => format!("shadows cube map {label}"),
            None => "shadows cube map".to_owned(),
        };
        let (face_uniforms, layout, face_group) = resources::faces(device, &label, slots as u64);
        let kind = PipelineKind {
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(&label),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            }),
            shader: resources::caster_shader(device, &label),
            depth_written: resources::writes_depth(device),
            format,
            encoding,
            slope_scale: bias.slope_scale,
            unclipped_depth: resources::can_pull_casters(device),
        };
        let mut textures = Textures::new(device, &label, size, format, slots, cube_array);
        if descriptor.allocation == Allocation::AtOnce {
            for slot in 0..slots {
                textures.allocate(device, slot);
            }
        }
        let textures_revision = textures.revision();
        Ok(Self {
            size,
            bias,
            reach: descriptor.reach,
            array: cube_array,
            format,
            encoding,
            near_plane: NearPlane::new(format, encoding),
            allocation: descriptor.allocation,
            cache: descriptor.cache,
            budget: descriptor.max_faces_per_frame,
            textures,
            kind,
            pipelines: HashMap::new(),
            face_uniforms,
            face_group,
            lights: resources::lights(device, &label, slots as u64, cube_array),
            lights_revision: textures_revision,
            instances: resources::instances(device, &label, 1),
            uploads: Uploads::new(device),
            submissions: Submissions::default(),
            label,
            scene: Scene::new(descriptor.sides),
            reached: Vec::new(),
            slots: (0..slots)
                .map(|_| Slot::new(descriptor.cull_casters))
                .collect(),
            order: Vec::new(),
            plans: Vec::new(),
            draws: DrawLists::new(slots),
            still: (0..slots).map(|_| Default::default()).collect(),
            still_least: descriptor.still_least(device),
            written_lights: vec![None; slots],
            written_faces: vec![None; slots],
            statistics: CubeStatistics::default(),
            reordered: 0,
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
        self.scene.compare(frame.casters, device)?;
        let encoder_dropped = self.submissions.take_dropped();
        if encoder_dropped {
            self.invalidate();
        }
        self.take_over(frame);
        self.allocate(device);
        self.replace_lights(device, queue);
        let plans = self.plan(frame);
        self.reserve(device, &plans)?;
        let not_encoded = self.is_pending();
        if not_encoded {
            self.forget_uploads();
        }
        self.follow(&plans);
        self.record_draws(device, &plans, frame);
        self.write_lights(frame.lights);

        let mut statistics = self.tally(&plans);
        self.draws.count(&mut statistics);
        statistics.bytes = self.bytes();
        statistics.uploaded = self.uploads.bytes();
        statistics.not_encoded = not_encoded;
        statistics.encoder_dropped = encoder_dropped;
        statistics.prepare = clock.elapsed();
        self.statistics = statistics;
        Ok(())
    }

    /// Whether an `encode` would record anything.
    fn is_pending(&self) -> bool {
        self.uploads.bytes() > 0 || self.slots.iter().any(|slot| slot.pending != 0)
    }

    /// The matrix of a face for a light of the last [`prepare`](Self::prepare), world space to clip
    /// space; `None` if there was no such light. The frame is left-handed: triangles that are
    /// counter-clockwise seen from the light are clockwise on the face. While a light that moved
    /// waits for its faces, this is still the matrix of where it was.
    pub fn clip_from_world(&self, light: usize, face: CubeFace) -> Option<Mat4> {
        let slot = &self.slots[*self.order.get(light)?];
        let light = slot.shown.or(slot.light)?;
        let near = self.near_plane.of_point(&light);
        Some(face.clip_from_light(near) * Mat4::from_translation(-light.position))
    }

    /// A light's texture and the first of its six layers, in the order of [`CubeFace::ALL`]; `None`
    /// if it has no texels. On wgpu's GL back end a cube array for one light has six more layers, which
    /// nothing is drawn into.
    pub fn texture(&self, light: usize) -> Option<(&wgpu::Texture, u32)> {
        let slot = self.textures.slot(*self.order.get(light)?)?;
        Some((&slot.texture, slot.first_layer))
    }

    /// A light's map as a cube texture, for hosts that sample it themselves; a placeholder of one
    /// texel a face if it has none.
    ///
    /// # Errors
    /// [`CubeShadowMapError::CubeView`] if the map is a cube array on wgpu's GL back end, which reads
    /// no cube out of an array.
    pub fn view(&self, light: usize) -> Result<&wgpu::TextureView, CubeShadowMapError> {
        let view = self.textures.cube(self.slot_of(light));
        view.ok_or(CubeShadowMapError::CubeView)
    }

    /// One face of a light's map as a 2D texture; `None` if it has no texels.
    pub fn face_view(&self, light: usize, face: CubeFace) -> Option<&wgpu::TextureView> {
        let slot = self.textures.slot(*self.order.get(light)?)?;
        Some(&slot.faces[face.layer() as usize])
    }

    /// Changes when a bind group of this map must be made again: when its texture came or went, or
    /// (for bind groups of one light) when a light changed its place. Compare it after each
    /// [`prepare`](Self::prepare), before the bind groups are used. To a bind group that was not made
    /// again all lights are dark, so that nobody takes it for right.
    #[must_use]
    pub fn texture_revision(&self) -> u64 {
        self.textures.revision() + self.reordered
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
        Some(super::schedule::longest_wait(self.slots.len(), budget))
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

    /// How many lights it was made for.
    pub(crate) fn most_lights(&self) -> usize {
        self.slots.len()
    }

    pub(crate) fn light_uniform(&self, light: usize) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &self.lights.uniforms,
            offset: light.min(self.slots.len() - 1) as u64 * UNIFORM_STRIDE,
            size: wgpu::BufferSize::new(size_of::<LightUniform>() as u64),
        })
    }

    /// The array of all cubes and the buffer of all lights, where they share a binding.
    pub(crate) fn array(&self) -> Option<(&wgpu::TextureView, &wgpu::Buffer)> {
        Some((self.textures.array()?, self.lights.all.as_ref()?))
    }

    fn slot_of(&self, light: usize) -> usize {
        let same_place = light.min(self.slots.len() - 1);
        self.order.get(light).copied().unwrap_or(same_place)
    }

    fn bytes(&self) -> u64 {
        let all = self.lights.all.as_ref().map_or(0, wgpu::Buffer::size);
        self.textures.bytes()
            + self.layer_bytes()
            + self.instances.size()
            + self.face_uniforms.size()
            + self.lights.uniforms.size()
            + all
    }

    /// Takes over the frame's lights and casters.
    fn take_over(&mut self, frame: &CubeFrame<'_>) {
        let order = assign(frame.lights, &self.slots, &self.order);
        let moved = order.iter().zip(&self.order).any(|(new, old)| new != old);
        self.reordered += u64::from(moved);
        let mut wanted = vec![None; self.slots.len()];
        for (light, &slot) in frame.lights.iter().zip(&order) {
            wanted[slot] = Some(*light);
        }
        self.order = order;
        // Lights that change are sorted out once, after the casters.
        let changes = |slot: &Slot, light: &Option<PointLight>| slot.light != *light;
        let mut changed = vec![false; self.slots.len()];
        for ((slot, light), changed) in self.slots.iter_mut().zip(&wanted).zip(&mut changed) {
            *changed = changes(slot, light);
            if *changed {
                let shown = slot.shown;
                slot.set_light(None, &self.scene, &[]);
                slot.shown = shown.filter(|_| light.is_some());
            }
        }
        if !self.scene.is_still(frame.casters) {
            self.scene.update(frame.casters, &mut self.slots);
        }
        for ((slot, light), changed) in self.slots.iter_mut().zip(wanted).zip(changed) {
            let Some(light) = light.filter(|_| changed) else {
                continue;
            };
            self.reached.clear();
            match slot.cull {
                true => self.scene.within(&light, &mut self.reached),
                false => self.reached.extend(0..self.scene.records().len() as u32),
            }
            slot.set_light(Some(light), &self.scene, &self.reached);
        }
    }
}
