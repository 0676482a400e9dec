//! What one frame needs, decided on the CPU: which casters, in which batches, drawn how.

use glam::Mat4;

use super::draw::{Part, Style};
use super::kept::{Kept, Slot};
use super::method::{Count, DarkCap, Form, Options};
use super::params::{Arguments, BatchParams, CasterParams, InstanceParams};
use super::regions::{Overflow, Place, Regions, Words};
use super::rule::{self, Counted};
use super::scissor::Rect;
use super::silhouette::{Counts, Way, Ways};
use super::statistics::{CasterState, Tally};
use super::subject::{Subject, subjects, validate};
use super::{ShadowVolumeFrame, VolumeStatistics};
use crate::error::ShadowVolumeError;
use crate::mesh::{CasterMesh, MeshKind};

/// The kinds of faces of a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Faces {
    LightCap,
    DarkCap,
    Sides,
    /// The dark cap as a fan over the silhouette.
    Fan,
}

impl Draw {
    /// Whether another draw has the same faces, this one being for those that it leaves out.
    pub fn is_repeat(&self) -> bool {
        let alone = (self.style.count, self.style.faces) == (Count::Pass, Faces::LightCap);
        self.style.part == Part::Back && !alone
    }
}

impl Faces {
    /// The vertex shader that places them.
    pub fn entry_point(self) -> &'static str {
        match self {
            Self::LightCap => "shadows_volume_light_cap",
            Self::DarkCap => "shadows_volume_dark_cap",
            Self::Sides => "shadows_volume_side",
            Self::Fan => "shadows_volume_fan",
        }
    }
}

/// One draw. Ordered so that draws of one pipeline follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Draw {
    pub style: Style,
    /// Place in [`Plan::instances`].
    pub instance: u32,
    /// Place in [`Plan::casters`].
    pub caster: u32,
    /// Whether the caps are those that count -1.
    pub back: bool,
}

/// Instances of one mesh whose parts lie in one chunk: one dispatch for each extraction pass.
#[derive(Clone, Debug)]
pub(super) struct Batch {
    pub mesh: CasterMesh,
    pub chunk: usize,
    pub params: BatchParams,
    pub instance_count: u32,
    /// Whether the buffers hold these volumes already.
    pub ready: bool,
    /// Whether they are drawn in this frame.
    pub drawn: bool,
    pub way: Way,
}

/// Everything `prepare` uploads and `encode` and `render` walk through.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    pub batches: Vec<Batch>,
    pub draws: Vec<Draw>,
    /// Words used in each chunk of buffers.
    pub chunks: Vec<Words>,
    pub instances: Vec<InstanceParams>,
    pub arguments: Vec<Arguments>,
    /// For each instance that is drawn, what its draws read.
    pub casters: Vec<CasterParams>,
    /// For each instance, its batch.
    pub batch_of: Vec<u32>,
    /// For each instance, what its volume follows from.
    pub slots: Vec<Slot>,
    pub statistics: VolumeStatistics,
    /// For each caster of the frame, what became of it.
    pub states: Vec<CasterState>,
    /// What of the target is drawn to, and the target's size.
    pub scissor: Option<(Rect, [u32; 2])>,
}

/// What of the device's limits the plan depends on.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanLimits {
    /// Bytes of the largest buffer that can be made.
    pub buffer_bytes: u64,
    /// Bytes of the largest buffer that can be made and bound as storage.
    pub storage_bytes: u64,
    /// Casters whose parameters fit the buffers.
    pub casters: usize,
    /// Workgroups in one dimension of a dispatch.
    pub workgroups: u32,
}

/// What of the renderer the plan depends on.
pub(super) struct Means<'a> {
    pub options: Options,
    pub ways: &'a Ways,
    pub kept: Kept<'a>,
    /// Whether volumes are kept at all.
    pub keep: bool,
}

impl Plan {
    pub fn new(
        frame: &ShadowVolumeFrame<'_>,
        device: &wgpu::Device,
        limits: &PlanLimits,
        means: &Means<'_>,
    ) -> Result<Self, ShadowVolumeError> {
        validate(frame, device)?;
        let mut tally = Tally::default();
        let subjects = subjects(frame, means, limits, &mut tally)?;
        let count = subjects.len();
        if count > limits.casters {
            return Err(ShadowVolumeError::TooManyCasters {
                count,
                limit: limits.casters,
            });
        }
        let mut plan = Self::default();
        let mut regions = Regions::new(limits.storage_bytes);
        for subject in &subjects {
            plan.add(subject, frame, &mut regions, limits, &means.kept)?;
        }
        plan.chunks = regions.chunks().to_vec();
        plan.draws.sort_unstable();
        plan.statistics = VolumeStatistics {
            casters_drawn: plan.casters.len() as u32,
            casters_skipped: (frame.casters.len() - plan.casters.len()) as u32,
            draws: plan.draws.len() as u32,
            triangles: plan.triangles(),
            ..tally.statistics
        };
        plan.states = tally.states;
        plan.scissor = means.options.scissor(frame);
        plan.count_extraction();
        Ok(plan)
    }

    /// Has every volume extracted, because the buffers were made anew.
    pub fn forget(&mut self) {
        self.batches.iter_mut().for_each(|b| b.ready = false);
        self.slots.iter_mut().for_each(|s| s.ready = false);
        self.count_extraction();
    }

    /// Whether any volume is found in this way.
    pub fn uses(&self, way: Way) -> bool {
        self.batches.iter().any(|batch| batch.way == way)
    }

    /// The batches that compute shaders extract, with their places in the list of batches.
    pub fn stale(&self) -> impl Iterator<Item = (u32, &Batch)> {
        let stale = |batch: &Batch| batch.drawn && !batch.ready && batch.way == Way::Compute;
        (0..)
            .zip(&self.batches)
            .filter(move |(_, batch)| stale(batch))
    }

    /// The slots whose volumes the CPU extracts.
    pub fn stale_on_cpu(&mut self) -> impl Iterator<Item = &mut Slot> {
        let stale = |slot: &&mut Slot| slot.is_stale() && slot.way == Way::Cpu;
        self.slots.iter_mut().filter(stale)
    }

    fn triangles(&self) -> u64 {
        let drawn = self.slots.iter().filter(|slot| slot.drawn);
        drawn
            .map(|slot| u64::from(slot.mesh.triangle_count()))
            .sum()
    }

    fn count_extraction(&mut self) {
        let searched = |slot: &&Slot| slot.is_stale() && slot.way != Way::Vertex;
        let extracted = self.slots.iter().filter(searched).count() as u32;
        let dispatches = 2 * self.stale().count() as u32;
        self.statistics.casters_extracted = extracted;
        self.statistics.dispatches = dispatches;
    }

    fn add(
        &mut self,
        subject: &Subject,
        frame: &ShadowVolumeFrame<'_>,
        regions: &mut Regions,
        limits: &PlanLimits,
        kept: &Kept<'_>,
    ) -> Result<(), ShadowVolumeError> {
        let caster = &frame.casters[subject.index];
        let mesh = &caster.mesh;
        let place = place(mesh, subject, regions, limits).map_err(|overflow| {
            ShadowVolumeError::TooLarge {
                index: subject.index,
                what: overflow.what,
                size: overflow.size,
                limit: overflow.limit,
            }
        })?;
        let instance = self.instances.len() as u32;
        let mut slot = Slot {
            mesh: mesh.clone(),
            revision: mesh.revision(),
            chunk: place.chunk,
            instance: instance_params(subject, &place),
            way: subject.way,
            counts: Counts::default(),
            layers: None,
            ready: false,
            drawn: subject.form.is_some(),
        };
        if let Some(kept) = kept.get(instance as usize, &slot) {
            slot.counts = kept.counts;
            slot.layers = kept.layers;
            slot.ready = true;
        }
        let batch = self.batch(&slot, limits.workgroups);
        self.batch_of.push(batch);
        self.instances.push(slot.instance);
        self.slots.push(slot);
        // Caps are below the region's end, which the regions keep below 2^32.
        let cap_end = place.cap + subject.words(mesh)[1] as u32;
        self.arguments.push(Arguments::new(place.cap, cap_end));
        let Some(form) = subject.form else {
            return Ok(());
        };
        let params = &self.batches[batch as usize].params;
        let params_place = self.casters.len() as u32;
        self.casters.push(CasterParams {
            clip_from_world: frame.view.clip_from_world().to_cols_array_2d(),
            world_from_object: Mat4::from(caster.world_from_object).to_cols_array_2d(),
            light: rule::world_light(frame.light),
            far_plane: form.far.plane.as_vec4().to_array(),
            apex: form.far.apex.as_vec4().to_array(),
            position_stride: params.position_stride,
            position_offset: params.position_offset,
            side_base: place.side,
            side_vertices: form.side_vertices,
            object_light: subject.light.light,
            object_light_rest: subject.light.rest,
            both_sides: subject.counted as u32,
            anchor: subject.light.origin.anchor,
            zero: 0,
            anchor_from_light: subject.light.origin.from_light,
            depth_step: rule::depth_step(frame.view),
        });
        self.draw(subject, &form, frame, [instance, params_place]);
        Ok(())
    }

    /// The batch that the next instance belongs to.
    fn batch(&mut self, slot: &Slot, most: u32) -> u32 {
        let open = self.batches.last_mut().filter(|batch| {
            batch.mesh.key() == slot.mesh.key()
                && batch.chunk == slot.chunk
                && (batch.ready, batch.drawn) == (slot.ready, slot.drawn)
                && batch.way == slot.way
                && batch.instance_count < most
        });
        match open {
            Some(batch) => batch.instance_count += 1,
            None => self.batches.push(Batch {
                mesh: slot.mesh.clone(),
                chunk: slot.chunk,
                params: batch_params(&slot.mesh, self.instances.len() as u32),
                instance_count: 1,
                ready: slot.ready,
                drawn: slot.drawn,
                way: slot.way,
            }),
        }
        self.batches.len() as u32 - 1
    }

    fn draw(
        &mut self,
        subject: &Subject,
        form: &Form,
        frame: &ShadowVolumeFrame<'_>,
        [instance, caster]: [u32; 2],
    ) {
        // A cap that counts +1 is counter-clockwise seen from the light, in the mesh's own space.
        let clockwise = subject.mirrored != rule::is_left_handed(frame.view);
        let mut push = |faces, clockwise, back, parts: &[Part]| {
            self.draws.extend(parts.iter().map(|&part| Draw {
                style: Style {
                    count: form.count,
                    faces,
                    clockwise,
                    part,
                },
                instance,
                caster,
                back,
            }));
        };
        let parts = match subject.counted {
            Counted::AwayFacing => &[Part::Front, Part::Back][..],
            Counted::LightFacing | Counted::All => &[Part::Whole],
        };
        push(Faces::Sides, clockwise, false, parts);
        if form.dark_cap == DarkCap::Fan {
            push(Faces::Fan, clockwise, false, &[Part::Whole]);
        }
        for &back in subject.cap_lists() {
            match (form.count, subject.counted) {
                (Count::Fail, _) => push(Faces::LightCap, clockwise != back, back, parts),
                // Where the mesh's far side is what is seen, its cap lies before it.
                (Count::Pass, Counted::AwayFacing) => {
                    push(Faces::LightCap, clockwise != back, back, &[Part::Back]);
                }
                (Count::Pass, _) => {}
            }
            if form.dark_cap == DarkCap::Full {
                push(Faces::DarkCap, clockwise == back, back, &[Part::Whole]);
            }
        }
    }
}

/// Finds room for one instance's lists.
fn place(
    mesh: &CasterMesh,
    subject: &Subject,
    regions: &mut Regions,
    limits: &PlanLimits,
) -> Result<Place, Overflow> {
    let size = match subject.way {
        Way::Vertex => mesh.record_bytes(),
        Way::Compute | Way::Cpu => 0,
    };
    if size > limits.buffer_bytes {
        return Err(Overflow {
            what: "edge records",
            size,
            limit: limits.buffer_bytes,
        });
    }
    regions.place(subject.words(mesh))
}

fn instance_params(subject: &Subject, place: &Place) -> InstanceParams {
    InstanceParams {
        light: subject.light.light,
        light_rest: subject.light.rest,
        both_sides: subject.counted as u32,
        facing_base: place.facing,
        cap_base: place.cap,
        side_base: place.side,
        zero: 0,
    }
}

fn batch_params(mesh: &CasterMesh, first_instance: u32) -> BatchParams {
    let (stride, offset) = mesh.layout();
    BatchParams {
        first_instance,
        triangle_count: mesh.triangle_count(),
        edge_count: mesh.edge_count(),
        // In words they fit 32 bits: the positions lie in one storage binding.
        position_stride: (stride / 4) as u32,
        position_offset: (offset / 4) as u32,
        general: u32::from(mesh.kind() == MeshKind::General),
        padding: [0; 2],
    }
}
