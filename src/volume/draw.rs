//! The pipelines that count a volume's faces in the stencil buffer.

use super::ShadowVolumeDescriptor;
use super::buffers::Buffers;
use super::layout::{storage, uniform};
use super::params::{Arguments, CasterParams};
use super::plan::{Draw, Faces, Plan};
use super::silhouette::{LIGHT_SIDE, Way};
use crate::mesh::{CasterMesh, EdgeRecord, MeshKind};
use crate::wgsl::POSITION;

const EXTRUDE: &str = include_str!("../../shaders/volume_extrude.wgsl");
const DRAW: &str = include_str!("../../shaders/volume_draw.wgsl");
const VERTEX: &str = include_str!("../../shaders/volume_vertex.wgsl");

/// How far sides are set back from the viewer, in units of the depth format's last place.
///
/// In a crease between a lit and an unlit triangle a side leaves the surface at so small an angle
/// that both have the same depth for a while, give or take the rasteriser's rounding. Set back by
/// that rounding it counts as behind the surface it belongs to.
const SIDE_BIAS_ULPS: i32 = 2;

/// What the vertex shaders work from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Feed {
    /// The lists that an extraction left, in storage buffers.
    Pulled,
    /// All triangles and edges, in vertex buffers.
    Records,
}

impl Feed {
    /// The shader of all faces.
    pub fn source(self) -> String {
        match self {
            Self::Pulled => [POSITION, EXTRUDE, DRAW].join("\n"),
            Self::Records => [POSITION, EXTRUDE, LIGHT_SIDE, VERTEX].join("\n"),
        }
    }

    /// Storage buffers at bindings 1 and on: positions, edges, sides.
    fn storage_buffers(self) -> u32 {
        match self {
            Self::Pulled => 3,
            Self::Records => 0,
        }
    }

    fn vertex_buffers(self, faces: Faces) -> Vec<Option<wgpu::VertexBufferLayout<'static>>> {
        const CORNERS: [wgpu::VertexAttribute; 3] =
            wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3];
        const EDGE: [wgpu::VertexAttribute; 7] = wgpu::vertex_attr_array![
            0 => Float32x3, 1 => Float32x3, 2 => Float32x3,
            3 => Float32x3, 4 => Float32x3, 5 => Float32x3, 6 => Uint32
        ];
        let layout = |attributes, size: usize| wgpu::VertexBufferLayout {
            array_stride: size as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes,
        };
        match (self, faces) {
            (Self::Pulled, _) => Vec::new(),
            (Self::Records, Faces::Sides) => vec![Some(layout(&EDGE, size_of::<EdgeRecord>()))],
            (Self::Records, _) => vec![Some(layout(&CORNERS, size_of::<[[f32; 3]; 3]>()))],
        }
    }
}

/// z-fail: a back face behind the visible point counts +1, a front face -1, modulo 256 because the
/// faces come in any order.
fn z_fail() -> wgpu::StencilState {
    let count = |depth_fail_op| wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Always,
        fail_op: wgpu::StencilOperation::Keep,
        depth_fail_op,
        pass_op: wgpu::StencilOperation::Keep,
    };
    wgpu::StencilState {
        front: count(wgpu::StencilOperation::DecrementWrap),
        back: count(wgpu::StencilOperation::IncrementWrap),
        read_mask: 0xff,
        write_mask: 0xff,
    }
}

/// What the light pass demands of the count, and the guard it leaves.
pub(super) fn light_pass() -> wgpu::StencilState {
    let face = wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Equal,
        fail_op: wgpu::StencilOperation::Keep,
        depth_fail_op: wgpu::StencilOperation::Keep,
        pass_op: wgpu::StencilOperation::IncrementClamp,
    };
    wgpu::StencilState {
        front: face,
        back: face,
        read_mask: 0xff,
        write_mask: 0xff,
    }
}

/// One pipeline for each kind of faces and each way that "front" may turn on screen.
#[derive(Debug)]
pub(super) struct DrawPipelines {
    /// Binds caster and, where they are pulled, positions, edges, sides.
    pub layout: wgpu::BindGroupLayout,
    pipelines: [[wgpu::RenderPipeline; 2]; 3],
}

impl DrawPipelines {
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ShadowVolumeDescriptor<'_>,
        feed: Feed,
        label: &str,
    ) -> Self {
        let stage = wgpu::ShaderStages::VERTEX;
        let mut entries = vec![uniform(stage, size_of::<CasterParams>())];
        entries.extend((1..=feed.storage_buffers()).map(|binding| storage(binding, stage, true)));
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &entries,
        });
        let factory = Factory {
            device,
            descriptor,
            feed,
            label,
            module: device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(label),
                source: wgpu::ShaderSource::Wgsl(feed.source().into()),
            }),
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(label),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            }),
        };
        let pipelines = [Faces::LightCap, Faces::DarkCap, Faces::Sides].map(|faces| {
            [wgpu::FrontFace::Ccw, wgpu::FrontFace::Cw].map(|f| factory.make(faces, f))
        });
        Self { layout, pipelines }
    }

    pub fn get(&self, faces: Faces, clockwise: bool) -> &wgpu::RenderPipeline {
        let [light_cap, dark_cap, sides] = &self.pipelines;
        let [ccw, cw] = match faces {
            Faces::LightCap => light_cap,
            Faces::DarkCap => dark_cap,
            Faces::Sides => sides,
        };
        if clockwise { cw } else { ccw }
    }
}

/// Records one draw, its pipeline and bind group being set.
pub(super) fn issue(pass: &mut wgpu::RenderPass<'_>, draw: &Draw, plan: &Plan, buffers: &Buffers) {
    let slot = &plan.slots[draw.instance as usize];
    let caster = &plan.casters[draw.instance as usize];
    match slot.way {
        Way::Vertex => issue_records(pass, draw.faces, &slot.mesh, caster),
        Way::Cpu => {
            if draw.faces == Faces::Sides {
                let vertices = slot.counts.sides * caster.side_vertices;
                return pass.draw(0..vertices, 0..1);
            }
            let Some([_, caps, _]) = buffers.chunk(slot.chunk) else {
                return;
            };
            let middle = slot.instance.cap_base + slot.counts.front;
            let range = match draw.back {
                false => slot.instance.cap_base..middle,
                true => middle..middle + slot.counts.back,
            };
            pass.set_index_buffer(caps.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(range, 0, 0..1);
        }
        Way::Compute => {
            let (Some(bound), Some([_, caps, _])) = (buffers.bound(), buffers.chunk(slot.chunk))
            else {
                return;
            };
            let own = u64::from(draw.instance) * size_of::<Arguments>() as u64;
            if draw.faces == Faces::Sides {
                return pass.draw_indirect(bound.arguments, own + Arguments::SIDES);
            }
            let list = match draw.back {
                false => Arguments::FRONT,
                true => Arguments::BACK,
            };
            pass.set_index_buffer(caps.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed_indirect(bound.arguments, own + list);
        }
    }
}

/// Every triangle or every edge as an instance.
fn issue_records(
    pass: &mut wgpu::RenderPass<'_>,
    faces: Faces,
    mesh: &CasterMesh,
    caster: &CasterParams,
) {
    let Some(records) = mesh.records() else {
        return;
    };
    if faces != Faces::Sides {
        pass.set_vertex_buffer(0, records.triangles.slice(..));
        return pass.draw(0..3, 0..mesh.triangle_count());
    }
    // Two triangles that both count are extruded twice where they run through the edge alike.
    let copies = match (mesh.kind(), caster.both_sides) {
        (MeshKind::Closed, 0) => 1,
        _ => 2,
    };
    pass.set_vertex_buffer(0, records.edges.slice(..));
    pass.draw(0..copies * caster.side_vertices, 0..records.edge_count);
}

struct Factory<'a> {
    device: &'a wgpu::Device,
    descriptor: &'a ShadowVolumeDescriptor<'a>,
    feed: Feed,
    label: &'a str,
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
}

impl Factory<'_> {
    fn make(&self, faces: Faces, front_face: wgpu::FrontFace) -> wgpu::RenderPipeline {
        let label = format!("{} {faces:?} {front_face:?}", self.label);
        let entry_point = match faces {
            Faces::LightCap => "shadows_volume_light_cap",
            Faces::DarkCap => "shadows_volume_dark_cap",
            Faces::Sides => "shadows_volume_side",
        };
        let targets = self.targets();
        // A pass without colour needs no fragment stage, and is faster without.
        let fragment = (!targets.is_empty()).then(|| wgpu::FragmentState {
            module: &self.module,
            entry_point: Some("shadows_volume_nothing"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &targets,
        });
        self.device
            .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(&label),
                layout: Some(&self.layout),
                vertex: wgpu::VertexState {
                    module: &self.module,
                    entry_point: Some(entry_point),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &self.feed.vertex_buffers(faces),
                },
                primitive: wgpu::PrimitiveState {
                    front_face,
                    cull_mode: None,
                    // Faces beyond a finite far plane must count; clamped, they do.
                    unclipped_depth: self.descriptor.depth.clips_far(),
                    ..Default::default()
                },
                depth_stencil: Some(self.depth_stencil(faces)),
                multisample: wgpu::MultisampleState {
                    count: self.descriptor.sample_count,
                    ..Default::default()
                },
                fragment,
                multiview_mask: None,
                cache: None,
            })
    }

    fn targets(&self) -> Vec<Option<wgpu::ColorTargetState>> {
        let target = |format| wgpu::ColorTargetState {
            format,
            blend: None,
            write_mask: wgpu::ColorWrites::empty(),
        };
        let formats = self.descriptor.color_formats.iter();
        formats.map(|format| format.map(target)).collect()
    }

    fn depth_stencil(&self, faces: Faces) -> wgpu::DepthStencilState {
        let depth = self.descriptor.depth;
        let bias = match faces {
            Faces::LightCap => i32::try_from(self.descriptor.cap_bias_ulps).unwrap_or(i32::MAX),
            Faces::Sides => SIDE_BIAS_ULPS,
            // At infinity it is behind everything as it is.
            Faces::DarkCap => 0,
        };
        wgpu::DepthStencilState {
            format: self.descriptor.depth_stencil_format,
            depth_write_enabled: Some(false),
            // A cap at the visible depth itself is behind it: strictly nearer passes.
            depth_compare: Some(depth.nearer()),
            stencil: z_fail(),
            bias: wgpu::DepthBiasState {
                constant: bias * depth.away(),
                ..Default::default()
            },
        }
    }
}
