//! The renderer: prepare, encode, render.

use crate::DepthConvention;
use crate::error::{ShadowVolumeError, VolumeRenderError};
use crate::submissions::Submissions;
use crate::uploads::Uploads;
use crate::volume::decide::decision::words;
use crate::volume::decide::method::Options;
use crate::volume::decide::near_plane::NearPlane;
use crate::volume::gpu::bind_groups::{Groups, Parts};
use crate::volume::gpu::buffers::Buffers;
use crate::volume::gpu::draw_calls::record;
use crate::volume::gpu::draw_pipelines;
use crate::volume::gpu::pipelines::{OwnPipelines, VolumePipelines};
use crate::volume::gpu::staged::Found;
use crate::volume::plan::cache::Kept;
use crate::volume::plan::count_bound;
use crate::volume::plan::faces::{Batch, Draw, Means, Outline, Plan, PlanLimits};
use crate::volume::silhouette::{CpuVolume, Way, Ways, workgroups};
use crate::volume::statistics::CasterState;
use crate::volume::{Counter, ShadowVolumeDescriptor, ShadowVolumeFrame, VolumeStatistics};

/// Stencil shadow volumes of one light for any number of casters.
///
/// A host with several lights keeps one renderer for each light that shines in a frame. One renderer
/// may also serve several views or lights, in one submission or in several, one after another:
/// `prepare`, `encode` and `render` for the first, then all three for the second. Everything is
/// recorded in that order and read in that order, so what goes into several encoders must be
/// submitted in the order in which it was recorded. Views of one light share what was found; lights
/// that take turns search all their casters anew each time.
///
/// The host's frame, for each light:
/// 1. depth prepass: all surfaces into the depth-stencil buffer;
/// 2. [`prepare`](Self::prepare), then [`encode`](Self::encode) outside of any pass;
/// 3. a pass with that depth-stencil buffer, its stencil cleared to 0 and its depth loaded:
///    [`render`](Self::render), then the host's own light pass with
///    [`light_pass_stencil`](Self::light_pass_stencil).
///
/// A call that was forgotten is told: `render` returns an error where `encode` was left out, or where
/// the encoder was dropped. What was recorded in vain is recorded again at the next frame. What the
/// renderer cannot see, [`invalidate`](Self::invalidate) tells it.
///
/// The stencil counts modulo 256. A point that lies in a multiple of 256 volumes at once reads 0
/// and is lit: casters that stack that deep along a light ray want
/// [`Counter::Exact`](crate::Counter::Exact) or fewer, closed meshes.
/// [`may_wrap`](Self::may_wrap) says whether that can happen.
///
/// A light may be as near to a caster as a millionth of its size, if it is outside of the box around
/// the mesh. Within the box, nearer to a large triangle than about 1e-5 of its size, or to an edge
/// than 3e-6 of its length, up to 1 % of the pixels come out wrong along the light's horizon: the
/// corners' points at infinity then lie almost in one line of clip space. And where shaders find the
/// silhouettes, a triangle that the light is nearer to than about 1e-6 of its size may count as seen
/// edge-on and cast nothing; the CPU decides in f64 there.
#[derive(Debug)]
pub struct ShadowVolumeRenderer {
    device: wgpu::Device,
    depth: DepthConvention,
    label: String,
    ways: Ways,
    pipelines: OwnPipelines,
    /// Where the CPU finds one volume after another.
    on_cpu: CpuVolume,
    buffers: Buffers,
    groups: Groups,
    limits: PlanLimits,
    plan: Plan,
    kept: Kept,
    uploads: Uploads,
    submissions: Submissions,
    keep: bool,
    options: Options,
    counter: Counter,
    /// Whether there was a `prepare`, and whether `encode` was called since the last.
    prepared: bool,
    encoded: bool,
}

/// What the last frame draws, and where it lies.
pub(crate) struct Drawn<'a> {
    pub plan: &'a Plan,
    pub kept: &'a Kept,
    pub buffers: &'a Buffers,
    pub depth: DepthConvention,
    pub near: NearPlane,
}

impl ShadowVolumeRenderer {
    /// Compiles the pipelines: for one renderer. Several share theirs:
    /// [`with_pipelines`](Self::with_pipelines).
    ///
    /// # Errors
    /// [`ShadowVolumeError`] if a format or sample count does not fit, or the device lacks a
    /// feature or a limit; the message names it.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ShadowVolumeDescriptor<'_>,
    ) -> Result<Self, ShadowVolumeError> {
        Self::with_pipelines(&VolumePipelines::new(device, None), descriptor)
    }

    /// A renderer for the device of these pipelines, which compiles those of them that no other
    /// renderer has needed so far.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_pipelines(
        pipelines: &VolumePipelines,
        descriptor: &ShadowVolumeDescriptor<'_>,
    ) -> Result<Self, ShadowVolumeError> {
        let device = pipelines.device();
        descriptor.validate(device)?;
        let ways = Ways::new(descriptor.silhouettes, device)?;
        let label = match descriptor.label {
            Some(name) => format!("shadows volume {name}"),
            None => "shadows volume".to_owned(),
        };
        let limits = PlanLimits::of(&device.limits(), &ways);
        Ok(Self {
            device: device.clone(),
            depth: descriptor.depth,
            kept: Kept::new(limits.storage_bytes),
            limits,
            uploads: Uploads::new(device),
            submissions: Submissions::default(),
            pipelines: pipelines.take(descriptor, &ways),
            ways,
            on_cpu: CpuVolume::default(),
            buffers: Buffers::new(&label),
            groups: Groups::default(),
            plan: Plan::default(),
            options: Options::of(device, descriptor),
            counter: descriptor.counter,
            keep: descriptor.keep_between_frames,
            prepared: false,
            encoded: false,
            label,
        })
    }

    /// Decides what one frame draws and finds the silhouettes that the CPU finds. What of it goes to
    /// the GPU, a few hundred bytes a caster, waits for [`encode`](Self::encode). A caster that is
    /// skipped because it is out of view takes about 0.12 microseconds of CPU time (10,000 of them,
    /// 2.6 GHz; `cargo bench --bench shadow_volume`).
    ///
    /// A volume is kept as long as a caster has it: its mesh and that mesh's revision, the light as
    /// seen from the mesh, and what of it counts. It does not matter where in the list the caster
    /// stands, nor what comes and goes around it. Casters out of view keep their volumes, as long as
    /// all casters together fit one storage buffer for each list, so that what comes back into view
    /// need not be searched again; casters out of the light's range do not.
    ///
    /// GPU memory, kept between frames and grown as needed, what it held being copied: where compute
    /// shaders find the silhouettes about 28 bytes a triangle and volume, where the CPU does what
    /// they come to, about 6 bytes a triangle; and 720 a caster. Up to twice that, because buffers
    /// grow to powers of two. Besides, what `encode` uploads waits in staging buffers. These are kept, of
    /// powers of two from 64 KB on: about twice the most that was uploaded, for each frame that the GPU
    /// has not finished.
    ///
    /// `queue` is not written to: what is uploaded is recorded.
    ///
    /// # Errors
    /// [`ShadowVolumeError`], before any GPU work, if the view's depth convention is not the
    /// renderer's, a light, range or caster is not sound, or a caster's volume is larger than the
    /// device's limits allow. The renderer then still draws what the last call prepared.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        _queue: &wgpu::Queue,
        frame: &ShadowVolumeFrame<'_>,
    ) -> Result<(), ShadowVolumeError> {
        if frame.view.depth() != self.depth {
            return Err(ShadowVolumeError::Depth {
                renderer: self.depth,
                view: frame.view.depth(),
            });
        }
        let means = Means {
            options: self.options,
            ways: &self.ways,
            regions: self.kept.regions(),
            keep: self.keep,
        };
        let outline = Outline::new(frame, device, &self.limits, &means)?;
        let [not_encoded, encoder_dropped] = self.forget();
        self.kept.update(&outline.subjects, frame.casters);
        let found = self.find();
        let mut plan = Plan::new(outline, frame, &self.options, &self.limits, &self.kept);
        if !plan.draws.is_empty() {
            let planned = (&plan, &self.kept);
            self.buffers
                .reserve(device, &mut self.uploads, planned, &self.limits);
            self.buffers.write(device, &mut self.uploads, &plan);
            found.write(&mut self.uploads, &self.buffers);
        }
        plan.statistics = VolumeStatistics {
            gpu_bytes: self.buffers.bytes(),
            not_encoded,
            encoder_dropped,
            ..plan.statistics
        };
        self.plan = plan;
        (self.prepared, self.encoded) = (true, false);
        self.bind();
        Ok(())
    }

    /// Records the uploads of the last [`prepare`](Self::prepare), and the compute passes that find
    /// the volumes which were not kept from the frame before: none where neither the light nor a
    /// caster has moved. Once: a second call before the next `prepare` records nothing.
    ///
    /// What is recorded must be submitted, for the next frame counts on it; if the encoder is dropped
    /// instead, the next `prepare` finds everything anew. A host that deforms a mesh in its own
    /// position buffer says so with [`CasterMesh::bump_revision`](crate::CasterMesh::bump_revision)
    /// before `prepare`.
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let first = self.prepared && !self.encoded;
        self.encoded = self.prepared;
        if !first || self.plan.draws.is_empty() {
            return;
        }
        self.submissions.watch(encoder);
        self.uploads.record(encoder);
        let Some(extraction) = self.pipelines.extraction.as_ref() else {
            return;
        };
        if self.plan.batches.is_empty() {
            return;
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(&self.label),
            timestamp_writes: None,
        });
        self.dispatch(&mut pass, &extraction.facing.pipeline, |batch, group| {
            (batch.params.triangle_count, &group[0])
        });
        self.dispatch(&mut pass, &extraction.edges.pipeline, |batch, group| {
            (batch.params.edge_count, &group[1])
        });
    }

    /// Has the next [`prepare`](Self::prepare) find every volume anew: for a host that has lost what
    /// was recorded in a way that the renderer cannot see, or has written into a mesh's buffer
    /// without a new revision.
    pub fn invalidate(&mut self) {
        self.kept.clear();
    }

    /// Records the stencil draws into the host's pass, which must have the formats and the sample
    /// count of the descriptor, a stencil of 0 and the scene's depth (which may be read-only). With
    /// [`Counter::Exact`](crate::Counter::Exact): a count of 0, and no need of the stencil.
    ///
    /// Changes the pass's pipeline, bind group 0, index buffer and vertex buffer 0; where the frame
    /// gave a target size and a range, also the scissor rectangle, which is then the whole target.
    /// Nothing else.
    ///
    /// # Errors
    /// [`VolumeRenderError`] if [`encode`](Self::encode) was not called since the last
    /// [`prepare`](Self::prepare), or its encoder was dropped. Nothing is then drawn, and no shadow
    /// is in the picture.
    pub fn render(&self, pass: &mut wgpu::RenderPass<'_>) -> Result<(), VolumeRenderError> {
        if !self.encoded {
            return Err(VolumeRenderError::NotEncoded);
        }
        if self.submissions.is_dropped() {
            return Err(VolumeRenderError::Dropped);
        }
        if self.plan.draws.is_empty() {
            return Ok(());
        }
        if let Some(([x, y, width, height], _)) = self.plan.scissor {
            pass.set_scissor_rect(x, y, width, height);
        }
        self.draw(pass);
        if let Some((_, [width, height])) = self.plan.scissor {
            pass.set_scissor_rect(0, 0, width, height);
        }
        Ok(())
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        let drawn = self.drawn();
        let mut current = None;
        for draw in &self.plan.draws {
            let Some(slot) = self.kept.get(draw.slot) else {
                continue;
            };
            let pipelines = match slot.way {
                Way::Vertex => self.pipelines.fed.as_ref(),
                Way::Compute | Way::Cpu => self.pipelines.pulled.as_ref(),
            };
            let Some(pipelines) = pipelines.filter(|_| self.bind_volume(pass, draw)) else {
                continue;
            };
            let state = (draw.style, slot.way == Way::Vertex);
            if current != Some(state) {
                let Some(pipeline) = pipelines.get(draw.style) else {
                    continue;
                };
                pass.set_pipeline(pipeline);
                current = Some(state);
            }
            record(pass, draw, slot, &drawn);
        }
    }

    /// The stencil state for the host's light pass, drawn with
    /// [`set_stencil_reference(0)`](wgpu::RenderPass::set_stencil_reference).
    ///
    /// A fragment is shaded only where the count is 0, so where the point is in no volume, and
    /// then raises the count to 1: a second fragment at the same sample (two surfaces at the same
    /// depth, the two triangles of a shared edge in a scene drawn again) is not shaded, so that
    /// light is never added twice. The depth comparison is the host's: `Equal` if it draws the
    /// scene again, `Always` for a triangle that covers the screen.
    ///
    /// The pass needs write access to the stencil. Between lights, clear the stencil to 0 and keep
    /// the depth.
    pub fn light_pass_stencil() -> wgpu::StencilState {
        draw_pipelines::light_pass()
    }

    /// What the last [`prepare`](Self::prepare) came to.
    pub fn statistics(&self) -> VolumeStatistics {
        self.plan.statistics
    }

    /// What was decided for each caster of the last frame that was prepared, in the frame's order.
    pub fn caster_states(&self) -> &[CasterState] {
        &self.plan.states
    }

    /// What the debug views draw from.
    pub(crate) fn drawn(&self) -> Drawn<'_> {
        Drawn {
            plan: &self.plan,
            kept: &self.kept,
            buffers: &self.buffers,
            depth: self.depth,
            near: self.options.near,
        }
    }

    /// Sets the bind group that a draw reads, if it is there.
    pub(crate) fn bind_volume(&self, pass: &mut wgpu::RenderPass<'_>, draw: &Draw) -> bool {
        let Some(group) = self.groups.of_caster(draw.caster as usize) else {
            return false;
        };
        let step = self.limits.caster_window;
        pass.set_bind_group(0, group, &[draw.caster * step]);
        true
    }

    /// No visible point is in more volumes than this, of those that the last
    /// [`prepare`](Self::prepare) draws.
    ///
    /// The bound is 1 for a convex caster and grows with the number of silhouette edges that one
    /// plane through the light cuts; casters add up where their bounding spheres overlap as seen
    /// from the light. A mesh over positions in the host's own buffer counts with all its triangles.
    ///
    /// The first time this takes the CPU once or twice as long as extracting the volumes
    /// ([`Silhouettes::Cpu`](crate::Silhouettes::Cpu)). Each caster's bound is kept with its volume, so where
    /// nothing moved only the casters are sorted. On the scenes of the example `compare` the bound is 3
    /// for `spheres`, 17 for `teapot` and 62 for `courtyard`.
    pub fn count_bound(&mut self) -> u64 {
        count_bound::bound(&self.plan, &mut self.kept, &mut self.on_cpu)
    }

    /// Whether the counter could wrap in the frame prepared last, so that a point in shadow would
    /// be lit: [`count_bound`](Self::count_bound) is at least 256, or with
    /// [`Counter::Exact`](crate::Counter::Exact) 2^24.
    ///
    /// `false` is certain. `true` may be a false alarm, for the bound is not the count.
    pub fn may_wrap(&mut self) -> bool {
        self.count_bound() >= self.counter.end()
    }

    /// Lets go what of the last frame cannot be counted on. Whether it was not encoded, and whether
    /// an encoder was dropped.
    fn forget(&mut self) -> [bool; 2] {
        self.uploads.clear();
        let dropped = self.submissions.take_dropped();
        let not_encoded = !(self.encoded || self.plan.draws.is_empty());
        if dropped || !self.keep {
            self.kept.clear();
        } else if not_encoded {
            self.kept.forget_wanted();
        }
        [not_encoded, dropped]
    }

    /// Finds a place for everything that is new, and on the CPU what is found there.
    fn find(&mut self) -> Found {
        let mut found = Found::default();
        for number in self.kept.wanted().to_vec() {
            let Some(slot) = self.kept.get(number) else {
                continue;
            };
            let mesh = slot.mesh.clone();
            match (slot.way, mesh.data()) {
                (Way::Compute, _) => self.kept.place(number, words(&mesh, Way::Compute)),
                (Way::Cpu, Some(data)) => {
                    let counts = self.on_cpu.extract(data, mesh.kind(), &slot.instance);
                    self.kept.place_found(number, counts);
                    if let Some(slot) = self.kept.get(number) {
                        found.add(&mut self.uploads, &self.on_cpu, data, slot);
                    }
                }
                _ => {}
            }
        }
        found
    }

    fn dispatch<'a>(
        &'a self,
        pass: &mut wgpu::ComputePass<'_>,
        pipeline: &wgpu::ComputePipeline,
        work: impl Fn(&'a Batch, &'a [wgpu::BindGroup; 2]) -> (u32, &'a wgpu::BindGroup),
    ) {
        let most = self.limits.workgroups;
        let step = self.limits.batch_window;
        pass.set_pipeline(pipeline);
        for (index, batch) in (0..).zip(&self.plan.batches) {
            let Some(groups) = self.groups.of_batch(batch) else {
                continue;
            };
            let (count, group) = work(batch, groups);
            let [x, y, z] = workgroups(count, batch.instance_count, most);
            pass.set_bind_group(0, group, &[index * step]);
            pass.dispatch_workgroups(x, y, z);
        }
    }

    /// Brings the bind groups up to date with plan and buffers.
    fn bind(&mut self) {
        let parts = Parts {
            device: &self.device,
            label: &self.label,
            buffers: &self.buffers,
            extraction: self.pipelines.extraction.as_ref(),
            pulled: self.pipelines.pulled.as_ref(),
            fed: self.pipelines.fed.as_ref(),
        };
        self.groups.update(&self.plan, &self.kept, &parts);
    }
}

#[cfg(test)]
#[path = "agreement.rs"]
mod agreement;
