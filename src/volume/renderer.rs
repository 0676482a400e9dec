//! The renderer: prepare, encode, render.

mod drawn;
mod inspect;
mod upload;

pub(crate) use drawn::Drawn;

use crate::DepthConvention;
use crate::error::{ShadowVolumeError, VolumeRenderError};
use crate::submissions::Submissions;
use crate::uploads::Uploads;
use crate::volume::decide::method::Options;
use crate::volume::gpu::bind_groups::Groups;
use crate::volume::gpu::buffers::Buffers;
use crate::volume::gpu::draw_pipelines::{self, Feed};
use crate::volume::gpu::pipelines::{OwnPipelines, VolumePipelines};
use crate::volume::plan::cache::VolumeCache;
use crate::volume::plan::limits::PlanLimits;
use crate::volume::plan::meshes::MeshPool;
use crate::volume::plan::params::{LightParams, ViewParams};
use crate::volume::plan::scene::Requirements;
use crate::volume::plan::volumes::{Volumes, check_counts, light_params, view_params};
use crate::volume::plan::work::{Dispatch, Work};
use crate::volume::silhouette::{CpuVolume, Ways};
use crate::volume::{Counter, ShadowVolumeDescriptor, ShadowVolumeFrame, VolumeStatistics};

/// Stencil shadow volumes for all lights of a frame in all its views, with any number of casters.
///
/// A frame of the host consists of:
/// 1. for each view, a depth prepass, which draws all surfaces into the depth-stencil buffer;
/// 2. [`prepare`](Self::prepare) with lights, views and casters, then [`encode`](Self::encode) outside any
///    pass, once each;
/// 3. for each view, a pass with the view's depth-stencil buffer, its stencil cleared to 0 and its depth
///    loaded. In it, for each light: [`reset`](Self::reset) unless it is the first, [`render`](Self::render)
///    with the indices of light and view, then the host's own light pass with
///    [`light_pass_stencil`](Self::light_pass_stencil). Alternatively, one pass for each light, with its
///    stencil cleared.
///
/// Volumes depend on the light only, and are extracted once for all views. What has not changed costs
/// nothing: a frame with the same lights, views and casters takes one comparison of the casters. If a caster
/// has moved, its own cost is added; if a view has moved, a new choice of method for each caster and light in
/// that view.
///
/// One renderer may also serve several frames of one submission, one after another: `prepare`, `encode` and
/// `render` for the first, then all three for the second. Everything is recorded and read in that order, so
/// if several encoders are used, they must be submitted in the order in which they were recorded.
///
/// Forgotten calls are reported: `render` returns an error if `encode` was left out or the encoder was
/// dropped. Work that was lost in this way is recorded again in the next frame. For losses that the renderer
/// cannot detect, call [`invalidate`](Self::invalidate).
///
/// The stencil counts modulo 256. A point that lies in a multiple of 256 volumes at once reads 0 and is lit:
/// if casters stack that deep along a light ray, use [`Counter::Exact`](crate::Counter::Exact), or fewer and
/// closed meshes. [`may_wrap`](Self::may_wrap) tells whether that can happen.
///
/// A light may be as near to a caster as a millionth of its size, if it is outside the box around the mesh.
/// If it is inside the box and nearer to a large triangle than about 1e-5 of its size, or to an edge than
/// 3e-6 of its length, up to 1 % of the pixels are wrong along the light's horizon: the corners' points at
/// infinity then lie almost on one line of clip space. If shaders find the silhouettes, a triangle nearer to
/// the light than about 1e-6 of its size may be treated as edge-on and cast nothing; the CPU decides this in
/// f64.
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
    volumes: Volumes,
    cache: VolumeCache,
    meshes: MeshPool,
    work: Work,
    /// As the shaders have them: see `multiview.rs`.
    views: Vec<ViewParams>,
    lights: Vec<LightParams>,
    statistics: VolumeStatistics,
    uploads: Uploads,
    submissions: Submissions,
    keep: bool,
    options: Options,
    counter: Counter,
    /// Whether there was a `prepare`, and whether `encode` was called since the last.
    prepared: bool,
    encoded: bool,
    /// Whether the last `prepare` left something for `encode` to record.
    waits: bool,
    /// Whether nothing that was written before can be counted on.
    renewed: bool,
}

impl ShadowVolumeRenderer {
    /// Compiles the pipelines for one renderer. To share them among several, use
    /// [`with_pipelines`](Self::with_pipelines).
    ///
    /// # Errors
    /// [`ShadowVolumeError`] if a format or the sample count is unsuitable, or if the device lacks a feature
    /// or a limit; the message names it.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ShadowVolumeDescriptor<'_>,
    ) -> Result<Self, ShadowVolumeError> {
        Self::with_pipelines(&VolumePipelines::new(device, None), descriptor)
    }

    /// A renderer for the device of these pipelines. Compiles only those that no other renderer has needed so
    /// far.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
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
        let multiview = descriptor.multiview();
        let limits = PlanLimits::of(&device.limits(), &ways, multiview);
        Ok(Self {
            device: device.clone(),
            depth: descriptor.depth,
            cache: VolumeCache::new(limits.storage_bytes),
            limits,
            uploads: Uploads::new(device),
            submissions: Submissions::default(),
            pipelines: pipelines.take(descriptor, &ways),
            on_cpu: CpuVolume::default(),
            buffers: Buffers::new(&label, &ways),
            groups: Groups::default(),
            volumes: Volumes::new(limits.storage_bytes, multiview),
            ways,
            meshes: MeshPool::new(limits.storage_bytes),
            work: Work::default(),
            views: Vec::new(),
            lights: Vec::new(),
            statistics: VolumeStatistics::default(),
            options: Options::of(device, descriptor),
            counter: descriptor.counter,
            keep: descriptor.keep_between_frames,
            prepared: false,
            encoded: false,
            waits: false,
            renewed: false,
            label,
        })
    }

    /// Decides what to draw for each light in each view, and finds silhouettes where that is the CPU's job.
    /// Uploads, of only what has changed, wait for [`encode`](Self::encode).
    ///
    /// A volume is identified by its mesh and that mesh's revision, the light as seen from the mesh, and the
    /// faces that count, and is kept as long as a caster uses it. The caster's index, other casters being
    /// added or removed, and the views in which it is drawn do not matter. Casters out of view keep their
    /// volumes, as long as all volumes together fit one storage buffer for each list, so that they need not
    /// be extracted again when they come back into view; casters out of the light's range do not.
    ///
    /// GPU memory is kept between frames and grown as needed, with its content copied. If compute shaders find the
    /// silhouettes, it takes about 28 bytes per triangle and volume; if the CPU does, the size of the result, about 6
    /// bytes per triangle. In addition, it takes 140 bytes per volume, about 230 per caster, light and view, and for
    /// merged draws another 12 for every eight sides and cap triangles that a caster may have (256 and none if vertex
    /// shaders find the silhouettes). The data of meshes lies in buffers that all meshes share, from the time a volume
    /// of the mesh is first extracted until no caster uses it: 12 bytes per position (none if the positions are the
    /// host's) and 16 per edge, and for compute shaders 12 per triangle and 4 for each use of an edge of a
    /// [`MeshKind::General`](crate::mesh::MeshKind::General) mesh. All of this may double, because buffers grow to
    /// powers of two. Uploads wait in staging buffers, which are kept, in sizes of powers of two from 64 KB: about
    /// twice the largest upload, for each frame in flight. Those of meshes are released once they are copied.
    ///
    /// Nothing is written through `queue`: uploads are recorded into the encoder.
    ///
    /// # Errors
    /// [`ShadowVolumeError`], before any GPU work, if a view's depth convention is not the renderer's, if a
    /// light, range or caster is invalid, or if a caster's volume is larger than the device's limits allow.
    /// The renderer then still draws what the previous call prepared.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        _queue: &wgpu::Queue,
        frame: &ShadowVolumeFrame<'_>,
    ) -> Result<(), ShadowVolumeError> {
        let multiview = self.pipelines.multiview;
        frame.validate(self.depth, multiview)?;
        let required = Requirements {
            device,
            ways: &self.ways,
            limits: &self.limits,
            regions: self.cache.regions(),
            meshes: &self.meshes,
        };
        self.volumes.casters.compare(frame.casters, &required)?;
        check_counts(frame, multiview, self.options, &self.limits)?;
        let [not_encoded, encoder_dropped] = self.forget();
        let choices = (self.options, self.keep);
        let left = self
            .volumes
            .decide(frame, choices, &self.ways, &mut self.cache);
        left.into_iter().for_each(|mesh| self.meshes.release(mesh));
        self.views = multiview.windows(&view_params(frame));
        self.lights = light_params(frame);
        let staged = self.find();
        self.volumes.fill(&mut self.cache, self.renewed);
        let touched = self.volumes.merged.settle();
        let most = self.limits.workgroups;
        self.work.merge(&self.volumes.merged, &touched, most);
        self.upload(device, staged, &touched);
        self.volumes.merged.finish(&touched);
        self.statistics = VolumeStatistics {
            not_encoded,
            encoder_dropped,
            ..self.count()
        };
        (self.prepared, self.encoded) = (true, false);
        Ok(())
    }

    /// Records the uploads of the last [`prepare`](Self::prepare), and the compute passes for volumes that
    /// were not kept from the previous frame: none if no light and no caster has moved, otherwise three
    /// dispatches for all lights and meshes (see [`VolumeStatistics::dispatches`]). Does so once: a second
    /// call before the next `prepare` records nothing.
    ///
    /// The recorded work must be submitted, because the next frame relies on it; if the encoder is dropped
    /// instead, the next `prepare` starts from scratch. A host that deforms a mesh in its own position buffer
    /// calls [`CasterMesh::bump_revision`](crate::CasterMesh::bump_revision) before `prepare`.
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let first = self.prepared && !self.encoded;
        self.encoded = self.prepared;
        if !first || !self.waits {
            return;
        }
        self.submissions.watch(encoder);
        self.uploads.record(encoder);
        let extraction = self.pipelines.extraction.as_ref();
        let Some(extraction) = extraction.filter(|_| !self.work.is_empty()) else {
            return;
        };
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(&self.label),
            timestamp_writes: None,
        });
        let Work {
            facing,
            edges,
            merging,
            ..
        } = &self.work;
        pass.set_pipeline(&extraction.facing.pipeline);
        self.dispatch(&mut pass, (0, facing), |one| self.groups.of_facing(one));
        pass.set_pipeline(&extraction.edges.pipeline);
        let first = facing.len() as u32;
        self.dispatch(&mut pass, (first, edges), |one| self.groups.of_edges(one));
        pass.set_pipeline(&extraction.merge.pipeline);
        let first = first + edges.len() as u32;
        self.dispatch(&mut pass, (first, merging), |one| self.groups.of_merge(one));
    }

    /// Makes the next [`prepare`](Self::prepare) extract every volume again, for a host that has lost
    /// recorded work in a way that the renderer cannot detect, or has written to a mesh's buffer without a
    /// new revision. Until that is encoded, [`render`](Self::render) returns
    /// [`VolumeRenderError::NotEncoded`].
    pub fn invalidate(&mut self) {
        (self.prepared, self.encoded) = (false, false);
        self.cache.forget_all();
        self.meshes.forget_all();
        self.renew();
    }

    /// Records the stencil draws of one light in one view, by their places in the frame, into the
    /// host's pass, which must have the formats, the sample count and the multiview mask of the descriptor,
    /// a stencil of 0 and the scene's depth in that view (which may be read-only). With
    /// [`Counter::Exact`](crate::Counter::Exact): a count of 0, and no need of the stencil.
    ///
    /// Changes the pass's pipeline, bind group 0, index buffer and vertex buffer 0, and nothing else, except
    /// that if the frame specified a target size and a range, the scissor rectangle is afterwards the whole
    /// target.
    ///
    /// # Errors
    /// [`VolumeRenderError`] if [`encode`](Self::encode) has not been called since the last
    /// [`prepare`](Self::prepare), if its encoder was dropped, or if the frame had no such light or view.
    /// Nothing is then drawn, so the picture has no shadow.
    pub fn render(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        light: usize,
        view: usize,
    ) -> Result<(), VolumeRenderError> {
        if !self.encoded {
            return Err(VolumeRenderError::NotEncoded);
        }
        if self.submissions.is_dropped() {
            return Err(VolumeRenderError::Dropped);
        }
        let drawn = self.drawn(light, view)?;
        if drawn.pair.draws.is_empty() {
            return Ok(());
        }
        let scissor = drawn.pair.scissor;
        if let Some(([x, y, width, height], _)) = scissor {
            pass.set_scissor_rect(x, y, width, height);
        }
        self.draw(pass, &drawn, [light, view]);
        if let Some((_, [width, height])) = scissor {
            pass.set_scissor_rect(0, 0, width, height);
        }
        Ok(())
    }

    /// Resets the counts of the whole viewport to 0 within the host's pass, so that the next light's volumes
    /// can be counted in the same pass: the stencil, or with [`Counter::Exact`](crate::Counter::Exact) the
    /// count's target. On tile-based GPUs, this saves the round trip of depth and colour to memory that one
    /// pass per light would take.
    ///
    /// This also erases whatever a light pass has left in the stencil, including the guard of
    /// [`light_pass_stencil`](Self::light_pass_stencil). Depth and the host's colours are unchanged. Changes
    /// the pass's pipeline and nothing else. The scissor rectangle is the host's, and must contain everything
    /// that was drawn to.
    pub fn reset(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipelines.reset);
        pass.draw(0..3, 0..1);
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, drawn: &Drawn<'_>, place: [usize; 2]) {
        let recorder = drawn.recorder();
        let mut current = None;
        for draw in drawn.draws() {
            let feed = Feed::of(draw.key.way);
            let pipelines = match feed {
                Feed::Records => self.pipelines.fed.as_ref(),
                Feed::Pulled => self.pipelines.pulled.as_ref(),
            };
            let Some(pipelines) = pipelines.filter(|_| self.bind_draw(pass, draw, place)) else {
                continue;
            };
            let state = (draw.key.style, feed);
            if current != Some(state) {
                let Some(pipeline) = pipelines.get(draw.key.style) else {
                    continue;
                };
                pass.set_pipeline(pipeline);
                current = Some(state);
            }
            recorder.record(pass, draw);
        }
    }

    /// The stencil state for the host's light pass, drawn with
    /// [`set_stencil_reference(0)`](wgpu::RenderPass::set_stencil_reference).
    ///
    /// A fragment is shaded only where the count is 0, that is, where the point is in no volume. It then
    /// raises the count to 1, so that a second fragment at the same sample (from two surfaces at the same
    /// depth, or two triangles that share an edge) is not shaded, and light is never added twice. The depth
    /// comparison is up to the host: `Equal` if it draws the scene again, `Always` for a triangle that covers
    /// the screen.
    ///
    /// The pass needs write access to the stencil. Between lights, [`reset`](Self::reset) it in the same
    /// pass, or clear it to 0 in another and keep the depth.
    pub fn light_pass_stencil() -> wgpu::StencilState {
        draw_pipelines::light_pass()
    }

    /// Records the dispatches of one pass, the first of which has this number among all.
    fn dispatch<'a>(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        (first, dispatches): (u32, &'a [Dispatch]),
        group: impl Fn(&'a Dispatch) -> Option<&'a wgpu::BindGroup>,
    ) {
        for (number, dispatch) in (first..).zip(dispatches) {
            let [x, y] = dispatch.groups;
            pass.set_bind_group(0, group(dispatch), &[number * self.limits.batch_window]);
            pass.dispatch_workgroups(x, y, 1);
        }
    }
}

#[cfg(test)]
#[path = "agreement.rs"]
mod agreement;
