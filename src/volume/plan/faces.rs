//! What one frame needs, decided on the CPU: which casters, in which batches, drawn how.

use glam::Mat4;

use crate::error::ShadowVolumeError;
use crate::mesh::{CasterMesh, MeshKind};
use crate::volume::decide::decision::{Subject, subjects, validate};
use crate::volume::decide::facing::{self, Counted};
use crate::volume::decide::method::{Count, DarkCap, Form, Options};
use crate::volume::decide::scissor::Rect;
use crate::volume::gpu::draw_pipelines::{Part, Style};
use crate::volume::plan::cache::Kept;
use crate::volume::plan::params::{Arguments, BatchParams, CasterParams, InstanceParams};
use crate::volume::plan::ranges::Regions;
use crate::volume::silhouette::{Way, Ways};
use crate::volume::statistics::{CasterState, Tally};
use crate::volume::{ShadowVolumeFrame, VolumeStatistics};

/// The kinds of faces of a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Faces {
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
pub(crate) struct Draw {
    pub style: Style,
    /// Number of a [`Slot`](crate::volume::plan::cache::Slot).
    pub slot: u32,
    /// Place in [`Plan::casters`].
    pub caster: u32,
    /// Whether the caps are those that count -1.
    pub back: bool,
}

/// Volumes of one mesh whose parts lie in one chunk, to be found by compute shaders: one dispatch for
/// each extraction pass.
#[derive(Clone, Debug)]
pub(crate) struct Batch {
    pub mesh: CasterMesh,
    pub chunk: usize,
    pub params: BatchParams,
    pub instance_count: u32,
}

/// What the host asked for, as far as it was decided before anything changed.
pub(crate) struct Outline {
    pub subjects: Vec<Subject>,
    tally: Tally,
}

/// Everything `prepare` uploads and `encode` and `render` walk through.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plan {
    pub batches: Vec<Batch>,
    pub draws: Vec<Draw>,
    /// What compute shaders find, batch after batch.
    pub instances: Vec<InstanceParams>,
    /// For each of these, its indirect arguments before anything is counted, and whose they are.
    pub arguments: Vec<(u32, Arguments)>,
    /// For each caster that is drawn, what its draws read.
    pub casters: Vec<CasterParams>,
    /// For each of these, its slot.
    pub slot_of: Vec<u32>,
    pub statistics: VolumeStatistics,
    /// For each caster of the frame, what became of it.
    pub states: Vec<CasterState>,
    /// What of the target is drawn to, and the target's size.
    pub scissor: Option<(Rect, [u32; 2])>,
}

/// What of the device's limits the plan depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlanLimits {
    /// Bytes of the largest buffer that can be made.
    pub buffer_bytes: u64,
    /// Bytes of the largest buffer that can be made and bound as storage.
    pub storage_bytes: u64,
    /// Casters whose parameters fit the buffers.
    pub casters: usize,
    /// Workgroups in one dimension of a dispatch.
    pub workgroups: u32,
    /// Bytes from one caster's parameters to the next's, and from one batch's.
    pub caster_window: u32,
    pub batch_window: u32,
}

/// What of the renderer the plan depends on.
pub(crate) struct Means<'a> {
    pub options: Options,
    pub ways: &'a Ways,
    pub regions: &'a Regions,
    /// Whether volumes are kept at all.
    pub keep: bool,
}

impl Outline {
    /// Decides what is drawn of each caster, or refuses the frame; nothing has changed then.
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
        Ok(Self { subjects, tally })
    }
}

impl Plan {
    /// `kept` has a place for every subject that is drawn.
    pub fn new(
        outline: Outline,
        frame: &ShadowVolumeFrame<'_>,
        options: &Options,
        limits: &PlanLimits,
        kept: &Kept,
    ) -> Self {
        let Outline { subjects, tally } = outline;
        let mut plan = Self::default();
        let mut triangles = 0;
        for (subject, slot) in subjects.iter().zip(kept.order()) {
            if let (Some(form), Some(slot)) = (subject.form, *slot) {
                plan.add(subject, &form, frame, (slot, kept));
                let mesh = &frame.casters[subject.index].mesh;
                triangles += u64::from(mesh.triangle_count());
            }
        }
        plan.draws.sort_unstable();
        let mut extracted = 0;
        for &number in kept.wanted() {
            let way = kept.get(number).map(|slot| slot.way);
            extracted += u32::from(way.is_some_and(|way| way != Way::Vertex));
            if way == Some(Way::Compute) {
                plan.extract(number, kept, limits.workgroups);
            }
        }
        plan.statistics = VolumeStatistics {
            casters_drawn: plan.casters.len() as u32,
            casters_skipped: (frame.casters.len() - plan.casters.len()) as u32,
            draws: plan.draws.len() as u32,
            triangles,
            casters_extracted: extracted,
            dispatches: 2 * plan.batches.len() as u32,
            ..tally.statistics
        };
        plan.states = tally.states;
        plan.scissor = options.scissor(frame);
        plan
    }

    fn add(
        &mut self,
        subject: &Subject,
        form: &Form,
        frame: &ShadowVolumeFrame<'_>,
        (number, kept): (u32, &Kept),
    ) {
        let Some(slot) = kept.get(number) else {
            return; // every number's slot is there
        };
        let caster = &frame.casters[subject.index];
        let (stride, offset) = position_words(&caster.mesh);
        let place = self.casters.len() as u32;
        self.casters.push(CasterParams {
            clip_from_world: frame.view.clip_from_world().to_cols_array_2d(),
            world_from_object: Mat4::from(caster.world_from_object).to_cols_array_2d(),
            light: facing::world_light(frame.light),
            far_plane: form.far.plane.as_vec4().to_array(),
            apex: form.far.apex.as_vec4().to_array(),
            position_stride: stride,
            position_offset: offset,
            side_base: slot.place.side,
            side_vertices: form.side_vertices,
            object_light: subject.light.light,
            object_light_rest: subject.light.rest,
            both_sides: subject.counted as u32,
            anchor: subject.light.origin.anchor,
            zero: 0,
            anchor_from_light: subject.light.origin.from_light,
            depth_step: facing::depth_step(frame.view),
        });
        self.slot_of.push(number);
        self.draw(subject, form, frame, [number, place]);
    }

    /// Has compute shaders find a volume.
    fn extract(&mut self, number: u32, kept: &Kept, most: u32) {
        let Some(slot) = kept.get(number) else { return };
        let first = self.instances.len() as u32;
        self.instances.push(slot.instance);
        // Caps are below the region's end, which the regions keep below 2^32.
        let cap_end = slot.place.cap + 3 * slot.mesh.triangle_count();
        let arguments = Arguments::new(slot.place.cap, cap_end);
        self.arguments.push((number, arguments));
        let open = self.batches.last_mut().filter(|batch| {
            batch.mesh.id() == slot.mesh.id()
                && batch.chunk == slot.place.chunk
                && batch.instance_count < most
        });
        match open {
            Some(batch) => batch.instance_count += 1,
            None => self.batches.push(Batch {
                mesh: slot.mesh.clone(),
                chunk: slot.place.chunk,
                params: batch_params(&slot.mesh, first),
                instance_count: 1,
            }),
        }
    }

    fn draw(
        &mut self,
        subject: &Subject,
        form: &Form,
        frame: &ShadowVolumeFrame<'_>,
        [slot, caster]: [u32; 2],
    ) {
        // A cap that counts +1 is counter-clockwise seen from the light, in the mesh's own space.
        let clockwise = subject.mirrored != facing::is_left_handed(frame.view);
        let mut push = |faces, clockwise, back, parts: &[Part]| {
            self.draws.extend(parts.iter().map(|&part| Draw {
                style: Style {
                    count: form.count,
                    faces,
                    clockwise,
                    part,
                    clipped: form.light_cap_clipped && faces == Faces::LightCap,
                },
                slot,
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

/// Words from one position of a mesh to the next, and before the first. They fit 32 bits: the
/// positions lie in one storage binding.
fn position_words(mesh: &CasterMesh) -> (u32, u32) {
    let (stride, offset) = mesh.layout();
    ((stride / 4) as u32, (offset / 4) as u32)
}

fn batch_params(mesh: &CasterMesh, first_instance: u32) -> BatchParams {
    let (position_stride, position_offset) = position_words(mesh);
    BatchParams {
        first_instance,
        triangle_count: mesh.triangle_count(),
        edge_count: mesh.edge_count(),
        position_stride,
        position_offset,
        general: u32::from(mesh.kind() == MeshKind::General),
        zero: 0,
        padding: 0,
    }
}
