//! The renderer: prepare, encode, render.

use std::collections::HashMap;

use super::buffers::{Bound, Buffers, window};
use super::draw::{self, DrawPipelines};
use super::layout::bind;
use super::params::{Arguments, BatchParams, CasterParams};
use super::plan::{Batch, Draw, Faces, Plan, PlanLimits};
use super::silhouette::{Extraction, workgroups};
use super::{ShadowVolumeDescriptor, ShadowVolumeFrame, VolumeStatistics};
use crate::DepthConvention;
use crate::error::ShadowVolumeError;
use crate::mesh::CasterMesh;

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
/// and is lit: casters that stack that deep along a light ray want fewer, closed meshes.
#[derive(Debug)]
pub struct ShadowVolumeRenderer {
    device: wgpu::Device,
    depth: DepthConvention,
    label: String,
    extraction: Extraction,
    pipelines: DrawPipelines,
    buffers: Buffers,
    groups: Groups,
    plan: Plan,
}

/// The bind groups of a mesh with a chunk's buffers.
#[derive(Debug)]
struct Group {
    // Keeps the mesh alive, so that its key stays its own.
    _mesh: CasterMesh,
    facing: wgpu::BindGroup,
    edges: wgpu::BindGroup,
    draw: wgpu::BindGroup,
}

/// Bind groups by mesh key and chunk.
#[derive(Debug, Default)]
struct Groups {
    generation: u64,
    by_key: HashMap<(usize, usize), Group>,
    /// For each batch, its key.
    of_batch: Vec<(usize, usize)>,
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
        let label = match descriptor.label {
            Some(name) => format!("shadows volume {name}"),
            None => "shadows volume".to_owned(),
        };
        Ok(Self {
            device: device.clone(),
            depth: descriptor.depth,
            extraction: Extraction::new(device, &label),
            pipelines: DrawPipelines::new(device, descriptor, &label),
            buffers: Buffers::new(&label),
            groups: Groups::default(),
            plan: Plan::default(),
            label,
        })
    }

    /// Decides what one frame draws and uploads the parameters: a few hundred bytes a caster.
    ///
    /// GPU memory, kept between frames and grown as needed: about 22 bytes a triangle and instance
    /// for a closed mesh, 28 for any other, and 450 a caster.
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
        let limits = PlanLimits::of(&device.limits());
        let mut plan = Plan::new(frame, device, &limits)?;
        if !plan.draws.is_empty() {
            self.buffers.upload(device, queue, &plan, &limits);
        }
        plan.statistics.gpu_bytes = self.buffers.bytes();
        self.plan = plan;
        self.bind();
        Ok(())
    }

    /// Records the compute passes that extract the volumes. May be called again without another
    /// [`prepare`](Self::prepare), e.g. after the host moved vertices of a mesh.
    pub fn encode(&self, encoder: &mut wgpu::CommandEncoder) {
        let Some(bound) = self.bound() else { return };
        // Counts start from the template, so that recording twice counts nothing twice.
        let size = size_of_val(&self.plan.arguments[..]) as u64;
        encoder.copy_buffer_to_buffer(bound.template, 0, bound.arguments, 0, size);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(&self.label),
            timestamp_writes: None,
        });
        self.dispatch(
            &mut pass,
            &self.extraction.facing.pipeline,
            |batch, group| (batch.params.triangle_count, &group.facing),
        );
        self.dispatch(
            &mut pass,
            &self.extraction.edges.pipeline,
            |batch, group| (batch.params.edge_count, &group.edges),
        );
    }

    /// Records the stencil draws into the host's pass, which must have the formats and the sample
    /// count of the descriptor, a stencil of 0 and the scene's depth (which may be read-only).
    ///
    /// Changes the pass's pipeline, bind group 0 and index buffer, nothing else.
    pub fn render(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Some(bound) = self.bound() else { return };
        let mut current = None;
        for draw in &self.plan.draws {
            let state = (draw.faces, draw.clockwise);
            if current != Some(state) {
                pass.set_pipeline(self.pipelines.get(draw.faces, draw.clockwise));
                current = Some(state);
            }
            self.draw(pass, draw, &bound);
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

    /// The buffers, if there is anything to draw.
    fn bound(&self) -> Option<Bound<'_>> {
        if self.plan.draws.is_empty() {
            return None;
        }
        self.buffers.bound()
    }

    fn dispatch<'a>(
        &'a self,
        pass: &mut wgpu::ComputePass<'_>,
        pipeline: &wgpu::ComputePipeline,
        work: impl Fn(&'a Batch, &'a Group) -> (u32, &'a wgpu::BindGroup),
    ) {
        let limits = self.device.limits();
        let most = limits.max_compute_workgroups_per_dimension;
        let step = window::<BatchParams>(&limits) as u32;
        pass.set_pipeline(pipeline);
        for (index, batch) in (0..).zip(&self.plan.batches) {
            let Some(group) = self.groups.get(index) else {
                continue;
            };
            let (count, group) = work(batch, group);
            let [x, y, z] = workgroups(count, batch.instance_count, most);
            pass.set_bind_group(0, group, &[index as u32 * step]);
            pass.dispatch_workgroups(x, y, z);
        }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, draw: &Draw, bound: &Bound<'_>) {
        let instance = draw.instance as usize;
        let batch = self.plan.batch_of[instance] as usize;
        let chunk = self.plan.batches[batch].chunk;
        let (Some(group), Some([_, caps, _])) = (self.groups.get(batch), self.buffers.chunk(chunk))
        else {
            return;
        };
        let step = window::<CasterParams>(&self.device.limits()) as u32;
        pass.set_bind_group(0, &group.draw, &[draw.instance * step]);
        let arguments = u64::from(draw.instance) * size_of::<Arguments>() as u64;
        if draw.faces == Faces::Sides {
            pass.draw_indirect(bound.arguments, arguments + Arguments::SIDES);
            return;
        }
        let list = if draw.back {
            Arguments::BACK
        } else {
            Arguments::FRONT
        };
        pass.set_index_buffer(caps.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed_indirect(bound.arguments, arguments + list);
    }

    /// Brings the bind groups up to date with plan and buffers.
    fn bind(&mut self) {
        let generation = self.buffers.generation();
        let mut old = std::mem::take(&mut self.groups);
        if old.generation != generation {
            old.by_key.clear();
        }
        let mut groups = Groups {
            generation,
            ..Default::default()
        };
        for batch in &self.plan.batches {
            let key = (batch.mesh.key(), batch.chunk);
            groups.of_batch.push(key);
            if groups.by_key.contains_key(&key) {
                continue;
            }
            if let Some(group) = old.by_key.remove(&key).or_else(|| self.group(batch)) {
                groups.by_key.insert(key, group);
            }
        }
        self.groups = groups;
    }

    fn group(&self, batch: &Batch) -> Option<Group> {
        let bound = self.buffers.bound()?;
        let [facings, caps, sides] = self.buffers.chunk(batch.chunk)?;
        let mesh = &batch.mesh;
        let label = &self.label;
        let params = (bound.batches, size_of::<BatchParams>());
        let make = |layout, window, buffers: &[&wgpu::Buffer]| {
            bind(&self.device, label, layout, window, buffers)
        };
        // A closed mesh has no list of uses, and its passes read none; any buffer will do there.
        let uses = mesh.edge_uses().unwrap_or(mesh.edges());
        Some(Group {
            _mesh: mesh.clone(),
            facing: make(
                &self.extraction.facing.layout,
                params,
                &[
                    bound.instances,
                    bound.arguments,
                    mesh.positions(),
                    mesh.triangles(),
                    facings,
                    caps,
                ],
            ),
            edges: make(
                &self.extraction.edges.layout,
                params,
                &[
                    bound.instances,
                    bound.arguments,
                    mesh.edges(),
                    uses,
                    facings,
                    sides,
                ],
            ),
            draw: make(
                &self.pipelines.layout,
                (bound.casters, size_of::<CasterParams>()),
                &[mesh.positions(), mesh.edges(), sides],
            ),
        })
    }
}

impl Groups {
    fn get(&self, batch: usize) -> Option<&Group> {
        self.by_key.get(self.of_batch.get(batch)?)
    }
}
