//! The pipelines of planar shadows in the host's passes.

use std::collections::HashMap;

use super::outline::CORNER_SIZE;
use crate::DepthConvention;
use crate::map::INSTANCE_SIZE;
use crate::mesh::InstanceLayout;
use crate::planar::casters::CastDraw;
use crate::planar::descriptor::{PlanarOutput, PlanarShadowDescriptor};
use crate::volume::light_pass::targets::is_float;

const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x3];

const CORNER: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x2];

const ROWS: [wgpu::VertexAttribute; 3] = wgpu::vertex_attr_array![
    1 => Float32x4, 2 => Float32x4, 3 => Float32x4
];

const HOST_COLUMNS: [wgpu::VertexAttribute; 4] = wgpu::vertex_attr_array![
    4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Float32x4
];

const HOST_ROWS: [wgpu::VertexAttribute; 3] = wgpu::vertex_attr_array![
    4 => Float32x4, 5 => Float32x4, 6 => Float32x4
];

/// What the pipelines of one pass share.
#[derive(Clone, Debug)]
pub(crate) struct PassFormats {
    pub label: String,
    pub depth_stencil: wgpu::TextureFormat,
    pub samples: u32,
    pub colors: Vec<Option<wgpu::TextureFormat>>,
    /// The target that is darkened.
    pub darkened: Option<usize>,
    pub shadow_bit: u8,
    pub outline_bit: u8,
    pub receiver_bits: u8,
}

impl PassFormats {
    pub fn new(label: &str, descriptor: &PlanarShadowDescriptor<'_>) -> Self {
        Self {
            label: label.to_owned(),
            depth_stencil: descriptor.depth_stencil_format,
            samples: descriptor.sample_count,
            colors: descriptor.color_formats.to_vec(),
            darkened: match descriptor.output {
                PlanarOutput::Stencil => None,
                PlanarOutput::Darken { target } => Some(target),
            },
            shadow_bit: descriptor.shadow_bit,
            outline_bit: descriptor.outline_bit,
            receiver_bits: descriptor.receiver_bits,
        }
    }

    /// The pass's targets, of which at most one is drawn into.
    fn targets(&self, darkened: Option<usize>) -> Vec<Option<wgpu::ColorTargetState>> {
        let formats = self.colors.iter().enumerate();
        formats
            .map(|(place, format)| {
                let is_drawn = Some(place) == darkened;
                Some(wgpu::ColorTargetState {
                    format: (*format)?,
                    blend: is_drawn.then_some(MULTIPLY),
                    write_mask: match is_drawn {
                        true => wgpu::ColorWrites::COLOR,
                        false => wgpu::ColorWrites::empty(),
                    },
                })
            })
            .collect()
    }

    fn depth_stencil(
        &self,
        compare: wgpu::CompareFunction,
        stencil: wgpu::StencilState,
        slope_scale: f32,
    ) -> wgpu::DepthStencilState {
        wgpu::DepthStencilState {
            format: self.depth_stencil,
            depth_write_enabled: Some(false),
            depth_compare: Some(compare),
            stencil,
            bias: wgpu::DepthBiasState {
                slope_scale,
                ..Default::default()
            },
        }
    }

    fn multisample(&self) -> wgpu::MultisampleState {
        wgpu::MultisampleState {
            count: self.samples,
            ..Default::default()
        }
    }
}

/// What is there, times what is left of it.
const MULTIPLY: wgpu::BlendState = {
    let component = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::Zero,
        dst_factor: wgpu::BlendFactor::Src,
        operation: wgpu::BlendOperation::Add,
    };
    wgpu::BlendState {
        color: component,
        alpha: component,
    }
};

/// The same on both sides of triangles.
fn stencil(face: wgpu::StencilFaceState, read: u8, write: u8) -> wgpu::StencilState {
    wgpu::StencilState {
        front: face,
        back: face,
        read_mask: read.into(),
        write_mask: write.into(),
    }
}

/// All that two draws of casters must share to use the same pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct CastKey {
    /// Bytes between positions.
    stride: u64,
    /// The host's transforms, and bytes between them.
    places: Option<(InstanceLayout, u64)>,
    /// Whether what casts nothing is cut off.
    cut: bool,
    /// Whether the receiver is a polygon.
    polygon: bool,
}

impl CastKey {
    pub fn new(draw: &CastDraw, polygon: bool) -> Self {
        let places = draw.mesh.places();
        Self {
            stride: draw.mesh.layout().0,
            places: places.map(|places| (places.layout, places.stride)),
            cut: draw.cut,
            polygon,
        }
    }

    /// Whether what casts nothing is cut off.
    pub fn is_cut(&self) -> bool {
        self.cut
    }

    /// The shader's entry point and the buffers that it reads.
    pub fn vertex(&self) -> (&'static str, Vec<Option<wgpu::VertexBufferLayout<'static>>>) {
        // Of a mesh at many places all are placed by one row of ours.
        let (entry, attributes, row_stride): (_, &[_], _) = match self.places {
            None => ("vertex", &[], INSTANCE_SIZE),
            Some((InstanceLayout::Columns4x4, _)) => ("vertex_columns", &HOST_COLUMNS, 0),
            Some((InstanceLayout::Rows3x4, _)) => ("vertex_rows", &HOST_ROWS, 0),
        };
        let instance = |array_stride, attributes| wgpu::VertexBufferLayout {
            array_stride,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes,
        };
        let positions = wgpu::VertexBufferLayout {
            array_stride: self.stride,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &POSITION,
        };
        let mut buffers = vec![Some(positions), Some(instance(row_stride, &ROWS))];
        buffers.extend(
            self.places
                .map(|(_, stride)| Some(instance(stride, attributes))),
        );
        (entry, buffers)
    }
}

/// The pipelines that draw casters, made when a draw first needs one.
#[derive(Debug)]
pub(crate) struct CastPipelines {
    formats: PassFormats,
    layout: wgpu::PipelineLayout,
    shader: wgpu::ShaderModule,
    made: HashMap<CastKey, wgpu::RenderPipeline>,
}

impl CastPipelines {
    pub fn new(
        device: &wgpu::Device,
        formats: &PassFormats,
        uniforms: &wgpu::BindGroupLayout,
    ) -> Self {
        let place = formats.darkened.unwrap_or(0);
        let source = crate::wgsl::PLANAR_CASTER
            .replace("-> @location(0)", &format!("-> @location({place})"));
        Self {
            layout: pipeline_layout(device, &formats.label, &[Some(uniforms)]),
            shader: crate::shader::module(device, &formats.label, source),
            made: HashMap::new(),
            formats: formats.clone(),
        }
    }

    /// Makes those that are missing.
    pub fn make(&mut self, device: &wgpu::Device, keys: impl Iterator<Item = CastKey>) {
        for key in keys {
            if !self.made.contains_key(&key) {
                let pipeline = self.pipeline(device, key);
                self.made.insert(key, pipeline);
            }
        }
    }

    pub fn get(&self, key: &CastKey) -> Option<&wgpu::RenderPipeline> {
        self.made.get(key)
    }

    /// The first fragment at a sample marks it, and so is the last to pass.
    fn marks(&self, polygon: bool) -> wgpu::StencilState {
        let PassFormats {
            shadow_bit,
            outline_bit,
            receiver_bits,
            ..
        } = self.formats;
        let receiver = match polygon {
            true => outline_bit,
            false => receiver_bits,
        };
        let face = wgpu::StencilFaceState {
            compare: wgpu::CompareFunction::Equal,
            fail_op: wgpu::StencilOperation::Keep,
            depth_fail_op: wgpu::StencilOperation::Keep,
            pass_op: wgpu::StencilOperation::Invert,
        };
        stencil(face, receiver | shadow_bit, shadow_bit)
    }

    fn pipeline(&self, device: &wgpu::Device, key: CastKey) -> wgpu::RenderPipeline {
        let formats = &self.formats;
        let (entry_point, buffers) = key.vertex();
        let fragment = match (formats.darkened, key.cut) {
            (Some(_), _) => Some("shade"),
            (None, true) => Some("untouched_cut"),
            (None, false) if !formats.colors.is_empty() => Some("untouched"),
            (None, false) => None,
        };
        let targets = formats.targets(formats.darkened);
        let marks = self.marks(key.polygon);
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&formats.label),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.shader,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(formats.depth_stencil(wgpu::CompareFunction::Always, marks, 0.0)),
            multisample: formats.multisample(),
            fragment: fragment.map(|entry_point| wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

fn pipeline_layout(
    device: &wgpu::Device,
    label: &str,
    groups: &[Option<&wgpu::BindGroupLayout>],
) -> wgpu::PipelineLayout {
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: groups,
        immediate_size: 0,
    })
}

/// What is done to the stencil before and after the casters of a plane, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Marking {
    /// Turns the outline's bit over, once for each triangle of the fan.
    Inside,
    /// Takes it back where something is before the plane.
    Before,
    /// Takes it back where what is seen is behind the plane.
    Behind,
    /// Takes it back.
    Done,
    /// Takes back both bits, all over the screen.
    Reset,
}

/// The pipelines of each.
#[derive(Debug)]
pub(crate) struct MarkingPipelines([wgpu::RenderPipeline; 5]);

impl MarkingPipelines {
    pub fn new(
        device: &wgpu::Device,
        formats: &PassFormats,
        uniforms: &wgpu::BindGroupLayout,
        descriptor: &PlanarShadowDescriptor<'_>,
    ) -> Self {
        let label = format!("{} outline", formats.label);
        let shader = crate::shader::module(device, &label, crate::wgsl::PLANAR_OUTLINE);
        let with_uniforms = pipeline_layout(device, &label, &[Some(uniforms)]);
        let without = pipeline_layout(device, &label, &[]);
        let marks = [
            Marking::Inside,
            Marking::Before,
            Marking::Behind,
            Marking::Done,
            Marking::Reset,
        ];
        let make = |marking| {
            let maker = Maker {
                device,
                label: &label,
                formats,
                shader: &shader,
                layout: match marking {
                    Marking::Reset => &without,
                    _ => &with_uniforms,
                },
                descriptor,
            };
            maker.make(marking)
        };
        Self(marks.map(make))
    }

    pub fn get(&self, marking: Marking) -> &wgpu::RenderPipeline {
        &self.0[marking as usize]
    }
}

struct Maker<'a> {
    device: &'a wgpu::Device,
    label: &'a str,
    formats: &'a PassFormats,
    shader: &'a wgpu::ShaderModule,
    layout: &'a wgpu::PipelineLayout,
    descriptor: &'a PlanarShadowDescriptor<'a>,
}

impl Maker<'_> {
    fn make(&self, marking: Marking) -> wgpu::RenderPipeline {
        let (formats, corners) = (self.formats, marking != Marking::Reset);
        let targets = formats.targets(None);
        let (compare, toward) = self.depth(marking);
        let [relative, absolute] = self.steps();
        let constants = [
            ("relative_step", toward * relative),
            ("absolute_step", toward * absolute),
        ];
        let slope_scale = toward as f32 * self.descriptor.bias_pixels;
        let buffers = [Some(wgpu::VertexBufferLayout {
            array_stride: CORNER_SIZE,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &CORNER,
        })];
        self.device
            .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(self.label),
                layout: Some(self.layout),
                vertex: wgpu::VertexState {
                    module: self.shader,
                    entry_point: Some(if corners { "outline" } else { "screen" }),
                    compilation_options: wgpu::PipelineCompilationOptions {
                        constants: if corners { &constants } else { &[] },
                        ..Default::default()
                    },
                    buffers: if corners { &buffers } else { &[] },
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: Some(formats.depth_stencil(
                    compare,
                    self.stencil(marking),
                    slope_scale,
                )),
                multisample: formats.multisample(),
                fragment: (!targets.is_empty()).then(|| wgpu::FragmentState {
                    module: self.shader,
                    entry_point: Some("untouched"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    targets: &targets,
                }),
                multiview_mask: None,
                cache: None,
            })
    }

    /// The depth comparison, and the sign of what is added to depth before it.
    fn depth(&self, marking: Marking) -> (wgpu::CompareFunction, f64) {
        let depth = self.descriptor.depth;
        let nearer = match depth {
            DepthConvention::Standard => -1.0,
            DepthConvention::InfiniteReverse | DepthConvention::FiniteReverse => 1.0,
        };
        match marking {
            Marking::Before => (depth.nearer_or_equal(), nearer),
            Marking::Behind => (depth.nearer(), -nearer),
            Marking::Inside | Marking::Done | Marking::Reset => {
                (wgpu::CompareFunction::Always, 0.0)
            }
        }
    }

    /// Units of the last place: of depth itself where it is a float that is 0 at infinity, of depth 1 elsewhere.
    fn steps(&self) -> [f64; 2] {
        let unit = f64::from(self.descriptor.bias_ulps) / f64::from(1 << 23);
        let infinite = self.descriptor.depth == DepthConvention::InfiniteReverse;
        match infinite && is_float(self.formats.depth_stencil) {
            true => [unit, 0.0],
            false => [0.0, unit],
        }
    }

    fn stencil(&self, marking: Marking) -> wgpu::StencilState {
        use wgpu::StencilOperation as Op;
        let (depth_fail_op, pass_op) = match marking {
            Marking::Inside => (Op::Keep, Op::Invert),
            Marking::Before => (Op::Zero, Op::Keep),
            Marking::Behind => (Op::Keep, Op::Zero),
            Marking::Done | Marking::Reset => (Op::Zero, Op::Zero),
        };
        let face = wgpu::StencilFaceState {
            compare: wgpu::CompareFunction::Always,
            // Never done, but wgpu sets the reference, which Vulkan wants set, only for what names it.
            fail_op: Op::Replace,
            depth_fail_op,
            pass_op,
        };
        let outline = self.formats.outline_bit;
        let written = match marking {
            Marking::Reset => outline | self.formats.shadow_bit,
            _ => outline,
        };
        stencil(face, 0xff, written)
    }
}
