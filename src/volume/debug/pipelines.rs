//! The pipelines of the debug views.

use crate::DepthConvention;
use crate::volume::debug::views::VolumeDebugDescriptor;
use crate::volume::decide::near_plane::NearPlane;
use crate::volume::gpu::draw_pipelines::Feed;
use crate::volume::gpu::layout::uniform;
use crate::volume::light_pass::screen::SCREEN;
use crate::volume::multiview::Multiview;
use crate::volume::plan::faces::Faces;

const COLOR: &str = include_str!("../../../shaders/volume_debug.wgsl");
const PULLED: &str = include_str!("../../../shaders/volume_debug_pulled.wgsl");
const RECORDS: &str = include_str!("../../../shaders/volume_debug_records.wgsl");

/// Bytes of one colour.
pub(crate) const COLOR_BYTES: usize = 16;

/// How far casters are drawn before themselves, in units of the depth format's last place.
const CASTER_BIAS_ULPS: i32 = 16;

impl Feed {
    /// The shader of faces, edges and casters.
    fn debug_source(self, depth: DepthConvention, near: NearPlane) -> String {
        let own = match self {
            Self::Pulled => PULLED,
            Self::Records => RECORDS,
        };
        [&self.source(depth, near), own, COLOR].join("\n")
    }
}

/// What draws volumes that were found in one of the ways.
#[derive(Debug)]
pub(crate) struct FeedPipelines {
    pub layout: wgpu::BindGroupLayout,
    faces: [(Faces, wgpu::RenderPipeline); 4],
    pub edges: wgpu::RenderPipeline,
    pub casters: wgpu::RenderPipeline,
}

impl FeedPipelines {
    pub fn new(factory: &Factory<'_>, feed: Feed) -> Self {
        let layout = feed.layout(factory.device, factory.label, Multiview::default());
        let make = |entry_point, faces, lines, depth: Test| {
            factory.make(&Recipe {
                source: feed.debug_source(factory.descriptor.depth, factory.near()),
                entry_point,
                buffers: &feed.vertex_buffers(faces),
                layout: Some(&layout),
                lines,
                depth,
                stencil: wgpu::StencilState::default(),
                blend: Some(wgpu::BlendState::ALPHA_BLENDING),
            })
        };
        let kinds = [Faces::LightCap, Faces::DarkCap, Faces::Sides, Faces::Fan];
        let (edge, caster) = ("shadows_volume_debug_edge", "shadows_volume_debug_caster");
        Self {
            faces: kinds.map(|faces| {
                let pipeline = make(faces.entry_point(), faces, false, Test::Nearer(0));
                (faces, pipeline)
            }),
            edges: make(edge, Faces::Sides, true, Test::Always),
            casters: make(
                caster,
                Faces::LightCap,
                false,
                Test::Nearer(CASTER_BIAS_ULPS),
            ),
            layout,
        }
    }

    pub fn faces(&self, faces: Faces) -> Option<&wgpu::RenderPipeline> {
        let found = self.faces.iter().find(|(known, _)| *known == faces);
        found.map(|(_, pipeline)| pipeline)
    }
}

/// What draws the stencil's counts. Each writes nothing but colour.
#[derive(Debug)]
pub(crate) struct CountPipelines {
    /// Where the count is the reference.
    pub equal: wgpu::RenderPipeline,
    /// Where the count is above the reference.
    pub above: wgpu::RenderPipeline,
    /// Where the count is 248 or more and the reference 248.
    pub negative: wgpu::RenderPipeline,
}

impl CountPipelines {
    pub fn new(factory: &Factory<'_>) -> Self {
        let make = |compare, read_mask| {
            let face = wgpu::StencilFaceState {
                compare,
                ..wgpu::StencilFaceState::IGNORE
            };
            factory.make(&Recipe {
                source: [SCREEN, COLOR].join("\n"),
                entry_point: "screen",
                buffers: &[],
                layout: None,
                lines: false,
                depth: Test::Always,
                stencil: wgpu::StencilState {
                    front: face,
                    back: face,
                    read_mask,
                    write_mask: 0,
                },
                blend: None,
            })
        };
        Self {
            equal: make(wgpu::CompareFunction::Equal, 0xff),
            above: make(wgpu::CompareFunction::Less, 0xff),
            negative: make(wgpu::CompareFunction::Equal, 0xf8),
        }
    }
}

/// The layout of the colours, group 1.
pub(crate) fn color_layout(device: &wgpu::Device, label: &str) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[uniform(0, wgpu::ShaderStages::FRAGMENT, COLOR_BYTES)],
    })
}

/// Which fragments are drawn.
enum Test {
    Always,
    /// Those before the visible surface, moved so many units of the last place toward the viewer.
    Nearer(i32),
}

/// What one pipeline differs in from the others.
struct Recipe<'a> {
    source: String,
    entry_point: &'a str,
    buffers: &'a [Option<wgpu::VertexBufferLayout<'static>>],
    layout: Option<&'a wgpu::BindGroupLayout>,
    lines: bool,
    depth: Test,
    stencil: wgpu::StencilState,
    blend: Option<wgpu::BlendState>,
}

/// What all pipelines share.
pub(crate) struct Factory<'a> {
    pub device: &'a wgpu::Device,
    pub descriptor: &'a VolumeDebugDescriptor<'a>,
    pub label: &'a str,
    pub colors: &'a wgpu::BindGroupLayout,
}

impl Factory<'_> {
    fn near(&self) -> NearPlane {
        NearPlane::of(self.device.features(), self.descriptor.depth)
    }

    fn make(&self, recipe: &Recipe<'_>) -> wgpu::RenderPipeline {
        let (device, label) = (self.device, Some(self.label));
        let module = crate::shader::module(device, self.label, recipe.source.as_str());
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &[recipe.layout, Some(self.colors)],
            immediate_size: 0,
        });
        let constants = self.near().depth(self.descriptor.depth);
        let of_faces = recipe.layout.and(constants);
        let compilation_options = wgpu::PipelineCompilationOptions::default();
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(recipe.entry_point),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: of_faces.as_slice(),
                    ..Default::default()
                },
                buffers: recipe.buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: match recipe.lines {
                    true => wgpu::PrimitiveTopology::LineList,
                    false => wgpu::PrimitiveTopology::TriangleList,
                },
                // As the volumes themselves are drawn.
                unclipped_depth: self.descriptor.depth.clips_far(),
                ..Default::default()
            },
            depth_stencil: Some(self.depth_stencil(recipe)),
            multisample: wgpu::MultisampleState {
                count: self.descriptor.sample_count,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("shadows_volume_debug"),
                compilation_options,
                targets: &[Some(wgpu::ColorTargetState {
                    format: self.descriptor.color_format,
                    blend: recipe.blend,
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn depth_stencil(&self, recipe: &Recipe<'_>) -> wgpu::DepthStencilState {
        let depth = self.descriptor.depth;
        let (depth_compare, nearer_by) = match recipe.depth {
            Test::Always => (wgpu::CompareFunction::Always, 0),
            Test::Nearer(ulps) => (depth.nearer(), ulps),
        };
        wgpu::DepthStencilState {
            format: self.descriptor.depth_stencil_format,
            depth_write_enabled: Some(false),
            depth_compare: Some(depth_compare),
            stencil: recipe.stencil.clone(),
            bias: wgpu::DepthBiasState {
                constant: -nearer_by * depth.away(),
                ..Default::default()
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    use super::*;

    #[test]
    fn every_shader_is_valid_without_any_capability() {
        let screen = [SCREEN, COLOR].join("\n");
        let depths = [DepthConvention::InfiniteReverse, DepthConvention::Standard];
        let feeds = depths.into_iter().flat_map(|depth| {
            [Feed::Pulled, Feed::Records].map(|feed| feed.debug_source(depth, NearPlane::Passed))
        });
        for source in feeds.chain([screen]) {
            let module = naga::front::wgsl::parse_str(&source)
                .unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source)));
            Validator::new(ValidationFlags::all(), Capabilities::empty())
                .validate(&module)
                .unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source)));
        }
    }
}
