//! The renderer: prepare, encode, render.

use std::sync::atomic::{AtomicBool, Ordering};

use super::buffers::{Buffers, window};
use super::draw::{self, DrawPipelines, Feed, issue};
use super::groups::{Groups, Parts};
use super::kept::Kept;
use super::layers;
use super::method::Options;
use super::params::{Arguments, BatchParams, CasterParams};
use super::plan::{Batch, Means, Plan, PlanLimits};
use super::silhouette::{CpuVolume, Extraction, Way, Ways, workgroups};
use super::{Counter, ShadowVolumeDescriptor, ShadowVolumeFrame, VolumeStatistics};
use crate::DepthConvention;
use crate::error::ShadowVolumeError;

/// Stencil shadow volumes of one light for any number of casters.
///
/// A host with several lights keeps one renderer for each light that shines in a frame, or
/// prepares, records and submits one light after another.
///
/// The host's frame, for each light:
/// 1. depth prepass: all surfaces into the depth-stencil buffer;
/// 2. [`prepare`](Self::prepare), then [`encode`](Self::encode) outside of any pass;
/// 3. a pass with that depth-stencil buffer, its stencil cleared to 0 and its depth loaded:
///    [`render`](Self::render), then the host's own light pass with
///    [`light_pass_stencil`](Self::light_pass_stencil).
///
/// The stencil counts modulo 256. A point that lies in a multiple of 256 volumes at once reads 0
/// and is lit: casters that stack that deep along a light ray want
/// [`Counter::Exact`](crate::Counter::Exact) or fewer, closed meshes.
/// [`may_wrap`](Self::may_wrap) says whether that can happen.
///
/// A light nearer to a triangle than about 3e-5 of the triangle's size leaves wrong pixels along
/// the horizon of that triangle: its corners' points at infinity then cancel in f32 clip space.
#[derive(Debug)]
pub struct ShadowVolumeRenderer {
    device: wgpu::Device,
    depth: DepthConvention,
    label: String,
    ways: Ways,
    extraction: Option<Extraction>,
    /// Where the CPU finds one volume after another.
    on_cpu: CpuVolume,
    /// Pipelines that read the lists of an extraction.
    pulled: Option<DrawPipelines>,
    /// Pipelines that are fed all triangles and edges.
    fed: Option<DrawPipelines>,
    buffers: Buffers,
    groups: Groups,
    plan: Plan,
    keep: bool,
    options: Options,
    counter: Counter,
    /// Whether `encode` was called since the last `prepare`.
    encoded: AtomicBool,
}

impl ShadowVolumeRenderer {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// [`ShadowVolumeError`] if a format or sample count does not fit, or the device lacks a
    /// feature or a limit; the message names it.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ShadowVolumeDescriptor<'_>,
    ) -> Result<Self, ShadowVolumeError> {
        descriptor.validate(device)?;
        let ways = Ways::new(descriptor.silhouettes, device)?;
        let label = match descriptor.label {
            Some(name) => format!("shadows volume {name}"),
            None => "shadows volume".to_owned(),
        };
        Ok(Self {
            device: device.clone(),
            depth: descriptor.depth,
            ways,
            extraction: ways
                .contain(Way::Compute)
                .then(|| Extraction::new(device, &label)),
            on_cpu: CpuVolume::default(),
            pulled: (ways.contain(Way::Compute) || ways.contain(Way::Cpu))
                .then(|| DrawPipelines::new(device, descriptor, Feed::Pulled, &label)),
            fed: ways
                .contain(Way::Vertex)
                .then(|| DrawPipelines::new(device, descriptor, Feed::Records, &label)),
            buffers: Buffers::new(&label),
            groups: Groups::default(),
            plan: Plan::default(),
            options: Options::of(descriptor),
            counter: descriptor.counter,
            keep: descriptor.keep_between_frames,
            encoded: AtomicBool::new(false),
            label,
        })
    }

    /// Decides what one frame draws and uploads the parameters: a few hundred bytes a caster.
    ///
    /// GPU memory, kept between frames and grown as needed: about 28 bytes a triangle and instance,
    /// and 720 a caster; up to twice that, because buffers grow to powers of two. Casters out of
    /// view keep their places, so that what comes back into view need not be searched again, as long
    /// as all casters together fit one storage buffer for each list; else they hold nothing.
    ///
    /// # Errors
    /// [`ShadowVolumeError`], before any GPU work, if the view's depth convention is not the
    /// renderer's, a light, range or caster is not sound, or a caster's volume is larger than the
    /// device's limits allow. The renderer then still draws what the last call prepared.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        frame: &ShadowVolumeFrame<'_>,
    ) -> Result<(), ShadowVolumeError> {
        if frame.view.depth() != self.depth {
            return Err(ShadowVolumeError::Depth {
                renderer: self.depth,
                view: frame.view.depth(),
            });
        }
        let limits = PlanLimits::of(&device.limits(), &self.ways);
        let means = Means {
            options: self.options,
            ways: &self.ways,
            kept: self.kept(),
            keep: self.keep,
        };
        let mut plan = Plan::new(frame, device, &limits, &means)?;
        if !plan.draws.is_empty() {
            let generation = self.buffers.generation();
            self.buffers.reserve(device, &plan, &limits);
            if self.buffers.generation() != generation {
                plan.forget();
            }
            self.extract(queue, &mut plan);
            self.buffers.upload(device, queue, &plan);
        }
        plan.statistics.gpu_bytes = self.buffers.bytes();
        self.plan = plan;
        *self.encoded.get_mut() = false;
        self.bind();
        Ok(())
    }

    /// Records the compute passes that extract the volumes which were not kept from the frame
    /// before: none where neither the light nor a caster has moved.
    ///
    /// What is recorded must be submitted, for the next frame counts on it. A host that deforms a
    /// mesh in its own position buffer says so with
    /// [`CasterMesh::bump_revision`](crate::CasterMesh::bump_revision) before
    /// [`prepare`](Self::prepare).
    pub fn encode(&self, encoder: &mut wgpu::CommandEncoder) {
        self.encoded.store(true, Ordering::Relaxed);
        if self.plan.stale().next().is_none() {
            return;
        }
        let (Some(bound), Some(extraction)) = (self.buffers.bound(), &self.extraction) else {
            return;
        };
        let each = size_of::<Arguments>() as u64;
        for (_, batch) in self.plan.stale() {
            // Counts start from the template, so that recording twice counts nothing twice.
            let start = u64::from(batch.params.first_instance) * each;
            let size = u64::from(batch.instance_count) * each;
            encoder.copy_buffer_to_buffer(bound.template, start, bound.arguments, start, size);
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

    /// Records the stencil draws into the host's pass, which must have the formats and the sample
    /// count of the descriptor, a stencil of 0 and the scene's depth (which may be read-only). With
    /// [`Counter::Exact`](crate::Counter::Exact): a count of 0, and no need of the stencil.
    ///
    /// Changes the pass's pipeline, bind group 0, index buffer and vertex buffer 0; where the frame
    /// gave a target size and a range, also the scissor rectangle, which is then the whole target.
    /// Nothing else.
    pub fn render(&self, pass: &mut wgpu::RenderPass<'_>) {
        if self.plan.draws.is_empty() {
            return;
        }
        if let Some(([x, y, width, height], _)) = self.plan.scissor {
            pass.set_scissor_rect(x, y, width, height);
        }
        let mut current = None;
        for draw in &self.plan.draws {
            let batch = self.plan.batch_of[draw.instance as usize] as usize;
            let way = self.plan.batches[batch].way;
            let pipelines = match way {
                Way::Vertex => self.fed.as_ref(),
                Way::Compute | Way::Cpu => self.pulled.as_ref(),
            };
            let (Some(pipelines), Some(group)) = (pipelines, self.groups.get(batch)) else {
                continue;
            };
            let state = (draw.style, way == Way::Vertex);
            if current != Some(state) {
                let Some(pipeline) = pipelines.get(draw.style) else {
                    continue;
                };
                pass.set_pipeline(pipeline);
                current = Some(state);
            }
            let step = window::<CasterParams>(&self.device.limits()) as u32;
            pass.set_bind_group(0, &group.draw, &[draw.caster * step]);
            issue(pass, draw, &self.plan, &self.buffers);
        }
        if let Some((_, [width, height])) = self.plan.scissor {
            pass.set_scissor_rect(0, 0, width, height);
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
        draw::light_pass()
    }

    /// What the last [`prepare`](Self::prepare) came to.
    pub fn statistics(&self) -> VolumeStatistics {
        self.plan.statistics
    }

    /// No visible point is in more volumes than this, of those that the last
    /// [`prepare`](Self::prepare) draws.
    ///
    /// The bound is 1 for a convex caster and grows with the number of silhouette edges that one
    /// plane through the light cuts; casters add up where their bounding spheres overlap as seen
    /// from the light. A mesh over positions in the host's own buffer counts with all its triangles.
    ///
    /// Takes the CPU about as long as one extraction of the volumes drawn
    /// ([`Silhouettes::Cpu`](crate::Silhouettes::Cpu)); what a caster comes to is kept with its
    /// volume, and what is left to do where nothing moved is to sort the casters.
    pub fn count_bound(&mut self) -> u64 {
        layers::bound(&mut self.plan, &mut self.on_cpu)
    }

    /// Whether the counter could wrap in the frame prepared last, so that a point in shadow would
    /// be lit: [`count_bound`](Self::count_bound) is at least 256, or with
    /// [`Counter::Exact`](crate::Counter::Exact) 2^24.
    ///
    /// `false` is certain. `true` may be a false alarm, for the bound is not the count.
    pub fn may_wrap(&mut self) -> bool {
        self.count_bound() >= self.counter.end()
    }

    /// Extracts on the CPU what is extracted there.
    fn extract(&mut self, queue: &wgpu::Queue, plan: &mut Plan) {
        for slot in plan.stale_on_cpu() {
            let (Some(mesh), Some([_, caps, sides])) =
                (slot.mesh.data(), self.buffers.chunk(slot.chunk))
            else {
                continue;
            };
            let volume = &mut self.on_cpu;
            slot.counts = volume.extract(mesh, slot.mesh.kind(), &slot.instance);
            let at = |place: u32| u64::from(place) * 4;
            // Caps are most of it, and go where the queue takes them from.
            let caps_size = at(slot.counts.front) + at(slot.counts.back);
            let staging = wgpu::BufferSize::new(caps_size)
                .and_then(|size| queue.write_buffer_with(caps, at(slot.instance.cap_base), size));
            if let Some(mut staging) = staging {
                volume.write_caps(mesh, staging.slice(..));
            }
            let words = bytemuck::cast_slice(&volume.sides);
            queue.write_buffer(sides, at(slot.instance.side_base), words);
        }
    }

    /// What the buffers hold of the frame before.
    fn kept(&self) -> Kept<'_> {
        if !self.keep {
            return Kept::NOTHING;
        }
        Kept {
            slots: &self.plan.slots,
            encoded: self.encoded.load(Ordering::Relaxed),
        }
    }

    fn dispatch<'a>(
        &'a self,
        pass: &mut wgpu::ComputePass<'_>,
        pipeline: &wgpu::ComputePipeline,
        work: impl Fn(&'a Batch, &'a [wgpu::BindGroup; 2]) -> (u32, &'a wgpu::BindGroup),
    ) {
        let limits = self.device.limits();
        let most = limits.max_compute_workgroups_per_dimension;
        let step = window::<BatchParams>(&limits) as u32;
        pass.set_pipeline(pipeline);
        for (index, batch) in self.plan.stale() {
            let group = self.groups.get(index as usize);
            let Some(groups) = group.and_then(|group| group.extraction.as_ref()) else {
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
            extraction: self.extraction.as_ref(),
            pulled: self.pulled.as_ref(),
            fed: self.fed.as_ref(),
        };
        self.groups.update(&self.plan, &parts);
    }
}

#[cfg(test)]
#[path = "agreement.rs"]
mod agreement;
