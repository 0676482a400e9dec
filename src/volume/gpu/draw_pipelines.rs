//! The pipelines that count a volume's faces in the stencil buffer.

use crate::DepthConvention;
use crate::mesh::EdgeRecord;
use crate::volume::decide::method::Count;
use crate::volume::decide::near_plane::NearPlane;
use crate::volume::gpu::counter::{self, Counter, Counting};
use crate::volume::gpu::layout::{storage, uniform};
use crate::volume::multiview::Multiview;
use crate::volume::plan::faces::Faces;
use crate::volume::plan::limits::PULLED_BUFFERS;
use crate::volume::plan::merged::BLOCK_BYTES;
use crate::volume::plan::params::{CasterParams, LightParams, ViewParams};
use crate::volume::silhouette::{LIGHT_SIDE, Way};
use crate::volume::{ShadowVolumeDescriptor, StartFrom};
use crate::wgsl::POSITION;

const EXTRUDE: &str = include_str!("../../../shaders/volume_extrude.wgsl");
const CORNER: &str = include_str!("../../../shaders/volume_corner.wgsl");
const CORNER_CUT: &str = include_str!("../../../shaders/volume_corner_cut.wgsl");
const CLIP_DISTANCES: &str = include_str!("../../../shaders/volume_clip_distances.wgsl");
const AS_IS: &str = include_str!("../../../shaders/volume_depth_as_is.wgsl");
const STEPS: &str = include_str!("../../../shaders/volume_depth_steps.wgsl");
const DRAW: &str = include_str!("../../../shaders/volume_draw.wgsl");
const VERTEX: &str = include_str!("../../../shaders/volume_vertex.wgsl");

/// How far sides are set back from the viewer, in units of the depth format's last place.
///
/// In a crease between a lit and an unlit triangle a side leaves the surface at so small an angle
/// that both have the same depth for a while, give or take the rasteriser's rounding. Set back by
/// that rounding it counts as behind the surface it belongs to: in z-fail, and not in z-pass. Both
/// take the same, so that every face counts in exactly one of the two.
const SIDE_BIAS_ULPS: i32 = 2;

/// How far the dark caps of z-fail are set back, in the same units.
///
/// They lie behind everything that is to be shadowed, but perhaps by less than the depth format can
/// tell or the rasteriser rounds. (In z-pass they are drawn where rays start beyond them.)
const DARK_CAP_BIAS_ULPS: i32 = 16;

/// What the vertex shaders work from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Feed {
    /// The lists that an extraction left, in storage buffers.
    Pulled,
    /// All triangles and edges, in vertex buffers.
    Records,
}

impl Feed {
    /// What draws need whose silhouettes are found in this way.
    pub fn of(way: Way) -> Self {
        match way {
            Way::Vertex => Self::Records,
            Way::Compute | Way::Cpu => Self::Pulled,
        }
    }

    /// The shader of all faces.
    pub fn source(self, depth: DepthConvention, near: NearPlane) -> String {
        let (extension, corner) = match near {
            NearPlane::Clipped | NearPlane::Passed => ("", CORNER),
            NearPlane::Cut => (CLIP_DISTANCES, CORNER_CUT),
        };
        let set_back = match depth {
            DepthConvention::InfiniteReverse => AS_IS,
            DepthConvention::FiniteReverse | DepthConvention::Standard => STEPS,
        };
        match self {
            Self::Pulled => [extension, POSITION, set_back, EXTRUDE, corner, DRAW].join("\n"),
            Self::Records => [
                extension, POSITION, set_back, EXTRUDE, corner, LIGHT_SIDE, VERTEX,
            ]
            .join("\n"),
        }
    }

    /// Bytes of the uniform buffers, from binding 0 on: of a view (or the views of a pass), a light and,
    /// where a draw has but one, a caster. Storage buffers follow.
    pub(crate) fn uniforms(self, multiview: Multiview) -> impl Iterator<Item = usize> {
        let sizes = [
            multiview.cameras() * size_of::<ViewParams>(),
            size_of::<LightParams>(),
            size_of::<CasterParams>(),
        ];
        sizes.into_iter().take(self.uniform_count())
    }

    /// How many there are.
    pub(crate) fn uniform_count(self) -> usize {
        match self {
            Self::Pulled => 2,
            Self::Records => 3,
        }
    }

    /// Binds view, light and caster; where they are pulled casters, positions, edges, and sides or caps.
    pub(crate) fn layout(
        self,
        device: &wgpu::Device,
        label: &str,
        multiview: Multiview,
    ) -> wgpu::BindGroupLayout {
        let stage = wgpu::ShaderStages::VERTEX;
        let sizes = (0..).zip(self.uniforms(multiview));
        let mut entries: Vec<_> = sizes
            .map(|(binding, size)| uniform(binding, stage, size))
            .collect();
        if self == Self::Pulled {
            entries.extend((2..2 + PULLED_BUFFERS).map(|binding| storage(binding, stage, true)));
        }
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &entries,
        })
    }

    pub(crate) fn vertex_buffers(
        self,
        faces: Faces,
    ) -> Vec<Option<wgpu::VertexBufferLayout<'static>>> {
        const CORNERS: [wgpu::VertexAttribute; 3] =
            wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3];
        const EDGE: [wgpu::VertexAttribute; 7] = wgpu::vertex_attr_array![
            0 => Float32x3, 1 => Float32x3, 2 => Float32x3,
            3 => Float32x3, 4 => Float32x3, 5 => Float32x3, 6 => Uint32
        ];
        const BLOCK: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Uint32x3];
        let layout = |attributes, size: usize| wgpu::VertexBufferLayout {
            array_stride: size as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes,
        };
        match (self, faces) {
            (Self::Pulled, _) => vec![Some(layout(&BLOCK, BLOCK_BYTES as usize))],
            (Self::Records, Faces::Sides | Faces::Fan) => {
                vec![Some(layout(&EDGE, size_of::<EdgeRecord>()))]
            }
            (Self::Records, _) => vec![Some(layout(&CORNERS, size_of::<[[f32; 3]; 3]>()))],
        }
    }
}

/// What the light pass demands of the count, and the guard it leaves.
pub(crate) fn light_pass() -> wgpu::StencilState {
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

/// What the names of all GPU objects here begin with.
const LABEL: &str = "shadows volume";

/// One pipeline for each kind of faces, way to count and way that "front" may turn on screen.
#[derive(Clone, Debug)]
pub(crate) struct DrawPipelines {
    feed: Feed,
    /// See [`Feed::layout`].
    pub layout: wgpu::BindGroupLayout,
    pipelines: Vec<(Style, wgpu::RenderPipeline)>,
}

/// What a pipeline is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Style {
    pub count: Count,
    pub faces: Faces,
    /// Whether faces that are clockwise on screen are the volume's front.
    pub clockwise: bool,
    pub part: Part,
    /// Whether depth is clipped though the projection has a far plane: see `Form`.
    pub clipped: bool,
}

impl Style {
    /// -1 for faces that are set toward the viewer, 1 for all others.
    fn away(self) -> i32 {
        match (self.part, self.faces) {
            (Part::Front, Faces::Sides) | (Part::Back, Faces::LightCap) => -1,
            _ => 1,
        }
    }
}

/// The faces of one draw that count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Part {
    Whole,
    /// Those seen from outside the volume, of one that starts at the far side of its mesh; see
    /// `start.rs`.
    Front,
    /// The others.
    Back,
}

/// What such volumes add.
const PARTS: [(Count, Faces, Part); 7] = [
    (Count::Fail, Faces::LightCap, Part::Front),
    (Count::Fail, Faces::LightCap, Part::Back),
    (Count::Fail, Faces::Sides, Part::Front),
    (Count::Fail, Faces::Sides, Part::Back),
    (Count::Pass, Faces::Sides, Part::Front),
    (Count::Pass, Faces::Sides, Part::Back),
    (Count::Pass, Faces::LightCap, Part::Back),
];

/// z-pass needs no caps, except the fan where rays may start beyond a finite volume.
const KINDS: [(Count, Faces); 6] = [
    (Count::Fail, Faces::LightCap),
    (Count::Fail, Faces::DarkCap),
    (Count::Fail, Faces::Sides),
    (Count::Fail, Faces::Fan),
    (Count::Pass, Faces::Sides),
    (Count::Pass, Faces::Fan),
];

impl DrawPipelines {
    /// None yet.
    pub fn new(device: &wgpu::Device, feed: Feed, multiview: Multiview) -> Self {
        Self {
            feed,
            layout: feed.layout(device, LABEL, multiview),
            pipelines: Vec::new(),
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.pipelines.len()
    }

    /// Compiles those of a descriptor that are missing. All that were compiled before were of
    /// descriptors with the same passes.
    pub fn complete(
        &mut self,
        device: &wgpu::Device,
        cache: Option<&wgpu::PipelineCache>,
        descriptor: &ShadowVolumeDescriptor<'_>,
    ) {
        let missing = styles(descriptor).filter(|style| self.get(*style).is_none());
        let missing: Vec<Style> = missing.collect();
        if missing.is_empty() {
            return;
        }
        let factory = Factory::new(device, cache, descriptor, self);
        let made = missing
            .into_iter()
            .map(|style| (style, factory.make(style)));
        let made: Vec<_> = made.collect();
        self.pipelines.extend(made);
    }

    /// The pipeline, for every style that a plan uses.
    pub fn get(&self, style: Style) -> Option<&wgpu::RenderPipeline> {
        let found = self.pipelines.iter().find(|(known, _)| *known == style);
        found.map(|(_, pipeline)| pipeline)
    }
}

/// All that a plan of this descriptor may use.
fn styles(descriptor: &ShadowVolumeDescriptor<'_>) -> impl Iterator<Item = Style> {
    let parts = match descriptor.start_from {
        StartFrom::LightFacing => &[][..],
        StartFrom::AwayFacing => &PARTS,
    };
    let clips = descriptor.depth.clips_far();
    let kinds = KINDS.map(|(count, faces)| (count, faces, Part::Whole));
    let kinds = kinds.into_iter().chain(parts.iter().copied());
    kinds.flat_map(move |(count, faces, part)| {
        let may_be_clipped = clips && (count, faces) == (Count::Fail, Faces::LightCap);
        let clipped = [false, true]
            .into_iter()
            .take(1 + usize::from(may_be_clipped));
        clipped.flat_map(move |clipped| {
            [false, true].map(|clockwise| Style {
                count,
                faces,
                clockwise,
                part,
                clipped,
            })
        })
    })
}

struct Factory<'a> {
    device: &'a wgpu::Device,
    cache: Option<&'a wgpu::PipelineCache>,
    descriptor: &'a ShadowVolumeDescriptor<'a>,
    feed: Feed,
    near: NearPlane,
    module: wgpu::ShaderModule,
    /// The same for faces that the rasteriser clips.
    clipped: Option<wgpu::ShaderModule>,
    /// Holds the fragment shader, where that is what counts.
    counting: Option<wgpu::ShaderModule>,
    layout: wgpu::PipelineLayout,
}

impl<'a> Factory<'a> {
    fn new(
        device: &'a wgpu::Device,
        cache: Option<&'a wgpu::PipelineCache>,
        descriptor: &'a ShadowVolumeDescriptor<'a>,
        to: &DrawPipelines,
    ) -> Self {
        let module = |source: String| crate::shader::module(device, LABEL, source);
        let (feed, depth) = (to.feed, descriptor.depth);
        let source = |depth, near| descriptor.multiview().source(feed.source(depth, near));
        let near = NearPlane::of(device.features(), depth);
        Self {
            device,
            cache,
            descriptor,
            feed,
            near,
            module: module(source(depth, near)),
            clipped: depth
                .clips_far()
                .then(|| module(source(DepthConvention::InfiniteReverse, NearPlane::Clipped))),
            counting: (descriptor.counter == Counter::Exact)
                .then(|| module(counter::source(descriptor.color_formats.len()))),
            layout: device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(LABEL),
                bind_group_layouts: &[Some(&to.layout)],
                immediate_size: 0,
            }),
        }
    }

    fn make(&self, style: Style) -> wgpu::RenderPipeline {
        let faces = style.faces;
        let label = format!("{LABEL} {style:?}");
        let nearer = self.descriptor.depth.nearer();
        let counting = self.descriptor.counter.counting(style.count, nearer);
        let targets = self.targets(&counting);
        let (counting_module, fragment) = match &self.counting {
            Some(counting) => (counting, "shadows_volume_count"),
            None => (&self.module, "shadows_volume_nothing"),
        };
        // A pass without colour needs no fragment stage, and is faster without.
        let fragment = (!targets.is_empty()).then(|| wgpu::FragmentState {
            module: counting_module,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &targets,
        });
        let unclipped_depth = self.descriptor.depth.clips_far() && !style.clipped;
        let module = match &self.clipped {
            Some(clipped) if style.clipped => clipped,
            _ => &self.module,
        };
        let steps = ("depth_steps", f64::from(self.bias(style)));
        let near_depth = self.near.depth(self.descriptor.depth);
        let of_unclipped = [Some(steps), near_depth].into_iter().flatten();
        let constants: Vec<_> = of_unclipped.filter(|_| unclipped_depth).collect();
        self.device
            .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(&label),
                layout: Some(&self.layout),
                vertex: wgpu::VertexState {
                    module,
                    entry_point: Some(faces.entry_point()),
                    compilation_options: wgpu::PipelineCompilationOptions {
                        constants: &constants,
                        ..Default::default()
                    },
                    buffers: &self.feed.vertex_buffers(faces),
                },
                primitive: wgpu::PrimitiveState {
                    front_face: match style.clockwise {
                        false => wgpu::FrontFace::Ccw,
                        true => wgpu::FrontFace::Cw,
                    },
                    cull_mode: match style.part {
                        Part::Whole => None,
                        Part::Front => Some(wgpu::Face::Back),
                        Part::Back => Some(wgpu::Face::Front),
                    },
                    // Faces beyond a finite far plane must count; clamped, they do.
                    unclipped_depth,
                    ..Default::default()
                },
                depth_stencil: Some(self.depth_stencil(style, counting)),
                multisample: wgpu::MultisampleState {
                    count: self.descriptor.sample_count,
                    ..Default::default()
                },
                fragment,
                multiview_mask: self.descriptor.multiview_mask,
                cache: self.cache,
            })
    }

    fn targets(&self, counting: &Counting) -> Vec<Option<wgpu::ColorTargetState>> {
        let target = |format| wgpu::ColorTargetState {
            format,
            blend: None,
            write_mask: wgpu::ColorWrites::empty(),
        };
        let formats = self.descriptor.color_formats.iter();
        let formats = formats.map(|format| format.map(target));
        formats.chain(counting.target.clone().map(Some)).collect()
    }

    /// How far faces are set back from the viewer, in units of the last place.
    fn bias(&self, style: Style) -> i32 {
        let units = match style.faces {
            Faces::LightCap => i32::try_from(self.descriptor.cap_bias_ulps).unwrap_or(i32::MAX),
            Faces::Sides => SIDE_BIAS_ULPS,
            Faces::DarkCap | Faces::Fan => match style.count {
                Count::Fail => DARK_CAP_BIAS_ULPS,
                Count::Pass => 0,
            },
        };
        units * style.away()
    }

    fn depth_stencil(&self, style: Style, counting: Counting) -> wgpu::DepthStencilState {
        let bias = self.bias(style) * self.descriptor.depth.away();
        wgpu::DepthStencilState {
            format: self.descriptor.depth_stencil_format,
            depth_write_enabled: Some(false),
            // A cap at the visible depth itself is behind it: strictly nearer passes.
            depth_compare: Some(counting.depth_compare),
            stencil: counting.stencil,
            bias: wgpu::DepthBiasState {
                constant: bias,
                clamp: self.bias_clamp(bias),
                ..Default::default()
            },
        }
    }

    /// The most that a bias may be: as many last places of depth 1.
    ///
    /// In a float format the unit is the last place of the largest depth on the face. Where depth is not
    /// clipped, a face has corners far beyond the far plane (in an orthographic view without an end), or
    /// just before the eye, and some GPUs (NVIDIA's) go by those: all of it would be behind everything.
    fn bias_clamp(&self, constant: i32) -> f32 {
        // GL has no such bound.
        let bounded = self.device.adapter_info().backend != wgpu::Backend::Gl;
        match bounded && self.descriptor.depth.clips_far() {
            true => constant as f32 * f32::EPSILON,
            false => 0.0,
        }
    }
}
