//! Several faces of a light in one pass, by multiview.

use std::collections::HashMap;
use std::num::NonZeroU32;

use super::cube::CubeShadowMap;
use super::draws::Draw;
use super::encode::depth_attachment;
use super::face::CubeFace;
use super::plan::SlotPlan;
use super::resources::{self, Instance, PipelineKey, PipelineKind, UNIFORM_STRIDE};
use super::slot::ALL_FACES;
use super::statistics::CubeStatistics;
use crate::Support;
use crate::error::CubeShadowMapError;

/// In how many passes a [`CubeShadowMap`] draws the faces of a light. All give the same bits.
///
/// On Mesa's software Vulkan (llvmpipe), with the 64 spheres of the example `compare`, one pass takes
/// 1.5 to 2.3 times as long as six at 1024 texels a face, and 2.4 to 5 times as long at 64
/// (`multiview_vs_six_passes` of the bench `cube_map`): each caster goes through the vertex shader
/// once for every face drawn, not only for the two or so that it touches. No GPU has been measured;
/// run the bench on yours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FacePasses {
    /// The way that measured faster, which is [`Separate`](Self::Separate) on every device measured
    /// so far.
    #[default]
    Auto,
    /// A pass for each face, with the casters that touch it.
    Separate,
    /// One pass for all faces of a light that are drawn in this frame, with every caster that
    /// touches any of them: fewer passes and draws, and more triangles that a view only clips. Needs
    /// [`Support::multiview`](crate::Support). A pipeline is made for each set of faces when it
    /// first occurs. Faces that go alone are drawn as by [`Separate`](Self::Separate). There are no
    /// [`StillLayers`](crate::StillLayers) under faces that are drawn together.
    Multiview,
}

impl FacePasses {
    pub(super) fn joint(self) -> bool {
        self == Self::Multiview
    }

    pub(super) fn validate(self, device: &wgpu::Device) -> Result<(), CubeShadowMapError> {
        let missing = Support::MULTIVIEW - device.features();
        let views = device.limits().max_multiview_view_count;
        match self.joint() && (!missing.is_empty() || views < 6) {
            true => Err(CubeShadowMapError::Multiview { missing, views }),
            false => Ok(()),
        }
    }
}

/// What drawing several faces at once takes, beside what single faces take.
///
/// llvmpipe (seen in Mesa 22.3.6) gathers the triangles that it clips until something makes it draw
/// them, and then draws them all on the layer of the first view that had any, so that what
/// straddles two faces goes missing on one. A run of triangles none of which is clipped makes it
/// draw: there every draw ends with an instance that lies in one point in the middle of every view.
#[derive(Debug)]
pub(super) struct Joint {
    kind: PipelineKind,
    separators: bool,
    /// All six faces' matrices of a light.
    group: wgpu::BindGroup,
    /// By the mask of the faces drawn.
    pipelines: HashMap<(PipelineKey, u8), wgpu::RenderPipeline>,
}

impl Joint {
    pub fn new(
        device: &wgpu::Device,
        label: &str,
        face_uniforms: &wgpu::Buffer,
        single: &PipelineKind,
    ) -> Self {
        let label = format!("{label} joint");
        let size = wgpu::BufferSize::new(6 * UNIFORM_STRIDE);
        let separators = device.adapter_info().driver == "llvmpipe";
        let (layout, group) = resources::face_group(device, &label, face_uniforms, size);
        Self {
            kind: PipelineKind {
                layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: Some(&label),
                    bind_group_layouts: &[Some(&layout)],
                    immediate_size: 0,
                }),
                shader: crate::shader::module(device, &label, crate::wgsl::CUBE_CASTER_VIEWS),
                constants: match separators {
                    true => &[("separators", 1.0)],
                    false => &[],
                },
                ..*single
            },
            separators,
            group,
            pipelines: HashMap::new(),
        }
    }

    /// What follows the instances of every draw.
    pub fn separator(&self) -> Option<Instance> {
        self.separators.then_some(Instance::default())
    }

    /// Instances that separators may take, where casters take `instances`: one for each draw, of
    /// which there are at most as many as casters.
    pub fn room(&self, instances: usize) -> usize {
        if self.separators { instances } else { 0 }
    }
}

/// The faces of a mask as views of one pass; `None` if they are fewer than two.
fn views(mask: u8) -> Option<NonZeroU32> {
    NonZeroU32::new(u32::from(mask)).filter(|mask| mask.get().count_ones() > 1)
}

impl CubeShadowMap {
    /// Makes the pipelines that the faces drawn together need.
    pub(super) fn make_joint_pipelines(&mut self, device: &wgpu::Device, plans: &[SlotPlan]) {
        let Some(joint) = &mut self.joint else { return };
        for (index, plan) in plans.iter().enumerate() {
            let Some(mask) = views(plan.drawn) else {
                continue;
            };
            for draw in self.draws.of(index, mask.trailing_zeros() as usize) {
                let key = draw.key();
                joint.pipelines.entry((key, plan.drawn)).or_insert_with(|| {
                    resources::pipeline(device, &self.label, &joint.kind, key, Some(mask))
                });
            }
        }
    }

    /// Draws the pending faces of a slot, in one pass if they are those that were prepared. Gives the
    /// faces that are clear or drawn then.
    pub(super) fn encode_joint(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        index: usize,
        pending: u8,
        joint: &Joint,
    ) -> u8 {
        if pending == 0 {
            return 0;
        }
        let drawn = self.plans[index].drawn;
        let draws = self.draws.of(index, drawn.trailing_zeros() as usize);
        match views(pending) {
            Some(mask) if pending == drawn => {
                self.clear_others(encoder, index, pending);
                self.encode_views(encoder, index, mask, draws, joint);
                ALL_FACES
            }
            // One face, or the host has begun one of them in the meantime: its set of faces has no
            // pipeline.
            _ => {
                for face in CubeFace::ALL {
                    if pending & face.bit() != 0 {
                        self.encode_face(encoder, index, face, draws);
                    }
                }
                pending
            }
        }
    }

    fn encode_views(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        index: usize,
        mask: NonZeroU32,
        draws: &[Draw],
        joint: &Joint,
    ) {
        let Some(texture) = self.textures.slot(index) else {
            return; // prepare made the texture of every slot with pending faces
        };
        let bits = mask.get() as u8;
        let label = format!("{} {index} faces {bits:06b}", self.label);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&label),
            depth_stencil_attachment: Some(depth_attachment(texture.layers(), self.clear())),
            multiview_mask: Some(mask),
            ..Default::default()
        });
        let offset = index as u32 * 6 * UNIFORM_STRIDE as u32;
        pass.set_bind_group(0, &joint.group, &[offset]);
        for draw in draws {
            if let Some(pipeline) = joint.pipelines.get(&(draw.key(), bits)) {
                let count = draw.instance_count + u32::from(joint.separators);
                draw.record_with(&mut pass, pipeline, &self.instances, count);
            }
        }
    }

    /// Clears the faces of a new texture that a pass of several leaves out: its clear touches none
    /// of them, and wgpu takes the whole view for cleared and would show whatever was in memory.
    fn clear_others(&self, encoder: &mut wgpu::CommandEncoder, index: usize, mask: u8) {
        let Some(texture) = self.textures.slot(index) else {
            return;
        };
        let unknown = ALL_FACES & !mask & !texture.cleared;
        for face in CubeFace::ALL {
            if unknown & face.bit() != 0 {
                drop(self.begin_pass(encoder, index, face, self.clear()));
            }
        }
    }

    /// Counts draw calls and the triangles in them, those of several views once for each.
    pub(super) fn count_draws(&self, statistics: &mut CubeStatistics, plans: &[SlotPlan]) {
        for (index, plan) in plans.iter().enumerate() {
            let times = match &self.joint {
                Some(_) => plan.drawn.count_ones(),
                None => 1,
            };
            // The faces that go alone in a map of joint faces are drawn from the same list.
            let on_faces = (0..6).flat_map(|face| self.draws.of(index, face));
            let on_layers = (0..6).flat_map(|face| self.draws.of_layer(index, face));
            for draw in on_faces.chain(on_layers) {
                statistics.draws += 1;
                statistics.triangles += u64::from(times)
                    * u64::from(draw.mesh.triangle_count())
                    * u64::from(draw.instance_count);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wgsl_layout::layout;

    #[test]
    fn the_shader_finds_each_face_where_a_pass_for_it_would() {
        let source = crate::wgsl::CUBE_CASTER_VIEWS;
        let (members, size) = layout(source, "ShadowsCubeFaceSlot");
        assert_eq!(members, [("face".to_owned(), 0)]);
        assert_eq!(size as u64, UNIFORM_STRIDE);
        let (members, size) = layout(source, "ShadowsCubeFaceUniform");
        assert_eq!(members[1], ("range".to_owned(), 64));
        assert_eq!(size, size_of::<resources::FaceUniform>());
    }
}
